//! What of leaves is worth setting up: most triangles of most leaves cover no sample of the tile.
//!
//! Where triangles are large, those that may are drawn at once, because of what they hide. Where they are small,
//! leaves wait until the machine has fetched them, and triangles until there are eight, of several leaves.

use super::rays::Lens;
use super::tree::{Leaf, WIDTH};
use bothways_common::simd::{Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, mask32x16, u32x8};

/// So many leaves wait.
const LEAVES: usize = 4;
/// Less than eight triangles, and those of all leaves.
const ROOM: usize = WIDTH + LEAVES * WIDTH;

/// Leaves and triangles that wait.
#[derive(Debug)]
pub(super) struct Sieve {
    /// Numbers of leaves, and which of their triangles count.
    leaves: [(usize, u64); LEAVES],
    leaf_count: usize,
    corners: [[f32; ROOM]; 9],
    ids: [u32; ROOM],
    count: usize,
}

impl Sieve {
    pub(super) const fn new() -> Sieve {
        Sieve {
            leaves: [(0, 0); LEAVES],
            leaf_count: 0,
            corners: [[0.0; ROOM]; 9],
            ids: [0; ROOM],
            count: 0,
        }
    }

    /// Lets a leaf wait while the machine fetches it; tells whether there is room for no other.
    #[inline(always)]
    pub(super) fn add(&mut self, leaf: (usize, u64)) -> bool {
        self.leaves[self.leaf_count & (LEAVES - 1)] = leaf;
        self.leaf_count += 1;
        self.leaf_count == LEAVES
    }

    /// Whether leaves or triangles wait.
    pub(super) fn is_empty(&self) -> bool {
        self.leaf_count + self.count == 0
    }

    /// Looks at the two leaves that have waited longest, or all; tells how many triangles wait then. It
    /// branches on no result, none of which could be foreseen.
    #[inline(always)]
    pub(super) fn sift<S: Simd>(
        &mut self,
        simd: S,
        leaves: &[Leaf],
        lens: &Lens,
        farthest: f32,
        all: bool,
    ) -> usize {
        let ripe = if all { self.leaf_count.min(LEAVES) } else { 2 };
        for pair in self.leaves[..ripe].chunks(2) {
            let [first, second] = [pair[0], *pair.get(1).unwrap_or(&(pair[0].0, 0))];
            let used = mask32x16::from_bitmask(simd, first.1 | second.1 << WIDTH);
            let pair = [&leaves[first.0], &leaves[second.0]];
            let passed = pass(simd, lens, pair, farthest) & used;
            let at = self.count.min(ROOM - 2 * WIDTH);
            for (row, to) in self.corners.iter_mut().enumerate() {
                load(simd, pair, row).compress(passed).store_slice(&mut to[at..at + 2 * WIDTH]);
            }
            let ids = simd.combine_u32x8(
                u32x8::load_array_ref(simd, &pair[0].ids),
                u32x8::load_array_ref(simd, &pair[1].ids),
            );
            ids.compress(passed).store_slice(&mut self.ids[at..at + 2 * WIDTH]);
            self.count = at + passed.to_bitmask().count_ones() as usize;
        }
        self.leaves.copy_within(2.., 0);
        self.leaf_count -= ripe;
        self.count
    }

    /// Eight of the triangles that wait, from one on.
    #[inline(always)]
    pub(super) fn eight<S: Simd>(&self, simd: S, first: usize) -> Leaf {
        let mut leaf = Leaf { corners: [[0.0; WIDTH]; 9], ids: [0; WIDTH] };
        let first = first.min(ROOM - WIDTH);
        for (from, to) in self.corners.iter().zip(&mut leaf.corners) {
            f32x8::from_slice(simd, &from[first..first + WIDTH]).store_array(to);
        }
        u32x8::from_slice(simd, &self.ids[first..first + WIDTH]).store_array(&mut leaf.ids);
        leaf
    }

    /// Forgets the first triangles; less than eight are left.
    #[inline(always)]
    pub(super) fn forget<S: Simd>(&mut self, simd: S, first: usize) {
        self.count -= first;
        if self.count > 0 {
            let Leaf { corners, ids } = self.eight(simd, first);
            for (from, to) in corners.iter().zip(&mut self.corners) {
                to[..WIDTH].copy_from_slice(from);
            }
            self.ids[..WIDTH].copy_from_slice(&ids);
        }
    }
}

/// Which triangles of two leaves may cover samples of the tile, and be no farther than `farthest`.
///
/// All corners on one side of the plane through a column's rays: no ray of the column meets the triangle. If
/// they are to the left of one column and to the right of the one before, then `x < k·t` and `x > (k − 1)·t`,
/// hence `t > 0`, and no ray of any column does. The same of rows. Which `k` to try is a guess. What is computed
/// is not certain within [`super::rough::Kind::column_error`]; of NaN nothing is.
#[inline(always)]
pub(super) fn pass<S: Simd>(simd: S, lens: &Lens, pair: [&Leaf; 2], farthest: f32) -> mask32x16<S> {
    let [a, b, c] =
        [corner(simd, lens, pair, 0), corner(simd, lens, pair, 1), corner(simd, lens, pair, 2)];
    let behind = a[0].min(b[0]).min(c[0]).simd_gt(f32x16::splat(simd, farthest));
    let one = f32x16::splat(simd, 1.0);
    let t = if lens.kind.parallel { [one; 3] } else { [a[0], b[0], c[0]] };
    let guess = one / t[0];
    let beside = is_between(simd, lens, [a[1], b[1], c[1]], &t, guess);
    let above = is_between(simd, lens, [a[2], b[2], c[2]], &t, guess);
    !(behind | beside | above)
}

/// One row of two leaves.
#[inline(always)]
fn load<S: Simd>(simd: S, [first, second]: [&Leaf; 2], row: usize) -> f32x16<S> {
    simd.combine_f32x8(
        f32x8::load_array_ref(simd, &first.corners[row]),
        f32x8::load_array_ref(simd, &second.corners[row]),
    )
}

/// `(t, x, y)` of one corner of each triangle.
#[inline(always)]
fn corner<S: Simd>(
    simd: S,
    Lens { kind, rough, .. }: &Lens,
    pair: [&Leaf; 2],
    corner: usize,
) -> [f32x16<S>; 3] {
    let [ex, ey, ez] = kind.rough.eye;
    let p = [
        load(simd, pair, 3 * corner) - ex,
        load(simd, pair, 3 * corner + 1) - ey,
        load(simd, pair, 3 * corner + 2) - ez,
    ];
    [kind.rough.t.at(p), rough.across.at(p), rough.down.at(p)]
}

/// Whether triangles certainly lie between two neighbouring columns, or beside all of the tile's. Comparisons
/// with NaN are false.
#[inline(always)]
fn is_between<S: Simd>(
    simd: S,
    lens: &Lens,
    [a, b, c]: [f32x16<S>; 3],
    [ta, tb, tc]: &[f32x16<S>; 3],
    guess: f32x16<S>,
) -> mask32x16<S> {
    #[expect(clippy::cast_precision_loss, reason = "at most 32")]
    let columns = f32x16::splat(simd, lens.kind.side as f32);
    let (zero, half) = (f32x16::splat(simd, 0.0), lens.offset(0));
    let error = f32x16::splat(simd, lens.kind.rough.column_error);
    // The first column to the right of a corner, counted from the tile's first, and from its middle.
    let next = (a * guess - (half - 1.0)).floor().max(zero).min(columns);
    let k = next + half;
    let (a, b, c) = (a - k * *ta, b - k * *tb, c - k * *tc);
    let left = a.max(b).max(c).simd_lt(-error) | next.simd_eq(columns);
    let (a, b, c) = (a + *ta, b + *tb, c + *tc);
    let right = a.min(b).min(c).simd_gt(error) | next.simd_eq(zero);
    left & right
}
