//! Eight rows of a sphere at a time: its functions on each row, and the columns in which it may be seen.

use super::forms::{Forms, SeenRoot};
use bothways_common::engine::roundoff::EPS53;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdFloat, f64x8};
use bothways_common::raster::Region;
use std::ops::Range;

/// What eight rows of a sphere need before their samples are tested.
pub(super) struct EightRows {
    first: usize,
    /// The form `square` on each row, as a function of `ξ`.
    square: [[f64; 8]; 2],
    linear: [f64; 8],
    /// The columns between which a sample may be covered; whatever is not less than the first of the region and not
    /// more than the last is beyond it.
    ends: [[f64; 8]; 2],
}

/// One row of a sphere: `square` is `square[0] + ξ·(square[1] + ξ·curvature)`, `linear` grows from here.
pub(super) struct Row {
    pub(super) square: [f64; 2],
    pub(super) linear: f64,
    /// The columns in which samples may be covered.
    pub(super) columns: Range<usize>,
}

impl EightRows {
    /// The rows from `first` on.
    #[inline(always)]
    pub(super) fn new<S: Simd>(simd: S, forms: &Forms, first: usize) -> EightRows {
        let splat = |value: f64| f64x8::splat(simd, value);
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let from_origin = first as f64 - forms.origin.row as f64;
        let rows = f64x8::load_array(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let up = (rows + splat(from_origin)) * splat(forms.spacing[0]);
        let Forms { square, linear, .. } = forms;
        let slope = splat(square.on_column[1]) + up * splat(square.on_column[2]);
        let on = splat(square.on_column[0]) + up * slope;
        let across = splat(square.across[0]) + up * splat(square.across[1]);
        let linear = splat(linear.on_column[0]) + up * splat(linear.on_column[1]);
        let (low, high) = ends(simd, forms, on, across);
        EightRows {
            first,
            linear: linear.to_array(),
            ends: [low.to_array(), high.to_array()],
            square: [on.to_array(), across.to_array()],
        }
    }

    /// One of the rows, as far as it lies in a region of the sphere.
    pub(super) fn row(&self, row: usize, region: &Region) -> Row {
        let lane = (row - self.first) & 7;
        Row {
            square: [self.square[0][lane], self.square[1][lane]],
            linear: self.linear[lane],
            columns: between([self.ends[0][lane], self.ends[1][lane]], &region.columns),
        }
    }
}

/// The columns between which `square` is not certainly negative, on eight rows; from −∞ to ∞ where that is not known.
///
/// A sample that may be covered has a `square`, in exact arithmetic from the row's coefficients, of at least
/// `−square_error`. If `curvature = −k` is negative, the function is `peak − k·(ξ − m)²` with `m = across/2k` and `peak =
/// on + ½·across·m`, so that `|ξ − m| ≤ √((peak + square_error)/k)`. The peak carries 3 roundings of its second part, and
/// one of both; `m` carries 2, the root 3. A sum of these and the product with `1/spacing` bring 3 more, of columns that
/// are less than 2¹⁷ where they matter: less than a millionth of a sample.
#[inline(always)]
fn ends<S: Simd>(simd: S, forms: &Forms, on: f64x8<S>, across: f64x8<S>) -> (f64x8<S>, f64x8<S>) {
    let splat = |value: f64| f64x8::splat(simd, value);
    let k = -forms.square.curvature;
    let square_error = match forms.seen {
        SeenRoot::Near { square_error, .. } if k > 0.0 => square_error,
        SeenRoot::Near { .. } | SeenRoot::Inside { .. } => {
            return (splat(f64::NEG_INFINITY), splat(f64::INFINITY));
        }
    };
    const ROUNDINGS: f64 = 8.0 * EPS53;
    let middle = across * splat(0.5 / k);
    let rest = splat(0.5) * across * middle;
    let peak = on + rest;
    let room = splat(square_error) + splat(ROUNDINGS) * (on.abs() + rest);
    let height = peak + room;
    let half = (height * splat(1.0 / k)).sqrt();
    let margin = splat(ROUNDINGS) * (middle.abs() + half);
    #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
    let origin = splat(forms.origin.column as f64);
    let by_spacing = splat(1.0 / forms.spacing[1]);
    let beside = splat((-20f64).exp2());
    let low = (middle - half - margin) * by_spacing + origin - beside;
    let high = (middle + half + margin) * by_spacing + origin + beside;
    // Written so that NaN is not known to be empty.
    let empty = height.simd_lt(splat(0.0));
    (low, empty.select(splat(-1.0), high))
}

/// The columns of a range that lie between two ends. NaN is no end.
#[inline(always)]
#[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the range")]
fn between([low, high]: [f64; 2], columns: &Range<usize>) -> Range<usize> {
    let Range { start, end } = *columns;
    let first = if low > start as f64 { low.min(end as f64).ceil() as usize } else { start };
    let end = if high < start as f64 {
        start
    } else if high < end as f64 {
        high as usize + 1
    } else {
        end
    };
    first..end.min(columns.end).max(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_rounded_inwards() {
        assert_eq!(between([2.5, 7.5], &(0..20)), 3..8);
        assert_eq!(between([3.0, 7.0], &(0..20)), 3..8);
        assert_eq!(between([-1.0, 30.0], &(4..20)), 4..20);
        assert_eq!(between([f64::NAN, f64::NAN], &(4..20)), 4..20);
        assert_eq!(between([f64::NEG_INFINITY, f64::INFINITY], &(4..20)), 4..20);
        assert!(between([1.0, -1.0], &(0..20)).is_empty());
        assert!(between([2.2, 2.8], &(0..20)).is_empty());
        assert!(between([25.0, 28.0], &(0..20)).is_empty());
        assert!(between([1.0, 2.0], &(4..20)).is_empty());
    }
}
