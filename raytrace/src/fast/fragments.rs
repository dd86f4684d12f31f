//! Fragments that wait for their depth test.

use super::size_class::FEW;
use super::tile::{LARGEST, TileBuffer, index};
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, i32x8, mask32x8,
};

/// The most fragments that wait: those that eight triangles over few samples can have.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
const MOST_FRAGMENTS: usize = 8 * FEW as usize;
/// A name holds a sample in its lower bits, then a lane, then whether the fragment is certain.
const LANE: usize = LARGEST * LARGEST;
const CERTAIN: usize = 8 * LANE;

/// Fragments of eight triangles that wait for their depth test: the machine predicts the branches of one loop over all of them
/// better than those of one loop for each step.
#[derive(Debug)]
pub(super) struct Fragments {
    /// Each array has room for eight more behind the last fragment.
    names: [i32; MOST_FRAGMENTS + 8],
    /// The ends of their keys.
    low: [f32; MOST_FRAGMENTS + 8],
    high: [f32; MOST_FRAGMENTS + 8],
    count: usize,
}

impl Fragments {
    pub(super) const fn new() -> Self {
        Fragments {
            names: [0; MOST_FRAGMENTS + 8],
            low: [0.0; MOST_FRAGMENTS + 8],
            high: [0.0; MOST_FRAGMENTS + 8],
            count: 0,
        }
    }

    /// Adds the lanes in which there is perhaps a fragment, or certainly.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        [row, column]: [f32x8<S>; 2],
        (perhaps, inside): (mask32x8<S>, mask32x8<S>),
        [low, high]: [f32x8<S>; 2],
    ) {
        // All of these are whole numbers that `f32` holds.
        let name = f32x8::load_array(simd, const { names(0) });
        let certain = f32x8::load_array(simd, const { names(CERTAIN) });
        let name = inside.select(certain, name) + (row * LARGEST as f32 + column);
        let from = self.count.min(MOST_FRAGMENTS);
        name.to_int::<i32x8<S>>().compress(perhaps).store_slice(&mut self.names[from..from + 8]);
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
        let fragments = self.names[..count].iter().zip(&self.low[..count]).zip(&self.high[..count]);
        for ((name, &low), &high) in fragments {
            let name = name.cast_unsigned() as usize;
            let lane = name / LANE % 8;
            let at = index(name / LARGEST, name);
            tile.fragment(context, at, (lane, ids[lane]), name >= CERTAIN, [low, high]);
        }
    }
}

/// The names of the first sample in all lanes, and something more.
#[expect(clippy::cast_precision_loss, reason = "small numbers")]
const fn names(more: usize) -> [f32; 8] {
    let mut names = [0.0; 8];
    let mut lane = 0;
    while lane < 8 {
        names[lane] = (lane * LANE + more) as f32;
        lane += 1;
    }
    names
}
