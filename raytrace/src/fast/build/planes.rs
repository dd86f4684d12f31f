//! Where the surface area heuristic would split a part: between bins of its primitives' middles.

use super::items::{Box4, Item};
use glam::Vec4;
use rayon::prelude::*;

/// Candidate splits along an axis, plus one.
pub(super) const BINS: usize = 16;

/// Bins of parts with more primitives are filled by all threads.
pub(super) const LARGE: usize = 1 << 17;

/// How middles are sorted into bins.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    low: Vec4,
    scale: Vec4,
}

impl Grid {
    pub(super) fn new(middles: &Box4) -> Grid {
        #[expect(clippy::cast_precision_loss, reason = "it is 16")]
        let bins = BINS as f32;
        // An extent that overflows, and one that is nothing, puts everything into the first bin.
        let scale = Vec4::splat(bins * 0.999) / (middles.high - middles.low);
        Grid {
            low: middles.low,
            scale: Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO),
        }
    }

    #[inline(always)]
    pub(super) fn bins(&self, middle: Vec4) -> [usize; 3] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is not negative, and the conversion saturates"
        )]
        let bin = |place: f32| (place as u32 as usize).min(BINS - 1);
        let place = (middle - self.low) * self.scale;
        [bin(place.x), bin(place.y), bin(place.z)]
    }
}

/// A split: primitives whose middle lies in a bin before this one, along one axis, go first.
#[derive(Clone, Copy)]
pub(super) struct SplitPlane {
    pub(super) grid: Grid,
    pub(super) axis: usize,
    pub(super) bin: usize,
    /// The sum over both parts of half their area times their number of leaves.
    pub(super) cost: f64,
}

/// What lies in a bin.
#[derive(Clone, Copy)]
pub(super) struct Bin {
    bounds: Box4,
    count: usize,
}

pub(super) type Bins = [[Bin; BINS]; 3];

pub(super) const NO_BINS: Bins = [[Bin { bounds: Box4::EMPTY, count: 0 }; BINS]; 3];

pub(super) fn fill_bins(items: &[Item], grid: &Grid) -> Bins {
    if items.len() > LARGE {
        let shares = items.par_chunks(LARGE / 4).map(|share| fill_bins(share, grid));
        return shares.reduce(
            || NO_BINS,
            |mut all, share| {
                for (bin, more) in all.iter_mut().flatten().zip(share.as_flattened()) {
                    bin.count += more.count;
                    bin.bounds = bin.bounds.with(more.bounds.low, more.bounds.high);
                }
                all
            },
        );
    }
    let mut bins = NO_BINS;
    for item in items {
        let places = grid.bins(item.middle());
        for axis in 0..3 {
            let bin = &mut bins[axis][places[axis]];
            bin.count += 1;
            bin.bounds = bin.bounds.with(item.low, item.high);
        }
    }
    bins
}

/// The split that the surface area heuristic likes best; `None` if all middles are in one bin.
pub(super) fn cheapest_plane(items: &[Item], middles: &Box4, most: usize) -> Option<SplitPlane> {
    let grid = Grid::new(middles);
    let bins = fill_bins(items, &grid);
    let mut best: Option<SplitPlane> = None;
    for (axis, bins) in bins.iter().enumerate() {
        // From the right, the cost of what lies at or beyond each bin; then from the left.
        let mut beyond = [0.0; BINS];
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in (1..BINS).rev() {
            count += bins[k].count;
            bounds = bounds.with(bins[k].bounds.low, bins[k].bounds.high);
            beyond[k] = leaves(count, most) * bounds.half_area();
        }
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in 1..BINS {
            count += bins[k - 1].count;
            bounds = bounds.with(bins[k - 1].bounds.low, bins[k - 1].bounds.high);
            let cost = leaves(count, most) * bounds.half_area() + beyond[k];
            let useful = count > 0 && count < items.len();
            if useful && best.is_none_or(|best| cost < best.cost) {
                best = Some(SplitPlane { grid, axis, bin: k, cost });
            }
        }
    }
    best
}

/// How many leaves so many primitives fill, with so many in each at most.
#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
pub(super) fn leaves(count: usize, most: usize) -> f64 {
    count.div_ceil(most) as f64
}
