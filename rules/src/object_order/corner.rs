//! `corner`: samples at the upper left corners of pixels, where loops without `+ 0.5` take them.
//!
//! All else is right, in `f64`.

use super::float_edges::FloatEdges;
use crate::samples::{SamplePoint, Samples};

pub(super) fn rule(samples: Samples<'_>) -> FloatEdges<'_, f64> {
    FloatEdges::new(samples, SamplePoint::Corner)
}
