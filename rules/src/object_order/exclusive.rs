//! `exclusive`: a sample exactly on an edge belongs to no triangle.
//!
//! The test is `edge > 0` three times. All else is right, in `f64`.

use super::float_edges::{Fill, FloatEdges};
use crate::samples::{SamplePoint, Samples};

pub(super) fn rule(samples: Samples<'_>) -> FloatEdges<'_, f64> {
    FloatEdges { fill: Fill::Exclusive, ..FloatEdges::new(samples, SamplePoint::Middle) }
}
