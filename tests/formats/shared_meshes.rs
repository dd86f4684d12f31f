//! A glTF file whose nodes share a mesh: both orders see in its instances what they see in copies.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Frame, Object, Options, Scene, Shape, View};
use bothways::formats::generate::Kind;
use bothways::formats::gltf;
use bothways::formats::source::{GivenFile, InputFile};
use bothways::scenes;
use bothways::{rasterize, raytrace};
use std::fmt::Write;

/// A torus, as the data of a glTF file and as the JSON that places it, with a mirrored and stretched one among many.
fn crowd() -> (Vec<u8>, String) {
    let torus = Kind::Torus.mesh([12, 8]).unwrap();
    let mut data = Vec::new();
    for position in torus.positions() {
        data.extend(position.to_array().iter().flat_map(|number| number.to_le_bytes()));
    }
    let vertices = data.len();
    data.extend(torus.triangles().as_flattened().iter().flat_map(|index| index.to_le_bytes()));
    let mut nodes = String::new();
    let count = 20 * 20;
    for k in 0..count {
        let (x, y, z) = (3 * (k % 20) - 30, (k % 7) - 3, -2 * (k / 20) - 4);
        let scale = if k % 3 == 0 { "[-1, 2, 0.5]" } else { "[1, 1, 1]" };
        write!(nodes, "{{ \"mesh\": 0, \"translation\": [{x}, {y}, {z}], \"scale\": {scale} }},")
            .unwrap();
    }
    let all: Vec<String> = (0..count).map(|node| node.to_string()).collect();
    let json = format!(
        "{{ \"asset\": {{ \"version\": \"2.0\" }}, \"scene\": 0, \"scenes\": [{{ \"nodes\": [{}] }}], \"nodes\": [{}],
        \"meshes\": [{{ \"primitives\": [{{ \"attributes\": {{ \"POSITION\": 0 }}, \"indices\": 1 }}] }}],
        \"accessors\": [
            {{ \"bufferView\": 0, \"componentType\": 5126, \"count\": {}, \"type\": \"VEC3\", \"min\": [-2, -2, -2], \"max\": [2, 2, 2] }},
            {{ \"bufferView\": 1, \"componentType\": 5125, \"count\": {}, \"type\": \"SCALAR\" }}],
        \"bufferViews\": [
            {{ \"buffer\": 0, \"byteLength\": {vertices} }},
            {{ \"buffer\": 0, \"byteOffset\": {vertices}, \"byteLength\": {} }}],
        \"buffers\": [{{ \"byteLength\": {}, \"uri\": \"crowd.bin\" }}] }}",
        all.join(","),
        nodes.trim_end_matches(','),
        torus.positions().len(),
        3 * torus.triangles().len(),
        data.len() - vertices,
        data.len(),
    );
    (data, json)
}

fn frames(scene: &Scene, camera: &Camera) -> [Frame; 2] {
    let view = View::new(scene, camera);
    let options = Options { samples: 2, ..Options::default() };
    [
        rasterize::fast::render(&rasterize::fast::prepare(scene), &view, &options),
        raytrace::fast::render(&raytrace::fast::prepare(scene), &view, &options),
    ]
}

#[test]
fn instances_of_a_gltf_file_have_the_ids_of_copies_in_both_orders() {
    let (data, json) = crowd();
    let given = [GivenFile::new("crowd.gltf", json.as_bytes()), GivenFile::new("crowd.bin", &data)];
    let file = InputFile::given(&given, 0);
    let loaded = scenes::load_file(&file, None).unwrap();
    assert!(matches!(loaded.scene.objects()[0].shape, Shape::Instances(_)), "they share");
    let (mesh, _) = gltf::read_as_one(&file).unwrap();
    let copied = Scene::new(vec![Object::from(Shape::Mesh(mesh))]).unwrap();
    assert_eq!(loaded.scene.primitive_count(), copied.primitive_count());
    let camera = CameraDescription { image: [160, 120], ..loaded.camera };
    let camera = Camera::new(camera).unwrap();
    let [shared, copied] = [&loaded.scene, &copied].map(|scene| frames(scene, &camera));
    let seen: std::collections::BTreeSet<Option<u64>> = copied[0].ids().iter().collect();
    assert!(seen.len() > 1000, "{}", seen.len());
    for frame in [&copied[1], &shared[0], &shared[1]] {
        assert!(frame.ids() == copied[0].ids());
    }
}

#[test]
fn a_scene_file_moves_them_all_or_copies_them_for_its_own_instances() {
    let (data, json) = crowd();
    let primitives = |object: &str| {
        let text = format!(
            "[[object]]\nmesh = 'crowd.gltf'\n{object}\n[[object]]\nplane = {{ point = [0, -9, 0], normal = [0, 1, 0] }}\n"
        );
        let given = [
            GivenFile::new("a.toml", text.as_bytes()),
            GivenFile::new("crowd.gltf", json.as_bytes()),
            GivenFile::new("crowd.bin", &data),
        ];
        let scene = scenes::load_file(&InputFile::given(&given, 0), None).unwrap().scene;
        let is_instances = matches!(scene.objects()[0].shape, Shape::Instances(_));
        let corner = scene.triangle(0).unwrap()[0];
        (scene.primitive_count(), is_instances, corner)
    };
    let (count, shared, corner) = primitives("");
    assert!(shared);
    let (moved_count, moved_shared, moved) = primitives("scale = 2\ntranslate = [1, 0, 0]");
    assert_eq!((moved_count, moved_shared), (count, true));
    let expected = 2.0 * corner + Vec3::X;
    assert!((moved - expected).length() < 1e-4, "{moved} {expected}");
    let (twice, _, first) = primitives("instances = [[0, 0, 0], [100, 0, 0]]");
    assert_eq!((twice, first), (2 * count - 1, corner));
}
