//! One ray against one primitive: what rounded arithmetic says for certain.

use super::ball;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::{Primitive, Ray, Sign};
use glam::DVec3;

/// Half the distance from 1 to the next number.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Two numbers between which a `t` lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Distance {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Distance {
    /// It could be anywhere in front of the eye: only the judge knows.
    pub(super) const UNKNOWN: Distance = Distance { low: 0.0, high: f64::INFINITY };

    /// `t`, known to within `error`.
    pub(super) fn around(t: f64, error: f64) -> Distance {
        let error = error * (1.0 + 8.0 * UNIT_ROUNDOFF);
        let (low, high) = (t - error, t + error);
        // NaN must not look like an order.
        if low <= high { Distance { low, high } } else { Distance::UNKNOWN }
    }

    /// The middle, if that is as good as a stored `t` needs.
    pub(super) fn t(self) -> Option<f64> {
        const CLOSE: f64 = 1e-7;
        let t = 0.5 * (self.low + self.high);
        (t.is_finite() && self.high - self.low <= CLOSE * t).then_some(t)
    }
}

/// What rounded arithmetic says of a ray and a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) enum Answer {
    /// A hit for certain, in this interval.
    Hit(Distance),
    /// A miss for certain.
    Miss,
    /// The judge must say whether; if a hit, then in this interval.
    Open(Distance),
}

/// The answer for a triangle, and the signs of its edge functions where they are certain.
///
/// `E_ab = b·(D × a)` and so on, with the corners taken from the ray's origin. A corner carries one
/// rounding (a parallel ray's origin), the cross product 2 more and that corner's again, the product 3
/// and the other corner's one: at most 8 of the permanent, of which each of the six terms is at most
/// `|D|·P²` with the largest coordinates of the direction and of the three corners. 50 instead of 48
/// leaves room for the roundings of the bound.
pub(super) fn triangle(
    ray: &Ray,
    corners: &[DVec3; 3],
    trust: Trust,
) -> (Answer, [Option<Sign>; 3]) {
    let d = ray.direction;
    let [a, b, c] = corners.map(|corner| corner - ray.origin);
    let edges = [d.cross(a).dot(b), d.cross(b).dot(c), d.cross(c).dot(a)];
    let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
    let size = d.abs().max_element() * largest * largest;
    let error = trust.of(50.0 * UNIT_ROUNDOFF * size + f64::MIN_POSITIVE);

    // `>` is false for NaN: then no sign is certain.
    let positive = edges.map(|edge| edge > error);
    let negative = edges.map(|edge| edge < -error);
    let signs = std::array::from_fn(|k| match (negative[k], positive[k]) {
        (true, _) => Some(Sign::Negative),
        (_, true) => Some(Sign::Positive),
        _ => None,
    });
    let any = |certain: [bool; 3]| certain[0] | certain[1] | certain[2];
    if any(positive) && any(negative) {
        return (Answer::Miss, signs);
    }
    let [along_b, along_c] = [corners[1] - corners[0], corners[2] - corners[0]];
    let normal = along_b.cross(along_c);
    let permanent = cross_permanent(along_b, along_c);
    let distance = flat_distance(ray, a, normal, permanent, trust);
    let all = |certain: [bool; 3]| certain[0] & certain[1] & certain[2];
    let answer = if all(positive) || all(negative) {
        // The ray's line passes inside; in front of the eye, or behind it?
        in_front(distance)
    } else {
        Answer::Open(distance.unwrap_or(Distance::UNKNOWN))
    };
    (answer, signs)
}

/// The answer for a plane.
#[inline(always)]
pub(super) fn plane(ray: &Ray, point: DVec3, normal: DVec3, trust: Trust) -> Answer {
    in_front(flat_distance(ray, point - ray.origin, normal, normal.abs(), trust))
}

/// Whether error bounds hold, or are (by a planted fault) zero or infinite.
#[derive(Clone, Copy, Debug)]
pub(super) enum Trust {
    Sound,
    Blind,
    None,
}

impl Trust {
    pub(super) fn new<F: Fault>() -> Trust {
        match () {
            () if F::is(Planted::ZeroErrorBound) => Trust::Blind,
            () if F::is(Planted::InfiniteErrorBound) => Trust::None,
            () => Trust::Sound,
        }
    }

    pub(super) fn is_sound(self) -> bool {
        matches!(self, Trust::Sound)
    }

    #[inline(always)]
    pub(super) fn of(self, error: f64) -> f64 {
        match self {
            Trust::Sound => error,
            Trust::Blind => 0.0,
            Trust::None => f64::INFINITY,
        }
    }
}

#[inline(always)]
fn in_front(distance: Option<Distance>) -> Answer {
    match distance {
        Some(distance) if distance.low > 0.0 => Answer::Hit(distance),
        Some(distance) if distance.high < 0.0 => Answer::Miss,
        Some(distance) => Answer::Open(distance),
        None => Answer::Open(Distance::UNKNOWN),
    }
}

/// Where a ray crosses a plane, `t = p/q` with `p = n·point`, `q = n·D`; `None` where `q` is not
/// certain.
///
/// A coordinate of `normal` carries at most 4 roundings of the same one of `permanent`, the point one,
/// the products 3: at most 8 for `p`, 7 for `q`. With `|p/q − P/Q| ≤ (δp + |p/q|·δq)/(|q| − δq)`, and
/// one rounding for the quotient.
#[inline(always)]
fn flat_distance(
    ray: &Ray,
    point: DVec3,
    normal: DVec3,
    permanent: DVec3,
    trust: Trust,
) -> Option<Distance> {
    let (p, q) = (normal.dot(point), normal.dot(ray.direction));
    let p_error = trust.of(9.0 * UNIT_ROUNDOFF * permanent.dot(point.abs()) + f64::MIN_POSITIVE);
    let q_error =
        trust.of(8.0 * UNIT_ROUNDOFF * permanent.dot(ray.direction.abs()) + f64::MIN_POSITIVE);
    let room = q.abs() - q_error;
    if room > 0.0 {
        let t = p / q;
        let error = (p_error + t.abs() * q_error) / room + trust.of(2.0 * UNIT_ROUNDOFF * t.abs());
        Some(Distance::around(t, error * (1.0 + 8.0 * UNIT_ROUNDOFF)))
    } else {
        None
    }
}

/// `|p| × |q|` with sums for differences: what bounds a cross product and its rounding.
fn cross_permanent(p: DVec3, q: DVec3) -> DVec3 {
    let (p, q) = (p.abs(), q.abs());
    DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x)
}

/// The answer for any primitive.
pub(super) fn primitive(
    ray: &Ray,
    primitive: &Primitive,
    trust: Trust,
) -> (Answer, [Option<Sign>; 3]) {
    match primitive {
        Primitive::Triangle(corners) => triangle(ray, corners, trust),
        Primitive::Sphere { center, radius } => {
            (ball::answer(ray, *center, *radius, trust), [None; 3])
        }
        Primitive::Plane { point, normal } => (plane(ray, *point, *normal, trust), [None; 3]),
    }
}
