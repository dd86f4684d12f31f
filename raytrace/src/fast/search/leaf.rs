//! Leaves of triangles, in whichever way they are stored.

use super::packed_ids;
use super::tile_frustum::TileFrustum;
use super::tree::{IndexedLeaf, LEAF, NodeKind, NodeRef, PlainLeaf};
use crate::fast::local_projection::LocalProjection;
use crate::fast::prepared::Prepared;
use bothways_common::Placement;
use bothways_common::engine::simd::{
    Compression, PackedShuffles, Simd, SimdBase, f32x16, mask32x16, u32x16,
};
use bothways_common::look::lanes::each;

/// A leaf in one of the ways in which its corners are stored.
pub(crate) enum FoundLeaf<'a> {
    Indexed(&'a IndexedLeaf),
    Plain(&'a PlainLeaf),
}

/// The leaf that a reference to one refers to.
#[inline(always)]
pub(crate) fn find_leaf(prepared: &Prepared, leaf: NodeRef) -> FoundLeaf<'_> {
    let (kind, index) = (leaf.kind(), leaf.index());
    if kind == NodeKind::IndexedLeaf {
        FoundLeaf::Indexed(&prepared.indexed_leaves[index])
    } else if kind == NodeKind::ScatteredLeaf {
        FoundLeaf::Indexed(&prepared.scattered_leaves[index].indexed)
    } else {
        FoundLeaf::Plain(&prepared.plain_leaves[index])
    }
}

/// The ids of the triangles of a leaf; unused lanes repeat the first.
#[inline(always)]
pub(crate) fn ids_of<S: Simd>(simd: S, prepared: &Prepared, leaf: NodeRef) -> u32x16<S> {
    let (kind, index) = (leaf.kind(), leaf.index());
    if kind == NodeKind::IndexedLeaf {
        let triangles = &prepared.indexed_leaves[index].triangles;
        packed_ids::unpack(u32x16::load_array_ref(simd, triangles))
    } else if kind == NodeKind::ScatteredLeaf {
        u32x16::load_array_ref(simd, &prepared.scattered_leaves[index].ids)
    } else {
        u32x16::load_array_ref(simd, &prepared.plain_leaves[index].ids)
    }
}

/// Up to sixteen triangles.
pub(crate) trait Leaf: Sized {
    /// A vertex of the first triangle.
    fn first_vertex(&self) -> [f32; 3];

    /// The rows of the three corners of each triangle, their columns, counted from the tile's first, and their keys, as
    /// [`LocalProjection::project`] finds them.
    fn project<S: Simd>(
        &self,
        simd: S,
        frustum: &TileFrustum,
        local: &LocalProjection,
    ) -> [[f32x16<S>; 3]; 3];

    /// The leaf of a mesh where an instance puts it.
    fn placed<S: Simd>(&self, simd: S, placement: &Placement) -> Self;

    /// Stores x, y, z of the first, second and third corners of some triangles, one triangle behind the other from
    /// index `at` on. What is behind them, up to sixteen, has no meaning then.
    fn gather<S: Simd, const ROOM: usize>(
        &self,
        simd: S,
        which: mask32x16<S>,
        to: &mut [[f32; ROOM]; 9],
        at: usize,
    );
}

impl Leaf for IndexedLeaf {
    #[inline(always)]
    fn first_vertex(&self) -> [f32; 3] {
        self.vertices.map(|row| row[0])
    }

    #[inline(always)]
    fn project<S: Simd>(
        &self,
        simd: S,
        frustum: &TileFrustum,
        local: &LocalProjection,
    ) -> [[f32x16<S>; 3]; 3] {
        let [x, y, z] = &self.vertices;
        let found = local.project(simd, frustum, [x, y, z]);
        let [a, b, c] = PackedShuffles::new(u32x16::load_array_ref(simd, &self.triangles)).unpack();
        each!(k in [0, 1, 2] => [a.of(found[k]), b.of(found[k]), c.of(found[k])])
    }

    #[inline(always)]
    fn placed<S: Simd>(&self, simd: S, placement: &Placement) -> Self {
        let vertices = placement.sixteen_positions(simd, &self.vertices);
        IndexedLeaf { vertices, ..*self }
    }

    #[inline(always)]
    fn gather<S: Simd, const ROOM: usize>(
        &self,
        simd: S,
        which: mask32x16<S>,
        to: &mut [[f32; ROOM]; 9],
        at: usize,
    ) {
        let triangles = u32x16::load_array_ref(simd, &self.triangles);
        let corners = PackedShuffles::new(triangles).compress(which).unpack();
        for (axis, row) in self.vertices.iter().enumerate() {
            let row = f32x16::load_array_ref(simd, row);
            for (corner, shuffle) in corners.into_iter().enumerate() {
                let to = &mut to[3 * corner + axis][at..at + LEAF];
                shuffle.of(row).store_slice(to);
            }
        }
    }
}

impl Leaf for PlainLeaf {
    #[inline(always)]
    fn first_vertex(&self) -> [f32; 3] {
        [self.corners[0][0], self.corners[1][0], self.corners[2][0]]
    }

    #[inline(always)]
    fn project<S: Simd>(
        &self,
        simd: S,
        frustum: &TileFrustum,
        local: &LocalProjection,
    ) -> [[f32x16<S>; 3]; 3] {
        let [ax, ay, az, bx, by, bz, cx, cy, cz] = &self.corners;
        let a = local.project(simd, frustum, [ax, ay, az]);
        let b = local.project(simd, frustum, [bx, by, bz]);
        let c = local.project(simd, frustum, [cx, cy, cz]);
        each!(k in [0, 1, 2] => [a[k], b[k], c[k]])
    }

    #[inline(always)]
    fn placed<S: Simd>(&self, simd: S, placement: &Placement) -> Self {
        let mut corners = [[0.0; LEAF]; 9];
        let of_mesh = self.corners.as_chunks::<3>().0;
        for (corner, placed) in of_mesh.iter().zip(corners.as_chunks_mut().0) {
            *placed = placement.sixteen_positions(simd, corner);
        }
        PlainLeaf { corners, ..*self }
    }

    #[inline(always)]
    fn gather<S: Simd, const ROOM: usize>(
        &self,
        simd: S,
        which: mask32x16<S>,
        to: &mut [[f32; ROOM]; 9],
        at: usize,
    ) {
        let compression = Compression::new(which);
        for (row, to) in self.corners.iter().zip(to) {
            compression.store(f32x16::load_array_ref(simd, row), &mut to[at..at + LEAF]);
        }
    }
}
