//! `one-origin`: the rays of a parallel camera all start at the eye, and have one direction: they are one ray. A
//! perspective camera, whose rays do start at the eye, is not changed. All else is right, in `f64`.

use crate::samples::{SamplePoint, Samples};

pub(super) fn samples<'a>(at: impl Fn(SamplePoint) -> Samples<'a>) -> Samples<'a> {
    at(SamplePoint::Middle).with_one_origin()
}
