//! Warnings about what a file has and is not drawn.

use super::*;

/// The end of the only primitive of the square.
const PRIMITIVE: &str = "\"indices\": 3 }] }]";

/// What is said about the square with changes that is drawn nevertheless.
fn said(changes: &[(&str, &str)]) -> Vec<String> {
    let Model { shapes, warnings, .. } = square(changes);
    assert!(!shapes.is_empty());
    warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn skins_are_said_once_where_they_are_drawn() {
    let says = "a: its skins are not read; a mesh that has one is drawn as it lies in the file, where its node is";
    let nodes = |nodes: &str| said(&[(NODES, nodes), ("\"nodes\": [0]", "\"nodes\": [0, 1]")]);
    let skinned = "[{ \"mesh\": 0, \"skin\": 0 }, { \"mesh\": 0, \"skin\": 0 }]";
    assert_eq!(nodes(skinned), [says]);
    assert_eq!(nodes("[{ \"mesh\": 0 }, { \"skin\": 0 }]"), [""; 0]);
    // The node is not in the scene.
    assert_eq!(said(&[(NODES, "[{ \"mesh\": 0 }, { \"mesh\": 0, \"skin\": 0 }]")]), [""; 0]);
}

/// The weights of a node are in place of those of its mesh.
#[test]
fn morph_targets_are_said_once_if_a_weight_adds_one() {
    let says =
        "a: its morph targets are not read; a mesh that gives them a weight is drawn without them";
    let with = |targets: &str, of_mesh: &str, of_node: &str| {
        let primitive = format!("\"indices\": 3{targets} }}]{of_mesh} }}]");
        let nodes = format!("[{{ \"mesh\": 0{of_node} }}, {{ \"mesh\": 0{of_node} }}]");
        let all = ("\"nodes\": [0]", "\"nodes\": [0, 1]");
        said(&[(PRIMITIVE, &primitive), (NODES, &nodes), all])
    };
    let two = ", \"targets\": [{ \"POSITION\": 0 }, { \"POSITION\": 0 }]";
    let weights = |weights: &str| format!(", \"weights\": {weights}");
    for of_one in ["[0.5, 0]", "[0, -1]"].map(weights) {
        assert_eq!(with(two, &of_one, ""), [says], "{of_one}");
        assert_eq!(with(two, "", &of_one), [says], "{of_one}");
        assert_eq!(with(two, &weights("[0, 0]"), &of_one), [says], "{of_one}");
        assert_eq!(with(two, &of_one, &weights("[0, 0]")), [""; 0], "{of_one}");
        assert_eq!(with("", &of_one, ""), [""; 0], "{of_one}");
    }
    assert_eq!(with(two, &weights("[0, 0, 1]"), ""), [""; 0], "there is no third target");
    assert_eq!(with(two, "", ""), [""; 0]);
}

#[test]
fn unlit_materials_are_said_once_where_they_are_drawn() {
    let says = "a: some of its materials are unlit (KHR_materials_unlit); what has one is shaded like everything else";
    let unlit = ("\"name\": \"red\"", "\"extensions\": { \"KHR_materials_unlit\": {} }");
    let required = "\"extensionsRequired\": [\"KHR_materials_unlit\"]";
    let required = ("\"extensionsUsed\": []", required);
    let primitive = "{ \"attributes\": { \"POSITION\": 0 }, \"indices\": 3, \"material\": 0 }";
    let twice = format!("\"indices\": 3, \"material\": 0 }}, {primitive}] }}]");
    assert_eq!(said(&[unlit, (PRIMITIVE, &twice), required]), [says]);
    assert_eq!(said(&[unlit, (PRIMITIVE, &twice)]), [says]);
    assert_eq!(said(&[unlit, required]), [""; 0], "nothing is made of it");
    assert_eq!(said(&[(PRIMITIVE, &twice)]), [""; 0]);
}

/// A picture of one white pixel.
const PICTURE: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg==";

#[test]
fn textures_at_coordinates_that_a_primitive_lacks_are_said_once() {
    let with = |set: &str, picture: &str, primitive: &str| {
        let [material, (factor, texture), (list, images)] =
            image(&format!("{{ \"uri\": \"{picture}\" }}"));
        let texture = texture.replace("\"index\": 0", &format!("\"index\": 0{set}"));
        let changes = [material, (factor, texture), (list, images)];
        let twice = ("\"material\": 0 }]", format!("\"material\": 0 }}{primitive}]"));
        let changes: Vec<(&str, String)> = changes.into_iter().chain([twice]).collect();
        let changes: Vec<(&str, &str)> =
            changes.iter().map(|(from, to)| (*from, to.as_str())).collect();
        said(&changes)
    };
    let lack = |names: &str| {
        format!(
            "a: some of its primitives lack {names}, where their texture is read; they are drawn in their base colour"
        )
    };
    let none = [""; 0];
    assert_eq!(with("", PICTURE, ""), none);
    assert_eq!(with(", \"texCoord\": 2", PICTURE, ""), [lack("\"TEXCOORD_2\"")]);
    let without = ", { \"attributes\": { \"POSITION\": 0 }, \"indices\": 3, \"material\": 0 }";
    assert_eq!(with("", PICTURE, without), [lack("\"TEXCOORD_0\"")]);
    assert_eq!(with(", \"texCoord\": 2", PICTURE, without), [lack("\"TEXCOORD_2\"")]);
    // The transformation of the texture names another set.
    let moved = ", \"extensions\": { \"KHR_texture_transform\": { \"texCoord\": 1 } }";
    assert_eq!(with(moved, PICTURE, ""), [lack("\"TEXCOORD_1\"")]);
    // It is drawn without its texture anyway, which is said.
    let missing = with(", \"texCoord\": 2", "a.png", "");
    assert!(missing.len() == 1 && missing[0].contains("a.png"), "{missing:?}");
}

#[test]
fn all_that_is_not_drawn_is_said() {
    let nodes = "[{ \"mesh\": 0, \"skin\": 0, \"weights\": [1] }]";
    let primitive = "\"indices\": 3, \"material\": 0, \"targets\": [{ \"POSITION\": 0 }] }] }]";
    let unlit = "\"extensions\": { \"KHR_materials_unlit\": {} }";
    let says = said(&[(NODES, nodes), (PRIMITIVE, primitive), ("\"name\": \"red\"", unlit)]);
    let words = ["skins", "morph targets", "unlit"];
    assert_eq!(says.len(), words.len(), "{says:?}");
    assert!(says.iter().zip(words).all(|(says, word)| says.contains(word)), "{says:?}");
}
