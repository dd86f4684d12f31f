//! Fragments that wait for their depth test, or for the judge.

use super::lanes::lanes_of;
use super::picture::Picture;
use super::size_class::FEW;
use super::tile::TileBuffer;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::simd::{
    Compression, Simd, SimdMask, f32x16, i32x16, mask32x16, u32x16,
};

/// The most fragments that wait: those that sixteen triangles over few samples can have.
const MOST_FRAGMENTS: usize = 16 * FEW as usize;

/// Fragments that wait for their depth test: the machine predicts the branches of one loop over all of them better
/// than those of one loop for each step.
#[derive(Debug)]
pub(super) struct Fragments {
    /// Each array has room for sixteen more behind the last fragment.
    index: [i32; MOST_FRAGMENTS + 16],
    keys: [f32; MOST_FRAGMENTS + 16],
    ids: [u32; MOST_FRAGMENTS + 16],
    count: usize,
}

impl Fragments {
    pub(super) const fn new() -> Self {
        Fragments {
            index: [0; MOST_FRAGMENTS + 16],
            keys: [0.0; MOST_FRAGMENTS + 16],
            ids: [0; MOST_FRAGMENTS + 16],
            count: 0,
        }
    }

    /// Whether there is no room for sixteen more.
    #[inline(always)]
    pub(super) fn are_full(&self) -> bool {
        self.count > MOST_FRAGMENTS - 16
    }

    /// Adds the lanes in which there is a fragment.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        index: i32x16<S>,
        keys: f32x16<S>,
        ids: u32x16<S>,
        inside: mask32x16<S>,
    ) {
        let from = self.count.min(MOST_FRAGMENTS);
        let compression = Compression::new(inside);
        compression.store(index, &mut self.index[from..from + 16]);
        compression.store(keys, &mut self.keys[from..from + 16]);
        compression.store(ids, &mut self.ids[from..from + 16]);
        self.count = from + inside.to_bitmask().count_ones() as usize;
    }

    /// Tests the depth of all fragments, and forgets them.
    #[inline(always)]
    pub(super) fn test_depth<C: Context>(
        &mut self,
        context: &mut C,
        picture: &Picture,
        buffer: &mut TileBuffer,
    ) {
        let count = std::mem::take(&mut self.count).min(MOST_FRAGMENTS);
        let fragments = self.index[..count].iter().zip(&self.keys[..count]).zip(&self.ids[..count]);
        for ((index, key), id) in fragments {
            let fragment = (index.cast_unsigned() as usize, *id, *key);
            buffer.fragment(context, picture, fragment);
        }
    }
}

/// Leaves to the judge whether the primitives of some lanes cover their samples: ids, indices and keys of all lanes.
#[cold]
pub(super) fn leave_open<C: ScalarContext>(
    context: &mut C,
    picture: &Picture,
    buffer: &mut TileBuffer,
    open: u64,
    (ids, index, keys): (&[u32; 16], &[i32; 16], &[f32; 16]),
) {
    for lane in lanes_of(open) {
        let fragment = (index[lane].cast_unsigned() as usize, ids[lane], keys[lane]);
        buffer.leave_open(context, picture, fragment, false);
    }
}
