//! The candidate queue: the triangles of leaves that are worth setting up. Most triangles of most leaves cover no
//! sample of the tile, and of many tiny ones the leaf's test says all.
//!
//! Large triangles are drawn at once, because of what they hide. With small ones, leaves wait until the machine has
//! fetched them, and triangles wait until there are eight, from several leaves.

use super::instance_frustum::{InstanceFrustum, PlacedBy};
use super::leaf::{FoundLeaf, Leaf, find_leaf, ids_of};
use super::leaf_fragments::{LEAVES, LeafFragments};
use super::leaf_tests::{
    CornerErrors, Test, TestedTriangles, doubt_of_any_size, doubt_of_size, pass,
};
use super::tile_frustum::TileFrustum;
use super::tree::{LEAF, NodeKind, NodeRef};
use crate::fast::local_projection::LocalProjection;
use crate::fast::prepared::Prepared;
use crate::fast::setup::TrianglePacket;
use bothways_common::engine::simd::{
    Compression, Simd, SimdBase, SimdMask, apart, f32x8, f32x16, mask32x16, u32x8, u32x16,
};

/// So many leaves, half of all that may wait, are tested together.
const RIPE: usize = LEAVES / 2;
/// Triangles that are set up together.
pub(crate) const EIGHT: usize = 8;
/// Room for this many triangles: those of all leaves, and those that are stored before it is known how many count.
const ROOM: usize = 80 + LEAVES * LEAF + EIGHT;

/// A projection of a whole instance that is off by more than so many columns lets triangles pass that the leaf's own
/// would drop.
const WORTHWHILE: f32 = 1.0 / 256.0;

/// A leaf that reaches over more columns or rows is long: over twice as many as a tile mostly has.
const LONG: f32 = 64.0;

/// Leaves that wait, triangles that passed the test of their leaf and wait, and fragments that this test found.
#[derive(Debug)]
pub(crate) struct CandidateQueue {
    leaves: [WaitingLeaf; LEAVES],
    leaf_count: usize,
    corners: [[f32; ROOM]; 9],
    ids: [u32; ROOM],
    /// The index of the first triangle that waits, and the end.
    first: usize,
    end: usize,
    pub(super) fragments: LeafFragments,
}

/// A leaf that waits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WaitingLeaf {
    pub(crate) leaf: NodeRef,
    /// How many of its triangles count: the first ones.
    pub(crate) used: usize,
    /// None of their vertices has a smaller `t`, as computed in `f32`.
    pub(crate) near: f32,
    /// No two vertices are farther from each other along any axis.
    pub(crate) size: f32,
}

impl CandidateQueue {
    pub(crate) fn new() -> Self {
        CandidateQueue {
            leaves: [WaitingLeaf {
                leaf: NodeRef::new(NodeKind::IndexedLeaf, 0),
                used: 0,
                near: 0.0,
                size: 0.0,
            }; LEAVES],
            leaf_count: 0,
            corners: [[0.0; ROOM]; 9],
            ids: [0; ROOM],
            first: 0,
            end: 0,
            fragments: LeafFragments::new(),
        }
    }

    /// Adds a leaf, which waits while the machine fetches it. Returns whether the queue of leaves is full.
    #[inline(always)]
    pub(crate) fn add(&mut self, leaf: WaitingLeaf) -> bool {
        self.leaves[self.leaf_count & (LEAVES - 1)] = leaf;
        self.leaf_count += 1;
        self.leaf_count == LEAVES
    }

    /// Whether leaves or triangles wait. Fragments wait only from the test of leaves to what follows it.
    pub(crate) fn is_empty(&self) -> bool {
        self.leaf_count + self.count() == 0
    }

    /// How many triangles wait.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.end - self.first
    }

    /// Tests the triangles of the half that has waited longest, or of `all`, and keeps those that pass, or their fragments. Seven
    /// triangles may wait already. It is compiled once for all loops that call it.
    #[inline(never)]
    pub(crate) fn test_leaves<S: Simd>(
        &mut self,
        simd: S,
        prepared: &Prepared,
        frustum: &TileFrustum,
        test: Test,
        all: bool,
    ) {
        let ripe = if all { self.leaf_count.min(LEAVES) } else { RIPE };
        apart!(simd, self.test_first(simd, ripe, prepared, frustum, test));
        debug_assert!(all || self.leaf_count == LEAVES);
        self.leaves.copy_within(RIPE.., 0);
        self.leaf_count -= ripe;
    }

    /// Tests the triangles of so many leaves, the first ones that wait.
    #[inline(always)]
    fn test_first<S: Simd>(
        &mut self,
        simd: S,
        count: usize,
        prepared: &Prepared,
        frustum: &TileFrustum,
        test: Test,
    ) {
        if self.end > ROOM - LEAVES * LEAF - EIGHT {
            self.move_to_start(simd);
        }
        for k in 0..count {
            let waiting = self.leaves[k];
            let ids = ids_of(simd, prepared, waiting.leaf);
            match find_leaf(prepared, waiting.leaf) {
                FoundLeaf::Indexed(leaf) => {
                    self.test_leaf(simd, (leaf, ids), frustum, &waiting, test);
                }
                FoundLeaf::Plain(leaf) => {
                    self.test_leaf(simd, (leaf, ids), frustum, &waiting, test);
                }
            }
        }
    }

    /// Tests the triangles of a leaf of an instance's mesh, and keeps those that pass. Nothing waits. It is compiled once for all
    /// loops that call it.
    #[inline(never)]
    pub(crate) fn test_placed<S: Simd>(
        &mut self,
        simd: S,
        prepared: &Prepared,
        (frustum, instance): (&TileFrustum, &InstanceFrustum),
        waiting: &WaitingLeaf,
        test: Test,
    ) {
        let rays = (frustum, instance);
        match find_leaf(prepared, waiting.leaf) {
            FoundLeaf::Indexed(leaf) => {
                apart!(simd, self.test_placed_leaf(simd, (prepared, leaf), rays, waiting, test))
            }
            FoundLeaf::Plain(leaf) => {
                apart!(simd, self.test_placed_leaf(simd, (prepared, leaf), rays, waiting, test))
            }
        }
    }

    /// Projects the leaf from where it is in the mesh, if that tells enough, and places it in the world if any of its
    /// triangles passes.
    #[inline(always)]
    fn test_placed_leaf<S: Simd>(
        &mut self,
        simd: S,
        (prepared, leaf): (&Prepared, &impl Leaf),
        (frustum, instance): (&TileFrustum, &InstanceFrustum),
        waiting: &WaitingLeaf,
        test: Test,
    ) {
        let PlacedBy { placement, first_name } = instance.place;
        let names = |ids: u32x16<S>| ids + first_name;
        let projection = instance.projection(waiting.near);
        if (0.0..WORTHWHILE).contains(&projection.error) {
            let [y, x, _] = leaf.project(simd, frustum, &projection);
            let error = projection.error;
            let doubt = |size| doubt_of_size(size, error);
            let passed = pass(simd, frustum, &[y, x], (error, doubt), test)
                & mask32x16::from_bitmask(simd, (1 << waiting.used) - 1);
            if passed.any_true() {
                let names = names(ids_of(simd, prepared, waiting.leaf));
                self.keep(simd, (&leaf.placed(simd, placement), names), passed);
            }
        } else {
            let leaf = &leaf.placed(simd, placement);
            let names = names(ids_of(simd, prepared, waiting.leaf)).to_array();
            apart!(simd, {
                let names = u32x16::load_array_ref(simd, &names);
                self.test_leaf(simd, (leaf, names), frustum, waiting, test);
            });
        }
    }

    /// Keeps those triangles of a leaf that may cover samples of the tile, or their fragments where these are certain. It branches on no
    /// result: none could be predicted.
    #[inline(always)]
    fn test_leaf<S: Simd>(
        &mut self,
        simd: S,
        (leaf, ids): (&impl Leaf, u32x16<S>),
        frustum: &TileFrustum,
        waiting: &WaitingLeaf,
        test: Test,
    ) {
        let mut passed = mask32x16::from_bitmask(simd, (1 << waiting.used) - 1);
        let local =
            LocalProjection::new(simd, frustum, leaf.first_vertex(), waiting.size, waiting.near);
        if local.is_useful() {
            let [y, x, keys] = leaf.project(simd, frustum, &local);
            // How many samples of the tile other triangles cover says nothing of slivers that are much longer than it: most of
            // these miss it, which their edges tell. For a single ray, the other test asks the edges anyway.
            let is_long = local.extent > LONG && frustum.template.side > 1;
            let test = if is_long { Test::Bounds } else { test };
            let LocalProjection { error, key_error, .. } = local;
            if test == Test::Fragments {
                let errors = CornerErrors { place: error, key: key_error };
                let TestedTriangles { pass, found } =
                    TestedTriangles::new(simd, frustum, &[y, x], &keys, &errors);
                self.fragments.add(&found, ids, passed);
                passed &= pass & !found.which;
            } else {
                let doubt = |_| f32x16::splat(simd, doubt_of_any_size(error));
                passed &= pass(simd, frustum, &[y, x], (error, doubt), test);
            }
        }
        self.keep(simd, (leaf, ids), passed);
    }

    /// Keeps some triangles of a leaf.
    #[inline(always)]
    fn keep<S: Simd>(
        &mut self,
        simd: S,
        (leaf, ids): (&impl Leaf, u32x16<S>),
        passed: mask32x16<S>,
    ) {
        let at = self.end.min(ROOM - LEAF);
        leaf.gather(simd, passed, &mut self.corners, at);
        Compression::new(passed).store(ids, &mut self.ids[at..at + LEAF]);
        self.end = at + passed.to_bitmask().count_ones() as usize;
    }

    /// Takes the next eight triangles from the queue; if there are fewer, others fill the lanes.
    #[inline(always)]
    pub(crate) fn take_eight<S: Simd>(&mut self, simd: S) -> TrianglePacket {
        let first = self.first.min(ROOM - EIGHT);
        let mut eight = TrianglePacket { corners: [[0.0; EIGHT]; 9], ids: [0; EIGHT] };
        let row = |row: usize| f32x8::from_slice(simd, &self.corners[row][first..first + EIGHT]);
        // In the pairs in which they are loaded later: then the machine can forward its stores to its loads.
        for (pair, to) in eight.corners.as_flattened_mut().chunks_exact_mut(2 * EIGHT).enumerate() {
            simd.combine_f32x8(row(2 * pair), row(2 * pair + 1)).store_slice(to);
        }
        row(8).store_array(&mut eight.corners[8]);
        u32x8::from_slice(simd, &self.ids[first..first + EIGHT]).store_array(&mut eight.ids);
        self.first = (self.first + EIGHT).min(self.end);
        if self.first == self.end {
            [self.first, self.end] = [0, 0];
        }
        eight
    }

    /// Makes room; fewer than eight triangles wait.
    #[inline(always)]
    fn move_to_start<S: Simd>(&mut self, simd: S) {
        let (first, count) = (self.first.min(ROOM - EIGHT), self.count());
        for row in &mut self.corners {
            f32x8::from_slice(simd, &row[first..first + EIGHT]).store_slice(&mut row[..EIGHT]);
        }
        u32x8::from_slice(simd, &self.ids[first..first + EIGHT])
            .store_slice(&mut self.ids[..EIGHT]);
        [self.first, self.end] = [0, count];
    }
}
