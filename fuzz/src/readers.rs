//! Checks the answers of file readers: a valid result, or a readable message.

use bothways_common::Mesh;
use bothways_formats::smooth;
use std::fmt::Display;

/// The most bytes of a message that people will read.
const LONGEST_MESSAGE: usize = 1200;

/// Checks that a message is short, and has no character that moves the cursor of a terminal or changes the direction of
/// text.
///
/// # Panics
///
/// If the message is long or has such a character.
pub fn check_message(error: &impl Display) {
    let message = error.to_string();
    assert!(message.len() <= LONGEST_MESSAGE, "{} bytes: {message:?}", message.len());
    let hostile =
        |c: char| c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    assert!(!message.contains(hostile), "{message:?}");
}

/// Checks that a mesh can be drawn: its positions are finite, its indices are valid, and normals can be computed for it.
///
/// # Panics
///
/// If it cannot.
pub fn check_mesh(mesh: Mesh) {
    let count = mesh.positions().len();
    assert!(mesh.positions().iter().all(|position| position.is_finite()));
    assert!(mesh.triangles().iter().flatten().all(|&vertex| (vertex as usize) < count));
    let triangles = mesh.triangles().len();
    assert_eq!(smooth::with_normals(mesh, smooth::CREASE).triangles().len(), triangles);
}

/// Corrects the checksums of all complete chunks of a PNG file. Other files stay as they are.
pub fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return bytes;
    }
    let mut at = 8;
    while let Some(&[a, b, c, d]) = bytes.get(at..at + 4) {
        let end = (at + 8).saturating_add(u32::from_be_bytes([a, b, c, d]) as usize);
        let Some(covered) = bytes.get(at + 4..end).filter(|_| end + 4 <= bytes.len()) else {
            break;
        };
        let checksum = crc32fast::hash(covered).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&checksum);
        at = end + 4;
    }
    bytes
}

/// A binary glTF file of one triangle, on which these bytes are a picture.
pub fn textured(picture: &[u8]) -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut data: Vec<u8> =
        corners.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
    let (positions, length) = (data.len(), picture.len());
    data.extend_from_slice(picture);
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"material":0}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}},
        {{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
        "textures":[{{"source":0}}],"images":[{{"bufferView":1,"mimeType":"image/png"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{positions}}},
        {{"buffer":0,"byteOffset":{positions},"byteLength":{length}}}],"buffers":[{{"byteLength":{}}}]}}"#,
        data.len()
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let size = |length: usize| u32::try_from(length).expect("inputs are small").to_le_bytes();
    let mut file = [&b"glTF"[..], &2_u32.to_le_bytes(), &size(28 + json.len() + data.len())].concat();
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &data)] {
        file.extend(size(chunk.len()));
        file.extend_from_slice(kind);
        file.extend_from_slice(chunk);
    }
    file
}
