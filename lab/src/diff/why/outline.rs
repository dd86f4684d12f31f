//! A primitive on the raster of a convention: its edge functions, its distance, and the pixels that it may cover.
//!
//! All of it is computed in `f64` with a bound for the roundoff; a sample within the bound goes to the exact judge.

use super::convention::Interpolation;
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

    /// The function with these values at three points of the viewport; `None` if they lie on a line.
    fn through(points: [([f64; 2], f64); 3], extent: f64) -> Option<Linear> {
        let [([x, y], value), b, c] = points;
        let beside = |([right, up], other): ([f64; 2], f64)| [right - x, up - y, other - value];
        let ([bx, by, to_b], [cx, cy, to_c]) = (beside(b), beside(c));
        let area = bx * cy - cx * by;
        let along_x = (to_b * cy - to_c * by) / area;
        let along_y = (bx * to_c - cx * to_b) / area;
        let constant = value - along_x * x - along_y * y;
        let size = constant.abs() + extent * (along_x.abs() + along_y.abs());
        size.is_finite().then_some(Linear { constant, along_x, along_y, error: size * ROUGHLY })
    }

    fn negated(self) -> Linear {
        let Linear { constant, along_x, along_y, error } = self;
        Linear { constant: -constant, along_x: -along_x, along_y: -along_y, error }
    }
}

/// The roundoff of a triple product, relative to the product of the lengths of its vectors. A triple product, and the
/// sum of three of them for a point of the viewport, take fewer than 64 roundings of 2⁻⁵³; this is four times as much.
const RELATIVE_ERROR: f64 = 1.0 / (1_u64 << 45) as f64;
/// The error of a distance that is interpolated, which decides nothing exactly.
const ROUGHLY: f64 = 1e-12;
/// What keeps a bound above zero where products underflow.
const FLOOR: f64 = 1e-280;

/// The sum of a vector's coordinates without their signs: at least its length, and found without a root.
fn at_least_length(v: DVec3) -> f64 {
    v.abs().element_sum()
}

/// A triangle on the raster.
#[derive(Clone, Copy, Debug)]
pub(super) struct TriangleOutline {
    /// `E_ab`, `E_bc`, `E_ca`, with positive values inside.
    pub(super) edges: [Linear; 3],
    /// Whether the corners are seen counter-clockwise.
    pub(super) is_front: bool,
}

impl TriangleOutline {
    /// The outline of a triangle `abc`; `None` if the triangle is seen edge-on.
    pub(super) fn new(corners: &[DVec3; 3], rays: &ViewingRays) -> Option<TriangleOutline> {
        let [a, b, c] = *corners;
        let axis = rays.axis();
        let facing = match rays.projection {
            Projection::Perspective => a.dot(b.cross(c)),
            Projection::Parallel => (b - a).cross(c - a).dot(axis),
        };
        let bound = match rays.projection {
            Projection::Perspective => at_least_length(a) * at_least_length(b) * at_least_length(c),
            Projection::Parallel => {
                at_least_length(b - a) * at_least_length(c - a) * at_least_length(axis)
            }
        };
        let negative = if facing.abs() > bound * RELATIVE_ERROR + FLOOR {
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
        let edges = [edge(a, b), edge(b, c), edge(c, a)];
        Some(TriangleOutline { edges, is_front: negative })
    }
}

/// The distance `t` of a plane: the quotient of two functions of the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneDistance {
    pub(super) numerator: Linear,
    pub(super) denominator: Linear,
}

impl PlaneDistance {
    /// The distance of the plane of a triangle `abc`: `t = n·(a − O)/(n·D)`.
    pub(super) fn of_triangle(&[a, b, c]: &[DVec3; 3], rays: &ViewingRays) -> PlaneDistance {
        let normal = (b - a).cross(c - a);
        let area = at_least_length(b - a) * at_least_length(c - a);
        PlaneDistance::of_plane(a, normal, area, rays)
    }

    /// The same for a plane through `point`; `size` bounds the length of the normal, rounded.
    pub(super) fn of_plane(
        point: DVec3,
        normal: DVec3,
        size: f64,
        rays: &ViewingRays,
    ) -> PlaneDistance {
        let (axis, extent) = (rays.axis(), rays.extent());
        let constant = |value: f64, length: f64| Linear {
            constant: value,
            along_x: 0.0,
            along_y: 0.0,
            error: size * length * RELATIVE_ERROR + FLOOR,
        };
        let along = |value: f64, length: f64, sign: f64| Linear {
            along_x: sign * normal.dot(rays.u),
            along_y: sign * normal.dot(rays.v),
            ..constant(value, length + extent)
        };
        let (to_plane, along_axis) = (normal.dot(point), normal.dot(axis));
        let (numerator, denominator) = match (rays.projection, rays.spread) {
            (Projection::Perspective, _) => (
                constant(to_plane, at_least_length(point)),
                along(along_axis, at_least_length(axis), 1.0),
            ),
            (Projection::Parallel, true) => (
                along(to_plane, at_least_length(point), -1.0),
                constant(along_axis, at_least_length(axis)),
            ),
            (Projection::Parallel, false) => (
                constant(to_plane, at_least_length(point)),
                constant(along_axis, at_least_length(axis)),
            ),
        };
        PlaneDistance { numerator, denominator }
    }

    /// The distance that a renderer gives a triangle `abc`; `None` if it reaches behind the eye.
    pub(super) fn interpolated(
        corners: &[DVec3; 3],
        rays: &ViewingRays,
        interpolation: Interpolation,
    ) -> Option<PlaneDistance> {
        let t = corners.map(|corner| depth_along_axis(corner, rays) / rays.distance.abs());
        let is_ahead = t.iter().all(|t| *t > 0.0);
        let constant =
            |value: f64| Linear { constant: value, along_x: 0.0, along_y: 0.0, error: FLOOR };
        let numerator = match interpolation {
            Interpolation::Perspective => return Some(PlaneDistance::of_triangle(corners, rays)),
            _ if !is_ahead => return None,
            Interpolation::Linear => {
                let [a, b, c] = corners.map(|corner| project_ahead(corner, rays));
                Linear::through([(a?, t[0]), (b?, t[1]), (c?, t[2])], rays.extent())?
            }
            Interpolation::Mean => constant(t.iter().sum::<f64>() / 3.0),
            Interpolation::FirstCorner => constant(t[0]),
        };
        Some(PlaneDistance { numerator, denominator: constant(1.0) })
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
#[inline]
fn edge_function(p: DVec3, q: DVec3, rays: &ViewingRays) -> Linear {
    let (axis, extent) = (rays.axis(), rays.extent());
    let cross = p.cross(q);
    match rays.projection {
        Projection::Perspective => Linear {
            constant: cross.dot(axis),
            along_x: cross.dot(rays.u),
            along_y: cross.dot(rays.v),
            error: at_least_length(p)
                * at_least_length(q)
                * (at_least_length(axis) + extent)
                * RELATIVE_ERROR
                + FLOOR,
        },
        // (p − O) × (q − O) = p × q + (q − p) × O
        Projection::Parallel => {
            let turned = axis.cross(q - p);
            let spread = if rays.spread { 1.0 } else { 0.0 };
            Linear {
                constant: cross.dot(axis),
                along_x: spread * turned.dot(rays.u),
                along_y: spread * turned.dot(rays.v),
                error: (at_least_length(p) + extent)
                    * (at_least_length(q) + extent)
                    * at_least_length(axis)
                    * RELATIVE_ERROR
                    + FLOOR,
            }
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
    let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    let [mut ahead, mut behind] = [0, 0];
    for corner in corners {
        match project(*corner, rays) {
            Place::Ahead(at) => {
                ahead += 1;
                for axis in 0..2 {
                    low[axis] = low[axis].min(at[axis]);
                    high[axis] = high[axis].max(at[axis]);
                }
            }
            Place::Behind => behind += 1,
            Place::Beside => {}
        }
    }
    match [ahead, behind] {
        [3, _] => within(low, high, rays, margin),
        [_, 3] => NO_AREA,
        _ => whole(rays),
    }
}

/// The same for a sphere.
pub(super) fn area_of_sphere(center: DVec3, radius: f64, rays: &ViewingRays, margin: f64) -> Area {
    // Wider than the sphere by far more than roundoff.
    match project_ball(center, radius * 1.0001, rays) {
        Place::Ahead([low, high]) => within(low, high, rays, margin),
        Place::Behind => NO_AREA,
        Place::Beside => whole(rays),
    }
}

fn within(low: [f64; 2], high: [f64; 2], rays: &ViewingRays, margin: f64) -> Area {
    Area {
        rows: rays.y.indices([low[1], high[1]], margin),
        columns: rays.x.indices([low[0], high[0]], margin),
    }
}

/// No pixel.
const NO_AREA: Area = Area { rows: 0..0, columns: 0..0 };

/// All pixels.
pub(super) fn whole(rays: &ViewingRays) -> Area {
    Area { rows: 0..rays.y.len(), columns: 0..rays.x.len() }
}

/// Where something lies, as seen along the axis.
enum Place<T> {
    /// In front of the eye, here on the viewport.
    Ahead(T),
    /// Behind the eye: no ray comes there.
    Behind,
    /// Beside the eye, or so near to its plane that rounding may move it by more than a small part of a pixel.
    Beside,
}

impl<T> Place<T> {
    /// The place of what lies between two depths along the axis; `length` bounds its distance from the eye.
    fn new([near, far]: [f64; 2], length: f64, ahead: impl FnOnce() -> T) -> Self {
        // At a smaller part of its distance, a depth is not clear of the eye's plane.
        let clear = length * 1e-9;
        if near > clear {
            Place::Ahead(ahead())
        } else if far < -clear {
            Place::Behind
        } else {
            Place::Beside
        }
    }

    /// The place of what has no depth, as parallel rays come from everywhere; they are one where they are not spread.
    fn parallel(rays: &ViewingRays, at: T) -> Self {
        if rays.spread { Place::Ahead(at) } else { Place::Beside }
    }
}

/// The place of a point.
#[inline]
fn project(point: DVec3, rays: &ViewingRays) -> Place<[f64; 2]> {
    let place = [point.dot(rays.u), point.dot(rays.v)];
    if rays.projection == Projection::Parallel {
        return Place::parallel(rays, place);
    }
    let depth = depth_along_axis(point, rays);
    Place::new([depth, depth], at_least_length(point), || {
        // The viewport lies at depth |d|.
        let scale = rays.distance.abs() / depth;
        place.map(|at| at * scale)
    })
}

/// The place of a point that lies clearly in front of the eye.
pub(super) fn project_ahead(point: DVec3, rays: &ViewingRays) -> Option<[f64; 2]> {
    match project(point, rays) {
        Place::Ahead(at) => Some(at),
        Place::Behind | Place::Beside => None,
    }
}

/// How deep a point lies in the direction of view.
fn depth_along_axis(point: DVec3, rays: &ViewingRays) -> f64 {
    -point.dot(rays.w) * rays.distance.signum()
}

/// The place of a ball: its least and its largest `x` and `y`.
fn project_ball(point: DVec3, radius: f64, rays: &ViewingRays) -> Place<[[f64; 2]; 2]> {
    let place = [point.dot(rays.u), point.dot(rays.v)];
    if rays.projection == Projection::Parallel {
        let ends = [place.map(|at| at - radius), place.map(|at| at + radius)];
        return Place::parallel(rays, ends);
    }
    let depth = depth_along_axis(point, rays);
    let ends = [depth - radius, depth + radius];
    Place::new(ends, at_least_length(point) + radius, || {
        let [near, far] = ends.map(|depth| depth / rays.distance.abs());
        let low = place.map(|at| ((at - radius) / near).min((at - radius) / far));
        let high = place.map(|at| ((at + radius) / near).max((at + radius) / far));
        [low, high]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, CameraDescription};
    use crate::diff::why::convention::{Change, Convention, Look};

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
        assert_eq!(PlaneDistance::of_triangle(&corners, &rays).t(-0.1, -0.1).0, 2.0);
        let area = area_of_triangle(&corners, &rays, 0.0);
        assert_eq!(area, Area { rows: 2..6, columns: 2..6 });
    }

    #[test]
    fn what_lies_behind_the_eye_covers_no_pixel() {
        let forward = Convention::default();
        let backward = forward.with(Change::Look(Look::Backward));
        let [forward, backward] = [forward, backward]
            .map(|convention| ViewingRays::new(&Camera::canonical(8, 8), &convention));
        let triangle = |depths: [f64; 3]| {
            let [a, b, c] = depths;
            [DVec3::new(0.0, 0.0, -a), DVec3::new(0.25, 0.0, -b), DVec3::new(0.0, 0.25, -c)]
        };
        let areas = |depths: [f64; 3]| {
            let corners = triangle(depths);
            [&forward, &backward].map(|rays| area_of_triangle(&corners, rays, 2.0))
        };
        assert_eq!(areas([-1.0, -2.0, -1.0])[0], NO_AREA);
        assert_ne!(areas([-1.0, -2.0, -1.0])[1], NO_AREA);
        assert_eq!(areas([1.0, 2.0, 1.0])[1], NO_AREA);
        // One corner beside the eye, or before it: rays may meet the triangle anywhere.
        for near in [0.0, 1.0, -1e-12, 1e-12] {
            assert_eq!(areas([-1.0, near, -2.0]), [whole(&forward), whole(&backward)]);
        }
        let ball = |z: f64, radius: f64| {
            let center = DVec3::new(0.25, 0.0, z);
            [&forward, &backward].map(|rays| area_of_sphere(center, radius, rays, 2.0))
        };
        assert_eq!(ball(2.0, 1.5)[0], NO_AREA);
        assert_eq!(ball(-2.0, 1.5)[1], NO_AREA);
        assert_eq!(ball(2.0, 2.0), [whole(&forward), whole(&backward)]);
        // Parallel rays come from everywhere.
        let parallel = CameraDescription {
            projection: Projection::Parallel,
            ..*Camera::canonical(8, 8).description()
        };
        let parallel = Camera::new(parallel).unwrap();
        let parallel = ViewingRays::new(&parallel, &Convention::default());
        assert_ne!(area_of_triangle(&triangle([-1.0; 3]), &parallel, 0.0), NO_AREA);
    }
}
