//! Spheres and planes, which both orders solve for one ray, in the arithmetic of a rule.

use crate::real::{Real, Vector, dot, minus};

/// The two `t` at which a ray meets a sphere, the smaller first: the roots of the quadratic equation, by the formula of
/// textbooks. `None` if its discriminant is not positive.
pub(crate) fn sphere<R: Real>(
    origin: Vector<R>,
    direction: Vector<R>,
    center: Vector<R>,
    radius: R,
) -> Option<[R; 2]> {
    let from_center = minus(origin, center);
    let a = dot(direction, direction);
    let half_b = dot(direction, from_center);
    let c = dot(from_center, from_center) - radius * radius;
    let discriminant = half_b * half_b - a * c;
    if discriminant > R::ZERO {
        let root = discriminant.sqrt();
        Some([(-half_b - root) / a, (-half_b + root) / a])
    } else {
        None
    }
}

/// The `t` at which a ray meets a plane; not finite, or none, where it runs along it.
pub(crate) fn plane<R: Real>(
    origin: Vector<R>,
    direction: Vector<R>,
    point: Vector<R>,
    normal: Vector<R>,
) -> Option<R> {
    let along = dot(normal, direction);
    (along != R::ZERO).then(|| dot(normal, minus(point, origin)) / along)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_a_sphere_twice_and_a_plane_once() {
        let (origin, direction) = ([0.0_f32; 3], [0.0, 0.0, -2.0]);
        assert_eq!(sphere(origin, direction, [0.0, 0.0, -4.0], 1.0), Some([1.5, 2.5]));
        assert_eq!(sphere(origin, direction, [0.0, 1.0, -4.0], 1.0), None, "tangent is a miss");
        assert_eq!(plane(origin, direction, [5.0, 0.0, -3.0], [0.0, 0.0, 7.0]), Some(1.5));
        assert_eq!(plane(origin, direction, [5.0, 0.0, -3.0], [0.0, 1.0, 0.0]), None);
    }
}
