//! `watertight`: the triangle is sheared so that the ray runs along an axis, and 2D edge functions decide, in `f32`; where
//! one is zero they are computed again in `f64`.
//!
//! Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", Journal of Computer Graphics Techniques, 2013; both
//! sides, edges inclusive.

use super::single::Ray;
use crate::real::{Vector, minus};

pub(super) fn hit(ray: &Ray, corners: [Vector<f32>; 3]) -> Option<f32> {
    let Shear { axes: [x, y, z], shear: [shear_x, shear_y, shear_z] } = Shear::new(ray.direction);
    let [a, b, c] = corners.map(|corner| minus(corner, ray.origin));
    let sheared = |p: Vector<f32>| [p[x] - shear_x * p[z], p[y] - shear_y * p[z]];
    let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(sheared);

    let mut u = cx * by - cy * bx;
    let mut v = ax * cy - ay * cx;
    let mut w = bx * ay - by * ax;
    if u == 0.0 || v == 0.0 || w == 0.0 {
        u = difference(cx, by, cy, bx);
        v = difference(ax, cy, ay, cx);
        w = difference(bx, ay, by, ax);
    }
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let determinant = u + v + w;
    if determinant == 0.0 {
        return None;
    }
    let [az, bz, cz] = [a, b, c].map(|p| shear_z * p[z]);
    Some((u * az + v * bz + w * cz) / determinant)
}

/// `p·q − r·s`, exact but for the last rounding to `f32`: the products of two `f32` are exact in `f64`.
#[expect(clippy::cast_possible_truncation, reason = "the rule is to round to f32")]
fn difference(p: f32, q: f32, r: f32, s: f32) -> f32 {
    (f64::from(p) * f64::from(q) - f64::from(r) * f64::from(s)) as f32
}

/// The axes, the one along which the ray goes farthest last, and the shear that makes the ray run along it.
struct Shear {
    axes: [usize; 3],
    shear: [f32; 3],
}

impl Shear {
    fn new(direction: Vector<f32>) -> Shear {
        let size = direction.map(f32::abs);
        let z = if size[0] > size[1] {
            if size[0] > size[2] { 0 } else { 2 }
        } else if size[1] > size[2] {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        // So that the triangle keeps its sense of turning.
        if direction[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let along = direction[z];
        Shear { axes: [x, y, z], shear: [direction[x] / along, direction[y] / along, 1.0 / along] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_through_an_edge_hit_both_sides_and_never_none() {
        let (a, b) = ([0.1, 0.2, 0.3], [1.7, -0.4, 0.9]);
        let (c, d) = ([0.3, 2.0, 0.1], [0.9, -2.0, 0.2]);
        for k in 0_u8..100 {
            let part = f32::from(k) / 99.0;
            let target: Vector<f32> = std::array::from_fn(|i| a[i] + part * (b[i] - a[i]));
            let origin = [0.5, 0.3, 7.0];
            let ray = Ray { origin, direction: minus(target, origin) };
            assert!(hit(&ray, [a, b, c]).is_some() || hit(&ray, [b, a, d]).is_some(), "{part}");
        }
        // In numbers that do not round, both.
        let ray = Ray { origin: [0.5, 0.0, 2.0], direction: [0.0, 0.0, -1.0] };
        let (a, b) = ([0.0; 3], [1.0, 0.0, 0.0]);
        assert_eq!(hit(&ray, [a, b, [0.0, 1.0, 0.0]]), Some(2.0));
        assert_eq!(hit(&ray, [a, b, [0.0, -1.0, 0.0]]), Some(2.0));
    }
}
