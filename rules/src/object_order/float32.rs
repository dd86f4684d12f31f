//! `float32`: raster coordinates, edge functions and depths in `f32`, with the top-left rule.
//!
//! A raster coordinate near 1000 has 13 bits behind the point, and an edge function is a difference of products of such
//! coordinates: a shared edge is not the same edge from both sides.

use super::float_edges::FloatEdges;
use crate::samples::{SamplePoint, Samples};

pub(super) fn rule(samples: Samples<'_>) -> FloatEdges<'_, f32> {
    FloatEdges::new(samples, SamplePoint::Middle)
}
