//! Texture coordinates: what they mean on each shape, and the pattern that is drawn over them.
//!
//! What a coordinate *is* stands here; how to find it at a sample is each order's own business.
//!
//! | shape | its texture coordinate |
//! |---|---|
//! | triangle | (0, 0), (1, 0) and (0, 1) at `a`, `b` and `c` |
//! | mesh | what its file or its generator gave to the corners; none where a corner has none |
//! | sphere | the turn around the y axis from +x towards −z, and the latitude; both from 0 to 1 |
//! | plane | lengths of the world from the plane's point, to the right and up: see [`plane_axes`] |

use crate::scene::material::Checker;
use crate::scene::shape::Shape;
use glam::{DVec2, DVec3, Vec2};
use std::f64::consts::{FRAC_1_PI, TAU};

/// The texture coordinate of one sample, and how much of the texture the sample sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexturePoint {
    /// The coordinate of the surface point in the middle of the sample.
    pub coordinate: DVec2,
    /// Width and height of the part of the texture from one sample to the next, to first order.
    pub footprint: DVec2,
}

impl TexturePoint {
    /// A coordinate that changes by so much from a sample to the next one across, and to the next one
    /// down.
    pub fn new(coordinate: DVec2, across: DVec2, down: DVec2) -> TexturePoint {
        TexturePoint { coordinate, footprint: across.abs() + down.abs() }
    }

    /// The coordinate as a frame keeps it.
    pub fn stored(&self) -> Vec2 {
        self.coordinate.as_vec2()
    }
}

impl Checker {
    /// The fraction of a sample's footprint that has the pattern's second colour, from 0 to 1.
    ///
    /// The pattern is averaged over the sample's footprint. So it turns grey towards the horizon
    /// where cells become smaller than samples, and it is a continuous function of the coordinate: two orders
    /// that round the same coordinate differently get nearly the same colour.
    ///
    /// Williams, "Pyramidal Parametrics", SIGGRAPH 1983, for why; the average of stripes is exact
    /// here, from their integral.
    ///
    /// ```
    /// use bothways_common::glam::{DVec2, Vec3};
    /// use bothways_common::Checker;
    /// use bothways_common::look::texture::TexturePoint;
    ///
    /// let checker = Checker { color: Vec3::X, divisions: [4.0, 4.0] };
    /// let fraction = |x, y| {
    ///     let small = DVec2::splat(0.001);
    ///     checker.fraction(&TexturePoint { coordinate: DVec2::new(x, y), footprint: small })
    /// };
    /// assert_eq!((fraction(0.1, 0.1), fraction(0.3, 0.1), fraction(0.3, 0.3)), (0.0, 1.0, 0.0));
    /// assert_eq!(fraction(0.25, 0.1), 0.5);
    /// ```
    pub fn fraction(&self, point: &TexturePoint) -> f32 {
        let divisions = Vec2::from(self.divisions).as_dvec2();
        let (middle, width) = (point.coordinate * divisions, point.footprint * divisions);
        let average = stripes(middle.x, width.x) * stripes(middle.y, width.y);
        #[expect(clippy::cast_possible_truncation, reason = "a fraction needs no more than f32")]
        let fraction = (0.5 - 0.5 * average) as f32;
        fraction.clamp(0.0, 1.0)
    }
}

/// The average, over an interval, of stripes that are 1 from 0 to 1, −1 from 1 to 2, and so on.
fn stripes(middle: f64, width: f64) -> f64 {
    /// Below it the difference of integrals would be all rounding.
    const LEAST: f64 = 1e-9;
    if !middle.is_finite() || !width.is_finite() {
        // At a pole, or beyond all numbers: every stripe is seen at once.
        return 0.0;
    }
    // The integral rises and falls between 0 and 1 with a period of 2.
    let integral = |at: f64| 1.0 - (at - 2.0 * (0.5 * at).floor() - 1.0).abs();
    // Near 0, so that adding half of the width loses nothing.
    let middle = middle - 2.0 * (0.5 * middle).floor();
    let half = 0.5 * width.max(LEAST);
    (integral(middle + half) - integral(middle - half)) / (2.0 * half)
}

/// The texture coordinates at the corners of a triangle of this shape, if all three have one. `local` counts the
/// primitives of the shape from 0.
pub fn corners(shape: &Shape, local: usize) -> Option<[DVec2; 3]> {
    match shape {
        Shape::Triangle(_) => Some([DVec2::ZERO, DVec2::X, DVec2::Y]),
        Shape::Mesh(mesh) => Some(mesh.texture_coordinates().of(local)?.map(Vec2::as_dvec2)),
        Shape::Sphere(_) | Shape::Plane(_) => None,
    }
}

/// The unit directions in which a plane's texture coordinates grow, for a normal of any length.
///
/// For a viewer at whom the normal points, the first direction goes right and the second up: along +y on walls,
/// along −z on floors and ceilings.
pub fn plane_axes(normal: DVec3) -> [DVec3; 2] {
    let slope = normal.abs();
    let up = if slope.y > slope.x.max(slope.z) { DVec3::NEG_Z } else { DVec3::Y };
    let normal = normal.normalize_or_zero();
    let right = up.cross(normal).normalize_or_zero();
    [right, normal.cross(right)]
}

/// The texture coordinate of the point of a sphere at an offset from its middle, and the directions
/// in which the two grow: their gradients, whose length is the growth per length.
///
/// At a pole there is no such direction, and the gradient of the first is not finite.
pub fn on_sphere(offset: DVec3) -> (DVec2, [DVec3; 2]) {
    let radius = offset.length();
    let from_axis = offset.x.hypot(offset.z);
    let turn = f64::atan2(-offset.z, offset.x) / TAU;
    let coordinate =
        DVec2::new(turn.rem_euclid(1.0), 0.5 + FRAC_1_PI * f64::atan2(offset.y, from_axis));
    let east = DVec3::new(offset.z, 0.0, -offset.x) / from_axis;
    let north = offset.cross(east) / radius;
    (coordinate, [east / (TAU * from_axis), north * (FRAC_1_PI / radius)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn fraction(divisions: [f32; 2], coordinate: [f64; 2], footprint: f64) -> f32 {
        let footprint = DVec2::splat(footprint);
        let point = TexturePoint { coordinate: coordinate.into(), footprint };
        Checker { color: Vec3::ZERO, divisions }.fraction(&point)
    }

    #[test]
    fn cells_alternate_in_both_directions_and_below_zero() {
        let fraction = |x, y| fraction([1.0; 2], [x, y], 0.125);
        let row = |y: f64| [-1.5, -0.5, 0.5, 1.5, 2.5].map(|x| fraction(x, y));
        assert_eq!(row(0.5), [0.0, 1.0, 0.0, 1.0, 0.0]);
        assert_eq!(row(-0.5), [1.0, 0.0, 1.0, 0.0, 1.0]);
    }

    #[test]
    fn the_pattern_has_no_jump() {
        let footprint = 0.01;
        let at = |k: i32| fraction([3.0, 5.0], [f64::from(k) * 1e-4, 0.1], footprint);
        // From one colour to the other takes a whole footprint: 100 steps.
        assert!((-20_000..20_000).all(|k| (at(k) - at(k + 1)).abs() < 0.011));
        assert!((0..10_000).any(|k| at(k) == 0.0) && (0..10_000).any(|k| at(k) == 1.0));
    }

    #[test]
    fn what_is_too_fine_or_nowhere_is_grey() {
        assert!((fraction([1.0; 2], [0.3, 0.4], 1000.0) - 0.5).abs() < 1e-3);
        for odd in [f64::NAN, f64::INFINITY] {
            assert_eq!(fraction([1.0; 2], [odd, 0.5], 0.1), 0.5);
            assert_eq!(fraction([1.0; 2], [0.5, 0.5], odd), 0.5);
        }
        assert_eq!(fraction([1.0; 2], [0.5, 0.5], 0.0), 0.0, "no footprint is a point");
    }

    #[test]
    fn planes_are_read_from_left_to_right_and_upwards() {
        assert_eq!(plane_axes(2.0 * DVec3::Z), [DVec3::X, DVec3::Y]);
        assert_eq!(plane_axes(DVec3::X), [DVec3::NEG_Z, DVec3::Y]);
        assert_eq!(plane_axes(DVec3::Y), [DVec3::X, DVec3::NEG_Z]);
        let normal = DVec3::new(1.0, -2.0, 0.5);
        let [right, up] = plane_axes(normal);
        assert!((right.cross(up) - normal.normalize()).length() < 1e-15);
    }

    #[test]
    fn a_sphere_is_a_globe() {
        assert_eq!(on_sphere(DVec3::X).0, DVec2::new(0.0, 0.5));
        assert_eq!(on_sphere(DVec3::NEG_Z).0, DVec2::new(0.25, 0.5));
        assert_eq!(on_sphere(3.0 * DVec3::Y).0.y, 1.0);
        // The gradients against a small step.
        let offset = DVec3::new(0.7, -0.4, 1.1);
        let (here, gradients) = on_sphere(offset);
        for step in [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| 1e-6 * axis) {
            let expected = on_sphere(offset + step).0 - here;
            let found = DVec2::new(gradients[0].dot(step), gradients[1].dot(step));
            assert!((found - expected).length() < 1e-11, "{found} {expected}");
        }
    }
}
