//! The surface area heuristic (SAH): the best split of primitives in two, between bins of their centres.

use super::prim_ref::Box4;
use super::primitives::Primitives;
use glam::Vec4;
use rayon::prelude::*;
use std::ops::Range;

/// Bins along an axis: one more than there are candidate splits.
pub(super) const BINS: usize = 16;

/// All threads together fill the bins of more primitives than this.
pub(super) const LARGE: usize = 1 << 17;

/// The mapping from centres to bins.
#[derive(Clone, Copy)]
pub(super) struct BinMapping {
    low: Vec4,
    scale: Vec4,
}

impl BinMapping {
    pub(super) fn new(centers: &Box4) -> BinMapping {
        #[expect(clippy::cast_precision_loss, reason = "it is 16")]
        let bins = BINS as f32;
        // If an extent overflows or is zero, all primitives go into the first bin.
        let scale = Vec4::splat(bins * 0.999) / (centers.high - centers.low);
        BinMapping {
            low: centers.low,
            scale: Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO),
        }
    }

    #[inline(always)]
    pub(super) fn bins(&self, center: Vec4) -> [usize; 3] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is not negative, and the conversion saturates"
        )]
        let bin = |place: f32| (place as u32 as usize).min(BINS - 1);
        let place = (center - self.low) * self.scale;
        [bin(place.x), bin(place.y), bin(place.z)]
    }
}

/// A split along one axis: primitives with a centre in a bin before this one go left.
#[derive(Clone, Copy)]
pub(super) struct SahSplit {
    pub(super) mapping: BinMapping,
    pub(super) axis: usize,
    pub(super) bin: usize,
    /// The sum over both sides of half the area of the box, times the number of leaves.
    pub(super) cost: f64,
}

/// The content of a bin: the box around the primitives, and the number of primitives.
#[derive(Clone, Copy)]
pub(super) struct Bin {
    bounds: Box4,
    count: usize,
}

pub(super) type Bins = [[Bin; BINS]; 3];

pub(super) const NO_BINS: Bins = [[Bin { bounds: Box4::EMPTY, count: 0 }; BINS]; 3];

/// Fills the bins with the primitives of a range.
pub(super) fn fill_bins<P: Primitives>(
    prims: &P,
    range: Range<usize>,
    mapping: &BinMapping,
) -> Bins {
    if range.len() > LARGE {
        let starts = range.clone().into_par_iter().step_by(LARGE / 4);
        let chunks =
            starts.map(|start| fill_bins(prims, start..range.end.min(start + LARGE / 4), mapping));
        return chunks.reduce(
            || NO_BINS,
            |mut all, chunk| {
                for (bin, more) in all.iter_mut().flatten().zip(chunk.as_flattened()) {
                    bin.count += more.count;
                    bin.bounds = bin.bounds.extended(more.bounds.low, more.bounds.high);
                }
                all
            },
        );
    }
    let mut bins = NO_BINS;
    prims.for_each(range, |prim| {
        let places = mapping.bins(prim.center());
        for axis in 0..3 {
            let bin = &mut bins[axis][places[axis]];
            bin.count += 1;
            bin.bounds = bin.bounds.extended(prim.low, prim.high);
        }
    });
    bins
}

/// The cheapest split; `None` if all centres are in one bin. A leaf has at most `most` primitives.
pub(super) fn cheapest_split(
    prims: &impl Primitives,
    centers: &Box4,
    most: usize,
) -> Option<SahSplit> {
    let mapping = BinMapping::new(centers);
    let bins = fill_bins(prims, 0..prims.len(), &mapping);
    let mut best: Option<SahSplit> = None;
    for (axis, bins) in bins.iter().enumerate() {
        // First from the right, the cost of the primitives in or beyond each bin; then from the left.
        let mut beyond = [0.0; BINS];
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in (1..BINS).rev() {
            count += bins[k].count;
            bounds = bounds.extended(bins[k].bounds.low, bins[k].bounds.high);
            beyond[k] = leaves(count, most) * bounds.half_area();
        }
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in 1..BINS {
            count += bins[k - 1].count;
            bounds = bounds.extended(bins[k - 1].bounds.low, bins[k - 1].bounds.high);
            let cost = leaves(count, most) * bounds.half_area() + beyond[k];
            let useful = count > 0 && count < prims.len();
            if useful && best.is_none_or(|best| cost < best.cost) {
                best = Some(SahSplit { mapping, axis, bin: k, cost });
            }
        }
    }
    best
}

/// The number of leaves for a number of primitives, with a given number of primitives per leaf at most.
#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
pub(super) fn leaves(count: usize, most: usize) -> f64 {
    count.div_ceil(most) as f64
}
