//! The search for the conventions under which a file agrees with the scene.
//!
//! Each hypothesis is drawn. First every single change and every pair of changes on different axes is held against
//! some rows of the file, with every placement; the best of them are drawn as a whole, and changes are added as long
//! as each of them explains at least half of what is left. A change that explains less is left out again. The file itself
//! tells planes, what is not drawn, the size and the place of the whole picture, and the eye and the axes from which it is seen so.

mod credible;
mod explanations;
mod framing;
mod least_squares;
mod marks;
mod nearly_right;
mod pose;

use super::candidate::{Candidate, as_good, parts};
use super::convention::{Change, Convention, Evidence, Placement};
use super::differences::Differences;
use super::draw::{draw, equally_near};
use super::drawn::{Drawn, Rows};
use super::encoding::{Encoding, IdEncoding, NothingEncoding};
use super::evidence::no_evidence;
use super::expected::{Expected, Score, score_of_truth};
use super::finding::{Explanation, Finding, Findings};
use super::observed::{Observed, Values};
use super::place::common_place;
use crate::common::View;
use crate::diff::buffer::Buffer;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::HashSet;
use std::sync::OnceLock;

/// Why a file cannot be searched for conventions.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SearchError {
    /// The file has several samples a pixel.
    #[error("conventions are searched in masks, ids and distances of one sample a pixel")]
    Samples,
    /// The file has colours alone.
    #[error(
        "colours alone tell none; give --background, the colour of what is not covered, or compare masks, ids or distances"
    )]
    Colors,
    /// No placement takes the file to the camera's image.
    #[error(
        "the file has {} x {} pixels and the camera {} x {}; give --size as the file has it",
        .file[0], .file[1], .camera[0], .camera[1]
    )]
    Size {
        /// Width and height of the file.
        file: [u32; 2],
        /// Width and height of the camera's image.
        camera: [u32; 2],
    },
}

/// Searches for the conventions under which a file agrees with a scene.
///
/// # Errors
///
/// If the file has colours alone, or several samples a pixel, or its size is neither the camera's nor the camera's with
/// rows and columns exchanged.
pub fn find_conventions(view: &View, file: &Buffer) -> Result<Findings, SearchError> {
    let unreadable =
        || if file.has_coverage() { SearchError::Samples } else { SearchError::Colors };
    let observed = Observed::of(file).ok_or_else(unreadable)?;
    let image @ [width, height] = view.camera.image();
    let distinct = Placement::distinct(std::iter::once(image));
    let placements: Vec<Placement> =
        distinct.filter(|placement| placement.fits(file.size(), image)).collect();
    if placements.is_empty() {
        return Err(SearchError::Size { file: file.size(), camera: image });
    }
    let truth = draw(view, &Convention::default(), Rows::ALL);
    let pixels = u64::from(width) * u64::from(height);
    let ours = score_of_truth(view, &observed, &placements, &truth);
    let search = Search {
        view,
        file,
        observed: &observed,
        covered: observed.covered_count(NothingEncoding::Ours),
        meanings_of_nothing: observed.meanings_of_nothing(view.scene.primitive_count()),
        placements: &placements,
        truth: &truth,
        ours,
        on_some_rows: OnceLock::new(),
    };
    Ok(Findings { pixels, differing: ours.differing, finding: search.finding() })
}

/// At least so many rows, and so many pixels, are looked at first.
const FEWEST_ROWS: usize = 48;
const FEWEST_PIXELS: usize = 60_000;
/// Pairs are drawn as long as no more primitives are drawn than this.
const MOST_PRIMITIVES: u64 = 40_000_000;
/// So many of the best are drawn as a whole.
const FINALISTS: usize = 8;
/// The most changes that are added to one of them.
const MOST_ADDED: usize = 3;

/// One of so many differing pixels may be left where the eye is not sought.
const FEW: u64 = 50;
/// The same where a contour alone tells another size or place.
const FEW_BY_CONTOUR: u64 = 1000;

/// Fewer wrong pixels tell no place.
const FEWEST_OF_PLACE: u64 = 4;

/// The most explanations that are named.
const MOST_EXPLANATIONS: usize = 6;

struct Search<'a> {
    view: &'a View<'a>,
    file: &'a Buffer<'a>,
    observed: &'a Observed,
    /// How many pixels of the file are covered.
    covered: u64,
    meanings_of_nothing: Vec<NothingEncoding>,
    placements: &'a [Placement],
    truth: &'a Drawn,
    /// How far the file is from the true picture.
    ours: Score,
    /// All that was held against some rows to find the finalists.
    on_some_rows: OnceLock<Vec<Candidate>>,
}

impl Search<'_> {
    fn finding(&self) -> Finding {
        let (ours, differing) = (self.ours, self.ours.differing);
        if differing == 0 {
            return Finding::True;
        }
        if let Some(reason) = no_evidence(self.view, self.file, self.observed, self.truth) {
            return Finding::NoEvidence(reason);
        }
        let placed = self.ours_in_place();
        if let Some(found) = self.nearly_right(&placed) {
            return found;
        }
        let mut finalists = self.finalists();
        finalists = self.improved(finalists, ours, placed.convention);
        finalists.sort_by_key(Candidate::rank);
        let mut explanations = self.best(&self.credible(finalists), ours);
        for other in [Self::missing, Self::layout] {
            let may_be_better = explanations.first().is_none_or(Explanation::may_be_bettered);
            let other = may_be_better.then(|| other(self)).flatten();
            if let Some(other) = other
                && explanations.first().is_none_or(|best| other.is_better_than(best))
            {
                explanations = vec![other];
            }
        }
        match explanations.first() {
            Some(best) if best.explained * 4 >= differing => Finding::Explained(explanations),
            _ => Finding::Unexplained(self.place()),
        }
    }

    /// What all differing pixels show, or should show.
    fn place(&self) -> Option<String> {
        let is_upright = self.placements.contains(&Placement::Upright);
        // A few pixels lie on one thing by accident.
        let tells = is_upright && self.ours.differing >= FEWEST_OF_PLACE;
        tells.then(|| common_place(self.view, self.observed, self.truth))?
    }

    /// The rows by which hypotheses are judged first.
    fn some_rows(&self) -> Rows {
        let [width, height] = self.view.camera.image().map(|side| side as usize);
        Rows { step: (width * height / FEWEST_PIXELS).min(height / FEWEST_ROWS).max(1) }
    }

    /// The scene under a convention. Where one ray decides every pixel, and rounding decides what it sees, the primitive
    /// that the file shows is right.
    fn drawn(&self, convention: &Convention, rows: Rows) -> Drawn {
        let drawn = draw(self.view, convention, rows);
        let as_near = equally_near(self.view, convention, &drawn);
        if as_near.is_empty() {
            return drawn;
        }
        let fit = |one: &Drawn| {
            let ranks = self.placed(*convention, one);
            ranks.iter().map(Candidate::rank).min()
        };
        std::iter::once(drawn).chain(as_near).min_by_key(fit).expect("one is drawn")
    }

    /// The pixels that differ under a convention in some rows, with the best reading of the file.
    fn differing_on_some_rows(&self, convention: Convention) -> u64 {
        let mut known = self.on_some_rows.get().into_iter().flatten();
        if let Some(known) = known.find(|one| one.convention == convention) {
            return known.score.differing;
        }
        let upright = Convention { placement: Placement::Upright, ..convention };
        let drawn = self.drawn(&upright, self.some_rows());
        let placed = self.placed(upright, &drawn).into_iter();
        let own = placed.filter(|one| one.convention.placement == convention.placement);
        own.map(|one| one.score.differing).min().unwrap_or(u64::MAX)
    }

    /// The best hypotheses by some rows of the picture, with ours among them.
    fn finalists(&self) -> Vec<Candidate> {
        let rows = self.some_rows();
        let mut hypotheses = vec![Convention::default()];
        let changes: Vec<Change> = Change::of_rendering(self.view.camera)
            .into_iter()
            .filter(|change| change.is_coarse())
            .collect();
        hypotheses.extend(changes.iter().map(|&change| Convention::default().with(change)));
        let paired = changes.iter().enumerate().flat_map(|(index, &one)| {
            let others =
                changes[index + 1..].iter().filter(move |other| one.is_paired_with(**other));
            others.map(move |&other| Convention::default().with(one).with(other))
        });
        let pairs: Vec<Convention> = paired.collect();
        if pairs.len() as u64 * self.view.scene.primitive_count() <= MOST_PRIMITIVES {
            hypotheses.extend(pairs);
        }
        let mut candidates: Vec<Candidate> = hypotheses
            .par_iter()
            .flat_map_iter(|convention| {
                let drawn = self.drawn(convention, rows);
                self.placed(*convention, &drawn)
            })
            .collect();
        let mut chosen = vec![Convention::default()];
        let mut choose = |candidates: &[Candidate]| {
            let fresh: Vec<Convention> = candidates
                .iter()
                .map(|candidate| candidate.convention)
                .filter(|convention| !chosen.contains(convention))
                .take(FINALISTS)
                .collect();
            chosen.extend(fresh);
        };
        candidates.sort_by_cached_key(Candidate::rank);
        choose(&candidates);
        // Several changes may fit a part of the file, and be refused.
        let is_single = |one: &&Candidate| one.convention.changes().len() <= 1;
        choose(&candidates.iter().filter(is_single).copied().collect::<Vec<_>>());
        candidates.sort_by_cached_key(|candidate| {
            (candidate.score.coverage, parts(&candidate.convention, &candidate.encoding))
        });
        choose(&candidates);
        self.on_some_rows.set(candidates).expect("the finalists are found once");
        chosen.par_iter().map(|convention| self.drawn_whole(*convention)).collect()
    }

    /// The best reading of the file for each placement.
    fn placed(&self, convention: Convention, drawn: &Drawn) -> Vec<Candidate> {
        let expected = Expected::new(self.view, &convention, drawn);
        let placed = self.placements.iter().map(|&placement| {
            let convention = Convention { placement, ..convention };
            let meanings = self.meanings_of_nothing.iter();
            let readings = meanings.map(|&nothing| self.read(convention, &expected, nothing));
            readings.min_by_key(Candidate::rank).expect("one meaning of nothing is ours")
        });
        placed.collect()
    }

    /// The reading of the file under a convention, with a meaning of nothing.
    fn read(
        &self,
        convention: Convention,
        expected: &Expected,
        nothing: NothingEncoding,
    ) -> Candidate {
        let placement = convention.placement;
        let with = |encoding: Encoding| {
            let score = expected.score_of_hypothesis(self.observed, placement, &encoding);
            Candidate { convention, encoding, score }
        };
        let best = with(expected.encoding(self.observed, placement, nothing));
        // A file that counts all from another number has hardly any right by ours.
        let counts_otherwise = matches!(best.encoding.ids, IdEncoding::CountedFrom(2..));
        if counts_otherwise && 1000 * self.ours.shown > self.ours.differing {
            return with(Encoding { ids: IdEncoding::FromZero, ..best.encoding });
        }
        best
    }

    /// The whole picture under a convention.
    fn whole(&self, convention: &Convention) -> Cow<'_, Drawn> {
        let upright = Convention { placement: Placement::Upright, ..*convention };
        if upright == Convention::default() {
            Cow::Borrowed(self.truth)
        } else {
            Cow::Owned(self.drawn(convention, Rows::ALL))
        }
    }

    /// The candidate with each change that the file suggests beside it, on an axis that is ours so far.
    fn with_suggestions(&self, candidate: &Candidate) -> Vec<Candidate> {
        let Candidate { convention, encoding, .. } = *candidate;
        let drawn = self.whole(&convention);
        let expected = Expected::new(self.view, &convention, &drawn);
        let placement = convention.placement;
        // Where each primitive may have any name, one that is missing has the name of what lies behind it.
        let encoding = match encoding.ids {
            IdEncoding::OneToOne => expected.encoding(self.observed, placement, encoding.nothing),
            _ => encoding,
        };
        let suggested = |encoding: Encoding| {
            Differences::new(&expected, self.observed, placement, encoding).suggested()
        };
        let mut changes = suggested(encoding);
        // A mask that lacks most of the picture is nearer to an inverted one.
        if encoding.nothing == NothingEncoding::Inverted {
            changes.extend(suggested(Encoding { nothing: NothingEncoding::Ours, ..encoding }));
        }
        let taken: HashSet<usize> = convention.changes().into_iter().map(Change::axis).collect();
        let free = changes.into_par_iter().filter(|change| !taken.contains(&change.axis()));
        let mut found: Vec<Candidate> =
            free.map(|change| self.drawn_whole(convention.with(change))).collect();
        // Where no sphere tells whether its other side is seen, it is.
        found.dedup_by(|second, first| {
            let with_same_plane = |plane| second.convention.with(Change::Near(plane));
            let is_same = |plane| with_same_plane(plane) == first.convention;
            first.convention.near.is_some_and(is_same) && first.score == second.score
        });
        found
    }

    /// The whole picture of a hypothesis, with ids in any order, too.
    fn drawn_whole(&self, convention: Convention) -> Candidate {
        let drawn = &*self.whole(&convention);
        let expected = Expected::new(self.view, &convention, drawn);
        let placement = convention.placement;
        // An inverted mask with a blank part is a mask of this part alone, which is more likely.
        let is_likely = |nothing: &NothingEncoding| {
            *nothing != NothingEncoding::Inverted || !convention.leaves_part_blank()
        };
        let meanings = self.meanings_of_nothing.iter().copied().filter(is_likely);
        let scored = meanings.flat_map(|nothing| {
            let own = self.read(convention, &expected, nothing);
            // Where primitives have other numbers, more pixels differ than in coverage alone.
            let ids_differ = own.score.differing > 2 * own.score.coverage;
            let is_ids = matches!(self.observed.values, Values::Ids(_));
            let one_to_one = (is_ids && ids_differ).then(|| {
                let encoding = Encoding { ids: IdEncoding::OneToOne, ..own.encoding };
                let score = expected.score_of_hypothesis(self.observed, placement, &encoding);
                Candidate { encoding, score, ..own }
            });
            std::iter::once(own).chain(one_to_one)
        });
        scored.min_by_key(Candidate::rank).expect("one meaning of nothing is ours")
    }

    /// Adds changes to the best of the finalists, and takes back those that explain too little.
    fn improved(
        &self,
        mut finalists: Vec<Candidate>,
        by_ours: Score,
        placed: Convention,
    ) -> Vec<Candidate> {
        let differing = by_ours.differing;
        let changes = Change::of_rendering(self.view.camera);
        finalists.sort_by_key(Candidate::rank);
        let mut all = finalists.clone();
        let mut starts: Vec<Candidate> = finalists.iter().take(2).copied().collect();
        all.extend(starts.iter().flat_map(|start| self.with_tie_rules_instead(start, &changes)));
        let ours = self.drawn_whole(placed);
        all.extend(self.with_suggestions(&ours));
        all.push(ours);
        // More parts cannot do better than what explains all.
        if starts[0].score.differing == 0 {
            return all;
        }
        let framed = self.framed();
        all.extend(framed);
        // Where many samples are ties, conventions that move them do better than ours until the rule for ties is found.
        for ours in [Convention::default(), placed] {
            if starts.iter().all(|one| one.convention != ours) {
                starts.push(self.drawn_whole(ours));
            }
        }
        // The contour of a mask that is framed and has another mistake, too, is that of many things.
        let is_start = |one: &Candidate| {
            one.convention.framing.evidence != Evidence::Contour
                && 2 * one.score.differing < differing
        };
        starts.extend(framed.filter(is_start));
        for start in starts {
            self.add_changes(start, &changes, differing, &mut all);
        }
        let possible = |all: &[Candidate]| {
            let possible = all.iter().filter(|one| self.may_explain(one, by_ours));
            possible.min_by_key(|one| one.rank()).copied()
        };
        if possible(&all).is_none_or(|best| best.score.differing * 2 > differing) {
            all.extend(self.tie_rules(placed, &changes));
        }
        // What explains all but a few pixels says more than where the eye is. A contour of another size or place must lie as well as it
        // can, and is named with another eye.
        let is_explained = possible(&all).is_some_and(|best| {
            let framing = best.convention.framing;
            let is_of_contour = framing.evidence == Evidence::Contour;
            let few = if is_of_contour { FEW_BY_CONTOUR } else { FEW };
            best.score.differing * few <= differing && (!is_of_contour || framing.is_of_one_kind())
        });
        if !is_explained {
            all.extend(self.framed_by_distances());
            all.extend(self.posed());
        }
        let best = possible(&all);
        if let Some(best) = best {
            all.extend(self.simplified(best, differing));
            all.extend(self.with_own_numbers_again(&best));
        }
        all
    }

    /// Adds to a candidate the change that explains most, as long as it explains half of what is left; all that is tried goes to
    /// `all`.
    fn add_changes(
        &self,
        start: Candidate,
        changes: &[Change],
        differing: u64,
        all: &mut Vec<Candidate>,
    ) {
        let mut best = start;
        for _ in 0..MOST_ADDED {
            if best.score.differing == 0 {
                break;
            }
            let taken: HashSet<usize> =
                best.convention.changes().into_iter().map(Change::axis).collect();
            let on_rows = self.differing_on_some_rows(best.convention);
            let mut added: Vec<Candidate> = changes
                .par_iter()
                .filter(|change| !taken.contains(&change.axis()))
                .map(|&change| (change, best.convention.with(change)))
                // What makes some rows no better is not drawn as a whole; few samples lie on ties, or nearly on edges.
                .filter(|(change, with)| {
                    !change.is_coarse() || self.differing_on_some_rows(*with) < on_rows
                })
                .map(|(_, with)| self.drawn_whole(with))
                .collect();
            added.extend(self.with_suggestions(&best));
            let Some(next) = added.iter().min_by_key(|one| one.rank()).copied() else { break };
            all.extend(added);
            if as_good(best.score.differing, next.score.differing, differing) {
                break;
            }
            best = next;
        }
    }

    /// The candidate with what the file suggests in place of each part with a number of its own: beside the other parts, the
    /// number is more certain.
    fn with_own_numbers_again(&self, candidate: &Candidate) -> Vec<Candidate> {
        let changes = candidate.convention.changes().into_iter();
        let own = changes.filter(|change| change.has_own_number());
        own.flat_map(|change| {
            let without = self.drawn_whole(candidate.convention.without(change));
            let suggested = self.with_suggestions(&without).into_iter();
            suggested.filter(move |one| one.convention.has(change.axis()))
        })
        .collect()
    }

    /// A candidate with a rule for ties in place of a change that moves more on the same axis: the primitive that is drawn
    /// last is seen, or the last one of those that are equally near.
    fn with_tie_rules_instead(&self, candidate: &Candidate, changes: &[Change]) -> Vec<Candidate> {
        let axes: Vec<usize> =
            candidate.convention.changes().into_iter().map(Change::axis).collect();
        let rules =
            changes.iter().filter(|rule| rule.is_rule_for_ties() && axes.contains(&rule.axis()));
        rules.map(|&rule| self.drawn_whole(candidate.convention.with(rule))).collect()
    }

    /// Our conventions, with the placement under which they fit best.
    fn ours_in_place(&self) -> Candidate {
        let placed = self.placed(Convention::default(), self.truth);
        *placed.iter().min_by_key(|one| one.rank()).expect("one placement fits the file")
    }

    /// Pairs of rules for exact ties besides a convention: which primitive owns an edge, and which is seen of equally near
    /// ones. One
    /// alone may explain nothing.
    fn tie_rules(&self, besides: Convention, changes: &[Change]) -> Vec<Candidate> {
        let rules: Vec<Change> =
            changes.iter().copied().filter(|change| change.is_rule_for_ties()).collect();
        let pairs: Vec<[Change; 2]> = rules
            .iter()
            .flat_map(|&one| rules.iter().map(move |&other| [one, other]))
            .filter(|[one, other]| one.axis() < other.axis())
            .collect();
        pairs
            .par_iter()
            .map(|&[one, other]| self.drawn_whole(besides.with(one).with(other)))
            .collect()
    }

    /// The candidate without the changes that explain less than half of what is left without them.
    fn simplified(&self, mut best: Candidate, differing: u64) -> Option<Candidate> {
        let mut simpler = None;
        for change in best.convention.changes() {
            let without = self.drawn_whole(best.convention.without(change));
            if as_good(without.score.differing, best.score.differing, differing) {
                best = without;
                simpler = Some(without);
            }
        }
        simpler
    }
}
