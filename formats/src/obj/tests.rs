//! Files that the reader accepts, files that it refuses, and the messages.

use super::*;
use crate::attributes::NONE;
use crate::source::{GivenFile, Reach};
use bothways_common::scene::{Attribute, Material};
use glam::{Vec2, Vec3};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use std::fs;
use std::io;

/// The vertices of a square.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn mesh(text: &str) -> Mesh {
    parse("mesh.obj", text.as_bytes()).unwrap()
}

/// The message about a file that is called `a`.
fn message(text: impl AsRef<[u8]>) -> String {
    parse("a", text.as_ref()).unwrap_err().to_string()
}

/// The message about a statement that follows the vertices of a square.
fn fault(statement: &str) -> String {
    let message = message(format!("{SQUARE}{statement}\nf 1 2 3\n"));
    message.strip_prefix("a:5: ").expect("the message names file and line").to_owned()
}

#[test]
fn convex_polygons_become_fans_in_file_order() {
    let mesh = mesh(&format!("{SQUARE}v -1 0.5 0\nf 2 3 4 5 1\nf 1 2 3\n"));
    assert_eq!(mesh.triangles(), [[1, 2, 3], [1, 3, 4], [1, 4, 0], [0, 1, 2]]);
}

#[test]
fn negative_indices_count_back_from_the_face() {
    let mesh = mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -3 -2 -1\n");
    assert_eq!(mesh.triangles(), [[0, 1, 2], [1, 2, 3]]);
}

#[test]
fn positive_indices_may_name_what_follows() {
    let mesh = mesh(&format!("f 1//1 2 3\nf 4 2 1\n{SQUARE}vn 0 0 1\n"));
    assert_eq!(mesh.triangles(), [[0, 1, 2], [3, 1, 0]]);
    assert_eq!(mesh.normals().corners, [[0, NONE, NONE], [NONE; 3]]);
}

#[test]
fn corners_carry_what_they_name() {
    let mesh = mesh(&format!(
        "{SQUARE}vt 0.5\nvt 1 2 3\nvn 0 0 1\nf 1 2 3\nf 1/1 2/2/1 3//1\nf 1 3/ 4//\n"
    ));
    assert_eq!(mesh.texture_coordinates().values, [Vec2::new(0.5, 0.0), Vec2::new(1.0, 2.0)]);
    assert_eq!(mesh.texture_coordinates().corners, [[NONE; 3], [0, 1, NONE], [NONE; 3]]);
    assert_eq!(mesh.normals().corners, [[NONE; 3], [NONE, 0, 0], [NONE; 3]]);
}

#[test]
fn what_no_face_names_is_dropped_but_vertices() {
    let mesh = mesh(&format!("{SQUARE}vt 0 0\nvn 0 0 1\nf 1 2 3\n"));
    assert_eq!(mesh.positions().len(), 4);
    assert_eq!(*mesh.normals(), Attribute::default());
    assert_eq!(*mesh.texture_coordinates(), Attribute::default());
}

#[test]
fn everything_else_of_the_format_is_skipped() {
    let text = "\u{feff}# a comment\r\nmtllib a b.mtl\r\n\r\no name\r\n\tv 0 0 0 1 # corner\r\n\
                v 1 0 0 0.5 0.5 0.5\r\nv +1. .1e1 -0\r\ng a b\r\nusemtl m\r\ns off\r\n\
                l 1 2\r\np 1\r\nvp 0 1\r\ncstype bezier\r\nf 1 \\\r\n 2 3\r\nend";
    let mesh = mesh(text);
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, -0.0)]);
    assert_eq!(mesh.triangles(), [[0, 1, 2]]);
}

#[test]
fn comments_need_not_be_utf8() {
    let text = [b"# \xfcber\ng \xff\n".as_slice(), SQUARE.as_bytes(), b"f 1 2 3"].concat();
    assert_eq!(parse("a", &text).unwrap().triangles().len(), 1);
}

#[test]
fn numbers_round_once_to_the_nearest() {
    // Just above the middle between 1 and its successor. Rounded to `f64`, it is that middle, a tie.
    let text = "v 1.0000000596046448 1.00000005960464477540 0\nf 1 1 1\n";
    let position = mesh(text).positions()[0];
    assert_eq!(position.x, 1.0 + f32::EPSILON);
    assert_eq!(position.y, 1.0 + f32::EPSILON);
    assert_eq!(mesh("v 1e-60 -1e-60 1e-45\nf 1 1 1").positions()[0].z, f32::from_bits(1));
}

#[test]
fn a_file_without_anything_to_draw_says_so() {
    assert_eq!(message(""), "a: the file is empty");
    let no_face = "a: no faces (`f` statements), so nothing to draw; export the mesh as polygons";
    assert_eq!(message("\n"), no_face);
    assert_eq!(message(SQUARE), no_face);
}

#[test]
fn very_many_material_files_take_no_quadratic_time_and_few_warnings() {
    // A comparison of all pairs would take 10¹⁰ steps.
    let libraries: String = (0..100_000).map(|k| format!("mtllib {k:07}.mtl\n")).collect();
    let begun = std::time::Instant::now();
    let text = format!("{libraries}{SQUARE}usemtl a\nf 1 2 3\n");
    let given = [GivenFile::new("a", text.as_bytes())];
    let (_, warnings) = read_with_materials(&InputFile::given(&given, 0)).unwrap();
    assert_eq!(
        (warnings.len(), warnings[8].to_string().as_str()),
        (9, "a: 99992 more material files are missing beside it")
    );
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

/// The material of a triangle whose OBJ file names this library, and the warnings or the error; `a.mtl` has this text, `a.tga`,
/// `a.png` and `b` are no pictures.
fn with_library(library: &str, mtl: &str) -> Result<(Material, Vec<String>), String> {
    let thread = std::thread::current().id();
    let folder = format!("bothways-library-{}-{thread:?}", std::process::id());
    let folder = std::env::temp_dir().join(folder);
    fs::create_dir_all(folder.join("sub")).unwrap();
    let text = format!("mtllib {library}\n{SQUARE}usemtl m\nf 1 2 3\n");
    let files =
        [("a.obj", text.as_str()), ("sub/a.mtl", mtl), ("sub/a.tga", "?"), ("sub/a.png", "?")];
    for (name, text) in files {
        fs::write(folder.join(name), text).unwrap();
    }
    let input = InputFile::on_disk(&folder.join("a.obj"), Reach::Folder);
    let shown = |text: String| text.replace(&format!("{}/", folder.display()), "");
    let read = read_with_materials(&input);
    fs::remove_dir_all(&folder).unwrap();
    let (mesh, warnings) = read.map_err(|error| shown(error.to_string()))?;
    let material = mesh.materials().unwrap().of(0).cloned().unwrap_or_default();
    Ok((material, warnings.iter().map(|warning| shown(warning.to_string())).collect()))
}

#[test]
fn the_separators_of_another_system_lead_to_a_material_file() {
    for library in ["sub/a.mtl", "sub\\a.mtl", "sub\\a.mtl .\\sub\\a.mtl"] {
        let (material, warnings) = with_library(library, "newmtl m\nKs 1\n").unwrap();
        assert_eq!((material.specular, warnings.len()), (1.0, 0), "{library}");
    }
    let says = "a.obj: there is no material file \"sub/b.mtl\" beside it; what needs it is drawn in light grey";
    assert_eq!(with_library("sub\\b.mtl", "").unwrap().1, [says]);
}

#[test]
fn a_picture_in_a_format_that_is_not_read_is_a_warning() {
    let said = |name: &str| with_library("sub/a.mtl", &format!("newmtl m\nKd 1\nmap_Kd {name}\n"));
    let (material, warnings) = said("a.tga").unwrap();
    assert_eq!((material.texture, material.color), (None, Vec3::ONE));
    let without = "what has it as its texture is drawn without";
    let format = "is in a format that is not read (save it as PNG, JPEG, BMP or PNM)";
    assert_eq!(warnings, [format!("sub/a.mtl:3: the picture \"a.tga\" {format}; {without}")]);
    let absent = format!("sub/a.mtl:3: there is no picture \"b.tga\" beside it; {without}");
    assert_eq!(said("b.tga").unwrap().1, [absent]);
    let url = "is a URL, and nothing is fetched (download it, and name it by a relative path)";
    assert_eq!(
        said("http://a.org/b.png").unwrap().1,
        [format!("sub/a.mtl:3: the picture \"http://a.org/b.png\" {url}; {without}")]
    );
    let broken =
        "sub/a.mtl:3: sub/a.png is no picture (PNG, JPEG, BMP or PNM); save it as one of these";
    assert_eq!(said("a.png").unwrap_err(), broken);
}

#[test]
fn colors_that_are_no_three_numbers_are_legal() {
    let said = |text: &str| with_library("sub/a.mtl", &format!("newmtl m\n{text}\n"));
    let says = "sub/a.mtl:3: Kd of \"m\" is stated as xyz or spectral, which is not read; what is made of it is drawn in light \
                grey; state three numbers";
    let others = "Ks xyz 1 1 1";
    for color in ["Kd xyz 0.5 0.5 0.5", "Kd xyz 1", "Kd spectral a.rfl 1"] {
        let (material, warnings) = said(&format!("{others}\n{color}\nKa spectral f.rfl")).unwrap();
        assert_eq!((material, warnings), (Material::default(), vec![says.to_owned()]), "{color}");
    }
    let (material, warnings) = said("Ks spectral f.rfl\nKa xyz 1 1 1\nKd xyz 1\nKd 1").unwrap();
    assert_eq!((material.color, warnings.len()), (Vec3::ONE, 0));
    let wrong = said("Ns xyz 1").unwrap_err();
    assert_eq!(wrong, "sub/a.mtl:2: \"xyz\" is not a number");
}

#[test]
fn what_is_no_statement_says_so() {
    assert_eq!(fault("foo 1 2"), r#"there is no statement "foo" that an OBJ file may have here"#);
    assert_eq!(fault("V 1 2 3"), r#"there is no statement "V" that an OBJ file may have here"#);
    assert_eq!(
        message("call b.obj\n"),
        r#"a:1: there is no statement "call" that an OBJ file may have here"#
    );
    let binary =
        "a:2: this is not plain text, as an OBJ or MTL file must be (a binary or UTF-16 file?)";
    assert_eq!(message(b"v 0 0 0\n\x89PNG\n"), binary);
    assert_eq!(message(b"v 0 0 0\nf\0 \x01\0\n"), binary);
}

#[test]
fn numbers_that_are_none_say_so() {
    assert_eq!(fault("v 0 0,5 1"), r#""0,5" is not a number"#);
    assert_eq!(fault("v 0 1 2 red"), r#""red" is not a number"#);
    assert_eq!(message(b"v 0 0 \xff\n"), r#"a:1: "�" is not a number"#);
    let long = format!("v {}", "x".repeat(1000));
    assert_eq!(fault(&long), format!(r#""{}…" is not a number"#, "x".repeat(32)));
    assert_eq!(fault("v 0 NaN 0"), r#""NaN" is not a finite number"#);
    assert_eq!(fault("vn 0 0 -inf"), r#""-inf" is not a finite number"#);
    let end = "is out of range: single precision ends at 3.4028235e38";
    assert_eq!(fault("v 1e39 0 0"), format!(r#""1e39" {end}"#));
    assert_eq!(fault("vt -1e999"), format!(r#""-1e999" {end}"#));
}

#[test]
fn missing_coordinates_say_so() {
    assert_eq!(fault("v 1 2"), "too few coordinates for a vertex: 2 instead of 3");
    assert_eq!(fault("vn"), "too few coordinates for a normal: 0 instead of 3");
    assert_eq!(fault("vt"), "too few coordinates for a texture coordinate: 0 instead of 1");
}

#[test]
fn faces_that_are_none_say_so() {
    assert_eq!(fault("f"), "a face needs at least 3 corners, this one has 0");
    assert_eq!(fault("f 1 2 # 3"), "a face needs at least 3 corners, this one has 2");
    for text in ["x", "/1", "1/2/3/4", "1.5", "1\\2", "99999999999999999999", "1/x", "1///"] {
        let corner = "is not a corner; write one as v, v/vt, v//vn or v/vt/vn, in whole numbers";
        assert_eq!(fault(&format!("f 1 2 {text}")), format!("{text:?} {corner}"));
    }
    assert_eq!(fault("f 1 0 2"), "the face names vertex 0, but they are counted from 1");
    assert_eq!(
        fault("f 1 2/0 2"),
        "the face names texture coordinate 0, but they are counted from 1"
    );
}

#[test]
fn indices_of_nothing_say_how_many_there_are() {
    let fault = |faces: &str| message(format!("{SQUARE}vt 0\n{faces}\nv 0 2 0\n"));
    assert_eq!(
        fault("f 1 2 3\nf 1 2 6"),
        "a:7: the face names vertex 6, but in the whole file only 5 are defined"
    );
    assert_eq!(
        fault("f 1 2/2 3"),
        "a:6: the face names texture coordinate 2, but in the whole file only 1 is defined"
    );
    assert_eq!(
        fault("f 1 2//1 3"),
        "a:6: the face names normal 1, but in the whole file none is defined"
    );
    assert_eq!(
        fault("f -4 -5 3"),
        "a:6: the face names vertex -5, counted back, but above it only 4 are defined"
    );
    // The message names the first of them.
    assert_eq!(
        fault("f 1 5 2\nf 7 9 4294967296\nf 1 2 6//1"),
        "a:7: the face names vertex 7, but in the whole file only 5 are defined"
    );
    assert_eq!(
        fault("f 1 2 4294967296"),
        "a:6: the face names vertex 4294967296, but in the whole file only 5 are defined"
    );
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = std::env::temp_dir().join(format!("bothways-obj-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let message = |path: &Path| {
        let message = read(path).unwrap_err().to_string();
        message.replace(&folder.display().to_string(), "FOLDER")
    };
    assert_eq!(message(&folder), "FOLDER: this is a folder, not an OBJ file");
    let path = folder.join("none.obj");
    assert_eq!(message(&path).replace('\\', "/"), "FOLDER/none.obj: there is no such file");
    // A sparse file takes no space on disk.
    fs::File::create(&path).unwrap().set_len(MOST_BYTES + 1).unwrap();
    assert_eq!(
        message(&path).replace('\\', "/"),
        "FOLDER/none.obj: an OBJ file of more than 16 GiB cannot be read; split it"
    );
    fs::write(&path, format!("{SQUARE}f 1 2 3\n")).unwrap();
    assert_eq!(read(&path).unwrap().triangles(), [[0, 1, 2]]);
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn messages_say_the_systems_reason_once() {
    let because = |kind: io::ErrorKind| {
        let error = ReadObjError::Unreadable { file: "a".to_owned(), error: kind.into() };
        assert!(std::error::Error::source(&error).is_none());
        error.to_string()
    };
    let denied = because(io::ErrorKind::PermissionDenied);
    assert_eq!(denied, "a: there is no permission to read it");
    assert_eq!(because(io::ErrorKind::TimedOut), "a: it cannot be read: timed out");
}

/// Pieces of OBJ files, and some that do not occur in them.
fn pieces() -> impl Strategy<Value = Vec<u8>> {
    let pieces: [&[u8]; 24] = [
        b"v ",
        b"vt ",
        b"vn ",
        b"f ",
        b"f 1 2 3",
        b"v 1 2 3\n",
        b"vt 1\n",
        b"vn 0 0 1\n",
        b"\n",
        b"\n",
        b"\r\n",
        b"\\\n",
        b" ",
        b"1 ",
        b"-1 ",
        b"2/1 ",
        b"1//1 ",
        b"3",
        b"/",
        b"0",
        b"nan",
        b"1e39",
        b"#",
        b"\xff",
    ];
    vec(select(pieces.to_vec()), 0..60).prop_map(|pieces| pieces.concat())
}

/// Any finite number, also −0 and denormals.
fn finite() -> impl Strategy<Value = f32> {
    use proptest::num::f32::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO
}

/// An attribute for so many triangles. All, some or none of their corners use it.
fn attribute<T: Copy + std::fmt::Debug>(
    value: impl Strategy<Value = T>,
    triangles: usize,
) -> impl Strategy<Value = Attribute<T>> {
    (vec(value, 1..9), vec([0_u32..12, 0..12, 0..12], triangles), any::<bool>()).prop_map(
        |(values, mut corners, present)| {
            for index in corners.as_flattened_mut() {
                *index = if (*index as usize) < values.len() { *index } else { NONE };
            }
            let attribute = Attribute { values, corners };
            // Values that no corner uses are not written.
            let is_used = attribute.corners.as_flattened().iter().any(|&index| index != NONE);
            if present && is_used { attribute } else { none() }
        },
    )
}

fn none<T>() -> Attribute<T> {
    Attribute { values: Vec::new(), corners: Vec::new() }
}

fn any_mesh() -> impl Strategy<Value = Mesh> {
    let position = [finite(), finite(), finite()].prop_map(Vec3::from);
    let parts = (vec(position, 1..20), 1_usize..20).prop_flat_map(|(positions, triangles)| {
        let vertex = 0..u32::try_from(positions.len()).unwrap();
        let normal = [finite(), finite(), finite()].prop_map(Vec3::from);
        let texture = [finite(), finite()].prop_map(Vec2::from);
        (
            Just(positions),
            vec([vertex.clone(), vertex.clone(), vertex], triangles),
            attribute(normal, triangles),
            attribute(texture, triangles),
        )
    });
    parts.prop_map(|(positions, triangles, normals, texture)| {
        let mesh = Mesh::new(positions, triangles).unwrap().with_normals(normals).unwrap();
        mesh.with_texture_coordinates(texture).unwrap()
    })
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(
        bytes in prop_oneof![vec(any::<u8>(), 0..300), pieces()],
    ) {
        // `Mesh` itself checks what is accepted.
        let _ = parse("a", &bytes);
    }

    #[test]
    fn what_is_written_is_read_back_bit_for_bit(mesh in any_mesh()) {
        let mut text = Vec::new();
        write(&mesh, &mut text).unwrap();
        let again = parse("again.obj", &text).unwrap();
        // Compared as text, because 0 equals −0.
        let text = String::from_utf8_lossy(&text);
        prop_assert_eq!(format!("{again:?}"), format!("{mesh:?}"), "{}", text);
    }
}
