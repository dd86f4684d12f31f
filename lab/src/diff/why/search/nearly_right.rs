//! A picture that is right but for a few pixels beside edges.

use super::{Explanation, FEW, Search};
use crate::diff::why::candidate::Candidate;
use crate::diff::why::convention::{Change, Vertices};

/// One pixel in so many may differ in a picture that is nearly right.
const MANY: u64 = 50;
/// So few pixels may be as expected by accident.
const FEWEST_PIXELS: u64 = 16;

impl Search<'_> {
    /// Vertices on a fine grid, as GPUs have them, if they explain all but a few of the differing pixels. Then nothing else is
    /// sought, which would take long: what moves more than that leaves no picture nearly right.
    pub(super) fn by_vertices(&self) -> Vec<Explanation> {
        let ours = self.ours_in_place();
        let (differing, pixels) = (ours.score.differing, self.truth.ids.len() as u64);
        if differing < FEWEST_PIXELS || differing * MANY > pixels {
            return Vec::new();
        }
        let fine = Vertices::OTHERS.into_iter().filter(|vertices| vertices.is_nearly_exact());
        let drawn = fine.map(|one| self.drawn_whole(ours.convention.with(Change::Vertices(one))));
        let explains = |one: &Candidate| one.score.differing * FEW <= differing;
        let found: Vec<Candidate> = drawn.filter(explains).collect();
        self.best(&found, self.ours)
    }
}
