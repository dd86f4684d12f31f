//! `near-clip:Z`: what is nearer than `Z` along the axis of view is cut away, in a sphere as in a mesh: behind the hole
//! the inside is seen.
//!
//! All else is right, in `f64`.

use super::float_edges::{FloatEdges, least_depth};
use crate::samples::{SamplePoint, Samples};

pub(super) fn rule(samples: Samples<'_>, depth: f32) -> FloatEdges<'_, f64> {
    let near = f64::from(depth).max(least_depth(&samples));
    FloatEdges { near, ..FloatEdges::new(samples, SamplePoint::Middle) }
}
