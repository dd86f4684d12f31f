//! Spheres, planes, and triangles that reach behind the eye, in pictures of whole tiles: the vector paths that take
//! sixteen samples of one of them at a time. The textbook says what is right.

use bothways_common::engine::simd::levels;
use bothways_common::glam::Vec3;
use bothways_common::{Camera, Frame, Object, Options, Plane, Shape, Sphere, Triangle, View};
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

fn sphere(center: Vec3, radius: f32) -> Object {
    Shape::Sphere(Sphere { center, radius }).into()
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

#[test]
fn spheres_of_all_sizes_everywhere() {
    let mut dice = Dice(16);
    for (count, size) in [(1, 2.0), (30, 0.6), (100, 0.1)] {
        let spheres = (0..count).map(|_| {
            let radius = size * (0.1 + dice.next().abs());
            sphere(3.0 * dice.point() - 2.0 * Vec3::Z, radius)
        });
        let spheres: Vec<Object> = spheres.collect();
        for projection in PROJECTIONS {
            for eye in [[0.0, 0.0, 3.0], [0.1, -0.2, 0.05], [-40.0, 3.0, 20.0]] {
                let camera = turned(projection, eye, [0.02, 0.01, -2.0], [67, 35]);
                let what = format!("{count} spheres of {size}, {projection:?} from {eye:?}");
                check(&spheres, &camera, &what);
            }
        }
    }
}

#[test]
fn spheres_around_the_eye_and_through_it() {
    let mut dice = Dice(17);
    for scale in [1.0, 1e-9, 1e9] {
        let mut center = || (4.0 * dice.point()).round() * scale;
        let spheres = (0..16).map(|k| {
            let center = center();
            let distance = center.length().max(scale);
            // Through the eye as nearly as `f32` says, a last place beside it, around it, beside it.
            sphere(center, [distance, distance.next_up(), 1.5 * distance, 0.5 * distance][k % 4])
        });
        let spheres: Vec<Object> = spheres.collect();
        for projection in PROJECTIONS {
            let camera = on_integers(projection, 17);
            for one in &spheres {
                check(std::slice::from_ref(one), &camera, &format!("{one:?}, {projection:?}"));
            }
            check(&spheres, &camera, &format!("all of them, {scale}, {projection:?}"));
        }
    }
}

#[test]
fn silhouettes_through_samples() {
    // Of parallel rays on integers, circles with integer centres and radii that meet many of them; and spheres
    // that touch rays of whole length.
    let circles = [(0.0, 0.0, 5.0), (3.0, -2.0, 10.0), (-4.0, 1.0, 13.0), (0.0, 0.0, 17.0)];
    let balls: Vec<Object> =
        circles.map(|(x, y, r)| sphere(Vec3::new(x, y, -20.0), r)).into_iter().collect();
    for objects in balls.chunks(1).chain([&balls[..]]) {
        check(objects, &on_integers(bothways_common::Projection::Parallel, 18), "circles");
    }
    let mut dice = Dice(18);
    let ways = [[3.0, 4.0, -12.0], [-4.0, 6.0, -12.0], [8.0, -9.0, -12.0], [0.0, 5.0, -12.0]];
    for way in ways.map(Vec3::from_array) {
        // A vector of whole length across the ray.
        let across = Vec3::new(way.y, -way.x, 0.0) / if way.x == 0.0 { 5.0 } else { 1.0 };
        let length = f64::from(across.x).hypot(f64::from(across.y));
        let whole = if length.fract() == 0.0 { across } else { Vec3::new(12.0, 0.0, way.x) };
        let unit = f64::from(whole.length());
        for _ in 0..8 {
            let (far, out) = (dice.next().abs() * 1e6, dice.next().abs() * 1e6);
            let (far, out) = (far.round() + 1.0, out.round() + 1.0);
            #[expect(clippy::cast_possible_truncation, reason = "it has few digits")]
            let radius = (unit * f64::from(out)) as f32;
            let ball = sphere(far * way + out * whole, radius);
            let description = bothways_common::CameraDescription {
                distance: 12.0,
                viewport: [35.0; 2],
                image: [35; 2],
                ..Default::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            check(&[ball], &camera, &format!("{way}, {far}, {out}"));
        }
    }
}

#[test]
fn spheres_that_touch_and_nearly_coincide() {
    let mut dice = Dice(19);
    for scale in [1.0, 1e6] {
        let spheres = (0..10).flat_map(|k| {
            let center = scale * (3.0 * dice.point() - 5.0 * Vec3::Z);
            let radius = scale * (0.5 + dice.next().abs());
            let other = match k % 3 {
                0 => sphere(center, radius.next_up()),
                1 => sphere(center + 0.5 * radius * Vec3::X, 0.5 * radius),
                _ => sphere(center + 1e-6 * scale * dice.point(), radius),
            };
            [sphere(center, radius), other]
        });
        let mut objects: Vec<Object> = spheres.collect();
        objects.push(plane(scale * Vec3::new(0.0, -1.0, 0.0), Vec3::Y));
        for projection in PROJECTIONS {
            let description = bothways_common::CameraDescription {
                projection,
                viewport: if scale == 1.0 { [2.0, 1.0] } else { [4e6, 2e6] },
                distance: if scale == 1.0 { 1.0 } else { 1e6 },
                image: [66, 33],
                ..Default::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            check(&objects, &camera, &format!("{scale}, {projection:?}"));
        }
    }
}
