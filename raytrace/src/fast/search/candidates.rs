//! The candidate queue: the triangles of leaves that are worth setting up. Most triangles of most leaves cover no
//! sample of the tile.
//!
//! Large triangles are drawn at once, because of what they hide. With small ones, leaves wait until the machine has
//! fetched them, and triangles wait until there are eight, from several leaves.

use super::instance_frustum::{InstanceFrustum, PlacedBy};
use super::leaf::{FoundLeaf, Leaf, find_leaf, ids_of};
use super::tile_frustum::TileFrustum;
use super::tree::{LEAF, NodeKind, NodeRef};
use crate::fast::local_projection::LocalProjection;
use crate::fast::prepared::Prepared;
use crate::fast::setup::TrianglePacket;
use bothways_common::engine::simd::{
    Compression, Simd, SimdBase, SimdFloat, SimdMask, apart, f32x8, f32x16, mask32x16, u32x8,
    u32x16,
};

/// At most this many leaves wait, and half of them are tested together then.
const LEAVES: usize = 8;
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

/// Leaves that wait, and triangles that passed the test of their leaf and wait.
#[derive(Debug)]
pub(crate) struct CandidateQueue {
    leaves: [WaitingLeaf; LEAVES],
    leaf_count: usize,
    corners: [[f32; ROOM]; 9],
    ids: [u32; ROOM],
    /// The index of the first triangle that waits, and the end.
    first: usize,
    end: usize,
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
        }
    }

    /// Adds a leaf, which waits while the machine fetches it. Returns whether the queue of leaves is full.
    #[inline(always)]
    pub(crate) fn add(&mut self, leaf: WaitingLeaf) -> bool {
        self.leaves[self.leaf_count & (LEAVES - 1)] = leaf;
        self.leaf_count += 1;
        self.leaf_count == LEAVES
    }

    /// Whether leaves or triangles wait.
    pub(crate) fn is_empty(&self) -> bool {
        self.leaf_count + self.count() == 0
    }

    /// How many triangles wait.
    #[inline(always)]
    pub(crate) fn count(&self) -> usize {
        self.end - self.first
    }

    /// Tests the triangles of the half that has waited longest, or of `all`, and keeps those that pass. Seven
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
            let corners = leaf.project(simd, frustum, &projection);
            let error = projection.error;
            let doubt = |size| doubt_of_size(size, error);
            let passed = pass(simd, frustum, &corners, (error, doubt), test)
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

    /// Keeps those triangles of a leaf that may cover samples of the tile. It branches on no result: none could be
    /// predicted.
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
            let corners = leaf.project(simd, frustum, &local);
            // How many samples of the tile other triangles cover says nothing of slivers that are much longer than it: most of
            // these miss it, which their edges tell. For a single ray, the other test asks the edges anyway.
            let is_long = local.extent > LONG && frustum.template.side > 1;
            let test = if is_long { Test::Bounds } else { test };
            let error = local.error;
            let doubt = |_| f32x16::splat(simd, doubt_of_any_size(error));
            passed &= pass(simd, frustum, &corners, (error, doubt), test);
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

/// How thoroughly triangles are tested before they are set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Test {
    /// By their bounds, which samples lie between their corners; and by their edges, where these leave out all of the tile.
    Bounds,
    /// By their edges, too, where one or two samples lie between their corners.
    Edges,
}

/// Which triangles may cover samples of the tile, by the rows and the columns of their corners, each of which may be
/// off by `error`; `doubt` finds that of edge functions from the triangles' sizes in columns and rows.
///
/// Samples to the left of all corners are not covered, nor those to the right, above and below. If one is left, or two
/// beside each other, edge functions may show that neither is covered.
#[inline(always)]
fn pass<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    [y, x]: &[[f32x16<S>; 3]; 2],
    (error, doubt): (f32, impl FnOnce(f32x16<S>) -> f32x16<S>),
    test: Test,
) -> mask32x16<S> {
    let rows = Between::new(simd, frustum, y, error);
    let columns = Between::new(simd, frustum, x, error);
    let missed = columns.none | rows.none;
    if test != Test::Edges {
        return !(missed | is_between_edges(simd, frustum, [y, x], error));
    }
    let more = columns.last - columns.first + (rows.last - rows.first);
    let doubt = doubt(columns.size.max(rows.size));
    let beside = is_beside([y, x], [rows.first, columns.first], doubt)
        & is_beside([y, x], [rows.last, columns.last], doubt);
    !(missed | more.simd_le(f32x16::splat(simd, 1.0)) & beside)
}

/// Which rows lie between the corners of triangles, or which columns.
struct Between<S: Simd> {
    first: f32x16<S>,
    last: f32x16<S>,
    /// From the first corner to the last.
    size: f32x16<S>,
    /// None of them is in the tile.
    none: mask32x16<S>,
}

impl<S: Simd> Between<S> {
    #[inline(always)]
    fn new(simd: S, frustum: &TileFrustum, [a, b, c]: &[f32x16<S>; 3], error: f32) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "at most 31")]
        let end = f32x16::splat(simd, (frustum.template.side - 1) as f32);
        let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
        let (first, last) = ((low - error).ceil(), (high + error).floor());
        let none = last.min(end).simd_lt(first.max(f32x16::splat(simd, 0.0)));
        Between { first, last, size: high - low, none }
    }
}

/// Whether triangles cover no sample of the tile, as two edge functions have different signs in all of it: slivers, of
/// which bounds say nothing.
///
/// # The error, rounding by rounding
///
/// Places are counted from the tile's middle, `h` from its first samples; `M` is the largest of any corner. A place may be off by
/// `e` up to `h + 3`, and beyond that by the same fraction ([`super::super::local_errors`]): by `e(1 + M/h)`. As `e` is at least
/// `36·ε₂₄`, half of that is more than the rounding of counting from the middle: by `δ = 2e(1 + M/h)` in all. An edge
/// function at the middle, `x_a·y_b − y_a·x_b`, is off by `4Mδ + 2δ²`, and by its roundings of `4·ε₂₄·M²`; as `δ` is at least
/// `4·ε₂₄·M` for `h` up to 18, that is less than `5Mδ + 2δ²`. To a sample it changes by `h(|x_b − x_a| + |y_b − y_a|)`, which is off
/// by `4hδ` and its roundings. Comparisons with NaN are false.
#[inline(always)]
fn is_between_edges<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    [y, x]: [&[f32x16<S>; 3]; 2],
    error: f32,
) -> mask32x16<S> {
    let half = -frustum.centered(0);
    let x = [x[0] - half, x[1] - half, x[2] - half];
    let y = [y[0] - half, y[1] - half, y[2] - half];
    let along_x = x[0].abs().max(x[1].abs()).max(x[2].abs());
    let most = along_x.max(y[0].abs()).max(y[1].abs()).max(y[2].abs());
    let off = (most * (1.0 / half) + 1.0) * (2.0 * error);
    let error = off * ((most + half) * 5.0 + off * 3.0);
    let mut positive = mask32x16::splat(simd, false);
    let mut negative = positive;
    for (p, q) in [(0, 1), (1, 2), (2, 0)] {
        let at_middle = x[p] * y[q] - y[p] * x[q];
        let change = ((x[q] - x[p]).abs() + (y[q] - y[p]).abs()) * half;
        let most = (change + error) * 1.000_001;
        positive |= at_middle.simd_gt(most);
        negative |= at_middle.simd_lt(-most);
    }
    positive & negative
}

/// The doubt of [`is_beside`] for triangles of a size `s` in columns and rows, as it is computed. There `m` is the size and `e`, and
/// `(5·s + 8·e)·e` is more than all.
#[inline(always)]
fn doubt_of_size<S: Simd>(size: f32x16<S>, error: f32) -> f32x16<S> {
    (size * 5.0 + 8.0 * error) * error
}

/// The same for triangles of any size, for which nothing is computed lane by lane. There `m` is 2 and `e`, one to the other
/// sample and less than one beyond it, so that `(9 + 7·e)·e` is more than all. Where errors are small, that makes no difference.
#[inline(always)]
fn doubt_of_any_size(error: f32) -> f32 {
    (9.0 + 7.0 * error) * error
}

/// Whether triangles certainly do not cover a sample, as two edge functions have different signs there, by more than is in
/// `doubt`. There is at most one other sample between their corners, beside it.
///
/// The sample lies between the corners but for an error `e` of less than 1/16. So none is farther from it along an axis
/// than some `m`, and along one axis not farther than 1 and `e`. Two products are off
/// by at most `4·m·e + 2·e²`; their factors' roundings, their own and that of their difference bring less than `9·m·ε₂₄`,
/// which is less than `m·e/2`, as `e` is at least `36·ε₂₄`.
#[inline(always)]
fn is_beside<S: Simd>(
    [y, x]: [&[f32x16<S>; 3]; 2],
    [row, column]: [f32x16<S>; 2],
    doubt: f32x16<S>,
) -> mask32x16<S> {
    let x = [x[0] - column, x[1] - column, x[2] - column];
    let y = [y[0] - row, y[1] - row, y[2] - row];
    let ab = x[0] * y[1] - y[0] * x[1];
    let bc = x[1] * y[2] - y[1] * x[2];
    let ca = x[2] * y[0] - y[2] * x[0];
    ab.max(bc).max(ca).simd_gt(doubt) & ab.min(bc).min(ca).simd_lt(-doubt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{best_level, dispatch};

    /// Corners of sixteen triangles, their `y` and their `x`.
    type Sixteen = [[[f32; LEAF]; 3]; 2];

    /// Which of them are beside a sample at the origin: by the doubt of their size, by that of any size, and by a third of that.
    fn beside(corners: &Sixteen, error: f32) -> [u64; 3] {
        dispatch!(best_level(), simd => {
            let [y, x] = corners.map(|rows| rows.map(|row| f32x16::load_array(simd, row)));
            let size = |[a, b, c]: [f32x16<_>; 3]| a.max(b).max(c) - a.min(b).min(c);
            let of_any_size = f32x16::splat(simd, doubt_of_any_size(error));
            let doubts = [doubt_of_size(size(x).max(size(y)), error), of_any_size, of_any_size * (1.0 / 3.0)];
            let zero = f32x16::splat(simd, 0.0);
            doubts.map(|doubt| is_beside([&y, &x], [zero, zero], doubt).to_bitmask())
        })
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "what is off is less for it")]
    fn triangles_are_not_beside_a_sample_on_their_edge_however_their_corners_are_off() {
        let mut random = fastrand::Rng::with_seed(21);
        let mut too_little = 0;
        for round in 0..30_000 {
            let error = 2_f64.powf(-4.0 - 16.0 * random.f64());
            // Another sample is beside this one, in the same row or column, or none is.
            let mut ends = [[-1.0, 1.0]; 2];
            if let Some(axis) = ends.get_mut(round % 3) {
                *axis = if random.bool() { [-1.0, 2.0] } else { [-2.0, 1.0] };
            }
            let ends = ends.map(|[low, high]| [low + 2.0 * error, high - 2.0 * error]);
            let mut inside = || ends.map(|[low, high]| low + (high - low) * random.f64());
            let (a, c) = (inside(), inside());
            // The line from the corner through the sample, up to where it ends.
            let most = [0, 1].map(|axis| {
                let [low, high] = ends[axis];
                (if a[axis] > 0.0 { -low } else { high }) / a[axis].abs()
            });
            let opposite = most[0].min(most[1]) * random.f64();
            let b = a.map(|value| -value * opposite);
            let mut corners: Sixteen = [[[0.0; LEAF]; 3]; 2];
            for (axis, rows) in corners.iter_mut().enumerate() {
                for (row, corner) in rows.iter_mut().zip([a, b, c]) {
                    *row = [(); LEAF].map(|()| {
                        let off = if random.bool() { error } else { -error };
                        // Not farther off for its rounding.
                        (corner[axis] + off * (1.0 - 1e-6)) as f32
                    });
                }
            }
            let [of_size, of_any_size, third] = beside(&corners, error as f32);
            assert_eq!([of_size, of_any_size], [0; 2], "{corners:?} {error}");
            too_little += third.count_ones();
        }
        assert!(too_little > 100, "a third of it is too little {too_little} times");
    }
}
