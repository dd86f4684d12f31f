//! What stays the same while a picture is drawn.

use super::camera_map::CameraMap;
use super::depth::KeyScale;
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::fault::Planted;
use bothways_common::observe::{Events, Question};
use bothways_common::raster::Sample;
use bothways_common::{Primitive, View};

/// What is drawn, from where, and how depth is stored.
pub(super) struct Picture<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) map: &'a CameraMap<'a>,
    pub(super) keys: KeyScale,
    /// Whether tiles that are finished are written past the caches.
    pub(super) past_caches: bool,
}

/// Asks the judge whether a primitive covers a sample that rounding leaves open.
#[cold]
pub(super) fn judge_covers<C: ScalarContext>(
    context: &mut C,
    picture: &Picture,
    sample: Sample,
    id: u64,
    primitive: &Primitive,
) -> bool {
    context.sink().judged(sample, Question::Coverage);
    let ray = picture.map.grid.ray(sample.row, sample.column);
    let coverage = picture.view.judge().coverage(primitive, &ray);
    if let Some(edges) = coverage.edges {
        context.sink().edge_signs(sample, id, edges.at_sample.map(Some));
    }
    coverage.covers && !C::has(Planted::StrictComparison)
}
