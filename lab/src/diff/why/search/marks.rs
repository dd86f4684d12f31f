//! Points of the scene, and where a file has them.

use super::super::contour::Coverage;
use super::super::convention::{Convention, Placement, Stance};
use super::super::encoding::{Encoding, NothingEncoding};
use super::super::expected::Expected;
use super::super::fit::seen_in_both;
use super::super::observed::Values;
use super::Search;
use crate::common::Primitive;
use crate::common::glam::DVec3;

/// For each way in which a stance is free, so many marks must be seen: each primitive tells two numbers, a piece of a contour one,
/// and its neighbours nearly the same.
const PRIMITIVES_EACH: usize = 2;
const PIECES_EACH: usize = 30;

/// So many times as far as what is seen of a plane at its contour lies the horizon.
const HORIZON: f64 = 1e6;

/// By what a file tells places.
pub(super) enum Landmarks {
    /// By the middles of its primitives.
    Middles,
    /// By the contour of what it covers, which is given as our picture lies.
    Contour(Coverage),
}

impl Landmarks {
    /// The fewest marks that tell a stance with so much freedom.
    pub(super) fn fewest(&self, freedom: usize) -> usize {
        let each = match self {
            Landmarks::Middles => PRIMITIVES_EACH,
            Landmarks::Contour(_) => PIECES_EACH,
        };
        each * freedom
    }
}

/// A point of the scene, and the way to where the file has it.
pub(super) struct Mark {
    pub(super) id: u32,
    /// In the world.
    pub(super) point: DVec3,
    /// Columns to the right and rows down.
    pub(super) offset: [f64; 2],
    /// The only direction in which the offset tells anything, if there is one: a unit vector.
    pub(super) across: Option<[f64; 2]>,
    pub(super) weight: f64,
}

impl Search<'_> {
    /// By what the file tells places, if it does: distances tell none.
    pub(super) fn landmarks(
        &self,
        placement: Placement,
        nothing: NothingEncoding,
    ) -> Option<Landmarks> {
        match &self.observed.values {
            Values::Ids(_) => Some(Landmarks::Middles),
            Values::Mask(_) => Some(Landmarks::Contour(self.coverage(placement, nothing))),
            Values::Distances(_) => None,
        }
    }

    /// What the file covers, as our picture lies.
    pub(super) fn coverage(&self, placement: Placement, nothing: NothingEncoding) -> Coverage {
        let expected = Expected::new(self.view, &Convention::default(), self.truth);
        let mut covered = vec![false; self.truth.ids.len()];
        expected.each_pixel(placement, |pixel, index, _| {
            covered[pixel] = self.observed.covered(index, nothing);
        });
        let [width, _] = expected.size();
        Coverage::new(width, covered)
    }

    /// The marks that our picture and the file have in common.
    pub(super) fn marks(
        &self,
        landmarks: &Landmarks,
        stance: &Stance,
        expected: &Expected,
        (placement, encoding): (Placement, &Encoding),
    ) -> Option<Vec<Mark>> {
        let theirs = match landmarks {
            Landmarks::Middles => {
                let seen = seen_in_both(expected, self.observed, placement, encoding)?;
                let marks = seen.iter().filter_map(|one| {
                    let point = self.center(one.id)?;
                    let (offset, weight) = (one.offset(), one.weight());
                    Some(Mark { id: one.id, point, offset, across: None, weight })
                });
                return Some(marks.collect());
            }
            Landmarks::Contour(theirs) => theirs,
        };
        let [width, _] = expected.size();
        let ids = &expected.drawn.ids;
        let ours = Coverage::of(expected);
        let marks = ours.contour(theirs).into_iter().map(|piece| {
            let pixel = piece.pixel[0] * width + piece.pixel[1];
            let [x, y] = ours.from_middle(piece.place);
            // The contour of a plane is its horizon, which no step of the eye brings nearer.
            let far = if self.center(ids[pixel]).is_some() { 1.0 } else { HORIZON };
            let depth = far * expected.depth(pixel);
            Mark {
                id: ids[pixel],
                point: stance.point([x, y, depth], self.view.camera),
                offset: piece.across.map(|part| piece.farther * part),
                across: Some(piece.across),
                weight: piece.length,
            }
        });
        Some(marks.collect())
    }

    /// The middle of a primitive in the world, if it has one.
    pub(super) fn center(&self, id: u32) -> Option<DVec3> {
        let from_eye = match self.view.primitive(id.into()) {
            Primitive::Triangle([a, b, c]) => (a + b + c) / 3.0,
            Primitive::Sphere { center, .. } => center,
            Primitive::Plane { .. } => return None,
        };
        Some(self.view.camera.eye().as_dvec3() + from_eye)
    }
}
