//! Polygons in files: the same triangles in the same order, however a file states them and however it is read.

use bothways_common::Mesh;
use bothways_common::glam::Vec3;
use bothways_formats::mesh_file::Format;
use bothways_formats::mesh_stream::MeshStream;
use bothways_formats::{obj, ply};
use std::fmt::Write;

/// Vertices, and polygons that name them.
struct Drawing {
    positions: Vec<[f32; 3]>,
    polygons: Vec<Vec<usize>>,
}

/// An arrowhead, an L, a U, a comb, a frame around a hole, and convex ones between them.
const OUTLINES: [&[[f32; 2]]; 8] = [
    &[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]],
    &[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
    &[[2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0]],
    &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]],
    &[
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [2.0, 3.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [0.0, 3.0],
    ],
    &[[0.0, 0.0], [2.0, 0.0], [3.0, 2.0], [1.0, 3.0], [-1.0, 2.0]],
    &[
        [0.0, 0.0],
        [1.0, 4.0],
        [2.0, 0.0],
        [3.0, 4.0],
        [4.0, 0.0],
        [5.0, 4.0],
        [6.0, 0.0],
        [6.0, 5.0],
        [0.0, 5.0],
    ],
    &[
        [0.0, 0.0],
        [6.0, 0.0],
        [6.0, 6.0],
        [0.0, 6.0],
        [0.0, 0.0],
        [2.0, 2.0],
        [2.0, 4.0],
        [4.0, 4.0],
        [4.0, 2.0],
        [2.0, 2.0],
    ],
];

/// Each outline with each corner as its first one, both ways around, and in planes of several directions.
fn drawing() -> Drawing {
    let mut drawing = Drawing { positions: Vec::new(), polygons: Vec::new() };
    let planes: [fn([f32; 2]) -> [f32; 3]; 4] = [
        |[x, y]| [x, y, 0.0],
        |[x, y]| [x, 1.0, y],
        |[x, y]| [x - y, y, x],
        |[x, y]| [y, x, x + 3.0 * y],
    ];
    for (outline, plane) in
        OUTLINES.into_iter().flat_map(|outline| planes.map(|plane| (outline, plane)))
    {
        for first in 0..outline.len() {
            let begin = drawing.positions.len();
            drawing.positions.extend(outline.iter().map(|&corner| plane(corner)));
            let mut polygon: Vec<usize> = (begin..drawing.positions.len()).collect();
            polygon.rotate_left(first);
            let back = polygon.iter().rev().copied().collect();
            drawing.polygons.extend([polygon, back]);
        }
    }
    drawing
}

/// The area of a polygon as a vector, twice; the coordinates are whole numbers, so it is exact.
fn twice_the_area(corners: &[Vec3]) -> Vec3 {
    corners.windows(2).map(|pair| (pair[0] - corners[0]).cross(pair[1] - corners[0])).sum()
}

/// What a statement of OBJ says about a polygon, with a number for each corner.
fn face(polygon: &[usize], corner: impl Fn(usize) -> String) -> String {
    let corners: Vec<String> = polygon.iter().map(|&vertex| corner(vertex)).collect();
    format!("f {}\n", corners.join(" "))
}

fn vertices(drawing: &Drawing) -> String {
    drawing.positions.iter().fold(String::new(), |mut text, [x, y, z]| {
        writeln!(text, "v {x} {y} {z}").expect("texts grow");
        text
    })
}

fn faces(drawing: &Drawing, corner: impl Fn(usize) -> String) -> String {
    drawing.polygons.iter().map(|polygon| face(polygon, &corner)).collect()
}

fn plain(vertex: usize) -> String {
    format!("{}", vertex + 1)
}

/// How the values of a PLY file are written.
#[derive(Clone, Copy)]
enum Values {
    Words,
    Little,
    Big,
}

/// A PLY file, with faces first or vertices first. Faces with a list that nothing needs are read value by value.
fn ply_file(drawing: &Drawing, values: Values, faces_first: bool, with_list: bool) -> Vec<u8> {
    let format = match values {
        Values::Words => "ascii",
        Values::Little => "binary_little_endian",
        Values::Big => "binary_big_endian",
    };
    let put = |file: &mut Vec<u8>, words: &[&dyn std::fmt::Display], bytes: &[[u8; 4]]| match values
    {
        Values::Words => {
            words.iter().for_each(|word| file.extend(format!("{word} ").bytes()));
            file.push(b'\n');
        }
        Values::Little => file.extend(bytes.as_flattened()),
        Values::Big => bytes.iter().for_each(|bytes| file.extend(bytes.iter().rev())),
    };
    let mut of_vertices = Vec::new();
    for [x, y, z] in &drawing.positions {
        put(&mut of_vertices, &[x, y, z], &[x.to_le_bytes(), y.to_le_bytes(), z.to_le_bytes()]);
    }
    let mut of_faces = Vec::new();
    for polygon in &drawing.polygons {
        let mut numbers: Vec<u32> = vec![u32::try_from(polygon.len()).expect("small numbers")];
        numbers.extend(polygon.iter().map(|&vertex| u32::try_from(vertex).expect("small numbers")));
        numbers.extend([1, 7].iter().filter(|_| with_list));
        let words: Vec<&dyn std::fmt::Display> = numbers.iter().map(|number| number as _).collect();
        let bytes: Vec<[u8; 4]> = numbers.iter().map(|number| number.to_le_bytes()).collect();
        put(&mut of_faces, &words, &bytes);
    }
    let list = if with_list { "property list uint uint more\n" } else { "" };
    let vertex_header = format!(
        "element vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
        drawing.positions.len()
    );
    let face_header = format!(
        "element face {}\nproperty list uint uint vertex_indices\n{list}",
        drawing.polygons.len()
    );
    let mut parts = [(vertex_header, of_vertices), (face_header, of_faces)];
    if faces_first {
        parts.reverse();
    }
    let [(first_header, first), (second_header, second)] = parts;
    let header = format!("ply\nformat {format} 1.0\n{first_header}{second_header}end_header\n");
    [header.into_bytes(), first, second].concat()
}

/// The triangles of a file on the disk: of its mesh, and of a stream.
fn read_and_streamed(name: &str, bytes: &[u8], format: Format) -> [Vec<[u32; 3]>; 2] {
    let folder = tempfile::tempdir().expect("there is room");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("there is room");
    let read = match format {
        Format::Obj => obj::read(&path).expect("the file is right"),
        _ => ply::read(&path).expect("the file is right"),
    };
    let mut streamed = Vec::new();
    let mut stream = MeshStream::open(&path, format).expect("the file is right");
    stream.for_each_triangle(|_, triangle| streamed.push(triangle)).expect("the file is right");
    [read.triangles().to_vec(), streamed]
}

/// Reads an OBJ file in every way that there is.
fn check_obj(name: &str, text: &str) -> Mesh {
    let mesh = obj::parse(name, text.as_bytes()).expect("the file is right");
    let [read, streamed] = read_and_streamed(name, text.as_bytes(), Format::Obj);
    assert!(read == mesh.triangles(), "{name}, read from the disk");
    assert!(streamed == mesh.triangles(), "{name}, streamed");
    mesh
}

/// The triangles of the drawing, which cover its polygons.
fn expected(drawing: &Drawing) -> Vec<[u32; 3]> {
    let text = vertices(drawing) + &faces(drawing, plain);
    let mesh = check_obj("vertices first.obj", &text);
    let mut first = 0;
    for polygon in &drawing.polygons {
        let corners: Vec<Vec3> =
            polygon.iter().map(|&vertex| Vec3::from(drawing.positions[vertex])).collect();
        let triangles = first..first + polygon.len() - 2;
        let areas: Vec<Vec3> =
            triangles.clone().map(|triangle| twice_the_area(&mesh.corners(triangle))).collect();
        let whole = twice_the_area(&corners);
        assert_eq!(areas.iter().sum::<Vec3>(), whole, "{corners:?}");
        assert!(areas.iter().all(|area| area.dot(whole) >= 0.0), "{corners:?}: {areas:?}");
        first = triangles.end;
    }
    assert_eq!(mesh.triangles().len(), first);
    mesh.triangles().to_vec()
}

#[test]
fn every_way_of_reading_gives_the_same_triangles_and_they_cover_the_polygons() {
    let drawing = drawing();
    let expected = expected(&drawing);
    let fan = |of: &Vec<usize>| -> Vec<[usize; 3]> {
        (2..of.len()).map(|k| [of[0], of[k - 1], of[k]]).collect()
    };
    let fans: Vec<[usize; 3]> = drawing.polygons.iter().flat_map(fan).collect();
    let differ = expected.iter().zip(fans).filter(|(cut, fan)| cut.map(|k| k as usize) != *fan);
    assert!(differ.count() > 500);

    let below = faces(&drawing, plain) + &vertices(&drawing);
    assert_eq!(check_obj("faces first.obj", &below).triangles(), expected);
    let count = drawing.positions.len();
    let back = vertices(&drawing) + &faces(&drawing, |vertex| format!("-{}", count - vertex));
    assert_eq!(check_obj("negative.obj", &back).triangles(), expected);
    let lines = faces(&drawing, plain).replace(' ', " \\\n");
    assert_eq!(check_obj("joined.obj", &(vertices(&drawing) + &lines)).triangles(), expected);

    for (values, way) in
        [(Values::Words, "words"), (Values::Little, "little"), (Values::Big, "big")]
    {
        for [faces_first, with_list] in [[false, false], [false, true], [true, false], [true, true]]
        {
            let name = format!("{way}, faces first: {faces_first}, with a list: {with_list}.ply");
            let bytes = ply_file(&drawing, values, faces_first, with_list);
            let parsed = ply::parse(&name, &bytes).unwrap();
            assert_eq!(parsed.triangles(), expected, "{name}");
            let [read, streamed] = read_and_streamed(&name, &bytes, Format::Ply);
            assert!(read == expected && streamed == expected, "{name}");
        }
    }
}

#[test]
fn what_corners_have_stays_at_its_corner() {
    let drawing = drawing();
    let expected = expected(&drawing);
    let attributes: String = (0..drawing.positions.len())
        .map(|vertex| format!("vt {vertex}\nvn {vertex} 1 0\n"))
        .collect();
    let with_all = |vertex: usize| format!("{0}/{0}/{0}", vertex + 1);
    let text = attributes.clone() + &faces(&drawing, with_all) + &vertices(&drawing);
    let mesh = check_obj("attributes.obj", &text);
    assert_eq!(mesh.triangles(), expected);
    assert_eq!(mesh.texture_coordinates().corners, expected);
    assert_eq!(mesh.normals().corners, expected);
    // Every third vertex has one, so the entries of the last triangles may be missing.
    let with_some = |vertex: usize| match vertex % 3 {
        0 => format!("{0}//{0}", vertex + 1),
        _ => plain(vertex),
    };
    let text = attributes + &vertices(&drawing) + &faces(&drawing, with_some);
    let mesh = check_obj("some attributes.obj", &text);
    let some = |index: u32| if index.is_multiple_of(3) { index } else { u32::MAX };
    let normals: Vec<[u32; 3]> = expected.iter().map(|corners| corners.map(some)).collect();
    assert_eq!((mesh.triangles(), &mesh.normals().corners), (&expected[..], &normals));
}

#[test]
fn a_large_file_is_cut_on_all_threads_as_a_small_one_is() {
    let drawing = drawing();
    let once = obj::parse("once.obj", (vertices(&drawing) + &faces(&drawing, plain)).as_bytes());
    let (once, count) = (once.unwrap().triangles().to_vec(), drawing.positions.len());
    // A file of this size is read in pieces. Faces before their vertices name those of another piece.
    let mut text = String::new();
    let mut expected = Vec::new();
    for copy in 0_usize.. {
        if text.len() > 3 << 20 {
            break;
        }
        let first = copy * count;
        let below = faces(&drawing, |vertex| plain(first + vertex));
        text += &if copy.is_multiple_of(2) {
            below + &vertices(&drawing)
        } else {
            vertices(&drawing) + &below
        };
        let first = u32::try_from(first).unwrap();
        expected.extend(once.iter().map(|corners| corners.map(|vertex| first + vertex)));
    }
    assert!(check_obj("large.obj", &text).triangles() == expected);
}

#[test]
fn a_polygon_of_more_corners_than_are_cut_is_a_fan_however_it_is_read() {
    let corners = 1 << 15;
    #[expect(clippy::cast_precision_loss, reason = "small numbers")]
    let position = |k: usize| [(k % 2) as f32, k as f32, 0.0];
    let drawing = Drawing {
        positions: (0..corners).map(position).collect(),
        polygons: vec![(0..corners).collect()],
    };
    let text = vertices(&drawing) + &faces(&drawing, plain);
    let mesh = check_obj("very many corners.obj", &text);
    assert_eq!(mesh.triangles()[1000], [0, 1001, 1002]);
    for values in [Values::Words, Values::Little] {
        let bytes = ply_file(&drawing, values, false, false);
        let [read, streamed] = read_and_streamed("very many corners.ply", &bytes, Format::Ply);
        assert!(read == mesh.triangles() && streamed == mesh.triangles());
    }
}
