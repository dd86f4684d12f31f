//! Vertices whose places on the raster are known exactly: they lie at samples, or at quarters of the way from one to
//! the next.
//!
//! Edge functions between such places are small multiples of a sixteenth: `f32` computes them without rounding, so that
//! an edge through a sample costs no more than any other.

use super::camera_map::CameraMap;
use bothways_common::Projection;
use bothways_common::engine::simd::{Simd, SimdBase, SimdFloat, f64x8, mask64x8};
use glam::DVec3;

/// What decides a sample on an edge between such places: half of the least edge function other than 0. It is added
/// to edges that own their samples, and subtracted from others.
///
/// The contract moves the sample a little to the right, which adds a little of the edge function's slope across,
/// and far less down, which adds far less of its slope down: an edge owns its samples if its slope across is
/// positive, or is zero and its slope down positive.
pub(super) const TIE: f32 = 1.0 / 32.0;

/// Tells which vertices are aligned, on a raster on which nothing is rounded from a vertex to its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct AlignmentTest {
    projection: Projection,
    distance: f64,
    /// From one row to the next on the viewport, and from one column to the next.
    spacing: [f64; 2],
    /// The row and column of the viewport's middle.
    middle: [f64; 2],
}

impl AlignmentTest {
    /// The test for a camera's raster, if nothing is rounded on it.
    ///
    /// The frame must run along the world's axes, to the last bit: then an offset along `u`, `v` or `w` is a
    /// coordinate, its sign changed or not, and a ray's direction and origin are those of the viewport. (A sum of
    /// components does not answer the question: a component far below the last bit of 1 vanishes in it.) And if
    /// `vw/W` has at most 10 bits, a sample's coordinate, half of it times an integer of 17 bits, is stored without
    /// rounding.
    pub(super) fn new(map: &CameraMap) -> Option<AlignmentTest> {
        let axes = [map.u, map.v, map.w];
        if !axes.into_iter().all(is_axis) {
            return None;
        }
        let [rows, columns] = map.raster.size().map(f64::from);
        let [vw, vh] = map.camera.viewport();
        Some(AlignmentTest {
            projection: map.projection(),
            distance: map.distance,
            spacing: [short_quotient(vh, rows)?, short_quotient(vw, columns)?],
            middle: map.middle,
        })
    }

    /// Which vertices lie exactly at a multiple of a quarter of a row (axis 0) or column (axis 1): the one next
    /// to `place`, their computed row or column. `along` is their offset from the eye along `−v` or `u`, and
    /// `depth` along `−w`.
    ///
    /// With `r` along `u` (or `−v`) and `g` the distance of neighbours, the true column is `middle +
    /// r·d/(ζ·g)` (parallel: without `d/ζ`). Let `n/4` be the quarter nearest to the computed one: it is the
    /// true one if `m·g·ζ = 4·r·d` with the integer `m = n − 4·middle`. Both products are exact in `f64`: `m`
    /// has at most 19 bits where `place` is within 1.49·2¹⁶, `g` 10, `d` 24, and `r` and `ζ` are checked to
    /// have 24 (for parallel rays nothing is multiplied but by a power of two). The computed place is then off by its
    /// own four roundings of at most 2¹⁸, less than 2⁻³³, so that fixed point, whose units are at least 2⁻²², holds the
    /// quarter itself.
    #[inline(always)]
    pub(super) fn is_aligned<S: Simd>(
        &self,
        simd: S,
        axis: usize,
        [place, along, depth]: [f64x8<S>; 3],
    ) -> mask64x8<S> {
        let splat = |value: f64| f64x8::splat(simd, value);
        let (middle, spacing) = (self.middle[axis], self.spacing[axis]);
        let from_middle = (place * splat(4.0)).round_ties_even() - splat(4.0 * middle);
        let grid_point = from_middle * splat(spacing);
        match self.projection {
            Projection::Perspective => {
                let same = (grid_point * depth).simd_eq(along * splat(4.0 * self.distance));
                same & is_short(simd, along) & is_short(simd, depth)
            }
            Projection::Parallel => grid_point.simd_eq(along * splat(4.0)),
        }
    }
}

/// Whether a vector is one of the world's axes or its opposite: one component of ±1, all others zero.
fn is_axis(vector: DVec3) -> bool {
    [DVec3::X, DVec3::Y, DVec3::Z].contains(&vector.abs())
}

/// `side/count` if it has at most 10 bits, and nothing is lost.
fn short_quotient(side: f64, count: f64) -> Option<f64> {
    let quotient = side / count;
    let has_few_bits = quotient.to_bits().trailing_zeros() >= f64::MANTISSA_DIGITS - 10;
    (has_few_bits && quotient * count == side).then_some(quotient)
}

/// Which numbers `f32` holds without rounding.
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
        assert!(is_axis(DVec3::NEG_Z) && is_axis(DVec3::new(-0.0, 1.0, 0.0)));
        for exponent in -1074..=-20 {
            let little = f64::from(exponent).exp2();
            assert!(!is_axis(DVec3::new(little, 0.0, 1.0)), "{exponent}");
            assert!(!is_axis(DVec3::new(0.0, -1.0, -little)), "{exponent}");
        }
        assert!(!is_axis(DVec3::new(0.0, 1.0_f64.next_down(), 0.0)));
    }

    #[test]
    fn quotients_of_more_bits_are_not_short() {
        assert_eq!(short_quotient(8.0, 8.0), Some(1.0));
        assert_eq!(short_quotient(1023.0, 1.0), Some(1023.0));
        assert_eq!(short_quotient(1025.0, 1.0), None);
        assert_eq!(short_quotient(1.0, 3.0), None);
    }
}
