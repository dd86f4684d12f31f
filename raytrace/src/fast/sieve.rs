//! What of leaves is worth setting up: most triangles of most leaves cover no sample of the tile.
//!
//! Where triangles are large, those that may are drawn at once, because of what they hide. Where they are small,
//! leaves wait until the machine has fetched them, and triangles until there are eight, of several leaves.

use super::anchor::Anchor;
use super::build::Prepared;
use super::corners::Leaf;
use super::rays::Lens;
use super::setup::Eight;
use super::tree::{Child, Kind, LEAF};
use bothways_common::engine::simd::{
    Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, mask32x16, u32x8, u32x16,
};

/// So many leaves wait.
const LEAVES: usize = 4;
/// Triangles that are set up together.
pub(super) const EIGHT: usize = 8;
/// Room for so many triangles, those of all leaves and those that are stored before it is known how many count.
const ROOM: usize = 80 + LEAVES * LEAF + EIGHT;

/// Leaves and triangles that wait.
#[derive(Debug)]
pub(super) struct Sieve {
    leaves: [Waiting; LEAVES],
    leaf_count: usize,
    corners: [[f32; ROOM]; 9],
    ids: [u32; ROOM],
    /// The first triangle that waits, and the end of them.
    first: usize,
    end: usize,
}

/// A leaf that waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    pub(super) leaf: Child,
    /// How many of its triangles count.
    pub(super) used: usize,
    /// None of their vertices has a smaller `t`, as computed in `f32`.
    pub(super) near: f32,
    /// No two of them are farther from each other along any axis.
    pub(super) size: f32,
}

impl Sieve {
    pub(super) fn new() -> Sieve {
        Sieve {
            leaves: [Waiting { leaf: Child::new(Kind::Patch, 0), used: 0, near: 0.0, size: 0.0 };
                LEAVES],
            leaf_count: 0,
            corners: [[0.0; ROOM]; 9],
            ids: [0; ROOM],
            first: 0,
            end: 0,
        }
    }

    /// Lets a leaf wait while the machine fetches it; tells whether there is room for no other.
    #[inline(always)]
    pub(super) fn add(&mut self, leaf: Waiting) -> bool {
        self.leaves[self.leaf_count & (LEAVES - 1)] = leaf;
        self.leaf_count += 1;
        self.leaf_count == LEAVES
    }

    /// Whether leaves or triangles wait.
    pub(super) fn is_empty(&self) -> bool {
        self.leaf_count + self.count() == 0
    }

    /// How many triangles wait.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.end - self.first
    }

    /// Looks at the two leaves that have waited longest, or at all, and lets triangles of theirs wait; there may be
    /// seven already.
    #[inline(always)]
    pub(super) fn sift<S: Simd>(
        &mut self,
        simd: S,
        prepared: &Prepared,
        lens: &Lens,
        look: Look,
        all: bool,
    ) {
        if self.end > ROOM - LEAVES * LEAF - EIGHT {
            self.move_to_start(simd);
        }
        let ripe = if all { self.leaf_count.min(LEAVES) } else { 2 };
        for k in 0..ripe {
            let waiting = self.leaves[k];
            let index = waiting.leaf.index();
            if waiting.leaf.kind() == Kind::Patch {
                self.look_at(simd, &prepared.patches[index], lens, &waiting, look);
            } else {
                self.look_at(simd, &prepared.triangles[index], lens, &waiting, look);
            }
        }
        self.leaves.copy_within(2.., 0);
        self.leaf_count -= ripe;
    }

    /// Lets those triangles of a leaf wait that may cover samples of the tile. It branches on no result, none of which
    /// could be foreseen.
    #[inline(always)]
    fn look_at<S: Simd>(
        &mut self,
        simd: S,
        leaf: &impl Leaf,
        lens: &Lens,
        waiting: &Waiting,
        look: Look,
    ) {
        let mut passed = mask32x16::from_bitmask(simd, (1 << waiting.used) - 1);
        let anchor = Anchor::new(lens, leaf.anchor(), waiting.size, waiting.near);
        if anchor.is_useful() {
            let places = leaf.places(simd, lens, &anchor);
            passed &= pass(simd, lens, &places, anchor.error, look);
        }
        let at = self.end.min(ROOM - LEAF);
        leaf.gather(simd, passed, &mut self.corners, at);
        let ids = u32x16::load_array_ref(simd, leaf.ids());
        ids.compress(passed).store_slice(&mut self.ids[at..at + LEAF]);
        self.end = at + passed.to_bitmask().count_ones() as usize;
    }

    /// The next eight of the triangles that wait, or all, and others with them; they no longer wait.
    #[inline(always)]
    pub(super) fn take_eight<S: Simd>(&mut self, simd: S) -> Eight {
        let first = self.first.min(ROOM - EIGHT);
        let mut eight = Eight { corners: [[0.0; EIGHT]; 9], ids: [0; EIGHT] };
        let row = |row: usize| f32x8::from_slice(simd, &self.corners[row][first..first + EIGHT]);
        // In the pairs in which they are loaded, or else the machine would wait until they are in its cache.
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

    /// Makes room: less than eight triangles wait.
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

/// How closely triangles are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    /// At which samples lie between their corners.
    Boxes,
    /// At their edges, too, which decide where one or two samples lie between the corners.
    Edges,
}

/// Which triangles may cover samples of the tile, by the columns and the rows of their corners, each of which may be
/// off by `error`.
///
/// Samples to the left of all corners are not covered, nor those to the right, above and below. If one is left, or two
/// beside each other, edge functions may tell that neither is covered.
#[inline(always)]
fn pass<S: Simd>(
    simd: S,
    lens: &Lens,
    [x, y]: &[[f32x16<S>; 3]; 2],
    error: f32,
    look: Look,
) -> mask32x16<S> {
    let (columns, rows) = (Between::new(simd, lens, x, error), Between::new(simd, lens, y, error));
    let missed = columns.none | rows.none;
    if look != Look::Edges {
        return !missed;
    }
    let more = columns.last - columns.first + (rows.last - rows.first);
    let beside = is_beside(simd, x, y, columns.first, rows.first, error)
        & is_beside(simd, x, y, columns.last, rows.last, error);
    !(missed | more.simd_le(f32x16::splat(simd, 1.0)) & beside)
}

/// Which columns lie between the corners of triangles, or which rows.
struct Between<S: Simd> {
    first: f32x16<S>,
    last: f32x16<S>,
    /// None of them is in the tile.
    none: mask32x16<S>,
}

impl<S: Simd> Between<S> {
    #[inline(always)]
    fn new(simd: S, lens: &Lens, [a, b, c]: &[f32x16<S>; 3], error: f32) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "at most 31")]
        let end = f32x16::splat(simd, (lens.kind.side - 1) as f32);
        let first = (a.min(*b).min(*c) - error).ceil();
        let last = (a.max(*b).max(*c) + error).floor();
        let none = last.min(end).simd_lt(first.max(f32x16::splat(simd, 0.0)));
        Between { first, last, none }
    }
}

/// Whether triangles certainly do not cover a sample, as two edge functions have different signs there. There is at
/// most one other sample between their corners, beside it.
///
/// So the corners are no farther from the sample than 2 along one axis and 1 along the other, and with an error `e` of
/// less than 1/16, two products are off by at most `6e + 6e²`; their factors' roundings, their own and that of
/// their difference bring less than `e`, which is at least `36u`, `u = 2⁻²⁴`.
#[inline(always)]
fn is_beside<S: Simd>(
    simd: S,
    x: &[f32x16<S>; 3],
    y: &[f32x16<S>; 3],
    column: f32x16<S>,
    row: f32x16<S>,
    error: f32,
) -> mask32x16<S> {
    let error = f32x16::splat(simd, 8.0 * error);
    let x = [x[0] - column, x[1] - column, x[2] - column];
    let y = [y[0] - row, y[1] - row, y[2] - row];
    let ab = x[0] * y[1] - y[0] * x[1];
    let bc = x[1] * y[2] - y[1] * x[2];
    let ca = x[2] * y[0] - y[2] * x[0];
    ab.max(bc).max(ca).simd_gt(error) & ab.min(bc).min(ca).simd_lt(-error)
}
