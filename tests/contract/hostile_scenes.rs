//! All four renderers on difficult random scenes: degenerate, huge, tiny, behind the eye, edge-on, coplanar,
//! duplicate, and with coordinates of few bits, so that exact ties are frequent.

use crate::four_renderers::{RENDERERS, all_agree};
use bothways::common::glam::{Quat, Vec3};
use bothways::common::{
    Camera, CameraDescription, Frame, Object, Options, Orientation, Plane, Projection, Scene,
    Shape, Sphere, View, Work,
};
use bothways::{rasterize, raytrace};
use bothways_test_support::hostile::{self, Numbers, point};
use bothways_test_support::{Ties, assert_is_part, scene, some_crops, triangle};
use proptest::prelude::*;
use std::cell::Cell;

/// Asserts that each renderer draws a crop as it draws that part of the whole picture.
fn check_a_crop(view: &View, options: &Options, seed: u64) {
    let crop = some_crops(view.camera.image(), seed).next();
    for (name, render) in RENDERERS {
        let part = render(view, &Options { crop, ..*options });
        assert_is_part(&render(view, options), &part, name);
    }
}

/// Asserts that the four renderers agree on random scenes; returns the shares of exact edge ties and of exact distance
/// ties among the tests of a primitive at a sample.
fn agree_on(numbers: Numbers, count: u32) -> (f64, f64) {
    let (edge, distance, tested) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let seed = Cell::new(0);
    hostile::for_each(numbers, count, |view, options| {
        all_agree(view, options, "a hostile scene");
        seed.set(seed.get() + 1);
        check_a_crop(view, options, seed.get());
        let mut ties = Ties::new(view, options.samples);
        let mut frame = Frame::new(view.camera, options);
        rasterize::textbook::determine_visibility(view, options, &mut frame, &mut ties);
        edge.set(edge.get() + ties.edge);
        distance.set(distance.get() + ties.distance);
        tested.set(tested.get() + ties.tested);
    });
    #[expect(clippy::cast_precision_loss, reason = "fractions need no more")]
    let fraction = |ties: u64| ties as f64 / tested.get() as f64;
    let fractions = (fraction(edge.get()), fraction(distance.get()));
    println!(
        "{numbers:?}: {} tests of a primitive at a sample, {} exact edge ties ({:.2} %), \
         {} exact distance ties ({:.2} %)",
        tested.get(),
        edge.get(),
        100.0 * fractions.0,
        distance.get(),
        100.0 * fractions.1
    );
    fractions
}

#[test]
fn scenes_of_few_bits_are_full_of_ties() {
    let (edge, distance) = agree_on(Numbers::FewBits, 3000);
    assert!(edge >= 0.01, "only {edge} of the tests are exact edge ties");
    assert!(distance >= 0.01, "only {distance} of the tests are exact distance ties");
}

#[test]
fn the_renderers_agree_on_ordinary_numbers() {
    agree_on(Numbers::Ordinary, 500);
}

#[test]
fn the_renderers_agree_on_extreme_numbers() {
    agree_on(Numbers::Extreme, 700);
}

#[test]
fn lanes_beyond_the_picture_are_not_judged() {
    // The error bounds overflow, so every sample of the picture is left to the judge. The lanes of SIMD beyond the
    // last column belong to no sample: they must not be left to it.
    let look = |projection, eye, direction: [f32; 3], up: [f32; 3], image| {
        let orientation = Orientation::Direction {
            direction: Vec3::from_array(direction),
            up: Vec3::from_array(up),
        };
        let (eye, viewport) = (Vec3::from_array(eye), [1.0, 1.0]);
        CameraDescription { projection, eye, orientation, viewport, image, ..Default::default() }
    };
    let far = [7e26, 7e20, 0.0];
    for width in 1..=33 {
        let description =
            look(Projection::Perspective, far, [0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [width, 5]);
        let scene = scene(vec![triangle([[0.0, 0.0, 6e-38], [8e29, 0.0, 0.0], [0.0; 3]])]);
        agree_on_one(&scene, description, &format!("{width} columns"));
    }
    let far = [-4_503_599_600_000_000.0, 0.0, -474_644_050_000_000.0];
    for width in 1..=33 {
        let description =
            look(Projection::Parallel, far, [0.4, 0.9, -0.3], [0.0, 1.0, 0.0], [width, 4]);
        let scene =
            scene(vec![triangle([[0.0, 0.0, -1.0], [0.0, 9e-39, -1.0], [-16.0, 0.0, 0.0]])]);
        agree_on_one(&scene, description, &format!("parallel, {width} columns"));
    }
}

/// Asserts that all four renderers agree on one scene.
fn agree_on_one(scene: &Scene, description: CameraDescription, what: &str) {
    let camera = Camera::new(description).expect("it is a camera");
    all_agree(&View::new(scene, &camera), &Options::default(), what);
}

/// Vectors from a point of a sphere towards its centre; their lengths are integers.
const WAYS: [[f32; 3]; 5] =
    [[0.0, 0.0, -1.0], [1.0, 2.0, -2.0], [-2.0, 3.0, -6.0], [3.0, 0.0, -4.0], [-4.0, 4.0, -7.0]];

/// Two spheres with radii of up to 2³⁰ that share one point or nearly do, or that nearly coincide; in one case of five
/// also the plane that touches them at that point. The point is in front of the eye, behind it, or the eye itself.
#[expect(clippy::too_many_lines, reason = "it is a table of numbers")]
fn nearly_touching() -> impl Strategy<Value = (Vec<Object>, CameraDescription, u32)> {
    let radius = || {
        prop_oneof![
            (0..31_i8).prop_map(|exponent| f32::from(exponent).exp2()),
            proptest::sample::select(vec![1.0_f32, 1e3, 1e6, 1e9]),
            0.5..2.0_f32,
        ]
    };
    let near = |x: f32, which: u8| match which {
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    };
    let eye = prop_oneof![Just(Vec3::ZERO), point(Numbers::FewBits), point(Numbers::Ordinary)];
    let away =
        prop_oneof![2 => Just(0.0_f32), 2 => (-2..8_i8).prop_map(f32::from), 1 => 1.0..100.0_f32];
    let shapes = (0..WAYS.len(), [radius(), radius()], [0..4_u8, 0..4_u8, 0..4_u8], 0..5_u8);
    let look = (any::<bool>(), -6..3_i8, 0.0..6.3_f32, prop_oneof![Just(0.0_f32), -1.5..1.5_f32]);
    (eye, away, shapes, look, 1..3_u32).prop_map(
        move |(
            eye,
            away,
            (way, [radius, other], near_by, kind),
            (perspective, zoom, yaw, pitch),
            samples,
        )| {
            let way = Vec3::from_array(WAYS[way]);
            let (ahead, length) = (way / way.length(), way.length());
            let point = eye + away * ahead;
            // For radii of few digits, these centres are exact.
            let ball = |radius: f32, near_by: u8| {
                let center = point + radius / length * way;
                Shape::Sphere(Sphere { center, radius: near(radius, near_by) })
            };
            let first = ball(radius, near_by[0]);
            let second = match (kind, &first) {
                (0, Shape::Sphere(Sphere { center, radius })) => Shape::Sphere(Sphere {
                    center: *center,
                    radius: near(near(*radius, near_by[1]), near_by[2]),
                }),
                (1, Shape::Sphere(Sphere { center, radius })) => {
                    let center =
                        Vec3::new(near(center.x, near_by[1]), near(center.y, near_by[2]), center.z);
                    Shape::Sphere(Sphere { center, radius: *radius })
                }
                (2, _) => {
                    // On the other side of the point.
                    Shape::Sphere(Sphere {
                        center: point - other / length * way,
                        radius: near(other, near_by[1]),
                    })
                }
                _ => ball(other, near_by[1]),
            };
            let mut shapes = vec![first, second];
            if kind == 4 {
                shapes.push(Shape::Plane(Plane { point, normal: way }));
            }
            // About a quarter of the cameras look straight at the point (or away from it), the others anywhere.
            let turn = Quat::from_rotation_y(if yaw < 3.0 { 0.0 } else { yaw })
                * Quat::from_rotation_x(pitch);
            let orientation = Orientation::Direction {
                direction: turn * ahead,
                up: turn * Vec3::new(0.25, 1.0, 0.125),
            };
            let side = f32::from(zoom).exp2();
            let projection =
                if perspective { Projection::Perspective } else { Projection::Parallel };
            let description = CameraDescription {
                projection,
                eye,
                orientation,
                distance: 1.0,
                viewport: [side; 2],
                image: [9, 7],
            };
            (shapes.into_iter().map(Object::from).collect(), description, samples)
        },
    )
}

#[test]
fn the_renderers_agree_on_spheres_that_nearly_touch_each_other_or_the_eye() {
    let (seen, all) = (Cell::new(0), Cell::new(0));
    hostile::runner(1500)
        .run(&nearly_touching(), |(objects, description, samples)| {
            let scene = Scene::new(objects).expect("it is a scene");
            // Looking along up is refused.
            let Ok(camera) = Camera::new(description) else { return Ok(()) };
            let options = Options { samples, ..Options::default() };
            let view = View::new(&scene, &camera);
            let frame = all_agree(&view, &options, "nearly touching spheres");
            seen.set(seen.get() + frame.ids().covered());
            all.set(all.get() + frame.ids().len());
            Ok(())
        })
        .expect("all renderers agree");
    println!("nearly touching spheres: {} of {} samples covered", seen.get(), all.get());
    assert!(4 * seen.get() > all.get(), "hardly anything is covered");
}

#[test]
fn at_most_one_test_of_a_sphere_in_twenty_is_left_to_the_judge() {
    let ball = |x: f32, y: f32, z: f32, radius: f32| {
        Shape::Sphere(Sphere { center: Vec3::new(x, y, z), radius })
    };
    let scenes = [
        ("the eye on a sphere", vec![ball(0.0, 0.0, -1.0, 1.0)]),
        ("the eye on another", vec![ball(3.0, 0.0, -4.0, 5.0)]),
        ("the eye nearly on a sphere", vec![ball(0.3, 0.1, -1.0, 1.048_809)]),
        (
            "nearly touching",
            vec![ball(0.0, 0.0, -1e6 - 10.0, 1e6), ball(0.0, 0.0, -1e6 - 11.0, 1e6 + 1.0)],
        ),
        ("side by side", vec![ball(-1e6, 0.0, -10.0, 1e6), ball(1e6 + 0.0625, 0.0, -10.0, 1e6)]),
        ("beside itself", vec![ball(0.0, 0.0, -1e6, 9e5), ball(0.0625, 0.0, -1e6, 9e5)]),
        ("around the eye", vec![ball(0.0, 0.0, -10.0, 1e6), ball(0.0, 0.0, -10.0, 1e6 + 0.0625)]),
        ("a planet before the eye", vec![ball(0.0, 0.0, -1e9 - 64.0, 1e9)]),
        ("a planet below the eye", vec![ball(0.0, -1e9 - 64.0, 0.0, 1e9)]),
        ("a planet that the eye is on", vec![ball(0.0, 0.0, -1e9, 1e9)]),
        ("a planet beside the eye", vec![ball(1e9, 0.0, -1.0, 1e9)]),
    ];
    for (what, shapes) in scenes {
        let scene =
            Scene::new(shapes.into_iter().map(Object::from).collect()).expect("it is a scene");
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description = CameraDescription {
                projection,
                viewport: [1.5, 1.0],
                image: [48, 32],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            let (view, options) = (View::new(&scene, &camera), Options::default());
            let (mut by_object, mut by_image) = (Work::default(), Work::default());
            let mut frame = Frame::new(&camera, &options);
            let prepared = rasterize::fast::prepare(&scene);
            rasterize::fast::determine_visibility(
                &prepared,
                &view,
                &options,
                &mut frame,
                &mut by_object,
            );
            let prepared = raytrace::fast::prepare(&scene);
            raytrace::fast::determine_visibility(
                &prepared,
                &view,
                &options,
                &mut frame,
                &mut by_image,
            );
            for (order, work) in [("object order", by_object), ("image order", by_image)] {
                let judged = work.judged_coverage + work.judged_nearest;
                assert!(work.tests > 0, "{what}, {projection:?}, {order}");
                assert!(
                    judged * 20 <= work.tests,
                    "{what}, {projection:?}, {order}: {judged} of {}",
                    work.tests
                );
            }
        }
    }
}
