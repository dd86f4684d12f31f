//! What is kept of a scene for any number of views of it.

use super::search::tree::{Bounds, IndexedLeaf, Node, NodeRef, PlainLeaf, SPHERES};
use bothways_common::engine::simd::Level;

/// What a moving camera would not repeat: the hierarchy over all bounded primitives.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) nodes: Vec<Node>,
    pub(super) indexed_leaves: Vec<IndexedLeaf>,
    pub(super) plain_leaves: Vec<PlainLeaf>,
    /// The ids of the spheres of the hierarchy's leaves; unused lanes repeat the first.
    pub(super) sphere_leaves: Vec<[u32; SPHERES]>,
    /// Where the walk begins: the triangles, and the spheres, as far as there are any.
    pub(super) roots: Vec<NodeRef>,
    /// Around everything in the hierarchy.
    pub(super) bounds: Bounds,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and for each the extent that the margin of its box was made for.
    pub(super) extents: Vec<(u32, f32)>,
    pub(super) primitives: u32,
    pub(super) level: Level,
    /// Samples along one side of a tile.
    pub(super) side: usize,
}

impl Prepared {
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
}
