//! `inclusive`: a sample exactly on an edge belongs to the triangles on both sides.
//!
//! The test is `edge >= 0` three times, which is what most first rasterizers write. All else is right, in `f64`.

use super::float_edges::{Fill, FloatEdges};
use crate::samples::{SamplePoint, Samples};

pub(super) fn rule(samples: Samples<'_>) -> FloatEdges<'_, f64> {
    FloatEdges { fill: Fill::Inclusive, ..FloatEdges::new(samples, SamplePoint::Middle) }
}
