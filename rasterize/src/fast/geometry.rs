//! The geometry of a frame, once the vertex stage is done.

use super::camera_map::CameraMap;
use super::search::clusters::Clusters;
use super::search::instances::SharedMesh;
use super::search::tiling::Tiling;
use super::vertices::{FixedPointRaster, Vertex};
use bothways_common::View;
use std::sync::Arc;

/// The map and the raster, the vertices on it, and the tiles.
pub(super) struct Geometry<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) map: &'a CameraMap<'a>,
    pub(super) raster: &'a FixedPointRaster,
    pub(super) tiling: &'a Tiling,
    /// All vertices, and for each object where its own begin.
    pub(super) vertices: &'a [Vertex],
    pub(super) first_vertices: &'a [usize],
    /// The clusters of every object.
    pub(super) clusters: &'a [Clusters],
    /// The meshes of those that are instances.
    pub(super) shared: &'a [Option<Arc<SharedMesh>>],
}
