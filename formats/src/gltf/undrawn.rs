//! What a file has and is not drawn, to be said once for the whole file.

use super::places::Places;
use crate::warning::MaterialWarning;
use ::gltf::json::{Material, Mesh, Root};
use std::collections::BTreeSet;

/// What of the things that are drawn is left out, or drawn otherwise.
#[derive(Default)]
pub(super) struct Undrawn {
    has_skins: bool,
    has_morph_targets: bool,
    has_unlit: bool,
    /// The sets of texture coordinates that primitives lack.
    lacking: BTreeSet<u32>,
}

impl Undrawn {
    /// What the nodes that have a mesh state beside its place.
    pub(super) fn of_nodes(root: &Root, places: &[Places]) -> Undrawn {
        let is_morphed = |places: &Places| {
            let mesh = places.mesh().and_then(|number| root.meshes.get(number));
            mesh.is_some_and(|mesh| is_morphed(mesh, places.of.node.weights.as_deref()))
        };
        Undrawn {
            has_skins: places.iter().any(|places| places.of.node.skin.is_some()),
            has_morph_targets: places.iter().any(is_morphed),
            ..Undrawn::default()
        }
    }

    /// Notes a material that is drawn.
    pub(super) fn note_material(&mut self, material: &Material) {
        let extensions = material.extensions.as_ref();
        self.has_unlit |= extensions.is_some_and(|all| all.unlit.is_some());
    }

    /// Notes a set of texture coordinates that a primitive lacks, though it has a texture.
    pub(super) fn note_lacking(&mut self, set: u32) {
        self.lacking.insert(set);
    }

    /// The warnings.
    pub(super) fn warnings(&self, file: &str) -> impl Iterator<Item = MaterialWarning> {
        let file = || file.to_owned();
        let names: Vec<String> = self.lacking.iter().map(|set| format!("TEXCOORD_{set}")).collect();
        let all = [
            self.has_skins.then(|| MaterialWarning::Skins { file: file() }),
            self.has_morph_targets.then(|| MaterialWarning::MorphTargets { file: file() }),
            self.has_unlit.then(|| MaterialWarning::Unlit { file: file() }),
            (!names.is_empty())
                .then(|| MaterialWarning::MissingCoordinates { file: file(), names }),
        ];
        all.into_iter().flatten()
    }
}

/// Whether a mesh has morph targets, one of which a weight adds to it. Those of the node are in place of those of the mesh.
fn is_morphed(mesh: &Mesh, of_node: Option<&[f32]>) -> bool {
    let weights = of_node.or(mesh.weights.as_deref()).unwrap_or_default();
    let targets = mesh.primitives.iter().filter_map(|primitive| primitive.targets.as_ref());
    let count = targets.map(Vec::len).max().unwrap_or(0);
    weights.iter().take(count).any(|&weight| weight != 0.0)
}
