//! Shuffles that are known only at run time: sixteen lanes, each of which takes one of sixteen numbers; and chosen lanes that are
//! stored one behind the other.

use super::{Bytes, Simd, SimdBase, SimdSplit, f32x16, mask32x16, u8x32, u8x64, u32x16};
#[cfg(target_arch = "x86_64")]
use super::{Level, SimdFrom, SimdMask, f32x8, u32x8};
#[cfg(target_arch = "x86_64")]
use fearless_simd::ExtractToken;

/// Which of sixteen numbers each of sixteen lanes takes.
///
/// Most levels shuffle bytes. AVX-512 and AVX2 shuffle numbers, which asks for less: AVX2 would need sixteen instructions for a vector
/// by its bytes, and needs six, eight numbers at a time. So the places are given both ways; the compiler leaves out what a level does
/// not ask for.
#[derive(Clone, Copy, Debug)]
pub struct Shuffle<S: Simd> {
    bytes: u8x64<S>,
    /// The places in the low four bits; the others have no meaning.
    #[cfg_attr(not(target_arch = "x86_64"), expect(dead_code, reason = "AVX levels ask for it"))]
    lanes: u32x16<S>,
}

/// Three shuffles that belong together, packed: for each lane, the three places from which it takes its numbers, in four bits each,
/// the lowest first. The other twenty bits have no meaning.
#[derive(Clone, Copy, Debug)]
pub struct PackedShuffles<S: Simd>(u32x16<S>);

impl<S: Simd> PackedShuffles<S> {
    /// For sixteen lanes.
    #[inline(always)]
    pub fn new(packed: u32x16<S>) -> Self {
        PackedShuffles(packed)
    }

    /// Those of the lanes in a mask, one behind the other. What the lanes behind these take has no meaning.
    #[inline(always)]
    pub fn compress(self, which: mask32x16<S>) -> Self {
        PackedShuffles(self.0.compress(which))
    }

    /// The three shuffles.
    #[inline(always)]
    pub fn unpack(self) -> [Shuffle<S>; 3] {
        [Shuffle::new(self.0), Shuffle::new(self.0 >> 4), Shuffle::new(self.0 >> 8)]
    }
}

impl<S: Simd> Shuffle<S> {
    /// From the places in the low four bits; the others have no meaning.
    #[inline(always)]
    fn new(lanes: u32x16<S>) -> Self {
        let simd = lanes.simd;
        let spread = u8x64::load_array(simd, const { pattern([0; 4], 4) });
        let within = u8x64::load_array(simd, const { pattern([0, 1, 2, 3], 0) });
        let first: u8x64<S> = ((lanes & 15) << 2).bitcast();
        Shuffle { bytes: first.swizzle_dyn_within_blocks(spread) + within, lanes }
    }

    /// Sixteen numbers, each in the lanes that take it.
    #[inline(always)]
    pub fn of(self, numbers: f32x16<S>) -> f32x16<S> {
        #[cfg(target_arch = "x86_64")]
        match numbers.simd.level() {
            Level::Avx512(avx512) => {
                let taken = avx512::sixteen(avx512, numbers.into(), self.lanes.into());
                return f32x16::simd_from(numbers.simd, taken);
            }
            Level::Avx2(avx2) => {
                let simd = numbers.simd;
                let (low, high) = numbers.split();
                let take = |lanes: u32x8<S>| {
                    let taken = avx2::eight(avx2, low.into(), high.into(), lanes.into());
                    f32x8::simd_from(simd, taken)
                };
                let (first, last) = self.lanes.split();
                return simd.combine_f32x8(take(first), take(last));
            }
            _ => {}
        }
        numbers.swizzle_dyn(self.bytes)
    }
}

/// Which of sixteen lanes are stored, one behind the other. It is made once for several vectors.
///
/// AVX2 stores half by half, each with one shuffle; a whole vector would have to be put together from both first.
#[derive(Clone, Copy, Debug)]
pub struct Compression<S: Simd> {
    which: mask32x16<S>,
    /// The places from which the lanes of each half take their numbers.
    #[cfg(target_arch = "x86_64")]
    places: [u32x8<S>; 2],
    /// How many lanes of the first half are stored.
    #[cfg(target_arch = "x86_64")]
    first: usize,
}

impl<S: Simd> Compression<S> {
    /// One that chooses the lanes of a mask.
    #[inline(always)]
    pub fn new(which: mask32x16<S>) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let simd = which.token();
            let (low, high) = simd.split_mask32x16(which);
            let lanes = u32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]);
            Compression {
                which,
                places: [lanes.compress(low), lanes.compress(high)],
                first: low.to_bitmask().count_ones() as usize,
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        Compression { which }
    }

    /// Stores the chosen lanes. What is behind them, up to sixteen, has no meaning then.
    ///
    /// # Panics
    ///
    /// If there is no room for sixteen.
    #[inline(always)]
    pub fn store<V>(self, numbers: V, to: &mut [V::Element])
    where
        V: SimdSplit<S> + SimdBase<S, Mask = mask32x16<S>>,
        V::Split: SimdBase<S, Element = V::Element, ByteVector = u8x32<S>>,
    {
        let to = &mut to[..16];
        #[cfg(target_arch = "x86_64")]
        if let Level::Avx2(avx2) = self.which.token().level() {
            let simd = self.which.token();
            let store = |half: V::Split, places: u32x8<S>, to: &mut [V::Element]| {
                let half: f32x8<S> = half.bitcast();
                let packed = f32x8::simd_from(simd, avx2::packed(avx2, half.into(), places.into()));
                packed.bitcast::<V::Split>().store_slice(to);
            };
            let (low, high) = numbers.split();
            store(low, self.places[0], &mut to[..8]);
            store(high, self.places[1], &mut to[self.first.min(8)..][..8]);
            return;
        }
        numbers.compress(self.which).store_slice(to);
    }
}

/// Writes the three lower bytes of each of sixteen numbers, one behind the other. The last four bytes have no meaning then.
#[inline(always)]
pub fn store_three_bytes_each<S: Simd>(numbers: u32x16<S>, to: &mut [u8; 52]) {
    let three_of_four = u8x64::from_slice(numbers.simd, [THREE_OF_FOUR; 4].as_flattened());
    let packed = numbers.bitcast::<u8x64<S>>().swizzle_dyn_within_blocks(three_of_four).to_array();
    for quarter in 0..4 {
        to[12 * quarter..][..16].copy_from_slice(&packed[16 * quarter..][..16]);
    }
}

/// The places of three of each four bytes; and four bytes without meaning.
const THREE_OF_FOUR: [u8; 16] = [0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 0, 0, 0, 0];

/// Four bytes, sixteen times: each time `step` more, and again from the start after every four times.
const fn pattern(four: [u8; 4], step: u8) -> [u8; 64] {
    let mut all = [0; 64];
    let mut k = 0;
    while k < 64 {
        #[expect(clippy::cast_possible_truncation, reason = "less than 4")]
        let time = (k / 4 % 4) as u8;
        all[k] = four[k % 4] + step * time;
        k += 1;
    }
    all
}

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use core::arch::x86_64::{__m512, __m512i, _mm512_permutexvar_ps};

    fearless_simd::kernel!(
        /// Sixteen lanes, each from one of sixteen numbers: the low four bits of the place say which.
        #[inline(always)]
        pub(super) fn sixteen(avx512: Avx512, numbers: __m512, lanes: __m512i) -> __m512 {
            _mm512_permutexvar_ps(lanes, numbers)
        }
    );
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use core::arch::x86_64::{
        __m256, __m256i, _mm256_blendv_ps, _mm256_castsi256_ps, _mm256_permutevar8x32_ps,
        _mm256_slli_epi32,
    };

    fearless_simd::kernel!(
        /// Eight lanes, each from one of the eight numbers `low` or `high`: bit 3 of the place says from which.
        #[inline(always)]
        pub(super) fn eight(avx2: Avx2, low: __m256, high: __m256, lanes: __m256i) -> __m256 {
            let is_high = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(lanes));
            let [low, high] = [low, high].map(|half| _mm256_permutevar8x32_ps(half, lanes));
            _mm256_blendv_ps(low, high, is_high)
        }
    );

    fearless_simd::kernel!(
        /// Eight lanes, each from one of eight numbers.
        #[inline(always)]
        pub(super) fn packed(avx2: Avx2, numbers: __m256, places: __m256i) -> __m256 {
            _mm256_permutevar8x32_ps(numbers, places)
        }
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{SimdMask, dispatch, levels};
    use proptest::array::{uniform3, uniform16};
    use proptest::prelude::*;

    /// Sixteen numbers of any bits: none is changed on its way.
    fn any_bits() -> impl Strategy<Value = [u32; 16]> {
        uniform16(any::<u32>())
    }

    /// Any lanes; and often all of a half, or none.
    fn any_lanes() -> impl Strategy<Value = u16> {
        prop_oneof![4 => any::<u16>(), 1 => proptest::sample::select(vec![0, 0xff, 0xff00, 0xffff])]
    }

    /// What is in the lanes of a mask.
    fn chosen<T: Copy>(which: u16, all: [T; 16]) -> Vec<T> {
        (0..16).filter(|lane| which >> lane & 1 == 1).map(|lane| all[lane]).collect()
    }

    proptest! {
        #[test]
        fn every_lane_takes_the_number_at_its_place(
            numbers in any_bits(),
            places in uniform16(uniform3(0_u8..16)),
            without_meaning in any_bits(),
            which in any_lanes(),
        ) {
            let mut packed = without_meaning.map(|bits| bits << 12);
            for (packed, places) in packed.iter_mut().zip(places) {
                let [a, b, c] = places.map(u32::from);
                *packed |= a | b << 4 | c << 8;
            }
            for level in levels() {
                let taken: [[[f32; 16]; 3]; 2] = dispatch!(level, simd => {
                    let row = f32x16::load_array(simd, numbers.map(f32::from_bits));
                    let all = PackedShuffles::new(u32x16::load_array(simd, packed));
                    let some = all.compress(mask32x16::from_bitmask(simd, which.into()));
                    [all, some].map(|packed| {
                        packed.unpack().map(|shuffle| shuffle.of(row).to_array())
                    })
                });
                let [all, some] = taken.map(|three| three.map(|row| row.map(f32::to_bits)));
                for k in 0..3 {
                    let expected = places.map(|places| numbers[usize::from(places[k])]);
                    prop_assert_eq!(all[k], expected, "{:?}", level);
                    let expected = chosen(which, expected);
                    prop_assert_eq!(&some[k][..expected.len()], expected, "{:?}", level);
                }
            }
        }

        #[test]
        fn three_bytes_of_each_number_are_stored_one_behind_the_other(numbers in any_bits()) {
            let expected = numbers.map(|number| {
                let [red, green, blue, _] = number.to_le_bytes();
                [red, green, blue]
            });
            for level in levels() {
                let mut stored = [7; 52];
                dispatch!(level, simd => {
                    store_three_bytes_each(u32x16::load_array(simd, numbers), &mut stored);
                });
                prop_assert_eq!(&stored[..48], expected.as_flattened(), "{:?}", level);
            }
        }

        #[test]
        fn lanes_are_stored_one_behind_the_other(numbers in any_bits(), which in any_lanes()) {
            let expected = chosen(which, numbers);
            for level in levels() {
                let (mut stored, mut whole) = ([f32::from_bits(7); 20], [7; 20]);
                dispatch!(level, simd => {
                    let row = u32x16::load_array(simd, numbers);
                    let which = mask32x16::from_bitmask(simd, which.into());
                    let compression = Compression::new(which);
                    compression.store(row, &mut whole);
                    compression.store(row.bitcast::<f32x16<_>>(), &mut stored);
                });
                let stored = stored.map(f32::to_bits);
                prop_assert_eq!(&stored[..expected.len()], &expected, "{:?}", level);
                prop_assert_eq!(&whole[..expected.len()], &expected, "{:?}", level);
                // Nothing is written behind the sixteenth.
                prop_assert_eq!((&stored[16..], &whole[16..]), (&[7; 4][..], &[7; 4][..]));
            }
        }
    }
}
