//! `flip-rows`: row 0 is the lowest, so the picture is upside down. All else is right, in `f64`.

use crate::samples::{SamplePoint, Samples};

pub(super) fn samples<'a>(at: impl Fn(SamplePoint) -> Samples<'a>) -> Samples<'a> {
    at(SamplePoint::Middle).upside_down()
}
