//! Files that the reader accepts, files that it refuses, and the messages.

use super::header::Encoding;
use super::*;
use crate::source::GivenFile;
use bothways_common::look::color::{linear_from_encoded, linear_from_srgb};
use bothways_common::scene::Positions;
use glam::Vec3;
use proptest::collection::vec;
use proptest::prelude::*;

/// The mesh of a file in memory, and the warnings.
fn given_with_warnings(file: &str) -> Result<(Mesh, Vec<MaterialWarning>), ReadPlyError> {
    read_with_warnings(&InputFile::given(&[GivenFile::new("a", file.as_bytes())], 0))
}

/// A header with these lines.
fn header(encoding: &str, lines: &[&str]) -> String {
    format!("ply\nformat {encoding} 1.0\n{}\nend_header\n", lines.join("\n"))
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z";
const FACES: &str = "property list uchar int vertex_indices";
/// The corners of a square.
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// An ASCII file with the vertices of a square and some faces.
fn square(faces: usize, lines: &str) -> String {
    let face = format!("element face {faces}");
    header("ascii", &["element vertex 4", XYZ, &face, FACES]) + SQUARE + lines
}

/// The message about a file that is called `a`.
fn message(bytes: impl AsRef<[u8]>) -> String {
    parse("a", bytes.as_ref()).unwrap_err().to_string()
}

fn message_of_header(lines: &[&str]) -> String {
    message(header("ascii", lines))
}

#[test]
fn convex_polygons_become_fans_in_file_order() {
    let mesh = parse("a", square(2, "4 1 2 3 0\n3 0 1 2").as_bytes()).unwrap();
    assert_eq!(mesh.triangles(), [[1, 2, 3], [1, 3, 0], [0, 1, 2]]);
    assert_eq!(mesh.positions()[2], Vec3::new(1.0, 1.0, 0.0));
}

/// A file with values of all types, in one of the three encodings.
fn every_type(encoding: Encoding) -> Vec<u8> {
    let name = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::LittleEndian => "binary_little_endian",
        Encoding::BigEndian => "binary_big_endian",
    };
    let text = header(
        name,
        &[
            "comment by hand",
            "obj_info nothing",
            "element camera 1",
            "property list ushort short view",
            "element vertex 3",
            "property uchar red",
            "property float z",
            "property double x",
            "property short y",
            "property list char float weights",
            "element face 1",
            "property uint flags",
            "property list uint ushort vertex_index",
            "element edge 1",
            "property int8 first",
        ],
    );
    let mut bytes = text.replace('\n', "\r\n").into_bytes();
    let mut put = |word: &str, value: &[u8], line_end: bool| match encoding {
        Encoding::Ascii => {
            bytes.extend_from_slice(word.as_bytes());
            bytes.extend_from_slice(if line_end { b"\r\n" } else { b" " });
        }
        Encoding::LittleEndian => bytes.extend_from_slice(value),
        Encoding::BigEndian => bytes.extend(value.iter().rev()),
    };
    put("2", &2_u16.to_le_bytes(), false);
    put("-7", &(-7_i16).to_le_bytes(), false);
    put("9", &9_i16.to_le_bytes(), true);
    for (x, y, z) in [(0.1_f64, 0_i16, 0.5_f32), (1e-60, 7, -0.25), (-2.0, -300, 4.0)] {
        put("255", &[255], false);
        put(&z.to_string(), &z.to_le_bytes(), false);
        put(&x.to_string(), &x.to_le_bytes(), false);
        put(&y.to_string(), &y.to_le_bytes(), false);
        put("1", &[1], false);
        put("nan", &f32::NAN.to_le_bytes(), true);
    }
    put("4000000000", &4_000_000_000_u32.to_le_bytes(), false);
    put("3", &3_u32.to_le_bytes(), false);
    for index in [2_u16, 0, 1] {
        put(&index.to_string(), &index.to_le_bytes(), index == 1);
    }
    put("-1", &[255], true);
    bytes
}

#[test]
fn all_types_are_read_in_all_encodings() {
    for encoding in [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian] {
        let bytes = every_type(encoding);
        let mesh = parse("a", &bytes).unwrap_or_else(|error| panic!("{encoding:?}: {error}"));
        let expected =
            [Vec3::new(0.1, 0.0, 0.5), Vec3::new(0.0, 7.0, -0.25), Vec3::new(-2.0, -300.0, 4.0)];
        assert_eq!(mesh.positions(), expected, "{encoding:?}");
        assert_eq!(mesh.triangles(), [[2, 0, 1]], "{encoding:?}");
        // One pass reads the vertices, the other skips them.
        let mut file = PlyFile::new("a".into(), Cursor::new(bytes.as_slice())).unwrap();
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        for _ in 0..2 {
            let known = &mut Positions::default();
            file.vertices(|position| known.push(position)).unwrap();
            positions.extend(known.iter());
            file.triangles(known, |triangle| triangles.push(triangle)).unwrap();
        }
        assert_eq!(positions, [expected, expected].concat());
        assert_eq!(triangles, [[2, 0, 1], [2, 0, 1]]);
    }
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    for encoding in [Encoding::LittleEndian, Encoding::BigEndian] {
        let bytes = every_type(encoding);
        for end in 0..bytes.len() {
            assert!(parse("a", &bytes[..end]).is_err(), "{encoding:?} with {end} bytes");
        }
        let longer = [bytes.as_slice(), b"\n"].concat();
        let place = format!("(byte {})", bytes.len());
        assert!(
            message(longer).starts_with(&format!("a: something follows the last element {place}"))
        );
    }
}

#[test]
fn coordinates_round_once_to_the_nearest() {
    // Just above the middle between 1 and its successor. Rounded to `f64`, it is that middle, a tie.
    let lines = square(1, "3 0 1 2").replace("1 1 0", "1.00000005960464477540 1e-60 1e-45");
    let position = parse("a", lines.as_bytes()).unwrap().positions()[2];
    assert_eq!(position.x, 1.0 + f32::EPSILON);
    assert_eq!((position.y, position.z), (0.0, f32::from_bits(1)));
}

#[test]
fn faces_may_come_before_vertices() {
    let text = header("ascii", &["element face 1", FACES, "element vertex 3", XYZ]);
    let text = text + "3 2 1 0\n\n0 0 0\n1 0 0\n  \n1 1 0\n\n \n";
    assert_eq!(parse("a", text.as_bytes()).unwrap().triangles(), [[2, 1, 0]]);
}

#[test]
fn headers_that_are_none_say_so() {
    assert_eq!(message(""), "a:1: the file is empty");
    let no_ply = "a:1: this is no PLY file, which begins with a line that says \"ply\"";
    assert_eq!(message("v 0 0 0\n"), no_ply);
    assert_eq!(message([0xff; 9000]), no_ply);
    let no_end = "the header has no end; a line that says \"end_header\" must close it";
    assert_eq!(message("ply\nformat ascii 1.0\n"), format!("a:2: {no_end}"));
    assert_eq!(message(format!("ply\ncomment {}", "x".repeat(9000))), format!("a:2: {no_end}"));
    assert_eq!(
        message("ply\nformat text 1.0\n"),
        "a:2: there is no format \"text\"; it is ascii, binary_little_endian or binary_big_endian"
    );
    assert_eq!(
        message("ply\nformat ascii 2.0\n"),
        "a:2: PLY of version \"2.0\" cannot be read; there is only 1.0"
    );
    let unknown = message_of_header(&["elements vertex 3"]);
    assert!(unknown.starts_with("a:3: \"elements vertex 3\" is no line of a PLY header"));
    let says = |lines: &[&str]| {
        let message = message_of_header(lines);
        message.split_once(": ").unwrap().1.to_owned()
    };
    assert_eq!(says(&["format ascii 1.0"]), "the header has a second format");
    assert_eq!(says(&["element vertex -1"]), "\"-1\" is no number of elements of vertex");
    assert_eq!(
        says(&["element vertex 99999999999999999999"]),
        "\"99999999999999999999\" is no number of elements of vertex"
    );
    assert_eq!(says(&["element vertex 3", "element face 1"]), "the element vertex has no property");
    assert_eq!(
        says(&["element vertex 3", XYZ, "element vertex 3"]),
        "the header has a second element vertex"
    );
    assert_eq!(
        says(&["element vertex 3", XYZ, XYZ]),
        "the header has a second property x of vertex"
    );
    assert!(says(&["property float x"]).starts_with("the property x belongs to no element"));
    assert!(
        says(&["element vertex 1", "property real x"]).starts_with("there is no type \"real\"")
    );
    assert_eq!(
        says(&["element face 1", "property list float int vertex_indices"]),
        "the length of the list vertex_indices is no integer type"
    );
}

#[test]
fn headers_without_a_mesh_say_what_they_lack() {
    let says = |lines: &[&str]| {
        let message = message_of_header(lines);
        message.split_once(": ").unwrap().1.to_owned()
    };
    assert_eq!(
        message("ply\nelement face 1\nproperty int x\nend_header\n"),
        "a:4: the header has no line \"format\""
    );
    let no_faces = "no elements face, so nothing to draw; export the mesh as polygons";
    assert_eq!(says(&["element vertex 3", XYZ]), no_faces);
    assert_eq!(says(&["element vertex 3", XYZ, "element face 0", FACES]), no_faces);
    let no_vertices = "the header has no element vertex, so nothing has a place";
    assert_eq!(says(&["element face 1", FACES]), no_vertices);
    let face = ["element face 1", FACES];
    assert_eq!(
        says(&["element vertex 3", "property float x\nproperty list int int y", face[0], face[1]]),
        "the element vertex has no property y that is a number"
    );
    assert_eq!(
        says(&["element vertex 4294967295", XYZ, face[0], face[1]]),
        "4294967295 vertices are too many; at most 4294967294 can be told apart"
    );
    for list in ["property list uchar float vertex_indices", "property int vertex_index"] {
        assert_eq!(
            says(&["element vertex 3", XYZ, "element face 1", list]),
            "the element face has no list vertex_indices (or vertex_index) of integers"
        );
    }
}

#[test]
fn elements_that_are_wrong_say_which_and_where() {
    let unknown = "vertices are counted from 0 and there are 4";
    assert_eq!(
        message(square(2, "3 0 1 2\n3 0 1 4\n")),
        format!("a: face 1 (line 15): it names vertex 4, but {unknown}")
    );
    assert_eq!(
        message(square(1, "3 0 -1 2\n")),
        format!("a: face 0 (line 14): it names vertex -1, but {unknown}")
    );
    let corners = |count| format!("a face needs at least 3 corners, this one has {count}");
    assert_eq!(message(square(1, "2 0 1\n")), format!("a: face 0 (line 14): {}", corners(2)));
    assert_eq!(message(square(1, "-1\n")), format!("a: face 0 (line 14): {}", corners(-1)));
    let says = |lines: &str| {
        let message = message(square(1, lines));
        message.strip_prefix("a: face 0 (line 14): ").expect(&message).to_owned()
    };
    let short = "the line ends before its element does; an element is one line";
    assert_eq!(says("3 0 1\n2\n"), short);
    let long = "the line goes on behind its element with \"3\"; an element is one line";
    assert_eq!(says("3 0 1 2 3\n"), long);
    assert_eq!(says("3 0 1 2.5\n"), "\"2.5\" is not a whole number of the property's type");
    assert_eq!(says("300 0 1 2\n"), "\"300\" is not a whole number of the property's type");
    let promised = "but its header promises 1 such elements; is it truncated?";
    assert_eq!(says("3 0 1"), format!("the file ends here, {promised}"));
    let trailing = message(square(1, "3 0 1 2\n3 0 1 2\n"));
    assert!(trailing.starts_with("a: something follows the last element (line 15)"), "{trailing}");
}

#[test]
fn coordinates_that_are_none_say_so() {
    let says = |word: &str| {
        let message = message(square(1, "3 0 1 2\n").replacen("1 0 0", &format!("{word} 0 0"), 1));
        message.strip_prefix("a: vertex 1 (line 11): ").expect(&message).to_owned()
    };
    assert_eq!(says("0,5"), "\"0,5\" is not a number");
    assert_eq!(says(&"1".repeat(3000)), format!("\"{}…\" is not a number", "1".repeat(32)));
    assert_eq!(says("nan"), "the coordinate x is nan, which is not a finite number");
    let end = "is out of range: single precision ends at 3.4028235e38";
    assert_eq!(says("-1e39"), format!("the coordinate x = -1e39 {end}"));
    assert_eq!(says("1e999"), format!("the coordinate x = 1e999 {end}"));

    let lines = ["element vertex 1", "property double x\nproperty char y\nproperty char z"];
    let head = header("binary_big_endian", &[lines[0], lines[1], "element face 1", FACES]);
    let with = |x: f64| message([head.as_bytes(), &x.to_be_bytes(), &[0; 99]].concat());
    let place = format!("a: vertex 0 (byte {})", head.len() + 8);
    assert_eq!(
        with(f64::NEG_INFINITY),
        format!("{place}: the coordinate x is -inf, which is not a finite number")
    );
    assert!(with(1e39).starts_with(&format!("{place}: the coordinate x = 1000")));
}

#[test]
fn a_count_that_the_file_cannot_hold_takes_no_memory() {
    let lines = ["element vertex 4000000000", XYZ, "element face 18446744073709551615", FACES];
    for encoding in ["ascii", "binary_little_endian"] {
        assert!(message(header(encoding, &lines) + SQUARE).contains("4000000000 such elements"));
    }
    let lines = ["element vertex 1", XYZ, "element face 1", "property list uint int vertex_index"];
    let head = header("binary_little_endian", &lines);
    let bytes = [head.as_bytes(), &[0; 12], &[0xff; 4], &[0; 40]];
    assert!(message(bytes.concat()).contains("promises 1 such elements"));
}

#[test]
fn names_that_a_terminal_would_obey_are_written_out() {
    let says = message("ply\nformat ascii 1.0\nproperty float \0\u{9b}2J\n");
    assert!(says.contains(r"the property \u{0}\u{9b}2J belongs to no element"), "{says}");
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = std::env::temp_dir().join(format!("bothways-ply-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let message = |path: &Path| {
        let message = read(path).unwrap_err().to_string();
        message.replace(&folder.display().to_string(), "FOLDER").replace('\\', "/")
    };
    assert_eq!(message(&folder), "FOLDER: this is a folder, not a PLY file");
    let path = folder.join("none.ply");
    assert_eq!(message(&path), "FOLDER/none.ply: there is no such file");
    std::fs::write(&path, square(1, "3 0 1 2\n")).unwrap();
    assert_eq!(read(&path).unwrap().triangles(), [[0, 1, 2]]);
    std::fs::remove_dir_all(&folder).unwrap();
}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(
        encoding in 0..3_usize,
        damage in vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
    ) {
        let encodings = [Encoding::Ascii, Encoding::LittleEndian, Encoding::BigEndian];
        let mut bytes = every_type(encodings[encoding]);
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        // `Mesh` itself checks what is accepted.
        let _ = parse("a", &bytes);
    }
}

/// The names and sizes of types, in bytes; the last two are for numbers with a fraction.
const TYPES: [(&str, usize); 8] = [
    ("char", 1),
    ("uchar", 1),
    ("short", 2),
    ("ushort", 2),
    ("int", 4),
    ("uint", 4),
    ("float", 4),
    ("double", 8),
];

/// A whole number as a value of one of the [`TYPES`].
fn value(number: u8, (name, size): (&str, usize), is_big: bool) -> Vec<u8> {
    let mut bytes = match name {
        "float" => f32::from(number).to_le_bytes().to_vec(),
        "double" => f64::from(number).to_le_bytes().to_vec(),
        _ => u64::from(number).to_le_bytes()[..size].to_vec(),
    };
    if is_big {
        bytes.reverse();
    }
    bytes
}

/// Binary files with values of all types and polygons of many sizes.
fn binary_files() -> impl Strategy<Value = Vec<u8>> {
    let kinds = vec(0_usize..8, 10);
    let lists = [0_usize..6, 0..6];
    let polygons = vec(vec(0_u8..12, 3..6), 1..12);
    (kinds, lists, vec(vec(0_u8..127, 8), 12), polygons, any::<(bool, bool, bool)>()).prop_map(
        |(kinds, [length, item], vertices, polygons, (is_big, has_normals, has_flags))| {
            let mut names = vec!["x", "red", "y", "z"];
            names.extend(if has_normals { &["nx", "ny", "alpha", "nz"][..] } else { &[] });
            let property =
                |(name, kind): (&&str, &usize)| format!("property {} {name}", TYPES[*kind].0);
            let mut lines = vec!["element vertex 12".to_owned()];
            lines.extend(names.iter().zip(&kinds).map(property));
            lines.push(format!("element face {}", polygons.len()));
            lines.extend(has_flags.then(|| property((&"flags", &kinds[8]))));
            let [length, item] = [TYPES[length], TYPES[item]];
            lines.push(format!("property list {} {} vertex_index", length.0, item.0));
            lines.extend(has_flags.then(|| property((&"more", &kinds[9]))));
            let encoding = if is_big { "binary_big_endian" } else { "binary_little_endian" };
            let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
            let mut bytes = header(encoding, &lines).into_bytes();
            for vertex in vertices {
                for (number, kind) in vertex.iter().zip(&kinds).take(names.len()) {
                    bytes.extend(value(*number, TYPES[*kind], is_big));
                }
            }
            let flags = |number, kind: usize| {
                if has_flags { value(number, TYPES[kind], is_big) } else { Vec::new() }
            };
            for polygon in polygons {
                bytes.extend(flags(1, kinds[8]));
                bytes.extend(value(u8::try_from(polygon.len()).unwrap(), length, is_big));
                polygon.iter().for_each(|index| bytes.extend(value(*index, item, is_big)));
                bytes.extend(flags(2, kinds[9]));
            }
            bytes
        },
    )
}

proptest! {
    #[test]
    fn what_is_in_memory_is_decoded_as_value_by_value(
        bytes in binary_files(),
        changes in vec((any::<proptest::sample::Index>(), any::<u8>()), 0..3),
        cut in proptest::option::weighted(0.2, any::<proptest::sample::Index>()),
        room in 2_usize..200,
    ) {
        let mut bytes = bytes;
        let header = bytes.windows(11).position(|word| word == b"end_header\n").unwrap() + 11;
        for (place, byte) in changes {
            let place = header + place.index(bytes.len() - header);
            bytes[place] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(header + cut.index(bytes.len() - header));
        }
        let [all, some, one] = [bytes.len(), room, 1].map(|room| {
            let input = std::io::BufReader::with_capacity(room, Cursor::new(&bytes));
            let read = PlyFile::new("a".into(), input).and_then(|mut file| file.mesh());
            // As text, because 0 equals −0, and NaN nothing.
            format!("{:?}", read.map_err(|error| error.to_string()))
        });
        prop_assert_eq!(&all, &one);
        prop_assert_eq!(&some, &one);
    }
}

#[test]
fn normals_are_those_of_the_vertices() {
    let lines = [
        "element vertex 4",
        XYZ,
        "property float nx",
        "property float ny",
        "property double nz",
        "property uchar red",
        "element face 2",
        FACES,
    ];
    let vertices = "0 0 0 0 0 2 9\n1 0 0 0 1 0 9\n0 1 0 0.5 0 0 9\n0 0 1 nan 0 0 9\n";
    let file = header("ascii", &lines) + vertices + "3 0 1 2\n3 0 1 3\n";
    let (mesh, warnings) = given_with_warnings(&file).unwrap();
    assert_eq!(mesh.normals().of(0), Some([2.0 * Vec3::Z, Vec3::Y, 0.5 * Vec3::X]));
    assert_eq!(mesh.normals().of(1), None);
    // One channel alone is no colour.
    assert_eq!((warnings, mesh.colors().len()), (Vec::new(), 0));
    let without = file
        .replace("0 0 2 9", "0 0 0 9")
        .replace("0 1 0 9", "0 inf 0 9")
        .replace("0.5 0 0 9", "0 0 0 9");
    assert_eq!(parse("a", without.as_bytes()).unwrap().normals().corners, [[0_u32; 3]; 0]);
}

#[test]
fn colors_are_those_of_the_vertices() {
    let colored = |kind: &str, vertices: &str| {
        let [red, green, blue] =
            ["red", "green", "blue"].map(|name| format!("property {kind} {name}"));
        let lines = ["element vertex 3", XYZ, &red, &green, &blue, "element face 1", FACES];
        let file = header("ascii", &lines) + vertices + "3 0 1 2\n";
        parse("a", file.as_bytes()).unwrap().colors().to_vec()
    };
    let bytes = "0 0 0 255 0 188\n1 0 0 51 51 51\n0 1 0 0 0 255\n";
    let expected = [[255, 0, 188], [51, 51, 51], [0, 0, 255]]
        .map(|color| Vec3::from(color.map(linear_from_srgb)));
    assert_eq!(colored("uchar", bytes), expected);
    // Fractions, of which those outside are clamped.
    let fractions = "0 0 0 2 -1 0.2\n1 0 0 nan 1 1\n0 1 0 0 0.25 1\n";
    let found = colored("float", fractions);
    assert_eq!(found[0], Vec3::new(1.0, 0.0, linear_from_srgb(51)));
    assert_eq!(found[1], Vec3::new(0.0, 1.0, 1.0));
    assert!((found[2].y - linear_from_encoded(0.25)).abs() < 1e-7);
}

#[test]
fn colors_of_faces_are_missed() {
    let faces = format!("{FACES}\nproperty uchar red");
    let lines = ["element vertex 3", XYZ, "element face 1", &faces];
    let file = header("ascii", &lines) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9\n";
    let (_, warnings) = given_with_warnings(&file).unwrap();
    let says = "a: the colours of its faces are not read; all of it is drawn in the material of its object";
    assert_eq!(warnings.iter().map(ToString::to_string).collect::<Vec<_>>(), [says]);
}

#[test]
fn textures_are_missed() {
    let said = |comment: &str, of_vertices: &str, of_faces: &str| {
        let (vertex, faces) = (format!("{XYZ}{of_vertices}"), format!("{FACES}{of_faces}"));
        let numbers = " 0".repeat(of_vertices.matches("property").count());
        let vertices = SQUARE.replace('\n', &format!("{numbers}\n"));
        let list = if of_faces.is_empty() { "" } else { " 0" };
        let file =
            header("ascii", &[comment, "element vertex 4", &vertex, "element face 1", &faces]);
        let file = format!("{file}{vertices}3 0 1 2{list}\n");
        let streams = PlyFile::new("a".into(), Cursor::new(file.as_bytes())).unwrap();
        let (_, warnings) = given_with_warnings(&file).unwrap();
        assert_eq!(warnings.is_empty(), streams.color_warning().is_none());
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let says = "a: textures and texture coordinates of PLY files are not read; it is drawn without; export it as OBJ or glTF to \
                keep them";
    let pair = |a: &str, b: &str| format!("\nproperty float {a}\nproperty double {b}");
    let list = "\nproperty list uchar float texcoord";
    assert_eq!(said("comment TextureFile a.png", &pair("s", "t"), list), [says]);
    assert_eq!(said("comment TextureFile a.png", "", ""), [says]);
    assert_eq!(said("comment none", "", list), [says]);
    for (a, b) in [("s", "t"), ("u", "v"), ("texture_u", "texture_v")] {
        assert_eq!(said("comment none", &pair(a, b), ""), [says]);
    }
    assert!(said("comment no TextureFile", &pair("s", "v"), "").is_empty());
}

#[test]
fn a_byte_order_mark_stands_before_nothing() {
    let plain = square(1, "4 0 1 2 3");
    let marked = format!("\u{feff}{plain}");
    assert_eq!(parse("a", marked.as_bytes()).unwrap(), parse("a", plain.as_bytes()).unwrap());
    let twice = message(format!("\u{feff}{marked}"));
    assert!(twice.starts_with("a:1: this is no PLY file"), "{twice}");
}
