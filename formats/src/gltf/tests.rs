//! Files that the reader accepts, files that break one rule each, and the messages.

mod accessors;
mod instancing;
mod sharing;
mod undrawn;

use super::*;
use crate::source::Reach;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use bothways_common::camera::{Orientation, Projection};
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use std::fs;

/// A square of two triangles: positions, normals, texture coordinates and indices, each in a view of one buffer.
const SQUARE: &str = r#"{
"asset": { "version": "2.0" }, "extensionsUsed": [],
"scene": 0, "scenes": [{ "nodes": [0] }],
"nodes": [{ "mesh": 0 }, { "camera": 0, "name": "stand" }],
"meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2 }, "indices": 3 }] }],
"materials": [{ "name": "red", "pbrMetallicRoughness": { "baseColorFactor": [1, 0.25, 0, 1] } }],
"cameras": [{ "type": "perspective", "perspective": { "yfov": 1.5707963, "znear": 1 } }],
"accessors": [
{ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
{ "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3" },
{ "bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2" },
{ "bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR" }],
"bufferViews": [
{ "buffer": 0, "byteOffset": 0, "byteLength": 48 },
{ "buffer": 0, "byteOffset": 48, "byteLength": 48 },
{ "buffer": 0, "byteOffset": 96, "byteLength": 32 },
{ "buffer": 0, "byteOffset": 128, "byteLength": 12 }],
"buffers": [{ "byteLength": 140, "uri": "DATA" }] }"#;

/// The nodes of the square.
const NODES: &str = "[{ \"mesh\": 0 }, { \"camera\": 0, \"name\": \"stand\" }]";

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The buffer of the square.
fn data() -> Vec<u8> {
    let normals = [[0.0_f32, 0.0, 1.0]; 4];
    let texture = CORNERS.map(|[x, y, _]| [x, y]);
    let floats =
        CORNERS.as_flattened().iter().chain(normals.as_flattened()).chain(texture.as_flattened());
    let floats = floats.flat_map(|number| number.to_le_bytes());
    floats.chain([0_u16, 1, 2, 0, 2, 3].into_iter().flat_map(u16::to_le_bytes)).collect()
}

/// The square with changes, and with this data.
fn document(data: &[u8], changes: &[(&str, &str)]) -> String {
    let mut text = SQUARE.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text.replace("DATA", &format!("data:application/octet-stream;base64,{}", STANDARD.encode(data)))
}

/// The mesh of a model that has one.
fn mesh_of(model: &Model) -> &Mesh {
    let [Shape::Mesh(mesh)] = &model.shapes[..] else { panic!("{:?}", model.shapes) };
    mesh
}

fn square(changes: &[(&str, &str)]) -> Model {
    parse("a", document(&data(), changes).as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// What is said about the square with changes.
fn fault(changes: &[(&str, &str)]) -> String {
    fault_of(document(&data(), changes))
}

fn fault_of(bytes: impl AsRef<[u8]>) -> String {
    let says = parse("a", bytes.as_ref()).map(|_| ()).unwrap_err().to_string();
    says.strip_prefix("a: ").expect("it names the file").to_owned()
}

/// A binary file.
fn binary(json: &str, bin: Option<&[u8]>) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], content: &[u8], padding: u8| {
        let mut bytes = content.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), padding);
        [&u32::try_from(bytes.len()).unwrap().to_le_bytes(), &kind[..], &bytes].concat()
    };
    let mut chunks = chunk(b"JSON", json.as_bytes(), b' ');
    chunks.extend(bin.map(|bin| chunk(b"BIN\0", bin, 0)).unwrap_or_default());
    let length = u32::try_from(12 + chunks.len()).unwrap();
    [b"glTF", &2_u32.to_le_bytes()[..], &length.to_le_bytes(), &chunks].concat()
}

#[test]
fn a_square_is_read_from_text_and_from_a_binary_file() {
    let model = square(&[]);
    assert_eq!(mesh_of(&model).positions(), CORNERS.map(Vec3::from_array));
    assert_eq!(mesh_of(&model).triangles(), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh_of(&model).normals().of(0), Some([Vec3::Z; 3]));
    assert_eq!(mesh_of(&model).texture_coordinates().of(0), Some([Vec2::Y, Vec2::ONE, Vec2::X]));
    assert!(model.cameras.is_empty() && model.warnings.is_empty());
    let json = SQUARE.replace(", \"uri\": \"DATA\"", "");
    assert_eq!(parse("a", &binary(&json, Some(&data()))).unwrap(), model);
    assert_eq!(
        fault_of(json),
        "buffer 0: it has no uri, and the file has no binary part that would be meant"
    );
}

#[test]
fn nodes_move_what_they_hold_and_a_mesh_may_be_there_twice() {
    let nodes = r#"[{ "mesh": 0, "translation": [0, 0, 5], "scale": [2, 2, 2], "children": [1] },
                    { "mesh": 0, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1] }]"#;
    let model = square(&[(r#"[{ "mesh": 0 }, { "camera": 0, "name": "stand" }]"#, nodes)]);
    let mesh = mesh_of(&model);
    assert_eq!(mesh.triangles().len(), 4);
    assert_eq!(
        mesh.corners(0).map(|p| p.to_array()),
        [[0.0, 0.0, 5.0], [2.0, 0.0, 5.0], [2.0, 2.0, 5.0]]
    );
    // The mirror in x turns the triangle, so that the normal stays on its outside.
    assert_eq!(
        mesh.corners(2).map(|p| p.to_array()),
        [[6.0, 0.0, 5.0], [4.0, 2.0, 5.0], [4.0, 0.0, 5.0]]
    );
    assert_eq!(mesh.normals().of(2), Some([Vec3::Z; 3]));
    let turned = r#"[{ "mesh": 0, "rotation": [0, 0.70710677, 0, 0.70710677] }]"#;
    let model = square(&[(r#"[{ "mesh": 0 }, { "camera": 0, "name": "stand" }]"#, turned)]);
    let mesh = mesh_of(&model);
    assert!((mesh.corners(0)[1] - Vec3::NEG_Z).length() < 1e-6);
    assert!((mesh.normals().of(0).unwrap()[0] - Vec3::X).length() < 1e-6);
}

#[test]
fn strips_and_fans_become_triangles_in_the_order_of_the_specification() {
    let mode = |mode| mesh_of(&square(&[("\"indices\": 3", mode)])).triangles().to_vec();
    assert_eq!(mode(r#""indices": 3, "mode": 5"#), [[0, 1, 2], [1, 0, 2], [2, 0, 2], [0, 3, 2]]);
    assert_eq!(mode(r#""mode": 5"#), [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(mode(r#""mode": 6"#), [[1, 2, 0], [2, 3, 0]]);
    let says = fault(&[("\"indices\": 3", "\"mode\": 1")]);
    assert_eq!(says, "its scene has no triangles, so nothing to draw");
    let says = fault(&[(", \"indices\": 3", "")]);
    assert_eq!(says, "mesh 0, primitive 0: it has 4 corners, and triangles need a multiple of 3");
}

#[test]
fn materials_have_their_base_color() {
    let with = |material: &str| {
        square(&[
            ("\"indices\": 3", "\"indices\": 3, \"material\": 0"),
            ("\"name\": \"red\",", material),
        ])
    };
    let model = with("\"name\": \"red\",");
    let material = mesh_of(&model).materials().unwrap().of(1).unwrap();
    assert_eq!(material.color, Vec3::new(1.0, 0.25, 0.0));
    assert_eq!(mesh_of(&model).materials().unwrap().named()[0].name, "red");
    assert_eq!(mesh_of(&with("")).materials().unwrap().named()[0].name, "#0");
    let says = fault(&[("\"indices\": 3", "\"indices\": 3, \"material\": 0"), ("0.25", "2.5")]);
    assert_eq!(says, "node 0: its base colour has a component that is not from 0 to 1");
}

#[test]
fn a_diffuse_color_and_texture_go_before_those_of_the_base() {
    const NAME: &str = "KHR_materials_pbrSpecularGlossiness";
    let with = |base: &str, diffuse: &str| {
        let material = format!(
            "\"pbrMetallicRoughness\": {{ {base} }}, \"extensions\": {{ \"{NAME}\": {{ {diffuse} }} }}"
        );
        let images = "\"textures\": [{ \"source\": 0 }, { \"source\": 1 }], \"images\": [{ \"uri\": \"base.png\" }, \
                      { \"uri\": \"diffuse.png\" }], \"cameras\": [";
        let model = square(&[
            ("\"indices\": 3", "\"indices\": 3, \"material\": 0"),
            ("\"pbrMetallicRoughness\": { \"baseColorFactor\": [1, 0.25, 0, 1] }", &material),
            ("\"cameras\": [", images),
            ("\"extensionsUsed\": []", &format!("\"extensionsRequired\": [\"{NAME}\"]")),
        ]);
        let says: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
        let has_coordinates = mesh_of(&model).texture_coordinates().of(0).is_some();
        let color = mesh_of(&model).materials().unwrap().of(0).unwrap().color;
        (color, has_coordinates, says.concat())
    };
    let base = "\"baseColorFactor\": [1, 0, 0, 1], \"baseColorTexture\": { \"index\": 0 }";
    let diffuse =
        "\"diffuseFactor\": [0, 0.5, 1, 1], \"diffuseTexture\": { \"index\": 1, \"texCoord\": 1 }";
    let (color, has_coordinates, says) = with(base, diffuse);
    assert_eq!(
        (color, has_coordinates),
        (Vec3::new(0.0, 0.5, 1.0), false),
        "there is no TEXCOORD_1"
    );
    // No picture is there, and only the one that would be drawn is missed.
    assert!(says.contains("\"diffuse.png\"") && !says.contains("base.png"), "{says}");
    assert_eq!(with(base, ""), (Vec3::ONE, true, String::new()), "white if it states nothing");
}

/// The square with a texture of an image that is stated so.
fn image(image: &str) -> [(&'static str, String); 3] {
    let texture = "[1, 0.25, 0, 1], \"baseColorTexture\": { \"index\": 0 }";
    let list =
        format!("\"textures\": [{{ \"source\": 0 }}], \"images\": [{image}], \"cameras\": [");
    [
        ("\"indices\": 3", "\"indices\": 3, \"material\": 0".to_owned()),
        ("[1, 0.25, 0, 1]", texture.to_owned()),
        ("\"cameras\": [", list),
    ]
}

#[test]
fn images_that_are_wrong_say_why() {
    let fault_of = |stated: &str| {
        let changes = image(stated);
        fault(&changes.each_ref().map(|(from, to)| (*from, to.as_str())))
    };
    for (stated, says) in [
        ("{}", "node 0: image 0 has neither a uri nor a view"),
        (
            "{ \"bufferView\": 99 }",
            "node 0: it names view 99, counted from 0, but there are only 4",
        ),
        (
            "{ \"bufferView\": 0 }",
            "node 0: image 0: its data is no picture (PNG, JPEG, BMP or PNM); save it as one of these",
        ),
        (
            "{ \"uri\": \"data:image/png;base64,AAAA\" }",
            "node 0: image 0: its data is no picture (PNG, JPEG, BMP or PNM); save it as one of these",
        ),
        (
            "{ \"uri\": \"data:image/png,AAAA\" }",
            "node 0: the URI \"data:image/png,AAAA\" cannot be read; data must be in base64",
        ),
    ] {
        assert_eq!(fault_of(stated), says, "{stated}");
    }
    let changes = image("{ \"uri\": \"../a.png\" }");
    let model = square(&changes.each_ref().map(|(from, to)| (*from, to.as_str())));
    let says = "a: the picture \"../a.png\" was not opened with it (open or drop both together); what has it as its texture is drawn without";
    assert_eq!(model.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(), [says]);
    assert_eq!(mesh_of(&model).materials().unwrap().of(0).unwrap().texture, None);
}

/// The square with a texture whose coordinates are moved so.
fn moved_texture(transform: &str) -> Vec<(String, String)> {
    let texture = format!(
        "\"baseColorTexture\": {{ \"index\": 0, \"texCoord\": 1, \"extensions\": {{ \"KHR_texture_transform\": {transform} }} }}"
    );
    [
        ("\"indices\": 3 }", "\"indices\": 3, \"material\": 0 }".to_owned()),
        ("\"baseColorFactor\": [1, 0.25, 0, 1]", texture),
        (
            "\"extensionsUsed\": []",
            "\"extensionsRequired\": [\"KHR_texture_transform\"], \"textures\": [{ \"source\": 0 }], \
             \"images\": [{ \"uri\": \"a.png\" }]"
                .to_owned(),
        ),
        ("\"NORMAL\": 1, \"TEXCOORD_0\": 2", "\"TEXCOORD_0\": 2, \"TEXCOORD_1\": 2".to_owned()),
    ]
    .map(|(from, to)| (from.to_owned(), to))
    .to_vec()
}

/// The example of the specification: the lower left quarter of the picture, turned clockwise.
#[test]
fn a_transform_of_a_texture_moves_its_coordinates() {
    let coordinates = |transform: &str| {
        let changes = moved_texture(transform);
        let changes: Vec<(&str, &str)> =
            changes.iter().map(|(from, to)| (from.as_str(), to.as_str())).collect();
        let model = square(&changes);
        let all = mesh_of(&model).texture_coordinates();
        // Of the corners at (0, 0), (1, 0), (1, 1) and (0, 1) in the format's coordinates, whose v runs down.
        let [[a, b, c], [_, _, d]] = [0, 1].map(|triangle| all.of(triangle).unwrap());
        [a, b, c, d].map(|ours| Vec2::new(ours.x, 1.0 - ours.y))
    };
    let of_example =
        coordinates("{ \"offset\": [0, 1], \"rotation\": 1.57079632679, \"scale\": [0.5, 0.5] }");
    let expected = [[0.0, 1.0], [0.0, 0.5], [0.5, 0.5], [0.5, 1.0]].map(Vec2::from_array);
    for (found, expected) in of_example.iter().zip(expected) {
        assert!((*found - expected).length() < 1e-6, "{of_example:?}");
    }
    // The other example: v runs up.
    let inverted = coordinates("{ \"offset\": [0, 1], \"scale\": [1, -1], \"texCoord\": 0 }");
    let expected = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from_array);
    assert_eq!(inverted, expected);
    assert_eq!(
        coordinates("{}"),
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from_array)
    );
    let far = moved_texture("{ \"offset\": [3e38, 0], \"scale\": [3e38, 1] }");
    let far: Vec<(&str, &str)> =
        far.iter().map(|(from, to)| (from.as_str(), to.as_str())).collect();
    let says = "mesh 0, primitive 0: the KHR_texture_transform of its texture moves coordinates where no f32 number reaches";
    assert_eq!(fault(&far), says);
}

#[test]
fn cameras_become_those_of_the_lecture() {
    let camera = |changes: &[(&str, &str)]| {
        let held = ("\"nodes\": [0]", "\"nodes\": [0, 1]");
        square(&[&[held], changes].concat()).cameras.remove(0)
    };
    let wide = camera(&[]);
    assert_eq!((wide.name.as_str(), wide.aspect_stated), ("stand", false));
    assert!((wide.camera.distance - 0.5).abs() < 1e-6, "{}", wide.camera.distance);
    assert_eq!(wide.camera.viewport, [640.0 / 480.0, 1.0]);
    let named = camera(&[
        ("\"znear\": 1", "\"znear\": 1, \"aspectRatio\": 1.5"),
        ("\"type\": \"p", "\"name\": \"eye\", \"type\": \"p"),
        ("\"camera\": 0", "\"camera\": 0, \"translation\": [1, 2, 3], \"rotation\": [0, 1, 0, 0]"),
    ]);
    assert_eq!((named.name.as_str(), named.aspect_stated), ("eye", true));
    assert_eq!((named.camera.viewport, named.camera.image), ([1.5, 1.0], [720, 480]));
    let (u, v, w) = (Vec3::NEG_X, Vec3::Y, Vec3::NEG_Z);
    assert_eq!(
        (named.camera.eye, named.camera.orientation),
        (Vec3::new(1.0, 2.0, 3.0), Orientation::Frame { u, v, w })
    );
    let parallel = "\"orthographic\": { \"xmag\": 2, \"ymag\": 1, \"znear\": 0, \"zfar\": 9";
    let parallel =
        camera(&[("\"perspective\": { \"yfov\": 1.5707963, \"znear\": 1", parallel)]).camera;
    assert_eq!(
        (parallel.projection, parallel.viewport, parallel.image),
        (Projection::Parallel, [4.0, 2.0], [960, 480])
    );
    let held = ("\"nodes\": [0]", "\"nodes\": [0, 1]");
    assert_eq!(
        fault(&[held, ("1.5707963", "3.5")]),
        "camera 0: its yfov is 3.5; it must be between 0 and pi"
    );
    assert_eq!(
        fault(&[held, ("\"camera\": 0", "\"camera\": 7")]),
        "node 1: it names camera 7, counted from 0, but there is only 1"
    );
    assert_eq!(
        fault(&[held, ("\"camera\": 0", "\"camera\": 0, \"scale\": [0, 1, 1]")]),
        "camera 0: its transformation has a number that is not finite"
    );
}

/// The rules for accessors, views and buffers, one by one: 3.6 of the specification.
#[test]
fn nodes_that_form_no_trees_are_refused() {
    let nodes = |nodes: &str| {
        fault(&[("[{ \"mesh\": 0 }, { \"camera\": 0, \"name\": \"stand\" }]", nodes)])
    };
    let twice = "it is reached twice: by a circle of nodes, or from two parents";
    assert_eq!(nodes(r#"[{ "children": [0] }]"#), format!("node 0: {twice}"));
    assert_eq!(nodes(r#"[{ "children": [1] }, { "children": [0] }]"#), format!("node 0: {twice}"));
    assert_eq!(
        nodes(r#"[{ "children": [1, 2] }, { "children": [2] }, {}]"#),
        format!("node 2: {twice}")
    );
    assert_eq!(
        nodes(r#"[{ "children": [5] }]"#),
        "node 0: it names node 5, counted from 0, but there is only 1"
    );
    assert_eq!(
        nodes(r#"[{ "mesh": 5 }]"#),
        "node 0: it names mesh 5, counted from 0, but there is only 1"
    );
    assert_eq!(
        nodes(r#"[{ "mesh": 0, "scale": [1e38, 1, 1], "translation": [3.4e38, 0, 0] }]"#),
        "node 0: it moves vertex 1 of its mesh where no f32 number reaches"
    );
    let two = "node 0: it has a matrix, and translation, rotation or scale as well; one excludes the other";
    assert_eq!(
        nodes(
            r#"[{ "mesh": 0, "scale": [1, 1, 1], "matrix": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1] }]"#
        ),
        two
    );
    assert_eq!(
        nodes(r#"[{ "mesh": 0, "translation": [1e39, 0, 0] }]"#),
        "its JSON is not that of a glTF file: number out of range at line 4 column 43"
    );
    let scale = |k| format!("{{ \"scale\": [1e38, 1, 1], \"children\": [{k}] }}");
    let scales: Vec<String> = (1..=9).map(scale).collect();
    assert_eq!(
        nodes(&format!("[{}, {{ \"mesh\": 0 }}]", scales.join(","))),
        "node 8: its transformation has a number that is not finite"
    );
    assert_eq!(
        fault(&[("\"scene\": 0", "\"scene\": 3")]),
        "it names scene 3, counted from 0, but there is only 1"
    );
    // A chain as long as the file does not overflow the stack.
    let chain: Vec<String> = (1..100_000).map(|k| format!("{{\"children\":[{k}]}}")).collect();
    let text = format!("[{}, {{ \"mesh\": 0 }}]", chain.join(","));
    let model = square(&[("[{ \"mesh\": 0 }, { \"camera\": 0, \"name\": \"stand\" }]", &text)]);
    assert_eq!(mesh_of(&model).triangles().len(), 2);
    // Many nodes of one mesh take more memory than the file.
    let many = vec!["{\"mesh\":0}"; 1000].join(",");
    let all: Vec<String> = (0..1000).map(|k| k.to_string()).collect();
    let model = square(&[
        ("[{ \"mesh\": 0 }, { \"camera\": 0, \"name\": \"stand\" }]", &format!("[{many}]")),
        ("\"nodes\": [0]", &format!("\"nodes\": [{}]", all.join(","))),
    ]);
    assert_eq!(mesh_of(&model).triangles().len(), 2000);
}

#[test]
fn without_scenes_all_nodes_without_a_parent_are_drawn() {
    let scenes = "\"scene\": 0, \"scenes\": [{ \"nodes\": [0] }],";
    let nodes = ("[{ \"mesh\": 0 },", "[{ \"mesh\": 0, \"children\": [2] }, { \"mesh\": 0 },");
    assert_eq!(mesh_of(&square(&[(scenes, ""), nodes])).triangles().len(), 4);
    assert_eq!(mesh_of(&square(&[("\"scene\": 0, ", "")])).triangles().len(), 2);
}

#[test]
fn what_applications_add_of_their_own_is_skipped() {
    for extras in ["{ \"a\": [1, {}] }", "\"text\"", "3", "null", "[[]]"] {
        let changes = [("\"mesh\": 0", &format!("\"mesh\": 0, \"extras\": {extras}")[..])];
        assert_eq!(mesh_of(&square(&changes)).triangles().len(), 2, "{extras}");
    }
    let unknown = [
        ("\"mesh\": 0", "\"mesh\": 0, \"extensions\": { \"X_own\": { \"a\": [] } }, \"own\": 1"),
        ("\"NORMAL\": 1,", "\"_OWN\": 1,"),
    ];
    assert_eq!(mesh_of(&square(&unknown)).triangles().len(), 2);
}

#[test]
fn containers_and_versions_that_are_not_read_say_so() {
    assert_eq!(fault_of(""), "the file is empty");
    assert_eq!(
        fault_of("v 0 0 0"),
        "this is no glTF file: it begins neither with \"glTF\" nor with JSON"
    );
    assert!(fault_of("{ \"asset\": 3 }").starts_with("its JSON is not that of a glTF file: "));
    assert!(fault_of("{ \u{1b}[2J").starts_with("its JSON is not that of a glTF file: "));
    assert_eq!(fault(&[("\"2.0\"", "\"1.0\"")]), "it is of version \"1.0\", and only 2.0 is read");
    assert_eq!(
        fault(&[("\"2.0\"", "\"2.1\", \"minVersion\": \"2.1\"")]),
        "it is of version \"2.1\", and only 2.0 is read"
    );
    let says = "it requires the extension \"KHR_draco_mesh_compression\", which is not supported; export it without (without \
                compression, for example)";
    assert_eq!(
        fault(&[(
            "\"extensionsUsed\": []",
            "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]"
        )]),
        says
    );
    let whole = binary(SQUARE, None);
    let changed = |at: usize, bytes: &[u8]| {
        let mut whole = whole.clone();
        whole[at..at + bytes.len()].copy_from_slice(bytes);
        fault_of(whole)
    };
    assert_eq!(changed(4, &[1]), "a binary glTF file of version 1 is not read, only of version 2");
    assert_eq!(
        changed(8, &[0; 4]),
        format!(
            "it should have 0 bytes, but has {}; is the length in its header wrong?",
            whole.len()
        )
    );
    assert_eq!(
        changed(8, &[0xff; 4]),
        format!("it should have 4294967295 bytes, but has {}; is it truncated?", whole.len())
    );
    assert_eq!(
        changed(12, &[0xff; 4]),
        format!("a chunk of 4294967295 bytes begins where only {} are left", whole.len() - 20)
    );
    assert_eq!(changed(16, b"BIN\0"), "its first chunk is no JSON, or no chunk at all");
    assert_eq!(fault_of(b"glTF\x02\0\0\0"), "it should have 12 bytes, but has 8; is it truncated?");
    let objects = format!("{{\"nodes\":[{}]}}", vec!["{}"; 1 << 20].join(","));
    assert_eq!(fault_of(objects), "its JSON has more than 1048576 objects; split the scene up");
    let names = format!("{{\"extensions\":{{{}", "\"\":0,".repeat(1 << 23));
    assert_eq!(fault_of(names), "its JSON has more than 8388608 names; split the scene up");
}

#[test]
fn buffers_beside_the_file_are_read_and_no_others() {
    let home = std::env::temp_dir().join(format!("bothways-gltf-{}", std::process::id()));
    let folder = home.join("inside");
    fs::create_dir_all(folder.join("deep")).unwrap();
    for name in ["outside.bin", "inside/a b.bin", "inside/deep/c.bin"] {
        fs::write(home.join(name), data()).unwrap();
    }
    let path = folder.join("a.gltf");
    let with = |uri: &str| {
        fs::write(&path, SQUARE.replace("DATA", uri)).unwrap();
        let says = read(&InputFile::on_disk(&path, Reach::Folder))
            .map(|model| mesh_of(&model).triangles().len());
        says.map_err(|error| error.to_string().replace(&path.display().to_string(), "a"))
    };
    for uri in ["a%20b.bin", "a b.bin", "./a%20b.bin", "deep/c.bin", "deep/../a%20b.bin"] {
        assert_eq!(with(uri), Ok(2), "{uri}");
    }
    let outside = "is not in the folder of the file that was opened, or below it; move it there, or allow it with \
                   --allow-outside";
    let absolute = home.join("outside.bin").display().to_string();
    for uri in [
        "../outside.bin",
        "deep/../../outside.bin",
        "%2e%2e/outside.bin",
        "/etc/passwd",
        &absolute,
        "C:/a.bin",
    ] {
        let says = with(uri).unwrap_err();
        assert!(says.starts_with("a: buffer 0: \"") && says.ends_with(outside), "{uri}: {says}");
    }
    for uri in ["file:///etc/passwd", "http://example.org/a.bin"] {
        let says =
            "is a URL, and nothing is fetched; download the file, and name it by a relative path";
        assert_eq!(with(uri), Err(format!("a: buffer 0: {uri:?} {says}")));
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(home.join("outside.bin"), folder.join("link.bin")).unwrap();
        assert!(with("link.bin").unwrap_err().ends_with(outside));
    }
    assert!(with("none.bin").unwrap_err().ends_with("none.bin: there is no such file"));
    assert!(with("").unwrap_err().ends_with("this is a folder, not the data of a buffer"));
    assert!(with("data:text/plain,hello").unwrap_err().ends_with("data must be in base64"));
    assert!(with("data:;base64,*").unwrap_err().ends_with("its data is no base64"));
    let alone = parse("a", SQUARE.replace("DATA", "a b.bin").as_bytes()).unwrap_err().to_string();
    assert!(alone.contains("\"a b.bin\" is not among the opened files"), "{alone}");
    fs::remove_dir_all(&home).unwrap();
}

/// Numbers and words of the square that can be exchanged for others.
fn damaged() -> impl Strategy<Value = String> {
    let numbers = prop_oneof![
        "[0-9]{1,3}",
        Just("-1".to_owned()),
        Just("4294967296".to_owned()),
        Just("5121".to_owned()),
        Just("5125".to_owned()),
        Just("1e30".to_owned()),
        Just("18446744073709551615".to_owned())
    ];
    proptest::collection::vec((any::<prop::sample::Index>(), numbers), 1..4).prop_map(|changes| {
        let mut text = document(
            &data(),
            &[
                ("\"nodes\": [0]", "\"nodes\": [0, 1]"),
                ("\"count\": 6", "\"count\": 6, \"byteOffset\": 0"),
            ],
        );
        for (place, number) in changes {
            let end = text.find("\"buffers\"").unwrap();
            let places: Vec<usize> =
                text[..end].match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
            let at = places[place.index(places.len())];
            let length = text[at..].bytes().take_while(u8::is_ascii_digit).count();
            text.replace_range(at..at + length, &number);
        }
        text
    })
}

proptest! {
    #[test]
    fn no_numbers_make_the_reader_panic(text in damaged()) {
        // `Mesh` itself checks what is accepted.
        let _ = parse("a", text.as_bytes());
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        damage in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in proptest::option::weighted(0.3, any::<prop::sample::Index>()),
    ) {
        let mut bytes = binary(&SQUARE.replace(", \"uri\": \"DATA\"", ""), Some(&data()));
        for (place, byte) in damage {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        bytes.truncate(cut.map_or(bytes.len(), |cut| cut.index(bytes.len())));
        let _ = parse("a", &bytes);
    }
}
