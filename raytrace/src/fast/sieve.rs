//! What of leaves is worth setting up: most triangles of most leaves cover no sample of the tile.
//!
//! Where triangles are large, those that may are drawn at once, because of what they hide. Where they are small,
//! leaves wait until the machine has fetched them, and triangles until there are eight, of several leaves.

use super::rays::Lens;
use super::tree::{Leaf, WIDTH};
use bothways_common::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, mask32x16, u32x8,
};

/// So many leaves wait.
const LEAVES: usize = 4;
/// Room for so many triangles, those of all leaves and those that are stored before it is known how many count.
const ROOM: usize = 80 + LEAVES * WIDTH + WIDTH;

/// Leaves and triangles that wait.
#[derive(Debug)]
pub(super) struct Sieve {
    /// Numbers of leaves, and which of their triangles count.
    leaves: [(usize, u64); LEAVES],
    leaf_count: usize,
    corners: [[f32; ROOM]; 9],
    ids: [u32; ROOM],
    /// The first triangle that waits, and the end of them.
    first: usize,
    end: usize,
}

impl Sieve {
    pub(super) const fn new() -> Sieve {
        Sieve {
            leaves: [(0, 0); LEAVES],
            leaf_count: 0,
            corners: [[0.0; ROOM]; 9],
            ids: [0; ROOM],
            first: 0,
            end: 0,
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
        self.leaf_count + self.count() == 0
    }

    /// How many triangles wait.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.end - self.first
    }

    /// Looks at the two leaves that have waited longest, or all, and lets triangles of theirs wait; there may be
    /// seven already. It branches on no result, none of which could be foreseen.
    #[inline(always)]
    pub(super) fn sift<S: Simd>(
        &mut self,
        simd: S,
        leaves: &[Leaf],
        lens: &Lens,
        farthest: f32,
        tiny: bool,
        all: bool,
    ) {
        if self.end > ROOM - LEAVES * WIDTH - WIDTH {
            self.move_to_start(simd);
        }
        let ripe = if all { self.leaf_count.min(LEAVES) } else { 2 };
        for pair in self.leaves[..ripe].chunks(2) {
            let [first, second] = [pair[0], *pair.get(1).unwrap_or(&(pair[0].0, 0))];
            let used = mask32x16::from_bitmask(simd, first.1 | second.1 << WIDTH);
            let pair = [&leaves[first.0], &leaves[second.0]];
            let passed = pass(simd, lens, pair, farthest, tiny) & used;
            let at = self.end.min(ROOM - 2 * WIDTH);
            for (row, to) in self.corners.iter_mut().enumerate() {
                load(simd, pair, row).compress(passed).store_slice(&mut to[at..at + 2 * WIDTH]);
            }
            let ids = simd.combine_u32x8(
                u32x8::load_array_ref(simd, &pair[0].ids),
                u32x8::load_array_ref(simd, &pair[1].ids),
            );
            ids.compress(passed).store_slice(&mut self.ids[at..at + 2 * WIDTH]);
            self.end = at + passed.to_bitmask().count_ones() as usize;
        }
        self.leaves.copy_within(2.., 0);
        self.leaf_count -= ripe;
    }

    /// The next eight of the triangles that wait, or all, and others with them; they no longer wait.
    #[inline(always)]
    pub(super) fn take_eight<S: Simd>(&mut self, simd: S) -> Leaf {
        let first = self.first.min(ROOM - WIDTH);
        let mut leaf = Leaf { corners: [[0.0; WIDTH]; 9], ids: [0; WIDTH] };
        let row = |row: usize| f32x8::from_slice(simd, &self.corners[row][first..first + WIDTH]);
        // In the pairs in which they are loaded, or else the machine would wait until they are in its cache.
        for (pair, to) in leaf.corners.as_flattened_mut().chunks_exact_mut(2 * WIDTH).enumerate() {
            simd.combine_f32x8(row(2 * pair), row(2 * pair + 1)).store_slice(to);
        }
        row(8).store_array(&mut leaf.corners[8]);
        u32x8::from_slice(simd, &self.ids[first..first + WIDTH]).store_array(&mut leaf.ids);
        self.first = (self.first + WIDTH).min(self.end);
        if self.first == self.end {
            [self.first, self.end] = [0, 0];
        }
        leaf
    }

    /// Makes room: less than eight triangles wait.
    #[inline(always)]
    fn move_to_start<S: Simd>(&mut self, simd: S) {
        let (first, count) = (self.first.min(ROOM - WIDTH), self.count());
        for row in &mut self.corners {
            f32x8::from_slice(simd, &row[first..first + WIDTH]).store_slice(&mut row[..WIDTH]);
        }
        u32x8::from_slice(simd, &self.ids[first..first + WIDTH])
            .store_slice(&mut self.ids[..WIDTH]);
        [self.first, self.end] = [0, count];
    }
}

/// Which triangles of two leaves may cover samples of the tile, and be no farther than `farthest`.
///
/// All corners to the left of the plane through a column's rays: no ray of the column meets the triangle, nor one
/// of any column to its right. The same of the right, and of rows. So what lies between two neighbouring columns
/// or rows covers nothing; and what may cover one column of one row alone covers that sample or none, as its edge
/// functions say. Which column to try is a guess. What is computed is not certain within
/// [`super::rough::Kind::column_error`]; of NaN nothing is.
#[inline(always)]
pub(super) fn pass<S: Simd>(
    simd: S,
    lens: &Lens,
    pair: [&Leaf; 2],
    farthest: f32,
    tiny: bool,
) -> mask32x16<S> {
    let [a, b, c] =
        [corner(simd, lens, pair, 0), corner(simd, lens, pair, 1), corner(simd, lens, pair, 2)];
    let behind = a[0].min(b[0]).min(c[0]).simd_gt(f32x16::splat(simd, farthest));
    let one = f32x16::splat(simd, 1.0);
    let t = if lens.kind.parallel { [one; 3] } else { [a[0], b[0], c[0]] };
    let guess = one / t[0];
    let columns = Between::new(simd, lens, [a[1], b[1], c[1]], &t, guess);
    let rows = Between::new(simd, lens, [a[2], b[2], c[2]], &t, guess);
    let missed = behind | columns.none | rows.none;
    if tiny {
        !(missed | columns.one & rows.one & is_beside(simd, lens, &columns.at, &rows.at, &t))
    } else {
        !missed
    }
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

/// Where triangles lie between the tile's columns, or its rows.
struct Between<S: Simd> {
    /// They certainly cover no column of the tile.
    none: mask32x16<S>,
    /// They certainly cover no column but one, and no corner is more than a column from it.
    one: mask32x16<S>,
    /// The corners as seen from that column, some triangles mirrored.
    at: [f32x16<S>; 3],
}

impl<S: Simd> Between<S> {
    #[inline(always)]
    fn new(
        simd: S,
        lens: &Lens,
        [a, b, c]: [f32x16<S>; 3],
        [ta, tb, tc]: &[f32x16<S>; 3],
        guess: f32x16<S>,
    ) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "at most 32")]
        let columns = f32x16::splat(simd, lens.kind.side as f32);
        let (zero, half) = (f32x16::splat(simd, 0.0), lens.offset(0));
        let error = f32x16::splat(simd, lens.kind.rough.column_error);
        // The first column to the right of a corner, counted from the tile's first, and from its middle.
        let next = (a * guess - (half - 1.0)).floor().max(zero).min(columns);
        let k = next + half;
        let (a, b, c) = (a - k * *ta, b - k * *tb, c - k * *tc);
        let left = a.max(b).max(c).simd_lt(-error);
        let (a1, b1, c1) = (a + *ta, b + *tb, c + *tc);
        let right = a1.min(b1).min(c1).simd_gt(error);
        // Of the two columns, the one that is left.
        let at = [left.select(a1, -a), left.select(b1, -b), left.select(c1, -c)];
        let beyond = (at[0] + *ta).min(at[1] + *tb).min(at[2] + *tc).simd_gt(error);
        Between {
            none: (left | next.simd_eq(columns)) & (right | next.simd_eq(zero)),
            one: (left ^ right) & beyond,
            at,
        }
    }
}

/// Whether triangles certainly do not cover the sample from which their corners are seen, no more than a column and
/// a row away: two edge functions have different signs.
///
/// With `e` the error of a coordinate and `m` the largest `t` of the corners, which bounds these coordinates here but
/// for `2u`, `u = 2⁻²⁴`: both products of an edge function are off by at most `2me + e²` and one rounding, and their
/// difference brings another, `4me + 2e² + 4.1·u·m²` in all. Since `e > 9u·m` (a column error holds that of `t`; of a
/// parallel camera `m` is 1, and its error holds that of a column), `5·(m + e)·e` is more, with its own roundings.
#[inline(always)]
fn is_beside<S: Simd>(
    simd: S,
    lens: &Lens,
    x: &[f32x16<S>; 3],
    y: &[f32x16<S>; 3],
    [ta, tb, tc]: &[f32x16<S>; 3],
) -> mask32x16<S> {
    let error = f32x16::splat(simd, lens.kind.rough.column_error);
    let error = (ta.max(*tb).max(*tc) + error) * (error * 5.0);
    let ab = x[0] * y[1] - y[0] * x[1];
    let bc = x[1] * y[2] - y[1] * x[2];
    let ca = x[2] * y[0] - y[2] * x[0];
    ab.max(bc).max(ca).simd_gt(error) & ab.min(bc).min(ca).simd_lt(-error)
}
