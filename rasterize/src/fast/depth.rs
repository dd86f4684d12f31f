//! Depth as a function on the viewport: as an interval that is certain to hold the true one, and as the
//! key that the z-buffer stores.

use super::camera_map::CameraMap;
use super::viewport_affine::ViewportAffine;
use bothways_common::Projection;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::roundoff::{EPS53, Interval};
use bothways_common::engine::simd::{Simd, SimdBase, f32x16, mask32x16};
use glam::DVec3;

/// The depth of a hit at `t`, of which `relative` bounds the relative error.
///
/// Depth grows with `t`: it is `−1/t` for a perspective camera, where `1/t` is affine on the
/// viewport, and `t` itself, from the local origin on, for a parallel one.
pub(super) fn depth_from_t(projection: Projection, t: f64, relative: f64) -> Interval {
    // Not certain, not finite or NaN: only the judge can decide.
    if !(relative < 0.125 && t > 0.0) {
        return Interval::ALL;
    }
    // 1/(t·(1 ± ρ)) is within 1.15·ρ of 1/t for ρ < 1/8; one rounding more is the reciprocal's.
    let (depth, relative) = match projection {
        Projection::Perspective => (-1.0 / t, 1.15 * relative + 2.0 * EPS53),
        Projection::Parallel => (t, relative + EPS53),
    };
    let error = depth.abs() * relative * (1.0 + 8.0 * EPS53);
    Interval { low: depth - error, high: depth + error }
}

/// The depth of the plane through `point` with this normal, of which each coordinate carries at
/// most four roundings of the same coordinate of `permanent`. The error is infinite where the plane is too close to
/// the eye or to edge-on for its depth to be trusted.
///
/// # The error, rounding by rounding
///
/// Perspective: `−1/t = −q/F` with `q = n·D`, `F = n·point`. A coordinate of `n` brings 4
/// roundings, a product with `u`, `v` or `w` and two sums 3, `d` one more, `−1/F` and the product
/// with it 2, evaluating at a sample at most 3, and `D` itself is rounded by 3: at most 16 of `Q =
/// Σ permanent·reach`. `F` brings 4 + 3 of `Σ permanent·|point|`. Parallel: `t = (n·point −
/// n·O)/F` with `F = n·D`; the same counts hold with `D` and `O` in each other's place, and the point is
/// taken from the local origin, which brings two more.
/// So the depth is off by at most `(18ε₅₃·Q + Q·δF/(|F| − δF))/|F|`; the constants below leave room
/// for the roundings of the bound itself.
#[inline(always)]
pub(super) fn depth_plane(
    map: &CameraMap,
    point: DVec3,
    normal: DVec3,
    permanent: DVec3,
) -> ViewportAffine {
    let projection = map.projection();
    let point = map.local.relative(point);
    let (height, mut reach) = (normal.dot(point), permanent.dot(map.reach));
    let (f, f_permanent) = match projection {
        Projection::Perspective => (height, permanent.dot(point.abs())),
        Projection::Parallel => (-normal.dot(map.w), permanent.dot(map.w.abs())),
    };
    let by_f = -1.0 / f;
    let at_center = match projection {
        Projection::Perspective => -map.distance * normal.dot(map.w),
        Projection::Parallel => {
            reach += permanent.dot(point.abs());
            -height
        }
    };
    let f_error = 7.5 * EPS53 * f_permanent + f64::MIN_POSITIVE;
    let room = f.abs() - f_error;
    let error = if room > f_error {
        (19.0 * EPS53 + 1.01 * f_error / room) * reach / room + f64::MIN_POSITIVE
    } else {
        f64::INFINITY
    };
    ViewportAffine {
        at_center: at_center * by_f,
        across: normal.dot(map.u) * by_f,
        up: normal.dot(map.v) * by_f,
        error,
    }
}

/// The sign of depth where something is in front of the eye: `−1/t` is negative there, `t` positive.
pub(super) fn sign_in_front(projection: Projection) -> f64 {
    match projection {
        Projection::Perspective => -1.0,
        Projection::Parallel => 1.0,
    }
}

/// The key that the z-buffer stores where nothing is seen.
pub(super) const NOTHING: f32 = 0.0;
/// How far a key may be from the true one, as a fraction of it.
pub(super) const KEY_ERROR: f32 = 1.0 / (1 << 18) as f32;
/// A key that is larger than another times this is certainly nearer: both may be off by
/// [`KEY_ERROR`], and the product by a rounding.
pub(super) const NEARER: f32 = 1.0 + 1.0 / (1 << 16) as f32;
/// The least distance of the farthest key from 0, as a fraction of the farthest `1/t` or `t`, or of the scene's size
/// about the local origin: the vertex stage knows those to within 2⁻⁴¹, hence keys to within 2⁻³¹.
const GAP: f64 = 1.0 / 1024.0;
/// Keys within this range and its reciprocal are far from overflow and underflow.
pub(super) const LARGEST_KEY: f64 = (1_u128 << 100) as f64;

/// How the z-buffer stores depth: as an `f32` key that is larger for what is nearer, positive, within
/// [`KEY_ERROR`] of the true one; or NaN, for "ask the judge".
///
/// A key is `1/t − offset` for a perspective camera, `offset − t` for a parallel one. The offset
/// brings the farthest point of the scene close to 0, where an `f32` resolves best: a distant eye
/// loses no depth. The `t` of a parallel camera counts from the local origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyScale {
    pub(super) projection: Projection,
    pub(super) offset: f64,
    /// For a parallel camera, the `t` from the eye whose key is 0; for a perspective camera, the offset.
    pub(super) from_eye: f64,
}

impl KeyScale {
    /// The scale for a scene within a box, `bounds` its corners, as one camera sees it.
    ///
    /// `unbounded` says that the scene has planes. Whatever the scale is, keys are right; a scale that
    /// fits the scene leaves less to the judge.
    pub(super) fn new(map: &CameraMap, bounds: &[DVec3; 8], unbounded: bool) -> Self {
        let (camera, local) = (map.camera, map.local);
        let relative = |corner: &DVec3| local.relative(*corner - camera.eye().as_dvec3());
        let depth = |corner: &DVec3| -relative(corner).dot(camera.w());
        let low = bounds.iter().map(depth).fold(f64::INFINITY, f64::min);
        let high = bounds.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        let offset = match camera.projection() {
            // From an eye within the box, 1/t has no bound above. Otherwise the nearest key is about
            // twice the farthest, so that one bound relative to a key suits a whole triangle.
            Projection::Perspective if unbounded || low <= 0.0 || !high.is_finite() => 0.0,
            Projection::Perspective => {
                let (far, near) = (camera.distance() / high, camera.distance() / low);
                (far - (near - far).max(GAP * far)).max(0.0)
            }
            Projection::Parallel => {
                let extent = |corner: &DVec3| relative(corner).abs().element_sum();
                let size = if local.t > 0.0 {
                    bounds.iter().map(extent).fold(0.0, f64::max)
                } else {
                    high.abs()
                };
                // Planes may be farther than the rest; twice is a guess that costs one bit.
                let low = low.max(map.depth_of_eye());
                let room = if unbounded { size } else { 0.5 * (high - low) };
                (high + room.max(GAP * size)).clamp(0.0, f64::from(f32::MAX))
            }
        };
        let offset = if offset.is_finite() { offset } else { 0.0 };
        KeyScale { projection: camera.projection(), offset, from_eye: offset + local.t }
    }

    /// The key of a depth that is certain to within a quarter of [`KEY_ERROR`], or NaN.
    ///
    /// The middle of the interval, the difference to the offset and their bound bring fewer than 2³
    /// roundings of 2⁻⁵³; rounding to `f32` brings 2⁻²⁴ of the key.
    pub(super) fn key(&self, depth: Interval) -> f32 {
        let middle = depth.middle();
        let key = match self.projection {
            Projection::Perspective => -middle - self.offset,
            Projection::Parallel => self.offset - middle,
        };
        let error = 0.5 * (depth.high - depth.low) + (-50f64).exp2() * (middle.abs() + self.offset);
        let in_range = (1.0 / LARGEST_KEY..=LARGEST_KEY).contains(&key);
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is what is asked")]
        let rounded = key as f32;
        if in_range && error <= 0.25 * f64::from(KEY_ERROR) * key { rounded } else { f32::NAN }
    }
}

/// How a fragment's key relates to the stored one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rank {
    Nearer,
    Farther,
    Unknown,
}

/// Compares a key with the stored one, as far as the errors of both leave no doubt. NaN leaves doubt.
#[inline(always)]
pub(super) fn rank<F: Fault>(key: f32, stored: f32) -> Rank {
    let nearer = nearer_by::<F>();
    if key > stored * nearer {
        Rank::Nearer
    } else if stored > key * nearer {
        Rank::Farther
    } else {
        Rank::Unknown
    }
}

/// The key of what is certainly nearer is larger by more than this factor.
pub(super) fn nearer_by<F: Fault>() -> f32 {
    if F::is(Planted::ZeroErrorBound) {
        1.0
    } else if F::is(Planted::InfiniteErrorBound) {
        f32::INFINITY
    } else {
        NEARER
    }
}

/// Distances from keys, and the lanes in which they are not within 8·10⁻⁶ of the true ones.
///
/// Perspective: `1/(key + offset)` is at most `KEY_ERROR` of it off, and three roundings of 2⁻²⁴.
/// Parallel: `offset − key`, from the eye on, is off by `KEY_ERROR` of the key, less than twice the distance if
/// that is at least a third of the offset.
#[inline(always)]
pub(super) fn distances<S: Simd>(
    simd: S,
    scale: &KeyScale,
    keys: f32x16<S>,
) -> (f32x16<S>, mask32x16<S>) {
    #[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
    let offset = f32x16::splat(simd, scale.from_eye as f32);
    match scale.projection {
        Projection::Perspective => {
            (f32x16::splat(simd, 1.0) / (keys + offset), !keys.simd_eq(keys))
        }
        Projection::Parallel => {
            let distances = offset - keys;
            (distances, !distances.simd_gt(offset * (1.0 / 3.0)))
        }
    }
}
