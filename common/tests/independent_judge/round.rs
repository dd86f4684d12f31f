//! Spheres that rays touch exactly, and spheres, triangles and planes met at exactly one distance.
//!
//! Everything is made of directions and radius vectors whose lengths are rational, so that what is
//! meant to be equal is equal in the stored numbers.

use crate::cases::{Case, Placement, few_bit_camera, few_bits, pictures, triangle};
use bothways_common::glam::Vec3;
use bothways_common::{CameraDescription, Plane, Projection, Shape, Sphere};
use proptest::prelude::*;

/// A viewing direction of rational length, by its point on the viewport at distance 1, and two
/// vectors of whole length that are perpendicular to it.
type Direction = ([f32; 2], [[f32; 3]; 2]);

const DIRECTIONS: [Direction; 6] = [
    ([0.0, 0.0], [[1.0, 0.0, 0.0], [3.0, -4.0, 0.0]]),
    ([0.75, 0.0], [[0.0, 1.0, 0.0], [4.0, 0.0, 3.0]]),
    ([0.0, -0.75], [[1.0, 0.0, 0.0], [0.0, -4.0, 3.0]]),
    ([0.5, 1.0], [[2.0, 1.0, 2.0], [2.0, -2.0, -1.0]]),
    ([1.0, 0.5], [[1.0, 2.0, 2.0], [2.0, -2.0, 1.0]]),
    ([1.75, 1.0], [[4.0, -8.0, -1.0], [4.0, 1.0, 8.0]]),
];

/// Vectors of whole length.
const RADII: [[f32; 3]; 7] = [
    [1.0, 0.0, 0.0],
    [0.0, 0.0, -1.0],
    [1.0, 2.0, -2.0],
    [-2.0, 3.0, -6.0],
    [3.0, 0.0, -4.0],
    [4.0, -4.0, -7.0],
    [0.0, -3.0, -4.0],
];

/// A ray in the camera's frame.
#[derive(Clone, Copy, Debug)]
struct Line {
    /// Its point on the viewport.
    point: [f32; 2],
    origin: Vec3,
    direction: Vec3,
    /// Perpendicular to it, of whole length.
    across: Vec3,
}

impl Line {
    fn at(self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }
}

/// A line for the projection, from the table.
fn line(projection: Projection, index: usize, which: usize) -> Line {
    let (point, _) = DIRECTIONS[index];
    let across = |index: usize| Vec3::from_array(DIRECTIONS[index].1[which]);
    let on_viewport = Vec3::new(point[0], point[1], 0.0);
    match projection {
        Projection::Perspective => Line {
            point,
            origin: Vec3::ZERO,
            direction: on_viewport - Vec3::Z,
            across: across(index),
        },
        // All rays run along −w, as the first of the table does.
        Projection::Parallel => {
            Line { point, origin: on_viewport, direction: Vec3::NEG_Z, across: across(0) }
        }
    }
}

fn camera_and_line() -> impl Strategy<Value = (CameraDescription, Line)> {
    (few_bit_camera(), 0..DIRECTIONS.len(), 0..2_usize).prop_map(|(camera, index, which)| {
        let camera =
            CameraDescription { distance: 1.0, viewport: [1.0, 1.0], image: [1, 1], ..camera };
        (camera, line(camera.projection, index, which))
    })
}

fn case(camera: CameraDescription, line: Line, shapes: Vec<Shape>) -> impl Strategy<Value = Case> {
    pictures(Just(camera), Just(shapes), Placement::Frame)
        .prop_map(move |case| Case { points: vec![line.point.map(f64::from)], ..case })
}

fn sphere(center: Vec3, radius: f32) -> Shape {
    Shape::Sphere(Sphere { center, radius })
}

/// Some way along a line.
fn distance() -> impl Strategy<Value = f32> {
    prop_oneof![4 => 1..=16_i8, 1 => -8..=8_i8].prop_map(|k| 0.5 * f32::from(k))
}

/// A length as it is, and the numbers next to it.
fn nearly(length: f32, which: u8) -> f32 {
    match which {
        0 => length.next_down(),
        1 => length.next_up(),
        _ => length,
    }
}

/// Spheres that a ray touches, misses or enters by the last bit of the radius.
pub(crate) fn touched() -> impl Strategy<Value = Case> {
    let one = (distance(), proptest::sample::select(&[-2.0, -0.5, 0.25, 1.0][..]), 0..4_u8);
    let several = proptest::collection::vec(one, 1..=3);
    (camera_and_line(), several).prop_flat_map(|((camera, line), several)| {
        let shapes = several.iter().map(|&(t, factor, which): &(f32, f32, u8)| {
            let to_center = factor * line.across;
            sphere(line.at(t) + to_center, nearly(to_center.length(), which))
        });
        case(camera, line, shapes.collect())
    })
}

/// Spheres, triangles and a plane through one point of a ray, rational distances all; and two
/// spheres on either side of the ray, whose common distance is irrational.
pub(crate) fn met_at_one_point() -> impl Strategy<Value = Case> {
    let spheres = [(0..RADII.len(), any::<bool>()), (0..RADII.len(), any::<bool>())];
    let rest = (distance(), [few_bits(), few_bits()], 1.0..6.0_f32, 0..6_u8);
    (camera_and_line(), spheres, rest).prop_flat_map(|((camera, line), spheres, rest)| {
        let (t, [e, f], radius, which) = rest;
        let point = line.at(t);
        let through_point = spheres.map(|(index, far)| {
            let to_center = Vec3::from_array(RADII[index]) * if far { -1.0 } else { 1.0 };
            sphere(point + to_center, nearly(to_center.length(), which))
        });
        let beside = [0.5, -0.5].map(|side| sphere(point + side * line.across, radius));
        let face = triangle([point + e, point + f, point - e - f]);
        let normal = if e == Vec3::ZERO { Vec3::Z } else { e };
        let plane = Shape::Plane(Plane { point, normal });
        let mut shapes: Vec<_> = [through_point, beside].concat();
        // Flat things come first in half of the pictures, so that no order of ids helps.
        let place = if which % 2 == 0 { 0 } else { shapes.len() };
        shapes.splice(place..place, [face, plane]);
        case(camera, line, shapes)
    })
}

/// Spheres that the ray's origin (for a perspective camera, the eye) lies on, in, or just outside.
pub(crate) fn about_the_eye() -> impl Strategy<Value = Case> {
    let one = (0..RADII.len(), any::<bool>(), 0..4_u8, prop_oneof![Just(1.0_f32), Just(1.5)]);
    let several = proptest::collection::vec(one, 1..=3);
    (camera_and_line(), several).prop_flat_map(|((camera, line), several)| {
        let shapes = several.iter().map(|&(index, behind, which, factor)| {
            let to_center = Vec3::from_array(RADII[index]) * if behind { -1.0 } else { 1.0 };
            sphere(line.origin + to_center, nearly(factor * to_center.length(), which))
        });
        case(camera, line, shapes.collect())
    })
}

/// Spheres of up to 10⁹ that touch each other from inside at a point of a ray, or nearly; have one centre and nearly
/// one radius, or nearly one centre; or hold the ray's origin; and the plane that touches them.
pub(crate) fn huge_and_nearly_touching() -> impl Strategy<Value = Case> {
    let size = || (0..=29_i8).prop_map(|exponent| f32::from(exponent).exp2());
    let one = (0..RADII.len(), [size(), size()], 0..4_u8, 0..6_u8);
    (camera_and_line(), distance(), any::<bool>(), one).prop_flat_map(
        |((camera, line), t, far, (index, [size, other_size], which, kind))| {
            let out = Vec3::from_array(RADII[index]) * if far { 1.0 } else { -1.0 };
            let point = if kind == 0 { line.origin } else { line.at(t) };
            let ball = |point: Vec3, size: f32, which: u8| {
                sphere(point + size * out, nearly(size * out.length(), which))
            };
            let beside = Vec3::new((size * out.x).next_up() / size, out.y, out.z);
            let other = match kind {
                0 | 1 => ball(point, other_size, which),
                2 => ball(point, size, (which + 1) % 4),
                3 => sphere(point + size * beside, size * out.length()),
                4 => ball(point + 0.25 * line.across, size, which),
                _ => ball(point + 0.0625 * out, size, which),
            };
            let touching = Shape::Plane(Plane { point, normal: out });
            case(camera, line, vec![ball(point, size, 2), other, touching])
        },
    )
}
