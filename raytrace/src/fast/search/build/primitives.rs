//! Primitives in an order that the build changes: at hand with their boxes, or found anew where they are asked for.

use super::prim_ref::{CornerReader, PrimRef, Source, place_bits};
use crate::fast::search::tree::WIDTH;

/// From so many primitives on, all threads work on them together, unless each thread has records of its own.
pub(super) const LARGE: usize = 4096;

/// The size of the chunks into which primitives are divided among threads: all of them, if they are few. It does not
/// depend on the number of threads, so that neither does the hierarchy.
pub(super) fn chunk_size(count: usize) -> usize {
    if count < LARGE { count } else { (count / 64).max(LARGE / 4) }
}

/// Some consecutive primitives of a hierarchy.
pub(super) trait Primitives: Send + Sync + Sized {
    /// Fewer are taken at hand before anything is built of them.
    const AT_HAND: usize;
    /// So many children of a node are built at the same time. What is built of them waits until all are.
    const TOGETHER: usize;

    /// What is kept of a primitive in their order.
    type Item: Copy + Send + Sync;

    /// The primitives in their order.
    fn items(&self) -> &[Self::Item];

    /// The same, in an order that may be changed.
    fn items_mut(&mut self) -> &mut [Self::Item];

    /// Finds the boxes of primitives.
    fn boxes(&self) -> impl Fn(&Self::Item) -> PrimRef + Copy + Send + Sync + use<Self>;

    /// Those before an index, and the others.
    fn split_at(self, index: usize) -> [Self; 2];

    /// Builds something of all of them at hand, which may change their order.
    fn at_hand<R>(self, build: impl FnOnce(&mut [PrimRef]) -> R) -> R;

    /// Of triangles, only those that are distinct.
    fn distinct(self, source: Source) -> Self;

    #[inline(always)]
    fn len(&self) -> usize {
        self.items().len()
    }
}

impl<'a> Primitives for &'a mut [PrimRef] {
    const AT_HAND: usize = 0;
    const TOGETHER: usize = WIDTH;

    type Item = PrimRef;

    #[inline(always)]
    fn items(&self) -> &[PrimRef] {
        self
    }

    #[inline(always)]
    fn items_mut(&mut self) -> &mut [PrimRef] {
        self
    }

    #[inline(always)]
    fn boxes(&self) -> impl Fn(&PrimRef) -> PrimRef + Copy + Send + Sync + use<'a> {
        |prim: &PrimRef| *prim
    }

    fn split_at(self, index: usize) -> [Self; 2] {
        self.split_at_mut(index).into()
    }

    fn at_hand<R>(self, build: impl FnOnce(&mut [PrimRef]) -> R) -> R {
        build(self)
    }

    fn distinct(self, source: Source) -> Self {
        let count = leave_out_duplicates(self, source);
        &mut self[..count]
    }
}

/// Moves the distinct triangles to the start, the first triangle in the scene of each group, and returns the number
/// of distinct triangles: the duplicates are never visible.
fn leave_out_duplicates(prims: &mut [PrimRef], source: Source) -> usize {
    let mut corners = CornerReader::new(source);
    let mut bits = |prim: &PrimRef| {
        let mut bits = corners.of(prim.id()).map(place_bits);
        bits.sort_unstable();
        bits
    };
    prims.sort_by_cached_key(|prim| (bits(prim), prim.id()));
    let mut kept = 1;
    for k in 1..prims.len() {
        if bits(&prims[k]) != bits(&prims[kept - 1]) {
            prims[kept] = prims[k];
            kept += 1;
        }
    }
    kept
}
