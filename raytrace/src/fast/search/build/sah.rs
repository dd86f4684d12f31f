//! The surface area heuristic (SAH): the best split of primitives in two, between bins of their centres.

use super::prim_ref::{Box8, PrimRef, half_area_of_sides};
use super::primitives::Primitives;
use bothways_common::engine::simd::{
    Level, Select, Simd, SimdBase, SimdFloat, SimdMask, SimdWiden, dispatch, f32x4, f32x8, i32x4,
    mask32x8,
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

    /// The costs of the splits of each axis; that before bin `k + 1` is at `k`.
    ///
    /// Empty bins are not skipped: the machine could not guess which they are, and to wait for that takes longer.
    #[inline(always)]
    fn split_costs<S: Simd>(&self, simd: S, most: usize) -> [[f64; BINS - 1]; 3] {
        let empty = Box8::EMPTY.lanes(simd);
        let mut costs = [[0.0; BINS - 1]; 3];
        for (axis, costs) in costs.iter_mut().enumerate() {
            let (bounds, counts) = (&self.bounds[axis], &self.counts[axis]);
            // First the costs of the left sides, each with its last bin.
            let (mut count, mut around) = (0, empty);
            for (last, cost) in costs.iter_mut().enumerate() {
                count += counts[last] as usize;
                around = around.max(bounds[last].lanes(simd));
                *cost = leaves(count, most) * half_area_of_lanes(around);
            }
            // Then, from the right, those of the right sides.
            let (mut count, mut around) = (0, empty);
            for (last, cost) in costs.iter_mut().enumerate().rev() {
                count += counts[last + 1] as usize;
                around = around.max(bounds[last + 1].lanes(simd));
                *cost += leaves(count, most) * half_area_of_lanes(around);
            }
        }
        costs
    }

    /// Adds the contents of other bins.
    fn extend(&mut self, other: &Bins) {
        let bounds = self.bounds.as_flattened_mut().iter_mut();
        for (bounds, other) in bounds.zip(other.bounds.as_flattened()) {
            *bounds = bounds.union(other);
        }
        let counts = self.counts.as_flattened_mut().iter_mut();
        counts.zip(other.counts.as_flattened()).for_each(|(count, other)| *count += other);
    }
}

/// [`Box8::half_area`] of a box in lanes, in the same steps, so that both give the same bits.
#[inline(always)]
fn half_area_of_lanes<S: Simd>(around: f32x8<S>) -> f64 {
    // The fourth lane holds ids. Most are denormal as numbers, which some machines take a hundred times as long to convert.
    let is_axis = mask32x8::from_bitmask(around.simd, 0b0111_0111);
    let (low, high) = is_axis.select(around, f32x8::splat(around.simd, 0.0)).widen();
    let [x, y, z, _] = (high + low).max(0.0).to_array();
    half_area_of_sides([x, y, z])
}

/// Fills the bins with some primitives, in chunks of some size.
fn fill_bins<P: Primitives>(prims: &P, size: usize, mapping: &BinMapping, level: Level) -> Bins {
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
                bins.extend(&others);
            }
            for item in more.as_flattened().iter().chain(rest) {
                bins.add(simd, &boxes(item), mapping);
            }
        });
        bins
    };
    if size >= prims.len() {
        return of(prims.items());
    }
    let chunks = prims.items().par_chunks(size).map(of);
    let union = |mut all: Bins, chunk: Bins| {
        all.extend(&chunk);
        all
    };
    chunks.reduce(|| Bins::EMPTY, union)
}

/// The cheapest split; `None` if all centres are in one bin. A leaf has at most `most` primitives. Bins are
/// filled with the primitives in chunks of some size.
pub(super) fn cheapest_split(
    prims: &impl Primitives,
    size: usize,
    centers: &Box8,
    most: usize,
    level: Level,
) -> Option<SahSplit> {
    let mapping = BinMapping::new(centers);
    let bins = fill_bins(prims, size, &mapping, level);
    let costs = dispatch!(level, simd => bins.split_costs(simd, most));
    let mut best: Option<SahSplit> = None;
    for (axis, (costs, counts)) in costs.iter().zip(&bins.counts).enumerate() {
        let mut count = 0;
        for (bin, (cost, more)) in (1..).zip(costs.iter().zip(counts)) {
            count += *more as usize;
            // Behind an empty bin, the split is the one before it, at the same cost. One with nothing on the right is none; on
            // the left, the least centre is in the first bin.
            let is_cheapest = best.is_none_or(|best| *cost < best.cost);
            if is_cheapest && count < prims.len() {
                best = Some(SahSplit { mapping, axis, bin, cost: *cost });
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast::search::tree::Bounds;
    use bothways_common::engine::simd::levels;
    use glam::Vec3;

    /// Boxes in a few places or in many, most of them in fewer than three dimensions. Read as numbers, their ids are
    /// denormal or none.
    fn boxes(random: &mut fastrand::Rng) -> Vec<PrimRef> {
        let count = [1, 2, 3, random.u32(4..400)][random.usize(0..4)];
        let places = [2.0, 1e3, 1e30, f32::MAX][random.usize(0..4)];
        let across = Vec3::from_array([(); 3].map(|()| f32::from(random.u8(0..2))));
        let mut vector = || {
            let place = [(); 3].map(|()| ((2.0 * random.f32() - 1.0) * places).round());
            across * Vec3::from_array(place)
        };
        let ids = [0, u32::MAX - 400];
        let of = |k: u32| {
            let (one, other) = (vector(), vector());
            let bounds = Bounds { low: one.min(other), high: one.max(other) };
            PrimRef::new(&bounds, ids[k as usize % 2] + k)
        };
        (0..count).map(of).collect()
    }

    /// The first of the cheapest splits, from the primitives on either side of each.
    fn cheapest_of_all(
        prims: &[PrimRef],
        mapping: BinMapping,
        most: usize,
        level: Level,
    ) -> Option<SahSplit> {
        let mut cheapest: Option<SahSplit> = None;
        for (axis, bin) in (0..3).flat_map(|axis| (1..16).map(move |bin| (axis, bin))) {
            let split = SahSplit { mapping, axis, bin, cost: 0.0 };
            let is_left = |prim: &&PrimRef| dispatch!(level, simd => split.goes_left(simd, prim.center(simd)));
            let sides: (Vec<&PrimRef>, Vec<&PrimRef>) = prims.iter().partition(is_left);
            if sides.0.is_empty() || sides.1.is_empty() {
                continue;
            }
            let cost_of = |side: Vec<&PrimRef>| {
                let all = side.iter().fold(Box8::EMPTY, |all, prim| all.union(&prim.0));
                leaves(side.len(), most) * all.half_area()
            };
            let cost = cost_of(sides.0) + cost_of(sides.1);
            if cheapest.is_none_or(|cheapest| cost < cheapest.cost) {
                cheapest = Some(SahSplit { cost, ..split });
            }
        }
        cheapest
    }

    #[test]
    fn the_first_of_the_cheapest_splits_is_chosen() {
        let mut random = fastrand::Rng::with_seed(19);
        let mut found_any = [false; 2];
        for _ in 0..300 {
            let mut prims = boxes(&mut random);
            let most = [8, 16][random.usize(0..2)];
            for level in levels() {
                let around = |centers: Box8, prim: &PrimRef| {
                    let [x, y, z, _] = dispatch!(level, simd => prim.center(simd).to_array());
                    centers.union(&Box8([-x, -y, -z, 0.0, x, y, z, 0.0]))
                };
                let centers = prims.iter().fold(Box8::EMPTY, around);
                let found = cheapest_split(&&mut prims[..], usize::MAX, &centers, most, level);
                let expected = cheapest_of_all(&prims, BinMapping::new(&centers), most, level);
                let shown = |split: Option<SahSplit>| split.map(|s| (s.axis, s.bin, s.cost));
                assert_eq!(shown(found), shown(expected), "{level:?}");
                found_any[usize::from(found.is_some())] = true;
            }
        }
        assert_eq!(found_any, [true; 2]);
    }
}
