//! Splits primitives in two: at the place that the surface area heuristic chooses, or by count.

use super::prim_ref::{Box8, PrimRef, Source};
use super::primitives::{Primitives, chunk_size};
use super::sah::{SahSplit, cheapest_split};
use crate::fast::search::tree::{INSTANCES, LEAF, SPHERES};
use bothways_common::engine::simd::{Level, Simd, SimdBase, SimdCombine, dispatch, f32x4, f32x8};
use rayon::prelude::*;
use std::ops::Range;

/// From this depth on a record is halved by count, which bounds the depth of any hierarchy.
pub(super) const DEEP: usize = 64;

/// Some consecutive primitives to build, with the box around them and the box around their centres.
pub(super) struct BuildRecord<P> {
    pub(super) prims: P,
    pub(super) bounds: Box8,
    centers: Box8,
    /// The index of the first primitive among all primitives.
    pub(super) first: usize,
    depth: usize,
    /// Whether duplicate triangles have been left out.
    distinct: bool,
}

impl<P: Primitives> BuildRecord<P> {
    pub(super) fn new(prims: P, first: usize, depth: usize, distinct: bool, level: Level) -> Self {
        let boxes = prims.boxes();
        let of = |items: &[P::Item]| {
            dispatch!(level, simd => {
                let mut all = ExtentLanes::empty(simd);
                for item in items {
                    let prim = boxes(item);
                    all.add(simd, &prim, prim.center(simd));
                }
                all.extent()
            })
        };
        // A list of no primitives has no chunks.
        let chunks = prims.items().par_chunks(chunk_size(prims.len()).max(1));
        let Extent { bounds, centers } = chunks.map(of).reduce(|| Extent::EMPTY, Extent::union);
        BuildRecord { prims, bounds, centers, first, depth, distinct }
    }

    /// Builds something of the same record, with its primitives at hand.
    pub(super) fn at_hand<R>(self, build: impl FnOnce(BuildRecord<&mut [PrimRef]>) -> R) -> R {
        let BuildRecord { prims, bounds, centers, first, depth, distinct } = self;
        prims.at_hand(|prims| build(BuildRecord { prims, bounds, centers, first, depth, distinct }))
    }
}

/// The common data of all records of one hierarchy.
#[derive(Clone, Copy)]
pub(super) struct BuildContext<'a> {
    pub(super) kind: Kind,
    pub(super) source: Source<'a>,
    pub(super) level: Level,
    /// Whether all threads fill the bins and sort the sides of one record, if it has many primitives.
    pub(super) by_all_threads: bool,
}

/// What a hierarchy is a hierarchy of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Triangles,
    Spheres,
    /// Instances of meshes.
    Instances,
}

impl BuildContext<'_> {
    /// The size of the chunks into which the primitives of a record are divided among threads.
    fn chunk_size(&self, count: usize) -> usize {
        if self.by_all_threads { chunk_size(count) } else { count }
    }

    /// The most primitives in a leaf.
    pub(super) fn most(&self) -> usize {
        match self.kind {
            Kind::Triangles => LEAF,
            Kind::Spheres => SPHERES,
            Kind::Instances => INSTANCES,
        }
    }
}

/// The result for a record with more primitives than a leaf holds: the record is divided in two, or its duplicates
/// are left out.
pub(super) enum Split<P> {
    Halves([BuildRecord<P>; 2]),
    Distinct(BuildRecord<P>),
}

/// Splits a record; its halves are one level deeper.
pub(super) fn split<P: Primitives>(record: BuildRecord<P>, context: &BuildContext) -> Split<P> {
    let size = context.chunk_size(record.prims.len());
    let best = cheapest_split(&record.prims, size, &record.centers, context.most(), context.level);
    if let Some(best) = best.filter(|_| record.depth < DEEP) {
        return Split::Halves(partition(record, size, &best, context.level));
    }
    let BuildRecord { prims, first, depth, distinct, .. } = record;
    if context.kind == Kind::Triangles && !distinct {
        let prims = prims.distinct(context.source);
        return Split::Distinct(BuildRecord::new(prims, first, depth, true, context.level));
    }
    // All centres are in one place, or the depth is too great: then any half is equally good if it is a number of
    // whole leaves.
    let half = (prims.len() / 2).next_multiple_of(context.most()).min(prims.len() - 1);
    let [left, right] = prims.split_at(half);
    let halves = [(left, first), (right, first + half)];
    Split::Halves(
        halves.map(|(prims, first)| {
            BuildRecord::new(prims, first, depth + 1, distinct, context.level)
        }),
    )
}

/// The box around some primitives, and the box around their centres.
#[derive(Clone, Copy)]
struct Extent {
    bounds: Box8,
    centers: Box8,
}

impl Extent {
    const EMPTY: Extent = Extent { bounds: Box8::EMPTY, centers: Box8::EMPTY };

    fn union(self, Extent { bounds, centers }: Extent) -> Extent {
        Extent { bounds: self.bounds.union(&bounds), centers: self.centers.union(&centers) }
    }
}

/// An extent that grows.
#[derive(Clone, Copy)]
struct ExtentLanes<S: Simd> {
    bounds: f32x8<S>,
    centers: f32x8<S>,
}

impl<S: Simd> ExtentLanes<S> {
    #[inline(always)]
    fn empty(simd: S) -> Self {
        let empty = Box8::EMPTY.lanes(simd);
        ExtentLanes { bounds: empty, centers: empty }
    }

    #[inline(always)]
    fn add(&mut self, simd: S, prim: &PrimRef, center: f32x4<S>) {
        self.bounds = self.bounds.max(prim.0.lanes(simd));
        self.centers = self.centers.max((-center).combine(center));
    }

    #[inline(always)]
    fn extent(self) -> Extent {
        Extent { bounds: Box8(self.bounds.to_array()), centers: Box8(self.centers.to_array()) }
    }
}

/// Sorts the primitives of a record by the side of a split on which they lie, in chunks of some size.
fn partition<P: Primitives>(
    record: BuildRecord<P>,
    size: usize,
    best: &SahSplit,
    level: Level,
) -> [BuildRecord<P>; 2] {
    let BuildRecord { mut prims, first, depth, distinct, .. } = record;
    let boxes = prims.boxes();
    let items = prims.items_mut();
    let of =
        |items: &mut [P::Item]| dispatch!(level, simd => partition_items(simd, items, boxes, best));
    let (middle, [left, right]) = if size >= items.len() {
        of(items)
    } else {
        let chunks: Vec<(usize, [Extent; 2])> = items.par_chunks_mut(size).map(of).collect();
        let lefts: Vec<usize> = chunks.iter().map(|(left, _)| *left).collect();
        let middle = bring_together(items, size, &lefts);
        let sides = chunks.iter().map(|(_, sides)| *sides);
        let union = |a: [Extent; 2], b: [Extent; 2]| [a[0].union(b[0]), a[1].union(b[1])];
        (middle, sides.fold([Extent::EMPTY; 2], union))
    };
    let [left_prims, right_prims] = prims.split_at(middle);
    let half = |prims, first, Extent { bounds, centers }| BuildRecord {
        prims,
        bounds,
        centers,
        first,
        depth: depth + 1,
        distinct,
    };
    [half(left_prims, first, left), half(right_prims, first + middle, right)]
}

/// Sorts primitives by their side; returns the number on the left, and the extents of both sides.
#[inline(always)]
fn partition_items<S: Simd, T: Copy>(
    simd: S,
    items: &mut [T],
    boxes: impl Fn(&T) -> PrimRef,
    best: &SahSplit,
) -> (usize, [Extent; 2]) {
    let (mut middle, mut end) = (0, items.len());
    let (mut left, mut right) = (ExtentLanes::empty(simd), ExtentLanes::empty(simd));
    // `item` is looked at next, and its place, the middle, is free: so a step copies one, rather than exchanging two.
    let Some(mut item) = items.first().copied() else {
        return (0, [left.extent(), right.extent()]);
    };
    while middle < end {
        let prim = boxes(&item);
        let center = prim.center(simd);
        if best.goes_left(simd, center) {
            left.add(simd, &prim, center);
            items[middle] = item;
            middle += 1;
            // There is no next one if all go left.
            if let Some(next) = items.get(middle) {
                item = *next;
            }
        } else {
            right.add(simd, &prim, center);
            end -= 1;
            std::mem::swap(&mut item, &mut items[end]);
        }
    }
    (middle, [left.extent(), right.extent()])
}

/// Brings the left ones of chunks of some size, which are the first in each, before all others. Returns how many there
/// are.
fn bring_together<T: Send>(items: &mut [T], size: usize, lefts: &[usize]) -> usize {
    let middle = lefts.iter().sum();
    let count = items.len();
    let chunks = (0..count).step_by(size).zip(lefts);
    let lefts = chunks.clone().map(|(start, left)| start.max(middle)..(start + left).max(middle));
    let rights = chunks
        .map(|(start, left)| (start + left).min(middle)..(start + size).min(count).min(middle));
    let (before, behind) = items.split_at_mut(middle);
    let mut wrong_behind = pieces(behind, middle, lefts).into_iter();
    let mut pairs = Vec::new();
    let mut other: &mut [T] = &mut [];
    for mut one in pieces(before, 0, rights) {
        while !one.is_empty() {
            if other.is_empty() {
                other = wrong_behind.next().expect("as many are on the wrong side on both sides");
            }
            let both = one.len().min(other.len());
            let (a, b);
            (a, one) = one.split_at_mut(both);
            (b, other) = std::mem::take(&mut other).split_at_mut(both);
            pairs.push((a, b));
        }
    }
    pairs.into_par_iter().for_each(|(a, b)| a.swap_with_slice(b));
    middle
}

/// The parts of a list in some ranges that ascend, where its first index is `at`; no part that is empty.
fn pieces<T>(
    mut list: &mut [T],
    mut at: usize,
    ranges: impl Iterator<Item = Range<usize>>,
) -> Vec<&mut [T]> {
    let mut pieces = Vec::new();
    for range in ranges.filter(|range| !range.is_empty()) {
        let (_, from) = std::mem::take(&mut list).split_at_mut(range.start - at);
        let (piece, rest) = from.split_at_mut(range.len());
        (at, list) = (range.end, rest);
        pieces.push(piece);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast::search::tree::Bounds;
    use bothways_common::engine::simd::levels;
    use glam::Vec3;

    /// The order of [`partition_items`], by exchanging two.
    fn exchanged(items: &mut [PrimRef], is_left: impl Fn(&PrimRef) -> bool) {
        let (mut middle, mut end) = (0, items.len());
        while middle < end {
            if is_left(&items[middle]) {
                middle += 1;
            } else {
                end -= 1;
                items.swap(middle, end);
            }
        }
    }

    /// The primitives of a record of some boxes, split where that is cheapest, and again if `again`: then whole chunks
    /// are on one side.
    fn check_partition(count: u32, again: bool, level: Level) {
        fn record(prims: &mut [PrimRef], level: Level) -> BuildRecord<&mut [PrimRef]> {
            BuildRecord::new(prims, 7, 3, false, level)
        }
        let mut random = fastrand::Rng::with_seed(19);
        let mut vector = || Vec3::from_array([(); 3].map(|()| random.f32()));
        let of = |id: u32| {
            let (one, other) = (vector(), vector());
            PrimRef::new(&Bounds { low: one.min(other), high: one.max(other) }, id)
        };
        let mut prims: Vec<PrimRef> = (0..count).map(of).collect();
        let BuildRecord { prims: all, centers, .. } = record(&mut prims, level);
        let size = chunk_size(all.len());
        let best = cheapest_split(&all, size, &centers, LEAF, level).unwrap();
        let is_left =
            |prim: &PrimRef| dispatch!(level, simd => best.goes_left(simd, prim.center(simd)));
        if again {
            partition(record(&mut prims, level), size, &best, level);
        }
        let mut expected = prims.clone();
        let [left, right] = partition(record(&mut prims, level), size, &best, level);
        assert_eq!((left.first, right.first), (7, 7 + left.prims.len()));
        for (side, on_left) in [(left, true), (right, false)] {
            assert!(
                !side.prims.is_empty() && side.prims.iter().all(|prim| is_left(prim) == on_left)
            );
            let all = BuildRecord::new(side.prims, 0, 0, false, level);
            assert_eq!(side.bounds.bounds(), all.bounds.bounds());
            assert_eq!(side.centers.bounds(), all.centers.bounds());
        }
        let ids = |prims: &[PrimRef]| prims.iter().map(PrimRef::id).collect::<Vec<u32>>();
        if size >= expected.len() {
            exchanged(&mut expected, is_left);
            assert_eq!(ids(&prims), ids(&expected));
        }
        let mut sorted = ids(&prims);
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..count));
    }

    #[test]
    fn a_partition_keeps_all_primitives_and_bounds_both_sides() {
        for level in levels() {
            for count in [2, 3, 17, 300, 4095, 6000] {
                check_partition(count, false, level);
                check_partition(count, true, level);
            }
        }
    }

    #[test]
    fn what_is_left_comes_before_all_others() {
        let mut random = fastrand::Rng::with_seed(19);
        for _ in 0..2000 {
            let (size, count) = (random.usize(1..20), random.usize(0..200));
            let share = random.f32();
            let mut items: Vec<(bool, usize)> =
                (0..count).map(|k| (random.f32() < share, k)).collect();
            let mut expected = items.clone();
            let sorted = |chunk: &mut [(bool, usize)]| {
                chunk.sort_by_key(|(is_left, _)| !is_left);
                chunk.iter().filter(|(is_left, _)| *is_left).count()
            };
            let lefts: Vec<usize> = items.chunks_mut(size).map(sorted).collect();
            let middle = bring_together(&mut items, size, &lefts);
            assert!(items[..middle].iter().all(|(is_left, _)| *is_left));
            assert!(items[middle..].iter().all(|(is_left, _)| !is_left));
            items.sort_unstable_by_key(|(_, k)| *k);
            expected.sort_unstable_by_key(|(_, k)| *k);
            assert_eq!(items, expected);
        }
    }
}
