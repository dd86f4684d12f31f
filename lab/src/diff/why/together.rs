//! The search for the conventions of a renderer by several of its pictures.
//!
//! One small picture says little: many conventions explain it. What explains the pictures of many scenes, those that are
//! right among them, is what the renderer does. So a hypothesis counts by the number of pictures that agree with it in
//! every pixel.

use super::convention::{Change, Convention, Placement, Rays};
use super::draw::draw;
use super::drawn::Rows;
use super::encoding::{Encoding, NothingEncoding};
use super::expected::Expected;
use super::observed::{Observed, Values};
use super::sentence::of_renderer;
use crate::common::{Camera, Projection, View};
use crate::diff::buffer::Buffer;
use rayon::prelude::*;

/// One picture of a renderer, and the scene that it shows.
#[derive(Clone, Copy, Debug)]
pub struct Rendering<'a> {
    /// The scene and the camera.
    pub view: &'a View<'a>,
    /// The mask, ids or distances that the renderer wrote.
    pub file: &'a Buffer<'a>,
}

/// Conventions under which pictures of a renderer agree with their scenes that do not agree otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct CommonExplanation {
    /// Where and how the renderer samples, and what it draws.
    pub convention: Convention,
    /// The cameras that the change of the rays concerns; `None` for all.
    pub rays_of: Option<Projection>,
    /// What the numbers of masks, of ids and of distances stand for.
    pub encodings: [Encoding; 3],
    /// For each picture whether it agrees in every pixel.
    pub agrees: Vec<bool>,
    /// The number of pictures that agree so, and not under our conventions.
    pub explained: usize,
}

impl CommonExplanation {
    /// The explanation in sentences, one for each part; `name` is the name of the renderer.
    pub fn sentences(&self, name: &str) -> Vec<String> {
        of_renderer(name, &self.convention, self.rays_of, &self.encodings)
    }

    /// Whether less than half of the pictures that are wrong are explained.
    pub fn is_a_guess(&self, wrong: usize) -> bool {
        self.explained * 2 < wrong
    }
}

/// Searches for the conventions of a renderer: those under which most of its pictures agree with their scenes. Several
/// are found if equally many pictures agree, none if no convention
/// does better than ours by more than one picture in thirty-two.
///
/// Pictures that hold colours alone or several samples a pixel agree with nothing.
pub fn find_common_conventions(renderings: &[Rendering]) -> Vec<CommonExplanation> {
    let shown: Vec<_> = renderings.iter().map(|one| Observed::of(one.file)).collect();
    // Where nothing is shown anywhere, whatever shows nothing explains it.
    let covers = |one: &Observed| one.covered_count(NothingEncoding::Ours) > 0;
    if !shown.iter().flatten().any(covers) {
        return Vec::new();
    }
    let search = Search { renderings, meanings: meanings_of_nothing(renderings, &shown), shown };
    let ours = search.held_to(&Hypothesis::default(), Placement::Upright, &Encodings::default());
    let mut found = search.by_single_and_pair();
    for _ in 0..MOST_ADDED {
        let Some(best) = found.first().cloned() else { break };
        if best.agreeing() == renderings.len() {
            break;
        }
        found.extend(search.with_one_more(&best.hypothesis));
        found.sort_by_key(Fit::rank);
    }
    search.best(found, &ours)
}

/// So many hypotheses are held to one meaning of the numbers in all pictures.
const FINALISTS: usize = 24;
/// The most changes that are added to a pair.
const MOST_ADDED: usize = 2;
/// The most explanations that are named.
const MOST_EXPLANATIONS: usize = 4;

/// A convention, perhaps with rays that concern the cameras of one projection alone: a renderer without parallel cameras
/// draws all of them in perspective, and is right about the others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Hypothesis {
    convention: Convention,
    rays_of: Option<Projection>,
}

impl Hypothesis {
    fn with(self, change: Step) -> Hypothesis {
        let rays_of = change.rays_of.or(self.rays_of);
        Hypothesis { convention: self.convention.with(change.change), rays_of }
    }

    /// What it means for one camera.
    fn of(&self, camera: &Camera) -> Convention {
        let mut convention = self.convention;
        let projection = camera.projection();
        let concerns = self.rays_of.is_none_or(|only| only == projection);
        if !concerns || (convention.rays == Rays::OneOrigin && projection != Projection::Parallel) {
            convention.rays = Rays::AsStated;
        }
        let ours = Convention::default();
        let [width, height] = camera.image();
        if !convention.columns.is_possible(width) {
            convention.columns = ours.columns;
        }
        if !convention.rows.is_possible(height) {
            convention.rows = ours.rows;
        }
        convention
    }
}

/// A change, perhaps for the cameras of one projection alone.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    change: Change,
    rays_of: Option<Projection>,
}

/// What the numbers of masks, ids and distances stand for.
type Encodings = [Encoding; 3];

/// The place of a kind of file among the encodings.
fn kind(values: &Values) -> usize {
    match values {
        Values::Mask(_) => 0,
        Values::Ids(_) => 1,
        Values::Distances(_) => 2,
    }
}

/// How well a hypothesis does.
#[derive(Clone, Debug)]
struct Fit {
    hypothesis: Hypothesis,
    encodings: Encodings,
    agrees: Vec<bool>,
    /// The pixels that differ in all pictures.
    differing: u64,
}

impl Fit {
    fn agreeing(&self) -> usize {
        self.agrees.iter().filter(|&&agrees| agrees).count()
    }

    /// How many choices are not ours.
    fn parts(&self) -> usize {
        let mistakes = self.hypothesis.convention.mistakes();
        mistakes + self.encodings.iter().map(Encoding::parts).sum::<usize>()
    }

    /// Smaller is better: most pictures, then the simplest.
    fn rank(&self) -> (usize, usize, u64) {
        (self.agrees.len() - self.agreeing(), self.parts(), self.differing)
    }
}

struct Search<'a> {
    renderings: &'a [Rendering<'a>],
    /// The files as the search reads them; `None` if it cannot.
    shown: Vec<Option<Observed>>,
    /// What may stand for nothing in each of them.
    meanings: Vec<Vec<NothingEncoding>>,
}

/// What may stand for nothing in each file. Where files of a kind have our number of nothing, the renderer writes it, also where
/// another of them shows a number everywhere. One file in thirty-two may have it by accident: a NaN of the renderer.
fn meanings_of_nothing(
    renderings: &[Rendering],
    shown: &[Option<Observed>],
) -> Vec<Vec<NothingEncoding>> {
    let mut with_ours = [0; 3];
    for one in shown.iter().flatten().filter(|one| one.has_our_nothing()) {
        with_ours[kind(&one.values)] += 1;
    }
    let meanings = |rendering: &Rendering, one: &Observed| {
        let mut meanings = one.meanings_of_nothing(rendering.view.scene.primitive_count());
        if with_ours[kind(&one.values)] > shown.len() / 32 {
            meanings.retain(|meaning| !matches!(meaning, NothingEncoding::Number(_)));
        }
        meanings
    };
    let all = renderings.iter().zip(shown);
    let meanings = all
        .map(|(rendering, one)| one.as_ref().map_or_else(Vec::new, |one| meanings(rendering, one)));
    meanings.collect()
}

impl<'a> Search<'a> {
    /// The pictures that can be read, with their place among all.
    fn readable(&self) -> impl Iterator<Item = (usize, &'a View<'a>, &Observed)> {
        let all = self.renderings.iter().zip(&self.shown).enumerate();
        all.filter_map(|(index, (one, shown))| Some((index, one.view, shown.as_ref()?)))
    }

    /// Every change that a renderer of one of the cameras can make.
    fn steps(&self) -> Vec<Step> {
        let mut steps: Vec<Step> = Vec::new();
        for one in self.renderings {
            for change in Change::of_rendering(one.view.camera) {
                let rays_of = (change == Change::Rays(Rays::OtherProjection))
                    .then(|| one.view.camera.projection());
                let step = Step { change, rays_of };
                if !steps.contains(&step) {
                    steps.push(step);
                }
            }
        }
        steps
    }

    fn by_single_and_pair(&self) -> Vec<Fit> {
        let steps = self.steps();
        let ours = Hypothesis::default();
        let mut hypotheses = vec![ours];
        for (index, &one) in steps.iter().enumerate() {
            hypotheses.push(ours.with(one));
            let others = &steps[index + 1..];
            let apart = others.iter().filter(|other| one.change.is_paired_with(other.change));
            hypotheses.extend(apart.map(|&other| ours.with(one).with(other)));
        }
        self.finalists(&hypotheses)
    }

    /// The hypothesis with one more change on another axis.
    fn with_one_more(&self, start: &Hypothesis) -> Vec<Fit> {
        let upright = Convention { placement: Placement::Upright, ..start.convention };
        let taken: Vec<usize> = upright.changes().into_iter().map(Change::axis).collect();
        let steps = self.steps().into_iter();
        let free = steps.filter(|step| !taken.contains(&step.change.axis()));
        let start = Hypothesis { convention: upright, ..*start };
        self.finalists(&free.map(|step| start.with(step)).collect::<Vec<_>>())
    }

    /// The best of the hypotheses with any placement, each held to one meaning of the numbers.
    fn finalists(&self, hypotheses: &[Hypothesis]) -> Vec<Fit> {
        let mut fits: Vec<(Placement, Fit, Vec<Option<Encoding>>)> =
            hypotheses.par_iter().flat_map_iter(|hypothesis| self.placed(hypothesis)).collect();
        fits.sort_by_key(|(_, fit, _)| fit.rank());
        fits.truncate(FINALISTS);
        let held = fits.par_iter().map(|(placement, fit, chosen)| {
            let encodings = self.common_encodings(fit, chosen, *placement);
            self.held_to(&fit.hypothesis, *placement, &encodings)
        });
        let mut held: Vec<Fit> = held.collect();
        held.sort_by_key(Fit::rank);
        held
    }

    /// How well a hypothesis does with each placement, if each picture may have its own meaning of numbers, and these
    /// meanings.
    fn placed(
        &self,
        hypothesis: &Hypothesis,
    ) -> impl Iterator<Item = (Placement, Fit, Vec<Option<Encoding>>)> + use<> {
        let count = self.renderings.len();
        let fit = |placement: Placement| {
            let convention = Convention { placement, ..hypothesis.convention };
            let hypothesis = Hypothesis { convention, ..*hypothesis };
            let agrees = vec![false; count];
            let fit = Fit { hypothesis, encodings: Encodings::default(), agrees, differing: 0 };
            (placement, fit, vec![None; count])
        };
        let images = self.renderings.iter().map(|one| one.view.camera.image());
        let mut fits: Vec<_> = Placement::distinct(images).map(fit).collect();
        for (index, view, shown) in self.readable() {
            let convention = hypothesis.of(view.camera);
            let drawn = draw(view, &convention, Rows::ALL);
            let expected = Expected::new(view, &convention, &drawn);
            for (placement, fit, chosen) in &mut fits {
                if !shown.fits(*placement, view.camera) {
                    fit.differing += drawn.ids.len() as u64;
                    continue;
                }
                let readings = self.meanings[index].iter().map(|&nothing| {
                    let encoding = expected.encoding(shown, *placement, nothing);
                    let score = expected.score_of_hypothesis(shown, *placement, &encoding);
                    (score.differing, encoding)
                });
                let best = readings.min_by_key(|&(differing, _)| differing);
                let (differing, encoding) = best.expect("one meaning of nothing is ours");
                fit.differing += differing;
                fit.agrees[index] = differing == 0;
                chosen[index] = Some(encoding);
            }
        }
        fits.into_iter()
    }

    /// For each kind of file the one encoding under which most of its pictures agree.
    fn common_encodings(
        &self,
        fit: &Fit,
        chosen: &[Option<Encoding>],
        placement: Placement,
    ) -> Encodings {
        let mut candidates: [Vec<Encoding>; 3] = [const { Vec::new() }; 3];
        for (index, _, shown) in self.readable() {
            let own = chosen[index].filter(|_| fit.agrees[index]);
            let list = &mut candidates[kind(&shown.values)];
            if let Some(encoding) = own.filter(|encoding| !list.contains(encoding)) {
                list.push(encoding);
            }
        }
        let mut encodings = Encodings::default();
        for (kind, list) in candidates.into_iter().enumerate() {
            let agreeing = |encoding: &Encoding| {
                let mut encodings = Encodings::default();
                encodings[kind] = *encoding;
                self.held_to_kind(&fit.hypothesis, placement, &encodings, Some(kind)).agreeing()
            };
            // Of equals the first, and ours before all.
            let ours = (agreeing(&Encoding::default()), Encoding::default());
            let best = list.iter().fold(ours, |best, encoding| {
                let number = agreeing(encoding);
                if number > best.0 { (number, *encoding) } else { best }
            });
            encodings[kind] = best.1;
        }
        encodings
    }

    fn held_to(&self, hypothesis: &Hypothesis, placement: Placement, encodings: &Encodings) -> Fit {
        self.held_to_kind(hypothesis, placement, encodings, None)
    }

    /// How well a hypothesis does with these meanings of numbers, perhaps on one kind of files alone.
    fn held_to_kind(
        &self,
        hypothesis: &Hypothesis,
        placement: Placement,
        encodings: &Encodings,
        only: Option<usize>,
    ) -> Fit {
        let mut agrees = vec![false; self.renderings.len()];
        let mut differing = 0;
        for (index, view, shown) in self.readable() {
            let kind = kind(&shown.values);
            if only.is_some_and(|only| only != kind) || !shown.fits(placement, view.camera) {
                continue;
            }
            let convention = hypothesis.of(view.camera);
            let drawn = draw(view, &convention, Rows::ALL);
            let expected = Expected::new(view, &convention, &drawn);
            let score = expected.score(shown, placement, &encodings[kind]);
            agrees[index] = score.differing == 0;
            differing += score.differing;
        }
        let convention = Convention { placement, ..hypothesis.convention };
        let hypothesis = Hypothesis { convention, ..*hypothesis };
        Fit { hypothesis, encodings: *encodings, agrees, differing }
    }

    /// The explanations under which most pictures agree, simplest first.
    fn best(&self, found: Vec<Fit>, ours: &Fit) -> Vec<CommonExplanation> {
        let Some(most) = found.iter().map(Fit::agreeing).max() else { return Vec::new() };
        // A part that one picture in thirty-two wants may be an accident.
        let slack = self.renderings.len() / 32;
        let good = |fit: &&Fit| fit.agreeing() + slack >= most;
        let simplest = found.iter().filter(good).map(Fit::parts).min().unwrap_or(0);
        let simple: Vec<&Fit> =
            found.iter().filter(good).filter(|fit| fit.parts() == simplest).collect();
        let most = simple.iter().map(|fit| fit.agreeing()).max().unwrap_or(0);
        if simplest == 0 || most <= ours.agreeing() {
            return Vec::new();
        }
        let mut explanations: Vec<CommonExplanation> = Vec::new();
        for fit in simple.into_iter().filter(|fit| fit.agreeing() == most) {
            let Hypothesis { convention, rays_of } = fit.hypothesis;
            let is_known = explanations.iter().any(|one| {
                (one.convention, one.rays_of, one.encodings) == (convention, rays_of, fit.encodings)
            });
            if is_known || explanations.len() == MOST_EXPLANATIONS {
                continue;
            }
            let newly =
                fit.agrees.iter().zip(&ours.agrees).filter(|(now, before)| **now && !**before);
            explanations.push(CommonExplanation {
                convention,
                rays_of,
                encodings: fit.encodings,
                agrees: fit.agrees.clone(),
                explained: newly.count(),
            });
        }
        explanations
    }
}
