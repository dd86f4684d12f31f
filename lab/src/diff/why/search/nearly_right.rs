//! A picture that is right but for a few pixels beside edges.

use super::Search;
use crate::diff::why::candidate::Candidate;
use crate::diff::why::convention::{Change, Convention, Placement, Vertices};
use crate::diff::why::encoding::Encoding;
use crate::diff::why::expected::Expected;
use crate::diff::why::finding::{Explanation, Finding};
use crate::diff::why::pixels::find_reasons;
use crate::diff::why::reason::ReasonKind;

/// One pixel in so many may differ in a picture that is nearly right.
const MANY: u64 = 50;
/// So few pixels may be as expected, or near an outline, by accident.
const FEWEST_PIXELS: u64 = 16;
/// One of so many differing pixels may be left by a way of rounding vertices: the renderer rounds elsewhere, too.
const LEFT: u64 = 10;

impl Search<'_> {
    /// What is found where only pixels beside edges differ. Then nothing else is sought, which would take long: what moves more
    /// than rounding does leaves no picture nearly right.
    pub(super) fn nearly_right(&self) -> Option<Finding> {
        let ours = self.ours_in_place();
        let (differing, pixels) = (ours.score.differing, self.truth.ids.len() as u64);
        if differing < FEWEST_PIXELS || differing * MANY > pixels {
            return None;
        }
        let by_vertices = self.by_vertices(&ours);
        if !by_vertices.is_empty() {
            return Some(Finding::Explained(by_vertices));
        }
        self.is_by_rounding_alone(&ours).then_some(Finding::Rounded)
    }

    /// Vertices on a fine grid, as GPUs have them, if they explain nearly all of the differing pixels.
    fn by_vertices(&self, ours: &Candidate) -> Vec<Explanation> {
        let fine = Vertices::OTHERS.into_iter().filter(|vertices| vertices.is_nearly_exact());
        let drawn = fine.map(|one| self.drawn_whole(ours.convention.with(Change::Vertices(one))));
        let explains = |one: &Candidate| one.score.differing * LEFT <= ours.score.differing;
        let found: Vec<Candidate> = drawn.filter(explains).collect();
        self.best(&found, self.ours)
    }

    /// Whether each pixel that differs under our conventions lies so near to an outline that rounding decides it, or where two
    /// distances are as near.
    fn is_by_rounding_alone(&self, ours: &Candidate) -> bool {
        let none = Encoding::default();
        if ours.convention != Convention::default() || ours.encoding != none {
            return false;
        }
        let width = self.view.camera.image()[0] as usize;
        let number = |side: usize| u32::try_from(side).expect("at most 2^16");
        let mut differing = Vec::new();
        let expected = Expected::new(self.view, &ours.convention, self.truth);
        expected.each(self.observed, Placement::Upright, &none, |index, differs, _| {
            if differs {
                differing.push([number(index / width), number(index % width)]);
            }
        });
        let is_rounding =
            |kind| matches!(kind, ReasonKind::Rounding | ReasonKind::DistanceRounding);
        find_reasons(self.view, self.file, self.file, &differing)
            .is_ok_and(|reasons| reasons.count_of(|kind| !is_rounding(kind)) == 0)
    }
}
