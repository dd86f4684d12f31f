//! Colours: linear values, which light adds up in, and the sRGB bytes of pictures.

use crate::engine::simd::{Bytes, Select, Simd, SimdBase, f32x16, store_three_bytes_each, u32x16};
use crate::look::lanes::each;
use std::sync::LazyLock;

/// The sRGB byte that is nearest to a linear value in 0 … 1; values outside are clamped, and what is not a number is 0.
///
/// IEC 61966-2-1:1999.
pub fn srgb_from_linear(linear: f32) -> u8 {
    let linear = if linear > LEAST { linear.min(1.0) } else { LEAST };
    let above = linear.to_bits() - LEAST.to_bits();
    let byte = (ENCODING[(above >> 16) as usize] + (above & 0xffff)) >> 16;
    u8::try_from(byte).expect("the table ends at 255")
}

/// The linear value in 0 … 1 that an sRGB byte stands for.
pub fn linear_from_srgb(byte: u8) -> f32 {
    linear_from_encoded(f32::from(byte) / 255.0)
}

/// The linear value in 0 … 1 that an sRGB value in 0 … 1 stands for.
pub fn linear_from_encoded(encoded: f32) -> f32 {
    // libm gives the same result on every machine and in WebAssembly; the standard library does not promise that.
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
}

/// The sRGB value in 0 … 1 of a linear one; values outside are clamped.
pub fn encoded_from_linear(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    };
    encoded.clamp(0.0, 1.0)
}

/// Where sixteen linear values stand in the encoding: how far above [`LEAST`], as differences of bits, shifted so that the upper eleven
/// bits are the number of the entry. [`store_srgb_of_sixteen`] makes bytes of them.
///
/// They are to be written to memory, and read in another loop: to take each lane out of a vector lasts twice as long as to look up what
/// stands there.
#[inline(always)]
pub(crate) fn places_of_sixteen<S: Simd>(simd: S, linear: f32x16<S>) -> u32x16<S> {
    let [least, one] = each!(value in [LEAST, 1.0] => f32x16::splat(simd, value));
    let linear = linear.simd_gt(least).select(linear, least);
    let linear = linear.simd_lt(one).select(linear, one);
    (linear.bitcast::<u32x16<S>>() - u32x16::splat(simd, LEAST.to_bits())) << UNUSED
}

/// Writes the sRGB bytes of the red, green and blue of sixteen colours, one behind the other, as [`srgb_from_linear`] finds them, from
/// their [places](places_of_sixteen). Four bytes more have no meaning.
#[inline(always)]
pub(crate) fn store_srgb_of_sixteen<S: Simd>(simd: S, places: [&[u32; 16]; 3], to: &mut [u8; 52]) {
    let table: &[u32; ROOM] = &ENCODING;
    let [red, green, blue] = each!(k in [0, 1, 2] => {
        let places = places[k];
        let entries = each!(lane in [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15] => {
            table[(places[lane] >> (u32::BITS - ENTRY_BITS)) as usize]
        });
        let entries = u32x16::from_slice(simd, &entries);
        let above = u32x16::from_slice(simd, places) >> UNUSED;
        (entries + (above & u32x16::splat(simd, 0xffff))) >> 16
    });
    store_three_bytes_each(red | (green << 8) | (blue << 16), to);
}

/// 2⁻¹³: it and everything below is byte 0.
const LEAST: f32 = f32::from_bits((127 - 13) << 23);
/// The steps of the table up to 1, and 1 itself: 128 to an octave.
const ENTRIES: usize = 13 * 128 + 1;

/// Room for them, as a power of 2: so the compiler sees that no place is beyond the table.
const ROOM: usize = ENTRIES.next_power_of_two();
const ENTRY_BITS: u32 = ROOM.ilog2();
/// Bits that no place needs: sixteen are lower than those that number the entry.
const UNUSED: u32 = u32::BITS - 16 - ENTRY_BITS;

/// One entry for all numbers with the same upper half of their bits: `2¹⁶` times the byte of the first of them, and the
/// distance from the last to the smallest of them, if there is one, whose byte is larger by 1. Added to the lower half
/// of a number's bits, it gives the byte in the upper half. No entry has two such: the encoding rises by at most
/// 255 · 1.055 / (2.4 · 128) < 1 in a step.
static ENCODING: LazyLock<Box<[u32; ROOM]>> = LazyLock::new(|| {
    let mut table = Box::new([0; ROOM]);
    let mut byte = 0;
    for (place, entry) in (0_u32..).zip(table[..ENTRIES].iter_mut()) {
        let first = LEAST.to_bits() + (place << 16);
        while byte < 255 && first_with(byte + 1).to_bits() <= first {
            byte += 1;
        }
        let next = if byte < 255 { first_with(byte + 1).to_bits() - first } else { u32::MAX };
        *entry = (byte << 16) + (0x1_0000 - next.min(0x1_0000));
    }
    table
});

/// The smallest linear value whose nearest byte is this one.
fn first_with(byte: u32) -> f32 {
    let encoded = (f64::from(byte) - 0.5) / 255.0;
    let linear = if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    };
    #[expect(clippy::cast_possible_truncation, reason = "rounded up below")]
    let rounded = linear as f32;
    if f64::from(rounded) < linear { rounded.next_up() } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{dispatch, levels};

    /// The definition.
    fn encoded(linear: f32) -> f64 {
        let linear = f64::from(linear);
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * linear.powf(1.0 / 2.4) - 0.055
        };
        255.0 * encoded
    }

    #[test]
    fn srgb_bytes_survive_the_way_there_and_back() {
        assert!((0..=255).all(|byte| srgb_from_linear(linear_from_srgb(byte)) == byte));
    }

    #[test]
    fn every_linear_value_gets_the_nearest_byte() {
        let steps = (0..0x3f80_0000_u32).step_by(997).chain([0x3f80_0000]);
        let borders = (1..=255).flat_map(|byte| {
            let first = first_with(byte);
            [first.next_down(), first, first.next_up()].map(f32::to_bits)
        });
        for linear in steps.chain(borders).map(f32::from_bits) {
            let byte = srgb_from_linear(linear);
            // The definition has a jump of 3·10⁻⁸ between its two parts, and rounding leaves as much.
            assert!((encoded(linear) - f64::from(byte)).abs() <= 0.5 + 1e-4, "{linear:e}: {byte}");
        }
        for (odd, byte) in [(-1.0, 0), (f32::NAN, 0), (2.0, 255), (f32::INFINITY, 255)] {
            assert_eq!(srgb_from_linear(odd), byte);
        }
    }

    #[test]
    fn sixteen_colors_have_the_bytes_of_one() {
        let odd = [f32::NAN, -1.0, 0.0, 1e-30, 1.0, 7.0, f32::INFINITY, -f32::INFINITY];
        let value = |k: usize| if k < 8 { odd[k] } else { (k as f32 * 0.618).fract() };
        for level in levels() {
            for start in 0..100 {
                let colors = dispatch!(level, simd => {
                    let lanes = |shift: usize| f32x16::from_fn(simd, |k| value(start + shift + k));
                    let mut bytes = [7; 52];
                    let places = each!(shift in [0, 5, 11] => places_of_sixteen(simd, lanes(shift)).to_array());
                    store_srgb_of_sixteen(simd, [&places[0], &places[1], &places[2]], &mut bytes);
                    bytes
                });
                for (lane, color) in colors.chunks_exact(3).take(16).enumerate() {
                    let expected = [0, 5, 11].map(|k| srgb_from_linear(value(start + k + lane)));
                    assert_eq!(color, expected);
                }
            }
        }
    }
}
