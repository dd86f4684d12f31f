//! What must hold of every file reader: a sound answer, or a message that somebody can read.

use bothways_common::Mesh;
use bothways_formats::smooth;
use std::fmt::Display;

/// Longer messages are read by nobody.
const LONGEST_MESSAGE: usize = 1200;

/// A message is short, and nothing in it moves a terminal's cursor or turns its text around.
///
/// # Panics
///
/// If it does not keep to that.
pub fn check_message(error: &impl Display) {
    let message = error.to_string();
    assert!(message.len() <= LONGEST_MESSAGE, "{} bytes: {message:?}", message.len());
    let hostile = |c: char| {
        c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    assert!(!message.contains(hostile), "{message:?}");
}

/// A mesh that was read can be drawn: its triangles have corners, and normals can be made for it.
///
/// # Panics
///
/// If they have not.
pub fn check_mesh(mesh: Mesh) {
    let count = mesh.positions().len();
    assert!(mesh.positions().iter().all(|position| position.is_finite()));
    assert!(mesh.triangles().iter().flatten().all(|&vertex| (vertex as usize) < count));
    let triangles = mesh.triangles().len();
    assert_eq!(smooth::with_normals(mesh, smooth::CREASE).triangles().len(), triangles);
}

/// A PNG whose chunks have the right checksums, as far as there are chunks; anything else as it is.
pub fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return bytes;
    }
    let mut at = 8;
    while let Some(&[a, b, c, d]) = bytes.get(at..at + 4) {
        let end = (at + 8).saturating_add(u32::from_be_bytes([a, b, c, d]) as usize);
        let Some(covered) = bytes.get(at + 4..end).filter(|_| end + 4 <= bytes.len()) else { break };
        let checksum = crc32fast::hash(covered).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&checksum);
        at = end + 4;
    }
    bytes
}
