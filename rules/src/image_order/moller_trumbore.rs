//! `moller-trumbore`: barycentric coordinates and `t` at once, by Cramer's rule, in `f32`.
//!
//! Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools, 1997; both sides,
//! edges inclusive, with the epsilon that is found in most copies of it. It is an absolute number, so small triangles
//! vanish.

use super::single::Ray;
use crate::real::{Vector, cross, dot, minus};

const EPSILON: f32 = 1e-7;

pub(super) fn hit(ray: &Ray, [a, b, c]: [Vector<f32>; 3]) -> Option<f32> {
    let (to_b, to_c) = (minus(b, a), minus(c, a));
    let p = cross(ray.direction, to_c);
    let determinant = dot(to_b, p);
    if determinant.abs() < EPSILON {
        return None;
    }
    let inverse = 1.0 / determinant;
    let from_a = minus(ray.origin, a);
    let u = dot(from_a, p) * inverse;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let q = cross(from_a, to_b);
    let v = dot(ray.direction, q) * inverse;
    if v < 0.0 || u + v > 1.0 {
        return None;
    }
    let t = dot(to_c, q) * inverse;
    (t > EPSILON).then_some(t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_triangle_vanishes() {
        let ray = Ray { origin: [0.1, 0.1, 3.0], direction: [0.0, 0.0, -1.0] };
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(hit(&ray, triangle), Some(3.0));
        let [a, b, c] = triangle;
        assert_eq!(hit(&ray, [a, c, b]), Some(3.0), "from both sides");
        let tiny = |factor: f32| {
            let ray = Ray { origin: ray.origin.map(|x| factor * x), ..ray };
            hit(&ray, triangle.map(|corner| corner.map(|x| factor * x)))
        };
        assert!(tiny(1e-3).is_some());
        assert_eq!(tiny(1e-4), None);
    }
}
