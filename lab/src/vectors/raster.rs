//! The triangles of a scene in raster coordinates, where exact raster coordinates exist.

use crate::common::glam::DVec3;
use crate::common::scene::Primitive;
use crate::common::{Projection, View};

/// The three corners of each triangle in scene order, each `[x, y, t]`: `x` right and `y` down in
/// pixels, the middle of the first pixel at `[0.5, 0.5]`, and `t` along the viewing ray.
///
/// Between the corners, `1/t` is linear in `x` and `y` for a perspective camera, `t` for a parallel
/// one.
///
/// They exist if the camera looks straight down the negative z axis, all triangles are wholly in front of the eye,
/// and every quotient and sum fits into an `f64`. Otherwise the answer is `None`: a scene with rounded coordinates is
/// a different scene.
pub fn triangles(view: &View) -> Option<Vec<[[f64; 3]; 3]>> {
    let camera = view.camera;
    if [camera.u(), camera.v(), camera.w()] != [DVec3::X, DVec3::Y, DVec3::Z] {
        return None;
    }
    view.primitives()
        .map(|(_, primitive)| match primitive {
            Primitive::Triangle([a, b, c]) => {
                Some([corner(view, a)?, corner(view, b)?, corner(view, c)?])
            }
            Primitive::Sphere { .. } | Primitive::Plane { .. } => None,
        })
        .collect()
}

fn corner(view: &View, offset: DVec3) -> Option<[f64; 3]> {
    let depth = -offset.z;
    if depth <= 0.0 {
        return None;
    }
    let camera = view.camera;
    let ([x, y], t) = match camera.projection() {
        Projection::Perspective => {
            let t = quotient(depth, camera.distance())?;
            ([quotient(offset.x, t)?, quotient(offset.y, t)?], t)
        }
        Projection::Parallel => ([offset.x, offset.y], depth),
    };
    let [vw, vh] = camera.viewport();
    let [width, height] = camera.image().map(f64::from);
    let across = quotient(product(x, width)?, vw)?;
    let down = quotient(product(-y, height)?, vh)?;
    Some([sum(width / 2.0, across)?, sum(height / 2.0, down)?, t])
}

// A fused multiplication and addition rounds once, so its result is zero exactly if the remainder
// is: offsets are multiples of 2⁻¹⁴⁹ below 2¹³⁰, and nothing made from them here underflows.

fn product(a: f64, b: f64) -> Option<f64> {
    let product = a * b;
    (a.mul_add(b, -product) == 0.0).then_some(product)
}

fn quotient(a: f64, b: f64) -> Option<f64> {
    let quotient = a / b;
    (quotient.mul_add(b, -a) == 0.0).then_some(quotient)
}

/// Knuth's two-sum: the rounding errors of the sum.
fn sum(a: f64, b: f64) -> Option<f64> {
    let sum = a + b;
    let b_kept = sum - a;
    let lost = (a - (sum - b_kept)) + (b - b_kept);
    (lost == 0.0).then_some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_would_be_rounded_is_no_answer() {
        assert_eq!((quotient(3.0, 4.0), quotient(1.0, 3.0)), (Some(0.75), None));
        assert_eq!((product(3.0, 0.1), product(0.25, 0.1)), (None, Some(0.025)));
        assert_eq!((sum(8.0, 0.5), sum(1.0, 1e-20)), (Some(8.5), None));
    }
}
