//! Planes in pictures of whole tiles: the vector paths that take
//! sixteen samples of one of them at a time. The textbook says what is right.

use bothways_common::engine::simd::levels;
use bothways_common::glam::Vec3;
use bothways_common::{Camera, Frame, Object, Options, Plane, Shape, View};
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
