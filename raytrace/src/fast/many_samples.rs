//! Triangles over many samples, and planes: one of them at sixteen blocks at once, then at the sixteen samples of each
//! block that is left.

use super::lane_affine::LaneAffine;
use super::search::tile_frustum::TileFrustum;
use super::setup::Setup;
use super::tile::{TileBuffer, place};
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, apart, f32x16, u32x16};

/// A setup, to be read lane by lane.
#[derive(Default)]
pub(super) struct SetupArrays {
    /// For each edge, and for the key: at the middle, across, down.
    affine: [[[f32; 8]; 3]; 4],
    error: [f32; 8],
    key_error: [f32; 8],
    rows: [[f32; 8]; 2],
    columns: [[f32; 8]; 2],
}

impl SetupArrays {
    #[inline(always)]
    pub(super) fn new<S: Simd>(setup: &Setup<S>) -> SetupArrays {
        let [ab, bc, ca] = &setup.edges;
        SetupArrays {
            affine: [arrays(ab), arrays(bc), arrays(ca), arrays(&setup.key)],
            error: setup.error.to_array(),
            key_error: setup.key_error.to_array(),
            rows: [setup.rows[0].to_array(), setup.rows[1].to_array()],
            columns: [setup.columns[0].to_array(), setup.columns[1].to_array()],
        }
    }
}

/// The setup of one triangle or plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatSetup {
    /// For each edge, and for the key: at the middle, across, down.
    pub(super) affine: [[f32; 3]; 4],
    pub(super) error: f32,
    pub(super) key_error: f32,
    /// The first row of the tile that it may cover, and the last; likewise columns.
    pub(super) rows: [f32; 2],
    pub(super) columns: [f32; 2],
}

impl SetupArrays {
    /// The setup of one triangle or plane, in its lane.
    pub(super) fn of_one(lane: usize, setup: &FlatSetup) -> SetupArrays {
        let mut arrays = SetupArrays::default();
        arrays.replace(lane, setup);
        arrays
    }

    /// Replaces what is in a lane.
    pub(super) fn replace(&mut self, lane: usize, setup: &FlatSetup) {
        for (to, of) in self.affine.iter_mut().zip(setup.affine) {
            to.iter_mut().zip(of).for_each(|(to, of)| to[lane] = of);
        }
        self.error[lane] = setup.error;
        self.key_error[lane] = setup.key_error;
        for end in [0, 1] {
            self.rows[end][lane] = setup.rows[end];
            self.columns[end][lane] = setup.columns[end];
        }
    }
}

#[inline(always)]
fn arrays<S: Simd>(affine: &LaneAffine<S>) -> [[f32; 8]; 3] {
    [affine.at_middle.to_array(), affine.across.to_array(), affine.down.to_array()]
}

/// The middles of the blocks of a group, from the middle of the first; and those of a block's samples, from its
/// middle.
pub(super) const STEPS: [f32; 4] = [0.0, 4.0, 8.0, 12.0];
pub(super) const WITHIN: [f32; 4] = [-1.5, -0.5, 0.5, 1.5];

/// The columns of sixteen places, four times the same four; and their rows.
#[inline(always)]
pub(super) fn columns<S: Simd>(simd: S, of: [f32; 4]) -> f32x16<S> {
    let [a, b, c, d] = of;
    f32x16::load_array(simd, [a, b, c, d, a, b, c, d, a, b, c, d, a, b, c, d])
}

#[inline(always)]
pub(super) fn rows<S: Simd>(simd: S, of: [f32; 4]) -> f32x16<S> {
    let [a, b, c, d] = of;
    f32x16::load_array(simd, [a, a, a, a, b, b, b, b, c, c, c, c, d, d, d, d])
}

/// [`draw`] for what is set up alone. It is compiled once for all loops that call it.
#[inline(never)]
pub(super) fn draw_one<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    setup: &SetupArrays,
    which: (usize, u32),
    tile: &mut TileBuffer,
) {
    apart!(simd, draw(simd, frustum, setup, which, tile));
}

/// Tests the triangle or plane of one lane at the samples of the tile.
#[inline(always)]
pub(super) fn draw<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    setup: &SetupArrays,
    (lane, id): (usize, u32),
    tile: &mut TileBuffer,
) {
    let triangle = TriangleSetup::new(simd, frustum, setup, (lane, id));
    let [ab, bc, ca] = &triangle.edges;
    let key = &triangle.key;
    let side = tile.side();
    let mut groups = groups(tile.blocks() / 16, [triangle.rows, triangle.columns]);
    while groups != 0 {
        let group = groups.trailing_zeros() as usize;
        groups &= groups - 1;
        let [top, left] = place(side, group * 256);
        let by = rows(simd, STEPS) + (frustum.centered(top) + 1.5);
        let bx = columns(simd, STEPS) + (frustum.centered(left) + 1.5);
        let (v0, v1, v2, v3) = (ab.at(by, bx), bc.at(by, bx), ca.at(by, bx), key.at(by, bx));
        // Blocks that are certainly outside of an edge or of the bounds, or hidden.
        let outside = (v0 + ab.spread).simd_lt(triangle.minus_error)
            | (v1 + bc.spread).simd_lt(triangle.minus_error)
            | (v2 + ca.spread).simd_lt(triangle.minus_error);
        let far = f32x16::from_slice(simd, &tile.block_far[group * 16..group * 16 + 16]);
        let hidden = (v3 + key.spread + triangle.key_error).simd_lt(far);
        let ([upper, lower], [first, last]) = (triangle.rows, triangle.columns);
        let beside = bx.simd_lt(f32x16::splat(simd, first - 1.5))
            | bx.simd_gt(f32x16::splat(simd, last + 1.5))
            | by.simd_lt(f32x16::splat(simd, upper - 1.5))
            | by.simd_gt(f32x16::splat(simd, lower + 1.5));
        let mut left = !(outside | hidden | beside).to_bitmask() & 0xffff;
        tile.executed.blocks += u64::from(left.count_ones());
        let values = [v0.to_array(), v1.to_array(), v2.to_array(), v3.to_array()];
        while left != 0 {
            let block = (left.trailing_zeros() & 15) as usize;
            left &= left - 1;
            triangle.draw_block(simd, frustum, (group, block), &values, tile);
        }
    }
}

/// The groups of blocks, of so many in the tile, that hold samples between the first and the last of some rows and columns,
/// counted from the tile's middle: a bit for each. NaN leaves none out.
#[inline(always)]
fn groups(count: usize, [rows, columns]: [[f32; 2]; 2]) -> u32 {
    if count < 4 {
        return (1 << count) - 1;
    }
    // Two rows of two groups, which meet in the tile's middle.
    let halves = |[first, last]: [f32; 2]| {
        [if first > 0.0 { 0 } else { u32::MAX }, if last < 0.0 { 0 } else { u32::MAX }]
    };
    let ([upper, lower], [left, right]) = (halves(rows), halves(columns));
    (upper & 0b0011 | lower & 0b1100) & (left & 0b0101 | right & 0b1010)
}

/// One triangle or plane and its affine functions, the same in every lane.
struct TriangleSetup<S: Simd> {
    id: u32,
    lane: usize,
    edges: [BlockAffine<S>; 3],
    key: BlockAffine<S>,
    error: f32x16<S>,
    minus_error: f32x16<S>,
    key_error: f32x16<S>,
    /// The first and the last row that it may cover, and column, from the tile's middle.
    rows: [f32; 2],
    columns: [f32; 2],
}

impl<S: Simd> TriangleSetup<S> {
    #[inline(always)]
    fn new(
        simd: S,
        frustum: &TileFrustum,
        setup: &SetupArrays,
        (lane, id): (usize, u32),
    ) -> TriangleSetup<S> {
        let SetupArrays { affine, rows, columns, .. } = setup;
        let half = frustum.centered(0);
        let error = f32x16::splat(simd, setup.error[lane]);
        TriangleSetup {
            id,
            lane,
            edges: [
                BlockAffine::new(simd, &affine[0], lane),
                BlockAffine::new(simd, &affine[1], lane),
                BlockAffine::new(simd, &affine[2], lane),
            ],
            key: BlockAffine::new(simd, &affine[3], lane),
            error,
            minus_error: -error,
            key_error: f32x16::splat(simd, setup.key_error[lane]),
            rows: [rows[0][lane] + half, rows[1][lane] + half],
            columns: [columns[0][lane] + half, columns[1][lane] + half],
        }
    }

    /// Tests it at the samples of a block of a group; `values` holds the edge functions and the key in the middles of
    /// the group's blocks.
    #[inline(always)]
    fn draw_block(
        &self,
        simd: S,
        frustum: &TileFrustum,
        (group, block): (usize, usize),
        values: &[[f32; 16]; 4],
        tile: &mut TileBuffer,
    ) {
        let [ab, bc, ca] = &self.edges;
        let e0 = ab.within + values[0][block];
        let e1 = bc.within + values[1][block];
        let e2 = ca.within + values[2][block];
        let keys = self.key.within + values[3][block];
        let least = e0.min(e1).min(e2);
        let (low, high) = (keys - self.key_error, keys + self.key_error);
        let from = (group * 16 + block) * 16;
        let stored_low = f32x16::from_slice(simd, &tile.low[from..from + 16]);
        let stored_high = f32x16::from_slice(simd, &tile.high[from..from + 16]);
        let mut inside = least.simd_gt(self.error);
        // Not the least of the three: it need not be NaN where one of them is.
        let out = e0.simd_lt(self.minus_error)
            | e1.simd_lt(self.minus_error)
            | e2.simd_lt(self.minus_error);
        let mut nowhere = out | high.simd_lt(stored_low);
        if frustum.template.parallel {
            let zero = f32x16::splat(simd, 0.0);
            nowhere |= low.simd_gt(zero);
            inside &= high.simd_lt(zero);
        }
        let nearer = inside & low.simd_gt(stored_high);
        if nearer.any_true() {
            nearer.select(low, stored_low).store_slice(&mut tile.low[from..from + 16]);
            nearer.select(high, stored_high).store_slice(&mut tile.high[from..from + 16]);
            let ids = u32x16::from_slice(simd, &tile.ids[from..from + 16]);
            let ids = nearer.select(u32x16::splat(simd, self.id), ids);
            ids.store_slice(&mut tile.ids[from..from + 16]);
            tile.dirty |= 1 << (group * 16 + block);
        }
        let open = !(nowhere | nearer).to_bitmask() & 0xffff;
        if open != 0 {
            tile.leave_all_open(from, open, self.lane, inside.to_bitmask());
        }
    }
}

/// An affine function of one triangle, in every lane.
struct BlockAffine<S: Simd> {
    at_middle: f32x16<S>,
    across: f32x16<S>,
    down: f32x16<S>,
    /// From the middle of a block to its samples.
    within: f32x16<S>,
    /// At most how far from its value at the middle it is at a sample of the block.
    spread: f32x16<S>,
}

impl<S: Simd> BlockAffine<S> {
    #[inline(always)]
    fn new(simd: S, of: &[[f32; 8]; 3], lane: usize) -> Self {
        let [at_middle, across, down] = [of[0][lane], of[1][lane], of[2][lane]];
        let (across, down) = (f32x16::splat(simd, across), f32x16::splat(simd, down));
        BlockAffine {
            at_middle: f32x16::splat(simd, at_middle),
            across,
            down,
            within: across * columns(simd, WITHIN) + down * rows(simd, WITHIN),
            spread: (across.abs() + down.abs()) * 1.500_001,
        }
    }

    /// The values at rows and columns, counted from the tile's middle.
    #[inline(always)]
    fn at(&self, row: f32x16<S>, column: f32x16<S>) -> f32x16<S> {
        (self.at_middle + self.down * row) + self.across * column
    }
}

#[cfg(test)]
mod tests {
    use super::groups;
    use crate::fast::tile::place;

    #[test]
    fn groups_are_left_out_where_no_sample_lies_in_them() {
        let places = [0, 1, 14, 15, 16, 17, 30, 31_u8];
        let ranges = || {
            let to_last = |first: u8| places.into_iter().map(move |last| [first, last]);
            places.into_iter().flat_map(to_last).filter(|[first, last]| first <= last)
        };
        let centered = |range: [u8; 2]| range.map(|place| f32::from(place) - 15.5);
        for rows in ranges() {
            for columns in ranges() {
                let holds = |group: &usize| {
                    let begins = place(32, group * 256);
                    [rows, columns].iter().zip(begins).all(|(&[first, last], begin)| {
                        usize::from(first) < begin + 16 && usize::from(last) >= begin
                    })
                };
                let expected = (0..4).filter(holds).fold(0, |bits, group| bits | 1 << group);
                assert_eq!(
                    groups(4, [rows, columns].map(centered)),
                    expected,
                    "{rows:?} {columns:?}"
                );
            }
        }
    }

    #[test]
    fn no_group_is_left_out_where_nothing_is_known() {
        let [all, none] = [[-15.5, 15.5], [f32::NAN; 2]];
        for known in [[none, none], [all, none], [none, all], [all, all]] {
            assert_eq!(groups(4, known), 0b1111);
        }
        // Small tiles have one group, or blocks alone.
        assert_eq!([groups(1, [[3.0, 3.0]; 2]), groups(0, [[0.0, 0.0]; 2])], [1, 0]);
    }
}
