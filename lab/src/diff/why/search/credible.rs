//! What a hypothesis must not do, however much of the file it explains.

use super::Search;
use crate::common::frame::NO_PRIMITIVE;
use crate::diff::why::candidate::Candidate;
use crate::diff::why::convention::{Change, Placement, Pose};
use crate::diff::why::encoding::NothingEncoding;
use crate::diff::why::expected::{Expected, Score};
use crate::diff::why::observed::Values;
use std::collections::BTreeMap;

/// Where fewer pixels of an object are right, in all or in a hundred, that may be by accident.
const FEWEST_OF_OBJECT: usize = 32;
const PERCENT_OF_OBJECT: usize = 30;
/// Fewer pixels tell no eye, no axes, and no size and place of the whole picture.
const FEWEST_OF_MEASURED: u64 = 16;
/// What shows one or two primitives tells a mistake of the list if so small a part of it is left.
const LEFT_OF_FEW_IDS: u64 = 200;
/// So many of the likeliest hypotheses are looked at.
const MOST_LOOKED_AT: usize = 32;

impl Search<'_> {
    /// Whether the numbers of a hypothesis allow that it explains the file.
    pub(super) fn may_explain(&self, candidate: &Candidate, ours: Score) -> bool {
        let explained = ours.differing.saturating_sub(candidate.score.differing);
        let is_measured = candidate.convention.is_posed() || candidate.convention.is_framed();
        (!is_measured || explained >= FEWEST_OF_MEASURED)
            && self.tells_pose(candidate, ours)
            && candidate.may_explain(ours, matches!(self.observed.values, Values::Mask(_)))
            && self.shows_what_the_file_shows(candidate)
            && leaves_the_coverage(candidate, ours)
    }

    /// What shows one or two primitives, many a wrong eye sees. It takes their outlines to tell that it is one.
    fn tells_pose(&self, candidate: &Candidate, ours: Score) -> bool {
        match candidate.convention.pose {
            Pose::AsStated => true,
            _ if self.observed.shows_several_ids() => true,
            Pose::Measured(_) => false,
            _ => {
                candidate.score.differing * LEFT_OF_FEW_IDS <= ours.differing
                    && self.observed.shows_outlines()
            }
        }
    }

    /// Whether a quarter of what the file covers is right: a picture of little or nothing is as near to a file that misses much.
    fn shows_what_the_file_shows(&self, candidate: &Candidate) -> bool {
        candidate.encoding.nothing != NothingEncoding::Ours
            || 4 * candidate.score.shown >= self.covered
    }

    /// The hypotheses that lose no object which is right by ours, as far as it is seen.
    pub(super) fn credible(&self, mut candidates: Vec<Candidate>) -> Vec<Candidate> {
        let objects = self.right_objects();
        if objects.is_empty() {
            return candidates;
        }
        candidates.retain(|one| self.may_explain(one, self.ours));
        candidates.truncate(MOST_LOOKED_AT);
        candidates.retain(|one| self.keeps(&objects, one));
        candidates
    }

    /// The pixels of each object that the file shows rightly by our conventions, of those that are hardly right by accident.
    fn right_objects(&self) -> Vec<Vec<usize>> {
        if !self.placements.contains(&Placement::Upright) {
            return Vec::new();
        }
        let differing = self.differing_by_ours();
        let mut objects: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (pixel, &id) in self.truth.ids.iter().enumerate() {
            if id != NO_PRIMITIVE {
                let (object, _) = self.view.scene.locate(id.into());
                objects.entry(object).or_default().push(pixel);
            }
        }
        let right = |pixels: Vec<usize>| {
            let all = pixels.len();
            let right: Vec<usize> = pixels.into_iter().filter(|&pixel| !differing[pixel]).collect();
            let is_certain =
                right.len() >= FEWEST_OF_OBJECT && 100 * right.len() >= PERCENT_OF_OBJECT * all;
            is_certain.then_some(right)
        };
        objects.into_values().filter_map(right).collect()
    }

    /// Whether three quarters of these pixels of each object are still right under a hypothesis.
    fn keeps(&self, objects: &[Vec<usize>], candidate: &Candidate) -> bool {
        let Candidate { convention, encoding, .. } = candidate;
        let drawn = self.whole(convention);
        let expected = Expected::new(self.view, convention, &drawn);
        let mut differs = vec![false; self.truth.ids.len()];
        expected.each(self.observed, convention.placement, encoding, |index, is_other, _| {
            differs[index] = is_other;
        });
        objects.iter().all(|pixels| {
            let right = pixels.iter().filter(|&&pixel| !differs[pixel]).count();
            4 * right >= 3 * pixels.len()
        })
    }
}

/// Whether a hypothesis about depths alone, which moves no outline, leaves little of the coverage wrong: what is wrong there has
/// another cause, which explains the rest, too.
fn leaves_the_coverage(candidate: &Candidate, ours: Score) -> bool {
    let changes = candidate.convention.changes();
    let is_of_depth = |change: &Change| matches!(change, Change::Depth(_) | Change::Edges(_));
    let explained = ours.differing.saturating_sub(candidate.score.differing);
    changes.is_empty()
        || !changes.iter().all(is_of_depth)
        || 4 * candidate.score.coverage <= explained
}
