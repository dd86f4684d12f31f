//! EXR files, made by the library that reads them.

use super::*;
use crate::diff::buffer::bytes;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, IntegerBounds,
    Layer, LayerAttributes, LineOrder, SmallVec, Vec2, WritableImage, f16,
};

/// An EXR of these channels.
fn exr_in(
    [width, height]: [usize; 2],
    channels: Vec<(&str, FlatSamples)>,
    compression: Compression,
    blocks: Blocks,
) -> Vec<u8> {
    let channels = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples));
    let channels = AnyChannels::sort(channels.collect::<SmallVec<_>>());
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let layer = Layer::new((width, height), LayerAttributes::default(), encoding, channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn exr(size: [usize; 2], channels: Vec<(&str, FlatSamples)>) -> Vec<u8> {
    exr_in(size, channels, Compression::ZIP16, Blocks::ScanLines)
}

fn floats(values: &[f32]) -> FlatSamples {
    FlatSamples::F32(values.to_vec())
}

fn read_exr(bytes: &[u8], channels: &[&str], normals: bool) -> Result<ReadBuffer, String> {
    let channels = channels.iter().map(|&name| name.to_owned()).collect();
    let options = ReadOptions { channels, normals, ..ReadOptions::default() };
    let input = std::io::Cursor::new(bytes);
    read_from(Path::new("a.exr"), input, &options).map_err(|error| error.to_string())
}

#[test]
fn channels_are_read_by_their_names() {
    let file = exr(
        [2, 1],
        vec![
            ("Z", floats(&[2.5, f32::INFINITY])),
            ("object_id", FlatSamples::U32(vec![7, u32::MAX])),
            ("half", FlatSamples::F16(vec![f16::from_f32(1.5), f16::from_f32(-2.0)])),
            ("mask", floats(&[0.0, 1.0])),
        ],
    );
    let content = |name: &str| read_exr(&file, &[name], false).unwrap().buffer.content().clone();
    assert_eq!(content("Z"), Content::Distances(vec![2.5, f64::INFINITY]));
    assert_eq!(content("object_id"), Content::Ids(vec![Some(7), None]));
    assert_eq!(content("half"), Content::Distances(vec![1.5, -2.0]));
    assert_eq!(content("mask"), Content::Mask(vec![false, true].into()));
    let read = read_exr(&file, &["Z"], false).unwrap();
    assert_eq!(read.notes, ["channel Z; not read: half, mask, object_id"]);
    let problem = read_exr(&file, &[], false).unwrap_err();
    assert_eq!(
        problem,
        "a.exr: choose what to read of it with --channels NAME[,NAME...]; its channels are Z, half, mask, \
         object_id"
    );
}

#[test]
fn every_compression_and_tiles_give_the_same_values() {
    let values: Vec<f32> =
        (0..70_u8).flat_map(|i| (0..50).map(move |j| f32::from(i / 3 + j / 4))).collect();
    let expected = Content::Distances(values.iter().copied().map(f64::from).collect());
    use Compression::{PIZ, RLE, Uncompressed, ZIP1, ZIP16};
    for compression in [Uncompressed, RLE, ZIP1, ZIP16, PIZ] {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(16, 32))] {
            let channels = vec![("Z", floats(&values)), ("other", floats(&[0.5; 3500]))];
            let file = exr_in([50, 70], channels, compression, blocks);
            let read = read_exr(&file, &["Z"], false).unwrap().buffer;
            assert_eq!((read.size(), read.content()), ([50, 70], &expected), "{compression}");
        }
    }
}

#[test]
fn colors_are_linear_and_multiplied_by_alpha() {
    let channels = |alpha: &[f32]| {
        let color = [("R", [0.25, 0.5]), ("G", [0.0, -1.0]), ("B", [4.0, 1.0])];
        let mut channels: Vec<(&str, FlatSamples)> =
            color.iter().map(|(name, values)| (*name, floats(values))).collect();
        channels.extend((!alpha.is_empty()).then(|| ("A", floats(alpha))));
        exr([2, 1], channels)
    };
    let opaque = read_exr(&channels(&[]), &[], false).unwrap().buffer;
    assert_eq!(opaque.kind(), "picture without coverage");
    let steps = |buffer: &Buffer, pixel| buffer.color([0, pixel]).unwrap().0;
    // Half of the light is 188 in sRGB; what is beyond black and white stays different from them.
    let [red, green, blue, _] = steps(&opaque, 1);
    assert_eq!((bytes([red]), green, blue), ([188], -255.0, 255.0));
    assert!(steps(&opaque, 0)[2] > 400.0);
    let with_alpha = read_exr(&channels(&[0.5, 0.0]), &[], false).unwrap().buffer;
    assert_eq!([0, 1].map(|pixel| with_alpha.covered(pixel)), [Some(true), Some(false)]);
    assert_eq!(steps(&with_alpha, 0)[0], steps(&opaque, 1)[0]);
    let problem = read_exr(&exr([1, 1], vec![("Y", floats(&[f32::NAN]))]), &[], false).unwrap_err();
    assert!(
        problem.contains("the colour at (0, 0) is NaN; colours are finite numbers"),
        "{problem}"
    );
}

#[test]
fn ids_may_be_floats_if_they_are_whole() {
    let file = |values: &[f32]| exr([2, 1], vec![("IndexOB.X", floats(values))]);
    let ids = read_exr(&file(&[3.0, -1.0]), &[], false).unwrap().buffer;
    assert_eq!(ids.content(), &Content::Ids(vec![Some(3), None]));
    let problem = read_exr(&file(&[3.0, 0.5]), &[], false).unwrap_err();
    assert!(problem.contains("the id at (0, 1) is 0.5; ids are whole numbers from 0"), "{problem}");
}

#[test]
fn normals_have_names_or_negative_values() {
    let named = [("normal.X", [1.0, 0.0]), ("normal.Y", [0.0; 2]), ("normal.Z", [0.0; 2])];
    let file = exr([2, 1], named.map(|(name, values)| (name, floats(&values))).to_vec());
    let expected = Content::Normals(vec![[1.0, 0.0, 0.0], [0.0; 3]]);
    assert_eq!(read_exr(&file, &[], false).unwrap().buffer.content(), &expected);
    let colors = |sign: f32| {
        let values = [("R", [0.0, 0.6]), ("G", [0.0, 0.0]), ("B", [sign, 0.8])];
        exr([2, 1], values.map(|(name, values)| (name, floats(&values))).to_vec())
    };
    assert_eq!(read_exr(&colors(-1.0), &[], false).unwrap().buffer.kind(), "normals");
    assert_eq!(
        read_exr(&colors(1.0), &[], false).unwrap().buffer.kind(),
        "picture without coverage"
    );
    assert_eq!(read_exr(&colors(1.0), &[], true).unwrap().buffer.kind(), "normals");
}

#[test]
fn damaged_files_end_in_one_message() {
    let whole = exr([64, 64], vec![("Z", floats(&[1.0; 4096]))]);
    let problem = |bytes: &[u8]| read_exr(bytes, &[], false).unwrap_err();
    for length in [whole.len() - 1, whole.len() / 2, 100, 9] {
        let said = problem(&whole[..length]);
        let expected =
            format!("the file ends early, after {length} bytes; copy it or write it again");
        assert!(said.ends_with(&expected), "{said}");
    }
    // A size that the few bytes cannot hold, in data window and display window. Without the number of chunks, which a
    // file of one part may leave out, nothing contradicts it.
    let claims = |width: i32, height: i32| {
        let mut bytes = whole.clone();
        let count = bytes.windows(10).position(|bytes| bytes == b"chunkCount").unwrap();
        bytes[count..count + 5].copy_from_slice(b"other");
        let corner = [63_i32, 63].map(i32::to_le_bytes).concat();
        let claimed = [width - 1, height - 1].map(i32::to_le_bytes).concat();
        for at in 0..bytes.len() - 8 {
            if bytes[at..at + 8] == corner[..] {
                bytes[at..at + 8].copy_from_slice(&claimed);
            }
        }
        problem(&bytes)
    };
    let said = claims(30_000, 30_000);
    assert!(said.contains("bytes cannot fill 30000 x 30000 pixels of 1 channels"), "{said}");
    assert!(claims(100_000, 100_000).contains("is 100000x100000 with"));
    let negative = claims(-5, 7);
    assert!(negative.contains("the EXR is damaged ("), "{negative}");
}

#[test]
fn a_crop_is_read_and_overscan_is_refused() {
    let read = |shown: usize, position| {
        let bytes = with_windows(shown, position);
        read_exr(&bytes, &[], false)
    };
    let crop = read(4, 1).unwrap();
    assert_eq!(crop.buffer.size(), [3, 2]);
    assert_eq!(crop.notes, ["channel Z", "its crop at (0, 1) of 4 x 2"]);
    let said =
        "its data window (3 x 2 from (0, 1) on) is not its display window (3 x 2 from (0, 0) on)";
    for problem in [
        read(3, 1).unwrap_err(),
        read(4, -1).unwrap_err().replace("-1", "1").replace("4 x 2", "3 x 2"),
    ] {
        assert!(problem.contains(said), "{problem}");
    }
}

/// A file of 3 x 2 pixels that begin at a column, shown in a window of another width.
fn with_windows(shown: usize, column: i32) -> Vec<u8> {
    let channels =
        AnyChannels::sort([AnyChannel::new("Z", floats(&[1.0; 6]))].into_iter().collect());
    let attributes = LayerAttributes::default().with_position(Vec2(column, 0));
    let layer = Layer::new((3, 2), attributes, Encoding::UNCOMPRESSED, channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut image = Image::from_layer(layer);
    image.attributes.display_window = IntegerBounds::from_dimensions((shown, 2));
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any damage to a file gives an answer, never a panic.
    #[test]
    fn damaged_files_are_answered(
        tiled in any::<bool>(),
        compression in 0..5_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        end in any::<prop::sample::Index>(),
        cut in any::<bool>(),
    ) {
        let blocks = if tiled { Blocks::Tiles(Vec2(2, 2)) } else { Blocks::ScanLines };
        let compression = [
            Compression::Uncompressed,
            Compression::RLE,
            Compression::ZIP16,
            Compression::PIZ,
            Compression::B44,
        ][compression];
        let channels = vec![("Z", floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]))];
        let mut bytes = exr_in([3, 2], channels, compression, blocks);
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if cut {
            bytes.truncate(end.index(bytes.len()));
        }
        if let Err(problem) = read_exr(&bytes, &[], false) {
            prop_assert!(problem.len() < 600 && problem.contains("; "), "{}", problem);
        }
    }
}
