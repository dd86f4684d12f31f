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
    let weights = weights();
    let mut planes = Planes::new();
    for part in 0..band.parts() {
        let first = part * PART;
        let lefts = first..(first + PART).min((band.width + 1).saturating_sub(WINDOW));
        planes.begin();
        for row in rows.clone().take_while(|_| !lefts.is_empty()) {
            let of_windows = row - RADIUS..row + RADIUS + 1;
            let holes = holes(band, of_windows.clone(), lefts.clone());
            let counts = |left: usize| !holes[left - first];
            let count = 3.0 * f64_of(lefts.clone().filter(|&left| counts(left)).count());
            windows += count;
            // Equal windows are perfectly similar.
            let differing = differing(band, of_windows.clone(), part);
            if differing.is_empty() {
                similarities += count;
                continue;
            }
            planes.fill(band, of_windows.clone(), part);
            let reaching = differing.start.saturating_sub(WINDOW - 1)..differing.end.min(PART);
            for channel in 0..3 {
                let found = planes.similarity(channel, row - RADIUS, &weights, reaching.clone());
                let counted = lefts.clone().filter(|&left| counts(left));
                similarities += counted.map(|left| found[left - first]).sum::<f64>();
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

/// For each window of some rows, by the column of its left edge counted from the first, whether a pixel of it is not
/// compared.
fn holes(band: &Band, rows: Range<usize>, lefts: Range<usize>) -> [bool; PART] {
    let mut holes = [false; PART];
    if band.is_compared_whole() {
        return holes;
    }
    for (hole, left) in holes.iter_mut().zip(lefts) {
        let mut pixels = rows.clone().flat_map(|row| {
            let first = band.row(row).start + left;
            first..first + WINDOW
        });
        *hole = pixels.any(|pixel| !band.is_compared(pixel));
    }
    holes
}

/// The values of a part of a row as numbers, for a channel: `a`, `b`, `a² + b²` and `ab`.
type Values = [[f64; REACH]; 4];

/// The values of a part in the eleven rows of its windows.
struct Planes {
    /// The row that is in each place, if one is.
    rows: [Option<usize>; WINDOW],
    /// Row `r` is in place `r mod 11`.
    values: Vec<[Values; 3]>,
}

impl Planes {
    fn new() -> Planes {
        Planes { rows: [None; WINDOW], values: vec![[[[0.0; REACH]; 4]; 3]; WINDOW] }
    }

    /// Begins another part.
    fn begin(&mut self) {
        self.rows = [None; WINDOW];
    }

    /// Reads a part of some rows, unless they are there.
    fn fill(&mut self, band: &Band, rows: Range<usize>, part: usize) {
        let columns = part * PART..(part * PART + REACH).min(band.width);
        for row in rows {
            let place = row % WINDOW;
            if self.rows[place].replace(row) == Some(row) {
                continue;
            }
            let first = row * band.width;
            for (channel, values) in self.values[place].iter_mut().enumerate() {
                let mut read = [[0.0; REACH]; 2];
                for (colors, values) in band.colors.iter().zip(&mut read) {
                    colors.copy(first + columns.start..first + columns.end, channel, values);
                }
                dispatch!(best_level(), _simd => products(values, &read));
            }
        }
    }

    /// The similarity of all windows that begin in the part, by the column of their left edge. `first` is their first row;
    /// only some of them differ.
    fn similarity(
        &self,
        channel: usize,
        first: usize,
        weights: &[f64; WINDOW],
        differing: Range<usize>,
    ) -> [f64; PART] {
        let rows = std::array::from_fn(|row| &self.values[(first + row) % WINDOW][channel]);
        dispatch!(best_level(), _simd => similarity(&rows, weights, differing))
    }
}

/// Computes the values of a row from those of A and of B.
#[inline(always)]
fn products([of_a, of_b, squares, products]: &mut Values, [a, b]: &[[f32; REACH]; 2]) {
    for at in 0..REACH {
        let [a, b] = [a[at], b[at]].map(f64::from);
        (of_a[at], of_b[at]) = (a, b);
        squares[at] = a * a + b * b;
        products[at] = a * b;
    }
}

/// The similarities of the windows in eleven rows, of which only some differ: equal ones have 1 to the last bit, as
/// numerator and denominator are the same number. Vectors compute several windows at once; each has the bits that it
/// has alone.
#[inline(always)]
fn similarity(
    rows: &[&Values; WINDOW],
    weights: &[f64; WINDOW],
    differing: Range<usize>,
) -> [f64; PART] {
    // The means of the values: first over columns, then over rows. Two rows that are equally far from the middle have
    // one weight, two columns, too.
    let reached = differing.start..differing.end + WINDOW - 1;
    let count = differing.len();
    let mut means = [[0.0; PART]; 4];
    for (plane, means) in means.iter_mut().enumerate() {
        let of_row = |row: usize| &rows[row][plane][reached.clone()];
        let mut columns = [0.0; REACH];
        let columns = &mut columns[..reached.len()];
        for (above, &weight) in weights[..RADIUS].iter().enumerate() {
            let pairs = of_row(above).iter().zip(of_row(WINDOW - 1 - above));
            for (column, (above, below)) in columns.iter_mut().zip(pairs) {
                *column += weight * (above + below);
            }
        }
        for (column, middle) in columns.iter_mut().zip(of_row(RADIUS)) {
            *column += weights[RADIUS] * middle;
        }
        let means = &mut means[differing.clone()];
        let beginning = |offset: usize| &columns[offset..][..count];
        for (left, &weight) in weights[..RADIUS].iter().enumerate() {
            let pairs = beginning(left).iter().zip(beginning(WINDOW - 1 - left));
            for (mean, (left, right)) in means.iter_mut().zip(pairs) {
                *mean += weight * (left + right);
            }
        }
        for (mean, middle) in means.iter_mut().zip(beginning(RADIUS)) {
            *mean += weights[RADIUS] * middle;
        }
    }
    let mut similarities = [1.0; PART];
    let [a, b, squares, ab] = means.each_ref().map(|means| &means[differing.clone()]);
    for (at, similarity) in similarities[differing.clone()].iter_mut().enumerate() {
        let (product, of_means) = (a[at] * b[at], a[at] * a[at] + b[at] * b[at]);
        let (covariance, variances) = (ab[at] - product, squares[at] - of_means);
        *similarity =
            (2.0 * product + C1) * (2.0 * covariance + C2) / ((of_means + C1) * (variances + C2));
    }
    similarities
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::engine::simd::levels;

    #[test]
    fn every_level_of_vectors_and_every_part_gives_the_same_bits() {
        let mut dice = fastrand::Rng::with_seed(5);
        let mut value = || f32::from(dice.u8(..));
        let rows: [Values; WINDOW] = std::array::from_fn(|_| {
            let read = [(); 2].map(|()| [(); REACH].map(|()| value()));
            let mut values = [[0.0; REACH]; 4];
            products(&mut values, &read);
            values
        });
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
