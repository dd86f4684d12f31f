//! Points of the scene, and where a file has them.

use super::super::contour::Coverage;
use super::super::convention::{Convention, Framing, Placement, Stance};
use super::super::encoding::{Encoding, NothingEncoding};
use super::super::expected::Expected;
use super::super::fit::seen_in_both;
use super::super::observed::Values;
use super::Search;
use crate::common::Primitive;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::DVec3;

/// For each way in which a stance is free, so many marks must be seen: each primitive tells two numbers, a piece of a contour one,
/// and its neighbours nearly the same.
const PRIMITIVES_EACH: usize = 2;
const PIECES_EACH: usize = 30;
const POINTS_EACH: usize = 30;

/// Of the points of a surface, about so many are taken.
const MOST_POINTS: usize = 4000;

/// A point that is farther from its surface than others, but not by more than this, in pixels, belongs to it.
pub(super) const FAR_OF_SURFACE: f64 = 1e-3;

/// So much nearer is nearer, and so many steps in a row may take surfaces no nearer.
const LESS: f64 = 0.9;
const MOST_WORSE: usize = 6;

/// So many times as far as what is seen of a plane at its contour lies the horizon.
const HORIZON: f64 = 1e6;

/// By what a file tells places.
pub(super) enum Landmarks {
    /// By the middles of its primitives.
    Middles,
    /// By the contour of what it covers, which is given as our picture lies.
    Contour(Coverage),
    /// By the surfaces on which its distances end.
    Surfaces,
}

impl Landmarks {
    /// The fewest marks that tell a stance with so much freedom.
    pub(super) fn fewest(&self, freedom: usize) -> usize {
        let each = match self {
            Landmarks::Middles => PRIMITIVES_EACH,
            Landmarks::Contour(_) => PIECES_EACH,
            Landmarks::Surfaces => POINTS_EACH,
        };
        each * freedom
    }
}

/// Something of the scene, and the way to where the file has it.
pub(super) struct Mark {
    pub(super) id: u32,
    /// In the world: of the scene; of a surface, where a distance of the file ends.
    pub(super) point: DVec3,
    pub(super) way: Way,
    pub(super) weight: f64,
}

/// The way to where a file has a point.
pub(super) enum Way {
    /// By so many columns to the right and rows down.
    InPicture {
        offset: [f64; 2],
        /// The only direction in which the offset tells anything, if there is one: a unit vector.
        across: Option<[f64; 2]>,
    },
    /// The point is this far from the surface on which it should lie, along its normal.
    ToSurface { normal: DVec3, far: f64 },
}

/// Whether surfaces come nearer to where distances end, step by step.
pub(super) struct Approach {
    nearest: f64,
    /// Steps in a row that took them no nearer.
    worse: usize,
}

impl Approach {
    pub(super) fn new() -> Approach {
        Approach { nearest: f64::INFINITY, worse: 0 }
    }

    /// Whether another step is worth it, by how far the middle one of these points is from its surface.
    pub(super) fn goes_on(&mut self, marks: &[Mark]) -> bool {
        let far = marks.iter().filter_map(|mark| match mark.way {
            Way::ToSurface { far, .. } => Some(far.abs()),
            Way::InPicture { .. } => None,
        });
        let mut far: Vec<f64> = far.collect();
        far.sort_by(f64::total_cmp);
        let middle = far.get(far.len() / 2).copied().unwrap_or(0.0);
        if middle < LESS * self.nearest {
            (self.nearest, self.worse) = (middle, 0);
        } else {
            self.worse += 1;
        }
        self.worse < MOST_WORSE
    }

    /// Whether the last step took them nearer.
    pub(super) fn comes_nearer(&self) -> bool {
        self.worse == 0
    }
}

impl Search<'_> {
    /// By what the file tells places, if it does.
    pub(super) fn landmarks(&self, placement: Placement, nothing: NothingEncoding) -> Landmarks {
        match &self.observed.values {
            Values::Ids(_) => Landmarks::Middles,
            Values::Mask(_) => Landmarks::Contour(self.coverage(placement, nothing)),
            Values::Distances(_) => Landmarks::Surfaces,
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
                    let way = Way::InPicture { offset: one.offset(), across: None };
                    Some(Mark { id: one.id, point, way, weight: one.weight() })
                });
                return Some(marks.collect());
            }
            Landmarks::Contour(theirs) => theirs,
            Landmarks::Surfaces => {
                let framing = Framing::default();
                return self.marks_of_surfaces(stance, expected, (placement, encoding), framing);
            }
        };
        let [width, _] = expected.size();
        let ids = &expected.drawn.ids;
        let ours = Coverage::of(expected);
        let marks = ours.contour(theirs).into_iter().map(|piece| {
            let pixel = piece.pixel[0] * width + piece.pixel[1];
            let [x, y] = ours.offset(piece.place);
            // The contour of a plane is its horizon, which no step of the eye brings nearer.
            let far = if self.center(ids[pixel]).is_some() { 1.0 } else { HORIZON };
            let depth = far * expected.depth(pixel);
            let offset = piece.across.map(|part| piece.farther * part);
            Mark {
                id: ids[pixel],
                point: stance.point([x, y, depth], self.view.camera),
                way: Way::InPicture { offset, across: Some(piece.across) },
                weight: piece.length,
            }
        });
        Some(marks.collect())
    }

    /// The points at which distances of the file end, where our picture shows something, too (Yang Chen, Gérard Medioni, "Object
    /// modeling by registration of multiple range images", IEEE International Conference on Robotics and Automation, 1991).
    pub(super) fn marks_of_surfaces(
        &self,
        stance: &Stance,
        expected: &Expected,
        (placement, encoding): (Placement, &Encoding),
        framing: Framing,
    ) -> Option<Vec<Mark>> {
        let Values::Distances(numbers) = &self.observed.values else { return None };
        let drawn = expected.drawn;
        let step = (drawn.ids.len() / MOST_POINTS).max(1);
        let eye = self.view.camera.eye().as_dvec3();
        let [width, height] = expected.size();
        #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
        let from_middle = |index: usize, side: usize| index as f64 + 0.5 - side as f64 / 2.0;
        let mut marks = Vec::new();
        expected.each_pixel(placement, |pixel, index, [row, column]| {
            let id = drawn.ids[pixel];
            if pixel % step != 0
                || id == NO_PRIMITIVE
                || !self.observed.covered(index, encoding.nothing)
            {
                return;
            }
            let Some(t) = expected.t_of(numbers[index], [row, column], encoding.distances) else {
                return;
            };
            let place = [from_middle(column, width), from_middle(row, height)];
            let place = [0, 1].map(|axis| framing.source(axis, place[axis]));
            let at = |t: f64| {
                let [x, y] = place;
                stance.point([x, y, expected.depth_of(t)], self.view.camera)
            };
            let (point, on_surface) = (at(t), at(drawn.t[pixel]));
            let normal = match self.view.primitive(id.into()) {
                Primitive::Triangle([a, b, c]) => (b - a).cross(c - a),
                Primitive::Sphere { center, .. } => on_surface - eye - center,
                Primitive::Plane { normal, .. } => normal,
            };
            let Some(normal) = normal.try_normalize() else { return };
            let far = normal.dot(on_surface - point);
            marks.push(Mark { id, point, way: Way::ToSurface { normal, far }, weight: 1.0 });
        });
        Some(marks)
    }

    /// How many pixels a length is at this depth, seen from beside, if it is as long as the picture is wide there.
    pub(super) fn pixels_of_depth(&self, depth: f64) -> f64 {
        f64::from(self.view.camera.image()[0]) / depth.abs()
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
