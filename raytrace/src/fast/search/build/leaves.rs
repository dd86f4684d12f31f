//! Leaves of triangles.

use super::prim_ref::{CornerReader, PrimRef, place_bits};
use crate::fast::search::packed_ids;
use crate::fast::search::tree::{IndexedLeaf, LEAF, NodeKind, PlainLeaf, ScatteredLeaf};
use bothways_common::Mesh;
use bothways_common::engine::simd::{Level, Simd, SimdBase, SimdMask, dispatch, mask32x16, u32x16};
use bothways_common::scene::are_same_corners;
use glam::Vec3;

/// The corners of the triangles of a full leaf.
const CORNERS: usize = 3 * LEAF;

/// The corners of some triangles, one triangle after another, and which of them are the same vertex. A vertex is known by
/// its index in a mesh, one word, or by the bits of its coordinates, three words.
struct Corners<const WORDS: usize> {
    words: [[u32; CORNERS]; WORDS],
    /// For each corner, the first corner with the same vertex.
    firsts: [u8; CORNERS],
    /// Bit `k` is set if corner `k` is the first with its vertex.
    are_first: u64,
}

impl<const WORDS: usize> Corners<WORDS> {
    /// The corners of some triangles; `None` if they have more vertices than a leaf has room for.
    fn new(
        prims: &[PrimRef],
        level: Level,
        mut of: impl FnMut(&PrimRef) -> [[u32; WORDS]; 3],
    ) -> Option<Self> {
        let mut corners =
            Corners { words: [[0; CORNERS]; WORDS], firsts: [0; CORNERS], are_first: 0 };
        // All corners are read first, so that several fetches from memory overlap.
        for (triangle, prim) in prims.iter().enumerate() {
            for (k, vertex) in of(prim).into_iter().enumerate() {
                for (words, word) in corners.words.iter_mut().zip(vertex) {
                    words[3 * triangle + k] = word;
                }
            }
        }
        dispatch!(level, simd => corners.find_firsts(simd, prims.len())).then_some(corners)
    }

    /// Finds the first corner with each vertex. Returns whether the vertices are few enough for a leaf.
    ///
    /// Each corner is compared with all before it, whatever was found for those: so the machine works on several at a time.
    #[inline(always)]
    fn find_firsts<S: Simd>(&mut self, simd: S, triangles: usize) -> bool {
        for triangle in 0..triangles {
            for corner in 3 * triangle..3 * triangle + 3 {
                let mut same = 0;
                for start in (0..=corner).step_by(16) {
                    let mut are_same = mask32x16::splat(simd, true);
                    for words in &self.words {
                        let these = u32x16::from_slice(simd, &words[start..start + 16]);
                        are_same &= these.simd_eq(u32x16::splat(simd, words[corner]));
                    }
                    same |= are_same.to_bitmask() << start;
                }
                // It is the same as itself, or one before it.
                let first = same.trailing_zeros();
                self.are_first |= 1 << first;
                self.firsts[corner] = u8::try_from(first).expect("corners are few");
            }
            if self.are_first.count_ones() as usize > LEAF {
                return false;
            }
        }
        true
    }

    /// The leaf of these triangles, without their ids; `position_of` finds where a vertex is.
    fn leaf(&self, prims: &[PrimRef], position_of: impl Fn([u32; WORDS]) -> Vec3) -> IndexedLeaf {
        // For each first corner, the index of its vertex.
        let mut indices = [0; CORNERS];
        let (mut vertices, mut count) = ([[0.0; LEAF]; 3], 0);
        // Vertices are numbered in the order of their first corners.
        let mut are_left = self.are_first;
        while are_left != 0 {
            let corner = are_left.trailing_zeros() as usize;
            are_left &= are_left - 1;
            let position = position_of(self.words.each_ref().map(|words| words[corner]));
            for (row, coordinate) in vertices.iter_mut().zip(position.to_array()) {
                row[count] = coordinate;
            }
            indices[corner] = u32::try_from(count).expect("there are sixteen at most");
            count += 1;
        }
        for row in &mut vertices {
            let first = row[0];
            row[count..].fill(first);
        }
        let triangles = std::array::from_fn(|lane| {
            let from = if lane < prims.len() { lane } else { 0 };
            let [a, b, c] = [0, 1, 2].map(|k| indices[usize::from(self.firsts[3 * from + k])]);
            a | b << 4 | c << 8
        });
        IndexedLeaf { vertices, triangles }
    }
}

impl Corners<1> {
    /// Vertices by their indices in a mesh, whose first triangle has this id.
    fn by_index(prims: &[PrimRef], (mesh, first_id): (&Mesh, u32), level: Level) -> Option<Self> {
        let of = |prim: &PrimRef| mesh.triangles()[(prim.id() - first_id) as usize];
        Corners::new(prims, level, |prim| of(prim).map(|index| [index]))
    }
}

impl Corners<3> {
    /// Vertices by their places: those with equal coordinates are the same vertex.
    fn by_place(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> Option<Self> {
        Corners::new(prims, level, |prim| corners.of(prim.id()).map(place_bits))
    }
}

/// The kind of leaf that has room for the vertices of triangles, and for their ids.
pub(super) fn kind_of(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> NodeKind {
    let by_index = corners.mesh_of(prims).and_then(|of| Corners::by_index(prims, of, level));
    if by_index.is_none() && Corners::by_place(prims, corners, level).is_none() {
        NodeKind::PlainLeaf
    } else if packed_ids::can_be_packed(prims.iter().map(PrimRef::id)) {
        NodeKind::IndexedLeaf
    } else {
        NodeKind::ScatteredLeaf
    }
}

/// Orders the triangles of a leaf so that duplicates, which are never visible, come last: a duplicate has the same
/// corners as a triangle with a smaller id. Returns the number of distinct triangles.
pub(super) fn put_duplicates_last(prims: &mut [PrimRef], corners: &mut CornerReader) -> usize {
    let keys = box_keys(prims);
    if (1..prims.len()).all(|k| !keys[..k].contains(&keys[k])) {
        return prims.len();
    }
    prims.sort_unstable_by_key(PrimRef::id);
    let mut keys = box_keys(prims);
    let mut distinct = 0;
    for k in 0..prims.len() {
        // The boxes of most pairs differ, so that no corner is looked at.
        let mut corners_of = |n: usize| corners.of(prims[n].id());
        let is_duplicate_of =
            |n: usize| keys[n] == keys[k] && are_same_corners(&corners_of(n), &corners_of(k));
        if !(0..distinct).any(is_duplicate_of) {
            prims[distinct..=k].rotate_right(1);
            keys[distinct..=k].rotate_right(1);
            distinct += 1;
        }
    }
    distinct
}

/// Keys of the boxes of the triangles of a leaf: triangles with the same corners have the same key.
fn box_keys(prims: &[PrimRef]) -> [u32; LEAF] {
    let key = |prim: &PrimRef| {
        let [x, y, z, _, u, v, w, _] = prim.0.0;
        let bits = [x, y, z, u, v, w].into_iter().map(f32::to_bits);
        bits.fold(0_u32, |key, bits| (key.rotate_left(5) ^ bits).wrapping_mul(0x9E37_79B9))
    };
    let mut keys = [0; LEAF];
    for (to, prim) in keys.iter_mut().zip(prims) {
        *to = key(prim);
    }
    keys
}

/// The leaf of some triangles with few distinct vertices, and with ids that can be packed.
pub(super) fn indexed_leaf(
    prims: &[PrimRef],
    corners: &mut CornerReader,
    level: Level,
) -> IndexedLeaf {
    let mut leaf = without_ids(prims, corners, level);
    for (triangle, id) in leaf.triangles.iter_mut().zip(packed_ids::pack(&ids(prims))) {
        *triangle |= id;
    }
    leaf
}

/// The leaf of some triangles with few distinct vertices, whatever their ids.
pub(super) fn scattered_leaf(
    prims: &[PrimRef],
    corners: &mut CornerReader,
    level: Level,
) -> ScatteredLeaf {
    ScatteredLeaf { indexed: without_ids(prims, corners, level), ids: ids(prims) }
}

/// The leaf of some triangles with few distinct vertices, with their vertices alone.
fn without_ids(prims: &[PrimRef], corners: &mut CornerReader, level: Level) -> IndexedLeaf {
    // If the indices alone show few vertices, only the positions of those few are read.
    if let Some((mesh, first_id)) = corners.mesh_of(prims)
        && let Some(found) = Corners::by_index(prims, (mesh, first_id), level)
    {
        // Adding 0 turns −0 into 0, as `place_bits` does.
        return found.leaf(prims, |[index]| mesh.positions()[index as usize] + 0.0);
    }
    let found = Corners::by_place(prims, corners, level).expect("there are few");
    found.leaf(prims, |bits| Vec3::from_array(bits.map(f32::from_bits)))
}

/// The leaf of any triangles.
pub(super) fn plain_leaf(prims: &[PrimRef], corners: &mut CornerReader) -> PlainLeaf {
    let mut leaf = PlainLeaf { corners: [[0.0; LEAF]; 9], ids: ids(prims) };
    for (lane, id) in leaf.ids.into_iter().enumerate() {
        for (corner, position) in corners.of(id).into_iter().enumerate() {
            for axis in 0..3 {
                leaf.corners[3 * corner + axis][lane] = position[axis];
            }
        }
    }
    leaf
}

/// The ids of a leaf's primitives; unused lanes repeat the first.
pub(super) fn ids<const MOST: usize>(prims: &[PrimRef]) -> [u32; MOST] {
    std::array::from_fn(|lane| prims.get(lane).unwrap_or(&prims[0]).id())
}
