//! A primitive on the raster of a convention: its edge functions, its distance, and the pixels that it may cover.
//!
//! All of it is computed in `f64` with a bound for the roundoff; a sample within the bound goes to the exact judge.

use super::rays::ViewingRays;
use crate::common::glam::DVec3;
use crate::common::{Projection, Ray};
use std::ops::Range;

/// A function `constant + x·along_x + y·along_y` of the viewport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Linear {
    pub(super) constant: f64,
    pub(super) along_x: f64,
    pub(super) along_y: f64,
    /// The largest error of a value on the raster.
    pub(super) error: f64,
}

impl Linear {
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        (self.constant + self.along_y * y) + self.along_x * x
    }

    fn negated(self) -> Linear {
        let Linear { constant, along_x, along_y, error } = self;
        Linear { constant: -constant, along_x: -along_x, along_y: -along_y, error }
    }
}

/// The roundoff of a triple product, relative to the product of the lengths of its vectors. A triple product, and the
/// sum of three of them for a point of the viewport, take fewer than 64 roundings of 2⁻⁵³; this is four times as much.
const ROUNDOFF: f64 = 1.0 / (1_u64 << 45) as f64;
/// What keeps a bound above zero where products underflow.
const FLOOR: f64 = 1e-280;

/// A triangle on the raster.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleOutline {
    /// `E_ab`, `E_bc`, `E_ca`, with positive values inside.
    pub(super) edges: [Linear; 3],
    /// The distance `t` is the quotient of these two.
    pub(super) numerator: Linear,
    pub(super) denominator: Linear,
    /// Whether the corners are seen counter-clockwise.
    pub(super) is_front: bool,
}

impl TriangleOutline {
    /// The outline of a triangle `abc`; `None` if the triangle is seen edge-on.
    pub(super) fn new(corners: &[DVec3; 3], rays: &ViewingRays) -> Option<TriangleOutline> {
        let [a, b, c] = *corners;
        let normal = (b - a).cross(c - a);
        let axis = rays.axis();
        let facing = match rays.projection {
            Projection::Perspective => a.dot(b.cross(c)),
            Projection::Parallel => normal.dot(axis),
        };
        let bound = match rays.projection {
            Projection::Perspective => a.length() * b.length() * c.length(),
            Projection::Parallel => (b - a).length() * (c - a).length() * axis.length(),
        };
        let negative = if facing.abs() > bound * ROUNDOFF + FLOOR {
            facing < 0.0
        } else {
            let ray = Ray { origin: DVec3::ZERO, direction: axis };
            match rays.judge().facing(corners, &ray) {
                crate::common::Sign::Zero => return None,
                sign => sign == crate::common::Sign::Negative,
            }
        };
        let edge = |p: DVec3, q: DVec3| {
            let edge = edge_function(p, q, rays);
            if negative { edge.negated() } else { edge }
        };
        let (numerator, denominator) = distance(a, b, c, rays);
        Some(TriangleOutline {
            edges: [edge(a, b), edge(b, c), edge(c, a)],
            numerator,
            denominator,
            is_front: negative,
        })
    }

    /// The distance `t` at a point of the viewport, and a bound for its error.
    pub(super) fn t(&self, x: f64, y: f64) -> (f64, f64) {
        let (numerator, denominator) = (self.numerator.at(x, y), self.denominator.at(x, y));
        let t = numerator / denominator;
        let relative =
            self.numerator.error / numerator.abs() + self.denominator.error / denominator.abs();
        // Twice the error of the first order; beyond this size the first order is not enough.
        let error = if relative < 1e-3 { 2.0 * relative * t.abs() } else { f64::INFINITY };
        (t, error)
    }
}

/// `det(p − O, q − O, D)` as a function of the viewport.
fn edge_function(p: DVec3, q: DVec3, rays: &ViewingRays) -> Linear {
    let (axis, extent) = (rays.axis(), rays.extent());
    let cross = p.cross(q);
    match rays.projection {
        Projection::Perspective => Linear {
            constant: cross.dot(axis),
            along_x: cross.dot(rays.u),
            along_y: cross.dot(rays.v),
            error: p.length() * q.length() * (axis.length() + extent) * ROUNDOFF + FLOOR,
        },
        // (p − O) × (q − O) = p × q + (q − p) × O
        Projection::Parallel => {
            let turned = axis.cross(q - p);
            let spread = if rays.spread { 1.0 } else { 0.0 };
            Linear {
                constant: cross.dot(axis),
                along_x: spread * turned.dot(rays.u),
                along_y: spread * turned.dot(rays.v),
                error: (p.length() + extent) * (q.length() + extent) * axis.length() * ROUNDOFF
                    + FLOOR,
            }
        }
    }
}

/// The numerator and the denominator of `t = n·(a − O)/(n·D)`.
fn distance(a: DVec3, b: DVec3, c: DVec3, rays: &ViewingRays) -> (Linear, Linear) {
    let normal = (b - a).cross(c - a);
    let area = (b - a).length() * (c - a).length();
    plane_distance(a, normal, area, rays)
}

/// The same for a plane through `point`; `size` bounds the length of the normal, rounded.
pub(super) fn plane_distance(
    point: DVec3,
    normal: DVec3,
    size: f64,
    rays: &ViewingRays,
) -> (Linear, Linear) {
    let (axis, extent) = (rays.axis(), rays.extent());
    let constant = |value: f64, length: f64| Linear {
        constant: value,
        along_x: 0.0,
        along_y: 0.0,
        error: size * length * ROUNDOFF + FLOOR,
    };
    let along = |value: f64, length: f64, sign: f64| Linear {
        along_x: sign * normal.dot(rays.u),
        along_y: sign * normal.dot(rays.v),
        ..constant(value, length + extent)
    };
    let (to_plane, along_axis) = (normal.dot(point), normal.dot(axis));
    match (rays.projection, rays.spread) {
        (Projection::Perspective, _) => {
            (constant(to_plane, point.length()), along(along_axis, axis.length(), 1.0))
        }
        (Projection::Parallel, true) => {
            (along(to_plane, point.length(), -1.0), constant(along_axis, axis.length()))
        }
        (Projection::Parallel, false) => {
            (constant(to_plane, point.length()), constant(along_axis, axis.length()))
        }
    }
}

/// The pixels of a rectangle: rows and columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
}

/// The pixels whose samples a triangle may cover, and `margin` pixels around them.
pub(super) fn area_of_triangle(corners: &[DVec3; 3], rays: &ViewingRays, margin: f64) -> Area {
    area(corners.iter().map(|&corner| project(corner, 0.0, rays)), rays, margin)
}

/// The same for a sphere.
pub(super) fn area_of_sphere(center: DVec3, radius: f64, rays: &ViewingRays, margin: f64) -> Area {
    // Wider than the sphere by far more than roundoff.
    area(std::iter::once(project(center, radius * 1.0001, rays)), rays, margin)
}

/// All pixels.
pub(super) fn whole(rays: &ViewingRays) -> Area {
    Area { rows: 0..rays.y.len(), columns: 0..rays.x.len() }
}

/// The least and the largest `x` and `y` on the viewport of a point, or of a ball around it; `None` if parts of it
/// lie beside or behind the eye.
fn project(point: DVec3, radius: f64, rays: &ViewingRays) -> Option<[[f64; 2]; 2]> {
    let place = [point.dot(rays.u), point.dot(rays.v)];
    if rays.projection == Projection::Parallel {
        return rays.spread.then(|| place.map(|at| [at - radius, at + radius]));
    }
    // point = t·D: its depth along the axis is t·d.
    let depth = -point.dot(rays.w) / rays.distance;
    let [near, far] = [-1.0, 1.0].map(|side| depth + side * radius / rays.distance.abs());
    // In front, and so far that rounding moves the point by much less than a pixel.
    let smallest = (point.length() + radius) / rays.distance.abs() * 1e-9;
    if near <= smallest || near.is_nan() {
        return None;
    }
    Some(place.map(|at| {
        let ends =
            [(at - radius) / near, (at - radius) / far, (at + radius) / near, (at + radius) / far];
        [
            ends.into_iter().fold(f64::INFINITY, f64::min),
            ends.into_iter().fold(f64::NEG_INFINITY, f64::max),
        ]
    }))
}

fn area(
    places: impl Iterator<Item = Option<[[f64; 2]; 2]>>,
    rays: &ViewingRays,
    margin: f64,
) -> Area {
    let mut box_ = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    for place in places {
        let Some(place) = place else { return whole(rays) };
        for (side, [low, high]) in box_.iter_mut().zip(place) {
            *side = [side[0].min(low), side[1].max(high)];
        }
    }
    let [x, y] = box_;
    Area { rows: indices(&rays.y, y, margin), columns: indices(&rays.x, x, margin) }
}

/// The indices of equally spaced coordinates within `[low, high]`, and a few around them.
pub(super) fn indices(coordinates: &[f64], [low, high]: [f64; 2], margin: f64) -> Range<usize> {
    let count = coordinates.len();
    let (Some(&first), Some(&last)) = (coordinates.first(), coordinates.last()) else {
        return 0..0;
    };
    if count == 1 {
        return 0..1;
    }
    #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
    let spacing = (last - first) / (count - 1) as f64;
    let [a, b] = [low, high].map(|at| (at - first) / spacing);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number below 0 or NaN becomes 0, one above the count becomes the largest"
    )]
    let index = |at: f64| at as usize;
    let [begin, end] = [a.min(b) - margin - 0.01, a.max(b) + margin + 0.01];
    if a.is_nan() || b.is_nan() {
        return 0..count;
    }
    if end < 0.0 {
        return 0..0;
    }
    let end = index(end).saturating_add(1).min(count);
    index(begin.ceil()).min(end)..end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Camera;
    use crate::diff::why::convention::Convention;

    #[test]
    fn indices_are_those_between_two_coordinates() {
        let four = [-3.0, -1.0, 1.0, 3.0];
        assert_eq!(indices(&four, [-1.0, 1.0], 0.0), 1..3);
        assert_eq!(indices(&four, [-0.5, 0.5], 0.0), 2..2);
        assert_eq!(indices(&four, [-0.5, 0.5], 1.0), 1..3);
        assert_eq!(indices(&four, [-90.0, 90.0], 0.0), 0..4);
        assert_eq!(indices(&four, [5.0, 90.0], 0.0), 4..4);
        assert_eq!(indices(&four, [-90.0, -5.0], 0.0), 0..0);
        assert_eq!(indices(&four, [f64::NAN, 0.0], 0.0), 0..4);
        let descending = [3.0, 1.0, -1.0, -3.0];
        assert_eq!(indices(&descending, [-1.0, 0.0], 0.0), 2..3);
    }

    #[test]
    fn a_triangle_s_functions_have_their_values() {
        let rays = ViewingRays::new(&Camera::canonical(8, 8), &Convention::default());
        let corner = |x: f64, y: f64| DVec3::new(2.0 * x, 2.0 * y, -2.0);
        let corners = [corner(-0.25, -0.25), corner(0.25, -0.25), corner(-0.25, 0.25)];
        let outline = TriangleOutline::new(&corners, &rays).unwrap();
        assert!(outline.is_front);
        let at = |x, y| outline.edges.map(|edge| edge.at(x, y).total_cmp(&0.0) as i8);
        assert_eq!(at(-0.1, -0.1), [1, 1, 1]);
        assert_eq!(at(0.2, 0.2), [1, -1, 1]);
        assert_eq!(at(0.0, 0.0), [1, 0, 1]);
        assert_eq!(outline.t(-0.1, -0.1).0, 2.0);
        let area = area_of_triangle(&corners, &rays, 0.0);
        assert_eq!(area, Area { rows: 2..6, columns: 2..6 });
    }
}
