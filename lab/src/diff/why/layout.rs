//! A buffer that is written or read at a wrong offset, or with rows of a wrong length.
//!
//! A picture whose rows are too long or too short, or that begins too late, is no picture of any camera, but each of its
//! numbers is right: at another place. The place is found by pixels that differ from their left neighbours, which tell most.

use super::drawn::Drawn;
use super::observed::{Observed, Values};
use super::shown::is_same_distance;
use crate::common::frame::NO_PRIMITIVE;

/// Where the numbers of a picture lie in a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// All lie farther by so many elements, or nearer to the beginning.
    Shifted {
        /// The number of elements.
        by: isize,
    },
    /// Rows begin every so many elements, not every `W`.
    Stride {
        /// The number of elements.
        stride: usize,
    },
}

/// So many pixels tell whether a layout is possible.
const PROBES: usize = 512;
/// Fewer tell nothing.
const FEWEST_PROBES: usize = 16;
/// The farthest shift, in elements; and no more than this part of the picture.
const FARTHEST: usize = 1 << 16;
const LARGEST_PART: usize = 4;
/// One in so many of the differing pixels may be left.
const LEFT: usize = 50;

/// The layout that explains nearly all of the differing pixels of an upright file, and where it still differs.
pub(super) fn layout(truth: &Drawn, observed: &Observed) -> Option<(Layout, Vec<bool>)> {
    let pixels = Pixels { truth, observed };
    let count = truth.ids.len();
    let differing = (0..count).filter(|&at| !pixels.agree(at, Some(at))).count();
    let probes = pixels.probes();
    if differing == 0 || probes.len() < FEWEST_PROBES {
        return None;
    }
    let shifts = pixels.shift(&probes).into_iter().map(|by| {
        let differs = (0..count).map(|at| pixels.differs_shifted(at, by)).collect();
        (Layout::Shifted { by }, differs)
    });
    let strides = pixels.stride(&probes).into_iter().flat_map(|stride| {
        [false, true].map(|nearest| {
            let sources = pixels.sources(stride, nearest);
            let differs: Vec<bool> =
                sources.iter().enumerate().map(|(at, &from)| !pixels.agree(at, from)).collect();
            (Layout::Stride { stride }, differs)
        })
    });
    let left = |differs: &[bool]| differs.iter().filter(|&&differs| differs).count();
    let found = shifts.chain(strides).min_by_key(|(_, differs)| left(differs))?;
    (LEFT * left(&found.1) <= differing).then_some(found)
}

struct Pixels<'a> {
    truth: &'a Drawn,
    observed: &'a Observed,
}

impl Pixels<'_> {
    /// Whether an element of the file shows what is seen at a pixel; `None` for nothing.
    fn agree(&self, element: usize, pixel: Option<usize>) -> bool {
        let seen = pixel.filter(|&pixel| self.truth.ids[pixel] != NO_PRIMITIVE);
        match &self.observed.values {
            Values::Mask(mask) => mask[element] == seen.is_some(),
            Values::Ids(ids) => ids[element] == seen.map(|pixel| self.truth.ids[pixel].into()),
            Values::Distances(t) => match seen {
                Some(pixel) => {
                    t[element].is_finite() && is_same_distance(t[element], self.truth.t[pixel])
                }
                None => !t[element].is_finite(),
            },
        }
    }

    /// Pixels that show another primitive than their left neighbours, or in a mask something beside nothing; evenly spread.
    fn probes(&self) -> Vec<usize> {
        let ids = &self.truth.ids;
        let is_mask = matches!(self.observed.values, Values::Mask(_));
        let number = |at: usize| match is_mask {
            true => u32::from(ids[at] != NO_PRIMITIVE),
            false => ids[at],
        };
        let telling = (1..ids.len()).filter(|&at| number(at) != number(at - 1));
        // An edge has two sides.
        let telling: Vec<usize> = telling.flat_map(|at| [at - 1, at]).collect();
        let step = telling.len().div_ceil(PROBES).max(1);
        // An odd step takes both sides in turn.
        telling.into_iter().step_by(step | 1).collect()
    }

    /// The shift under which most probes agree, if most of them do.
    fn shift(&self, probes: &[usize]) -> Option<isize> {
        let count = self.truth.ids.len();
        let farthest = (count / LARGEST_PART).min(FARTHEST).cast_signed();
        let agreeing = |by: isize| {
            let placed = probes.iter().filter_map(|&pixel| {
                let element = pixel.checked_add_signed(by).filter(|&element| element < count)?;
                Some(self.agree(element, Some(pixel)))
            });
            most(placed)
        };
        let shifts = (-farthest..=farthest).filter(|&by| by != 0);
        best(shifts, agreeing)
    }

    /// Whether an element differs from a shifted picture; beyond its end begins it again, or is nothing.
    fn differs_shifted(&self, element: usize, by: isize) -> bool {
        let count = self.truth.ids.len();
        let from = element.checked_add_signed(-by).filter(|&pixel| pixel < count);
        let again = || {
            let pixel = (element.cast_signed() - by).rem_euclid(count.cast_signed());
            self.agree(element, Some(pixel.cast_unsigned()))
        };
        !(self.agree(element, from) || from.is_none() && again())
    }

    /// The stride under which most probes agree, if most of them do.
    fn stride(&self, probes: &[usize]) -> Option<usize> {
        let (width, count) = (self.truth.width, self.truth.ids.len());
        let agreeing = |stride: usize| {
            let placed = probes.iter().filter_map(|&pixel| {
                let (row, column) = (pixel / width, pixel % width);
                // The next row may be written over what lies farther right, and nothing over the end of the row before.
                let is_alone = column + stride >= width || 2 * stride <= width;
                let element = (column < stride && is_alone).then_some(row * stride + column)?;
                (element < count).then(|| self.agree(element, Some(pixel)))
            });
            most(placed)
        };
        let strides = (width / 4).max(1)..=2 * width;
        best(strides.filter(|&stride| stride != width), agreeing)
    }

    /// The pixel that each element holds where rows begin every `stride` elements: of several that of the last row, or the nearest.
    fn sources(&self, stride: usize, nearest: bool) -> Vec<Option<usize>> {
        let truth = self.truth;
        let mut sources: Vec<Option<usize>> = vec![None; truth.ids.len()];
        let seen = (0..truth.ids.len()).filter(|&pixel| truth.ids[pixel] != NO_PRIMITIVE);
        for pixel in seen {
            let element = pixel / truth.width * stride + pixel % truth.width;
            let Some(source) = sources.get_mut(element) else { continue };
            let is_hidden = |other: usize| nearest && truth.t[other] <= truth.t[pixel];
            if !source.is_some_and(is_hidden) {
                *source = Some(pixel);
            }
        }
        sources
    }
}

/// How many of some probes agree, in thousandths; 0 for few probes. Those that begin with disagreement are given up.
fn most(agree: impl Iterator<Item = bool>) -> usize {
    let (mut all, mut agreeing) = (0, 0);
    for agrees in agree {
        all += 1;
        agreeing += usize::from(agrees);
        if all == FEWEST_PROBES && 2 * agreeing < all {
            return 0;
        }
    }
    if all < FEWEST_PROBES { 0 } else { 1000 * agreeing / all }
}

/// The number for which most probes agree, if three of five do.
fn best<Number: Copy>(
    numbers: impl Iterator<Item = Number>,
    agreeing: impl Fn(Number) -> usize,
) -> Option<Number> {
    let counted = numbers.map(|number| (number, agreeing(number)));
    let best = counted.max_by_key(|&(_, agreeing)| agreeing)?;
    (best.1 >= 600).then_some(best.0)
}
