//! Runs of pixels in which two buffers are alike: whole masks, rows of masks, and up to 64 pixels of anything.

use super::bits::{bits, packed};
use super::buffer::{Buffer, Content, Covered, Pixels};
use crate::common::engine::simd::{Simd, best_level, dispatch};
use crate::common::frame::{Ids, NO_PRIMITIVE, NO_WIDE_PRIMITIVE};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

impl Buffer<'_> {
    /// The covered ones of up to 64 pixels of a row, if the other buffer is of the same kind and differs there by no more
    /// than is known of others; both have one sample a pixel. Pixels of colours alone count as covered.
    pub(super) fn alike_run(
        &self,
        other: &Buffer,
        row: u32,
        columns: Range<u32>,
        known: Known,
    ) -> Option<u64> {
        let [first, end] = [columns.start, columns.end].map(|j| self.pixel([row, j]));
        let run = first..end;
        match (self.content(), other.content()) {
            (Content::Mask(a), Content::Mask(b)) => {
                let (a, b) = (&a[run.clone()], &b[run]);
                dispatch!(best_level(), simd => (a == b).then(|| packed(simd, a)))
            }
            (Content::Ids(a), Content::Ids(b)) => {
                let (a, b) = (&a[run.clone()], &b[run]);
                all(a, b, |a, b| a == b).then(|| bits(a.iter().map(Option::is_some)))
            }
            (Content::Distances(a), Content::Distances(b)) => {
                let (a, b) = (&a[run.clone()], &b[run]);
                let alike = |a: &f64, b: &f64| known.covers_distances(*a, *b);
                all(a, b, alike).then(|| bits(a.iter().map(|t| t.is_finite())))
            }
            (Content::Picture(a), Content::Picture(b)) if a.covered == b.covered => {
                let are_equal = match (&a.pixels, &b.pixels) {
                    (Pixels::Bytes(a), Pixels::Bytes(b)) => a[run.clone()] == b[run.clone()],
                    (of_a @ Pixels::Opaque(_), of_b @ Pixels::Opaque(_)) => {
                        of_a.opaque()[run.clone()] == of_b.opaque()[run.clone()]
                    }
                    _ => false,
                };
                if !are_equal {
                    return None;
                }
                let covered = |at: usize| a.covered(at) != Some(false);
                // Of colours alone, nothing tells otherwise.
                let is_unknown = a.covered == Covered::Unknown;
                Some(bits(run.map(|at| is_unknown || covered(at))))
            }
            (Content::Frame(a), Content::Frame(b)) => {
                let ids = [a, b].map(|seen| seen.frame.ids().of(run.clone()));
                let t = [a, b].map(|seen| &seen.frame.distances()[run.clone()]);
                let bytes = 3 * run.start..3 * run.end;
                let colors = [a, b].map(|seen| &seen.picture.as_raw()[bytes.clone()]);
                let is_alike = ids[0] == ids[1]
                    && all(t[0], t[1], |a, b| known.covers_distances((*a).into(), (*b).into()))
                    && all(colors[0], colors[1], |a, b| known.covers_steps(a.abs_diff(*b)));
                is_alike.then(|| match ids[0] {
                    Ids::Narrow(ids) => bits(ids.iter().map(|&id| id != NO_PRIMITIVE)),
                    Ids::Wide(ids) => bits(ids.iter().map(|&id| id != NO_WIDE_PRIMITIVE)),
                })
            }
            _ => None,
        }
    }

    /// The values of a mask that is equal to the other one, and how many of them are covered; `None` if they differ
    /// anywhere, or if these are no masks.
    pub(super) fn equal_mask(&self, other: &Buffer) -> Option<(&Arc<Vec<bool>>, u64)> {
        /// Few enough that all processors have work, and enough that handing it out costs nothing.
        const AT_ONCE: usize = 1 << 16;
        let (Content::Mask(a), Content::Mask(b)) = (self.content(), other.content()) else {
            return None;
        };
        let parts = a.par_chunks(AT_ONCE).zip(b.par_chunks(AT_ONCE));
        let covered = parts.map(|(a, b)| dispatch!(best_level(), _simd => covered_if_equal(a, b)));
        let covered = covered.try_reduce(|| 0, |one, other| Some(one + other))?;
        Some((a, covered))
    }

    /// Stores a bit for each pixel of a row of two masks of one sample a pixel, 64 pixels of this one and of the other in a
    /// word each. Gives the number of pixels that both cover, that this one alone, and that the other alone covers; `None` if
    /// these are no masks.
    pub(super) fn mask_row(
        &self,
        other: &Buffer,
        row: u32,
        words: &mut Vec<[u64; 2]>,
    ) -> Option<[u64; 3]> {
        let (Content::Mask(a), Content::Mask(b)) = (self.content(), other.content()) else {
            return None;
        };
        let first = self.pixel([row, 0]);
        let run = first..first + self.size()[0] as usize;
        words.clear();
        words.reserve(run.len().div_ceil(64));
        let [a, b] = [&a[run.clone()], &b[run]];
        Some(dispatch!(best_level(), simd => packed_pairs(simd, [a, b], words)))
    }
}

/// The largest differences that are known of other pixels, and are within the tolerances.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    /// The relative difference of distances.
    pub(super) t: f64,
    /// The difference of colours, in steps of 1/255.
    pub(super) color: f32,
}

impl Known {
    /// Whether two distances certainly differ by no more: nothing and nothing, equal ones, or close ones. The bound is a
    /// little smaller than what is known, as both sides round.
    fn covers_distances(self, a: f64, b: f64) -> bool {
        const SMALLER: f64 = 1.0 - 8.0 * f64::EPSILON;
        let larger = a.abs().max(b.abs());
        let is_close = (a - b).abs() <= larger * self.t * SMALLER;
        // Where nothing under- or overflows; `max` leaves out NaN.
        let is_ordinary = (larger > 1e-290) & (larger < 1e290) & !a.is_nan() & !b.is_nan();
        (a.to_bits() == b.to_bits()) | (is_close & is_ordinary)
    }

    fn covers_steps(self, steps: u8) -> bool {
        f32::from(steps) <= self.color
    }
}

/// Whether a condition holds for all pairs. Every pair is looked at, without a branch.
fn all<T>(a: &[T], b: &[T], holds: impl Fn(&T, &T) -> bool) -> bool {
    a.iter().zip(b).fold(true, |all, (a, b)| all & holds(a, b))
}

/// The number of true ones among values; `None` if others are not equal to them. What was compared is counted while it is in
/// the nearest cache.
#[inline(always)]
fn covered_if_equal(values: &[bool], others: &[bool]) -> Option<u64> {
    /// The sums of so many columns are counted beside one another, in bytes.
    const LANES: usize = 64;
    /// So many values at once: no sum is more than a byte holds, and twice as many bytes fit into that cache.
    const AT_ONCE: usize = 128 * LANES;
    let (mut columns, mut count) = ([0_u32; LANES], 0);
    for (values, others) in values.chunks(AT_ONCE).zip(others.chunks(AT_ONCE)) {
        if values != others {
            return None;
        }
        let (lines, rest) = values.as_chunks::<LANES>();
        let mut sums = [0_u8; LANES];
        for line in lines {
            for (sum, value) in sums.iter_mut().zip(line) {
                *sum += u8::from(*value);
            }
        }
        for (column, sum) in columns.iter_mut().zip(sums) {
            *column += u32::from(sum);
        }
        count += rest.iter().map(|value| u64::from(*value)).sum::<u64>();
    }
    Some(count + columns.into_iter().map(u64::from).sum::<u64>())
}

/// Packs the values of both into words of 64 bits; counts what is true in both, in the first alone and in the second alone.
#[inline(always)]
fn packed_pairs<S: Simd>(
    simd: S,
    [values, others]: [&[bool]; 2],
    words: &mut Vec<[u64; 2]>,
) -> [u64; 3] {
    let mut counts = [0; 3];
    for (values, others) in values.chunks(64).zip(others.chunks(64)) {
        let [a, b] = [packed(simd, values), packed(simd, others)];
        for (count, bits) in counts.iter_mut().zip([a & b, a & !b, !a & b]) {
            *count += u64::from(bits.count_ones());
        }
        words.push([a, b]);
    }
    counts
}
