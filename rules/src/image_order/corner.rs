//! `corner`: rays through the upper left corners of pixels, as from formulas without `+ 0.5`. All else is right, in `f64`.

use crate::samples::{SamplePoint, Samples};

pub(super) fn samples<'a>(at: impl Fn(SamplePoint) -> Samples<'a>) -> Samples<'a> {
    at(SamplePoint::Corner)
}
