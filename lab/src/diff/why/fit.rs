//! The framing that takes a picture to the one that a file shows, by the places of its primitives in both.
//!
//! Where a picture is stretched and moved, every primitive keeps what hides it: the middle of its pixels is stretched and
//! moved alike. A line through all of these middles, by least squares, is the framing, but for what pixels round. So it is with
//! all that a mask covers, if it lies wholly in both.

use super::contour::Coverage;
use super::convention::{Framing, Placement};
use super::encoding::{Encoding, IdEncoding};
use super::expected::Expected;
use super::observed::{Observed, Values};
use crate::common::frame::NO_PRIMITIVE;
use std::collections::BTreeMap;

/// Fewer primitives may lie so by accident.
const FEWEST_PRIMITIVES: usize = 3;

/// A framing, and how well the places of primitives tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    pub(super) framing: Framing,
    /// The lesser one of the correlations along both axes: 1 where all places lie on a line.
    pub(super) correlation: f64,
}

/// Where a number lies in a picture.
#[derive(Clone, Copy, Debug, Default)]
struct Spot {
    pixels: f64,
    sum: [f64; 2],
    squares: [f64; 2],
    /// Whether a part of it may lie beside the picture.
    is_cut: bool,
}

impl Spot {
    fn add(&mut self, at: [f64; 2], is_at_border: bool) {
        self.pixels += 1.0;
        for (axis, at) in at.into_iter().enumerate() {
            self.sum[axis] += at;
            self.squares[axis] += at * at;
        }
        self.is_cut |= is_at_border;
    }

    fn middle(&self, axis: usize) -> f64 {
        self.sum[axis] / self.pixels
    }

    /// The root of the mean square of the distances from the middle.
    fn spread(&self, axis: usize) -> f64 {
        let middle = self.middle(axis);
        (self.squares[axis] / self.pixels - middle * middle).max(0.0).sqrt()
    }
}

/// A primitive that lies wholly in both pictures.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) id: u32,
    /// In the picture, and in the file.
    spots: [Spot; 2],
}

impl Seen {
    /// The number of its pixels, in the picture in which it has fewer.
    pub(super) fn weight(&self) -> f64 {
        self.spots[0].pixels.min(self.spots[1].pixels)
    }

    /// By how many columns to the right and rows down the middle of its pixels lies from that in our picture.
    pub(super) fn offset(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.spots[1].middle(axis) - self.spots[0].middle(axis))
    }
}

/// The primitives that lie wholly in both pictures. Only files of ids tell: a mask is one shape, which may as well be an object of
/// another size.
pub(super) fn seen_in_both(
    expected: &Expected,
    observed: &Observed,
    placement: Placement,
    encoding: &Encoding,
) -> Option<Vec<Seen>> {
    let Values::Ids(numbers) = &observed.values else { return None };
    if encoding.ids == IdEncoding::OneToOne {
        return None;
    }
    let [width, height] = expected.size();
    #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
    let at = |index: usize, side: usize| index as f64 + 0.5 - side as f64 / 2.0;
    let numbering = expected.numbering(encoding.ids);
    let mut ours = BTreeMap::<u64, (u32, Spot)>::new();
    let mut theirs = BTreeMap::<u64, Spot>::new();
    expected.each_pixel(placement, |pixel, index, [row, column]| {
        let place = [at(column, width), at(row, height)];
        let is_at_border = [row, column].contains(&0) || row + 1 == height || column + 1 == width;
        let id = expected.drawn.ids[pixel];
        if id != NO_PRIMITIVE {
            let number = numbering.number(id);
            let (_, spot) = ours.entry(number).or_insert((id, Spot::default()));
            spot.add(place, is_at_border);
        }
        if let Some(number) = numbers[index].filter(|_| observed.covered(index, encoding.nothing)) {
            theirs.entry(number).or_default().add(place, is_at_border);
        }
    });
    let both = ours.iter().filter_map(|(number, &(id, own))| {
        let spots = [own, *theirs.get(number)?];
        spots.iter().all(|spot| !spot.is_cut).then_some(Seen { id, spots })
    });
    Some(both.collect())
}

/// The framing under which the picture is the file, as far as primitives tell that lie wholly in both.
pub(super) fn framing_of_file(
    expected: &Expected,
    observed: &Observed,
    placement: Placement,
    encoding: &Encoding,
) -> Option<Fit> {
    let seen = seen_in_both(expected, observed, placement, encoding)?;
    let pairs: Vec<[Spot; 2]> = seen.into_iter().map(|seen| seen.spots).collect();
    if pairs.len() < FEWEST_PRIMITIVES {
        return None;
    }
    let [x, y] = [0, 1].map(|axis| line(&pairs, axis));
    let ([x, right, of_x], [y, down, of_y]) = (x?, y?);
    let framing = Framing { scale: [x, y], shift: [right, down], ..Framing::default() };
    Some(Fit { framing, correlation: of_x.min(of_y) })
}

/// The framing under which what one mask covers is what another one does: by the middles of both and how far they spread. `None`
/// where a part of one may lie beside the picture, and it tells neither.
pub(super) fn framing_of_mask(ours: &Coverage, theirs: &Coverage) -> Option<Framing> {
    let spots = [ours, theirs].map(|coverage| {
        let mut spot = Spot::default();
        coverage.each_covered(|place, is_at_border| spot.add(place, is_at_border));
        spot
    });
    if spots.iter().any(|spot| spot.is_cut || spot.pixels == 0.0) {
        return None;
    }
    let [x, y] = [0, 1].map(|axis| line(&[spots], axis));
    let ([x, right, _], [y, down, _]) = (x?, y?);
    Some(Framing { scale: [x, y], shift: [right, down], ..Framing::default() })
}

/// The scale, the shift and the correlation along one axis, where the places in both pictures lie on a line, but for what
/// pixels round.
fn line(pairs: &[[Spot; 2]], axis: usize) -> Option<[f64; 3]> {
    let weight = |[own, other]: &[Spot; 2]| own.pixels.min(other.pixels);
    let all: f64 = pairs.iter().map(weight).sum();
    let middles = [0, 1].map(|side: usize| {
        let sum: f64 = pairs.iter().map(|pair| weight(pair) * pair[side].middle(axis)).sum();
        sum / all
    });
    /// The least correlation.
    const LEAST: f64 = 0.95;
    let (mut both, mut own_square, mut other_square) = (0.0, 0.0, 0.0);
    for pair in pairs {
        let [own, other] = [0, 1].map(|side: usize| pair[side].middle(axis) - middles[side]);
        let [own_spread, other_spread] = [0, 1].map(|side: usize| pair[side].spread(axis));
        both += weight(pair) * (own * other + own_spread * other_spread);
        own_square += weight(pair) * (own * own + own_spread * own_spread);
        other_square += weight(pair) * (other * other + other_spread * other_spread);
    }
    let scale = both / own_square;
    let correlation = both / (own_square * other_square).sqrt();
    (correlation > LEAST).then(|| [scale, middles[1] - scale * middles[0], correlation])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_through_the_middles() {
        let spot = |middle: f64, half: f64| {
            let mut spot = Spot::default();
            spot.add([middle - half, 0.0], false);
            spot.add([middle + half, 1.0], false);
            spot
        };
        let pairs = [-3.0, 0.5, 7.0].map(|at: f64| [spot(at, 1.0), spot(1.5 * at - 2.0, 1.5)]);
        assert_eq!(line(&pairs, 0), Some([1.5, -2.0, 1.0]));
        // What has no extent along an axis has no scale there.
        let flat = [1.0, 1.0, 1.0].map(|at: f64| [spot(at, 0.0), spot(at, 0.0)]);
        assert_eq!(line(&flat, 0), None);
        let mirrored = [-3.0, 0.5, 7.0].map(|at: f64| [spot(at, 1.0), spot(-at, 1.0)]);
        assert_eq!(line(&mirrored, 0), None);
    }

    #[test]
    fn a_mask_that_is_stretched_and_moved_tells_both() {
        let ellipse = |[x, y]: [f64; 2], [a, b]: [f64; 2]| {
            let covered = (0..200 * 100_u32).map(|at| {
                let (column, row) = (f64::from(at % 200) + 0.5, f64::from(at / 200) + 0.5);
                ((column - 100.0 - x) / a).powi(2) + ((row - 50.0 - y) / b).powi(2) < 1.0
            });
            Coverage::new(200, covered.collect())
        };
        let ours = ellipse([10.0, -5.0], [40.0, 30.0]);
        let theirs = ellipse([10.0 * 1.2 - 7.0, -5.0 * 0.9 + 3.5], [40.0 * 1.2, 30.0 * 0.9]);
        let Framing { scale, shift, .. } = framing_of_mask(&ours, &theirs).unwrap();
        for (measured, by) in scale.iter().chain(&shift).zip([1.2, 0.9, -7.0, 3.5]) {
            assert!((measured - by).abs() < 0.05, "{scale:?} {shift:?}");
        }
        // A part of it lies beside the picture, or it covers nothing.
        assert_eq!(framing_of_mask(&ours, &ellipse([70.0, 0.0], [40.0, 30.0])), None);
        assert_eq!(framing_of_mask(&ours, &ellipse([0.0, 0.0], [0.1, 0.1])), None);
    }
}
