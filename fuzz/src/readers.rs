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
