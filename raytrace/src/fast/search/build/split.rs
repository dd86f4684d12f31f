//! Splits primitives in two: where the surface area heuristic says, or by count.

use super::prim_ref::{Box4, Corners, PrimRef};
use super::sah::{SahSplit, cheapest_split};
use crate::fast::search::tree::{LEAF, SPHERES};
use bothways_common::Scene;

/// From this depth on a record is halved by count, which bounds the depth of any hierarchy.
pub(super) const DEEP: usize = 64;

/// Some consecutive primitives that are to be built, the box around them and the box around their centres.
pub(super) struct BuildRecord<'a> {
    pub(super) prims: &'a mut [PrimRef],
    pub(super) bounds: Box4,
    centers: Box4,
    /// The index of the first one among all.
    pub(super) first: usize,
    depth: usize,
    /// Whether duplicates of triangles were left out.
    distinct: bool,
}

impl<'a> BuildRecord<'a> {
    pub(super) fn new(
        prims: &'a mut [PrimRef],
        first: usize,
        depth: usize,
        distinct: bool,
    ) -> Self {
        let (mut bounds, mut centers) = (Box4::EMPTY, Box4::EMPTY);
        for prim in &*prims {
            bounds = bounds.extended(prim.low, prim.high);
            let center = prim.center();
            centers = centers.extended(center, center);
        }
        BuildRecord { prims, bounds, centers, first, depth, distinct }
    }
}

/// What all records of one hierarchy share.
pub(super) struct BuildContext<'a> {
    /// Whether it is that of the spheres.
    pub(super) spheres: bool,
    pub(super) scene: &'a Scene,
}

impl BuildContext<'_> {
    /// How many primitives a leaf has at most.
    pub(super) fn most(&self) -> usize {
        if self.spheres { SPHERES } else { LEAF }
    }
}

/// What becomes of a record with more primitives than a leaf holds: it is divided in two, or its duplicates are left
/// out.
pub(super) enum Split<'a> {
    Halves([BuildRecord<'a>; 2]),
    Distinct(BuildRecord<'a>),
}

/// Splits a record; its halves are one level deeper.
pub(super) fn split<'a>(record: BuildRecord<'a>, context: &BuildContext) -> Split<'a> {
    let best = cheapest_split(record.prims, &record.centers, context.most());
    if let Some(best) = best.filter(|_| record.depth < DEEP) {
        return Split::Halves(partition(record, &best));
    }
    let BuildRecord { prims, first, depth, distinct, .. } = record;
    if !context.spheres && !distinct {
        let count = leave_out_duplicates(prims, context);
        return Split::Distinct(BuildRecord::new(&mut prims[..count], first, depth, true));
    }
    // All in one place, or too deep: any half is as good as any other, as long as it is whole leaves.
    let half = (prims.len() / 2).next_multiple_of(context.most()).min(prims.len() - 1);
    let (left, right) = prims.split_at_mut(half);
    let left = BuildRecord::new(left, first, depth + 1, distinct);
    Split::Halves([left, BuildRecord::new(right, first + half, depth + 1, distinct)])
}

/// Sorts the primitives of a record by the side of a split on which they lie.
fn partition<'a>(record: BuildRecord<'a>, best: &SahSplit) -> [BuildRecord<'a>; 2] {
    let BuildRecord { prims, first, depth, distinct, .. } = record;
    let (mut middle, mut end) = (0, prims.len());
    let (mut left, mut right) = ([Box4::EMPTY; 2], [Box4::EMPTY; 2]);
    while middle < end {
        let prim = prims[middle];
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
    let (left_prims, right_prims) = prims.split_at_mut(middle);
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

/// Keeps the distinct triangles, each time the first in the scene, at the start, and returns how many there are: the
/// duplicates are never seen.
fn leave_out_duplicates(prims: &mut [PrimRef], context: &BuildContext) -> usize {
    let mut corners = Corners::new(context.scene);
    let mut bits = |prim: &PrimRef| {
        // Adding 0 makes −0 and 0 one.
        let mut bits = corners.of(prim.id()).map(|v| (v + 0.0).to_array().map(f32::to_bits));
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
