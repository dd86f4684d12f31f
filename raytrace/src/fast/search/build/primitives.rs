//! Primitives in an order that the build changes: at hand with their boxes, or found anew where they are asked for.

use super::prim_ref::PrimRef;
use super::split::{BuildContext, leave_out_duplicates};
use crate::fast::search::tree::WIDTH;
use std::ops::Range;

/// Some consecutive primitives of a hierarchy.
pub(super) trait Primitives: Send + Sync + Sized {
    /// Fewer are taken at hand before anything is built of them.
    const AT_HAND: usize;
    /// So many children of a node are built at the same time. What is built of them waits until all are.
    const TOGETHER: usize;

    fn len(&self) -> usize;

    fn at(&self, index: usize) -> PrimRef;

    fn for_each(&self, range: Range<usize>, take: impl FnMut(&PrimRef));

    fn swap(&mut self, first: usize, second: usize);

    /// Those before an index, and the others.
    fn split_at(self, index: usize) -> [Self; 2];

    /// Builds something of all of them at hand, which may change their order.
    fn at_hand<R>(self, build: impl FnOnce(&mut [PrimRef]) -> R) -> R;

    /// Of triangles, only those that are distinct.
    fn distinct(self, context: &BuildContext) -> Self;
}

impl Primitives for &mut [PrimRef] {
    const AT_HAND: usize = 0;
    const TOGETHER: usize = WIDTH;

    #[inline(always)]
    fn len(&self) -> usize {
        <[PrimRef]>::len(self)
    }

    #[inline(always)]
    fn at(&self, index: usize) -> PrimRef {
        self[index]
    }

    #[inline(always)]
    fn for_each(&self, range: Range<usize>, take: impl FnMut(&PrimRef)) {
        self[range].iter().for_each(take);
    }

    #[inline(always)]
    fn swap(&mut self, first: usize, second: usize) {
        <[PrimRef]>::swap(self, first, second);
    }

    fn split_at(self, index: usize) -> [Self; 2] {
        self.split_at_mut(index).into()
    }

    fn at_hand<R>(self, build: impl FnOnce(&mut [PrimRef]) -> R) -> R {
        build(self)
    }

    fn distinct(self, context: &BuildContext) -> Self {
        let count = leave_out_duplicates(self, context);
        &mut self[..count]
    }
}
