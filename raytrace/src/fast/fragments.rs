//! Fragments that wait for their depth test.

use super::size_class::FEW;
use super::tile::{LARGEST_SIDE, TileBuffer, index};
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, i32x8, mask32x8,
};

/// The most fragments that wait: those that eight triangles over few samples can have.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
const MOST_FRAGMENTS: usize = 8 * FEW as usize;
const _: () = assert!(FEW.fract() == 0.0, "a triangle has a whole number of samples");
/// The code of a fragment holds its sample in the lower bits, then a lane, then whether the fragment is certain.
const LANE: usize = LARGEST_SIDE * LARGEST_SIDE;
const CERTAIN: usize = 8 * LANE;

/// Fragments of eight triangles that wait for their depth test: the machine predicts the branches of one loop over all of them
/// better than those of one loop for each step.
#[derive(Debug)]
pub(super) struct Fragments {
    /// Each array has room for eight more behind the last fragment.
    codes: [i32; MOST_FRAGMENTS + 8],
    /// The ends of their keys.
    low: [f32; MOST_FRAGMENTS + 8],
    high: [f32; MOST_FRAGMENTS + 8],
    count: usize,
}

impl Fragments {
    pub(super) const fn new() -> Self {
        Fragments {
            codes: [0; MOST_FRAGMENTS + 8],
            low: [0.0; MOST_FRAGMENTS + 8],
            high: [0.0; MOST_FRAGMENTS + 8],
            count: 0,
        }
    }

    /// Adds the lanes in which there is `perhaps` a fragment, at a row and column of the tile; where it is also `inside`, that is
    /// certain.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        [row, column]: [f32x8<S>; 2],
        (perhaps, inside): (mask32x8<S>, mask32x8<S>),
        [low, high]: [f32x8<S>; 2],
    ) {
        // Where there is a fragment, all of these are whole numbers that `f32` holds. What comes of other lanes is dropped below.
        let code = f32x8::load_array(simd, const { codes(0) });
        let certain = f32x8::load_array(simd, const { codes(CERTAIN) });
        let code = inside.select(certain, code) + (row * LARGEST_SIDE as f32 + column);
        debug_assert!(self.count <= MOST_FRAGMENTS, "fragments would be lost");
        let from = self.count.min(MOST_FRAGMENTS);
        code.to_int::<i32x8<S>>().compress(perhaps).store_slice(&mut self.codes[from..from + 8]);
        low.compress(perhaps).store_slice(&mut self.low[from..from + 8]);
        high.compress(perhaps).store_slice(&mut self.high[from..from + 8]);
        self.count = from + perhaps.to_bitmask().count_ones() as usize;
    }

    /// Tests the depth of all fragments, whose triangles have these ids, and forgets them.
    #[inline(always)]
    pub(super) fn test_depth<C: ScalarContext>(
        &mut self,
        context: &mut C,
        ids: &[u32; 8],
        tile: &mut TileBuffer,
    ) {
        let count = std::mem::take(&mut self.count).min(MOST_FRAGMENTS);
        let fragments = self.codes[..count].iter().zip(&self.low[..count]).zip(&self.high[..count]);
        for ((code, &low), &high) in fragments {
            let Fragment { lane, at, certain } = Fragment::of(*code);
            tile.fragment(context, at, (lane, ids[lane]), certain, [low, high]);
        }
    }
}

/// What a code stands for.
#[derive(Debug, PartialEq, Eq)]
struct Fragment {
    lane: usize,
    /// The index of its sample in the tile.
    at: usize,
    certain: bool,
}

impl Fragment {
    #[inline(always)]
    fn of(code: i32) -> Fragment {
        let code = code.cast_unsigned() as usize;
        let at = index(code / LARGEST_SIDE, code);
        Fragment { lane: code / LANE % 8, at, certain: code >= CERTAIN }
    }
}

/// The codes of a fragment at the first sample in all lanes, plus `more`.
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
const fn codes(more: usize) -> [f32; 8] {
    let mut codes = [0.0; 8];
    let mut lane = 0;
    while lane < 8 {
        codes[lane] = (lane * LANE + more) as f32;
        lane += 1;
    }
    codes
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};

    /// As many steps as fill the room: in a fifth of the lanes there is nothing.
    const STEPS: u16 = 20;

    /// The row and column of a lane of a step, whether there is perhaps a fragment, and whether certainly.
    fn drawn(step: u16, lane: usize) -> (u16, u16, bool, bool) {
        let number = 8 * step + u16::try_from(lane).unwrap();
        (number * 7 % 32, number * 11 % 32, number % 5 != 4, number.is_multiple_of(3))
    }

    #[inline(always)]
    fn add_step<S: Simd>(simd: S, fragments: &mut Fragments, step: u16) {
        let of = |lane| drawn(step, lane);
        // Lanes without a fragment may have any row.
        let row = |lane| if of(lane).2 { f32::from(of(lane).0) } else { f32::INFINITY };
        let column = |lane| f32::from(of(lane).1);
        let places = [f32x8::from_fn(simd, row), f32x8::from_fn(simd, column)];
        let bits = |is: fn((u16, u16, bool, bool)) -> bool| {
            (0..8).fold(0, |bits, lane| bits | u64::from(is(of(lane))) << lane)
        };
        let [perhaps, inside] =
            [bits(|of| of.2), bits(|of| of.3)].map(|bits| mask32x8::from_bitmask(simd, bits));
        let low = f32x8::from_fn(simd, |lane| f32::from(step) + 0.125 * lane as f32);
        fragments.add(simd, places, (perhaps, inside), [low, low + 0.5]);
    }

    #[test]
    fn fragments_keep_their_sample_lane_and_keys_at_every_level() {
        let expected: Vec<(Fragment, [f32; 2])> = (0..STEPS)
            .flat_map(|step| (0..8).map(move |lane| (step, lane, drawn(step, lane))))
            .filter(|(.., (_, _, perhaps, _))| *perhaps)
            .map(|(step, lane, (row, column, _, certain))| {
                let at = index(row.into(), column.into());
                let low = f32::from(step) + 0.125 * lane as f32;
                (Fragment { lane, at, certain }, [low, low + 0.5])
            })
            .collect();
        assert_eq!(expected.len(), MOST_FRAGMENTS);
        for level in levels() {
            let mut fragments = Fragments::new();
            for step in 0..STEPS {
                dispatch!(level, simd => add_step(simd, &mut fragments, step));
            }
            let Fragments { codes, low, high, count } = &fragments;
            let of = |k: usize| (Fragment::of(codes[k]), [low[k], high[k]]);
            let found: Vec<_> = (0..*count).map(of).collect();
            assert_eq!(found, expected, "{level:?}");
        }
    }
}
