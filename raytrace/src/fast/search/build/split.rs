//! Splits primitives in two: at the place that the surface area heuristic chooses, or by count.

use super::prim_ref::{Box4, PrimRef, Source};
use super::primitives::Primitives;
use super::sah::{SahSplit, cheapest_split};
use crate::fast::search::tree::{INSTANCES, LEAF, SPHERES};

/// From this depth on a record is halved by count, which bounds the depth of any hierarchy.
pub(super) const DEEP: usize = 64;

/// Some consecutive primitives to build, with the box around them and the box around their centres.
pub(super) struct BuildRecord<P> {
    pub(super) prims: P,
    pub(super) bounds: Box4,
    centers: Box4,
    /// The index of the first primitive among all primitives.
    pub(super) first: usize,
    depth: usize,
    /// Whether duplicate triangles have been left out.
    distinct: bool,
}

impl<P: Primitives> BuildRecord<P> {
    pub(super) fn new(prims: P, first: usize, depth: usize, distinct: bool) -> Self {
        let (mut bounds, mut centers) = (Box4::EMPTY, Box4::EMPTY);
        prims.for_each(0..prims.len(), |prim| {
            bounds = bounds.extended(prim.low, prim.high);
            let center = prim.center();
            centers = centers.extended(center, center);
        });
        BuildRecord { prims, bounds, centers, first, depth, distinct }
    }

    /// Builds something of the same record, with its primitives at hand.
    pub(super) fn at_hand<R>(self, build: impl FnOnce(BuildRecord<&mut [PrimRef]>) -> R) -> R {
        let BuildRecord { prims, bounds, centers, first, depth, distinct } = self;
        prims.at_hand(|prims| build(BuildRecord { prims, bounds, centers, first, depth, distinct }))
    }
}

/// The common data of all records of one hierarchy.
pub(super) struct BuildContext<'a> {
    pub(super) kind: Kind,
    pub(super) source: Source<'a>,
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
    let best = cheapest_split(&record.prims, &record.centers, context.most());
    if let Some(best) = best.filter(|_| record.depth < DEEP) {
        return Split::Halves(partition(record, &best));
    }
    let BuildRecord { prims, first, depth, distinct, .. } = record;
    if context.kind == Kind::Triangles && !distinct {
        return Split::Distinct(BuildRecord::new(
            prims.distinct(context.source),
            first,
            depth,
            true,
        ));
    }
    // All centres are in one place, or the depth is too great: then any half is equally good if it is a number of
    // whole leaves.
    let half = (prims.len() / 2).next_multiple_of(context.most()).min(prims.len() - 1);
    let [left, right] = prims.split_at(half);
    let left = BuildRecord::new(left, first, depth + 1, distinct);
    Split::Halves([left, BuildRecord::new(right, first + half, depth + 1, distinct)])
}

/// Sorts the primitives of a record by the side of a split on which they lie.
fn partition<P: Primitives>(record: BuildRecord<P>, best: &SahSplit) -> [BuildRecord<P>; 2] {
    let BuildRecord { mut prims, first, depth, distinct, .. } = record;
    let (mut middle, mut end) = (0, prims.len());
    let (mut left, mut right) = ([Box4::EMPTY; 2], [Box4::EMPTY; 2]);
    while middle < end {
        let prim = prims.at(middle);
        let center = prim.center();
        let goes_left = best.mapping.bins(center)[best.axis] < best.bin;
        let side = if goes_left { &mut left } else { &mut right };
        side[0] = side[0].extended(prim.low, prim.high);
        side[1] = side[1].extended(center, center);
        if goes_left {
            middle += 1;
        } else {
            end -= 1;
            prims.swap(middle, end);
        }
    }
    let [left_prims, right_prims] = prims.split_at(middle);
    let half = |prims, first, [bounds, centers]: [Box4; 2]| BuildRecord {
        prims,
        bounds,
        centers,
        first,
        depth: depth + 1,
        distinct,
    };
    [half(left_prims, first, left), half(right_prims, first + middle, right)]
}
