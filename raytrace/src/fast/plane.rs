//! One ray against one plane: that of a triangle, or an infinite one.

use super::answer::{Answer, Trust, distance_around};
use bothways_common::Ray;
use bothways_common::engine::roundoff::{EPS53, Interval};
use glam::DVec3;

/// The answer for an infinite plane.
#[inline(always)]
pub(super) fn answer(ray: &Ray, point: DVec3, normal: DVec3, trust: Trust) -> Answer {
    in_front(crossing(ray, point - ray.origin, normal, normal.abs(), trust))
}

/// Whether a crossing of the ray's line lies in front of the eye.
#[inline(always)]
pub(super) fn in_front(distance: Option<Interval>) -> Answer {
    match distance {
        Some(distance) if distance.low > 0.0 => Answer::Hit(distance),
        Some(distance) if distance.high < 0.0 => Answer::Miss,
        Some(distance) => Answer::Open(distance),
        None => Answer::Open(Interval::NOT_NEGATIVE),
    }
}

/// Where the line of a ray crosses a plane, `t = p/q` with `p = n·point`, `q = n·D`; `None` where `q` is not
/// certain.
///
/// A coordinate of `normal` carries at most 4 roundings of the same one of `permanent`, the point one,
/// the products 3: at most 8 for `p`, 7 for `q`. With `|p/q − P/Q| ≤ (δp + |p/q|·δq)/(|q| − δq)`, and
/// one rounding for the quotient.
#[inline(always)]
pub(super) fn crossing(
    ray: &Ray,
    point: DVec3,
    normal: DVec3,
    permanent: DVec3,
    trust: Trust,
) -> Option<Interval> {
    let (p, q) = (normal.dot(point), normal.dot(ray.direction));
    let p_error = trust.of(9.0 * EPS53 * permanent.dot(point.abs()) + f64::MIN_POSITIVE);
    let q_error = trust.of(8.0 * EPS53 * permanent.dot(ray.direction.abs()) + f64::MIN_POSITIVE);
    let room = q.abs() - q_error;
    if room > 0.0 {
        let t = p / q;
        let error = (p_error + t.abs() * q_error) / room + trust.of(2.0 * EPS53 * t.abs());
        Some(distance_around(t, error * (1.0 + 8.0 * EPS53)))
    } else {
        None
    }
}
