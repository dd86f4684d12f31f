//! Normals and ways to points of light that are kept as some numbers in `f32`, counted from a sample near their triangle. Most of
//! these triangles are small, and seen at few samples of a row.

use crate::engine::simd::{Simd, SimdBase, SimdNarrow, f32x8, f64x8};
use crate::look::lanes::{DVec3x8, Lanes, each};
use crate::raster::Sample;
use std::convert::Infallible;

/// With more points of light, the point that is seen takes less room than the ways to all of them. Triangles are not kept as local
/// looks then, either. This number is a guess.
pub const MOST_LIGHTS: usize = 4;

/// Three vectors, of which each sample has a sum: the first, and the others times a [factor](LocalLook::factors) each.
pub type LocalVector = [[f32; 3]; 3];

/// A triangle of which nothing is wanted but normals and the ways to points of light, by some numbers in `f32` that are exact enough
/// near it.
///
/// Normals are towards the viewer, and ways lead to their light; where the triangle is seen, all have any length between 2⁻⁶⁰ and 2⁶⁰.
pub trait LocalLook: Copy + Send {
    /// What its normals are made of.
    fn normals(&self) -> &LocalVector;

    /// The factors of the second vector and of the third at eight samples of a row, of which this is the first. Samples at which the
    /// triangle is not seen get any.
    fn factors<S: Simd>(&self, simd: S, first: Sample) -> [f32x8<S>; 2];
}

/// There are none.
impl LocalLook for Infallible {
    fn normals(&self) -> &LocalVector {
        match *self {}
    }

    fn factors<S: Simd>(&self, _: S, _: Sample) -> [f32x8<S>; 2] {
        match *self {}
    }
}

/// A vector at eight samples with these factors, summed up from left to right.
#[inline(always)]
pub fn vector_at<S: Simd>(
    simd: S,
    [first, second, third]: &LocalVector,
    [of_second, of_third]: [f32x8<S>; 2],
) -> Lanes<f32x8<S>> {
    let splat = |number: f32| f32x8::splat(simd, number);
    let [x, y, z] = each!(k in [0, 1, 2] => {
        splat(first[k]) + splat(second[k]) * of_second + splat(third[k]) * of_third
    });
    Lanes { x, y, z }
}

/// Three vectors as they are kept.
#[inline(always)]
pub fn local_vector([a, b, c]: [Lanes<f64>; 3]) -> LocalVector {
    #[expect(clippy::cast_possible_truncation, reason = "each order derives what it loses")]
    let number = |number: f64| number as f32;
    each!(of in [a, b, c] => [number(of.x), number(of.y), number(of.z)])
}

/// The same of eight triangles.
#[derive(Clone, Copy, Debug)]
pub struct EightVectors([[f32; 16]; 5]);

impl EightVectors {
    /// Zeros.
    pub const ZERO: EightVectors = EightVectors([[0.0; 16]; 5]);

    /// With these vectors, rounded to `f32`.
    #[inline(always)]
    pub fn new<S: Simd>([a, b, c]: [DVec3x8<S>; 3]) -> EightVectors {
        // Two times eight numbers at a time become `f32`.
        let halves: [[f64x8<S>; 2]; 5] =
            [[a.x, a.y], [a.z, b.x], [b.y, b.z], [c.x, c.y], [c.z, c.z]];
        EightVectors(each!(k in [0, 1, 2, 3, 4] => halves[k][0].narrow(halves[k][1]).to_array()))
    }

    /// Those of one triangle.
    #[inline(always)]
    pub fn of(&self, lane: usize) -> LocalVector {
        let number = |k: usize| self.0[k / 2][k % 2 * 8 + (lane & 7)];
        each!(from in [0, 3, 6] => [number(from), number(from + 1), number(from + 2)])
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
