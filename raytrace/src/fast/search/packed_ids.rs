//! The ids of a leaf's triangles, packed in the upper twenty bits of sixteen numbers.
//!
//! Nineteen bits say how much an id is above the leaf's base, a multiple of 2¹⁶. The base divided by that has sixteen bits: the
//! highest bit of each lane.

use super::tree::LEAF;
use bothways_common::engine::simd::{Bytes, Simd, SimdBase, SimdMask, i32x16, u32x16};

/// The lowest bit of an id in a number, and the bit of the base.
const FIRST: u32 = 12;
const HIGHEST: u32 = 31;
/// The lowest bit of an id that is part of the base.
const BASE: u32 = 16;

/// Whether ids lie near enough to each other to be packed: they do up to a difference of 458,752, and do not from 524,288 on.
pub(crate) fn can_be_packed(ids: impl Iterator<Item = u32> + Clone) -> bool {
    let base = base_of(ids.clone());
    ids.max().is_some_and(|largest| largest - base < 1 << (HIGHEST - FIRST))
}

/// Packs ids that are so near to each other. The lower twelve bits are 0.
pub(crate) fn pack(ids: &[u32; LEAF]) -> [u32; LEAF] {
    debug_assert!(can_be_packed(ids.iter().copied()), "{ids:?}");
    let base = base_of(ids.iter().copied());
    let of_base = |lane: usize| (base >> BASE >> lane & 1) << HIGHEST;
    std::array::from_fn(|lane| of_base(lane) | (ids[lane] - base) << FIRST)
}

/// The ids, whatever the lower twelve bits are.
#[inline(always)]
pub(crate) fn unpack<S: Simd>(packed: u32x16<S>) -> u32x16<S> {
    let zero = i32x16::splat(packed.simd, 0);
    let of_base = packed.bitcast::<i32x16<S>>().simd_lt(zero).to_bitmask();
    #[expect(clippy::cast_possible_truncation, reason = "sixteen lanes")]
    let base = (of_base as u32) << BASE;
    ((packed & ((1 << HIGHEST) - 1)) >> FIRST) + base
}

/// The largest multiple of 2¹⁶ that is no more than any id.
fn base_of(ids: impl Iterator<Item = u32>) -> u32 {
    ids.min().unwrap_or(0) >> BASE << BASE
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};

    fn unpacked(packed: [u32; LEAF]) -> Vec<[u32; LEAF]> {
        let at =
            |level| dispatch!(level, simd => unpack(u32x16::load_array(simd, packed)).to_array());
        levels().into_iter().map(at).collect()
    }

    #[test]
    fn ids_can_be_packed_up_to_some_distance() {
        let can_be = |ids: [u32; 2]| can_be_packed(ids.into_iter());
        assert!(can_be([0, 524_287]) && !can_be([0, 524_288]));
        assert!(can_be([524_287, 65_535]) && !can_be([524_288, 65_535]));
        assert!(can_be([65_536, 589_823]) && !can_be([65_536, 589_824]));
        assert!(can_be([u32::MAX - 458_752, u32::MAX]) && !can_be([u32::MAX - 524_288, u32::MAX]));
        assert!(can_be([u32::MAX; 2]));
    }

    #[test]
    fn ids_are_packed_and_unpacked() {
        let mut random = fastrand::Rng::with_seed(20);
        for round in 0..2000 {
            let most = if round % 2 == 0 { 40 } else { 458_752 };
            let least = if round % 4 < 2 { random.u32(..) } else { random.u32(..200_000) };
            let above: [u32; LEAF] = std::array::from_fn(|_| random.u32(0..=most));
            let ids = above.map(|above| least.saturating_add(above));
            let mut packed = pack(&ids);
            for packed in &mut packed {
                assert_eq!(*packed & 4095, 0);
                *packed |= random.u32(..4096);
            }
            for unpacked in unpacked(packed) {
                assert_eq!(unpacked, ids);
            }
        }
    }
}
