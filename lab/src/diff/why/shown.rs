//! What a file shows as a whole, as far as it agrees with the truth: the reasons of single pixels ask for it.

use super::distances::SampleDistances;
use super::drawn::Drawn;
use super::encoding::NothingEncoding;
use super::observed::{Observed, Values};
use super::outline::TriangleOutline;
use super::rays::ViewingRays;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::{Judge, Primitive, Sign, View};
use crate::diff::tolerance::DEPTH_TOLERANCE;
use std::collections::HashSet;

/// What a file shows, and what it shows nowhere.
pub(super) struct Shown {
    pub(super) observed: Observed,
    /// Whether it shows any face with its corners clockwise as seen, and any with its corners counter-clockwise.
    pub(super) shows_back: bool,
    pub(super) shows_front: bool,
    /// Whether it shows nothing or another primitive more than a pixel within such a face.
    pub(super) lacks_back: bool,
    pub(super) lacks_front: bool,
    /// The least depth along the axis at which it agrees with the truth; infinite if it agrees nowhere.
    pub(super) nearest: f64,
    /// Whether at least half of what it does not show lies nearer than that, and it shows hardly any of this elsewhere: a near
    /// plane explains it.
    pub(super) may_clip: bool,
    /// Whether meshes may stand in the place of spheres: their outlines lie inside, so that no sample is gained, and
    /// the triangles have ids of their own.
    pub(super) may_hold_meshes: bool,
}

impl Shown {
    pub(super) fn new(
        view: &View,
        rays: &ViewingRays,
        judge: &Judge,
        truth: &Drawn,
        observed: Observed,
    ) -> Shown {
        let (mut shows_back, mut shows_front, mut nearest) = (false, false, f64::INFINITY);
        let (mut lacks_back, mut lacks_front) = (false, false);
        let mut seen = HashSet::new();
        let mut missing = Vec::new();
        for (index, &id) in truth.ids.iter().enumerate() {
            if id == NO_PRIMITIVE {
                continue;
            }
            if !agrees(&observed, index, id, truth.t[index]) {
                missing.push((truth.t[index] * rays.distance.abs(), index));
                let at = [index / rays.x.len(), index % rays.x.len()];
                if let Some(is_back) = well_within(view, rays, at, id) {
                    lacks_back |= is_back;
                    lacks_front |= !is_back;
                }
                continue;
            }
            nearest = nearest.min(truth.t[index] * rays.distance.abs());
            if seen.insert(id)
                && let Primitive::Triangle(corners) = view.primitive(id.into())
            {
                let ray = rays.ray(index / rays.x.len(), index % rays.x.len());
                let is_back = judge.facing(&corners, &ray) == Sign::Positive;
                shows_back |= is_back;
                shows_front |= !is_back;
            }
        }
        let before = missing.iter().filter(|(depth, _)| *depth < nearest);
        let before: Vec<usize> = before.map(|(_, index)| *index).collect();
        let least = nearest / rays.distance.abs();
        let may_clip = 2 * before.len() >= missing.len()
            && 10 * shown_elsewhere(&observed, truth, &before, least) <= before.len()
            && 10 * shown_instead(view, rays, judge, &observed, &before) <= before.len();
        let gains = |index: usize| {
            truth.ids[index] == NO_PRIMITIVE && observed.covered(index, NothingEncoding::Ours)
        };
        let may_hold_meshes =
            !matches!(observed.values, Values::Ids(_)) && !(0..truth.ids.len()).any(gains);
        Shown {
            observed,
            shows_back,
            shows_front,
            lacks_back,
            lacks_front,
            nearest,
            may_clip,
            may_hold_meshes,
        }
    }
}

/// How many of the primitives that are missing in these pixels, or of distances below the least right one, the file shows in wrong
/// places: what a plane cuts away is seen nowhere.
fn shown_elsewhere(observed: &Observed, truth: &Drawn, missing: &[usize], least: f64) -> usize {
    match &observed.values {
        Values::Mask(_) => 0,
        Values::Ids(ids) => {
            let wrong = ids.iter().zip(&truth.ids).filter(|(id, own)| **id != Some((**own).into()));
            let wrong: HashSet<u64> = wrong.filter_map(|(id, _)| *id).collect();
            missing.iter().filter(|&&pixel| wrong.contains(&truth.ids[pixel].into())).count()
        }
        Values::Distances(t) => {
            let is_near = |t: &&f64| **t > 0.0 && **t < least && !is_same_distance(**t, least);
            t.iter().filter(is_near).count()
        }
    }
}

/// In how many of these pixels the file shows a primitive that does not cover the sample: behind what a plane cuts away lies what
/// does.
fn shown_instead(
    view: &View,
    rays: &ViewingRays,
    judge: &Judge,
    observed: &Observed,
    pixels: &[usize],
) -> usize {
    let Values::Ids(ids) = &observed.values else { return 0 };
    let width = rays.x.len();
    let is_beside = |pixel: &&usize| {
        let shown = ids[**pixel].filter(|&id| id < view.scene.primitive_count());
        let ray = || rays.ray(**pixel / width, **pixel % width);
        shown.is_some_and(|id| !judge.covers(&view.primitive(id), &ray()))
    };
    pixels.iter().filter(is_beside).count()
}

/// Whether a triangle that is seen at a sample is a back face; `None` if its outline is within a pixel.
fn well_within(view: &View, rays: &ViewingRays, at: [usize; 2], id: u32) -> Option<bool> {
    let Primitive::Triangle(corners) = view.primitive(id.into()) else { return None };
    let outline = TriangleOutline::new(&corners, rays)?;
    let distances = SampleDistances::new(rays, at);
    let is_within = outline.edges.iter().all(|edge| distances.to_zero(edge) > 1.0);
    is_within.then_some(!outline.is_front)
}

fn agrees(observed: &Observed, index: usize, id: u32, t: f64) -> bool {
    match &observed.values {
        Values::Mask(mask) => mask[index],
        Values::Ids(ids) => ids[index] == Some(id.into()),
        Values::Distances(distances) => {
            distances[index].is_finite() && is_same_distance(distances[index], t)
        }
    }
}

/// Whether two finite distances are equal within the tolerance of the diff.
pub(super) fn is_same_distance(one: f64, other: f64) -> bool {
    (one - other).abs() <= DEPTH_TOLERANCE * one.abs().max(other.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_agrees_with_no_distance() {
        let values = Values::Distances(vec![2.0, f64::INFINITY, f64::NAN]);
        let observed = Observed { size: [3, 1], values };
        assert_eq!([0, 1, 2].map(|index| agrees(&observed, index, 0, 2.0)), [true, false, false]);
    }
}
