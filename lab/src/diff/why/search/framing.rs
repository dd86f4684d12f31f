//! The search for the size and the place of a whole picture.

use super::super::candidate::{Candidate, as_good};
use super::super::convention::{Change, Convention, Framing};
use super::super::encoding::{Encoding, IdEncoding};
use super::super::expected::Expected;
use super::super::fit::{Fit, framing_of_file};
use super::Search;

/// So often a framing is measured: each time, pixels round less.
const MOST_FITS: usize = 6;

/// In so many placements it is measured: ids tell most of the wrong ones.
const MOST_PLACEMENTS: usize = 2;

impl Search<'_> {
    /// Our conventions with the size and the place of the picture that the file shows: with more of the scene around it, unless
    /// with nothing around it it explains more.
    pub(super) fn framed(&self) -> Option<Candidate> {
        let mut placed = self.placed(Convention::default(), self.truth);
        placed.sort_by_key(Candidate::rank);
        let told = placed.iter().filter(|one| self.fit(one).is_some());
        let both = told
            .take(MOST_PLACEMENTS)
            .flat_map(|one| [false, true].map(|is_alone| self.framed_so(one, is_alone)));
        both.flatten().min_by_key(Candidate::rank)
    }

    fn framed_so(&self, candidate: &Candidate, is_alone: bool) -> Option<Candidate> {
        let Candidate { convention, score, .. } = *candidate;
        let with = |framing: Framing| {
            let change = Change::Framing(Framing { is_alone, ..framing });
            self.drawn_whole(convention.with(change))
        };
        let mut best = *candidate;
        for _ in 0..MOST_FITS {
            let next = best.convention.framing.then(self.fit(&best)?);
            let fitted = with(next);
            if fitted.score.differing >= best.score.differing {
                break;
            }
            best = fitted;
        }
        if !best.convention.is_framed() {
            return None;
        }
        for simple in [Framing::with_simple_scale, Framing::with_simple_shift] {
            let other = with(simple(best.convention.framing));
            if as_good(other.score.differing, best.score.differing, score.differing) {
                best = other;
            }
        }
        Some(best).filter(|best| best.convention.is_framed())
    }

    /// The framing that primitives tell best. In a picture of another size, numbers say nothing yet about how they count.
    fn fit(&self, candidate: &Candidate) -> Option<Framing> {
        let drawn = self.whole(&candidate.convention);
        let expected = Expected::new(self.view, &candidate.convention, &drawn);
        let ids = [IdEncoding::FromZero, IdEncoding::CountedFrom(1), candidate.encoding.ids];
        let fits = ids.into_iter().filter_map(|ids| {
            let encoding = Encoding { ids, ..candidate.encoding };
            framing_of_file(&expected, self.observed, candidate.convention.placement, &encoding)
        });
        let best = fits.max_by(|one, other| one.correlation.total_cmp(&other.correlation));
        best.map(|Fit { framing, .. }| framing)
    }
}
