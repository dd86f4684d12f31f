//! The search for an eye and axes that no mistake of the list gives.
//!
//! Where the eye stands elsewhere, or looks elsewhere, the middles of the pixels of each primitive lie elsewhere, too, and so does the
//! contour of all, and what distances end on. By least squares (the method of Gauss and Newton), the eye and the axes are moved until they lie where the file has
//! them. Both pictures are of pixels, and hide the same primitives where they agree: what is measured has no error of its own.

use super::super::candidate::{Candidate, as_good};
use super::super::convention::{Change, Convention, Moved, Placement, Pose, Stance};
use super::super::encoding::{DistanceEncoding, Encoding, IdEncoding, NothingEncoding};
use super::super::expected::Expected;
use super::super::observed::Values;
use super::least_squares::{NormalEquations, Row, solution_of_most};
use super::marks::{Approach, FAR_OF_SURFACE, Landmarks, Mark, Way};
use super::{FEW, Search};
use rayon::prelude::*;

/// So often the eye and the axes are moved.
const MOST_STEPS: usize = 20;

/// So often in a row they may be moved for nothing.
const MOST_WORSE: usize = 6;

/// In so many placements they are sought.
const MOST_PLACEMENTS: usize = 2;

/// A step is at most so long: a part of the depth, or an angle.
const LONGEST: f64 = 0.5;

/// The step by which slopes are measured.
const SMALL: f64 = 1e-5;

/// Where the last step was shorter than this, it tells of the next one.
const NEAR: f64 = 0.05;

impl Search<'_> {
    /// Our conventions with the eye and the axes that the file shows: of those that explain it, one with little that is moved.
    pub(super) fn posed(&self) -> Option<Candidate> {
        let by_ours = self.ours.differing;
        let few =
            |found: &[Candidate]| found.iter().any(|one| FEW * one.score.differing <= by_ours);
        let mut found = Vec::new();
        for start in self.starts_from_elsewhere() {
            let sought = |moved: &[Moved]| -> Vec<Candidate> {
                moved.par_iter().filter_map(|&moved| self.posed_so(&start, moved)).collect()
            };
            found.extend(sought(&Moved::simple(self.view.camera)));
            // A contour alone tells too little of all at once.
            if !few(&found) && !matches!(self.observed.values, Values::Mask(_)) {
                found.extend(sought(&[Moved::All]));
            }
            if few(&found) {
                break;
            }
        }
        let fewest = found.iter().map(|one| one.score.differing).min()?;
        let good = found.iter().filter(|one| as_good(one.score.differing, fewest, by_ours));
        let projection = self.view.camera.projection();
        let freedom = |one: &&Candidate| match one.convention.pose {
            Pose::Measured(stance) => stance.moved.freedom(projection),
            _ => 0,
        };
        good.min_by_key(|one| (freedom(one), one.rank())).copied()
    }

    /// Our conventions, upright and in the placement that fits best, with each numbering that the file may have.
    pub(super) fn starts_from_elsewhere(&self) -> Vec<Candidate> {
        let mut placed = self.placed(Convention::default(), self.truth);
        placed.sort_by_key(|one| (one.convention.placement != Placement::Upright, one.rank()));
        placed.truncate(MOST_PLACEMENTS);
        if matches!(self.observed.values, Values::Mask(_)) {
            // What is covered elsewhere may be nearer to the inverse of ours. In most pixels it is so only where everything is much
            // larger, or if it is one.
            let is_inverse = 2 * self.ours.differing > self.truth.ids.len() as u64;
            let inverse = is_inverse.then_some(NothingEncoding::Inverted);
            let expected = Expected::new(self.view, &Convention::default(), self.truth);
            let meanings = std::iter::once(NothingEncoding::Ours).chain(inverse);
            let each = meanings
                .flat_map(|nothing| placed.iter().map(move |one| (one.convention, nothing)));
            return each.map(|(one, nothing)| self.read(one, &expected, nothing)).collect();
        }
        if let Values::Distances(numbers) = &self.observed.values {
            let Some(best) = placed.first() else { return Vec::new() };
            let encodings = encodings_of_distances(numbers);
            // A number that many pixels have is that of nothing rather than a distance.
            let each = self.meanings_of_nothing.iter().rev().flat_map(|&nothing| {
                encodings.map(|distances| {
                    let encoding = Encoding { distances, nothing, ..best.encoding };
                    Candidate { encoding, ..*best }
                })
            });
            return each.collect();
        }
        let each = placed.into_iter().flat_map(|one| {
            let numberings = self.numberings(one.encoding.nothing).into_iter();
            numberings.map(move |ids| {
                let encoding = Encoding { ids, ..one.encoding };
                Candidate { encoding, ..one }
            })
        });
        each.collect()
    }

    /// How ids may count: in a picture from elsewhere, numbers at places say nothing yet.
    fn numberings(&self, nothing: NothingEncoding) -> Vec<IdEncoding> {
        let Values::Ids(numbers) = &self.observed.values else { return Vec::new() };
        let from_one = IdEncoding::CountedFrom(1);
        if numbers.contains(&Some(self.view.scene.primitive_count())) {
            vec![from_one]
        } else if nothing != NothingEncoding::Number(0.0) && numbers.contains(&Some(0)) {
            vec![IdEncoding::FromZero]
        } else {
            vec![IdEncoding::FromZero, from_one]
        }
    }

    /// The start with the eye and the axes that the file shows, if its ids count as in the start.
    fn posed_so(&self, start: &Candidate, moved: Moved) -> Option<Candidate> {
        let Candidate { convention, encoding, .. } = *start;
        let placement = convention.placement;
        let landmarks = self.landmarks(placement, encoding.nothing);
        // All distances are wrong until all are right.
        let is_of_surfaces = matches!(landmarks, Landmarks::Surfaces);
        let fewest = landmarks.fewest(moved.freedom(self.view.camera.projection()));
        let mut stance = Stance::stated(self.view.camera, moved);
        let mut best: Option<Candidate> = None;
        let (mut last, mut worse): (Option<Vec<f64>>, usize) = (None, 0);
        let (mut told_by, mut is_told) = (None, false);
        let mut approach = Approach::new();
        for _ in 0..MOST_STEPS {
            let next = convention.with(Change::Pose(Pose::Measured(stance)));
            next.pose.camera(self.view.camera)?;
            let drawn = self.whole(&next);
            let expected = Expected::new(self.view, &next, &drawn);
            let read = self.read(next, &expected, encoding.nothing);
            if best.is_none_or(|best| read.score.differing < best.score.differing) {
                (best, worse) = (Some(read), 0);
            } else if !is_of_surfaces {
                worse += 1;
            }
            let marks = self.marks(&landmarks, &stance, &expected, (placement, &encoding))?;
            if marks.len() < fewest {
                break;
            }
            if worse == 0 {
                told_by = self.only_object(&marks);
                is_told = self.tell_all(&landmarks, &stance, &marks);
            }
            if read.score.differing == 0
                || worse == MOST_WORSE
                || is_of_surfaces && !approach.goes_on(&marks)
            {
                break;
            }
            let Some(mut step) = self.step(&landmarks, &stance, &marks) else { break };
            last = match last {
                _ if is_of_surfaces => None,
                Some(last) => {
                    step.extrapolate(&last);
                    None
                }
                None => Some(step.by.clone()),
            };
            let Some(after) = stance.after(&step.by, step.length, self.view.camera) else { break };
            stance = after;
        }
        let best = best.filter(|best| is_told && best.score.differing < start.score.differing)?;
        let Pose::Measured(stance) = best.convention.pose else { return None };
        let by_contour = matches!(landmarks, Landmarks::Contour(_));
        let pose = Pose::Measured(Stance { told_by, by_contour, ..stance });
        Some(Candidate { convention: best.convention.with(Change::Pose(pose)), ..best })
    }

    /// The only object of several in the scene that has primitives with a middle among these.
    fn only_object(&self, marks: &[Mark]) -> Option<usize> {
        let with_middle = marks.iter().filter(|one| self.center(one.id).is_some());
        let mut objects = with_middle.map(|one| self.view.scene.locate(one.id.into()).0);
        let first = objects.next()?;
        let is_only = objects.all(|object| object == first);
        (is_only && self.view.scene.objects().len() > 1).then_some(first)
    }

    /// Whether marks of a contour or of surfaces tell each part of a stance: that of a sphere, for one, is the same from many eyes, and
    /// a horizon from all.
    fn tell_all(&self, landmarks: &Landmarks, stance: &Stance, marks: &[Mark]) -> bool {
        if matches!(landmarks, Landmarks::Middles) {
            return true;
        }
        let freedom = stance.moved.freedom(self.view.camera.projection());
        let is_contour = matches!(landmarks, Landmarks::Contour(_));
        if is_contour
            && stance.moved.is_of_eye()
            && marks.iter().all(|mark| self.center(mark.id).is_none())
        {
            return false;
        }
        let Some((rows, _)) = self.rows(stance, marks) else { return false };
        NormalEquations::new(&rows, freedom).tell_all_ways()
    }

    /// The step that brings what is seen to where the file has it.
    fn step(&self, landmarks: &Landmarks, stance: &Stance, marks: &[Mark]) -> Option<Step> {
        let freedom = stance.moved.freedom(self.view.camera.projection());
        let (rows, length) = self.rows(stance, marks)?;
        // What lies far off is hidden otherwise in one of both: its middle is that of another part, its surface another one.
        let mut by = match landmarks {
            Landmarks::Middles => solution_of_most(rows, freedom, 0.5)?,
            Landmarks::Surfaces => solution_of_most(rows, freedom, FAR_OF_SURFACE)?,
            Landmarks::Contour(_) => NormalEquations::new(&rows, freedom).solution()?,
        };
        let longest = by.iter().fold(0.0, |longest: f64, by| longest.max(by.abs()));
        if longest > LONGEST {
            by.iter_mut().for_each(|by| *by *= LONGEST / longest);
        }
        Some(Step { by, length })
    }

    /// How the place of each mark moves with the stance, and the depth at which they lie, in the middle.
    fn rows(&self, stance: &Stance, marks: &[Mark]) -> Option<(Vec<Row>, f64)> {
        let camera = self.view.camera;
        let placed =
            marks.iter().filter_map(|mark| Some((mark, stance.place(mark.point, camera)?)));
        let placed: Vec<(&Mark, [f64; 3])> = placed.collect();
        // A plane goes on to its horizon.
        let is_near = |mark: &Mark| self.center(mark.id).is_some();
        let some_are = placed.iter().any(|(mark, _)| is_near(mark));
        let near = || placed.iter().filter(|(mark, _)| is_near(mark) || !some_are);
        let weight: f64 = near().map(|(mark, _)| mark.weight).sum();
        let depths = near().map(|(mark, [.., depth])| mark.weight * depth.abs());
        let length = depths.sum::<f64>() / weight;
        let freedom = stance.moved.freedom(camera.projection());
        let moved = (0..freedom).map(|way| {
            let mut step = vec![0.0; freedom];
            step[way] = SMALL;
            stance.after(&step, length, camera)
        });
        let moved: Vec<Stance> = moved.collect::<Option<_>>()?;
        let rows = placed.iter().filter_map(|(mark, place @ [x, y, depth])| {
            let weight = mark.weight;
            let pixels = self.pixels_of_depth(*depth);
            let slopes = moved.iter().map(|moved| match mark.way {
                Way::InPicture { .. } => {
                    let [right, down, _] = moved.place(mark.point, camera)?;
                    Some([(right - x) / SMALL, (down - y) / SMALL])
                }
                Way::ToSurface { normal, .. } => {
                    let by = normal.dot(moved.point(*place, camera) - mark.point);
                    Some([pixels * by / SMALL, 0.0])
                }
            });
            let slopes: Vec<[f64; 2]> = slopes.collect::<Option<_>>()?;
            Some(match mark.way {
                Way::InPicture { offset, across: Some(across) } => {
                    Row { slopes, offset, weight }.along(across)
                }
                Way::InPicture { offset, across: None } => Row { slopes, offset, weight },
                Way::ToSurface { far, .. } => Row { slopes, offset: [pixels * far, 0.0], weight },
            })
        });
        Some((rows.collect(), length))
    }
}

/// What distances may stand for, by the sign of most of them.
fn encodings_of_distances(numbers: &[f64]) -> [DistanceEncoding; 3] {
    use DistanceEncoding::{
        AlongAxis, AlongRay, NegativeAlongAxis, NegativeAlongRay, NegativeT, T,
    };
    let finite = || numbers.iter().filter(|number| number.is_finite());
    let negative = finite().filter(|number| **number < 0.0).count();
    let positive = finite().filter(|number| **number > 0.0).count();
    if negative > positive {
        [NegativeT, NegativeAlongAxis, NegativeAlongRay]
    } else {
        [T, AlongAxis, AlongRay]
    }
}

/// A step, as [`Stance::after`] takes it.
struct Step {
    by: Vec<f64>,
    length: f64,
}

impl Step {
    /// Makes the step as long as this one and all that would follow it, if each were as much shorter than the one before as this
    /// one is: pixels of tiny primitives move by whole steps or not at all, and tell less of a way than it has.
    fn extrapolate(&mut self, last: &[f64]) {
        let dot = |one: &[f64]| one.iter().zip(last).map(|(one, last)| one * last).sum::<f64>();
        let ratio = dot(&self.by) / dot(last);
        let is_near = last.iter().all(|by| by.abs() < NEAR);
        if is_near && (0.0..0.95).contains(&ratio) {
            self.by.iter_mut().for_each(|by| *by /= 1.0 - ratio);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_as_long_as_all_that_would_follow() {
        let mut step = Step { by: vec![0.01, 0.0], length: 1.0 };
        step.extrapolate(&[0.02, 0.0]);
        assert_eq!(step.by, [0.02, 0.0]);
        // The last step was long, or went back.
        for last in [[0.2, 0.0], [-0.02, 0.0]] {
            let mut step = Step { by: vec![0.01, 0.0], length: 1.0 };
            step.extrapolate(&last);
            assert_eq!(step.by, [0.01, 0.0]);
        }
    }
}
