//! Triangles side by side, one a lane: gathered, sorted by size, and handed on sixteen at a time.

use super::vertices::Vertex;
use bothways_common::engine::simd::{
    Bytes, Compression, Select, Simd, SimdBase, SimdMask, f32x16, i32x4, i32x16, mask32x16, u32x16,
};

/// Sixteen lanes, and room for sixteen more.
const ROOM: usize = 32;

/// Vertices of triangles that wait to be set up: the first sixteen together.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    ids: [u32; ROOM],
    /// Rows, columns and keys of the three corners.
    corners: [[[i32; ROOM]; 3]; 3],
    /// The flags that all three corners have.
    flags: [i32; ROOM],
    count: usize,
}

impl Lanes {
    pub(super) const fn new() -> Lanes {
        let corners = [[[0; ROOM]; 3]; 3];
        Lanes { ids: [0; ROOM], corners, flags: [0; ROOM], count: 0 }
    }

    /// How many triangles wait, at most sixteen at a time.
    pub(super) fn count(&self) -> usize {
        self.count.min(16)
    }

    /// Fills the lanes with `count` triangles, at most sixteen: ids and corners.
    #[inline(always)]
    pub(super) fn fill<S: Simd>(
        &mut self,
        simd: S,
        count: usize,
        mut triangle: impl FnMut(usize) -> (u32, [Vertex; 3]),
    ) {
        self.count = count.min(16);
        for first in (0..self.count).step_by(4) {
            // Lanes behind the last triangle repeat it, and are not used.
            let last = self.count - 1;
            let mut next = |lane: usize| triangle(last.min(first + lane));
            // Written out, so that `next` is certainly inlined.
            let four = [next(0), next(1), next(2), next(3)];
            self.ids[first..first + 4].copy_from_slice(&four.map(|(id, _)| id));
            let mut common = i32x4::splat(simd, -1);
            for corner in 0..3 {
                let [row, column, key, flags] =
                    transposed(simd, four.map(|(_, corners)| corners[corner]));
                let [rows, columns, keys] = &mut self.corners[corner];
                row.store_slice(&mut rows[first..first + 4]);
                column.store_slice(&mut columns[first..first + 4]);
                key.store_slice(&mut keys[first..first + 4]);
                common &= flags;
            }
            common.store_slice(&mut self.flags[first..first + 4]);
        }
    }

    /// Adds some triangles of `from` behind those that wait, which are fewer than sixteen.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&mut self, simd: S, from: &Lanes, which: mask32x16<S>) {
        let at = self.count & 15;
        let compression = Compression::new(which);
        let add = |from: &[i32; ROOM], to: &mut [i32; ROOM]| {
            compression.store(load(simd, from), &mut to[at..at + 16]);
        };
        for (from, to) in from.corners.iter().zip(&mut self.corners) {
            add(&from[0], &mut to[0]);
            add(&from[1], &mut to[1]);
            add(&from[2], &mut to[2]);
        }
        add(&from.flags, &mut self.flags);
        compression.store(from.ids(simd), &mut self.ids[at..at + 16]);
        self.count = at + which.to_bitmask().count_ones() as usize;
    }

    /// Whether sixteen triangles wait.
    pub(super) fn are_full(&self) -> bool {
        self.count >= 16
    }

    /// Forgets the first sixteen.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        for corner in &mut self.corners {
            corner.iter_mut().for_each(|numbers| numbers.copy_within(16.., 0));
        }
        self.flags.copy_within(16.., 0);
        self.ids.copy_within(16.., 0);
        self.count = self.count.saturating_sub(16);
    }

    /// The ids of all sixteen lanes.
    #[inline(always)]
    pub(super) fn ids<S: Simd>(&self, simd: S) -> u32x16<S> {
        u32x16::from_slice(simd, &self.ids[..16])
    }

    /// The ids of some lanes.
    pub(super) fn ids_of(&self, lanes: u64) -> impl Iterator<Item = u32> {
        lanes_of(lanes).map(|lane| self.ids[lane])
    }

    /// The fixed-point rows (axis 0) or columns (axis 1) of the three corners.
    #[inline(always)]
    pub(super) fn places<S: Simd>(&self, simd: S, axis: usize) -> [i32x16<S>; 3] {
        std::array::from_fn(|corner| load(simd, &self.corners[corner][axis]))
    }

    /// The three corners' keys.
    #[inline(always)]
    pub(super) fn keys<S: Simd>(&self, simd: S) -> [f32x16<S>; 3] {
        std::array::from_fn(|corner| load(simd, &self.corners[corner][2]).bitcast())
    }

    /// The flags that the corners of a triangle share.
    #[inline(always)]
    pub(super) fn flags<S: Simd>(&self, simd: S) -> i32x16<S> {
        load(simd, &self.flags)
    }

    /// The lanes that hold a triangle.
    #[inline(always)]
    pub(super) fn used<S: Simd>(&self, simd: S) -> mask32x16<S> {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "up to 16")]
        let count = i32x16::splat(simd, self.count() as i32);
        i32x16::load_array(simd, LANES).simd_lt(count)
    }
}

/// The keys to store: new ones where the mask says so, stored ones elsewhere. `Bits` are whole numbers of as many lanes.
///
/// They are chosen as such bits. For AVX2, the compiler makes a masked store of a choice between floating-point numbers one of
/// which comes from where the other goes, and some processors take as long for that as for all else that a sample needs.
#[inline(always)]
pub(super) fn keys_to_store<Bits: Bytes, Keys: Bytes<Bytes = Bits::Bytes>>(
    replaces: impl Select<Bits>,
    new: Keys,
    stored: Keys,
) -> Keys {
    replaces.select(new.bitcast(), stored.bitcast()).bitcast()
}

/// A row, a column or a number of samples in all lanes.
#[inline(always)]
pub(super) fn in_all_lanes<S: Simd>(simd: S, samples: usize) -> i32x16<S> {
    i32x16::splat(simd, i32::try_from(samples).expect("a side has at most 65,536 samples"))
}

/// The numbers of the lanes that are set in a mask.
pub(super) fn lanes_of(mask: u64) -> impl Iterator<Item = usize> {
    let mut rest = mask & 0xffff;
    std::iter::from_fn(move || {
        let lane = rest.trailing_zeros() as usize;
        let is_one = rest != 0;
        rest &= rest.wrapping_sub(1);
        is_one.then_some(lane)
    })
}

/// The numbers of the lanes.
const LANES: [i32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

#[inline(always)]
fn load<S: Simd>(simd: S, numbers: &[i32; ROOM]) -> i32x16<S> {
    i32x16::from_slice(simd, &numbers[..16])
}

/// Rows, columns, keys and flags of four vertices.
#[inline(always)]
fn transposed<S: Simd>(simd: S, vertices: [Vertex; 4]) -> [i32x4<S>; 4] {
    let [a, b, c, d] = vertices.map(|vertex| i32x4::load_array(simd, vertex));
    let (even, odd) = (a.zip_low(c), b.zip_low(d));
    let (even_rest, odd_rest) = (a.zip_high(c), b.zip_high(d));
    [
        even.zip_low(odd),
        even.zip_high(odd),
        even_rest.zip_low(odd_rest),
        even_rest.zip_high(odd_rest),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{SimdSplit, dispatch, levels, u32x8};

    #[test]
    fn keys_are_chosen_bit_by_bit() {
        let random = &mut fastrand::Rng::with_seed(5);
        for level in levels() {
            for _ in 0..500 {
                // All bits of all kinds of numbers.
                let new: [f32; 16] = std::array::from_fn(|_| f32::from_bits(random.u32(..)));
                let stored: [f32; 16] = std::array::from_fn(|_| f32::from_bits(random.u32(..)));
                let replaces = random.u16(..);
                let expected = |lane: usize| {
                    if replaces >> lane & 1 == 1 { new[lane] } else { stored[lane] }
                };
                let expected: [u32; 16] = std::array::from_fn(|lane| expected(lane).to_bits());
                dispatch!(level, simd => {
                    let mask = mask32x16::from_bitmask(simd, replaces.into());
                    let (new, stored) =
                        (f32x16::load_array(simd, new), f32x16::load_array(simd, stored));
                    let keys = keys_to_store::<u32x16<_>, _>(mask, new, stored).to_array();
                    assert_eq!(keys.map(f32::to_bits), expected);
                    let (left, right) = simd.split_mask32x16(mask);
                    let ((new, others), (stored, rest)) = (new.split(), stored.split());
                    let keys = keys_to_store::<u32x8<_>, _>(left, new, stored).to_array();
                    assert_eq!(keys.map(f32::to_bits), expected[..8]);
                    let keys = keys_to_store::<u32x8<_>, _>(right, others, rest).to_array();
                    assert_eq!(keys.map(f32::to_bits), expected[8..]);
                });
            }
        }
    }
}
