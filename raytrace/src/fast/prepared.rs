//! What is kept of a scene for any number of views of it.

use super::search::tree::{
    Bounds, IndexedLeaf, LEAF_KINDS, LeafCounts, Node, NodeRef, PlainLeaf, SPHERES, ScatteredLeaf,
};
use bothways_common::engine::simd::Level;
use bothways_common::engine::tasks::TaskTimes;
use bothways_common::{Placement, Scene, Shape};
use std::sync::Arc;

/// What a moving camera would not repeat: the hierarchy over all bounded primitives.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) nodes: Vec<Node>,
    pub(super) indexed_leaves: Vec<IndexedLeaf>,
    pub(super) scattered_leaves: Vec<ScatteredLeaf>,
    pub(super) plain_leaves: Vec<PlainLeaf>,
    /// The names of the spheres of the hierarchy's leaves; unused lanes repeat the first.
    pub(super) sphere_leaves: Vec<[u32; SPHERES]>,
    /// The numbers of all instances, leaf by leaf: a leaf of instances is known by the place of its first here.
    pub(super) instance_order: Vec<u32>,
    /// The hierarchies of the meshes that instances share, in coordinates of the meshes.
    pub(super) meshes: Vec<MeshRoot>,
    /// The objects that are instances.
    pub(super) instanced: Vec<Instanced>,
    /// Where the walk begins: the triangles, the spheres and the instances, as far as there are any.
    pub(super) roots: Vec<NodeRef>,
    /// Around everything in the hierarchy.
    pub(super) bounds: Bounds,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and for each the extent that the margin of its box was made for.
    pub(super) extents: Vec<(u32, f32)>,
    pub(super) primitives: u64,
    pub(super) level: Level,
    /// Threads that chunks are cut for; 0 if all frames have the same chunks.
    pub(super) threads: usize,
    /// For benches.
    pub(super) times: Option<Arc<TaskTimes>>,
    /// Samples along one side of a tile.
    pub(super) side: usize,
}

/// The hierarchy of a mesh that instances share.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeshRoot {
    /// A node, or a leaf with these counts.
    pub(super) root: NodeRef,
    pub(super) counts: LeafCounts,
    /// Around all of it.
    pub(super) bounds: Bounds,
}

/// An object that is instances of a mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instanced {
    /// The number of its first instance among those of all objects.
    pub(super) first_number: u32,
    pub(super) object: usize,
    pub(super) first_id: u64,
    /// How many triangles the mesh has, and its place among [`Prepared::meshes`].
    pub(super) triangles: u32,
    pub(super) mesh: usize,
}

/// One instance of a mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct OneInstance<'a, 'b> {
    pub(super) mesh: &'a MeshRoot,
    pub(super) placement: &'b Placement,
    /// The id of its first triangle, and how many it has.
    pub(super) first_id: u64,
    pub(super) triangles: u32,
}

impl Prepared {
    /// An instance, by its number among those of all objects.
    #[inline(always)]
    pub(super) fn instance<'a>(&self, scene: &'a Scene, number: u32) -> OneInstance<'_, 'a> {
        let after = self.instanced.partition_point(|instanced| instanced.first_number <= number);
        let Instanced { first_number, object, first_id, triangles, mesh } =
            self.instanced[after - 1];
        let Shape::Instances(instances) = &scene.objects()[object].shape else {
            unreachable!("another scene was prepared")
        };
        let number = number - first_number;
        let placement = &instances.placements()[number as usize];
        let first_id = first_id + u64::from(number) * u64::from(triangles);
        OneInstance { mesh: &self.meshes[mesh], placement, first_id, triangles }
    }

    /// The number of leaves of each kind; none of instances, which there are in one hierarchy only.
    pub(super) fn leaf_counts(&self) -> [usize; LEAF_KINDS] {
        let Prepared { indexed_leaves, scattered_leaves, plain_leaves, sphere_leaves, .. } = self;
        let (indexed, scattered) = (indexed_leaves.len(), scattered_leaves.len());
        [indexed, scattered, plain_leaves.len(), sphere_leaves.len(), 0]
    }

    /// Adds the root of a hierarchy, in which everything has these bounds.
    pub(super) fn add_root(&mut self, root: NodeRef, bounds: &Bounds) {
        self.bounds = self.bounds.union(bounds);
        self.roots.push(root);
    }

    /// Cuts frames into chunks for so many threads: into smaller ones where there are many threads and few chunks. Frames are
    /// the same to the last bit, and sooner done; in which order observers hear of rays depends on the number from then on.
    pub fn cut_for_threads(&mut self, threads: usize) {
        self.threads = threads;
    }

    /// The same, traced at another level of SIMD and in tiles of 16 × 16 or 32 × 32 samples: for tests. They check that
    /// the level changes no bit of a frame, and that the tiles change no id and no event.
    ///
    /// # Panics
    ///
    /// If `side` is another number.
    #[doc(hidden)]
    #[must_use]
    pub fn drawn_with(self, level: Level, side: usize) -> Prepared {
        assert!([16, 32].contains(&side), "tiles have 16 or 32 samples a side, not {side}");
        Prepared { level, side, ..self }
    }

    /// The same, with a note of how long the tasks of each frame take: for benches.
    #[doc(hidden)]
    #[must_use]
    pub fn timed_by(self, times: Arc<TaskTimes>) -> Prepared {
        Prepared { times: Some(times), ..self }
    }
}
