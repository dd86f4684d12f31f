//! Cameras with frames that run almost along the world's axes, in front of scenes on a lattice: numbers that are
//! exact in an aligned frame are not exact in a tilted frame, even for a very small tilt.

#![expect(clippy::cast_precision_loss, reason = "small numbers")]

use crate::four_renderers::all_agree;
use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Object, Options, Orientation, Projection, View};
use bothways_test_support::{PROJECTIONS, hostile, scene, triangle};
use proptest::prelude::*;

/// The least and the greatest tilt, as powers of two. Components below 2⁻¹⁰⁰ of a frame are 0 by the contract.
const TILTS: std::ops::RangeInclusive<i32> = -100..=-20;

/// The part of a camera's description that gives the tilted frame.
#[derive(Clone, Copy, Debug)]
enum Tilted {
    Frame,
    Direction,
    LookAt,
}

/// A camera that looks down the negative z axis, its samples one unit apart at a distance of 1; turned a little
/// about its up, its right and its back, by tangents of angles.
fn tilted(
    projection: Projection,
    by: Tilted,
    [yaw, pitch, roll]: [f32; 3],
    image: [u32; 2],
) -> Camera {
    let up = Vec3::new(-roll, 1.0, 0.0);
    let (eye, orientation) = match by {
        Tilted::Frame => {
            let u = Vec3::new(1.0, roll, 0.0);
            (Vec3::ZERO, Orientation::Frame { u, v: up, w: Vec3::new(yaw, pitch, 1.0) })
        }
        Tilted::Direction => {
            let direction = Vec3::new(-yaw, -pitch, -1.0);
            (Vec3::ZERO, Orientation::Direction { direction, up })
        }
        Tilted::LookAt => {
            (Vec3::new(yaw, pitch, 0.0), Orientation::LookAt { target: Vec3::NEG_Z, up })
        }
    };
    let viewport = image.map(|side| side as f32);
    let description =
        CameraDescription { projection, eye, orientation, viewport, image, distance: 1.0 };
    Camera::new(description).expect("it is a camera")
}

/// Triangles with corners at samples or between samples, in planes at whole distances.
fn lattice() -> impl Strategy<Value = Vec<Object>> {
    let halves = || (-10..=10_i8).prop_map(|twice| 0.5 * f32::from(twice));
    let corner = || (halves(), halves());
    let depth = prop_oneof![3 => Just(1.0_f32), 1 => Just(2.0), 1 => Just(3.0)];
    let one = (corner(), corner(), corner(), depth).prop_map(|(a, b, c, depth)| {
        triangle([a, b, c].map(|(x, y)| [x * depth, y * depth, -depth]))
    });
    proptest::collection::vec(one, 1..5)
}

fn tilt() -> impl Strategy<Value = f32> {
    let size = (TILTS, 1.0..2.0_f32, any::<bool>()).prop_map(|(exponent, part, minus)| {
        let size = part * (exponent as f32).exp2();
        if minus { -size } else { size }
    });
    // The cosine of 90 degrees as many programs compute it.
    prop_oneof![4 => Just(0.0_f32), 1 => Just(6.123_234e-17), 6 => size]
}

fn agree(objects: Vec<Object>, camera: &Camera, what: &str) {
    let scene = scene(objects);
    all_agree(&View::new(&scene, camera), &Options::default(), what);
}

#[test]
fn a_frame_tilted_by_the_cosine_of_90_degrees() {
    let parallel = tilted(Projection::Parallel, Tilted::Frame, [6.123_234e-17, 0.0, 0.0], [8; 2]);
    let corners = [[-1.5, -2.5, -1.0], [2.5, -2.5, -1.0], [-1.5, 2.5, -1.0]];
    agree(vec![triangle(corners)], &parallel, "parallel");
    let perspective = tilted(Projection::Perspective, Tilted::Frame, [1e-18, 0.0, 0.0], [8; 2]);
    let corners = [[-2.5, -0.5, -1.0], [2.5, -0.5, -1.0], [0.5, -3.5, -1.0]];
    agree(vec![triangle(corners)], &perspective, "perspective");
}

#[test]
fn an_eye_that_a_rounding_moved_off_the_axis() {
    let ties = bothways::scenes::load("ties").expect("it is built in").scene;
    let orientation = Orientation::LookAt { target: Vec3::ZERO, up: Vec3::Y };
    for (projection, side) in [(Projection::Perspective, 1.0), (Projection::Parallel, 4.0)] {
        let description = CameraDescription {
            projection,
            eye: Vec3::new(1e-17, 0.0, 4.0),
            orientation,
            viewport: [side; 2],
            image: [64; 2],
            distance: 1.0,
        };
        let camera = Camera::new(description).expect("it is a camera");
        all_agree(&View::new(&ties, &camera), &Options::default(), &format!("{projection:?}"));
    }
}

#[test]
fn the_renderers_agree_on_lattices_in_front_of_tilted_cameras() {
    let by = prop_oneof![Just(Tilted::Frame), Just(Tilted::Direction), Just(Tilted::LookAt)];
    let image = prop_oneof![Just([8_u32, 8]), Just([9, 9]), Just([7, 12])];
    let strategy = (lattice(), by, [tilt(), tilt(), tilt()], image);
    let run = hostile::runner(3000).run(&strategy, |(objects, by, tilt, image)| {
        for projection in PROJECTIONS {
            let camera = tilted(projection, by, tilt, image);
            let what = format!("{projection:?}, {by:?}, tilted by {tilt:?}");
            agree(objects.clone(), &camera, &what);
        }
        Ok(())
    });
    run.expect("all renderers agree");
}
