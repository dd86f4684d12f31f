//! A triangle set up in `f64`: edge functions and depth as affine functions on the viewport, with the errors of their
//! rounding.

use crate::fast::camera_map::{CameraMap, samples_between};
use crate::fast::depth::depth_plane;
use crate::fast::viewport_affine::ViewportAffine;
use bothways_common::engine::fault::{Fault, Planted, error_bound};
use bothways_common::engine::roundoff::{EPS53, cross_permanent};
use bothways_common::{Judge, Projection, Sign};
use glam::DVec3;
use std::ops::Range;

/// A triangle, set up in `f64`. Its edge functions are positive inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct F64Setup {
    pub(crate) edges: [ViewportAffine; 3],
    pub(crate) depth: ViewportAffine,
    /// The sign of the facing, ±1, by which the edge functions were multiplied.
    pub(crate) facing: f64,
}

impl F64Setup {
    /// Edge functions and depth; `None` for a triangle that is edge-on, which covers nothing.
    #[inline(always)]
    pub(crate) fn new<F: Fault>(
        map: &CameraMap,
        judge: &Judge,
        corners: &[DVec3; 3],
    ) -> Option<Self> {
        let [a, b, c] = *corners;
        let (along_b, along_c) = (b - a, c - a);
        let normal = along_b.cross(along_c);
        let permanent = cross_permanent(along_b, along_c);
        let facing = facing::<F>(map, judge, corners, normal, permanent)?;
        let edge = |p, q| {
            let ends = [p, q].map(|corner| map.local.relative(corner));
            edge_function(map, ends, p - q).oriented(facing)
        };
        let mut setup = F64Setup {
            edges: [edge(a, b), edge(b, c), edge(c, a)],
            depth: depth_plane(map, a, normal, permanent),
            facing,
        };
        setup.edges.iter_mut().for_each(|edge| edge.error = error_bound::<F>(edge.error));
        setup.depth.error = error_bound::<F>(setup.depth.error);
        Some(setup)
    }

    /// The columns at which, on some row from one to another, no edge function is certainly negative, widened by one.
    #[inline(always)]
    pub(crate) fn span(
        &self,
        map: &CameraMap,
        ys: [f64; 2],
        columns: &Range<usize>,
    ) -> Range<usize> {
        let mut low = f64::NEG_INFINITY;
        let mut high = f64::INFINITY;
        for edge in &self.edges {
            // on_row + x·across ≥ −error; rounding keeps order, so that no row between has a larger on_row.
            let on_row = edge.on_row(ys[0]).max(edge.on_row(ys[1]));
            let crossing = (-edge.error - on_row) / edge.across;
            if edge.across > 0.0 {
                low = low.max(crossing);
            } else if edge.across < 0.0 {
                high = high.min(crossing);
            } else if on_row < -edge.error {
                return columns.start..columns.start;
            }
        }
        // In the picture a column is rounded by less than 2⁻³³; one column is room enough.
        let [first, last] = [low, high].map(|x| map.column(x));
        let span = samples_between(first - 1.0, last + 1.0, columns.end);
        span.start.clamp(columns.start, columns.end)..span.end.clamp(columns.start, columns.end)
    }
}

/// The sign of `F`, ±1, or `None` if it is zero.
///
/// Perspective: `F = n·a`, `n = (b − a) × (c − a)`, of which each coordinate carries 4 roundings and
/// the product 3 more; parallel: `F = n·D` likewise. 8 leaves room for the bound's own.
#[inline(always)]
fn facing<F: Fault>(
    map: &CameraMap,
    judge: &Judge,
    corners: &[DVec3; 3],
    normal: DVec3,
    permanent: DVec3,
) -> Option<f64> {
    let against = match map.projection() {
        Projection::Perspective => corners[0],
        Projection::Parallel => -map.w,
    };
    let facing = normal.dot(against);
    let error = 8.0 * EPS53 * permanent.dot(against.abs()) + f64::MIN_POSITIVE;
    if facing.abs() > error && !F::is(Planted::InfiniteErrorBound) {
        return Some(facing.signum());
    }
    match judge.facing(corners, &map.grid.ray(0, 0)) {
        Sign::Negative => Some(-1.0),
        Sign::Zero => None,
        Sign::Positive => Some(1.0),
    }
}

/// The edge function from `p` to `q`, its sign that of the real one.
///
/// # The error, rounding by rounding
///
/// Perspective: `E = n·D`, `n = p × q`. A coordinate of `n` carries 2 roundings of its permanent
/// `N`, a product with `u`, `v` or `w` and two sums 3, `d` one; evaluation at a sample adds at most
/// 3. `D = (x·u + y·v) − d·w` is rounded by 3. That is at most 2 + 3 + 1 + 2 + 3 = 11 of `Σ
/// N·reach`.
///
/// Parallel: `E = D·(p × q) + O·m`, `m = (p − q) × D`. Corners are taken from the local origin in the first term,
/// which leaves `E` as it is; each brings two roundings then, and the term carries 4 + 2 + 3, and 2 for
/// two sums. A coordinate of `m` carries 3 of its permanent `M`, the product with `u` or `v` 3,
/// evaluation 3, and `O` is rounded by 2: at most 11 of `Σ M·reach`.
///
/// The bound takes 13, so that its own roundings (at most 10, each of one part in 2⁵³) do no harm, nor those
/// of second order.
#[inline(always)]
fn edge_function(map: &CameraMap, [p, q]: [DVec3; 2], along: DVec3) -> ViewportAffine {
    let (normal, permanent) = (p.cross(q), cross_permanent(p, q));
    let (at_center, slope, size) = match map.projection() {
        Projection::Perspective => {
            (-map.distance * normal.dot(map.w), normal, permanent.dot(map.reach))
        }
        Projection::Parallel => {
            let slope = -along.cross(map.w);
            let size = permanent.dot(map.w.abs()) + cross_permanent(along, map.w).dot(map.reach);
            (-normal.dot(map.w), slope, size)
        }
    };
    ViewportAffine {
        at_center,
        across: slope.dot(map.u),
        up: slope.dot(map.v),
        error: 13.0 * EPS53 * size + f64::MIN_POSITIVE,
    }
}
