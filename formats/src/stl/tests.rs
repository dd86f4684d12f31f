//! Files that the reader accepts, files that it refuses, and the messages.

use super::*;
use crate::generate::Kind;
use glam::Vec3;
use proptest::prelude::*;

const SQUARE: &str = "solid a square\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n  \
                      endloop\n endfacet\n facet normal 0 0 0\n  outer loop\n   vertex 0 -0 0\n   vertex 1 1e0 0\n   \
                      vertex 0 1 0\n  endloop\n endfacet\nendsolid a square\n";

fn message(bytes: impl AsRef<[u8]>) -> String {
    parse("a", bytes.as_ref()).unwrap_err().to_string()
}

/// The message about the square with a change.
fn changed(from: &str, to: &str) -> String {
    assert!(SQUARE.contains(from), "{from}");
    message(SQUARE.replacen(from, to, 1))
}

#[test]
fn corners_at_the_same_place_are_one_vertex() {
    let mesh = parse("a", SQUARE.as_bytes()).unwrap();
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.normals().corners.is_empty());
}

#[test]
fn case_line_ends_and_blank_lines_do_not_matter_and_solids_follow_one_another() {
    let text = format!("\u{feff}\r\n{}", SQUARE.to_ascii_uppercase().replace('\n', "\r\n\r\n"));
    assert_eq!(parse("a", text.as_bytes()).unwrap(), parse("a", SQUARE.as_bytes()).unwrap());
    let twice = format!("{SQUARE}{SQUARE}");
    assert_eq!(parse("a", twice.as_bytes()).unwrap().triangles().len(), 4);
}

#[test]
fn binary_files_are_told_by_their_size_even_if_they_begin_with_solid() {
    let mesh = parse("a", SQUARE.as_bytes()).unwrap();
    let mut bytes = Vec::new();
    write(&mesh, &mut bytes).unwrap();
    assert_eq!(parse("a", &bytes).unwrap(), mesh);
    bytes[..6].copy_from_slice(b"solid ");
    assert_eq!(parse("a", &bytes).unwrap(), mesh);
    // One byte more or less, and it is no binary file.
    let size = "and as a binary one of 2 facets it would have 184 bytes, but has";
    let begins = "a: this is no STL file: it begins with \"solid\", but is no text";
    let differs = "a: this is no STL file: it does not begin with \"solid\"";
    let longer = "185; is its number of facets wrong, or something appended to it?";
    let shorter = "183; is it truncated?";
    let mut other = bytes.clone();
    other[0] = b'x';
    for (bytes, says) in [(&bytes, begins), (&other, differs)] {
        assert_eq!(message(&bytes[..183]), format!("{says}, {size} {shorter}"));
        assert_eq!(message([&bytes[..], b"\n"].concat()), format!("{says}, {size} {longer}"));
    }
    assert_eq!(
        message(&bytes[..83]),
        format!("{begins}, and a binary one has at least 84 bytes, this one has 83")
    );
    let short = "a: this is no STL file: it does not begin with \"solid\", and a binary one has at least 84 bytes, this one \
                 has 9";
    assert_eq!(message(b"solidxxxx"), short);
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    assert_eq!(message(""), "a: the file is empty");
    let none = "a: no facets, so nothing to draw; export the mesh as triangles";
    assert_eq!(message("solid\nendsolid"), none);
    let mut empty = [0; 84];
    empty[0] = b'x';
    assert_eq!(message(empty), none);
    assert_eq!(
        changed("facet normal", "facet"),
        "a:2: \"0\" stands here in place of \"facet normal\" or \"endsolid\""
    );
    assert_eq!(
        changed("outer loop", "outer"),
        "a:3: \"outer\" stands here in place of \"outer loop\""
    );
    assert_eq!(
        changed("vertex 0 0 0", "vertex 0 0"),
        "a:4: a vertex needs 3 coordinates, this one has 2"
    );
    assert_eq!(
        changed("vertex 0 0 0", "vertex 0 0 0 1"),
        "a:4: the line goes on with \"1\", which does not belong there"
    );
    assert_eq!(changed("vertex 0 0 0", "vertex 0 0 o"), "a:4: \"o\" is not a number");
    assert_eq!(
        changed("vertex 0 0 0", "vertex 0 0 nan"),
        "a:4: a coordinate is nan, which is not a finite number"
    );
    assert_eq!(
        changed("vertex 0 0 0", "vertex 0 0 1e39"),
        "a:4: \"1e39\" is out of range: single precision ends at 3.4028235e38"
    );
    assert_eq!(
        changed("  endloop", "vertex 1 2 3"),
        "a:7: this facet has a fourth vertex, but STL has triangles only"
    );
    assert_eq!(changed("  endloop\n", ""), "a:7: \"endfacet\" stands here in place of \"endloop\"");
    assert_eq!(
        changed("endsolid a square\n", ""),
        "a:15: the file ends here, before \"facet normal\" or \"endsolid\"; is it truncated?"
    );
    assert_eq!(message(format!("{SQUARE}x")), "a:17: \"x\" stands here in place of \"solid\"");
    let no_text = "a:3: this is not plain text, as an ASCII STL file must be; is the file damaged?";
    assert_eq!(changed("outer loop", "outer \u{1b}[31mloop"), no_text);
    let late = format!("{}\0{SQUARE}", SQUARE.repeat(9));
    assert_eq!(message(late), no_text.replace('3', "145"));
    let long = format!("solid {}", "x".repeat(1 << 17));
    assert_eq!(message(long), "a:1: the line has 65536 bytes or more; is this an STL file?");
    let mut bytes = Vec::new();
    write(&parse("a", SQUARE.as_bytes()).unwrap(), &mut bytes).unwrap();
    bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert_eq!(message(&bytes), "a: facet 1: a coordinate is inf, which is not a finite number");
}

#[test]
fn a_mesh_that_is_written_is_read_back() {
    let torus = Kind::Torus.mesh([12, 8]).unwrap();
    let mut bytes = Vec::new();
    write(&torus, &mut bytes).unwrap();
    let again = parse("a", &bytes).unwrap();
    assert_eq!(again.positions().len(), torus.positions().len());
    for triangle in 0..torus.triangles().len() {
        assert_eq!(again.corners(triangle), torus.corners(triangle));
    }
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(
        is_binary in any::<bool>(),
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in proptest::option::weighted(0.3, any::<prop::sample::Index>()),
    ) {
        let mut bytes = SQUARE.as_bytes().to_vec();
        if is_binary {
            let mesh = parse("a", &bytes).unwrap();
            bytes.clear();
            write(&mesh, &mut bytes).unwrap();
        }
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        bytes.truncate(cut.map_or(bytes.len(), |cut| cut.index(bytes.len())));
        // `Mesh` itself checks what is accepted.
        let _ = parse("a", &bytes);
    }
}
