//! The contour of our picture: where what is covered ends, and how much farther out it ends in a mask.
//!
//! A mask has no primitives whose middles could be held against ours. But where the eye moves, the points of the scene that are seen
//! at the contour take it with them. How far along the contour, nothing tells; so only the way across it counts (Chris Harris, Carl
//! Stennett, "RAPID - a video rate object tracker", British Machine Vision Conference, 1990). That way is measured by area, which is
//! finer than a pixel: the pixels that only one of both covers, each held against the nearest piece of our contour.

use super::expected::Expected;
use crate::common::frame::NO_PRIMITIVE;

/// What is covered in a picture, row by row.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    width: usize,
    covered: Vec<bool>,
}

/// A place in a picture: columns to the right and rows down from its upper left corner.
pub(super) type Place = [f64; 2];

/// A side between two pixels, of which one is covered.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Row and column of both.
    covered: [usize; 2],
    beside: [usize; 2],
    /// The middle of the side.
    place: Place,
}

/// The side between a covered pixel and one that is not, as a piece of the contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    /// The covered pixel: row and column.
    pub(super) pixel: [usize; 2],
    /// The middle of the side.
    pub(super) place: Place,
    /// The unit vector across the contour, away from what is covered.
    pub(super) across: [f64; 2],
    /// How long the contour is there, in pixels: 1 where it runs along the side.
    pub(super) length: f64,
    /// By how many pixels the other mask goes farther out; negative where it ends before.
    pub(super) farther: f64,
}

/// So far from a side, in pixels, the direction of the contour is measured.
const REACH: usize = 3;

/// Where the pixels around a side tell less of a direction than this, it is thin, or a corner: a straight contour tells 1.
const LEAST_STRAIGHT: f64 = 0.5;

/// Pixels that are farther from the contour than so many times the middle one of them, and a pixel, tell nothing of it.
const FAR: f64 = 3.0;

/// Sides that run nearly across the contour count as pieces of this length: none has length 0.
const SHORTEST: f64 = 0.05;

impl Coverage {
    pub(super) fn new(width: usize, covered: Vec<bool>) -> Coverage {
        Coverage { width, covered }
    }

    /// What is covered in our picture.
    pub(super) fn of(expected: &Expected) -> Coverage {
        let [width, _] = expected.size();
        let covered = expected.drawn.ids.iter().map(|id| *id != NO_PRIMITIVE);
        Coverage::new(width, covered.collect())
    }

    fn height(&self) -> usize {
        self.covered.len() / self.width
    }

    fn is_covered(&self, [row, column]: [usize; 2]) -> bool {
        self.covered[row * self.width + column]
    }

    /// Tells of each covered pixel: its place from the middle of the picture, and whether it lies at the border.
    pub(super) fn each_covered(&self, mut tell: impl FnMut(Place, bool)) {
        let (width, height) = (self.width, self.height());
        for index in (0..self.covered.len()).filter(|&index| self.covered[index]) {
            let [row, column] = [index / width, index % width];
            let is_at_border =
                [row, column].contains(&0) || row + 1 == height || column + 1 == width;
            tell(self.offset(middle_of([row, column])), is_at_border);
        }
    }

    /// The number of columns.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
    pub(super) fn width(&self) -> f64 {
        self.width as f64
    }

    /// How far a place lies from the middle of the picture.
    pub(super) fn offset(&self, place: Place) -> Place {
        #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
        let middle = [self.width, self.height()].map(|side| side as f64 / 2.0);
        [0, 1].map(|axis| place[axis] - middle[axis])
    }

    /// The sides between covered pixels and others.
    fn sides(&self) -> Vec<Side> {
        let mut sides = Vec::new();
        #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
        let middle = |one: usize, other: usize| (one + other + 1) as f64 / 2.0;
        let mut pair = |one: [usize; 2], other: [usize; 2]| {
            let place = [middle(one[1], other[1]), middle(one[0], other[0])];
            match (self.is_covered(one), self.is_covered(other)) {
                (true, false) => sides.push(Side { covered: one, beside: other, place }),
                (false, true) => sides.push(Side { covered: other, beside: one, place }),
                _ => {}
            }
        };
        for row in 0..self.height() {
            for column in 0..self.width {
                if column + 1 < self.width {
                    pair([row, column], [row, column + 1]);
                }
                if row + 1 < self.height() {
                    pair([row, column], [row + 1, column]);
                }
            }
        }
        sides
    }

    /// The contour, piece by piece, and how much farther out another mask of this size goes; without what is thin, and what lies at
    /// the picture's border.
    pub(super) fn contour(&self, other: &Coverage) -> Vec<Piece> {
        let sides = self.sides();
        let areas = self.areas(&sides, other);
        let pieces =
            sides.iter().zip(areas).filter_map(|(&Side { covered, beside, place }, area)| {
                let across = self.across(covered, place)?;
                let is_upright = covered[0] == beside[0];
                let length = across[usize::from(!is_upright)].abs().max(SHORTEST);
                Some(Piece { pixel: covered, place, across, length, farther: area / length })
            });
        pieces.collect()
    }

    /// For each side, the pixels that another mask covers beyond it, less those that it does not cover before it.
    fn areas(&self, sides: &[Side], other: &Coverage) -> Vec<f64> {
        let nearest = self.nearest(sides);
        let differing = (0..self.covered.len()).filter_map(|index| {
            let side = nearest[index].filter(|_| self.covered[index] != other.covered[index])?;
            let ([x, y], [u, v]) =
                (middle_of([index / self.width, index % self.width]), sides[side].place);
            Some((side, other.covered[index], (x - u).hypot(y - v)))
        });
        let differing: Vec<(usize, bool, f64)> = differing.collect();
        let mut far: Vec<f64> = differing.iter().map(|(.., far)| *far).collect();
        far.sort_by(f64::total_cmp);
        // What lies farther from the contour than most belongs to something that is seen in one of both alone, as a hole that closes.
        let most = far.get(far.len() / 2).map_or(0.0, |middle| FAR * middle + 1.0);
        let mut areas = vec![0.0; sides.len()];
        for (side, is_covered, _) in differing.into_iter().filter(|(.., far)| *far <= most) {
            areas[side] += if is_covered { 1.0 } else { -1.0 };
        }
        areas
    }

    /// The direction across the contour, by the pixels around a place of it; `None` where some of these lie beside the picture.
    fn across(&self, [row, column]: [usize; 2], place: Place) -> Option<[f64; 2]> {
        let around = |at: usize, count: usize| {
            let (first, end) = (at.checked_sub(REACH)?, at + REACH + 1);
            (end <= count).then_some(first..end)
        };
        let (rows, columns) = (around(row, self.height())?, around(column, self.width)?);
        let (mut sum, mut all) = ([0.0; 2], 0.0);
        for row in rows {
            for column in columns.clone() {
                let [x, y] = middle_of([row, column]);
                let away = [x - place[0], y - place[1]];
                let sign = if self.is_covered([row, column]) { -1.0 } else { 1.0 };
                sum = [0, 1].map(|axis| sum[axis] + sign * away[axis]);
                all += away[0].hypot(away[1]);
            }
        }
        let length = f64::hypot(sum[0], sum[1]);
        // Of all ways from a point, those across a line are 2/π in the mean.
        (length >= LEAST_STRAIGHT * std::f64::consts::FRAC_2_PI * all)
            .then(|| sum.map(|sum| sum / length))
    }

    /// For each pixel, which side is nearest, or nearly so: sides are handed on from pixel to pixel, down and to the right, then up
    /// and to the left (Per-Erik Danielsson, "Euclidean distance mapping", Computer Graphics and Image Processing, 1980).
    fn nearest(&self, sides: &[Side]) -> Vec<Option<usize>> {
        let (width, height) = (self.width, self.height());
        let mut nearest: Vec<Option<usize>> = vec![None; self.covered.len()];
        for (side, &Side { covered, beside, .. }) in sides.iter().enumerate() {
            for [row, column] in [covered, beside] {
                nearest[row * width + column] = Some(side);
            }
        }
        let mut take = |to: [usize; 2], [row, column]: [Option<usize>; 2]| {
            let (Some(row), Some(column)) = (row, column) else { return };
            if row >= height || column >= width {
                return;
            }
            let [x, y] = middle_of(to);
            let far = |side: usize| {
                let [u, v] = sides[side].place;
                (u - x).hypot(v - y)
            };
            let own = nearest[to[0] * width + to[1]];
            let from = nearest[row * width + column];
            if from.is_some_and(|from| own.is_none_or(|own| far(from) < far(own))) {
                nearest[to[0] * width + to[1]] = from;
            }
        };
        for row in 0..height {
            for column in 0..width {
                take([row, column], [row.checked_sub(1), Some(column)]);
                take([row, column], [Some(row), column.checked_sub(1)]);
            }
            for column in (0..width).rev() {
                take([row, column], [Some(row), Some(column + 1)]);
            }
        }
        for row in (0..height).rev() {
            for column in (0..width).rev() {
                take([row, column], [Some(row + 1), Some(column)]);
                take([row, column], [Some(row), Some(column + 1)]);
            }
            for column in 0..width {
                take([row, column], [Some(row), column.checked_sub(1)]);
            }
        }
        nearest
    }
}

/// The middle of a pixel.
#[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
fn middle_of([row, column]: [usize; 2]) -> Place {
    [column as f64 + 0.5, row as f64 + 0.5]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How long a line that moves by 0.37 columns a row is for each.
    const LENGTH: f64 = 1.066;

    /// What lies left of a line that goes through columns of rows.
    fn left_of(line: impl Fn(f64) -> f64) -> Coverage {
        let covered = (0..40 * 30).map(|at: u32| {
            let (row, column) = (f64::from(at / 40) + 0.5, f64::from(at % 40) + 0.5);
            column < line(row)
        });
        Coverage::new(40, covered.collect())
    }

    #[test]
    fn a_contour_points_away_from_what_is_covered() {
        let coverage = left_of(|row| 12.0 + 0.37 * row);
        let pieces = coverage.contour(&coverage);
        assert!(pieces.len() > 20, "{}", pieces.len());
        let across = [1.0, -0.37].map(|part: f64| part / LENGTH);
        for piece in &pieces {
            assert!(coverage.is_covered(piece.pixel) && piece.farther == 0.0, "{piece:?}");
            let [x, y] = piece.place;
            assert!((x - (12.0 + 0.37 * y)).abs() < 1.0, "{piece:?}");
            let cosine = piece.across[0] * across[0] + piece.across[1] * across[1];
            assert!(cosine > 0.95, "{piece:?}");
        }
        // 24 rows lie away from the border.
        let length: f64 = pieces.iter().map(|piece| piece.length).sum();
        assert!((length - 24.0 * LENGTH).abs() < 1.0, "{length}");
        let all = Coverage::new(4, vec![true; 12]);
        assert_eq!(all.contour(&Coverage::new(4, vec![false; 12])), []);
    }

    #[test]
    fn how_much_farther_out_a_mask_goes_is_finer_than_a_pixel() {
        let ours = left_of(|row| 12.0 + 0.37 * row);
        for by in [5.0, 0.4, 0.0, -0.3, -4.0] {
            let pieces = ours.contour(&left_of(|row| 12.0 + by + 0.37 * row));
            // Away from both ends of the line.
            let pieces: Vec<&Piece> =
                pieces.iter().filter(|piece| (6..24).contains(&piece.pixel[0])).collect();
            let length: f64 = pieces.iter().map(|piece| piece.length).sum();
            let area: f64 = pieces.iter().map(|piece| piece.length * piece.farther).sum();
            let expected = by / LENGTH;
            assert!((area / length - expected).abs() < 0.1, "{by} {}", area / length);
        }
    }
}
