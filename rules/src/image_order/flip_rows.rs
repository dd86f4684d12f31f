//! `flip-rows`: row 0 is the lowest, so the picture is upside down. All else is right, in `f64`.

use crate::samples::{Place, Samples};

pub(super) fn samples<'a>(at: impl Fn(Place) -> Samples<'a>) -> Samples<'a> {
    at(Place::Middle).upside_down()
}
