//! The search for the size and the place of a whole picture.

use super::super::candidate::{Candidate, as_good};
use super::super::contour::Coverage;
use super::super::convention::{Change, Convention, Evidence, Framing, Moved, Stance};
use super::super::encoding::{Encoding, IdEncoding};
use super::super::expected::{Expected, Score};
use super::super::fit::{Fit, framing_of_file, framing_of_mask};
use super::super::observed::Values;
use super::least_squares::{NormalEquations, Row, solution_of_most};
use super::marks::{Approach, FAR_OF_SURFACE, Landmarks, Mark, Way};
use super::{FEW, Search};

/// So often a framing is measured: each time, pixels round less.
const MOST_FITS: usize = 6;

/// So often a contour is moved, and so often in a row for nothing.
const MOST_STEPS: usize = 12;
const MOST_WORSE: usize = 4;

/// So often what distances end on is moved.
const MOST_STEPS_OF_DISTANCES: usize = 20;

/// A mask or distances that differ in fewer pixels tell no four numbers.
const FEWEST_PIXELS: u64 = 100;

/// At once, a contour is moved by at most this part of the picture's size.
const LONGEST: f64 = 0.5;

/// In so many placements it is measured: ids tell most of the wrong ones.
const MOST_PLACEMENTS: usize = 2;

impl Search<'_> {
    /// Our conventions with the size and the place of the picture that ids or a mask show.
    pub(super) fn framed(&self) -> Option<Candidate> {
        match self.observed.values {
            Values::Ids(_) => self.framed_by_primitives(),
            Values::Mask(_) => self.framed_by_contour(),
            Values::Distances(_) => None,
        }
    }

    /// With more of the scene around it, unless with nothing around it it explains more.
    fn framed_by_primitives(&self) -> Option<Candidate> {
        let mut placed = self.placed(Convention::default(), self.truth);
        placed.sort_by_key(Candidate::rank);
        let told = placed.iter().filter(|one| self.fit(one).is_some());
        let both = told
            .take(MOST_PLACEMENTS)
            .flat_map(|one| [false, true].map(|is_alone| self.framed_so(one, is_alone)));
        both.flatten().min_by_key(Candidate::rank)
    }

    fn framed_so(&self, candidate: &Candidate, is_alone: bool) -> Option<Candidate> {
        let convention = candidate.convention;
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
        better(candidate, with_simple_numbers(best, candidate, with))
    }

    /// With more of the scene around it, if that explains a mask; otherwise with nothing around it, if that does.
    fn framed_by_contour(&self) -> Option<Candidate> {
        if self.ours.differing < FEWEST_PIXELS {
            return None;
        }
        let starts = self.starts_from_elsewhere().into_iter();
        let mut found = starts
            .flat_map(|start| [false, true].map(|is_alone| (start, is_alone)))
            .filter_map(|(start, is_alone)| self.framed_by_contour_so(&start, is_alone));
        found.find(|one| FEW * one.score.differing <= self.ours.differing)
    }

    /// A mask whose contour lies where the file has it, if it tells enough, with as few numbers as do nearly as well.
    fn framed_by_contour_so(&self, start: &Candidate, is_alone: bool) -> Option<Candidate> {
        let all = self.fitted(start, Framing { is_alone, ..Framing::default() }, Stretch::All);
        let differing = start.score.differing;
        if all.score.differing * FEW > differing {
            return None;
        }
        let simpler = Stretch::SIMPLER
            .map(|stretch| self.fitted(start, stretch.simplified(all.convention.framing), stretch));
        let each = || simpler.iter().chain([&all]);
        let fewest = each().map(|one| one.score.differing).min()?;
        // Steps are never as small as the number would have to be that leaves the fewest.
        let most = 2 * fewest + differing / 200;
        let best = each().find(|one| one.score.differing <= most)?;
        better(start, *best)
    }

    /// The start with a framing, moved in these ways until the contour lies where the file has it. Only what is covered counts.
    fn fitted(&self, start: &Candidate, framing: Framing, stretch: Stretch) -> Candidate {
        let Candidate { convention, encoding, .. } = *start;
        let theirs = self.coverage(convention.placement, encoding.nothing);
        let read = |framing: Framing| {
            let next = convention.with(Change::Framing(framing));
            let drawn = self.whole(&next);
            let expected = Expected::new(self.view, &next, &drawn);
            let read = as_mask(self.read(next, &expected, encoding.nothing));
            (read, Coverage::of(&expected))
        };
        let (mut best, mut worse) = (as_mask(*start), 0);
        let mut framing = Framing { evidence: Evidence::Contour, ..framing };
        for _ in 0..MOST_STEPS {
            let (fitted, ours) = read(framing);
            if fitted.score.differing < best.score.differing {
                (best, worse) = (fitted, 0);
            } else {
                worse += 1;
            }
            if best.score.differing == 0 || worse == MOST_WORSE {
                break;
            }
            let Some(step) = stretch.step(&ours, &theirs) else { break };
            framing = framing.then(step);
        }
        with_simple_numbers(best, start, |framing| read(framing).0)
    }

    /// Distances of a picture whose contour lies where the file has it, if it has one, and that end on what is seen.
    pub(super) fn framed_by_distances(&self) -> Option<Candidate> {
        let is_of_distances = matches!(self.observed.values, Values::Distances(_));
        if !is_of_distances || self.ours.differing < FEWEST_PIXELS {
            return None;
        }
        let starts = self.starts_from_elsewhere();
        let rough = self.fitted(starts.first()?, Framing::default(), Stretch::All);
        let mut framings = vec![rough.convention.framing];
        if rough.convention.is_framed() {
            framings.push(Framing::default());
        }
        let mut found = starts.iter().flat_map(|start| {
            framings.iter().filter_map(|framing| self.fitted_to_surfaces(start, *framing))
        });
        found.find(|one| FEW * one.score.differing <= self.ours.differing)
    }

    fn fitted_to_surfaces(&self, start: &Candidate, framing: Framing) -> Option<Candidate> {
        let Candidate { convention, encoding, .. } = *start;
        let with = |framing: Framing| convention.with(Change::Framing(framing));
        let mut framing = Framing { evidence: Evidence::Distances, ..framing };
        let (mut best, mut approach) = (*start, Approach::new());
        for _ in 0..MOST_STEPS_OF_DISTANCES {
            let next = with(framing);
            let drawn = self.whole(&next);
            let expected = Expected::new(self.view, &next, &drawn);
            let fitted = self.read(next, &expected, encoding.nothing);
            if fitted.score.differing <= best.score.differing {
                best = fitted;
            }
            let of_file = (convention.placement, &encoding);
            let stance = Stance::stated(self.view.camera, Moved::All);
            let marks = self.marks_of_surfaces(&stance, &expected, of_file, framing)?;
            // Where all are right, both sides may yet come nearer to one scale.
            if !approach.goes_on(&marks) || best.score.differing == 0 && !approach.comes_nearer() {
                break;
            }
            let Some(step) = self.step_of_surfaces(&stance, &marks, framing) else { break };
            framing = framing.then(step);
        }
        better(start, with_simple_numbers(best, start, |framing| self.drawn_whole(with(framing))))
    }

    /// The framing that takes what is seen at the ends of distances to where the file has it, nearly, if they tell all of it.
    fn step_of_surfaces(
        &self,
        stance: &Stance,
        marks: &[Mark],
        framing: Framing,
    ) -> Option<Framing> {
        let camera = self.view.camera;
        let clues = marks.iter().filter_map(|mark| {
            let Way::ToSurface { normal, far } = mark.way else { return None };
            let [x, y, depth] = stance.place(mark.point, camera)?;
            let pixels = self.pixels_of_depth(depth);
            let right = stance.point([x + 1.0, y, depth], camera) - mark.point;
            let down = stance.point([x, y + 1.0, depth], camera) - mark.point;
            // Where everything is moved to the right, a pixel shows what lies farther to the left.
            let along = [right, down].map(|side| -pixels * normal.dot(side));
            let along = [0, 1].map(|axis| along[axis] / framing.scale[axis]);
            let place = [0, 1].map(|axis| [x, y][axis] * framing.scale[axis] + framing.shift[axis]);
            Some(Clue { place, along, by: pixels * far, weight: mark.weight })
        });
        let clues: Vec<Clue> = clues.collect();
        if clues.len() < Landmarks::Surfaces.fewest(Stretch::All.freedom()) {
            return None;
        }
        Stretch::All.step_of(&clues, f64::from(camera.image()[0]), Some(FAR_OF_SURFACE))
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

/// What tells by how much a picture is off in one direction.
struct Clue {
    /// From the middle of the picture, in pixels.
    place: [f64; 2],
    /// By how much it comes nearer where everything there is moved by a pixel to the right, and down.
    along: [f64; 2],
    /// By how much it should.
    by: f64,
    weight: f64,
}

/// The candidate as if only what is covered counted.
fn as_mask(candidate: Candidate) -> Candidate {
    let Score { coverage, .. } = candidate.score;
    Candidate { score: Score { differing: coverage, ..candidate.score }, ..candidate }
}

/// The candidate with simple numbers in its framing, where these do as well.
fn with_simple_numbers(
    mut best: Candidate,
    start: &Candidate,
    with: impl Fn(Framing) -> Candidate,
) -> Candidate {
    for simple in [Framing::with_simple_scale, Framing::with_simple_shift] {
        let other = with(simple(best.convention.framing));
        if as_good(other.score.differing, best.score.differing, start.score.differing) {
            best = other;
        }
    }
    best
}

/// A framed candidate, if it does better than what it began with.
fn better(start: &Candidate, framed: Candidate) -> Option<Candidate> {
    let is_framed = framed.convention.is_framed();
    (is_framed && framed.score.differing < start.score.differing).then_some(framed)
}

/// What of the size and the place of a mask is another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stretch {
    /// The size: all is as many times as wide as it is high.
    Size,
    /// The place.
    Place,
    /// Width and height.
    Sides,
    /// The size, and the place.
    SizeAndPlace,
    /// Width, height and place.
    All,
}

impl Stretch {
    /// All but [`Stretch::All`]; the first have the fewest numbers.
    const SIMPLER: [Stretch; 4] =
        [Stretch::Size, Stretch::Place, Stretch::Sides, Stretch::SizeAndPlace];

    /// The framing that is nearest to one.
    fn simplified(self, framing: Framing) -> Framing {
        let [x, y] = framing.scale;
        let scale = match self {
            Stretch::Place => [1.0; 2],
            Stretch::Size | Stretch::SizeAndPlace => [f64::midpoint(x, y); 2],
            Stretch::Sides | Stretch::All => [x, y],
        };
        let shift = match self {
            Stretch::Size | Stretch::Sides => [0.0; 2],
            Stretch::Place | Stretch::SizeAndPlace | Stretch::All => framing.shift,
        };
        Framing { scale, shift, ..framing }
    }

    /// The framing that takes what is covered in our picture to what another mask covers, nearly, if they tell all of it.
    fn step(self, ours: &Coverage, theirs: &Coverage) -> Option<Framing> {
        let whole = if self == Stretch::All { framing_of_mask(ours, theirs) } else { None };
        whole.or_else(|| self.step_of_contour(ours, theirs))
    }

    fn step_of_contour(self, ours: &Coverage, theirs: &Coverage) -> Option<Framing> {
        let pieces = ours.contour(theirs).into_iter().map(|piece| {
            let place = ours.offset(piece.place);
            Clue { place, along: piece.across, by: piece.farther, weight: piece.length }
        });
        self.step_of(&pieces.collect::<Vec<_>>(), ours.width(), None)
    }

    /// In how many ways it moves a picture.
    fn freedom(self) -> usize {
        match self {
            Stretch::Size => 1,
            Stretch::Place | Stretch::Sides => 2,
            Stretch::SizeAndPlace => 3,
            Stretch::All => 4,
        }
    }

    /// The framing that clues tell, if they tell all of it; without those that are farther off than most, if they may be so far.
    fn step_of(self, clues: &[Clue], width: f64, least: Option<f64>) -> Option<Framing> {
        let of_place = [[width, 0.0], [0.0, width]];
        let rows = clues.iter().map(|&Clue { place: [x, y], along, by, weight }| {
            let slopes = match self {
                Stretch::Size => vec![[x, y]],
                Stretch::Place => of_place.to_vec(),
                Stretch::Sides => vec![[x, 0.0], [0.0, y]],
                Stretch::SizeAndPlace => [&[[x, y]][..], &of_place].concat(),
                Stretch::All => [&[[x, 0.0], [0.0, y]], &of_place[..]].concat(),
            };
            let moved = Row { slopes, offset: [0.0; 2], weight }.along(along);
            Row { offset: [by, 0.0], ..moved }
        });
        let rows: Vec<Row> = rows.collect();
        let equations = NormalEquations::new(&rows, self.freedom());
        if !equations.tell_all_ways() {
            return None;
        }
        let by = match least {
            Some(least) => solution_of_most(rows, self.freedom(), least)?,
            None => equations.solution()?,
        };
        let by: Vec<f64> = by.into_iter().map(|by| by.clamp(-LONGEST, LONGEST)).collect();
        let (scale, shift) = match (self, &by[..]) {
            (Stretch::Place, shift) => ([0.0; 2], shift),
            (Stretch::Size | Stretch::SizeAndPlace, [both, shift @ ..]) => ([*both; 2], shift),
            (_, [x, y, shift @ ..]) => ([*x, *y], shift),
            _ => return None,
        };
        let shift = [0, 1].map(|axis| width * shift.get(axis).copied().unwrap_or(0.0));
        Some(Framing { scale: scale.map(|by| 1.0 + by), shift, ..Framing::default() })
    }
}
