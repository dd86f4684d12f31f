//! Files and buffers made by hand, and the messages about them.

mod exr;
mod hostile;
mod options;
mod pictures;

use super::*;
use crate::diff::Class;
use image::{DynamicImage, GrayAlphaImage, GrayImage, ImageBuffer, ImageFormat, Luma, RgbaImage};
use proptest::prelude::*;
use std::path::Path;

/// A NumPy array in a form that any program may write.
fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), data].concat()
}

fn read_bytes(bytes: &[u8], background: Option<[u8; 3]>) -> Result<Buffer<'static>, String> {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("file");
    std::fs::write(&path, bytes).unwrap();
    read(&path, background).map_err(|error| error.to_string())
}

fn read_npy(descr: &str, shape: &str, data: &[u8]) -> Buffer<'static> {
    read_bytes(&npy(descr, false, shape, data), None).unwrap()
}

fn read_image(image: impl Into<DynamicImage>, format: ImageFormat) -> Buffer<'static> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).unwrap();
    read_bytes(bytes.get_ref(), None).unwrap()
}

fn ids(size: [u32; 2], drawn: &str) -> Buffer<'static> {
    let ids = drawn.chars().map(|letter| letter.to_digit(10).map(u64::from)).collect();
    Buffer::new(size, 1, Content::Ids(ids))
}

fn distances(t: &[f64]) -> Buffer<'static> {
    let width = u32::try_from(t.len()).unwrap();
    Buffer::new([width, 1], 1, Content::Distances(t.to_vec()))
}

fn colors(pixels: &[[f32; 4]], covered: Covered) -> Buffer<'static> {
    let picture = Picture { pixels: Pixels::Steps(pixels.to_vec()), covered };
    Buffer::new([u32::try_from(pixels.len()).unwrap(), 1], 1, Content::Picture(picture))
}

#[test]
fn integers_of_every_size_are_ids_and_all_ones_are_nothing() {
    let expected = Content::Ids(vec![Some(0), Some(5), None]);
    for (descr, width) in [("i1", 1), ("u1", 1), ("i2", 2), ("u2", 2), ("i4", 4), ("u8", 8)] {
        let value = |id: i64| id.to_le_bytes()[..width].to_vec();
        let little: Vec<u8> = [0, 5, -1].into_iter().flat_map(value).collect();
        let big: Vec<u8> =
            [0, 5, -1].into_iter().flat_map(|id| value(id).into_iter().rev()).collect();
        assert_eq!(read_npy(&format!("'<{descr}'"), "(1, 3)", &little).content(), &expected);
        assert_eq!(read_npy(&format!("'>{descr}'"), "(1, 3)", &big).content(), &expected);
    }
}

#[test]
fn floats_of_every_size_are_distances() {
    let expected = Content::Distances(vec![1.5, -2.0, f64::INFINITY]);
    let halves = [0x3e00_u16, 0xc000, 0x7c00].map(u16::to_le_bytes).concat();
    assert_eq!(read_npy("'<f2'", "(1, 3)", &halves).content(), &expected);
    let singles = [1.5, -2.0, f32::INFINITY].map(f32::to_be_bytes).concat();
    assert_eq!(read_npy("'>f4'", "(1, 3)", &singles).content(), &expected);
    let doubles = [1.5, -2.0, f64::INFINITY].map(f64::to_le_bytes).concat();
    assert_eq!(read_npy("'<f8'", "(1, 3, 1)", &doubles).content(), &expected);
    // The smallest half float, the largest half float, and one third.
    let halves = [0x0001_u16, 0x7bff, 0x3555].map(u16::to_le_bytes).concat();
    let expected = Content::Distances(vec![2.0_f64.powi(-24), 65_504.0, 0.333_251_953_125]);
    assert_eq!(read_npy("'<f2'", "(1, 3)", &halves).content(), &expected);
}

#[test]
fn booleans_are_masks_and_columns_may_come_first() {
    let mask = read_npy("'|b1'", "(2, 3)", &[1, 0, 0, 1, 1, 0]);
    assert_eq!((mask.size(), mask.kind()), ([3, 2], "mask"));
    let fortran = npy("'|b1'", true, "(2, 3)", &[1, 1, 0, 1, 0, 0]);
    assert_eq!(read_bytes(&fortran, None), Ok(mask));
}

#[test]
fn arrays_have_samples_or_channels() {
    let samples = read_npy("'|u1'", "(1, 2, 2, 2)", &[0, 1, 2, 3, 4, 5, 6, 255]);
    assert_eq!((samples.size(), samples.samples()), ([2, 1], 2));
    assert_eq!(samples.seen([0, 1]), "id 4, id 5, id 6, nothing");

    let rgb = read_npy("'|u1'", "(1, 2, 3)", &[1, 2, 3, 4, 5, 6]);
    assert_eq!(rgb.kind(), "picture without coverage");
    assert_eq!(rgb.seen([0, 1]), "#040506");
    let floats = [0.0, 1.0, 0.2, 0.0].map(f32::to_le_bytes).concat();
    let rgba = read_npy("'<f4'", "(1, 1, 4)", &floats);
    assert_eq!((rgba.kind(), rgba.seen([0, 0])), ("picture with alpha", "nothing".into()));
}

#[test]
fn sixteen_bits_of_a_picture_are_kept() {
    let deep = ImageBuffer::from_fn(3, 1, |x, _| Luma([[0_u16, 1, 514][x as usize]]));
    for format in [ImageFormat::Png, ImageFormat::Pnm] {
        let grey = read_image(DynamicImage::ImageLuma16(deep.clone()), format);
        let Content::Picture(picture) = grey.content() else { panic!("a mask") };
        assert_eq!(picture.pixels.iter().map(|p| p[0] * 257.0).collect::<Vec<_>>(), [0., 1., 514.]);
        assert_eq!(
            (0..3).map(|p| grey.covered(p).unwrap()).collect::<Vec<_>>(),
            [false, true, true]
        );
    }
}

#[test]
fn two_greys_are_a_mask_whatever_its_white_is() {
    for white in [1, 255] {
        let grey = GrayImage::from_raw(3, 1, vec![0, white, 0]).unwrap();
        let mask = read_image(grey, ImageFormat::Png);
        assert_eq!(mask.content(), &Content::Mask(vec![false, true, false].into()));
    }
}

#[test]
fn alpha_tells_what_is_covered() {
    let grey = GrayAlphaImage::from_raw(2, 1, vec![9, 0, 9, 1]).unwrap();
    let grey = read_image(grey, ImageFormat::Png);
    assert_eq!([0, 1].map(|pixel| grey.covered(pixel)), [Some(false), Some(true)]);
    let rgba = RgbaImage::from_raw(1, 1, vec![1, 2, 3, 4]).unwrap();
    assert_eq!(read_image(rgba, ImageFormat::Png).seen([0, 0]), "#01020304");
}

#[test]
fn a_background_tells_what_is_not_covered() {
    let bytes = npy("'|u1'", false, "(1, 2, 3)", &[1, 2, 3, 4, 5, 6]);
    let picture = read_bytes(&bytes, Some([4, 5, 6])).unwrap();
    assert_eq!([0, 1].map(|pixel| picture.covered(pixel)), [Some(true), Some(false)]);
}

#[test]
fn bad_files_are_refused_with_their_reason() {
    let huge = "(9223372036854775807, 9223372036854775807)";
    let nan = f32::NAN.to_le_bytes().repeat(3);
    let refused: [(Vec<u8>, &str); 18] = [
        (b"hello".to_vec(), "neither a picture"),
        (Vec::new(), "is empty; write it again"),
        (b"PK\x03\x04...".to_vec(), ".npz"),
        (b"\x89PNG\r\n\x1a\nrubbish".to_vec(), "ends early, after 15 bytes; copy it"),
        (b"\x93NUMPY\x01\x00".to_vec(), "ends early, after 8 bytes; copy it"),
        (npy(&"(".repeat(60_000), false, "(2, 3)", &[]), "more than the 10000 that any array"),
        (npy(&"()".repeat(70), false, "(2, 3)", &[]), "too many parts"),
        (
            npy(&format!("{}'<u1'{}", "[".repeat(20), "]".repeat(20)), false, "(1, 1)", &[0]),
            "too many parts",
        ),
        (
            npy("'|u1'", false, "(-1, 6)", &[0; 6]),
            "shape (-1, 6), where -1 is no number of rows, columns",
        ),
        (
            npy("<u1", false, "(1, 6)", &[0; 6]),
            "from byte 10 on, is none that NumPy writes ({'descr': <u1, 'fo",
        ),
        (npy("'<u4'", false, "(2, 3)", &[0; 23]), "23 of the 24 bytes"),
        (npy("'<u4'", false, "(6,)", &[0; 24]), "shape [6]; pixels are H x W"),
        (npy("'<u4'", false, "(0, 3)", &[]), "the image is 3x0"),
        (npy("'<u4'", false, huge, &[]), "more than 1073741824 samples"),
        (npy("'<c8'", false, "(1, 1)", &[0; 8]), "dtype is '<c8'"),
        (npy("[('id', '<u4')]", false, "(1, 1)", &[0; 4]), "dtype is [('id', '<u4')"),
        (npy("'|i1'", false, "(1, 2)", &[0, 254]), "the id at (0, 1) is negative"),
        (npy("'<f4'", false, "(1, 1, 3)", &nan), "the colour at (0, 0) is NaN"),
    ];
    for (bytes, reason) in refused {
        let problem = read_bytes(&bytes, None).unwrap_err();
        assert!(problem.contains(reason), "{problem}");
    }
    let missing = read(Path::new("no/such/file.png"), None).unwrap_err().to_string();
    assert!(missing.starts_with("cannot read no/such/file.png"), "{missing}");
}

#[test]
fn shapes_may_have_the_l_of_python_2() {
    let buffer = read_npy("'|u1'", "(2L, 3L)", &[0, 1, 2, 3, 4, 5]);
    assert_eq!((buffer.size(), buffer.kind()), ([3, 2], "ids"));
}

/// A PNG with these chunks.
fn png(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let chunk = |(name, content): &(&[u8; 4], &[u8])| {
        let length = u32::try_from(content.len()).unwrap().to_be_bytes();
        let covered = [&name[..], content].concat();
        let checksum = crc32fast::hash(&covered).to_be_bytes();
        [&length[..], &covered, &checksum].concat()
    };
    let chunks: Vec<u8> = chunks.iter().flat_map(chunk).collect();
    [b"\x89PNG\r\n\x1a\n", &chunks[..]].concat()
}

/// A PNG that claims this size, with this palette and the data of one pixel.
fn palette_png(size: [u32; 2], palette: &[u8]) -> Vec<u8> {
    let header = [&size[0].to_be_bytes()[..], &size[1].to_be_bytes(), &[8, 3, 0, 0, 0]].concat();
    // One row of one pixel: a zlib stream of one stored block.
    let pixels = [0x78, 0x01, 0x01, 2, 0, 0xfd, 0xff, 0, 1, 0, 3, 0, 2];
    png(&[(b"IHDR", &header), (b"PLTE", palette), (b"IDAT", &pixels), (b"IEND", &[])])
}

#[test]
fn palettes_have_three_bytes_a_color() {
    assert!(read_bytes(&palette_png([1, 1], &[0; 6]), None).is_ok());
    for length in [0, 1, 4, 5, 767, 771] {
        let problem = read_bytes(&palette_png([1, 1], &vec![0; length]), None).unwrap_err();
        let said =
            format!("PLTE at byte 33 of the PNG) has {length} bytes; it must have 3 for each");
        assert!(problem.contains(&said), "{problem}");
    }
}

#[test]
fn damages_of_a_png_have_their_place() {
    let whole = palette_png([1, 1], &[0; 6]);
    let mut bent = whole.clone();
    bent[42] ^= 1;
    let problem = read_bytes(&bent, None).unwrap_err();
    assert!(problem.contains("chunk PLTE at byte 33 of the PNG has a wrong checksum"), "{problem}");
    let problem = read_bytes(&whole[..60], None).unwrap_err();
    assert!(
        problem.ends_with("ends early, after 60 bytes; copy it or write it again"),
        "{problem}"
    );
    let more = read_bytes(&palette_png([3, 5], &[0; 6]), None).unwrap_err();
    assert!(more.contains("the pixels of the PNG are damaged; copy the file or save"), "{more}");
}

#[test]
fn what_a_png_lacks_is_named() {
    /// A header of one pixel.
    fn header(width: u8, depth: u8, color: u8) -> [u8; 13] {
        [0, 0, 0, width, 0, 0, 0, 1, depth, color, 0, 0, 0]
    }
    let pixels = [0x78, 0x01, 0x01, 2, 0, 0xfd, 0xff, 0, 1, 0, 3, 0, 2];
    let said = |header: [u8; 13], pixels: &[(&[u8; 4], &[u8])]| {
        let chunks = [&[(b"IHDR", &header[..])], pixels, &[(b"IEND", &[][..])]].concat();
        read_bytes(&png(&chunks), None).map(|_| ()).unwrap_err()
    };
    let some: &[(&[u8; 4], &[u8])] = &[(b"IDAT", &pixels)];
    let cases = [
        (said(header(1, 8, 3), some), "colour type 3, but no palette (no chunk PLTE) before its"),
        (
            said(header(0, 8, 0), some),
            "the image is 0x1; both sides need at least 1 pixel; save it",
        ),
        (said(header(1, 7, 2), some), "bit depth 7, but with colour type 2 only 8, 16 are known"),
        (said(header(1, 8, 5), some), "colour type 5, but only 0, 2, 3, 4 and 6 are known"),
        (said(header(1, 8, 0), &[]), "has no pixels (no chunk IDAT); copy the file or save it"),
    ];
    for (problem, said) in cases {
        assert!(problem.contains(said), "{problem}");
    }
}

#[test]
fn a_picture_that_is_too_large_has_a_remedy() {
    let wide = [&[0, 1, 0, 1][..], &[0, 0, 0, 1, 8, 0, 0, 0, 0]].concat();
    let pixels = [0x78, 0x01, 0x01, 2, 0, 0xfd, 0xff, 0, 1, 0, 3, 0, 2];
    let file = png(&[(b"IHDR", &wide), (b"IDAT", &pixels), (b"IEND", &[])]);
    let problem = read_bytes(&file, None).unwrap_err();
    assert!(problem.contains("is 65537x1 with") && problem.ends_with("; compare parts of it"));
}

#[test]
fn few_bytes_claim_no_memory() {
    let problem = read_bytes(&palette_png([32_768, 32_768], &[0; 6]), None).unwrap_err();
    let said =
        "its 32768 x 32768 pixels need 7168 MiB of memory, and a picture may take 2048; compare";
    assert!(problem.contains(said), "{problem}");
    // A run-length BMP of 8 bits: its palette, and the end of the picture.
    let number = |number: u32| number.to_le_bytes();
    let header = [40, 10_000, 10_000, 1 | 8 << 16, 1, 2, 0, 0, 2, 0].map(number).concat();
    let start = [62 + 2, 0, 62].map(number).concat();
    let bmp = [b"BM", &start[..], &header, &[0; 8], &[0, 1]].concat();
    let problem = read_bytes(&bmp, None).unwrap_err();
    let said =
        "a run-length BMP of 64 bytes cannot fill 10000 x 10000 pixels; if the file is complete";
    assert!(problem.contains(said), "{problem}");
}

#[test]
fn pictures_that_end_early_say_so() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    DynamicImage::from(GrayImage::new(4, 4)).write_to(&mut bytes, ImageFormat::Bmp).unwrap();
    let bmp = bytes.into_inner();
    let files =
        [bmp[..bmp.len() - 3].to_vec(), b"P5 4 4 255\nabc".to_vec(), b"P2 2 2 9\n1 2".to_vec()];
    for file in files {
        let problem = read_bytes(&file, None).unwrap_err();
        let said =
            format!("the file ends early, after {} bytes; copy it or write it again", file.len());
        assert!(problem.ends_with(&said), "{problem}");
    }
    let problem = read_bytes(b"P2 2 x 9\n1 2", None).unwrap_err();
    assert!(
        problem.contains("the PNM is damaged (") && problem.contains("save it again"),
        "{problem}"
    );
}

#[test]
fn coverage_and_ids_are_counted() {
    let (a, b) = (ids([3, 2], "01.22."), ids([3, 2], "0.123."));
    let comparison = compare(&a, &b).unwrap();
    let coverage = comparison.coverage.unwrap();
    assert_eq!((coverage.a, coverage.b, coverage.both), (4, 4, 3));
    assert_eq!((coverage.only_a, coverage.only_b, coverage.matches), (1, 1, false));
    assert_eq!(comparison.ids, Some(BufferIds { differing_samples: 1, differing_pixels: 1 }));
    assert_eq!(comparison.first_differing, [[0, 1], [0, 2], [1, 1]]);
    assert_eq!(comparison.region, Some([0, 1, 2, 2]));
    let colors: Vec<[u8; 3]> = comparison.picture().pixels().map(|pixel| pixel.0).collect();
    assert_eq!(colors[1..3], [[0xe6, 0x9f, 0x00], [0x00, 0x72, 0xb2]]);
    assert_eq!(colors[3..5], [[0x58; 3], [0xcc, 0x79, 0xa7]]);
    assert!(compare(&a, &a).unwrap().equal);
}

#[test]
fn distances_are_compared_within_tolerance() {
    let a = distances(&[1.0, 2.0, f64::INFINITY, 0.0, f64::MAX]);
    let b = distances(&[1.0 + 1e-6, 2.5, f64::NAN, -0.0, -f64::MAX]);
    let comparison = compare(&a, &b).unwrap();
    let depth = comparison.depth.unwrap();
    assert_eq!((depth.max_relative_difference, depth.at), (2.0, Some([0, 4])));
    assert_eq!((depth.differing_pixels, comparison.differing_pixels), (2, 2));
    assert_eq!(comparison.coverage.unwrap().both, 4);
    assert!(compare(&distances(&[1.0]), &distances(&[1.0 + 9e-6])).unwrap().equal);
}

#[test]
fn colors_are_compared_where_neither_says_nothing() {
    let a = colors(&[[0.0, 9.0, 0.0, 255.0], [1.0; 4], [7.0; 4]], Covered::Unknown);
    let b = colors(&[[0.0, 6.5, 0.0, 9.0], [3.0; 4], [0.0; 4]], Covered::ByAlpha);
    let comparison = compare(&a, &b).unwrap();
    assert_eq!(comparison.compared, [Aspect::Color]);
    assert_eq!(comparison.not_compared, ["coverage: only B tells"]);
    let expected = BufferColor { max_difference: 2.5, at: Some([0, 0]), differing_pixels: 1 };
    assert_eq!(comparison.color, Some(expected));
}

#[test]
fn other_numbers_of_samples_are_compared_by_pixel() {
    let fine = Content::Ids(vec![Some(3), None, None, None, None, None, None, None]);
    let fine = Buffer::new([2, 1], 2, fine);
    let comparison = compare(&fine, &ids([2, 1], "1.")).unwrap();
    assert_eq!(comparison.coverage.unwrap().unit, Unit::Pixels);
    assert_eq!((comparison.equal, comparison.ids), (true, None));
    assert_eq!(comparison.not_compared, ["ids: A has 2 x 2 samples a pixel, B 1 x 1"]);
    assert_eq!(fine.seen([0, 0]), "id 3, nothing (x3)");
}

#[test]
fn what_cannot_be_compared_is_named() {
    let problem = |a: &Buffer, b: &Buffer| compare(a, b).unwrap_err().to_string();
    let sizes = problem(&ids([3, 2], "......"), &ids([2, 3], "......"));
    assert!(sizes.contains("A is 3 x 2 pixels and B is 2 x 3"), "{sizes}");
    assert!(sizes.contains("swapped"), "{sizes}");
    let nothing = problem(&ids([1, 1], "0"), &colors(&[[0.0; 4]], Covered::Unknown));
    assert!(nothing.contains("--background"), "{nothing}");
}

#[test]
fn common_mistakes_are_recognised() {
    let hint = |a: &Buffer, b: &Buffer| compare(a, b).unwrap().hints.join("; ");
    let a = ids([2, 2], "01..");
    assert!(hint(&a, &ids([2, 2], "..01")).contains("turned upside down"));
    assert!(hint(&a, &ids([2, 2], "10..")).contains("turned left to right"));
    let row = ids([4, 1], "01..");
    assert!(hint(&row, &ids([4, 1], ".01.")).contains("moved 1 column to the left"));
    assert!(hint(&a, &ids([2, 2], "12..")).contains("0 in A is 1 in B, 1 in A is 2 in B"));
    let from_1 = hint(&a, &ids([2, 2], "1200"));
    assert!(from_1.contains("in B, 0 stands for nothing: ids count from 0"), "{from_1}");
    assert!(hint(&a, &ids([2, 2], "..00")).contains("exactly what A does not"));
    assert_eq!(hint(&a, &ids([2, 2], "0.0.")), "");
}

/// A mask of bools.
fn mask(size: [u32; 2], drawn: &str) -> Buffer<'static> {
    let mask: Vec<bool> = drawn.chars().map(|letter| letter == '#').collect();
    Buffer::new(size, 1, Content::Mask(mask.into()))
}

fn hints(a: &Buffer, b: &Buffer) -> Vec<String> {
    let hints = compare(a, b).unwrap().hints;
    // The hints do not depend on the order of the files.
    assert_eq!(hints.len(), compare(b, a).unwrap().hints.len(), "{hints:?}");
    hints
}

#[test]
fn every_turn_is_recognised_and_no_other() {
    let a = ids([3, 3], "012345678");
    let turned = [
        ("678345012", "turned upside down"),
        ("210543876", "turned left to right"),
        ("876543210", "turned by 180 degrees"),
        ("036147258", "transposed (its rows are A's columns)"),
        ("852741630", "mirrored at the diagonal from the bottom left to the top right"),
        ("630741852", "turned by 90 degrees to the left"),
        ("258147036", "turned by 90 degrees to the right"),
    ];
    for (drawn, name) in turned {
        let hints = hints(&a, &ids([3, 3], drawn));
        assert_eq!(hints[0], format!("B agrees with A once it is {name}"));
        // Every id also has one other id in its place.
        assert_eq!(hints.len(), 2, "{hints:?}");
        assert!(hints[1].starts_with("the ids correspond one to one"), "{hints:?}");
    }
}

#[test]
fn a_symmetric_picture_cannot_tell_a_transposition_from_a_half_turn() {
    let (a, b) = (mask([3, 3], "##.#....."), mask([3, 3], ".....#.##"));
    let found = hints(&a, &b);
    assert_eq!(
        found,
        [
            "B agrees with A once it is turned by 180 degrees",
            "B agrees with A once it is mirrored at the diagonal from the bottom left to the top right",
        ]
    );
}

#[test]
fn what_enters_at_the_border_is_explained_by_no_move() {
    // Two rows and columns, and three: where edges are inclusive, it looks like a move inside.
    let (two, three) = (mask([4, 4], "##..##.........."), mask([4, 4], "###.###.###....."));
    assert_eq!(hints(&two, &three), [""; 0]);
    let (two, moved) = (mask([3, 3], "##.##...."), mask([3, 3], "....##.##"));
    let found = hints(&two, &moved);
    assert!(found.iter().any(|hint| hint.contains("moved 1 row up and 1 column to the left")));
    assert!(found.iter().any(|hint| hint.contains("180 degrees")), "{found:?}");
}

#[test]
fn a_move_by_several_pixels_is_recognised_where_none_by_one_explains() {
    let drawn = |rows: &str| ids([6, 5], &rows.replace(' ', ""));
    let a = drawn("...... .01... .23... ...... ......");
    let moved = |rows: &str| hints(&a, &drawn(rows));
    let said = moved("...... ...... ...... ...01. ...23.");
    assert_eq!(said, ["B agrees with A once it is moved 2 rows up and 2 columns to the left"]);
    let said = moved("01.... 23.... ...... ...... ......");
    let one = "moved 1 row down and 1 column to the right; where edges lie on samples, half a pixel does that";
    assert_eq!(said, [format!("B agrees with A once it is {one}")]);
    assert_eq!(
        moved("...... ....01 ....23 ...... ......")[0],
        "B agrees with A once it is moved 3 columns to the left"
    );
    // A part that leaves the picture is no move.
    assert_eq!(moved("...... ...... ...... ...... ...01."), [""; 0]);
}

#[test]
fn rows_for_columns_in_a_picture_that_is_not_square_are_recognised() {
    let a = ids([3, 2], "012.45");
    for (drawn, name) in [
        ("0.1425", "transposed (its rows are A's columns)"),
        ("5241.0", "mirrored at the diagonal from the bottom left to the top right"),
        (".04152", "turned by 90 degrees to the left"),
        ("25140.", "turned by 90 degrees to the right"),
    ] {
        let b = ids([2, 3], drawn);
        assert_eq!(
            exchanged_sides(&a, &b),
            [format!("B agrees with A once it is {name}")],
            "{drawn}"
        );
    }
    assert!(exchanged_sides(&a, &ids([2, 3], "0.1.25")).is_empty());
    assert!(exchanged_sides(&a, &a).is_empty());
}

#[test]
fn masks_are_not_told_to_be_saved_as_bool() {
    let (a, b) = (mask([2, 1], "#."), mask([2, 1], ".#"));
    assert!(hints(&a, &b).iter().all(|hint| !hint.contains("bool")));
    assert!(hints(&a, &b).contains(&"B covers exactly what A does not".to_owned()));
    // The values 0 and 255 of a byte.
    let integers = ids([2, 1], ".0");
    assert!(hints(&a, &integers).iter().any(|hint| hint.contains("save it as bool")));
    let integers = ids([2, 1], "10");
    assert!(hints(&a, &integers).iter().any(|hint| hint.contains("save it as bool")));
}

#[test]
fn a_primitive_that_is_missing_is_named_and_not_blamed_on_the_other_file() {
    let (a, b) = (ids([3, 1], "012"), ids([3, 1], ".12"));
    assert_eq!(
        hints(&a, &b),
        [
            "B never shows the primitive 0 of A, and agrees elsewhere: culled, cut off, not \
             drawn, or missed between samples?",
            "in A, 0 stands for nothing: write the largest number of the type, or -1",
        ]
    );
    assert_eq!(hints(&a, &ids([3, 1], "0.2")).len(), 1);
    let nothing = "B covers nothing: is all of it culled, cut off, behind the eye, or missed between samples?";
    assert_eq!(hints(&a, &ids([3, 1], "...")), [nothing]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Any damage to a file gives an answer, never a panic.
    #[test]
    fn damaged_files_are_answered(
        which in 0..4_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        end in any::<prop::sample::Index>(),
        cut in any::<bool>(),
    ) {
        let mut bytes = match which {
            0 => npy("'<u4'", false, "(2, 3)", &[7; 24]),
            1 => npy("'>f8'", true, "(1, 2, 2, 2)", &[63; 64]),
            2 => b"P6 2 1 255 abcdef".to_vec(),
            _ => {
                let mut png = std::io::Cursor::new(Vec::new());
                RgbaImage::new(3, 2).write_to(&mut png, ImageFormat::Png).unwrap();
                png.into_inner()
            }
        };
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if cut {
            bytes.truncate(end.index(bytes.len()));
        }
        if let Ok(buffer) = read_bytes(&bytes, None) {
            prop_assert!(compare(&buffer, &buffer).unwrap().equal);
        }
    }
}
