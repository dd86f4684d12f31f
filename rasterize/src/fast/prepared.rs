//! What is prepared once for any number of views of a scene.

use super::search::batches::{Batch, batches};
use super::search::bins::BatchBins;
use super::search::clusters::Clusters;
use super::search::instances::{SharedMesh, placed_box, shared_meshes};
use super::tile::TileBuffer;
use super::vertices::Vertex;
use bothways_common::engine::simd::{Level, best_level};
use bothways_common::engine::tasks::TaskTimes;
use bothways_common::{Instances, Scene, Shape};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::{Arc, Mutex};

/// Rows and columns of a tile, as powers of two: its keys and ids fill a MiB. Full HD has 20 tiles, enough
/// for some threads.
const TILE: [u32; 2] = [8, 9];

/// What a moving camera would not repeat: the scene is cut into batches that threads can share, its meshes
/// into clusters of neighbouring triangles, and a box around it is known.
#[derive(Debug)]
pub struct Prepared {
    pub(super) batches: Vec<Batch>,
    /// The clusters of every object.
    pub(super) clusters: Vec<Clusters>,
    /// For each object that is instances: the mesh.
    pub(super) shared: Vec<Option<Arc<SharedMesh>>>,
    pub(super) primitives: u64,
    /// The index of each object's first vertex among all vertices; at the end, the number of all vertices.
    pub(super) first_vertices: Vec<usize>,
    /// The corners of a box around all objects that are not planes.
    pub(super) bounds: [DVec3; 8],
    pub(super) has_planes: bool,
    pub(super) level: Level,
    pub(super) tile: [u32; 2],
    /// Threads that tiles are cut for; 0 if all frames have the same tiles.
    pub(super) threads: usize,
    /// For benches.
    pub(super) times: Option<Arc<TaskTimes>>,
    /// Of the last frame: allocations for the next.
    pub(super) recycled: Mutex<Recycled>,
}

/// Memory that one frame passes on to the next; its contents are not used again.
#[derive(Debug, Default)]
pub(super) struct Recycled {
    pub(super) vertices: Vec<Vertex>,
    pub(super) bins: Vec<BatchBins>,
    pub(super) tiles: Vec<TileBuffer>,
}

/// A box around all instances of a mesh.
fn around(instances: &Instances) -> [DVec3; 2] {
    let nothing = || [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let Some(bounds) = instances.mesh().bounds() else { return nothing() };
    let boxes = instances
        .placements()
        .par_iter()
        .with_min_len(1024)
        .map(|placement| placed_box(placement, &bounds).map(|corner| corner.as_dvec3()));
    boxes.reduce(nothing, |a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

/// The corners of a box.
pub(crate) fn corners(bounds: [DVec3; 2]) -> [DVec3; 8] {
    std::array::from_fn(|k| {
        DVec3::from_array(std::array::from_fn(|axis| bounds[k >> axis & 1][axis]))
    })
}

impl Prepared {
    /// What [`prepare`](super::prepare) returns.
    pub(super) fn new(scene: &Scene) -> Prepared {
        let primitives = scene.primitive_count();
        let mut first_vertices = vec![0];
        let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let mut has_planes = false;
        for object in scene.objects() {
            let mut include = |low: DVec3, high: DVec3| {
                bounds = [bounds[0].min(low), bounds[1].max(high)];
            };
            let vertices = match &object.shape {
                Shape::Mesh(mesh) => {
                    for position in mesh.positions() {
                        include(position.as_dvec3(), position.as_dvec3());
                    }
                    mesh.positions().len()
                }
                Shape::Triangle(triangle) => {
                    for corner in [triangle.a, triangle.b, triangle.c] {
                        include(corner.as_dvec3(), corner.as_dvec3());
                    }
                    3
                }
                Shape::Sphere(sphere) => {
                    let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
                    include(center - radius, center + radius);
                    0
                }
                Shape::Instances(instances) => {
                    let [low, high] = around(instances);
                    include(low, high);
                    0
                }
                Shape::Plane(_) => {
                    has_planes = true;
                    0
                }
            };
            first_vertices.push(first_vertices[first_vertices.len() - 1] + vertices);
        }
        let clusters = scene.objects().par_iter().map(|object| Clusters::new(&object.shape));
        Prepared {
            batches: batches(scene),
            clusters: clusters.collect(),
            shared: shared_meshes(scene),
            primitives,
            first_vertices,
            bounds: corners(bounds),
            has_planes,
            level: best_level(),
            tile: TILE,
            threads: 0,
            times: None,
            recycled: Mutex::default(),
        }
    }

    /// Cuts frames into tiles for so many threads: into smaller ones where there are many threads and few tiles. Frames are
    /// the same to the last bit, and sooner done; what they execute ([`Executed`]) depends on the number from then on.
    ///
    /// [`Executed`]: bothways_common::Executed
    pub fn cut_for_threads(&mut self, threads: usize) {
        self.threads = threads;
    }

    /// The same as a part of a larger scene: it is drawn as the larger scene would draw it, to the last bit. `bounds`
    /// are the corners of a box around that.
    pub(crate) fn within(self, bounds: [DVec3; 8]) -> Prepared {
        Prepared { bounds, ..self }
    }

    /// The same, drawn at another level of SIMD and in tiles of other rows and columns (powers of
    /// two): for tests, which check that neither changes a bit.
    #[doc(hidden)]
    #[must_use]
    pub fn drawn_with(self, level: Level, tile: [u32; 2]) -> Prepared {
        Prepared { level, tile, ..self }
    }

    /// The same, with a note of how long the tasks of each frame take: for benches.
    #[doc(hidden)]
    #[must_use]
    pub fn timed_by(self, times: Arc<TaskTimes>) -> Prepared {
        Prepared { times: Some(times), ..self }
    }
}

impl Clone for Prepared {
    fn clone(&self) -> Self {
        Prepared {
            batches: self.batches.clone(),
            clusters: self.clusters.clone(),
            shared: self.shared.clone(),
            first_vertices: self.first_vertices.clone(),
            times: self.times.clone(),
            recycled: Mutex::default(),
            ..*self
        }
    }
}
