//! Vertices that lie exactly at samples, or at quarters of the way from one to the next.
//!
//! Edge functions between such places are small multiples of a sixteenth: `f32` computes them without rounding,
//! so that an edge through a sample costs no more than any other.

use crate::camera::{Camera, Projection, SampleGrid};
use crate::simd::{Simd, SimdBase, SimdFloat, f64x8, mask64x8};
use glam::DVec3;

/// What decides a sample on an edge between such places: half of the least edge function but 0, which is added
/// to edges that own their samples, and taken from others.
///
/// The contract moves the sample a little to the right, which adds a little of the edge function's slope across,
/// and far less down, which adds far less of its slope down: an edge owns its samples if its slope across is
/// positive, or is zero and its slope down positive.
pub const TIE: f32 = 1.0 / 32.0;

/// The samples of a camera between which and its rays nothing is rounded.
#[derive(Clone, Copy, Debug)]
pub struct ExactGrid {
    projection: Projection,
    distance: f64,
    /// From one column to the next on the viewport, and from one row to the next.
    spacing: [f64; 2],
    /// The column and row of the viewport's middle.
    middle: [f64; 2],
}

impl ExactGrid {
    /// The grid of a camera's samples, if nothing is rounded between them.
    ///
    /// If the distance `vw/W` has at most 10 bits, a sample's coordinate, half of it times an integer of 17
    /// bits, is stored without rounding. If besides `u`, `v` and `w` run along the world's axes, the rays and
    /// all offsets along `u`, `v`, `w` are the coordinates themselves.
    pub fn new(camera: &Camera, samples: &SampleGrid) -> Option<ExactGrid> {
        let is_axis =
            |axis: DVec3| axis.abs().element_sum() == 1.0 && axis.abs().max_element() == 1.0;
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let size = [samples.width() as f64, samples.height() as f64];
        let viewport = camera.viewport();
        let spacing: [Option<f64>; 2] = std::array::from_fn(|axis| {
            let spacing = viewport[axis] / size[axis];
            let few_bits = spacing.to_bits().trailing_zeros() >= 43;
            (few_bits && spacing * size[axis] == viewport[axis]).then_some(spacing)
        });
        let [Some(across), Some(down)] = spacing else { return None };
        [camera.u(), camera.v(), camera.w()].into_iter().all(is_axis).then_some(ExactGrid {
            projection: camera.projection(),
            distance: camera.distance(),
            spacing: [across, down],
            middle: size.map(|count| 0.5 * (count - 1.0)),
        })
    }

    /// Where vertices lie exactly at a multiple of a quarter of a column (axis 0) or row (axis 1): the one next
    /// to `place`, their computed column or row. `along` is their offset from the eye along `u` or `−v`, and
    /// `depth` along `−w`.
    ///
    /// With `r` along `u` (or `−v`) and `g` the distance of neighbours, the true column is `middle +
    /// r·d/(ζ·g)` (parallel: without `d/ζ`). Let `n/4` be the quarter nearest to the computed one: it is the
    /// true one if `m·g·ζ = 4·r·d` with the integer `m = n − 4·middle`. Both products are exact in `f64`: `m`
    /// has at most 19 bits where `place` is within 1.49·2¹⁶, `g` 10, `d` 24, and `r` and `ζ` are checked to
    /// have 24. Of places farther out, nothing is said.
    #[inline(always)]
    pub fn holds<S: Simd>(
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
            Projection::Parallel => grid_point.simd_eq(along * splat(4.0)) & is_short(simd, along),
        }
    }
}

/// Which numbers `f32` holds, too.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "the question is what survives it")]
fn is_short<S: Simd>(simd: S, value: f64x8<S>) -> mask64x8<S> {
    let back = value.to_array().map(|value| f64::from(value as f32));
    value.simd_eq(f64x8::load_array(simd, back))
}
