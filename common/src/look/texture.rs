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

use crate::engine::simd::{Select, Simd, SimdBase, SimdFloat, f64x8};
use crate::look::lanes::{DVec3x8, each};
use crate::scene::material::Checker;
use crate::scene::shape::Shape;
use glam::{DVec2, DVec3, Vec2};
use std::f64::consts::{FRAC_1_PI, TAU};

/// The texture coordinates of eight samples, and how much of the texture each sample sees.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoints<S: Simd> {
    /// The coordinates of the surface points in the middle of the samples.
    pub coordinate: [f64x8<S>; 2],
    /// Width and height of the part of the texture from one sample to the next, to first order.
    pub footprint: [f64x8<S>; 2],
}

impl<S: Simd> TexturePoints<S> {
    /// Coordinates that change by so much from a sample to the next one across, and to the next one down.
    #[inline(always)]
    pub fn new(
        coordinate: [f64x8<S>; 2],
        across: [f64x8<S>; 2],
        down: [f64x8<S>; 2],
    ) -> TexturePoints<S> {
        let footprint = each!(k in [0, 1] => across[k].abs() + down[k].abs());
        TexturePoints { coordinate, footprint }
    }
}

impl Checker {
    /// The fraction of a sample's footprint that has the pattern's second colour, from 0 to 1, for each of eight.
    ///
    /// The pattern is averaged over the sample's footprint. So it turns grey towards the horizon
    /// where cells become smaller than samples, and it is a continuous function of the coordinate: two orders
    /// that round the same coordinate differently get nearly the same colour.
    ///
    /// Williams, "Pyramidal Parametrics", SIGGRAPH 1983, for why; the average of stripes is exact
    /// here, from their integral.
    #[inline(always)]
    pub fn fraction<S: Simd>(&self, simd: S, points: &TexturePoints<S>) -> f64x8<S> {
        let [across, up] = each!(k in [0, 1] => {
            let divisions = f64x8::splat(simd, self.divisions[k].into());
            stripes(simd, points.coordinate[k] * divisions, points.footprint[k] * divisions)
        });
        let half = f64x8::splat(simd, 0.5);
        let fraction = half - half * (across * up);
        let [zero, one] = each!(value in [0.0, 1.0] => f64x8::splat(simd, value));
        let fraction = fraction.simd_gt(zero).select(fraction, zero);
        fraction.simd_lt(one).select(fraction, one)
    }
}

/// The average, over an interval, of stripes that are 1 from 0 to 1, −1 from 1 to 2, and so on.
#[inline(always)]
fn stripes<S: Simd>(simd: S, middle: f64x8<S>, width: f64x8<S>) -> f64x8<S> {
    /// Below it the difference of integrals would be all rounding.
    const LEAST: f64 = 1e-9;
    let splat = |value: f64| f64x8::splat(simd, value);
    let (half, one, two) = (splat(0.5), splat(1.0), splat(2.0));
    // The integral rises and falls between 0 and 1 with a period of 2.
    let integral = |at: f64x8<S>| one - (at - two * (half * at).floor() - one).abs();
    // Near 0, so that adding half of the width loses nothing.
    let near = middle - two * (half * middle).floor();
    let wide = half * width.simd_gt(splat(LEAST)).select(width, splat(LEAST));
    let average = (integral(near + wide) - integral(near - wide)) / (two * wide);
    // At a pole, or beyond all numbers: every stripe is seen at once.
    (middle.is_finite() & width.is_finite()).select(average, splat(0.0))
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

/// [`on_sphere`] for eight points.
#[inline(always)]
pub fn on_sphere_lanes<S: Simd>(simd: S, offsets: DVec3x8<S>) -> ([f64x8<S>; 2], [DVec3x8<S>; 2]) {
    let all: [_; 8] = std::array::from_fn(|lane| on_sphere(offsets.lane(lane)));
    let coordinate = each!(k in [0, 1] => f64x8::from_fn(simd, |lane| all[lane].0[k]));
    let gradients = each!(k in [0, 1] => DVec3x8::from_fn(simd, |lane| all[lane].1[k]));
    (coordinate, gradients)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{best_level, dispatch};
    use glam::Vec3;

    fn fraction(divisions: [f32; 2], coordinate: [f64; 2], footprint: f64) -> f64 {
        let checker = Checker { color: Vec3::ZERO, divisions };
        dispatch!(best_level(), simd => {
            let splat = |value: f64| f64x8::splat(simd, value);
            let points = TexturePoints {
                coordinate: coordinate.map(splat),
                footprint: [splat(footprint); 2],
            };
            checker.fraction(simd, &points)[3]
        })
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
        assert!((0..10_000).any(|k| at(k) < 1e-9) && (0..10_000).any(|k| at(k) > 1.0 - 1e-9));
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
