//! The search for an eye and axes that no mistake of the list gives.
//!
//! Where the eye stands elsewhere, or looks elsewhere, the middles of the pixels of each primitive lie elsewhere, too. By
//! least squares (the method of Gauss and Newton), the eye and the axes are moved until they lie where the file has
//! them. Both pictures are of pixels, and hide the same primitives where they agree: what is measured has no error of its own.

use super::super::candidate::{Candidate, as_good};
use super::super::convention::{Change, Convention, Moved, Placement, Pose, Stance};
use super::super::encoding::{Encoding, IdEncoding, NothingEncoding};
use super::super::expected::Expected;
use super::super::fit::{Seen, seen_in_both};
use super::super::observed::Values;
use super::{FEW, Search};
use crate::common::Primitive;
use crate::common::glam::DVec3;
use rayon::prelude::*;

/// So often the eye and the axes are moved.
const MOST_STEPS: usize = 20;

/// So often in a row they may be moved for nothing.
const MOST_WORSE: usize = 6;

/// In so many placements they are sought.
const MOST_PLACEMENTS: usize = 2;

/// For each way in which a stance is free, so many primitives must be seen: each tells two numbers.
const PRIMITIVES_EACH: usize = 2;

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
        for start in self.starts_of_pose() {
            let sought = |moved: &[Moved]| -> Vec<Candidate> {
                moved.par_iter().filter_map(|&moved| self.posed_so(&start, moved)).collect()
            };
            found.extend(sought(&Moved::simple(self.view.camera)));
            if !few(&found) {
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
    fn starts_of_pose(&self) -> Vec<Candidate> {
        let mut placed = self.placed(Convention::default(), self.truth);
        placed.sort_by_key(|one| (one.convention.placement != Placement::Upright, one.rank()));
        placed.truncate(MOST_PLACEMENTS);
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
        let mut stance = Stance::stated(self.view.camera, moved);
        let mut best: Option<Candidate> = None;
        let (mut last, mut worse): (Option<Vec<f64>>, usize) = (None, 0);
        let mut told_by = None;
        for _ in 0..MOST_STEPS {
            let next = convention.with(Change::Pose(Pose::Measured(stance)));
            next.pose.camera(self.view.camera)?;
            let drawn = self.whole(&next);
            let expected = Expected::new(self.view, &next, &drawn);
            let read = self.read(next, &expected, encoding.nothing);
            if best.is_none_or(|best| read.score.differing < best.score.differing) {
                (best, worse) = (Some(read), 0);
            } else {
                worse += 1;
            }
            let seen = seen_in_both(&expected, self.observed, placement, &encoding)?;
            if worse == 0 {
                told_by = self.only_object(&seen);
            }
            if read.score.differing == 0 || worse == MOST_WORSE {
                break;
            }
            let Some(mut step) = self.step(&stance, &seen) else { break };
            last = match last {
                Some(last) => {
                    step.extrapolate(&last);
                    None
                }
                None => Some(step.by.clone()),
            };
            let Some(after) = stance.after(&step.by, step.length, self.view.camera) else { break };
            stance = after;
        }
        let best = best.filter(|best| best.score.differing < start.score.differing)?;
        let Pose::Measured(stance) = best.convention.pose else { return None };
        let pose = Pose::Measured(Stance { told_by, ..stance });
        Some(Candidate { convention: best.convention.with(Change::Pose(pose)), ..best })
    }

    /// The only object of several in the scene that has primitives with a middle among these.
    fn only_object(&self, seen: &[Seen]) -> Option<usize> {
        let with_middle = seen.iter().filter(|one| self.center(one.id).is_some());
        let mut objects = with_middle.map(|one| self.view.scene.locate(one.id.into()).0);
        let first = objects.next()?;
        let is_only = objects.all(|object| object == first);
        (is_only && self.view.scene.objects().len() > 1).then_some(first)
    }

    /// The step that brings the middles of what is seen to where the file has them.
    fn step(&self, stance: &Stance, seen: &[Seen]) -> Option<Step> {
        let freedom = stance.moved.freedom(self.view.camera.projection());
        if seen.len() < PRIMITIVES_EACH * freedom {
            return None;
        }
        let (mut rows, length) = self.rows(stance, seen)?;
        let by = solved(&rows, freedom)?;
        // What lies far off is hidden otherwise in one of both, and its middle is that of another part.
        let mut left: Vec<f64> = rows.iter().map(|row| row.left(&by)).collect();
        left.sort_by(f64::total_cmp);
        let most = 3.0 * left.get(left.len() / 2)? + 0.5;
        rows.retain(|row| row.left(&by) <= most);
        let mut by = solved(&rows, freedom)?;
        let longest = by.iter().fold(0.0, |longest: f64, by| longest.max(by.abs()));
        if longest > LONGEST {
            by.iter_mut().for_each(|by| *by *= LONGEST / longest);
        }
        Some(Step { by, length })
    }

    /// How the place of each primitive moves with the stance, and the depth at which they lie, in the middle.
    fn rows(&self, stance: &Stance, seen: &[Seen]) -> Option<(Vec<Row>, f64)> {
        let camera = self.view.camera;
        let placed = seen.iter().filter_map(|one| {
            let center = self.center(one.id)?;
            Some((one, center, stance.place(center, camera)?))
        });
        let placed: Vec<(&Seen, DVec3, [f64; 3])> = placed.collect();
        let weight: f64 = placed.iter().map(|(one, ..)| one.weight()).sum();
        let depths = placed.iter().map(|(one, _, [.., depth])| one.weight() * depth.abs());
        let length = depths.sum::<f64>() / weight;
        let freedom = stance.moved.freedom(self.view.camera.projection());
        let moved = (0..freedom).map(|way| {
            let mut step = vec![0.0; freedom];
            step[way] = SMALL;
            stance.after(&step, length, camera)
        });
        let moved: Vec<Stance> = moved.collect::<Option<_>>()?;
        let rows = placed.iter().filter_map(|(one, center, [x, y, _])| {
            let slopes = moved.iter().map(|moved| {
                let [right, down, _] = moved.place(*center, camera)?;
                Some([(right - x) / SMALL, (down - y) / SMALL])
            });
            let slopes: Vec<[f64; 2]> = slopes.collect::<Option<_>>()?;
            Some(Row { slopes, offset: one.offset(), weight: one.weight() })
        });
        Some((rows.collect(), length))
    }

    /// The middle of a primitive in the world, if it has one.
    fn center(&self, id: u32) -> Option<DVec3> {
        let from_eye = match self.view.primitive(id.into()) {
            Primitive::Triangle([a, b, c]) => (a + b + c) / 3.0,
            Primitive::Sphere { center, .. } => center,
            Primitive::Plane { .. } => return None,
        };
        Some(self.view.camera.eye().as_dvec3() + from_eye)
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

/// How the place of one primitive moves.
struct Row {
    /// For each way, the columns and rows by which it moves.
    slopes: Vec<[f64; 2]>,
    /// The columns and rows by which it should.
    offset: [f64; 2],
    weight: f64,
}

impl Row {
    /// How many pixels are left of the offset.
    fn left(&self, by: &[f64]) -> f64 {
        let left = [0, 1].map(|axis| {
            let moved: f64 = self.slopes.iter().zip(by).map(|(slope, by)| slope[axis] * by).sum();
            self.offset[axis] - moved
        });
        left[0].hypot(left[1])
    }
}

/// The least squares: the normal equations, by Gaussian elimination. A way that no place depends on stays as it is.
fn solved(rows: &[Row], freedom: usize) -> Option<Vec<f64>> {
    let mut matrix = vec![vec![0.0; freedom + 1]; freedom];
    for row in rows {
        for axis in 0..2 {
            let slopes = row.slopes.iter().map(|slope| slope[axis]);
            for (line, own) in matrix.iter_mut().zip(slopes.clone()) {
                let values = slopes.clone().chain([row.offset[axis]]);
                let weighted = row.weight * own;
                line.iter_mut().zip(values).for_each(|(sum, value)| *sum += weighted * value);
            }
        }
    }
    let largest = (0..freedom).map(|way| matrix[way][way]).fold(0.0, f64::max);
    for (way, row) in matrix.iter_mut().enumerate() {
        row[way] += 1e-9 * largest;
    }
    for way in 0..freedom {
        let pivot = (way..freedom)
            .max_by(|&one, &other| matrix[one][way].abs().total_cmp(&matrix[other][way].abs()))?;
        matrix.swap(way, pivot);
        let (head, rest) = matrix.split_at_mut(way + 1);
        let pivot = &head[way];
        for row in rest {
            let factor = row[way] / pivot[way];
            row.iter_mut().zip(pivot).for_each(|(value, of_pivot)| *value -= factor * of_pivot);
        }
    }
    let mut by = vec![0.0; freedom];
    for way in (0..freedom).rev() {
        let known: f64 = (way + 1..freedom).map(|other| matrix[way][other] * by[other]).sum();
        by[way] = (matrix[way][freedom] - known) / matrix[way][way];
    }
    by.iter().all(|by| by.is_finite()).then_some(by)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn least_squares_weigh_what_they_are_told_and_leave_what_no_place_tells() {
        let row = |slopes: [[f64; 2]; 3], offset: [f64; 2], weight: f64| Row {
            slopes: slopes.to_vec(),
            offset,
            weight,
        };
        let slopes = [[1.0, 0.0], [1.0, 2.0], [0.0, 0.0]];
        let rows = [row(slopes, [5.0, 4.0], 1.0), row(slopes, [9.0, 4.0], 3.0)];
        let by = solved(&rows, 3).unwrap();
        // Of 5 and 9, with their weights, 8.
        let is_near = |one: f64, other: f64| (one - other).abs() < 1e-6;
        assert!(is_near(by[0], 6.0) && is_near(by[1], 2.0) && by[2] == 0.0, "{by:?}");
        assert!(is_near(rows[0].left(&by), 3.0) && is_near(rows[1].left(&by), 1.0));
        assert_eq!(solved(&[], 1), None);
    }

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
