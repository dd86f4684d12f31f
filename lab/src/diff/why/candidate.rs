//! A hypothesis, and how well it does.

use super::convention::{Convention, Interpolation, Pose};
use super::encoding::{Encoding, IdEncoding};
use super::expected::Score;

/// One of so many differing pixels may contradict the names of primitives.
const FEW_OTHER_NAMES: u64 = 10;
/// One of so many may be covered otherwise beside other names.
const FEW_UNCOVERED: u64 = 50;

/// A hypothesis and how well it does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) convention: Convention,
    pub(super) encoding: Encoding,
    pub(super) score: Score,
}

impl Candidate {
    pub(super) fn rank(&self) -> (u64, usize) {
        (self.score.differing, parts(&self.convention, &self.encoding))
    }

    /// Whether nearly all stays right that the file shows rightly by our conventions. Where much is missing in a file,
    /// a picture that shows little leaves few pixels, too, and explains nothing. A few pixels may be right by accident.
    ///
    /// And the more freedom a hypothesis has, the less it may leave: several parts, or a number of its own, fit a part of
    /// anything. A mask tells less than ids and distances.
    pub(super) fn may_explain(&self, ours: Score, is_mask: bool) -> bool {
        let lost = ours.shown.saturating_sub(self.score.shown);
        let explained = ours.differing.saturating_sub(self.score.differing);
        let mistakes = self.convention.mistakes();
        let parts_left = match mistakes + usize::from(self.encoding.is_another_numbering()) {
            0 | 1 => 1,
            2 => 50,
            _ => 200,
        };
        let omission_left = match (self.convention.leaves_out(), is_mask) {
            (true, true) => 50,
            (true, false) => 10,
            (false, _) => 1,
        };
        // Names that each primitive may have fit much of anything: they must agree nearly everywhere, and cover what is seen.
        let may_be_names = self.encoding.ids != IdEncoding::OneToOne
            || (FEW_OTHER_NAMES * self.score.contradicting <= ours.differing
                && FEW_UNCOVERED * self.score.coverage <= ours.differing);
        let is_measured = self.encoding.has_own_numbers() || self.convention.is_framed();
        // Another eye, or nearly the same field of view, sees much of what ours sees.
        let is_close =
            self.convention.pose != Pose::AsStated || self.convention.field.is_of_angle();
        let close_left = if is_measured || is_close { 50 } else { 1 };
        let free_left = if self.convention.is_freely_posed() { 200 } else { 1 };
        // Other distances exchange a few primitives in any picture.
        let is_interpolated = self.convention.interpolation != Interpolation::Perspective;
        let interpolated_left = if is_interpolated { 10 } else { 1 };
        let least =
            parts_left.max(omission_left).max(close_left).max(free_left).max(interpolated_left);
        let most_mistakes = if is_mask { 2 } else { 3 };
        mistakes <= most_mistakes
            && may_be_names
            && least * self.score.differing <= ours.differing
            && 10 * lost <= explained
    }
}

/// How many choices are not ours. A framing counts twice, and so does a measured pose: it says what is seen, and not why. By a contour
/// they count three times: it tells less than two mistakes that are known.
pub(super) fn parts(convention: &Convention, encoding: &Encoding) -> usize {
    let is_measured = convention.is_framed() || convention.is_posed();
    let is_of_contour = convention.is_measured_by_contour();
    let measured = usize::from(is_measured) + usize::from(is_of_contour);
    convention.mistakes() + measured + encoding.parts()
}

/// Whether a hypothesis that leaves `simpler` pixels does as well as one with more parts that leaves `fewest`: the
/// further parts explain less than half of what is left without them, or less than a thousandth of all.
pub(super) fn as_good(simpler: u64, fewest: u64, differing: u64) -> bool {
    simpler < 2 * fewest || simpler.saturating_sub(fewest) <= differing / 1000
}
