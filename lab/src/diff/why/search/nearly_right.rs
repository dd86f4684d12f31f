//! A picture that is right but for a few pixels beside edges.

use super::Search;
use crate::diff::why::candidate::Candidate;
use crate::diff::why::convention::{Change, Convention, Vertices};
use crate::diff::why::finding::{Explanation, Finding};
use crate::diff::why::pixels::{PixelReason, find_reasons};
use crate::diff::why::reason::Reason;

/// One pixel in so many may differ in a picture that is nearly right; in a small one, some more.
const MANY: u64 = 50;
/// Fewer pixels may be as expected by accident. What changes no others is rarely that.
const FEWEST_PIXELS: u64 = 4;
/// Fewer pixels may lie near outlines by accident, unless they lie very near.
const FEW_PIXELS: u64 = 16;
/// How near: half a step of a GPU's grid, in pixels.
const VERY_NEAR: f64 = 1.0 / 512.0;
/// One of so many differing pixels may be left by a way of rounding vertices: the renderer rounds elsewhere, too.
const LEFT: u64 = 10;

impl Search<'_> {
    /// What is found where only pixels beside edges differ. Then nothing else is sought, which would take long: what moves more
    /// than rounding does leaves no picture nearly right.
    pub(super) fn nearly_right(&self, ours: &Candidate) -> Option<Finding> {
        let (differing, pixels) = (ours.score.differing, self.truth.ids.len() as u64);
        if differing * MANY > pixels && differing >= FEW_PIXELS {
            return None;
        }
        if differing >= FEWEST_PIXELS {
            let by_vertices = self.by_vertices(ours);
            if !by_vertices.is_empty() {
                return Some(Finding::Explained(by_vertices));
            }
        }
        self.is_by_rounding_alone(ours).then_some(Finding::Rounded)
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
        if ours.convention != Convention::default() || !ours.encoding.is_ours() {
            return false;
        }
        let differing = self.pixels(&self.differing_by_ours());
        let are_few = (differing.len() as u64) < FEW_PIXELS;
        let is_rounding = |one: &PixelReason| match one.reason {
            Reason::Rounding { pixels, .. } => !are_few || pixels <= VERY_NEAR,
            Reason::DistanceRounding { .. } => true,
            _ => false,
        };
        find_reasons(self.view, self.file, self.file, &differing)
            .is_ok_and(|reasons| reasons.pixels.iter().all(is_rounding))
    }
}
