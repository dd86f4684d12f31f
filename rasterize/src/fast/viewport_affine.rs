//! Affine functions on the viewport.

use bothways_common::engine::roundoff::Interval;

/// A function `at_center + x·across + y·up` on the viewport, to within `error`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewportAffine {
    pub(super) at_center: f64,
    pub(super) across: f64,
    pub(super) up: f64,
    /// Infinite where the function is not to be trusted.
    pub(super) error: f64,
}

impl ViewportAffine {
    /// The function times a sign, ±1.
    #[inline(always)]
    pub(super) fn oriented(self, sign: f64) -> ViewportAffine {
        let ViewportAffine { at_center, across, up, error } = self;
        ViewportAffine { at_center: sign * at_center, across: sign * across, up: sign * up, error }
    }

    /// The part of the function that all samples of a row share.
    #[inline(always)]
    pub(super) fn on_row(&self, y: f64) -> f64 {
        self.at_center + y * self.up
    }

    /// The function at a sample of that row.
    pub(super) fn at(&self, on_row: f64, x: f64) -> Interval {
        let value = on_row + x * self.across;
        // A function that is not trusted gives NaN.
        Interval::around(value, self.error).unwrap_or(Interval::ALL)
    }
}
