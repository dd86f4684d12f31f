//! The structural similarity of two pictures, as [`ColorMeasures::ssim`](super::ColorMeasures::ssim) states it.

use super::color::Band;
use std::ops::Range;

/// The pixels of a window on each side of its middle.
pub(super) const MARGIN: u32 = 5;
const RADIUS: usize = MARGIN as usize;
const WINDOW: usize = 2 * RADIUS + 1;
/// The standard deviation of the weights, in pixels.
const SIGMA: f64 = 1.5;
/// (K₁·L)² and (K₂·L)², which keep the quotients of dark and of flat parts from being 0/0.
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// The number of windows with middles in these rows of a band, once for each channel, and the sum of their similarities.
/// Only windows that are compared whole count.
pub(super) fn sums(band: &Band, rows: Range<usize>) -> (f64, f64) {
    let (mut windows, mut similarities) = (0.0, 0.0);
    if band.width < WINDOW {
        return (windows, similarities);
    }
    let weights = weights();
    let equal = band.channels.each_ref().map(|channel| equal_parts(channel, band.width));
    for row in rows {
        let above = (row - RADIUS) * band.width;
        let place = above..above + WINDOW * band.width;
        let counted = counted(&band.compared[place.clone()], band.width);
        for ([a, b], equal) in band.channels.iter().zip(&equal) {
            let [a, b] = [&a[place.clone()], &b[place.clone()]];
            for of_part in counted.chunk_by(|one, other| one / PART == other / PART) {
                let part = of_part[0] / PART;
                windows += f64_of(of_part.len());
                // Equal windows are perfectly similar.
                if (row - RADIUS..row + RADIUS + 1).all(|row| equal[row][part]) {
                    similarities += f64_of(of_part.len());
                    continue;
                }
                let first = part * PART;
                let columns = first..(first + PART + WINDOW - 1).min(band.width);
                let found = similarity([a, b], band.width, columns, &weights);
                similarities += of_part.iter().map(|middle| found[middle - first]).sum::<f64>();
            }
        }
    }
    (windows, similarities)
}

/// The windows beside one another of which it is known whether they are equal as a whole.
const PART: usize = 64;

/// For each row and for each part of the windows of a row, whether a channel is equal there.
fn equal_parts([a, b]: &[Vec<f32>; 2], width: usize) -> Vec<Vec<bool>> {
    let of_row = |(a, b): (&[f32], &[f32])| {
        let part = |first: usize| {
            let columns = first..(first + PART + WINDOW - 1).min(width);
            a[columns.clone()] == b[columns]
        };
        (0..width).step_by(PART).map(part).collect()
    };
    a.chunks_exact(width).zip(b.chunks_exact(width)).map(of_row).collect()
}

#[expect(clippy::cast_precision_loss, reason = "at most 2^16 windows")]
fn f64_of(windows: usize) -> f64 {
    windows as f64
}

/// A Gaussian over the pixels of a row of a window; its sum is 1.
fn weights() -> [f64; WINDOW] {
    #[expect(clippy::cast_precision_loss, reason = "at most 11")]
    let bell = |at: usize| (-0.5 * ((at as f64 - f64::from(MARGIN)) / SIGMA).powi(2)).exp();
    let bells: [f64; WINDOW] = std::array::from_fn(bell);
    let sum: f64 = bells.iter().sum();
    bells.map(|bell| bell / sum)
}

/// The windows of a row that are compared whole, by the column of their left edge.
fn counted(compared: &[bool], width: usize) -> Vec<usize> {
    let holes: Vec<bool> = (0..width)
        .map(|column| compared.iter().skip(column).step_by(width).any(|compared| !compared))
        .collect();
    let windows = holes.windows(WINDOW).enumerate();
    windows.filter(|(_, holes)| !holes.contains(&true)).map(|(column, _)| column).collect()
}

/// The similarity of all windows that lie in some columns of a row of windows, by the column of their left edge.
fn similarity(
    [a, b]: [&[f32]; 2],
    width: usize,
    place: Range<usize>,
    weights: &[f64; WINDOW],
) -> Vec<f64> {
    // The means of a, b, a², b² and ab: first over columns, then over rows.
    let mut columns = [(); 5].map(|()| vec![0.0; place.len()]);
    for ((a, b), weight) in a.chunks_exact(width).zip(b.chunks_exact(width)).zip(weights) {
        let [a, b] = [&a[place.clone()], &b[place.clone()]];
        for (column, (a, b)) in a.iter().zip(b).enumerate() {
            let [a, b] = [*a, *b].map(f64::from);
            let products = [a, b, a * a, b * b, a * b];
            for (sum, product) in columns.iter_mut().zip(products) {
                sum[column] += weight * product;
            }
        }
    }
    let means = columns.map(|column| {
        let mut means = vec![0.0; place.len() + 1 - WINDOW];
        for (offset, weight) in weights.iter().enumerate() {
            for (mean, value) in means.iter_mut().zip(&column[offset..]) {
                *mean += weight * value;
            }
        }
        means
    });
    let [a, b, aa, bb, ab] = &means;
    let of_window = |at: usize| {
        let (product, squares) = (a[at] * b[at], a[at] * a[at] + b[at] * b[at]);
        let (covariance, variances) = (ab[at] - product, aa[at] + bb[at] - squares);
        (2.0 * product + C1) * (2.0 * covariance + C2) / ((squares + C1) * (variances + C2))
    };
    (0..a.len()).map(of_window).collect()
}
