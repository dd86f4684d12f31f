//! Depth as a function on the viewport, and as an interval that is certain to hold the true one.

use super::screen::Screen;
use bothways_common::Projection;
use glam::DVec3;

/// Half the distance from 1 to the next number.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Two numbers between which a depth key lies.
///
/// A key grows with `t`: it is `−1/t` for a perspective camera, where `1/t` is affine on the
/// viewport, and `t` itself for a parallel one.
#[derive(Clone, Copy, Debug)]
pub(super) struct DepthKey {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl DepthKey {
    /// Behind everything: the key of a sample at which nothing is seen so far.
    pub(super) const NOTHING: DepthKey = DepthKey { low: f64::INFINITY, high: f64::INFINITY };
    /// It could be anywhere: only the judge knows.
    pub(super) const UNKNOWN: DepthKey = DepthKey { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// The interval of an enclosure of `t`, of which `relative` bounds the relative error.
    pub(super) fn from_t(projection: Projection, t: f64, relative: f64) -> DepthKey {
        // Not certain, not finite or NaN: only the judge knows.
        if !(relative < 0.125 && t > 0.0) {
            return DepthKey::UNKNOWN;
        }
        // 1/(t·(1 ± ρ)) is within 1.15·ρ of 1/t for ρ < 1/8; one rounding more is the reciprocal's.
        let (key, relative) = match projection {
            Projection::Perspective => (-1.0 / t, 1.15 * relative + 2.0 * UNIT_ROUNDOFF),
            Projection::Parallel => (t, relative + UNIT_ROUNDOFF),
        };
        let error = key.abs() * relative * (1.0 + 8.0 * UNIT_ROUNDOFF);
        DepthKey { low: key - error, high: key + error }
    }

    /// The distance in the middle of the interval, if that is as good as a stored `t` needs.
    pub(super) fn t(self, projection: Projection) -> Option<f64> {
        const CLOSE: f64 = 1e-9;
        let key = 0.5 * (self.low + self.high);
        let certain = key.is_finite() && self.high - self.low <= CLOSE * key.abs();
        certain.then(|| match projection {
            Projection::Perspective => -1.0 / key,
            Projection::Parallel => key,
        })
    }
}

/// The depth key of a flat primitive: `at_centre + x·across + y·up` on the viewport, to within
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
    /// n·O)/F` with `F = n·D`; the same counts hold with `D` and `O` in each other's place.
    /// So the key is off by at most `(16u·Q + Q·δF/(|F| − δF))/|F|`; the constants below leave room
    /// for the roundings of the bound itself.
    pub(super) fn new(screen: &Screen, point: DVec3, normal: DVec3, permanent: DVec3) -> Self {
        let projection = screen.projection();
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
            (17.0 * UNIT_ROUNDOFF + 1.01 * f_error / room) * reach / room + f64::MIN_POSITIVE
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

    /// The part of the key that all samples of a row share.
    pub(super) fn on_row(&self, y: f64) -> f64 {
        self.at_centre + y * self.up
    }

    /// The key at a sample of that row.
    pub(super) fn key(&self, on_row: f64, x: f64) -> DepthKey {
        let key = on_row + x * self.across;
        let (low, high) = (key - self.error, key + self.error);
        // NaN (from a plane that is not trusted) must not look like an order.
        if low <= high { DepthKey { low, high } } else { DepthKey::UNKNOWN }
    }
}

/// The key's sign where something is in front of the eye: `−1/t` is negative there, `t` positive.
pub(super) fn sign_in_front(projection: Projection) -> f64 {
    match projection {
        Projection::Perspective => -1.0,
        Projection::Parallel => 1.0,
    }
}
