//! The surface area heuristic (SAH): the best split of primitives in two, between bins of their centres.

use super::prim_ref::{Box8, PrimRef};
use super::primitives::{Primitives, chunk_size};
use bothways_common::engine::simd::{
    Level, Simd, SimdBase, SimdFloat, SimdMask, dispatch, f32x4, i32x4,
};
use rayon::prelude::*;

/// Bins along an axis: one more than there are candidate splits.
pub(super) const BINS: usize = 16;

/// The last bin, which is all bits that a bin may have.
const LAST_BIN: i32 = 15;
const _: () = assert!(BINS == 16);

/// From so many primitives on, they are put into two sets of bins in turn.
const MANY: usize = 256;

/// The mapping from centres to bins.
#[derive(Clone, Copy)]
pub(super) struct BinMapping {
    low: [f32; 4],
    scale: [f32; 4],
}

impl BinMapping {
    /// For centres in a box.
    pub(super) fn new(Box8(centers): &Box8) -> BinMapping {
        #[expect(clippy::cast_precision_loss, reason = "it is 16")]
        let bins = BINS as f32;
        let low = [-centers[0], -centers[1], -centers[2], 0.0];
        // If an extent overflows or is zero, all primitives go into the first bin.
        let scale = |axis: usize| {
            let scale = bins * 0.999 / (centers[4 + axis] - low[axis]);
            if scale < f32::INFINITY { scale } else { 0.0 }
        };
        BinMapping { low, scale: [scale(0), scale(1), scale(2), 0.0] }
    }

    /// The bins of a centre along the three axes.
    #[inline(always)]
    fn bins<S: Simd>(&self, simd: S, center: f32x4<S>) -> i32x4<S> {
        let low = f32x4::load_array_ref(simd, &self.low);
        let scale = f32x4::load_array_ref(simd, &self.scale);
        // A difference that overflows has a scale of 0. The product is no number, and becomes 0 or the least integer, as the
        // machine has it: both end in 0 bits.
        let places: i32x4<S> = ((center - low) * scale).to_int();
        places & i32x4::splat(simd, LAST_BIN)
    }
}

/// A split along one axis: primitives with a centre in a bin before this one go left.
#[derive(Clone, Copy)]
pub(super) struct SahSplit {
    pub(super) mapping: BinMapping,
    pub(super) axis: usize,
    pub(super) bin: i32,
    /// The sum over both sides of half the area of the box, times the number of leaves.
    pub(super) cost: f64,
}

impl SahSplit {
    /// Whether a primitive with this centre goes left.
    #[inline(always)]
    pub(super) fn goes_left<S: Simd>(&self, simd: S, center: f32x4<S>) -> bool {
        let goes_left = self.mapping.bins(simd, center).simd_lt(i32x4::splat(simd, self.bin));
        goes_left.to_bitmask() >> self.axis & 1 == 1
    }
}

/// The contents of the bins of each axis: the box around the primitives, and the number of primitives.
#[derive(Clone, Copy)]
struct Bins {
    bounds: [[Box8; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl Bins {
    const EMPTY: Bins = Bins { bounds: [[Box8::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] };

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, prim: &PrimRef, mapping: &BinMapping) {
        let bins = mapping.bins(simd, prim.center(simd)).to_array();
        let prim = prim.0.lanes(simd);
        let axes = self.bounds.iter_mut().zip(&mut self.counts);
        for ((bounds, counts), bin) in axes.zip(bins) {
            #[expect(clippy::cast_sign_loss, reason = "it is not negative")]
            let bin = bin as usize % BINS;
            bounds[bin].lanes(simd).max(prim).store_slice(&mut bounds[bin].0);
            counts[bin] += 1;
        }
    }

    fn union(mut self, other: &Bins) -> Bins {
        let bounds = self.bounds.as_flattened_mut().iter_mut();
        for (bounds, other) in bounds.zip(other.bounds.as_flattened()) {
            *bounds = bounds.union(other);
        }
        let counts = self.counts.as_flattened_mut().iter_mut();
        counts.zip(other.counts.as_flattened()).for_each(|(count, other)| *count += other);
        self
    }
}

/// Fills the bins with some primitives.
fn fill_bins<P: Primitives>(prims: &P, mapping: &BinMapping, level: Level) -> Bins {
    let boxes = prims.boxes();
    let of = |items: &[P::Item]| {
        let mut bins = Bins::EMPTY;
        // Neighbours often share their bins. In two sets, they do not wait for one another.
        let (pairs, rest) = items.as_chunks::<2>();
        let (pairs, more) = if items.len() < MANY { (&[][..], pairs) } else { (pairs, &[][..]) };
        dispatch!(level, simd => {
            if !pairs.is_empty() {
                let mut others = Bins::EMPTY;
                for [one, other] in pairs {
                    bins.add(simd, &boxes(one), mapping);
                    others.add(simd, &boxes(other), mapping);
                }
                bins = bins.union(&others);
            }
            for item in more.as_flattened().iter().chain(rest) {
                bins.add(simd, &boxes(item), mapping);
            }
        });
        bins
    };
    let size = chunk_size(prims.len());
    if size >= prims.len() {
        return of(prims.items());
    }
    let chunks = prims.items().par_chunks(size).map(of);
    chunks.reduce(|| Bins::EMPTY, |all, chunk| all.union(&chunk))
}

/// The cheapest split; `None` if all centres are in one bin. A leaf has at most `most` primitives.
pub(super) fn cheapest_split(
    prims: &impl Primitives,
    centers: &Box8,
    most: usize,
    level: Level,
) -> Option<SahSplit> {
    let mapping = BinMapping::new(centers);
    let bins = fill_bins(prims, &mapping, level);
    let mut best: Option<SahSplit> = None;
    for (axis, (bounds, counts)) in bins.bounds.iter().zip(&bins.counts).enumerate() {
        // First from the right, the cost of the primitives in or beyond each bin; then from the left. An empty bin
        // makes no other split than the one before.
        let mut beyond = [0.0; BINS + 1];
        let (mut count, mut around) = (0, Box8::EMPTY);
        for k in (1..BINS).rev() {
            beyond[k] = beyond[k + 1];
            if counts[k] > 0 {
                count += counts[k] as usize;
                around = around.union(&bounds[k]);
                beyond[k] = leaves(count, most) * around.half_area();
            }
        }
        let (mut count, mut around) = (0, Box8::EMPTY);
        for k in 1..BINS {
            if counts[k - 1] == 0 {
                continue;
            }
            count += counts[k - 1] as usize;
            if count == prims.len() {
                break;
            }
            around = around.union(&bounds[k - 1]);
            let cost = leaves(count, most) * around.half_area() + beyond[k];
            if best.is_none_or(|best| cost < best.cost) {
                let bin = i32::try_from(k).expect("it is less than 16");
                best = Some(SahSplit { mapping, axis, bin, cost });
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
