//! Bounds on the raster: the rows and columns of a tile that something may cover.

use super::search::tile_frustum::TileFrustum;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, mask32x8};
use glam::DVec3;

/// The first and the last row of the tile that triangles may cover, and the first and the last column. Each corner
/// is given by its `(t, x, y)`, which is off by at most `e`.
#[inline(always)]
pub(super) fn of_triangles<S: Simd>(
    simd: S,
    frustum: &TileFrustum,
    e: f32x8<S>,
    [[ta, xa, ya], [tb, xb, yb], [tc, xc, yc]]: &[[f32x8<S>; 3]; 3],
) -> [[f32x8<S>; 2]; 2] {
    let template = frustum.template;
    let (x, y, safe) = if template.parallel {
        let safe = e.simd_lt(f32x8::splat(simd, 1.0 / 16384.0));
        ([*xa, *xb, *xc], [*ya, *yb, *yc], safe)
    } else {
        let one = f32x8::splat(simd, 1.0);
        let (ra, rb, rc) = (one / *ta, one / *tb, one / *tc);
        let safe = ta.min(*tb).min(*tc).simd_gt(e * 16384.0);
        ([*xa * ra, *xb * rb, *xc * rc], [*ya * ra, *yb * rb, *yc * rc], safe)
    };
    let safe = safe & mask32x8::splat(simd, template.errors.small);
    let (left, right) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    let (upper, lower) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
    let side = template.side;
    [between(simd, upper, lower, safe, side), between(simd, left, right, safe, side)]
}

/// The first and the last column (or row) of the tile between two places, counted from its middle; all
/// columns where that is not `safe`.
///
/// Where `t ≥ 2¹⁴·e`, a corner's column is off by at most `2⁻¹⁴·(1 + |x|)`, and in `f32` by four roundings
/// more; so is that of a parallel camera where `e < 2⁻¹⁴`. Samples are off by less than 2⁻¹⁰, or
/// `MapErrors::small` would be false. The margin is larger.
#[inline(always)]
fn between<S: Simd>(
    simd: S,
    low: f32x8<S>,
    high: f32x8<S>,
    safe: mask32x8<S>,
    side: usize,
) -> [f32x8<S>; 2] {
    #[expect(clippy::cast_precision_loss, reason = "at most 31")]
    let end = (side - 1) as f32;
    let (half, zero, last) = (0.5 * end, f32x8::splat(simd, 0.0), f32x8::splat(simd, end));
    let first = (low - (low.abs() * (1.0 / 4096.0) + 1.0 / 512.0) + half).ceil().max(zero);
    let end = (high + (high.abs() * (1.0 / 4096.0) + 1.0 / 512.0) + half).floor().min(last);
    [safe.select(first, zero), safe.select(end, last)]
}

/// The rows and columns of the tile that a sphere's box may cover; all, where a corner of it is not in
/// front of the eye.
///
/// A corner is trusted where `t ≥ 2¹⁴·e`: its column is then off by at most `2⁻¹⁴·(1 + |x|)`. The margin
/// of a hundredth, and as much of `x`, is larger than that, than the samples' errors and than those of the
/// sphere's box.
pub(super) fn of_sphere(frustum: &TileFrustum, center: DVec3, radius: f64) -> [[usize; 2]; 2] {
    let side = frustum.template.side;
    let all = [[0, side]; 2];
    if !frustum.template.errors.small {
        return all;
    }
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for k in 0..8 {
        let sign = |axis: usize| if k >> axis & 1 == 1 { radius } else { -radius };
        let corner = center + DVec3::new(sign(0), sign(1), sign(2));
        // The bounds are made for what boxes hold; a sphere without one may be larger.
        if corner.abs().max_element() > 2.0 * frustum.template.errors.reach {
            return all;
        }
        let [t, x, y] = std::array::from_fn(|row| {
            DVec3::from_array(frustum.rows[row]).dot(corner) + frustum.shift[row]
        });
        let place = if frustum.template.parallel {
            [y, x]
        } else if t > 16384.0 * frustum.template.errors.corner {
            [y / t, x / t]
        } else {
            return all;
        };
        for axis in 0..2 {
            low[axis] = low[axis].min(place[axis]);
            high[axis] = high[axis].max(place[axis]);
        }
    }
    if frustum.template.parallel && frustum.template.errors.corner * 16384.0 > 1.0 {
        return all;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
    std::array::from_fn(|axis| {
        let margin = |x: f64| 0.01 + 0.01 * x.abs();
        #[expect(clippy::cast_precision_loss, reason = "at most 32")]
        let end = side as f64;
        let first = (low[axis] - margin(low[axis]) + frustum.template.half).ceil().clamp(0.0, end);
        let behind =
            (high[axis] + margin(high[axis]) + frustum.template.half + 1.0).floor().clamp(0.0, end);
        [first as usize, behind as usize]
    })
}
