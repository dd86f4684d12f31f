//! What is named of all that was tried.

use super::{MOST_EXPLANATIONS, Search};
use crate::diff::why::candidate::{Candidate, as_good, parts};
use crate::diff::why::convention::{Convention, Placement};
use crate::diff::why::drawn::Rows;
use crate::diff::why::encoding::Encoding;
use crate::diff::why::expected::{Expected, Score};
use crate::diff::why::finding::Explanation;
use crate::diff::why::layout::layout;
use crate::diff::why::missing::{Renumbered, renumbered};
use crate::diff::why::observed::Values;

impl Search<'_> {
    /// The explanations that leave as few pixels as the best one, simplest first.
    pub(super) fn best(&self, candidates: &[Candidate], ours: Score) -> Vec<Explanation> {
        let differing = ours.differing;
        let parts = |one: &Candidate| parts(&one.convention, &one.encoding);
        // Our own conventions explain nothing.
        let others =
            || candidates.iter().filter(|one| parts(one) > 0 && self.may_explain(one, ours));
        let fewest = others().map(|one| one.score.differing).min().unwrap_or(differing);
        // A picture tells roughly where a plane lies: one that clips does as well as a part that is blank.
        let best = others().min_by_key(|one| one.rank());
        let is_of_part = best.is_some_and(|best| best.convention.leaves_part_blank());
        let is_rival = |one: &Candidate| {
            is_of_part && one.convention.clips() && one.score.differing <= fewest + differing / 100
        };
        let good =
            |one: &&Candidate| as_good(one.score.differing, fewest, differing) || is_rival(one);
        let simplest = others().filter(good).map(parts).min();
        let is_simplest = |one: &&Candidate| Some(parts(one)) == simplest;
        let mut chosen: Vec<Candidate> =
            others().filter(good).filter(is_simplest).copied().collect();
        chosen.sort_by_key(Candidate::rank);
        let least = chosen.first().map_or(0, |one| one.score.differing);
        let mut explanations: Vec<Explanation> = Vec::new();
        for one in chosen {
            let is_known = explanations
                .iter()
                .any(|other| other.convention == one.convention && other.encoding == one.encoding);
            let is_near = one.score.differing <= least + differing / 1000 || is_rival(&one);
            if is_near && !is_known && explanations.len() < MOST_EXPLANATIONS {
                explanations.push(self.explanation(&one, differing));
            }
        }
        explanations
    }

    fn explanation(&self, candidate: &Candidate, differing: u64) -> Explanation {
        let Candidate { convention, encoding, score } = *candidate;
        Explanation {
            convention,
            encoding,
            missing: Vec::new(),
            layout: None,
            explained: differing.saturating_sub(score.differing),
            remaining: score.differing,
            pixels: self.explained(candidate),
        }
    }

    /// What a file of ids lacks and does not count, if that explains nearly all of it.
    pub(super) fn missing(&self) -> Option<Explanation> {
        let Values::Ids(ids) = &self.observed.values else { return None };
        if !self.placements.contains(&Placement::Upright) {
            return None;
        }
        let Renumbered { missing, differs } = renumbered(self.view, self.truth, ids)?;
        Some(Explanation { missing, ..self.by_our_conventions(&differs) })
    }

    /// Where the numbers of a file lie in a buffer, if that explains nearly all of it.
    pub(super) fn layout(&self) -> Option<Explanation> {
        if !self.placements.contains(&Placement::Upright) {
            return None;
        }
        let (found, differs) = layout(self.truth, self.observed)?;
        Some(Explanation { layout: Some(found), ..self.by_our_conventions(&differs) })
    }

    /// What is explained where a file with our conventions differs only at these pixels.
    fn by_our_conventions(&self, differs: &[bool]) -> Explanation {
        let remaining = differs.iter().filter(|&&differs| differs).count() as u64;
        let mut explained = self.differing_by_ours();
        explained.iter_mut().zip(differs).for_each(|(wrong, differs)| *wrong &= !differs);
        Explanation {
            convention: Convention::default(),
            encoding: Encoding::default(),
            missing: Vec::new(),
            layout: None,
            explained: self.ours.differing.saturating_sub(remaining),
            remaining,
            pixels: self.pixels(&explained),
        }
    }

    /// The pixels that differ under our conventions, and not under these.
    fn explained(&self, candidate: &Candidate) -> Vec<[u32; 2]> {
        if !self.placements.contains(&Placement::Upright) {
            return Vec::new();
        }
        let mut wrong = self.differing_by_ours();
        let drawn = self.drawn(&candidate.convention, Rows::ALL);
        let expected = Expected::new(self.view, &candidate.convention, &drawn);
        let placement = candidate.convention.placement;
        expected.each(self.observed, placement, &candidate.encoding, |index, differs, _| {
            wrong[index] &= !differs;
        });
        self.pixels(&wrong)
    }

    /// Whether each pixel of an upright file differs under our conventions.
    pub(super) fn differing_by_ours(&self) -> Vec<bool> {
        let mut differing = vec![false; self.truth.ids.len()];
        let ours = Expected::new(self.view, &Convention::default(), self.truth);
        let none = Encoding::default();
        ours.each(self.observed, Placement::Upright, &none, |index, differs, _| {
            differing[index] = differs;
        });
        differing
    }

    /// The pixels `[i, j]` that are chosen, row by row.
    pub(super) fn pixels(&self, chosen: &[bool]) -> Vec<[u32; 2]> {
        let width = self.view.camera.image()[0] as usize;
        let number = |side: usize| u32::try_from(side).expect("at most 2^16");
        let chosen = (0..chosen.len()).filter(|&index| chosen[index]);
        chosen.map(|index| [number(index / width), number(index % width)]).collect()
    }
}
