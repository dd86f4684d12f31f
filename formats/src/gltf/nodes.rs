//! The nodes of a scene, each with its place in the world.

use super::error::GltfFault;
use super::item::{Located, item};
use ::gltf::json::scene::{Node, UnitQuaternion};
use ::gltf::json::{Index, Root};
use glam::{DMat4, DQuat, DVec3};

/// A node and its transformation.
pub(super) struct Placed<'a> {
    pub(super) number: usize,
    pub(super) node: &'a Node,
    pub(super) world_from_node: DMat4,
}

impl Placed<'_> {
    /// The fault as one of this node.
    pub(super) fn located(&self, fault: GltfFault) -> Located {
        (format!("node {}", self.number), fault)
    }
}

/// The nodes of the default scene, in the order of the file: each before its children.
pub(super) fn placed(root: &Root) -> Result<Vec<Placed<'_>>, Located> {
    let mut placed: Vec<Placed> = Vec::new();
    let mut reached = vec![false; root.nodes.len()];
    let roots = roots(root)?;
    // A stack of its own: a chain of nodes may be as long as the file. What comes first is on top, with the place of its
    // parent.
    let mut waiting: Vec<(Index<Node>, Option<usize>)> =
        roots.iter().rev().map(|&node| (node, None)).collect();
    while let Some((index, parent)) = waiting.pop() {
        let (world_from_parent, name) = match parent.map(|parent| &placed[parent]) {
            Some(parent) => (parent.world_from_node, format!("node {}", parent.number)),
            None => (DMat4::IDENTITY, "scene".to_owned()),
        };
        let (number, node) = item(&root.nodes, index, "node").map_err(|fault| (name, fault))?;
        let located = |fault| (format!("node {number}"), fault);
        if std::mem::replace(&mut reached[number], true) {
            return Err(located(GltfFault::ReachedTwice));
        }
        let world_from_node = world_from_parent * transform(node).map_err(located)?;
        // Many large scales in a row end beyond all numbers.
        if !world_from_node.is_finite() {
            return Err(located(GltfFault::TransformNotFinite));
        }
        let children = node.children.iter().flatten().rev();
        waiting.extend(children.map(|&child| (child, Some(placed.len()))));
        placed.push(Placed { number, node, world_from_node });
    }
    Ok(placed)
}

/// The nodes with which the scene begins: those of the default scene or of the first; all nodes without a parent if there is
/// no scene.
fn roots(root: &Root) -> Result<Vec<Index<Node>>, Located> {
    let whole = |fault| (String::new(), fault);
    match root.scene {
        Some(scene) => {
            let (_, scene) = item(&root.scenes, scene, "scene").map_err(whole)?;
            return Ok(scene.nodes.clone());
        }
        None => {
            if let Some(scene) = root.scenes.first() {
                return Ok(scene.nodes.clone());
            }
        }
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    let all = (0..).zip(is_child);
    Ok(all.filter(|(_, is_child)| !is_child).map(|(node, _)| Index::new(node)).collect())
}

/// The transformation that a node states: its matrix, or scale, then rotation, then translation.
fn transform(node: &Node) -> Result<DMat4, GltfFault> {
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    Ok(match node.matrix {
        Some(_) if has_parts => return Err(GltfFault::TwoTransforms),
        Some(matrix) => DMat4::from_cols_array(&matrix.map(f64::from)),
        None if !has_parts => DMat4::IDENTITY,
        None => {
            let rotation = node.rotation.map(|UnitQuaternion(rotation)| rotation);
            composed(node.scale, rotation, node.translation)
        }
    })
}

/// The transformation that scales, then rotates, then translates, as far as each is stated.
pub(super) fn composed(
    scale: Option<[f32; 3]>,
    rotation: Option<[f32; 4]>,
    translation: Option<[f32; 3]>,
) -> DMat4 {
    let rotation =
        rotation.map_or(DQuat::IDENTITY, |numbers| DQuat::from_array(numbers.map(f64::from)));
    // Written in `f32`, it is nearly of unit length.
    let rotation =
        if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    let vector = |numbers: Option<[f32; 3]>, without: DVec3| {
        numbers.map_or(without, |numbers| DVec3::from(numbers.map(f64::from)))
    };
    let (scale, translation) = (vector(scale, DVec3::ONE), vector(translation, DVec3::ZERO));
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
