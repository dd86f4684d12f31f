//! Normals that are kept as some numbers in `f32`, counted from a sample near their triangle. Most of these triangles are small, and
//! seen at few samples of a row.

use crate::engine::simd::{Simd, SimdBase, f32x8};
use crate::raster::Sample;
use std::convert::Infallible;

/// The normals of a triangle of which nothing else is wanted, each of some numbers in `f32` that are exact enough near it.
pub trait LocalNormals: Copy + Send {
    /// Writes down normals towards the viewer, of any length between 2⁻⁶⁰ and 2⁶⁰, at some samples of a row, of which this is the
    /// first: their three coordinates, a multiple of eight of each. Samples at which the triangle is not seen get any values.
    fn store<S: Simd>(&self, simd: S, first: Sample, to: [&mut [f32]; 3]);
}

/// There are none.
impl LocalNormals for Infallible {
    fn store<S: Simd>(&self, _simd: S, _first: Sample, _to: [&mut [f32]; 3]) {
        match *self {}
    }
}

/// A sample from which others are counted. It may lie outside of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Anchor {
    row: i32,
    column: i32,
}

impl Anchor {
    /// Triangles are counted from anchors that are nearer to the picture's middle, rows and columns added up. So these, and
    /// differences of them, are exact in `f32`.
    pub const FARTHEST: f64 = 1e6;

    /// The sample in this row and column, which are whole numbers within 2²³.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "whole, and within 2²³")]
    pub fn new([row, column]: [f64; 2]) -> Anchor {
        Anchor { row: row as i32, column: column as i32 }
    }

    /// How many rows and columns a sample is beyond it, exactly.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_precision_loss,
        reason = "a picture has fewer than 2²³ rows and columns, and `Anchor::new` asks the same of anchors"
    )]
    pub fn steps_to(self, Sample { row, column }: Sample) -> [f32; 2] {
        [(row as i32 - self.row) as f32, (column as i32 - self.column) as f32]
    }
}

/// A whole number of columns, and the seven after it.
#[inline(always)]
pub fn eight_columns<S: Simd>(simd: S, first: f32) -> f32x8<S> {
    // Whole numbers below 2²⁴ are exact.
    f32x8::splat(simd, first)
        + f32x8::load_array_ref(simd, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}
