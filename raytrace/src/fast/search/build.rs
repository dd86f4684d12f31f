//! Builds the hierarchy: boxes around boxes around primitives, split where that is expected to be cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007; sixteen boxes a node as in Wald, Benthin and Boulos, "Getting Rid of
//! Packets", same venue, 2008.

mod arena;
mod collapse;
mod grow;
mod leaves;
mod prim_ref;
mod sah;
mod split;

use super::tree::{Bounds, Node, NodeKind};
use crate::fast::prepared::Prepared;
use arena::{Arena, LeafRange};
use bothways_common::Scene;
use bothways_common::engine::simd::best_level;
use grow::grow;
use prim_ref::{Corners, PrimRef, collect};
use rayon::prelude::*;
use split::{BuildContext, BuildRecord};

/// Builds the hierarchy of a scene, to be traced in tiles of `side` × `side` samples.
pub(crate) fn build(scene: &Scene, side: usize) -> Prepared {
    let mut collected = collect(scene);
    let mut arena = Arena::default();
    let mut roots = Vec::new();
    let mut bounds = Bounds::EMPTY;
    let hierarchies = [(false, &mut collected.triangles), (true, &mut collected.spheres)];
    for (spheres, prims) in hierarchies {
        if prims.is_empty() {
            continue;
        }
        let all = BuildRecord::new(prims, 0, 0, false);
        let root = all.bounds.bounds();
        bounds = bounds.union(&root);
        let (mut tree, child, counts) = grow(all, &BuildContext { spheres, scene });
        // Few primitives are a leaf; the walk begins at a node.
        if child.kind() != NodeKind::Node {
            tree.nodes.push(Node::empty());
            tree.attach(0, &root, child, counts);
        }
        roots.push(arena.append(tree));
    }
    let [indexed, plain, spheres] = &arena.leaves;
    let triangles = &collected.triangles;
    Prepared {
        indexed_leaves: filled(scene, triangles, indexed, leaves::indexed_leaf),
        plain_leaves: filled(scene, triangles, plain, leaves::plain_leaf),
        sphere_leaves: filled(scene, &collected.spheres, spheres, |prims, _| {
            std::array::from_fn(|lane| prims.get(lane).unwrap_or(&prims[0]).id())
        }),
        nodes: arena.nodes,
        roots,
        bounds,
        unbounded: collected.unbounded,
        extents: collected.extents,
        primitives: scene.primitive_count(),
        level: best_level(),
        side,
    }
}

/// All leaves of one kind.
fn filled<L: Send>(
    scene: &Scene,
    prims: &[PrimRef],
    ranges: &[LeafRange],
    leaf: impl Fn(&[PrimRef], &mut Corners) -> L + Sync,
) -> Vec<L> {
    let ranges = ranges.par_iter().with_min_len(64);
    let of = |range: &LeafRange| &prims[range.first as usize..][..usize::from(range.count)];
    ranges.map_init(|| Corners::new(scene), |corners, range| leaf(of(range), corners)).collect()
}

#[cfg(test)]
mod tests;
