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

use crate::engine::simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, f32x16, f64x8};
use crate::look::lanes::{DVec3x8, each};
use crate::scene::material::Checker;
use crate::scene::shape::Shape;
use glam::{DVec2, DVec3, Vec2};
use std::f64::consts::{FRAC_1_PI, TAU};

/// The texture coordinates of sixteen samples, and how much of the texture each sample sees.
#[derive(Clone, Copy, Debug)]
pub struct TexturePoints<S: Simd> {
    /// The coordinates of the surface points in the middle of the samples: of the first eight, and of the next ones.
    pub halves: [[f64x8<S>; 2]; 2],
    /// Width and height of the part of the texture from one sample to the next, to first order.
    pub footprint: [f32x16<S>; 2],
}

/// The same for a pattern alone, by differences from one place of the texture that is near: `f32` is enough for them.
#[derive(Clone, Copy, Debug)]
pub struct TextureDifferences<S: Simd> {
    /// The place from which the coordinates are counted.
    pub from: [f64; 2],
    /// The coordinates, from there.
    pub differences: [f32x16<S>; 2],
    /// As in [`TexturePoints`].
    pub footprint: [f32x16<S>; 2],
}

impl Checker {
    /// The fraction of a sample's footprint that has the pattern's second colour, from 0 to 1, for each of sixteen.
    ///
    /// The pattern is averaged over the sample's footprint. So it turns grey towards the horizon
    /// where cells become smaller than samples, and it is a continuous function of the coordinate: two orders
    /// that round the same coordinate differently get nearly the same colour.
    ///
    /// Williams, "Pyramidal Parametrics", SIGGRAPH 1983, for why; the average of stripes is exact
    /// here, from their integral.
    #[inline(always)]
    pub fn fraction<S: Simd>(&self, simd: S, points: &TexturePoints<S>) -> f32x16<S> {
        let [low, high] = points.halves;
        let [across, up] = each!(k in [0, 1] => {
            let divisions = self.divisions[k];
            let wide = f64x8::splat(simd, divisions.into());
            let depth = each!(half in [low, high] => depth_in_stripe(simd, half[k] * wide));
            let width = points.footprint[k] * f32x16::splat(simd, divisions);
            stripes(simd, depth[0].narrow(depth[1]), width)
        });
        let half = f32x16::splat(simd, 0.5);
        half - half * (across * up)
    }

    /// The same from differences.
    ///
    /// Places are counted from the border of two stripes that is nearest to where the differences begin, so the rest in `f32` has all its
    /// digits, however close the border. Where it is large beside a footprint, and the sample meets a border all the same, the
    /// difference is as large. With `ε = 2⁻²⁴`, a difference `δ` with an error of `e·ε·δ` has one of less than `(e + 5)·ε·δ`
    /// here: `ε` for its product, `ε` for the rest, which is no larger than `δ` there, but for a footprint, and `2ε` for their sum, which is at most
    /// twice `δ`.
    #[inline(always)]
    pub fn fraction_by_differences<S: Simd>(
        &self,
        simd: S,
        points: &TextureDifferences<S>,
    ) -> f32x16<S> {
        let half = f32x16::splat(simd, 0.5);
        let mut sign = half;
        let [across, up] = each!(k in [0, 1] => {
            let divisions = self.divisions[k];
            let Border { rest, is_odd } = Border::near(points.from[k] * f64::from(divisions));
            // Beyond a border, all stripes are exchanged.
            sign = if is_odd { -sign } else { sign };
            let wide = f32x16::splat(simd, divisions);
            let place = points.differences[k] * wide + f32x16::splat(simd, rest);
            stripes(simd, depth_in_stripe(simd, place), points.footprint[k] * wide)
        });
        half - sign * (across * up)
    }
}

/// The border between two stripes that is nearest to a place: a whole number.
struct Border {
    /// How far the place is beyond it.
    rest: f32,
    is_odd: bool,
}

impl Border {
    #[inline(always)]
    fn near(place: f64) -> Border {
        let border = place.round_ties_even();
        #[expect(clippy::cast_possible_truncation, reason = "see `fraction_by_differences`")]
        let rest = (place - border) as f32;
        let half = 0.5 * border;
        Border { rest, is_odd: half != half.round_ties_even() }
    }
}

/// How deep in their stripe places are: the distance from the nearest border, at most ½, with the stripe's sign. Stripes
/// are 1 from 0 to 1, −1 from 1 to 2, and so on. Where a place is no number, so is the result.
///
/// What is computed here rounds only when the place itself has lost its last digits to its size, so in `f32` the result
/// has all its digits, however close the border.
#[inline(always)]
fn depth_in_stripe<S: Simd, V: SimdFloat<S>>(simd: S, place: V) -> V
where
    V::Element: From<f32>,
{
    let [half, one, two] =
        each!(value in [0.5, 1.0, 2.0] => V::splat(simd, V::Element::from(value)));
    // Between −1 and 1, in the stripe of its sign.
    let near = place - two * (half * place).round_ties_even();
    let size = near.abs();
    let rest = one - size;
    size.simd_lt(rest).select(size, rest).copysign(near)
}

/// The average of stripes over an interval, from the depth of its middle and its width: within 2⁻²¹.
///
/// - An interval that is no wider than a stripe meets one border, the nearest one, or none. The average is the depth in
///   halves of the interval, and no more than 1: one quotient of two numbers with one rounding each.
/// - A wider one is averaged from the stripes' integral, which rises and falls between 0 and 1. Its two ends are rounded
///   by at most `ε₂₄ · (½ + width)` in all, with `ε₂₄ = 2⁻²⁴`, and so is the integral, whose slope is 1; divided by a width
///   above 1, the two differences stay below `4ε₂₄`, and three more roundings of numbers up to 1 add `3ε₂₄`.
#[inline(always)]
fn stripes<S: Simd>(simd: S, depth: f32x16<S>, width: f32x16<S>) -> f32x16<S> {
    /// A point: narrower intervals are taken for it, so that no quotient is of zeros.
    const LEAST: f32 = 1e-9;
    let splat = |value: f32| f32x16::splat(simd, value);
    let (one, zero) = (splat(1.0), splat(0.0));
    let wide = splat(0.5) * width.simd_gt(splat(LEAST)).select(width, splat(LEAST));
    let average = depth / wide;
    let size = average.abs();
    let mut average = size.simd_lt(one).select(size, one).copysign(depth);
    let is_wider = width.simd_gt(one);
    if is_wider.any_true() {
        let [end, start] = each!(at in [depth + wide, depth - wide] => {
            (at - splat(2.0) * (splat(0.5) * at).round_ties_even()).abs()
        });
        let of_wider = (end - start) / width;
        average = is_wider.select(of_wider, average);
    }
    // At a pole, or beyond all numbers: every stripe is seen at once.
    (depth.is_finite() & width.is_finite()).select(average, zero)
}

/// The texture coordinates at the corners of a triangle of this shape, if all three have one. `local` counts the
/// primitives of the shape from 0.
pub fn corners(shape: &Shape, local: usize) -> Option<[DVec2; 3]> {
    match shape {
        Shape::Triangle(_) => Some([DVec2::ZERO, DVec2::X, DVec2::Y]),
        Shape::Mesh(mesh) => Some(mesh.texture_coordinates().of(local)?.map(Vec2::as_dvec2)),
        Shape::Instances(instances) => {
            let (_, triangle) = instances.locate(local);
            let coordinates = instances.mesh().texture_coordinates().of(triangle)?;
            Some(coordinates.map(Vec2::as_dvec2))
        }
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
    // libm gives the same result on every machine and in WebAssembly.
    let from_axis = libm::hypot(offset.x, offset.z);
    let turn = libm::atan2(-offset.z, offset.x) / TAU;
    let coordinate =
        DVec2::new(turn.rem_euclid(1.0), 0.5 + FRAC_1_PI * libm::atan2(offset.y, from_axis));
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
    use crate::engine::simd::{best_level, dispatch, levels};
    use glam::Vec3;

    fn fraction(divisions: [f32; 2], coordinate: [f64; 2], footprint: f32) -> f32 {
        let checker = Checker { color: Vec3::ZERO, divisions };
        dispatch!(best_level(), simd => {
            let coordinate = coordinate.map(|value| f64x8::splat(simd, value));
            let points = TexturePoints {
                halves: [coordinate; 2],
                footprint: [f32x16::splat(simd, footprint); 2],
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
        assert!((0..10_000).any(|k| at(k) <= 0.0) && (0..10_000).any(|k| at(k) >= 1.0));
    }

    #[test]
    fn averages_of_stripes_are_within_their_bound_at_every_level() {
        let integral = |at: f64| 1.0 - (at - 2.0 * (0.5 * at).floor() - 1.0).abs();
        let mut worst = 0.0_f64;
        for step in 0..4000_u32 {
            let middle = f64::from(step) * 0.618_034 - 1200.0;
            for width in [1e-4_f32, 0.02, 0.3, 0.999, 1.0, 1.001, 1.7, 2.0, 3.3, 50.0, 1e4] {
                let found = levels().into_iter().map(|level| {
                    dispatch!(level, simd => {
                        let depth = depth_in_stripe(simd, f64x8::splat(simd, middle));
                        stripes(simd, depth.narrow(depth), f32x16::splat(simd, width))[5]
                    })
                });
                let found: Vec<f32> = found.collect();
                assert!(found.iter().all(|one| one.to_bits() == found[0].to_bits()));
                let half = 0.5 * f64::from(width);
                let expected = (integral(middle + half) - integral(middle - half)) / (2.0 * half);
                worst = worst.max((f64::from(found[0]) - expected).abs());
            }
        }
        println!("largest error: 2^{:.2}", worst.log2());
        assert!(worst < f64::from(2f32.powi(-21)), "{worst}");
    }

    /// Differences of up to a hundred footprints, from anywhere in a stripe, close to its border and far from the origin.
    #[test]
    fn fractions_by_differences_are_those_of_the_places() {
        let mut worst = 0.0_f64;
        for step in 0..4000_u16 {
            let number = |factor: f32| (f32::from(step) * factor).fract();
            let width = 10f32.powf(7.0 * number(0.618_034) - 5.0);
            let border = (1000.0 * number(0.754_878)).floor() - 500.0;
            let beside = [1e-6, 1e-3, 0.3][usize::from(step) % 3] * (number(0.569_84) - 0.5);
            let from = [f64::from(border) + f64::from(beside), f64::from(7.0 * number(0.414_214))];
            let along = [95.0, -40.0].map(|most| most * width * number(0.236_068));
            let divisions = [1.0, 2.5];
            let found = levels().into_iter().map(|level| {
                dispatch!(level, simd => {
                    let splat = |number: f32| f32x16::splat(simd, number);
                    let checker = Checker { color: Vec3::ZERO, divisions };
                    let (differences, footprint) = (along.map(splat), [splat(width); 2]);
                    let points = TextureDifferences { from, differences, footprint };
                    checker.fraction_by_differences(simd, &points)[7]
                })
            });
            let found: Vec<f32> = found.collect();
            assert!(found.iter().all(|one| one.to_bits() == found[0].to_bits()));
            let place = [0, 1].map(|k| from[k] + f64::from(along[k]));
            let expected = fraction(divisions, place, width);
            worst = worst.max(f64::from((found[0] - expected).abs()));
        }
        println!("largest error: {worst:e}");
        // 5 · 2⁻²⁴ of 95 footprints, over half of one; for two directions, of which each counts half.
        assert!(worst < 6e-5, "{worst:e}");
    }

    #[test]
    fn what_is_too_fine_or_nowhere_is_grey() {
        assert!((fraction([1.0; 2], [0.3, 0.4], 1000.0) - 0.5).abs() < 1e-3);
        for odd in [f32::NAN, f32::INFINITY] {
            assert_eq!(fraction([1.0; 2], [odd.into(), 0.5], 0.1), 0.5);
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
