//! Triangles over few samples: a triangle a lane, one of its samples at a time.

use super::fragments::Fragments;
use super::search::tile_frustum::TileFrustum;
use super::setup::{Setup, TrianglePacket};
use super::tile::TileBuffer;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x8, mask32x8};

/// Tests those of eight triangles that are `few`, each at its `samples`.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    frustum: &TileFrustum,
    setup: &Setup<C::Simd>,
    (eight, few): (&TrianglePacket, u64),
    samples: f32x8<C::Simd>,
    (fragments, tile): (&mut Fragments, &mut TileBuffer),
) {
    let simd = context.simd();
    let splat = |value: f32| f32x8::splat(simd, value);
    let half = splat(frustum.centered(0));
    let (zero, one) = (splat(0.0), splat(1.0));
    let [first, last] = setup.columns;
    let (mut column, mut row) = (first, setup.rows[0]);
    let few = mask32x8::from_bitmask(simd, few);
    let remaining = few.select(samples, zero);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let steps = simd.reduce_max_f32x8(remaining) as u32;
    let mut done = zero;
    for _ in 0..steps {
        let active = remaining.simd_gt(done);
        let at = [row + half, column + half];
        let (perhaps, inside, low, high) = test(simd, setup, at, frustum.template.parallel, active);
        fragments.add(simd, [row, column], (perhaps, inside), [low, high]);
        done += one;
        column += one;
        let wraps = column.simd_gt(last);
        column = wraps.select(first, column);
        row += wraps.select(one, zero);
    }
    tile.executed.lane_steps += u64::from(steps);
    fragments.test_depth(context, &eight.ids, tile);
}

/// Tests the `active` ones of eight triangles, each at a row and a column that are counted from the tile's middle.
/// Returns the lanes whose triangles may cover the sample, those that certainly do, and the ends of their keys.
#[inline(always)]
fn test<S: Simd>(
    simd: S,
    setup: &Setup<S>,
    [row, column]: [f32x8<S>; 2],
    parallel: bool,
    active: mask32x8<S>,
) -> (mask32x8<S>, mask32x8<S>, f32x8<S>, f32x8<S>) {
    let zero = f32x8::splat(simd, 0.0);
    let [ab, bc, ca] = &setup.edges;
    let (e0, e1, e2) = (ab.at(row, column), bc.at(row, column), ca.at(row, column));
    let (least, minus_error) = (e0.min(e1).min(e2), -setup.error);
    let out = e0.simd_lt(minus_error) | e1.simd_lt(minus_error) | e2.simd_lt(minus_error);
    let mut perhaps = active & !out;
    let key = setup.key.at(row, column);
    let (low, high) = (key - setup.key_error, key + setup.key_error);
    let mut inside = least.simd_gt(setup.error);
    if parallel {
        // In front of the eye a key is negative; behind it there is nothing to see.
        perhaps &= !low.simd_gt(zero);
        inside &= high.simd_lt(zero);
    }
    (perhaps, inside, low, high)
}
