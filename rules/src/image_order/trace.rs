//! The loop of every rule: for each sample in the picture, for each object that its ray may hit, keep the nearest.

use super::hierarchy::Hierarchy;
use super::shape::Shape;
use crate::samples::Samples;
use bothways_common::Frame;
use bothways_common::frame::{Tile, stored_t};
use rayon::prelude::*;

/// A rule at work.
pub(super) trait Tracer: Sync {
    /// A ray in the rule's arithmetic.
    type Ray;

    /// The ray through a sample.
    fn ray(&self, row: usize, column: usize) -> Self::Ray;
    /// The least positive `t` at which a ray hits a primitive.
    fn hit(&self, ray: &Self::Ray, shape: &Shape) -> Option<f64>;
}

/// How many rows and columns of samples one thread draws at a time.
const TILE: usize = 16;

/// Traces all rays. Of equal hits, the first in the scene is seen.
pub(super) fn trace<T: Tracer>(
    tracer: &T,
    hierarchy: &Hierarchy,
    samples: &Samples,
    frame: &mut Frame,
) {
    frame.tiles_mut(TILE, TILE).into_par_iter().for_each(|Tile { region, ids, mut t }| {
        let mut ids = ids.narrow();
        for (in_tile, row) in region.rows.clone().enumerate() {
            for (at, column) in region.columns.clone().enumerate() {
                // The search is in f64 whatever the rule: it must not lose what the rule hits.
                let path = samples.ray(row, column);
                let ray = tracer.ray(row, column);
                let mut nearest = (f64::INFINITY, u32::MAX);
                hierarchy.walk(&path, samples.camera().eye(), &mut nearest, |shape| {
                    tracer.hit(&ray, shape)
                });
                if nearest.0.is_finite() {
                    ids[in_tile][at] = nearest.1;
                    t[in_tile][at] = stored_t(nearest.0);
                }
            }
        }
    });
}
