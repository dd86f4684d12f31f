//! Meshes that several nodes name: stored once where they are large, in the order of the nodes.

use super::*;
use bothways_common::scene::{Instances, Placement};

/// How many times the square is drawn over itself in a mesh of 66 triangles.
const LAYERS: usize = 33;

/// The square with many layers as mesh 0 and one triangle of it as mesh 1, and these nodes.
pub(super) fn with_nodes(nodes: &[String]) -> String {
    let data = data();
    let (start, indices) = data.split_at(128);
    let data = [start, &indices.repeat(LAYERS)].concat();
    let (count, bytes) = (6 * LAYERS, 12 * LAYERS);
    let all: Vec<String> = (0..nodes.len()).map(|node| node.to_string()).collect();
    let of_few = "{ \"primitives\": [{ \"attributes\": { \"POSITION\": 0 }, \"indices\": 4 }] }";
    let few = "{ \"bufferView\": 3, \"componentType\": 5123, \"count\": 3, \"type\": \"SCALAR\" }";
    document(
        &data,
        &[
            ("\"nodes\": [0]", &format!("\"nodes\": [{}]", all.join(","))),
            (
                "[{ \"mesh\": 0 }, { \"camera\": 0, \"name\": \"stand\" }]",
                &format!("[{}]", nodes.join(",")),
            ),
            ("\"indices\": 3 }] }]", &format!("\"indices\": 3 }}] }}, {of_few}]")),
            (
                "\"count\": 6, \"type\": \"SCALAR\" }",
                &format!("\"count\": {count}, \"type\": \"SCALAR\" }}, {few}"),
            ),
            (
                "\"byteOffset\": 128, \"byteLength\": 12 }",
                &format!("\"byteOffset\": 128, \"byteLength\": {bytes} }}"),
            ),
            ("\"byteLength\": 140", &format!("\"byteLength\": {}", 128 + bytes)),
        ],
    )
}

/// A node of a mesh, moved and scaled.
fn node(mesh: usize, k: usize) -> String {
    let scale = if k.is_multiple_of(2) { "[0.5, 0.5, 0.5]" } else { "[-1, 2, 1]" };
    format!("{{ \"mesh\": {mesh}, \"translation\": [{k}, 0, -1], \"scale\": {scale} }}")
}

pub(super) fn model(text: &str) -> Model {
    parse("a", text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn instances_of(shape: &Shape) -> &Instances {
    let Shape::Instances(instances) = shape else { panic!("{shape:?}") };
    instances
}

/// The corners of all triangles in the order of ids, those of each triangle in one order for both sides.
fn corners(shapes: &[Shape]) -> Vec<[Vec3; 3]> {
    let of_shape = |shape: &Shape| -> Vec<[Vec3; 3]> {
        match shape {
            Shape::Mesh(mesh) => (0..mesh.triangles().len()).map(|k| mesh.corners(k)).collect(),
            Shape::Instances(instances) => {
                (0..instances.primitive_count()).map(|k| instances.corners(k)).collect()
            }
            other => panic!("{other:?}"),
        }
    };
    let mut all: Vec<[Vec3; 3]> = shapes.iter().flat_map(of_shape).collect();
    for corners in &mut all {
        corners.sort_by(|a, b| a.to_array().partial_cmp(&b.to_array()).expect("they are finite"));
    }
    all
}

#[test]
fn a_large_mesh_of_many_nodes_is_stored_once() {
    let nodes: Vec<String> = (0..1000).map(|k| node(0, k)).collect();
    let text = with_nodes(&nodes);
    let model = model(&text);
    let [shape] = &model.shapes[..] else { panic!("{}", model.shapes.len()) };
    let instances = instances_of(shape);
    assert_eq!((instances.mesh().triangles().len(), instances.placements().len()), (66, 1000));
    // Few numbers an instance: this is what bounds the memory of many.
    assert_eq!(size_of::<Placement>(), 48);
    // What copies show, to the last bit: with these numbers the maps are exact in f32.
    let given = [crate::source::GivenFile::new("a", text.as_bytes())];
    let (copied, _) = read_as_one(&InputFile::given(&given, 0)).unwrap();
    assert_eq!(corners(&model.shapes), corners(&[Shape::Mesh(copied)]));
}

#[test]
fn few_copies_stay_copies() {
    let nodes: Vec<String> = (0..900).map(|k| node(0, k)).collect();
    assert_eq!(mesh_of(&model(&with_nodes(&nodes))).triangles().len(), 66 * 900);
    // A mesh of one triangle is as small as its place.
    let nodes: Vec<String> = (0..70_000).map(|k| node(1, k)).collect();
    assert_eq!(mesh_of(&model(&with_nodes(&nodes))).triangles().len(), 70_000);
}

#[test]
fn other_meshes_between_its_nodes_keep_their_place_in_the_order() {
    let of = |k: usize| usize::from([3, 4, 900].contains(&k));
    let nodes: Vec<String> = (0..1003).map(|k| node(of(k), k)).collect();
    let text = with_nodes(&nodes);
    let model = model(&text);
    let [first, Shape::Mesh(between), second, Shape::Mesh(alone), third] = &model.shapes[..] else {
        panic!("{}", model.shapes.len())
    };
    assert_eq!((between.triangles().len(), alone.triangles().len()), (2, 1));
    let all = [first, second, third].map(instances_of);
    assert_eq!(all.map(|instances| instances.placements().len()), [3, 895, 102]);
    assert!(all.iter().all(|one| std::sync::Arc::ptr_eq(one.shared_mesh(), all[0].shared_mesh())));
    let given = [crate::source::GivenFile::new("a", text.as_bytes())];
    let (copied, _) = read_as_one(&InputFile::given(&given, 0)).unwrap();
    assert_eq!(corners(&model.shapes), corners(&[Shape::Mesh(copied)]));
}

#[test]
fn an_instance_out_of_range_is_named() {
    let mut nodes: Vec<String> = (0..1000).map(|k| node(0, k)).collect();
    nodes[700] = "{ \"mesh\": 0, \"translation\": [3.4e38, 0, 0], \"scale\": [1e38, 1, 1] }".into();
    assert_eq!(
        fault_of(with_nodes(&nodes)),
        "node 700: it moves its mesh where no f32 number reaches"
    );
    nodes[700] = "{ \"mesh\": 2 }".into();
    let says = "node 700: it names mesh 2, counted from 0, but there are only 2";
    assert_eq!(fault_of(with_nodes(&nodes)), says);
}
