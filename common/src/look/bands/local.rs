//! Normals of triangles on which they change little. Most of these are small, and seen at few samples of a row.

use super::chunk::Chunk;
use crate::engine::simd::{Simd, SimdBase, f32x8};
use crate::look::lanes::each;
use crate::raster::Sample;
use glam::Vec3;
use std::ops::Range;

/// Normals towards the viewer as an affine function of row and column, in `f32`, counted from a sample near the triangle: where they
/// change so little on it that this is exact enough.
#[derive(Clone, Copy, Debug)]
pub struct LocalNormals {
    /// The normal at the anchor, and how it changes from a column to the next one, and from a row to the next one.
    numbers: [[f32; 3]; 3],
    /// Row and column of that sample, which may lie outside of the picture.
    anchor: [i32; 2],
}

/// Samples of a row that are found together: most triangles are not seen at more.
const TOGETHER: usize = 8;
const LANES: [f32; TOGETHER] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];

impl LocalNormals {
    /// The normal at an anchor, a row and a column within 2²³, and its changes from there to the next column and to the next row.
    /// Lengths where the triangle is seen are between 2⁻⁶⁰ and 2⁶⁰.
    #[inline(always)]
    pub fn new(anchor: [i32; 2], numbers: [[f32; 3]; 3]) -> LocalNormals {
        LocalNormals { numbers, anchor }
    }

    /// The normal at a sample.
    pub fn at(&self, Sample { row, column }: Sample) -> Vec3 {
        let [rows, columns] = [steps_from(row, self.anchor[0]), steps_from(column, self.anchor[1])];
        let [at_anchor, across, down] = self.numbers.map(Vec3::from);
        (at_anchor + down * rows) + across * columns
    }

    /// Writes down the normals at some samples of a row, of which this is the first, with the bits of [`LocalNormals::at`]. What it
    /// writes beyond them is overwritten by what comes next.
    #[inline(always)]
    pub(super) fn store<S: Simd>(
        &self,
        simd: S,
        first: Sample,
        chunk: &mut Chunk,
        samples: Range<usize>,
    ) {
        let rows = steps_from(first.row, self.anchor[0]);
        let mut columns = steps_from(first.column, self.anchor[1]);
        let [at_anchor, across, down] = &self.numbers;
        let in_row = each!(k in [0, 1, 2] => at_anchor[k] + down[k] * rows);
        for at in samples.step_by(TOGETHER) {
            // Whole numbers below 2²⁴ are exact.
            let places = f32x8::splat(simd, columns) + f32x8::load_array_ref(simd, &LANES);
            columns += LANES[TOGETHER - 1] + 1.0;
            let [x, y, z] = each!(k in [0, 1, 2] => {
                f32x8::splat(simd, in_row[k]) + f32x8::splat(simd, across[k]) * places
            });
            let [to_x, to_y, to_z] = &mut chunk.normal;
            x.store_slice(&mut to_x[at..at + TOGETHER]);
            y.store_slice(&mut to_y[at..at + TOGETHER]);
            z.store_slice(&mut to_z[at..at + TOGETHER]);
        }
    }
}

/// How many steps a row or a column is beyond another one.
#[inline(always)]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    reason = "a picture has fewer than 2²³ rows and columns, and `LocalNormals::new` asks the same of anchors"
)]
fn steps_from(at: usize, anchor: i32) -> f32 {
    (at as i32 - anchor) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{dispatch, levels};

    #[test]
    fn normals_of_a_row_have_the_bits_of_each_alone() {
        let numbers = [[0.1, -0.7, 0.7], [0.011, 0.02, -0.031], [-0.017, 0.013, 0.07]];
        let normals = LocalNormals::new([-3, 1000], numbers);
        for level in levels() {
            let mut chunk = Chunk::new();
            let first = Sample { row: 5, column: 990 };
            dispatch!(level, simd => normals.store(simd, first, &mut chunk, 40..61));
            for at in 40..61 {
                let expected = normals.at(Sample { column: first.column + at - 40, ..first });
                assert_eq!(Vec3::from([0, 1, 2].map(|k: usize| chunk.normal[k][at])), expected);
            }
        }
    }
}
