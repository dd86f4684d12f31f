//! `float32`: the plane of the triangle gives `t`, and the hit point is held against its three edges, all in `f32`; edges
//! inclusive.
//!
//! The hit point is rounded before the test, so two triangles at one edge test different points.

use super::single::Ray;
use crate::real::{Vector, cross, dot, minus, plus, scaled};

pub(super) fn hit(ray: &Ray, [a, b, c]: [Vector<f32>; 3]) -> Option<f32> {
    let normal = cross(minus(b, a), minus(c, a));
    let along = dot(normal, ray.direction);
    if along == 0.0 {
        return None;
    }
    let t = dot(normal, minus(a, ray.origin)) / along;
    let point = plus(ray.origin, scaled(t, ray.direction));
    let is_within = |from, to| dot(normal, cross(minus(to, from), minus(point, from))) >= 0.0;
    (is_within(a, b) && is_within(b, c) && is_within(c, a)).then_some(t)
}
