//! Pictures on surfaces that are damaged, or lie about their size: a picture or a short message, and never more texels than
//! the file can hold.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use bothways_formats::gltf;
use fastrand::Rng;
use std::fs;
use std::path::Path;

/// The most pixels that a byte of a file can stand for, in any format: a PNG of one bit a pixel, of which a byte stands for
/// 1032 bytes (RFC 1951). In memory a texel takes 12 bytes, and a third more with its smaller levels.
const MOST_TEXELS_A_BYTE: usize = 8 * 1032;

/// The number of texels, or the message.
fn read(picture: &[u8]) -> Result<usize, String> {
    let image = BASE64_STANDARD.encode(picture);
    let numbers = BASE64_STANDARD.encode([0; 36]);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"material":0}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]}},
        {{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{"source":0}}],"images":[{{"uri":"data:image/png;base64,{image}"}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],
        "buffers":[{{"byteLength":36,"uri":"data:application/octet-stream;base64,{numbers}"}}]}}"#
    );
    let model = gltf::parse("a.gltf", json.as_bytes()).map_err(|error| error.to_string())?;
    let mesh = model.shapes[0].mesh().unwrap();
    let material = mesh.materials().unwrap().of(0).unwrap().clone();
    Ok(material.texture.unwrap().pyramid.levels()[0].texels().len())
}

/// The small pictures that the fuzz targets start from.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/seeds/read_picture");
    let mut files: Vec<_> =
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    files.into_iter().map(|file| fs::read(file).unwrap()).collect()
}

/// A picture with a few bytes changed, left out, or there twice; in a PNG checksums are right again.
fn damaged(seed: &[u8], dice: &mut Rng) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..=dice.usize(..4) {
        let at = dice.usize(..bytes.len());
        match dice.usize(..6) {
            0 => bytes.truncate(at + 1),
            1 => drop(bytes.drain(at..(at + 1 + dice.usize(..9)).min(bytes.len()))),
            2 => bytes.insert(at, 0xff),
            3 => bytes[at] ^= 1 << dice.usize(..8),
            4 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][dice.usize(..5)],
            _ => {
                let part = bytes[at..(at + 1 + dice.usize(..20)).min(bytes.len())].to_vec();
                bytes.splice(at..at, part);
            }
        }
        if bytes.is_empty() {
            bytes.push(0);
        }
    }
    with_checksums(bytes)
}

/// With wrong checksums, the reader would never reach the content of the chunks.
fn with_checksums(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut at = 8;
    while bytes.starts_with(b"\x89PNG") && bytes.len() >= at + 12 {
        let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let end = at + 8 + length;
        if end + 4 > bytes.len() {
            break;
        }
        let checksum = crc32fast::hash(&bytes[at + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&checksum);
        at = end + 4;
    }
    bytes
}

#[test]
fn damaged_pictures_are_pictures_or_messages() {
    let (seeds, mut dice) = (seeds(), Rng::with_seed(21));
    assert!(seeds.len() > 10);
    let [mut read_some, mut refused] = [0_u32; 2];
    let rounds = if std::env::var_os("BOTHWAYS_LONG").is_some() { 1_000_000 } else { 50_000 };
    for round in 0..rounds {
        let picture = damaged(&seeds[round % seeds.len()], &mut dice);
        match read(&picture) {
            Ok(texels) => {
                assert!(texels <= MOST_TEXELS_A_BYTE * picture.len(), "{texels}: {picture:?}");
                read_some += 1;
            }
            Err(message) => {
                assert!(message.len() < 400, "{message}");
                assert!(!message.contains(char::is_control), "{message:?}");
                refused += 1;
            }
        }
    }
    assert!(read_some > 1000 && refused > 1000, "{read_some} read, {refused} refused");
}

#[test]
fn a_picture_that_lies_about_its_size_is_refused_before_there_is_memory_for_it() {
    let mut tried = 0;
    for seed in seeds() {
        let [at, is_png] = match &seed[..2] {
            b"BM" => [18, 0],
            b"\x89P" => [16, 1],
            _ => continue,
        };
        let mut lying = seed.clone();
        let side = if is_png == 1 { 11_000_u32.to_be_bytes() } else { 11_000_u32.to_le_bytes() };
        lying[at..at + 4].copy_from_slice(&side);
        lying[at + 4..at + 8].copy_from_slice(&side);
        let message = read(&with_checksums(lying)).unwrap_err();
        let said =
            ["cannot fill", "ends early", "damaged"].iter().any(|said| message.contains(said));
        assert!(said && message.len() < 400, "{message}");
        assert!(is_png == 0 || message.contains("cannot fill 11000 x 11000 pixels"), "{message}");
        tried += 1;
    }
    assert!(tried > 5, "{tried}");
}

/// The decoder multiplied beyond 32 bits here, as the fuzz target of pictures found.
#[test]
fn a_jpeg_whose_numbers_overflow_is_a_picture_or_a_message() {
    let jpeg = include_bytes!("files/fuzzed-overflow.jpg");
    match read(jpeg) {
        Ok(texels) => assert_eq!(texels, 3 * 62_978),
        Err(message) => assert!(message.len() < 300, "{message}"),
    }
}
