//! Leaves of triangles.

use super::super::tree::{LEAF, Patch, Triangles};
use super::items::{Corners, Item};
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, best_level, dispatch, f32x16};
use bothways_common::scene::are_same_corners;
use glam::Vec3;

/// The triangles of a patch, by their different vertices.
pub(super) struct Gathered {
    vertices: [[f32; LEAF]; 3],
    vertex_count: usize,
    /// Of each triangle the numbers of its vertices.
    corners: [[u8; 3]; LEAF],
}

impl Gathered {
    /// Vertices are the same where their coordinates are equal. `None` if there are too many.
    pub(super) fn new(items: &[Item], corners: &mut Corners) -> Option<Gathered> {
        let mut gathered =
            Gathered { vertices: [[0.0; LEAF]; 3], vertex_count: 0, corners: [[0; 3]; LEAF] };
        dispatch!(best_level(), simd => gathered.add(simd, items, corners))?;
        Some(gathered)
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, items: &[Item], corners: &mut Corners) -> Option<()> {
        for (lane, item) in items.iter().enumerate() {
            let [a, b, c] = corners.of(item.id());
            let numbers = [self.number(simd, a)?, self.number(simd, b)?, self.number(simd, c)?];
            self.corners[lane] = numbers;
        }
        Some(())
    }

    /// The number of a vertex, which is added if it is new and there is room for it.
    #[inline(always)]
    fn number<S: Simd>(&mut self, simd: S, vertex: Vec3) -> Option<u8> {
        let [x, y, z] = &mut self.vertices;
        let same = f32x16::load_array_ref(simd, x).simd_eq(f32x16::splat(simd, vertex.x))
            & f32x16::load_array_ref(simd, y).simd_eq(f32x16::splat(simd, vertex.y))
            & f32x16::load_array_ref(simd, z).simd_eq(f32x16::splat(simd, vertex.z));
        // Beyond the last is the origin.
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

    fn patch(&self, items: &[Item]) -> Patch {
        let vertices = self.vertices.map(|row| {
            std::array::from_fn(|k| if k < self.vertex_count { row[k] } else { row[0] })
        });
        let mut patch = Patch { vertices, corners: [[0; 4]; LEAF], ids: [0; LEAF] };
        for lane in 0..LEAF {
            let from = if lane < items.len() { lane } else { 0 };
            let [a, b, c] = self.corners[from].map(|number| 4 * number);
            patch.corners[lane] = [a, b, c, 0];
            patch.ids[lane] = items[from].id();
        }
        patch
    }
}

/// Orders the triangles of a leaf so that those which are the same as one with a smaller id, and so never seen, come
/// last; tells how many others there are.
pub(super) fn put_twins_last(items: &mut [Item], corners: &mut Corners) -> usize {
    let key = |item: &Item| {
        let (low, high) = (item.low.truncate(), item.high.truncate());
        let bits = low.to_array().into_iter().chain(high.to_array()).map(f32::to_bits);
        bits.fold(0_u32, |key, bits| (key.rotate_left(5) ^ bits).wrapping_mul(0x9E37_79B9))
    };
    let mut keys = [0; LEAF];
    for (to, item) in keys.iter_mut().zip(&*items) {
        *to = key(item);
    }
    if (1..items.len()).all(|k| !keys[..k].contains(&keys[k])) {
        return items.len();
    }
    items.sort_unstable_by_key(Item::id);
    let mut different = 0;
    for k in 0..items.len() {
        let all = corners.of(items[k].id());
        let is_twin = |other: &Item| are_same_corners(&corners.of(other.id()), &all);
        if !items[..different].iter().any(is_twin) {
            items[different..=k].rotate_right(1);
            different += 1;
        }
    }
    different
}

/// The leaf of some triangles with few different vertices.
pub(super) fn patch(items: &[Item], corners: &mut Corners) -> Patch {
    Gathered::new(items, corners).expect("there are few").patch(items)
}

/// The leaf of some triangles.
pub(super) fn triangles(items: &[Item], corners: &mut Corners) -> Triangles {
    let mut leaf = Triangles { corners: [[0.0; LEAF]; 9], ids: [0; LEAF] };
    for lane in 0..LEAF {
        let id = items.get(lane).unwrap_or(&items[0]).id();
        leaf.ids[lane] = id;
        for (corner, position) in corners.of(id).into_iter().enumerate() {
            for axis in 0..3 {
                leaf.corners[3 * corner + axis][lane] = position[axis];
            }
        }
    }
    leaf
}
