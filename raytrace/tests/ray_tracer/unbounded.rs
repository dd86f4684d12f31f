//! Planes and triangles that reach behind the eye, in pictures of whole tiles: the vector paths that take
//! sixteen samples of one of them at a time. The textbook says what is right.

use bothways_common::engine::simd::levels;
use bothways_common::glam::Vec3;
use bothways_common::{Camera, Frame, Object, Options, Plane, Shape, Triangle, View};
use bothways_raytrace::{fast, textbook};
use bothways_test_support::{
    Dice, PROJECTIONS, assert_same_visibility, camera, on_integers, scene, turned,
};

/// Compares a picture with the textbook's, in tiles of both sizes; all levels of SIMD must give the same bits.
fn check(objects: &[Object], camera: &Camera, what: &str) {
    let scene = scene(objects.to_vec());
    let (view, options) = (View::new(&scene, camera), Options::default());
    let expected = textbook::render(&view, &options);
    let prepared = fast::prepare(&scene);
    for side in [16, 32] {
        let frames = levels().into_iter().map(|level| {
            let prepared = prepared.clone().drawn_with(level, side);
            let mut frame = Frame::new(camera, &options);
            fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
            frame
        });
        let mut first: Option<Frame> = None;
        for frame in frames {
            assert_same_visibility(&expected, &frame, &format!("{what}, tiles of {side}"));
            let first = first.get_or_insert_with(|| frame.clone());
            assert_eq!(first.distances(), frame.distances(), "{what}, tiles of {side}");
        }
    }
}

fn plane(point: Vec3, normal: Vec3) -> Object {
    Shape::Plane(Plane { point, normal }).into()
}

fn triangle([a, b, c]: [Vec3; 3]) -> Object {
    Shape::Triangle(Triangle { a, b, c }).into()
}

/// A number of few bits, so that what is made of such numbers meets samples exactly.
fn few_bits(dice: &mut Dice) -> Vec3 {
    (4.0 * dice.point()).round()
}

#[test]
fn planes_in_all_directions() {
    let mut dice = Dice(11);
    for (count, scale) in [(1, 1.0), (12, 1.0), (40, 1e-20), (40, 1e20)] {
        let planes = (0..count).map(|k| {
            let point = 2.0 * dice.point() - 3.0 * Vec3::Z;
            let normal = dice.point();
            // Some twice, given by another point and length.
            let again = if k % 4 == 0 { 1.0 } else { scale };
            plane(point, again * normal)
        });
        let planes: Vec<Object> = planes.collect();
        for projection in PROJECTIONS {
            let camera = turned(projection, [0.3, 0.2, 1.5], [0.1, 0.0, -3.0], [70, 41]);
            check(&planes, &camera, &format!("{count} planes, {projection:?}"));
        }
    }
}

#[test]
fn planes_that_meet_in_samples() {
    let mut dice = Dice(12);
    let mut normal = || {
        let normal = few_bits(&mut dice);
        if normal == Vec3::ZERO { Vec3::Y } else { normal }
    };
    // All through one point, all through the eye, all in one plane.
    let shared = Vec3::new(1.0, 2.0, -8.0);
    let pencil: Vec<Object> = (0..12).map(|_| plane(shared, normal())).collect();
    let of_eye: Vec<Object> = (0..6).map(|_| plane(Vec3::ZERO, normal())).collect();
    let same: Vec<Object> = (1..6_u8)
        .map(|k| {
            let k = f32::from(k);
            plane(Vec3::new(k, 2.0 * k, -8.0 - 3.0 * k), k * Vec3::new(1.0, 1.0, 1.0))
        })
        .collect();
    let all = [pencil.clone(), of_eye.clone(), same.clone()].concat();
    for projection in PROJECTIONS {
        for (objects, what) in
            [(&pencil, "one point"), (&of_eye, "the eye"), (&same, "one plane"), (&all, "all")]
        {
            check(objects, &on_integers(projection, 17), &format!("{what}, {projection:?}"));
        }
    }
}

#[test]
fn planes_that_nearly_hold_the_eye() {
    let mut dice = Dice(13);
    let planes = (0..24_i16).map(|k| {
        let normal = dice.point();
        let along = normal.cross(dice.point());
        plane(along + normal * (-f32::from(2 * k)).exp2(), normal)
    });
    let planes: Vec<Object> = planes.collect();
    for projection in PROJECTIONS {
        let camera = camera(projection, [0.0; 3], [2.0, 1.0], [66, 33]);
        for one in &planes {
            check(std::slice::from_ref(one), &camera, &format!("{one:?}, {projection:?}"));
        }
        check(&planes, &camera, "all of them");
    }
}

#[test]
fn triangles_that_reach_behind_the_eye() {
    let mut dice = Dice(14);
    for far in [1.0, 30.0, 1e6] {
        let triangles = (0..30).map(|k| {
            let round = |p: Vec3| if k % 3 == 0 { p.round() } else { p };
            let behind = dice.point() * far + far * Vec3::Z;
            let ahead = [(); 2].map(|()| 3.0 * dice.point() - 4.0 * Vec3::Z);
            triangle([behind, ahead[0], ahead[1]].map(round))
        });
        let triangles: Vec<Object> = triangles.collect();
        for projection in PROJECTIONS {
            let camera = turned(projection, [0.0; 3], [0.1, 0.2, -3.0], [67, 35]);
            check(&triangles, &camera, &format!("{far}, {projection:?}"));
            let camera = on_integers(projection, 17);
            check(&triangles, &camera, &format!("{far}, {projection:?}, on integers"));
        }
    }
}

#[test]
fn triangles_that_are_nearly_edge_on() {
    // The eye is a little beside the plane of each, in all digits from many to none, or two corners lie nearly opposite
    // to each other.
    let mut dice = Dice(15);
    for projection in PROJECTIONS {
        let camera = turned(projection, [0.0; 3], [0.1, 0.2, -3.0], [67, 35]);
        let beside = match projection {
            bothways_common::Projection::Perspective => dice.point(),
            bothways_common::Projection::Parallel => camera.w().as_vec3(),
        };
        let triangles = (0..60_i16).map(|k| {
            let little = (-0.8 * f32::from(k)).exp2();
            let (one, other) = (dice.point(), dice.point() - Vec3::Z);
            match k % 3 {
                // Its plane nearly holds a line through the eye.
                0 => triangle([one, one - 4.0 * beside, other + little * dice.point()]),
                1 => triangle([one, -2.0 * one + little * dice.point(), other]),
                _ => {
                    triangle([3.0 * other, 5.0 * other + little * one, 2.0 * other - little * one])
                }
            }
        });
        let triangles: Vec<Object> = triangles.collect();
        for part in triangles.chunks(6) {
            check(part, &camera, &format!("{part:?}, {projection:?}"));
        }
        check(&triangles, &camera, "all of them");
    }
}
