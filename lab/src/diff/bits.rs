//! Sixty-four values as the bits of a number.

use crate::common::engine::simd::{Simd, SimdBase, SimdMask, best_level, dispatch, u8x64};

/// A bit for each of up to 64 values in memory, the first one lowest, by the vectors of this processor.
pub(super) fn packed_bits(values: &[bool]) -> u64 {
    dispatch!(best_level(), simd => packed(simd, values))
}

/// A bit for each of up to 64 values in memory, the first one lowest.
#[inline(always)]
pub(super) fn packed<S: Simd>(simd: S, values: &[bool]) -> u64 {
    let Some(values) = values.first_chunk::<64>() else {
        return bits(values.iter().copied());
    };
    let mut bytes = [0; 64];
    for (byte, value) in bytes.iter_mut().zip(values) {
        *byte = u8::from(*value);
    }
    u8x64::from_slice(simd, &bytes).simd_gt(0).to_bitmask()
}

/// A bit for each of up to 64 values, the first one lowest.
pub(super) fn bits(values: impl Iterator<Item = bool>) -> u64 {
    values.enumerate().fold(0, |bits, (at, value)| bits | u64::from(value) << at)
}
