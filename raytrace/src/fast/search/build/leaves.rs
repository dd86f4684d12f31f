//! Leaves of triangles.

use super::prim_ref::{CornerReader, PrimRef, place_bits};
use crate::fast::search::tree::{IndexedLeaf, LEAF, PlainLeaf};
use bothways_common::Mesh;
use bothways_common::engine::simd::{Level, Simd, SimdBase, SimdMask, dispatch, mask32x16, u32x16};
use bothways_common::scene::are_same_corners;

/// The distinct vertices of some triangles, and each triangle as the numbers of its vertices. A vertex is known by its
/// index in a mesh, one word, or by the bits of its coordinates, three words.
struct VertexSet<const WORDS: usize> {
    vertices: [[u32; LEAF]; WORDS],
    vertex_count: usize,
    /// For each triangle, the numbers of its vertices.
    corners: [[u8; 3]; LEAF],
}

impl<const WORDS: usize> VertexSet<WORDS> {
    /// The vertices of some triangles; `None` if there are too many.
    fn new(
        prims: &[PrimRef],
        level: Level,
        mut of: impl FnMut(&PrimRef) -> [[u32; WORDS]; 3],
    ) -> Option<Self> {
        let mut set =
            VertexSet { vertices: [[0; LEAF]; WORDS], vertex_count: 0, corners: [[0; 3]; LEAF] };
        dispatch!(level, simd => {
            for (lane, prim) in prims.iter().enumerate() {
                let [a, b, c] = of(prim);
                let numbers = [set.number(simd, a)?, set.number(simd, b)?, set.number(simd, c)?];
                set.corners[lane] = numbers;
            }
            Some(())
        })?;
        Some(set)
    }

    /// The number of a vertex. A new vertex is added if there is room for it.
    #[inline(always)]
    fn number<S: Simd>(&mut self, simd: S, vertex: [u32; WORDS]) -> Option<u8> {
        let mut same = mask32x16::splat(simd, true);
        for (row, word) in self.vertices.iter().zip(vertex) {
            same &= u32x16::load_array_ref(simd, row).simd_eq(u32x16::splat(simd, word));
        }
        // The slots after the last vertex hold zeros: a vertex of zeros is found in its own, or in the first of these,
        // which becomes its own.
        let number = (same.to_bitmask().trailing_zeros() as usize).min(self.vertex_count);
        if number == self.vertex_count {
            if number == LEAF {
                return None;
            }
            for (row, word) in self.vertices.iter_mut().zip(vertex) {
                row[number] = word;
            }
            self.vertex_count += 1;
        }
        u8::try_from(number).ok()
    }
}

impl VertexSet<1> {
    /// Vertices by their indices in a mesh, whose first triangle has this id.
    fn by_index(prims: &[PrimRef], (mesh, first_id): (&Mesh, u32), level: Level) -> Option<Self> {
        let of = |prim: &PrimRef| mesh.triangles()[(prim.id() - first_id) as usize];
        VertexSet::new(prims, level, |prim| of(prim).map(|index| [index]))
    }
}

impl VertexSet<3> {
    /// Vertices by their places: those with equal coordinates are the same vertex.
    fn by_place(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> Option<Self> {
        VertexSet::new(prims, level, |prim| corners.of(prim.id()).map(place_bits))
    }

    /// Vertices by their indices, if they are few then, and otherwise by their places.
    fn of(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> Option<Self> {
        if let Some((mesh, first_id)) = corners.mesh_of(prims)
            && let Some(set) = VertexSet::by_index(prims, (mesh, first_id), level)
        {
            let VertexSet { vertices: [indices], vertex_count, corners } = set;
            let mut vertices = [[0; LEAF]; 3];
            for (lane, index) in indices[..vertex_count].iter().enumerate() {
                let place = place_bits(mesh.positions()[*index as usize]);
                for (row, word) in vertices.iter_mut().zip(place) {
                    row[lane] = word;
                }
            }
            return Some(VertexSet { vertices, vertex_count, corners });
        }
        VertexSet::by_place(prims, corners, level)
    }

    fn leaf(&self, prims: &[PrimRef]) -> IndexedLeaf {
        let vertices = self.vertices.map(|row| {
            let row = row.map(f32::from_bits);
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

/// Whether there are few enough vertices for an indexed leaf.
pub(super) fn share_vertices(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> bool {
    let by_index = corners.mesh_of(prims).and_then(|of| VertexSet::by_index(prims, of, level));
    by_index.is_some() || VertexSet::by_place(prims, corners, level).is_some()
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
    VertexSet::of(prims, corners, level).expect("there are few").leaf(prims)
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
