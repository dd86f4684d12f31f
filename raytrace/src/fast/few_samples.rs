//! Triangles over few samples: a triangle a lane, one of its samples at a time.

use super::search::tile_frustum::TileFrustum;
use super::setup::{Setup, TrianglePacket};
use super::tile::{TileBuffer, index};
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x8};

/// Tests those of eight triangles that are `few`, each at its `samples`.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    frustum: &TileFrustum,
    setup: &Setup<C::Simd>,
    (eight, few): (&TrianglePacket, u64),
    samples: f32x8<C::Simd>,
    tile: &mut TileBuffer,
) {
    let simd = context.simd();
    let half = f32x8::splat(simd, frustum.centered(0));
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let [first, last] = setup.columns;
    let (mut column, mut row) = (first, setup.rows[0]);
    let mut done = zero;
    let mut steps = 0;
    loop {
        let active = samples.simd_gt(done).to_bitmask() & few;
        if active == 0 {
            break;
        }
        steps += 1;
        let Fragments { mut perhaps, inside, low, high } = Fragments::new(
            simd,
            setup,
            [row + half, column + half],
            frustum.template.parallel,
            active,
        );
        if perhaps != 0 {
            let (low, high) = (low.to_array(), high.to_array());
            let (columns, rows) = (column.to_array(), row.to_array());
            while perhaps != 0 {
                let lane = (perhaps.trailing_zeros() & 7) as usize;
                perhaps &= perhaps - 1;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a row and a column of the tile"
                )]
                let at = index(rows[lane] as u32 as usize, columns[lane] as u32 as usize);
                let certain = inside >> lane & 1 == 1;
                let key = [low[lane], high[lane]];
                tile.fragment(context, at, (lane, eight.ids[lane]), certain, key);
            }
        }
        done += one;
        column += one;
        let wraps = column.simd_gt(last);
        column = wraps.select(first, column);
        row += wraps.select(one, zero);
    }
    tile.executed.lane_steps += steps;
}

/// Eight triangles, each tested at one sample.
struct Fragments<S: Simd> {
    /// The lanes whose triangles may cover the sample, and those that certainly do.
    perhaps: u64,
    inside: u64,
    /// The ends of their keys.
    low: f32x8<S>,
    high: f32x8<S>,
}

impl<S: Simd> Fragments<S> {
    /// Tests the `active` triangles, each at a row and a column that are counted from the tile's middle.
    #[inline(always)]
    fn new(
        simd: S,
        setup: &Setup<S>,
        [row, column]: [f32x8<S>; 2],
        parallel: bool,
        active: u64,
    ) -> Self {
        let zero = f32x8::splat(simd, 0.0);
        let [ab, bc, ca] = &setup.edges;
        let (e0, e1, e2) = (ab.at(row, column), bc.at(row, column), ca.at(row, column));
        let (least, minus_error) = (e0.min(e1).min(e2), -setup.error);
        let out = e0.simd_lt(minus_error) | e1.simd_lt(minus_error) | e2.simd_lt(minus_error);
        let mut perhaps = !out.to_bitmask() & active;
        if perhaps == 0 {
            return Fragments { perhaps, inside: 0, low: zero, high: zero };
        }
        let key = setup.key.at(row, column);
        let (low, high) = (key - setup.key_error, key + setup.key_error);
        let mut inside = least.simd_gt(setup.error);
        if parallel {
            // In front of the eye a key is negative; behind it there is nothing to see.
            perhaps &= !low.simd_gt(zero).to_bitmask();
            inside &= high.simd_lt(zero);
        }
        Fragments { perhaps, inside: inside.to_bitmask(), low, high }
    }
}
