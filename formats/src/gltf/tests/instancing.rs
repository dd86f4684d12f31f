//! Nodes whose mesh `EXT_mesh_gpu_instancing` puts at several places.

use super::sharing::{instances_of, model, with_nodes};
use super::*;

/// Values of an attribute of the extension, as an accessor describes them.
struct List {
    attribute: &'static str,
    kind: &'static str,
    component: &'static str,
    count: usize,
    bytes: Vec<u8>,
}

fn floats<const N: usize>(attribute: &'static str, values: &[[f32; N]]) -> List {
    let bytes = values.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    let kind = if N == 4 { "VEC4" } else { "VEC3" };
    List { attribute, kind, component: "5126", count: values.len(), bytes }
}

/// A node of mesh 0, at the places of all lists, with more members.
fn node_with(members: &str) -> String {
    let extension = "\"extensions\": { \"EXT_mesh_gpu_instancing\": ATTRIBUTES }";
    format!("{{ \"mesh\": 0, {extension}{members} }}")
}

/// A file with these lists in a second buffer. `ATTRIBUTES` in its text becomes what the extension states about them.
fn with_lists(text: &str, lists: &[List]) -> String {
    let first = text.matches("\"componentType\"").count();
    let (mut accessors, mut views, mut stated) = (String::new(), String::new(), Vec::new());
    let mut bytes = Vec::new();
    for (k, list) in lists.iter().enumerate() {
        let List { attribute, kind, component, count, .. } = list;
        let (offset, length) = (bytes.len(), list.bytes.len());
        bytes.extend_from_slice(&list.bytes);
        accessors += &format!(
            ", {{ \"bufferView\": {}, \"componentType\": {component}, \"count\": {count}, \"type\": \"{kind}\" }}",
            4 + k
        );
        views +=
            &format!(", {{ \"buffer\": 1, \"byteOffset\": {offset}, \"byteLength\": {length} }}");
        stated.push(format!("\"{attribute}\": {}", first + k));
    }
    let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes));
    let buffer = format!(", {{ \"byteLength\": {}, \"uri\": \"{uri}\" }}] }}", bytes.len());
    let text = text.replace("}],\n\"bufferViews\"", &format!("}}{accessors}],\n\"bufferViews\""));
    let text = text.replace("}],\n\"buffers\"", &format!("}}{views}],\n\"buffers\""));
    let text = text.strip_suffix("] }").expect("it ends with its buffers").to_owned() + &buffer;
    let attributes = format!("{{ \"attributes\": {{ {} }} }}", stated.join(", "));
    text.replace("ATTRIBUTES", &attributes)
}

/// The square at the places of these lists, in a node with more members.
fn at_places(members: &str, lists: &[List]) -> String {
    let node = format!("[{}]", node_with(members));
    with_lists(&document(&data(), &[(NODES, &node)]), lists)
}

/// What is said about the square at the places of these lists.
fn fault_at(lists: &[List]) -> String {
    fault_of(at_places("", lists))
}

/// Scale, rotation and translation of an instance.
type Parts = ([f32; 3], [f32; 4], [f32; 3]);

/// Numbers that are not zero, so that each part has a meaning of its own.
fn parts() -> impl Strategy<Value = Parts> {
    let some = || prop_oneof![-3.0_f32..-0.25, 0.25_f32..3.0];
    let three = || [some(), some(), some()];
    (three(), [some(), some(), some(), some()], three())
}

/// The lists of those parts that are stated, and nodes that state the same.
fn stated(all: &[Parts], [scale, rotation, translation]: [bool; 3]) -> (Vec<List>, Vec<String>) {
    let mut lists = Vec::new();
    if translation {
        lists.push(floats("TRANSLATION", &all.iter().map(|parts| parts.2).collect::<Vec<_>>()));
    }
    if scale {
        lists.push(floats("SCALE", &all.iter().map(|parts| parts.0).collect::<Vec<_>>()));
    }
    if rotation {
        lists.push(floats("ROTATION", &all.iter().map(|parts| parts.1).collect::<Vec<_>>()));
    }
    let node = |(scaled, rotated, moved): &Parts| {
        let mut node = "\"mesh\": 0".to_owned();
        for (is_stated, member) in [
            (scale, format!(", \"scale\": {scaled:?}")),
            (rotation, format!(", \"rotation\": {rotated:?}")),
            (translation, format!(", \"translation\": {moved:?}")),
        ] {
            node += if is_stated { &member } else { "" };
        }
        format!("{{ {node} }}")
    };
    (lists, all.iter().map(node).collect())
}

proptest! {
    /// The nodes are children of one that stands where the node of the instances does.
    #[test]
    fn instances_are_where_nodes_with_their_transformations_would_be(
        all in proptest::collection::vec(parts(), 1..9),
        parent in parts(),
        is_stated in any::<[bool; 3]>().prop_filter("one is stated", |stated| stated.contains(&true)),
    ) {
        let (scale, rotation, translation) = parent;
        let place = format!(
            ", \"scale\": {scale:?}, \"rotation\": {rotation:?}, \"translation\": {translation:?}"
        );
        let (lists, children) = stated(&all, is_stated);
        let numbers: Vec<String> = (1..=all.len()).map(|k| k.to_string()).collect();
        let nodes =
            format!("[{{ \"children\": [{}]{place} }}, {}]", numbers.join(","), children.join(","));
        let separate = square(&[(NODES, &nodes)]);
        prop_assert_eq!(&model(&at_places(&place, &lists)), &separate);
        prop_assert_eq!(mesh_of(&separate).triangles().len(), 2 * all.len());
    }
}

#[test]
fn instances_come_in_the_order_of_the_file() {
    let places = [[5.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 1.0]];
    let model = model(&at_places("", &[floats("TRANSLATION", &places)]));
    let mesh = mesh_of(&model);
    let firsts = [0, 2, 4].map(|triangle| mesh.corners(triangle)[0].to_array());
    assert_eq!((mesh.triangles().len(), firsts), (6, places));
}

#[test]
fn a_large_mesh_at_many_places_of_nodes_in_a_row_is_stored_once() {
    let all: Vec<Parts> = (0_u8..=249)
        .map(|k| ([0.5, 2.0, -1.0], [0.0, 0.0, 0.0, 1.0], [f32::from(k), 0.0, -1.0]))
        .collect();
    let (lists, separate) = stated(&all, [true, true, true]);
    let alone = "{ \"mesh\": 0 }".to_owned();
    let nodes: Vec<String> =
        [vec![alone.clone()], vec![node_with(""); 4], vec![alone.clone()]].concat();
    let found = model(&with_lists(&with_nodes(&nodes), &lists));
    let [shape] = &found.shapes[..] else { panic!("{}", found.shapes.len()) };
    assert_eq!(instances_of(shape).placements().len(), 1 + 4 * 250 + 1);
    let nodes = [vec![alone.clone()], vec![separate; 4].concat(), vec![alone]].concat();
    assert_eq!(found, model(&with_nodes(&nodes)));
}

#[test]
fn rotations_are_floats_or_normalized_bytes_or_shorts() {
    // A quarter about z. Integers are not of unit length, so they are made so.
    let quarter = |component: &'static str, bytes: Vec<u8>| {
        let list = List { attribute: "ROTATION", kind: "VEC4", component, count: 1, bytes };
        let model = model(&at_places("", &[list]));
        mesh_of(&model).corners(0)[1]
    };
    let shorts = [0_i16, 0, 23170, 23170].into_iter().flat_map(i16::to_le_bytes).collect();
    let floats = [0.0_f32, 0.0, 0.5, 0.5].into_iter().flat_map(f32::to_le_bytes).collect();
    for (component, bytes) in [
        ("5120, \"normalized\": true", vec![0, 0, 90, 90]),
        ("5122, \"normalized\": true", shorts),
        ("5126", floats),
    ] {
        let corner = quarter(component, bytes);
        assert!((corner - Vec3::Y).length() < 1e-6, "{component}: {corner}");
    }
}

#[test]
fn children_and_cameras_of_a_node_with_instances_are_there_once() {
    let first = node_with(", \"camera\": 0, \"children\": [1]");
    let nodes = format!("[{first}, {{ \"mesh\": 0 }}]");
    let text = document(&data(), &[(NODES, &nodes)]);
    let model = model(&with_lists(&text, &[floats("TRANSLATION", &[[1.0, 0.0, 0.0]; 3])]));
    assert_eq!((mesh_of(&model).triangles().len(), model.cameras.len()), (8, 1));
    assert_eq!(mesh_of(&model).corners(6)[0], Vec3::ZERO);
    // What has no mesh has nothing to put anywhere, so nothing is asked for.
    let nothing = "{ \"extensions\": { \"EXT_mesh_gpu_instancing\": 3 } }]";
    let nodes = NODES.replace("{ \"camera\": 0, \"name\": \"stand\" }]", nothing);
    let model = square(&[(NODES, &nodes), ("\"nodes\": [0]", "\"nodes\": [0, 1]")]);
    assert_eq!(mesh_of(&model).triangles().len(), 2);
}

#[test]
fn a_file_may_require_the_extension() {
    let required = "\"extensionsRequired\": [\"EXT_mesh_gpu_instancing\"]";
    let text = at_places("", &[floats("SCALE", &[[2.0; 3]; 2])]);
    let model = model(&text.replace("\"extensionsUsed\": []", required));
    assert_eq!(mesh_of(&model).triangles().len(), 4);
}

#[test]
fn instances_that_break_a_rule_are_refused_with_their_node() {
    let says = "node 0: its EXT_mesh_gpu_instancing has 3 elements of SCALE, but 2 of TRANSLATION";
    let two = || floats("TRANSLATION", &[[0.0; 3]; 2]);
    assert_eq!(fault_at(&[floats("SCALE", &[[1.0; 3]; 3]), two()]), says);
    let says =
        "node 0: its EXT_mesh_gpu_instancing has 1 elements of ROTATION, but 2 of TRANSLATION";
    assert_eq!(fault_at(&[two(), floats("ROTATION", &[[0.0; 4]])]), says);
    let says = "node 0, accessor 4: its type must be VEC3, not VEC4";
    assert_eq!(fault_at(&[floats("TRANSLATION", &[[0.0; 4]])]), says);
    let says = "node 0, accessor 4: its type must be VEC4, not VEC3";
    assert_eq!(fault_at(&[floats("ROTATION", &[[0.0; 3]])]), says);
    let shorts = |attribute: &'static str, kind: &'static str| List {
        component: "5122",
        ..List { attribute, kind, component: "", count: 1, bytes: vec![0; 8] }
    };
    let says = "node 0, accessor 4: its components must be floats, not SHORT";
    assert_eq!(fault_at(&[shorts("SCALE", "VEC3")]), says);
    let says = "node 0, accessor 4: its components must be floats, or normalized bytes or shorts, not SHORT";
    assert_eq!(fault_at(&[shorts("ROTATION", "VEC4")]), says);
    let says = "node 0, accessor 4: number 4, counted from 0, is not finite";
    let nan = [[0.0; 3], [0.0, f32::NAN, 0.0]];
    assert_eq!(fault_at(&[floats("TRANSLATION", &nan)]), says);
    assert_eq!(fault_at(&[floats("SCALE", &nan)]), says);
    let infinite = [[0.0; 4], [f32::INFINITY, 0.0, 0.0, 0.0]];
    assert_eq!(fault_at(&[floats("ROTATION", &infinite)]), says);
    let says = "node 0, accessor 4: its 3 elements end at byte 36, but its view has 24 bytes";
    assert_eq!(fault_at(&[List { count: 3, ..two() }]), says);
    // Scaled by the node, the second place is beyond the largest f32 number.
    let says = "node 0, instance 1: it moves vertex 0 of its mesh where no f32 number reaches";
    let far = floats("TRANSLATION", &[[1e38, 0.0, 0.0], [2e38, 0.0, 0.0]]);
    assert_eq!(fault_of(at_places(", \"scale\": [3, 3, 3]", &[far])), says);
}

#[test]
fn an_extension_that_states_no_instances_is_refused_with_its_node() {
    let stated = |stated: &str| {
        let node = format!("\"extensions\": {{ \"EXT_mesh_gpu_instancing\": {stated} }}");
        fault(&[(NODES, &format!("[{{ \"mesh\": 0, {node} }}]"))])
    };
    let none = "node 0: its EXT_mesh_gpu_instancing names none of TRANSLATION, ROTATION and SCALE";
    assert_eq!(stated("{ \"attributes\": {} }"), none);
    assert_eq!(stated("{ \"attributes\": { \"_ID\": 3 } }"), none);
    let says = "node 0: it names accessor 9, counted from 0, but there are only 4";
    assert_eq!(stated("{ \"attributes\": { \"SCALE\": 9 } }"), says);
    let says = "node 0: its EXT_mesh_gpu_instancing must state attributes, each by the number of an accessor";
    for unknown in ["3", "{}", "{ \"attributes\": 3 }"] {
        assert_eq!(stated(unknown), says, "{unknown}");
    }
    for number in ["-1", "0.5", "\"0\"", "4294967296", "null"] {
        assert_eq!(
            stated(&format!("{{ \"attributes\": {{ \"SCALE\": {number} }} }}")),
            says,
            "{number}"
        );
    }
}

#[test]
fn an_instance_out_of_range_is_named_with_its_node() {
    let mut places = [[0.0; 3]; 500];
    places[7][0] = 2e38;
    let nodes = ["{ \"mesh\": 0 }", &node_with(""), &node_with(", \"scale\": [3, 1, 1]")];
    let nodes = nodes.map(str::to_owned);
    let says = fault_of(with_lists(&with_nodes(&nodes), &[floats("TRANSLATION", &places)]));
    assert_eq!(says, "node 2, instance 7: it moves its mesh where no f32 number reaches");
}

/// Each of many nodes names the same places, so the file stays small.
#[test]
fn too_many_instances_are_refused_before_they_take_memory() {
    let nodes = vec![node_with(""); (1 << 12) + 1];
    let text = with_lists(&with_nodes(&nodes), &[floats("TRANSLATION", &[[0.0; 3]; 1 << 12])]);
    let says =
        "node 4096: with it, the scene has 16781312 instances of meshes; at most 16777216 are read";
    assert_eq!(fault_of(text), says);
}
