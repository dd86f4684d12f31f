//! Affine functions of the raster, one for each of eight triangles.

use bothways_common::engine::simd::{Select, Simd, SimdBase, f32x8, mask32x8};

/// An affine function of the raster in eight lanes: `at_middle + δi·down + δj·across`, with `δi` rows and `δj` columns
/// from the middle of a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneAffine<S: Simd> {
    pub(super) at_middle: f32x8<S>,
    /// What it gains from a column to the next.
    pub(super) across: f32x8<S>,
    /// What it gains from a row to the next.
    pub(super) down: f32x8<S>,
}

impl<S: Simd> LaneAffine<S> {
    /// The value at a row and a column, counted from the middle.
    #[inline(always)]
    pub(super) fn at(&self, row: f32x8<S>, column: f32x8<S>) -> f32x8<S> {
        (self.at_middle + self.down * row) + self.across * column
    }

    /// At most how far from its value at the middle it is within `half` rows and columns.
    #[inline(always)]
    pub(super) fn spread(&self, half: f32x8<S>) -> f32x8<S> {
        half * (self.across.abs() + self.down.abs())
    }

    /// The other one, in some lanes.
    #[inline(always)]
    pub(super) fn or(&self, other: &Self, which: mask32x8<S>) -> Self {
        LaneAffine {
            at_middle: which.select(other.at_middle, self.at_middle),
            across: which.select(other.across, self.across),
            down: which.select(other.down, self.down),
        }
    }
}
