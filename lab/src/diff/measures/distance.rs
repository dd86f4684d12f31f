//! The exact distances of pixels from a mask, in linear time.
//!
//! Felzenszwalb and Huttenlocher, "Distance Transforms of Sampled Functions", Theory of Computing 8, 2012.

use serde::Serialize;

/// A pixel and its distance from a mask.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BorderDistance {
    /// The distance between the middles of two pixels, in pixels: 1 for a neighbour.
    pub pixels: f64,
    /// The row and the column of the pixel.
    pub at: [u32; 2],
}

/// The distance in a column without a pixel of the mask.
const FAR: u32 = u32::MAX;

/// The first of the wanted pixels, which are listed row by row, that are farthest from the mask; `None` if there is no
/// wanted pixel, or the mask is empty.
pub(super) fn farthest(
    size: [u32; 2],
    mask: &[bool],
    wanted: &[[u32; 2]],
) -> Option<BorderDistance> {
    let width = size[0] as usize;
    let in_columns = distances_in_columns(width, mask);
    let mut envelope = Envelope::default();
    let mut most: Option<(u64, [u32; 2])> = None;
    for of_row in wanted.chunk_by(|one, other| one[0] == other[0]) {
        let row = &in_columns[of_row[0][0] as usize * width..][..width];
        // Most differing pixels lie close to the mask: it costs less to look beside them than to enclose a row.
        let mut steps = 0;
        let mut is_enclosed = false;
        for &[i, j] in of_row {
            if !is_enclosed && steps > width {
                envelope.enclose(row);
                is_enclosed = true;
            }
            let squared = if is_enclosed {
                envelope.at(j.into())?
            } else {
                nearest_beside(row, j as usize, &mut steps)?
            };
            if most.is_none_or(|(largest, _)| squared > largest) {
                most = Some((squared, [i, j]));
            }
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "at most twice 2^32")]
    most.map(|(squared, at)| BorderDistance { pixels: (squared as f64).sqrt(), at })
}

/// The square of the distance of a pixel from the mask, by the distances in the columns, nearest columns first; counts
/// the columns that are looked at.
fn nearest_beside(row: &[u32], column: usize, steps: &mut usize) -> Option<u64> {
    let mut nearest: Option<u64> = None;
    for away in 0..row.len() {
        let across = (away as u64).pow(2);
        if nearest.is_some_and(|nearest| nearest <= across) {
            break;
        }
        *steps += 1;
        let beside = [column.checked_sub(away), Some(column + away)];
        for at in beside.into_iter().flatten() {
            if let Some(&distance) = row.get(at).filter(|&&distance| distance != FAR) {
                let squared = across + u64::from(distance).pow(2);
                nearest = Some(nearest.map_or(squared, |nearest| nearest.min(squared)));
            }
        }
    }
    nearest
}

/// For each pixel, the number of rows to the nearest pixel of the mask in its column.
fn distances_in_columns(width: usize, mask: &[bool]) -> Vec<u32> {
    let mut rows: Vec<u32> = mask.iter().map(|&is_in| if is_in { 0 } else { FAR }).collect();
    let one_more = |distance: u32| distance.saturating_add(1);
    for at in width..rows.len() {
        rows[at] = rows[at].min(one_more(rows[at - width]));
    }
    for at in (0..rows.len().saturating_sub(width)).rev() {
        rows[at] = rows[at].min(one_more(rows[at + width]));
    }
    rows
}

/// The lower envelope of a parabola `(x − j)² + distance²` over each column `j` that holds a pixel of the mask.
#[derive(Default)]
struct Envelope {
    parabolas: Vec<Parabola>,
    /// The parabola at the last position that was asked for.
    current: usize,
}

/// A parabola, and the place from which on it is the lowest.
#[derive(Clone, Copy)]
struct Parabola {
    column: u64,
    height: u64,
    from: f64,
}

impl Envelope {
    /// Starts again with the distances of one row.
    fn enclose(&mut self, distances: &[u32]) {
        self.parabolas.clear();
        self.current = 0;
        for (column, &distance) in (0..).zip(distances).filter(|(_, distance)| **distance != FAR) {
            let height = u64::from(distance).pow(2);
            let mut from = f64::NEG_INFINITY;
            while let Some(last) = self.parabolas.last() {
                from = last.meets(column, height);
                if from > last.from {
                    break;
                }
                self.parabolas.pop();
                from = f64::NEG_INFINITY;
            }
            self.parabolas.push(Parabola { column, height, from });
        }
    }

    /// The square of the distance at a column; `None` without any parabola. Columns are asked for from left to right.
    fn at(&mut self, column: u64) -> Option<u64> {
        #[expect(clippy::cast_precision_loss, reason = "a column is less than 2^16")]
        let place = column as f64;
        while self.parabolas.get(self.current + 1).is_some_and(|next| next.from <= place) {
            self.current += 1;
        }
        let lowest = self.parabolas.get(self.current)?;
        Some(column.abs_diff(lowest.column).pow(2) + lowest.height)
    }
}

impl Parabola {
    /// The place from which on a parabola farther right is lower.
    ///
    /// The numerator is an integer below 2³⁵, hence exact. Two such places within the picture are equal or 2⁻³⁴ apart, far
    /// more than an `f64` rounds there.
    fn meets(self, column: u64, height: u64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "below 2^35")]
        let [left, right, apart] =
            [self.height + self.column.pow(2), height + column.pow(2), 2 * (column - self.column)]
                .map(|number| number as f64);
        (right - left) / apart
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The same by all pairs of pixels.
    fn by_all_pairs([width, height]: [u32; 2], mask: &[bool]) -> Vec<Option<u64>> {
        let pixels = || (0..height).flat_map(|i| (0..width).map(move |j| [i, j]));
        let covered: Vec<[u32; 2]> =
            pixels().zip(mask).filter(|(_, is_in)| **is_in).map(|(pixel, _)| pixel).collect();
        let squared = |[i, j]: [u32; 2], [k, l]: [u32; 2]| {
            u64::from(i.abs_diff(k)).pow(2) + u64::from(j.abs_diff(l)).pow(2)
        };
        pixels().map(|a| covered.iter().map(|&b| squared(a, b)).min()).collect()
    }

    proptest! {
        #[test]
        fn distances_are_exact(
            width in 1..24_u32,
            height in 1..24_u32,
            density in 1..40_u8,
            seeds in prop::collection::vec(any::<u8>(), 24 * 24),
        ) {
            let count = (width * height) as usize;
            let mask: Vec<bool> = seeds[..count].iter().map(|seed| seed % 40 < density / 4).collect();
            let expected = by_all_pairs([width, height], &mask);
            // All pixels at once: then rows are enclosed.
            let all: Vec<[u32; 2]> =
                (0..width * height).map(|index| [index / width, index % width]).collect();
            let most = expected.iter().flatten().max().copied();
            let first = most.and_then(|_| expected.iter().position(|squared| *squared == most));
            let found = farthest([width, height], &mask, &all);
            prop_assert_eq!(found.map(|found| found.at), first.map(|index| all[index]));
            for (index, expected) in (0..width * height).zip(expected) {
                let pixel = [index / width, index % width];
                let found = farthest([width, height], &mask, &[pixel]);
                let squared = found.map(|found| found.pixels.powi(2).round());
                #[expect(clippy::cast_precision_loss, reason = "small")]
                let expected = expected.map(|squared| squared as f64);
                prop_assert_eq!(squared, expected);
            }
        }
    }
}
