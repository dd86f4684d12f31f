//! Leaves of triangles.

use super::prim_ref::{CornerReader, PrimRef};
use crate::fast::search::tree::{IndexedLeaf, LEAF, PlainLeaf};
use bothways_common::Mesh;
use bothways_common::engine::simd::{Level, Simd, SimdBase, SimdMask, dispatch, f32x16, u32x16};
use bothways_common::scene::are_same_corners;
use glam::Vec3;

/// The distinct vertices of some triangles, and each triangle as the numbers of its vertices.
struct VertexSet {
    vertices: [[f32; LEAF]; 3],
    vertex_count: usize,
    /// For each triangle, the numbers of its vertices.
    corners: [[u8; 3]; LEAF],
}

/// The distinct vertices as indices of a mesh, and each triangle as numbers among them.
struct IndexSet {
    indices: [u32; LEAF],
    index_count: usize,
    corners: [[u8; 3]; LEAF],
}

/// Whether there are few enough vertices for an indexed leaf.
pub(super) fn share_vertices(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> bool {
    let by_index = corners.mesh_of(prims).and_then(|of| IndexSet::new(prims, of, level));
    by_index.is_some() || VertexSet::by_place(prims, corners, level).is_some()
}

impl IndexSet {
    /// The vertices of some triangles of a mesh, where its first triangle has this id; `None` if there are too many.
    fn new(prims: &[PrimRef], (mesh, first_id): (&Mesh, u32), level: Level) -> Option<IndexSet> {
        let mut set = IndexSet { indices: [0; LEAF], index_count: 0, corners: [[0; 3]; LEAF] };
        let of = |prim: &PrimRef| mesh.triangles()[(prim.id() - first_id) as usize];
        dispatch!(level, simd => set.add(simd, prims, of))?;
        Some(set)
    }

    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        prims: &[PrimRef],
        of: impl Fn(&PrimRef) -> [u32; 3],
    ) -> Option<()> {
        for (numbers, prim) in self.corners.iter_mut().zip(prims) {
            for (number, index) in numbers.iter_mut().zip(of(prim)) {
                let same =
                    u32x16::load_array_ref(simd, &self.indices).simd_eq(u32x16::splat(simd, index));
                // The slots after the last index hold 0: index 0 is found in its own, or in the first of these, which becomes
                // its own.
                let at = (same.to_bitmask().trailing_zeros() as usize).min(self.index_count);
                if at == self.index_count {
                    *self.indices.get_mut(at)? = index;
                    self.index_count += 1;
                }
                *number = u8::try_from(at).ok()?;
            }
        }
        Some(())
    }
}

impl VertexSet {
    /// The vertices of some triangles; `None` if there are too many. They are told apart by their indices, if they are few
    /// then, and otherwise by their places.
    fn new(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> Option<VertexSet> {
        if let Some((mesh, first_id)) = corners.mesh_of(prims)
            && let Some(set) = IndexSet::new(prims, (mesh, first_id), level)
        {
            let IndexSet { indices, index_count, corners } = set;
            let mut vertices = [[0.0; LEAF]; 3];
            for (lane, index) in indices[..index_count].iter().enumerate() {
                let place = mesh.positions()[*index as usize].to_array();
                for (row, coordinate) in vertices.iter_mut().zip(place) {
                    row[lane] = coordinate;
                }
            }
            return Some(VertexSet { vertices, vertex_count: index_count, corners });
        }
        VertexSet::by_place(prims, corners, level)
    }

    fn by_place(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> Option<VertexSet> {
        let mut set =
            VertexSet { vertices: [[0.0; LEAF]; 3], vertex_count: 0, corners: [[0; 3]; LEAF] };
        dispatch!(level, simd => set.add(simd, prims, corners))?;
        Some(set)
    }

    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        simd: S,
        prims: &[PrimRef],
        corners: &mut CornerReader,
    ) -> Option<()> {
        for (lane, prim) in prims.iter().enumerate() {
            let [a, b, c] = corners.of(prim.id());
            let numbers = [self.number(simd, a)?, self.number(simd, b)?, self.number(simd, c)?];
            self.corners[lane] = numbers;
        }
        Some(())
    }

    /// The number of a vertex. A new vertex is added if there is room for it.
    #[inline(always)]
    fn number<S: Simd>(&mut self, simd: S, vertex: Vec3) -> Option<u8> {
        let [x, y, z] = &mut self.vertices;
        let same = f32x16::load_array_ref(simd, x).simd_eq(f32x16::splat(simd, vertex.x))
            & f32x16::load_array_ref(simd, y).simd_eq(f32x16::splat(simd, vertex.y))
            & f32x16::load_array_ref(simd, z).simd_eq(f32x16::splat(simd, vertex.z));
        // The slots after the last vertex hold the origin.
        let number = (same.to_bitmask().trailing_zeros() as usize).min(self.vertex_count);
        if number == self.vertex_count {
            if number == LEAF {
                return None;
            }
            [x[number], y[number], z[number]] = vertex.to_array();
            self.vertex_count += 1;
        }
        u8::try_from(number).ok()
    }

    fn leaf(&self, prims: &[PrimRef]) -> IndexedLeaf {
        let vertices = self.vertices.map(|row| {
            std::array::from_fn(|k| if k < self.vertex_count { row[k] } else { row[0] })
        });
        let mut leaf = IndexedLeaf { vertices, corners: [[0; 4]; LEAF], ids: [0; LEAF] };
        for lane in 0..LEAF {
            let from = if lane < prims.len() { lane } else { 0 };
            let [a, b, c] = self.corners[from].map(|number| 4 * number);
            leaf.corners[lane] = [a, b, c, 0];
            leaf.ids[lane] = prims[from].id();
        }
        leaf
    }
}

/// Orders the triangles of a leaf so that duplicates, which are never visible, come last: a duplicate has the same
/// corners as a triangle with a smaller id. Returns the number of distinct triangles.
pub(super) fn put_duplicates_last(prims: &mut [PrimRef], corners: &mut CornerReader) -> usize {
    let key = |prim: &PrimRef| {
        let [x, y, z, _, u, v, w, _] = prim.0.0;
        let bits = [x, y, z, u, v, w].into_iter().map(f32::to_bits);
        bits.fold(0_u32, |key, bits| (key.rotate_left(5) ^ bits).wrapping_mul(0x9E37_79B9))
    };
    let mut keys = [0; LEAF];
    for (to, prim) in keys.iter_mut().zip(&*prims) {
        *to = key(prim);
    }
    if (1..prims.len()).all(|k| !keys[..k].contains(&keys[k])) {
        return prims.len();
    }
    prims.sort_unstable_by_key(PrimRef::id);
    let mut distinct = 0;
    for k in 0..prims.len() {
        let all = corners.of(prims[k].id());
        let is_duplicate = |other: &PrimRef| are_same_corners(&corners.of(other.id()), &all);
        if !prims[..distinct].iter().any(is_duplicate) {
            prims[distinct..=k].rotate_right(1);
            distinct += 1;
        }
    }
    distinct
}

/// The leaf of some triangles with few distinct vertices.
pub(super) fn indexed_leaf(
    prims: &[PrimRef],
    corners: &mut CornerReader,
    level: Level,
) -> IndexedLeaf {
    VertexSet::new(prims, corners, level).expect("there are few").leaf(prims)
}

/// The leaf of any triangles.
pub(super) fn plain_leaf(prims: &[PrimRef], corners: &mut CornerReader) -> PlainLeaf {
    let mut leaf = PlainLeaf { corners: [[0.0; LEAF]; 9], ids: [0; LEAF] };
    for lane in 0..LEAF {
        let id = prims.get(lane).unwrap_or(&prims[0]).id();
        leaf.ids[lane] = id;
        for (corner, position) in corners.of(id).into_iter().enumerate() {
            for axis in 0..3 {
                leaf.corners[3 * corner + axis][lane] = position[axis];
            }
        }
    }
    leaf
}
