//! Palettes, bilevel pictures, JPEG and normals.

use super::*;

fn read_at(bytes: &[u8], options: &ReadOptions) -> Result<ReadBuffer, String> {
    let input = std::io::Cursor::new(bytes);
    read_from(Path::new("a"), input, options).map_err(|error| error.to_string())
}

/// A PNG of four pixels in one row, `depth` bits each, of this colour type.
fn tiny_png(depth: u8, color: u8, palette: &[u8], row: &[u8]) -> Vec<u8> {
    let header = [0, 0, 0, 4, 0, 0, 0, 1, depth, color, 0, 0, 0];
    let data = [&[0], row].concat();
    // One stored block in a zlib stream, whose checksum is Adler's.
    let length = u16::try_from(data.len()).unwrap();
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in &data {
        a = (a + u32::from(byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    let stream = [
        &[0x78, 0x01, 0x01][..],
        &length.to_le_bytes(),
        &(!length).to_le_bytes(),
        &data,
        &(b << 16 | a).to_be_bytes(),
    ]
    .concat();
    let mut chunks: Vec<(&[u8; 4], &[u8])> = vec![(b"IHDR", &header)];
    if !palette.is_empty() {
        chunks.push((b"PLTE", palette));
    }
    chunks.extend([(b"IDAT", &stream[..]), (b"IEND", &[])]);
    png(&chunks)
}

#[test]
fn bilevel_pictures_and_grey_palettes_are_masks() {
    let expected = Content::Mask(vec![false, true, true, false].into());
    let read = |bytes: &[u8]| read_bytes(bytes, None).unwrap();
    assert_eq!(read(&tiny_png(1, 0, &[], &[0b0110_0000])).content(), &expected);
    assert_eq!(read(&tiny_png(2, 0, &[], &[0b0011_1100])).content(), &expected);
    let black_and_white = [0, 0, 0, 255, 255, 255];
    assert_eq!(read(&tiny_png(1, 3, &black_and_white, &[0b0110_0000])).content(), &expected);
    assert_eq!(read(&tiny_png(8, 3, &black_and_white, &[0, 1, 1, 0])).content(), &expected);
    // White may come first, and a colour makes a picture of it.
    let turned = [255, 255, 255, 0, 0, 0];
    assert_eq!(read(&tiny_png(1, 3, &turned, &[0b1001_0000])).content(), &expected);
    let colored = read(&tiny_png(1, 3, &[0, 0, 0, 255, 0, 0], &[0b0110_0000]));
    assert_eq!(
        (colored.kind(), colored.seen([0, 1])),
        ("picture without coverage", "#ff0000".into())
    );
}

/// A BMP of two rows of four pixels, with a palette of these colours, `0xRRGGBB`; its rows come from the bottom.
fn tiny_bmp(bits: u8, palette: &[u32], rows: [[u8; 4]; 2]) -> Vec<u8> {
    let pixels_at = 54 + 4 * u32::try_from(palette.len()).unwrap();
    let mut bytes = b"BM".to_vec();
    for number in [pixels_at + 8, 0, pixels_at, 40, 4, 2, 1 | u32::from(bits) << 16, 0, 0, 0, 0] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend(u32::try_from(palette.len()).unwrap().to_le_bytes());
    bytes.extend([0; 4]);
    palette.iter().for_each(|color| bytes.extend(color.to_le_bytes()));
    bytes.extend(rows.as_flattened());
    bytes
}

#[test]
fn bilevel_and_grey_bmp_files_are_masks() {
    let expected = Content::Mask(vec![false, true, true, false, true, false, false, true].into());
    let read = |bytes: &[u8]| read_bytes(bytes, None).unwrap();
    let [black_and_white, red] = [[0, 0xff_ffff], [0, 0xff_0000]];
    let bilevel = [[0b1001_0000, 0, 0, 0], [0b0110_0000, 0, 0, 0]];
    assert_eq!(read(&tiny_bmp(1, &black_and_white, bilevel)).content(), &expected);
    let bytes = [[1, 0, 0, 1], [0, 1, 1, 0]];
    assert_eq!(read(&tiny_bmp(8, &black_and_white, bytes)).content(), &expected);
    assert_eq!(read(&tiny_bmp(8, &red, bytes)).kind(), "picture without coverage");
}

fn jpeg(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Jpeg).unwrap();
    bytes.into_inner()
}

#[test]
fn a_jpeg_is_read_with_a_warning() {
    let disk = GrayImage::from_fn(32, 32, |x, y| {
        Luma([if x.abs_diff(16).pow(2) + y.abs_diff(16).pow(2) < 100 { 255 } else { 0 }])
    });
    let read = read_at(&jpeg(disk), &ReadOptions::default()).unwrap();
    // Around the disk, compression leaves greys: this is no mask any more.
    assert_eq!(read.buffer.kind(), "grey picture");
    assert!(read.warnings[0].starts_with("JPEG changes pixels"), "{:?}", read.warnings);
    assert_eq!(
        read_at(&npy("'|b1'", false, "(1, 1)", &[1]), &ReadOptions::default()).unwrap().warnings,
        [""; 0]
    );
}

#[test]
fn a_jpeg_that_ends_early_or_claims_too_much_is_refused() {
    let whole = jpeg(image::RgbImage::from_pixel(64, 64, image::Rgb([1, 2, 3])));
    let problem = |bytes: &[u8]| read_at(bytes, &ReadOptions::default()).unwrap_err();
    for length in [whole.len() - 1, whole.len() / 2, 20] {
        let said = problem(&whole[..length]);
        assert!(said.contains(&format!("ends early, after {length} bytes")), "{said}");
    }
    // The height and the width follow the marker of the frame, its length and the number of bits.
    let mut claims = whole.clone();
    let frame = claims.windows(2).position(|bytes| bytes == [0xff, 0xc0]).unwrap();
    claims[frame + 5..frame + 9].copy_from_slice(&[0x70, 0, 0x70, 0]);
    let said = problem(&claims);
    assert!(said.contains("bytes cannot fill 28672 x 28672 pixels"), "{said}");
}

#[test]
fn vectors_of_an_array_are_normals_or_colors() {
    let array = |vectors: &[[f32; 3]]| {
        let data: Vec<u8> = vectors.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
        npy("'<f4'", false, &format!("(1, {}, 3)", vectors.len()), &data)
    };
    let default = ReadOptions::default();
    let normals = read_at(&array(&[[0.0, 0.6, -0.8], [0.0; 3]]), &default).unwrap().buffer;
    assert_eq!(normals.content(), &Content::Normals(vec![[0.0, 0.6, -0.8], [0.0; 3]]));
    assert_eq!(normals.seen([0, 0]), "normal (0.0000 0.6000 -0.8000)");
    assert_eq!(normals.seen([0, 1]), "nothing");
    let colors = array(&[[0.0, 0.6, 0.8]]);
    assert_eq!(read_at(&colors, &default).unwrap().buffer.kind(), "picture without coverage");
    let options = ReadOptions { normals: true, ..default };
    assert_eq!(read_at(&colors, &options).unwrap().buffer.kind(), "normals");
    let problem = read_at(&npy("'|u1'", false, "(1, 1, 3)", &[1; 3]), &options).unwrap_err();
    assert!(problem.contains("normals are arrays of floats of the shape H x W x 3"), "{problem}");
    let problem = read_at(&jpeg(GrayImage::new(2, 2)), &options).unwrap_err();
    assert!(problem.contains("normals are read from floats"), "{problem}");
}

#[test]
fn normals_are_compared_by_their_angle() {
    let normals = |vectors: &[[f32; 3]]| {
        let width = u32::try_from(vectors.len()).unwrap();
        Buffer::new([width, 1], 1, Content::Normals(vectors.to_vec()))
    };
    let (sin, cos) = (0.05_f32.to_radians().sin(), 0.05_f32.to_radians().cos());
    let a = normals(&[[0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [0.0; 3], [1.0, 0.0, 0.0]]);
    let b = normals(&[[sin, 0.0, cos], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0]]);
    let comparison = compare(&a, &b).unwrap();
    assert_eq!(comparison.compared, [Aspect::Coverage, Aspect::Normals]);
    let expected = BufferNormals { max_degrees: 90.0, at: Some([0, 1]), differing_pixels: 1 };
    assert_eq!((comparison.normals, comparison.differing_pixels), (Some(expected), 2));
    let close = compare(&normals(&[[0.0, 0.0, 1.0]]), &normals(&[[sin, 0.0, cos]])).unwrap();
    assert!(close.equal && (close.normals.unwrap().max_degrees - 0.05).abs() < 1e-5);
    let tolerances = Tolerances { normals: 0.04, ..Tolerances::default() };
    let options = CompareOptions { tolerances, ..CompareOptions::default() };
    let close = compare_with(&normals(&[[0.0, 0.0, 1.0]]), &normals(&[[sin, 0.0, cos]]), &options);
    assert!(!close.unwrap().equal);
}
