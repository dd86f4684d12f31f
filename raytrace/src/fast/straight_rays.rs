//! Rays whose coordinates `f64` holds without a rounding: those of a frame along the world's axes, through samples
//! with simple coordinates.

use bothways_common::engine::simd::{Simd, SimdBase, SimdFloat, f64x8, mask64x8};
use bothways_common::{Camera, Projection, Raster, SampleGrid};
use glam::DVec3;

/// Rays along the world's axes, or outward from such a ray by steps that `f64` holds: none of their numbers is rounded.
#[derive(Clone, Copy, Debug)]
pub(super) struct StraightRays {
    projection: Projection,
    distance: f64,
    /// Of `u`, `−v` and `−w`.
    right: Along,
    down: Along,
    forward: Along,
    /// A quarter of the way from a row to the next on the viewport, and from a column to the next.
    quarter: [f64; 2],
    /// The row and column of the viewport's middle, in quarters.
    middle: [f64; 2],
}

/// A coordinate of the world, along its axis or against it.
#[derive(Clone, Copy, Debug)]
struct Along {
    axis: usize,
    sign: f64,
}

impl Along {
    /// The coordinate along a unit vector; `None` if the vector has another component, however small.
    fn new(vector: DVec3) -> Option<Along> {
        let components = vector.to_array();
        let axis = components.iter().position(|component| *component != 0.0)?;
        let alone = components[axis + 1..].iter().all(|component| *component == 0.0);
        let sign = components[axis];
        (alone && (sign == 1.0 || sign == -1.0)).then_some(Along { axis, sign })
    }

    #[inline(always)]
    fn of<S: Simd>(self, point: &[f64x8<S>; 3]) -> f64x8<S> {
        point[self.axis] * self.sign
    }
}

impl StraightRays {
    /// The rays of a camera's samples, if they are straight.
    ///
    /// With a frame along the world's axes each coordinate of a ray's origin and direction is one of `x`, `y`, `d` and
    /// 1, with a sign, without a rounding. Every `x` and `y` is tested: they must be multiples of half
    /// the way `g` between neighbours, of which `g` has at most 10 bits and the other factor at most 17, so that the
    /// product with which each is compared is exact.
    pub(super) fn new(
        camera: &Camera,
        samples: &SampleGrid,
        raster: &Raster,
    ) -> Option<StraightRays> {
        let along = [camera.u(), -camera.v(), -camera.w()].map(Along::new);
        let [Some(right), Some(down), Some(forward)] = along else { return None };
        let [across, upward] = [step(samples.x())?, step(samples.y())?];
        Some(StraightRays {
            projection: camera.projection(),
            distance: camera.distance(),
            right,
            down,
            forward,
            quarter: [-0.25 * upward, 0.25 * across],
            middle: raster.middle().map(|middle| 4.0 * middle),
        })
    }

    /// The quarters of a row and column that are nearest to computed ones, and whether the ray through there meets
    /// a point in front of the eye, given by its offset from the eye.
    ///
    /// The ray passes `x = m·g/4` to the right of the middle, `m` an integer of at most 19 bits, and `x` has 29. A
    /// point at the depth `ζ` and the distance `r` to the right lies on it, as far as that goes, if `r = t·x` with `t
    /// = ζ/d`, that is `r·d = ζ·x`; of parallel rays if `r = x`. With `r` and `ζ` of 24 bits, which is looked at,
    /// and `d` of 24, both products are exact. Downward likewise.
    #[inline(always)]
    pub(super) fn meets<S: Simd>(
        &self,
        simd: S,
        [row, column]: [f64x8<S>; 2],
        offset: &[f64x8<S>; 3],
    ) -> ([f64x8<S>; 2], mask64x8<S>) {
        let quarters = [(row * 4.0).round_ties_even(), (column * 4.0).round_ties_even()];
        let ahead = self.forward.of(offset);
        let met = self.passes(simd, 0, quarters[0], [self.down.of(offset), ahead])
            & self.passes(simd, 1, quarters[1], [self.right.of(offset), ahead]);
        let met = match self.projection {
            Projection::Perspective => {
                met & is_short(simd, ahead) & ahead.simd_gt(f64x8::splat(simd, 0.0))
            }
            Projection::Parallel => met,
        };
        ([quarters[0] * 0.25, quarters[1] * 0.25], met)
    }

    /// Whether the rays through a quarter of a row (axis 0) or column (axis 1) pass a point along that axis, given by its
    /// offset from the eye along the axis and ahead.
    #[inline(always)]
    fn passes<S: Simd>(
        &self,
        simd: S,
        axis: usize,
        quarter: f64x8<S>,
        [beside, ahead]: [f64x8<S>; 2],
    ) -> mask64x8<S> {
        let passes = (quarter - self.middle[axis]) * self.quarter[axis];
        match self.projection {
            Projection::Perspective => {
                let same = (beside * self.distance).simd_eq(ahead * passes);
                same & is_short(simd, beside)
            }
            Projection::Parallel => beside.simd_eq(passes),
        }
    }
}

/// The step from each of some places to the next. `None` unless the step has at most 10 bits and each place is, without
/// rounding, half of it times an integer.
fn step(places: &[f64]) -> Option<f64> {
    let (count, first) = (f64::from(u32::try_from(places.len()).ok()?), *places.first()?);
    // The first lies (count − 1)/2 steps before the middle; one place alone tells no step.
    let step = if count > 1.0 { -2.0 * first / (count - 1.0) } else { return None };
    let has_few_bits = step.to_bits().trailing_zeros() >= f64::MANTISSA_DIGITS - 10;
    let from_middle = (0..).map(|place| 2.0 * f64::from(place) + 1.0 - count);
    let even = places.iter().zip(from_middle).all(|(place, halves)| *place == 0.5 * step * halves);
    (has_few_bits && even).then_some(step)
}

/// Which numbers `f32` holds, too.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the question is what survives it")]
fn is_short<S: Simd>(simd: S, value: f64x8<S>) -> mask64x8<S> {
    let back = value.to_array().map(|value| f64::from(value as f32));
    value.simd_eq(f64x8::load_array(simd, back))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_no_other_component() {
        assert!(
            Along::new(DVec3::NEG_Y).is_some_and(|along| (along.axis, along.sign) == (1, -1.0))
        );
        assert!(Along::new(DVec3::new(0.0, -0.0, 1.0)).is_some_and(|along| along.axis == 2));
        for exponent in -1074..=-20 {
            let little = f64::from(exponent).exp2();
            for tilted in [[1.0, little, 0.0], [little, 1.0, 0.0], [0.0, -little, -1.0]] {
                assert!(Along::new(DVec3::from_array(tilted)).is_none(), "{tilted:?}");
            }
        }
        assert!(Along::new(DVec3::new(1.0_f64.next_up(), 0.0, 0.0)).is_none());
        assert!(Along::new(DVec3::ZERO).is_none());
    }

    #[test]
    fn steps_are_those_of_places_that_are_not_rounded() {
        assert_eq!(step(&[-1.5, -0.5, 0.5, 1.5]), Some(1.0));
        assert_eq!(step(&[0.75, 0.0, -0.75]), Some(-0.75));
        assert_eq!(step(&[-1.0 / 3.0, 0.0, 1.0 / 3.0]), None);
        assert_eq!(step(&[-1.0, 0.1, 1.0]), None);
        assert_eq!(step(&[-1.0, 0.0_f64.next_up(), 1.0]), None);
    }
}
