//! A triangle at one of its vertices.

use glam::DVec3;

/// A triangle at one of its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    /// The unit normal; zero if the triangle has no area.
    pub(super) normal: DVec3,
    /// The normal times the triangle's angle at the vertex.
    pub(super) weighted: DVec3,
    pub(super) triangle: u32,
}
