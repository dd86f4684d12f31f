//! Depth as a function on the viewport: as an interval that is certain to hold the true one, and as the
//! key that the z-buffer stores.

use super::screen::Screen;
use bothways_common::Projection;
use glam::DVec3;

/// Half the distance from 1 to the next number.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Two numbers between which a depth lies.
///
/// Depth grows with `t`: it is `−1/t` for a perspective camera, where `1/t` is affine on the
/// viewport, and `t` itself, from the waypoint on, for a parallel one.
#[derive(Clone, Copy, Debug)]
pub(super) struct DepthInterval {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl DepthInterval {
    /// It could be anywhere: only the judge knows.
    pub(super) const UNKNOWN: DepthInterval =
        DepthInterval { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// The interval of an enclosure of `t`, of which `relative` bounds the relative error.
    pub(super) fn from_t(projection: Projection, t: f64, relative: f64) -> DepthInterval {
        // Not certain, not finite or NaN: only the judge knows.
        if !(relative < 0.125 && t > 0.0) {
            return DepthInterval::UNKNOWN;
        }
        // 1/(t·(1 ± ρ)) is within 1.15·ρ of 1/t for ρ < 1/8; one rounding more is the reciprocal's.
        let (depth, relative) = match projection {
            Projection::Perspective => (-1.0 / t, 1.15 * relative + 2.0 * UNIT_ROUNDOFF),
            Projection::Parallel => (t, relative + UNIT_ROUNDOFF),
        };
        let error = depth.abs() * relative * (1.0 + 8.0 * UNIT_ROUNDOFF);
        DepthInterval { low: depth - error, high: depth + error }
    }
}

/// The depth of a flat primitive: `at_centre + x·across + y·up` on the viewport, to within
/// `error`.
#[derive(Clone, Copy, Debug)]
pub(super) struct DepthPlane {
    pub(super) at_centre: f64,
    pub(super) across: f64,
    pub(super) up: f64,
    /// Infinite where the plane is too close to the eye or to edge-on for its depth to be trusted.
    pub(super) error: f64,
}

impl DepthPlane {
    /// The depth of the plane through `point` with this normal, of which each coordinate carries at
    /// most four roundings of the same coordinate of `permanent`.
    ///
    /// # The error, rounding by rounding
    ///
    /// Perspective: `−1/t = −q/F` with `q = n·D`, `F = n·point`. A coordinate of `n` brings 4
    /// roundings, a product with `u`, `v` or `w` and two sums 3, `d` one more, `−1/F` and the product
    /// with it 2, evaluating at a sample at most 3, and `D` itself is rounded by 3: at most 16 of `Q =
    /// Σ permanent·reach`. `F` brings 4 + 3 of `Σ permanent·|point|`. Parallel: `t = (n·point −
    /// n·O)/F` with `F = n·D`; the same counts hold with `D` and `O` in each other's place, and the point is
    /// taken from the waypoint, which brings two more.
    /// So the depth is off by at most `(18u·Q + Q·δF/(|F| − δF))/|F|`; the constants below leave room
    /// for the roundings of the bound itself.
    pub(super) fn new(screen: &Screen, point: DVec3, normal: DVec3, permanent: DVec3) -> Self {
        let projection = screen.projection();
        let point = screen.waypoint.relative(point);
        let (height, mut reach) = (normal.dot(point), permanent.dot(screen.reach));
        let (f, f_permanent) = match projection {
            Projection::Perspective => (height, permanent.dot(point.abs())),
            Projection::Parallel => (-normal.dot(screen.w), permanent.dot(screen.w.abs())),
        };
        let by_f = -1.0 / f;
        let at_centre = match projection {
            Projection::Perspective => -screen.distance * normal.dot(screen.w),
            Projection::Parallel => {
                reach += permanent.dot(point.abs());
                -height
            }
        };
        let f_error = 7.5 * UNIT_ROUNDOFF * f_permanent + f64::MIN_POSITIVE;
        let room = f.abs() - f_error;
        let error = if room > f_error {
            (19.0 * UNIT_ROUNDOFF + 1.01 * f_error / room) * reach / room + f64::MIN_POSITIVE
        } else {
            f64::INFINITY
        };
        DepthPlane {
            at_centre: at_centre * by_f,
            across: normal.dot(screen.u) * by_f,
            up: normal.dot(screen.v) * by_f,
            error,
        }
    }

    /// The part of the depth that all samples of a row share.
    pub(super) fn on_row(&self, y: f64) -> f64 {
        self.at_centre + y * self.up
    }

    /// The depth at a sample of that row.
    pub(super) fn at(&self, on_row: f64, x: f64) -> DepthInterval {
        let depth = on_row + x * self.across;
        let (low, high) = (depth - self.error, depth + self.error);
        // NaN (from a plane that is not trusted) must not look like an order.
        if low <= high { DepthInterval { low, high } } else { DepthInterval::UNKNOWN }
    }
}

/// The sign of depth where something is in front of the eye: `−1/t` is negative there, `t` positive.
pub(super) fn sign_in_front(projection: Projection) -> f64 {
    match projection {
        Projection::Perspective => -1.0,
        Projection::Parallel => 1.0,
    }
}

/// What the z-buffer stores where nothing is seen.
pub(super) const NOTHING: f32 = 0.0;
/// How far a key may be from the true one, as a part of it.
pub(super) const KEY_ERROR: f32 = 1.0 / (1 << 18) as f32;
/// A key that is larger than another times this is certainly nearer: both may be off by
/// [`KEY_ERROR`], and the product by a rounding.
pub(super) const NEARER: f32 = 1.0 + 1.0 / (1 << 16) as f32;
/// Keys within this range and its reciprocal are far from overflow and underflow.
pub(super) const LARGEST_KEY: f64 = (1_u128 << 100) as f64;

/// How the z-buffer stores depth: as an `f32` key that is larger for what is nearer, positive, within
/// [`KEY_ERROR`] of the true one; or NaN, for "ask the judge".
///
/// A key is `1/t − offset` for a perspective camera, `offset − t` for a parallel one. The offset
/// brings the farthest point of the scene close to 0, where an `f32` resolves best: a distant eye
/// loses no depth. The `t` of a parallel camera counts from the waypoint.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyScale {
    pub(super) projection: Projection,
    pub(super) offset: f64,
    /// The `t` of a parallel camera whose key is 0, from the eye on; for a perspective camera the offset.
    pub(super) from_eye: f64,
}

impl KeyScale {
    /// The scale for a scene within a box, `bounds` its corners, as one camera sees it.
    ///
    /// `unbounded` says that the scene has planes. Whatever the scale is, keys are right; a scale that
    /// fits the scene leaves less to the judge.
    pub(super) fn new(screen: &Screen, bounds: &[DVec3; 8], unbounded: bool) -> Self {
        let (camera, waypoint) = (screen.camera, screen.waypoint);
        let relative = |corner: &DVec3| waypoint.relative(*corner - camera.eye().as_dvec3());
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
                let size = if waypoint.t > 0.0 {
                    bounds.iter().map(extent).fold(0.0, f64::max)
                } else {
                    high.abs()
                };
                // Planes may be farther than the rest; twice is a guess that costs one bit.
                let low = low.max(screen.depth_of_eye());
                let room = if unbounded { size } else { 0.5 * (high - low) };
                (high + room.max(GAP * size)).clamp(0.0, f64::from(f32::MAX))
            }
        };
        let offset = if offset.is_finite() { offset } else { 0.0 };
        KeyScale { projection: camera.projection(), offset, from_eye: offset + waypoint.t }
    }

    /// The key of a depth that is certain to within a quarter of [`KEY_ERROR`], or NaN.
    ///
    /// The middle of the interval, the difference to the offset and their bound bring fewer than 2³
    /// roundings of 2⁻⁵³; rounding to `f32` brings 2⁻²⁴ of the key.
    pub(super) fn key(&self, depth: DepthInterval) -> f32 {
        let middle = 0.5 * (depth.low + depth.high);
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

/// The least distance of the farthest key from 0, as a part of the farthest `1/t` or `t`, or of the scene's size
/// about the waypoint: the vertex stage knows those to within 2⁻⁴¹, hence keys to within 2⁻³¹.
const GAP: f64 = 1.0 / 1024.0;
