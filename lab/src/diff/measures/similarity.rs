//! The structural similarity of two pictures, as [`ColorMeasures::ssim`](super::ColorMeasures::ssim) states it.

use super::band::{Band, PART, WINDOW, f64_of};
use crate::common::engine::simd::{best_level, dispatch};
use std::ops::Range;

/// The pixels of a window on each side of its middle.
pub(super) const MARGIN: u32 = 5;
const RADIUS: usize = MARGIN as usize;
/// The standard deviation of the weights, in pixels.
const SIGMA: f64 = 1.5;
/// (K₁·L)² and (K₂·L)², which keep the quotients of dark and of flat parts from being 0/0.
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);
/// The columns that the windows of a part reach.
const REACH: usize = PART + WINDOW - 1;

/// The number of windows with middles in these rows of a band, once for each channel, and the sum of their similarities.
/// Only windows that are compared whole count.
pub(super) fn sums(band: &Band, rows: Range<usize>) -> (f64, f64) {
    let (mut windows, mut similarities) = (0.0, 0.0);
    if band.width < WINDOW {
        return (windows, similarities);
    }
    let weights = weights();
    let mut planes = Planes::new(band);
    let all = band.is_compared_whole().then(|| (0..=band.width - WINDOW).collect::<Vec<_>>());
    for row in rows {
        let of_windows = row - RADIUS..row + RADIUS + 1;
        let some;
        let counted = match &all {
            Some(all) => all,
            None => {
                some = counted(band, of_windows.clone());
                &some
            }
        };
        let parts = || counted.chunk_by(|one, other| one / PART == other / PART);
        for channel in 0..3 {
            for of_part in parts() {
                let part = of_part[0] / PART;
                windows += f64_of(of_part.len());
                // Equal windows are perfectly similar.
                let differing = differing(band, of_windows.clone(), part);
                if differing.is_empty() {
                    similarities += f64_of(of_part.len());
                    continue;
                }
                planes.fill(band, of_windows.clone(), part);
                let reaching = differing.start.saturating_sub(WINDOW - 1)..differing.end.min(PART);
                let found =
                    planes.similarity(channel, [of_windows.start, part], &weights, reaching);
                let first = part * PART;
                similarities += of_part.iter().map(|middle| found[middle - first]).sum::<f64>();
            }
        }
    }
    (windows, similarities)
}

/// The columns from the first to the last in which some rows differ in a part, counted from the first of the part.
fn differing(band: &Band, rows: Range<usize>, part: usize) -> Range<usize> {
    let differing = rows.map(|row| band.differing(row, part)).filter(|columns| !columns.is_empty());
    let all = differing.reduce(|one, other| one.start.min(other.start)..one.end.max(other.end));
    all.unwrap_or(0..0)
}

/// A Gaussian over the pixels of a row of a window; its sum is 1.
fn weights() -> [f64; WINDOW] {
    let bell = |at: usize| (-0.5 * ((f64_of(at) - f64::from(MARGIN)) / SIGMA).powi(2)).exp();
    let bells: [f64; WINDOW] = std::array::from_fn(bell);
    let sum: f64 = bells.iter().sum();
    bells.map(|bell| bell / sum)
}

/// The windows of some rows that are compared whole, by the column of their left edge.
fn counted(band: &Band, rows: Range<usize>) -> Vec<usize> {
    let mut holes = vec![false; band.width];
    for row in rows {
        for (hole, pixel) in holes.iter_mut().zip(band.row(row)) {
            *hole |= !band.is_compared(pixel);
        }
    }
    let windows = holes.windows(WINDOW).enumerate();
    windows.filter(|(_, holes)| !holes.contains(&true)).map(|(column, _)| column).collect()
}

/// The values of a part of a row as numbers: for each channel those of A and of B.
type Values = [[[f32; REACH]; 2]; 3];

/// The values of the parts of a band that are not equal.
struct Planes {
    width: usize,
    parts: usize,
    /// For each row and each of its parts the place of its values, if they were asked for.
    places: Vec<Option<usize>>,
    values: Vec<Values>,
}

impl Planes {
    fn new(band: &Band) -> Planes {
        let places = vec![None; band.rows() * band.parts()];
        Planes { width: band.width, parts: band.parts(), places, values: Vec::new() }
    }

    fn columns(&self, part: usize) -> Range<usize> {
        part * PART..(part * PART + REACH).min(self.width)
    }

    /// Reads a part of some rows, unless it is there.
    fn fill(&mut self, band: &Band, rows: Range<usize>, part: usize) {
        let columns = self.columns(part);
        for row in rows {
            let place = &mut self.places[row * self.parts + part];
            if place.is_some() {
                continue;
            }
            *place = Some(self.values.len());
            let first = row * self.width;
            let mut read: Values = [[[0.0; REACH]; 2]; 3];
            for (channel, values) in read.iter_mut().enumerate() {
                for (colors, values) in band.colors.iter().zip(values) {
                    colors.copy(first + columns.start..first + columns.end, channel, values);
                }
            }
            self.values.push(read);
        }
    }

    /// The similarity of all windows that begin in a part, by the column of their left edge. `first` is their first row;
    /// only some of them differ.
    fn similarity(
        &self,
        channel: usize,
        [first, part]: [usize; 2],
        weights: &[f64; WINDOW],
        differing: Range<usize>,
    ) -> [f64; PART] {
        let rows = std::array::from_fn(|row| {
            let place = self.places[(first + row) * self.parts + part];
            &self.values[place.expect("it was filled")][channel]
        });
        dispatch!(best_level(), _simd => similarity(&rows, weights, differing))
    }
}

/// The similarities of the windows in eleven rows of A and of B, of which only some differ: equal ones have 1 to the last bit,
/// as numerator and denominator are the same number. Vectors compute several windows at once; each has the bits that it
/// has alone.
#[inline(always)]
fn similarity(
    rows: &[&[[f32; REACH]; 2]; WINDOW],
    weights: &[f64; WINDOW],
    differing: Range<usize>,
) -> [f64; PART] {
    // The means of a, b, a², b² and ab: first over columns, then over rows.
    let mut columns = [[0.0; REACH]; 5];
    let reached = differing.start..differing.end + WINDOW - 1;
    for (&[of_a, of_b], &weight) in rows.iter().zip(weights) {
        let [a, b] = [&of_a[reached.clone()], &of_b[reached.clone()]];
        let [sum_a, sum_b, sum_aa, sum_bb, sum_ab] =
            columns.each_mut().map(|sums| &mut sums[reached.clone()]);
        add(sum_a, weight, [a, b], |a, _| a);
        add(sum_b, weight, [a, b], |_, b| b);
        add(sum_aa, weight, [a, b], |a, _| a * a);
        add(sum_bb, weight, [a, b], |_, b| b * b);
        add(sum_ab, weight, [a, b], |a, b| a * b);
    }
    let mut means = [[0.0; PART]; 5];
    for (means, columns) in means.iter_mut().zip(&columns) {
        for (offset, weight) in weights.iter().enumerate() {
            let columns = &columns[differing.start + offset..];
            for (mean, value) in means[differing.clone()].iter_mut().zip(columns) {
                *mean += weight * value;
            }
        }
    }
    let mut similarities = [1.0; PART];
    let [a, b, aa, bb, ab] = means.each_ref().map(|means| &means[differing.clone()]);
    for (at, similarity) in similarities[differing.clone()].iter_mut().enumerate() {
        let (product, squares) = (a[at] * b[at], a[at] * a[at] + b[at] * b[at]);
        let (covariance, variances) = (ab[at] - product, aa[at] + bb[at] - squares);
        *similarity =
            (2.0 * product + C1) * (2.0 * covariance + C2) / ((squares + C1) * (variances + C2));
    }
    similarities
}

/// Adds a value of each column, times a weight.
#[inline(always)]
fn add(sums: &mut [f64], weight: f64, [a, b]: [&[f32]; 2], value: impl Fn(f64, f64) -> f64) {
    for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
        *sum += weight * value(f64::from(*a), f64::from(*b));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::engine::simd::levels;

    #[test]
    fn every_level_of_vectors_and_every_part_gives_the_same_bits() {
        let mut dice = fastrand::Rng::with_seed(5);
        let mut value = || f32::from(dice.u8(..));
        let rows: [[[f32; REACH]; 2]; WINDOW] =
            std::array::from_fn(|_| [(); 2].map(|()| [(); REACH].map(|()| value())));
        let (rows, weights) = (rows.each_ref(), weights());
        let all = similarity(&rows, &weights, 0..PART);
        for level in levels() {
            for part in [0..PART, 5..6, 17..50, 63..64] {
                let found = dispatch!(level, _simd => similarity(&rows, &weights, part.clone()));
                assert_eq!(found[part.clone()], all[part], "{level:?}");
            }
        }
    }
}
