//! One ray against one triangle.

use super::answer::{Answer, Trust};
use super::plane;
use bothways_common::engine::roundoff::{EPS53, Interval, cross_permanent};
use bothways_common::{Ray, Sign};
use glam::DVec3;

/// The answer for a triangle, and the signs of its edge functions where they are certain.
///
/// `E_ab = b·(D × a)` and so on, with the corners taken from the ray's origin. A corner carries one
/// rounding (a parallel ray's origin), the cross product 2 more and that corner's again, the product 3
/// and the other corner's one: at most 8 of the permanent, of which each of the six terms is at most
/// `|D|·P²` with the largest coordinates of the direction and of the three corners. 50 instead of 48
/// leaves room for the roundings of the bound.
pub(super) fn answer(ray: &Ray, corners: &[DVec3; 3], trust: Trust) -> (Answer, [Option<Sign>; 3]) {
    let d = ray.direction;
    let [a, b, c] = corners.map(|corner| corner - ray.origin);
    let edges = [d.cross(a).dot(b), d.cross(b).dot(c), d.cross(c).dot(a)];
    let largest = a.abs().max(b.abs()).max(c.abs()).max_element();
    let size = d.abs().max_element() * largest * largest;
    let error = trust.of(50.0 * EPS53 * size + f64::MIN_POSITIVE);

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
    let distance = crossing(ray, corners, trust);
    let all = |certain: [bool; 3]| certain[0] & certain[1] & certain[2];
    let answer = if all(positive) || all(negative) {
        // The line of the ray passes inside. Does it do so in front of the eye?
        plane::in_front(distance)
    } else {
        Answer::Open(distance.unwrap_or(Interval::NOT_NEGATIVE))
    };
    (answer, signs)
}

/// Where the line of a ray crosses the plane of a triangle; `None` where that is not certain.
#[inline(always)]
pub(super) fn crossing(ray: &Ray, corners: &[DVec3; 3], trust: Trust) -> Option<Interval> {
    let [a, b, c] = *corners;
    let (along_b, along_c) = (b - a, c - a);
    let normal = along_b.cross(along_c);
    plane::crossing(ray, a - ray.origin, normal, cross_permanent(along_b, along_c), trust)
}
