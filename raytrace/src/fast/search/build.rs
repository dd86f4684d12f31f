//! Builds the hierarchy: boxes around boxes around primitives, split where that is expected to be cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007; sixteen boxes a node as in Wald, Benthin and Boulos, "Getting Rid of
//! Packets", same venue, 2008.

mod arena;
mod collapse;
mod grow;
mod instances;
mod leaves;
mod prim_ref;
mod primitives;
mod sah;
mod split;

use super::tree::{Bounds, SPHERES};
use crate::fast::prepared::{Instanced, MeshRoot, Prepared};
use arena::{Arena, LeafRange};
use bothways_common::engine::simd::Level;
use bothways_common::{Mesh, Scene, Shape};
use grow::grow;
use instances::{InstanceBoxes, Numbered};
use prim_ref::{CornerReader, PrimRef, Source, collect, triangles_of};
use rayon::prelude::*;
use split::{BuildContext, BuildRecord, Kind};
use std::collections::HashMap;
use std::sync::Arc;

/// Builds the hierarchy of a scene, to be traced in tiles of `side` × `side` samples. It is built and traced at one level
/// of SIMD. A mesh of which there are instances has a hierarchy of its own, once.
pub(crate) fn build(scene: &Scene, side: usize, level: Level) -> Prepared {
    let mut collected = collect(scene);
    let mut prepared = Prepared {
        nodes: Vec::new(),
        indexed_leaves: Vec::new(),
        scattered_leaves: Vec::new(),
        plain_leaves: Vec::new(),
        sphere_leaves: Vec::new(),
        instance_order: Vec::new(),
        roots: Vec::new(),
        meshes: Vec::new(),
        instanced: Vec::new(),
        bounds: Bounds::EMPTY,
        unbounded: collected.unbounded,
        extents: collected.extents,
        primitives: scene.primitive_count(),
        level,
        threads: 0,
        times: None,
        side,
    };
    add_meshes(scene, &mut prepared);
    // The walk begins with the last; instances come last, as there may be very many that something else hides.
    add_instances(scene, &mut prepared);
    let hierarchies =
        [(Kind::Triangles, &mut collected.triangles), (Kind::Spheres, &mut collected.spheres)];
    for (kind, prims) in hierarchies {
        if prims.is_empty() {
            continue;
        }
        let (source, level) = (Source::Scene(scene), prepared.level);
        let context = BuildContext { kind, source, level, by_all_threads: true };
        let MeshRoot { root, bounds, .. } = add_hierarchy(prims, &context, true, &mut prepared);
        prepared.add_root(root, &bounds);
        *prims = Vec::new();
    }
    prepared
}

/// Builds the hierarchies of the meshes that instances share, and notes where the instances of each object are.
fn add_meshes(scene: &Scene, prepared: &mut Prepared) {
    let mut known: HashMap<*const Mesh, usize> = HashMap::new();
    let mut first_number = 0;
    for (object, described) in scene.objects().iter().enumerate() {
        let Shape::Instances(instances) = &described.shape else { continue };
        if instances.primitive_count() == 0 {
            continue;
        }
        let mesh = *known.entry(Arc::as_ptr(instances.shared_mesh())).or_insert_with(|| {
            let mesh = instances.mesh();
            let (kind, source) = (Kind::Triangles, Source::Mesh(mesh));
            let context =
                BuildContext { kind, source, level: prepared.level, by_all_threads: true };
            let built = add_hierarchy(&mut triangles_of(mesh), &context, false, prepared);
            prepared.meshes.push(built);
            prepared.meshes.len() - 1
        });
        let triangles = u32::try_from(instances.mesh().triangles().len()).expect("ids are u32");
        let first_id = scene.first_id(object);
        prepared.instanced.push(Instanced { first_number, object, first_id, triangles, mesh });
        first_number +=
            u32::try_from(instances.placements().len()).expect("they are fewer than ids");
    }
}

/// Builds the hierarchy over instances behind the nodes that are there. Beside its nodes and the order of the instances,
/// little memory is used: there may be a million instances.
fn add_instances(scene: &Scene, prepared: &mut Prepared) {
    let boxes = InstanceBoxes::new(scene, &prepared.instanced);
    let mut order = boxes.numbers();
    if order.is_empty() {
        return;
    }
    let (kind, source, level) = (Kind::Instances, Source::Scene(scene), prepared.level);
    let context = BuildContext { kind, source, level, by_all_threads: true };
    let all = BuildRecord::new(
        Numbered { numbers: &mut order, boxes: &boxes },
        0,
        0,
        false,
        context.level,
    );
    let bounds = all.bounds.bounds();
    let mut arena = Arena { nodes: std::mem::take(&mut prepared.nodes), ..Arena::default() };
    let (root, counts) = grow(all, &context, &mut arena);
    let (root, _) = arena.begun_with_node(&bounds, root, counts);
    (prepared.nodes, prepared.instance_order) = (arena.nodes, order);
    prepared.add_root(root, &bounds);
}

/// Builds a hierarchy, and adds it to those that are there. If there are few primitives, it is a leaf, or
/// `begins_with_node` and a node with that leaf.
fn add_hierarchy(
    prims: &mut [PrimRef],
    context: &BuildContext,
    begins_with_node: bool,
    prepared: &mut Prepared,
) -> MeshRoot {
    let all = BuildRecord::new(&mut *prims, 0, 0, false, context.level);
    let bounds = all.bounds.bounds();
    let mut tree = Arena::default();
    let (mut root, mut counts) = grow(all, context, &mut tree);
    if begins_with_node {
        (root, counts) = tree.begun_with_node(&bounds, root, counts);
    }
    let (nodes, leaves) = (prepared.nodes.len(), prepared.leaf_counts());
    let Arena { nodes: added, leaves: [indexed, scattered, plain, spheres, _] } =
        tree.shifted(nodes, leaves);
    append(&mut prepared.nodes, added);
    let (source, level) = (context.source, context.level);
    let indexed_leaf =
        |prims: &[PrimRef], corners: &mut CornerReader| leaves::indexed_leaf(prims, corners, level);
    append(&mut prepared.indexed_leaves, filled(source, prims, &indexed, indexed_leaf));
    let scattered_leaf = |prims: &[PrimRef], corners: &mut CornerReader| {
        leaves::scattered_leaf(prims, corners, level)
    };
    let scattered_leaves = filled(source, prims, &scattered, scattered_leaf);
    append(&mut prepared.scattered_leaves, scattered_leaves);
    append(&mut prepared.plain_leaves, filled(source, prims, &plain, leaves::plain_leaf));
    append(
        &mut prepared.sphere_leaves,
        filled(source, prims, &spheres, |prims, _| leaves::ids::<SPHERES>(prims)),
    );
    MeshRoot { root: root.shifted(nodes, leaves), counts, bounds }
}

/// Adds more at the end; without a copy if they are the first.
fn append<T>(to: &mut Vec<T>, mut more: Vec<T>) {
    if to.is_empty() { *to = more } else { to.append(&mut more) }
}

/// All leaves of one kind.
fn filled<L: Send>(
    source: Source,
    prims: &[PrimRef],
    ranges: &[LeafRange],
    leaf: impl Fn(&[PrimRef], &mut CornerReader) -> L + Sync,
) -> Vec<L> {
    let ranges = ranges.par_iter().with_min_len(64);
    let of = |range: &LeafRange| &prims[range.first as usize..][..usize::from(range.count)];
    ranges
        .map_init(|| CornerReader::new(source), |corners, range| leaf(of(range), corners))
        .collect()
}

#[cfg(test)]
mod tests;
