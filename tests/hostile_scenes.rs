//! All four renderers on random scenes that are meant to hurt: degenerate, huge, tiny, behind the eye,
//! edge-on, coplanar, duplicate, and with coordinates of few bits, so that exact ties abound.

mod support;

use bothways::common::glam::{Quat, Vec3};
use bothways::common::{
    Camera, CameraDescription, Frame, Mesh, Object, Options, Orientation, Plane, Projection, Scene,
    Shape, Sphere, Triangle, View, Work,
};
use bothways::{rasterize, raytrace};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRng, TestRunner};
use std::cell::Cell;
use support::{RENDERERS, Ties, all_agree, assert_is_part, cases, scene, some_crops, triangle};

/// What a scene's coordinates look like.
#[derive(Clone, Copy, Debug)]
enum Numbers {
    /// Integers from −4 to 4, and samples on integers: samples on edges and vertices, coplanar faces,
    /// equal distances.
    FewBits,
    /// Anything of ordinary size.
    Ordinary,
    /// From denormal to nearly infinite, mixed.
    Extreme,
}

fn coordinate(numbers: Numbers) -> BoxedStrategy<f32> {
    match numbers {
        Numbers::FewBits => (-4..=4_i8).prop_map(f32::from).boxed(),
        Numbers::Ordinary => (-4.0..4.0_f32).boxed(),
        Numbers::Extreme => prop_oneof![
            4 => -4.0..4.0_f32,
            1 => Just(0.0_f32),
            1 => any::<f32>().prop_filter("finite", |x| x.is_finite()),
            1 => (-149..127_i32, any::<bool>())
                .prop_map(|(e, minus)| if minus { -(e as f32).exp2() } else { (e as f32).exp2() }),
        ]
        .boxed(),
    }
}

fn point(numbers: Numbers) -> impl Strategy<Value = Vec3> {
    let one = || coordinate(numbers);
    (one(), one(), one()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn shape(numbers: Numbers) -> impl Strategy<Value = Shape> {
    let corners = || (point(numbers), point(numbers), point(numbers));
    let triangle = corners().prop_map(|(a, b, c)| Shape::Triangle(Triangle { a, b, c }));
    // Repeated and collinear corners.
    let degenerate = (point(numbers), point(numbers), 0..3_u8).prop_map(|(a, b, kind)| {
        let c = [a, b, 0.5 * a + 0.5 * b][usize::from(kind)];
        Shape::Triangle(Triangle { a, b, c })
    });
    // In a plane that others share.
    let coplanar = (corners(), -6..0_i8).prop_map(|((a, b, c), z)| {
        let z = f32::from(z);
        let [a, b, c] = [a, b, c].map(|p| Vec3::new(p.x, p.y, z));
        Shape::Triangle(Triangle { a, b, c })
    });
    let needle = (point(numbers), point(numbers), 1..40_i32).prop_map(|(a, b, e)| {
        let c = b + Vec3::new(0.0, (-e as f32).exp2(), (-e as f32).exp2());
        Shape::Triangle(Triangle { a, b, c })
    });
    let ball =
        (point(numbers), coordinate(numbers)).prop_filter_map("a radius", |(center, radius)| {
            (radius != 0.0).then(|| Shape::Sphere(Sphere { center, radius: radius.abs() }))
        });
    let plane = (point(numbers), point(numbers)).prop_filter_map("a normal", |(point, normal)| {
        (normal != Vec3::ZERO).then_some(Shape::Plane(Plane { point, normal }))
    });
    let fan = proptest::collection::vec(point(numbers), 4..8).prop_map(|positions| {
        let count = u32::try_from(positions.len()).expect("they are few");
        let triangles = (1..count - 1).map(|k| [0, k, k + 1]).collect();
        Shape::Mesh(Mesh::new(positions, triangles).expect("it is a mesh"))
    });
    prop_oneof![
        4 => triangle, 1 => degenerate, 3 => coplanar, 1 => needle, 2 => ball, 1 => plane, 2 => fan
    ]
}

/// Objects, some of them again with their corners turned round.
fn objects(numbers: Numbers) -> impl Strategy<Value = Vec<Object>> {
    let doubled = (shape(numbers), 0..4_u8).prop_map(|(shape, copies)| {
        let turned = match (&shape, copies) {
            (Shape::Triangle(Triangle { a, b, c }), 1) => {
                Some(Shape::Triangle(Triangle { a: *b, b: *c, c: *a }))
            }
            (Shape::Triangle(Triangle { a, b, c }), 2) => {
                Some(Shape::Triangle(Triangle { a: *b, b: *a, c: *c }))
            }
            (_, 3) => Some(shape.clone()),
            _ => None,
        };
        std::iter::once(shape).chain(turned).map(Object::from).collect::<Vec<_>>()
    });
    proptest::collection::vec(doubled, 1..7).prop_map(|objects| objects.concat())
}

fn camera(numbers: Numbers) -> impl Strategy<Value = CameraDescription> {
    let projection = prop_oneof![Just(Projection::Perspective), Just(Projection::Parallel)];
    let straight = Just(Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z });
    let turned = (0.0..6.3_f32, -1.5..1.5_f32, -3.0..3.0_f32).prop_map(|(yaw, pitch, roll)| {
        let turn = Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch);
        let turn = turn * Quat::from_rotation_z(roll);
        Orientation::Direction { direction: turn * Vec3::NEG_Z, up: turn * Vec3::Y }
    });
    let orientation = match numbers {
        Numbers::FewBits => prop_oneof![5 => straight.boxed(), 1 => turned.boxed()].boxed(),
        Numbers::Ordinary | Numbers::Extreme => {
            prop_oneof![1 => straight.boxed(), 4 => turned.boxed()].boxed()
        }
    };
    let lens = match numbers {
        Numbers::Extreme => prop_oneof![
            3 => Just([1.0, 2.0, 1.5]),
            1 => Just([(-64f32).exp2(), (-44f32).exp2(), (-60f32).exp2()]),
            1 => Just([64f32.exp2(), (-64f32).exp2(), 64f32.exp2()]),
            1 => Just([1.0, 20f32.exp2(), 10f32.exp2()]),
            2 => (-20..20_i32, -20..20_i32, 0.5..2.0_f32).prop_map(|(d, side, factor)| {
                let side = factor * (side as f32).exp2();
                [(d as f32).exp2().max(side * (-19f32).exp2()), side, side]
            }),
        ]
        .boxed(),
        _ => {
            prop_oneof![Just([1.0, 4.0, 4.0]), Just([1.0, 8.0, 8.0]), Just([2.0, 2.0, 4.0])].boxed()
        }
    };
    let sides = match numbers {
        Numbers::FewBits => {
            prop_oneof![Just([5_u32, 5]), Just([9, 9]), Just([7, 3]), Just([1, 1])].boxed()
        }
        // Some reach over the borders of tiles.
        Numbers::Ordinary | Numbers::Extreme => prop_oneof![
            8 => (1..14_u32, 1..14_u32).prop_map(|(width, height)| [width, height]),
            1 => Just([70, 2]), 1 => Just([3, 67]), 1 => Just([140, 1])
        ]
        .boxed(),
    };
    (projection, point(numbers), orientation, lens, sides).prop_map(
        move |(projection, eye, orientation, [distance, width, height], image)| {
            let viewport = match numbers {
                // A pixel is a unit of the viewport: its centres are integers.
                Numbers::FewBits => image.map(|side| side as f32),
                Numbers::Ordinary | Numbers::Extreme => [width, height],
            };
            CameraDescription { projection, eye, orientation, distance, viewport, image }
        },
    )
}

/// Renders a part of the picture with all four.
fn check_a_crop(view: &View, options: &Options, seed: u64) {
    let crop = some_crops(view.camera.image(), seed).next();
    for (name, render) in RENDERERS {
        let part = render(view, &Options { crop, ..*options });
        assert_is_part(&render(view, options), &part, name);
    }
}

/// Runs the four renderers on random scenes and gives the shares of exact ties among the tests.
fn agree_on(numbers: Numbers, count: u32) -> (f64, f64) {
    let (edge, distance, tested) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let crops = Cell::new(0);
    let config = Config { cases: cases(count), failure_persistence: None, ..Config::default() };
    // Several samples a pixel lie between the integers of few bits.
    let samples = match numbers {
        Numbers::FewBits => prop_oneof![9 => Just(1_u32), 1 => 2..4_u32].boxed(),
        Numbers::Ordinary | Numbers::Extreme => (1..4_u32).boxed(),
    };
    let strategy = (objects(numbers), camera(numbers), samples);
    // The same scenes every time, so that a failure is found again; other ones in the long run.
    let mut runner = if cases(1) == 1 {
        let rng = TestRng::deterministic_rng(config.rng_algorithm);
        TestRunner::new_with_rng(config, rng)
    } else {
        TestRunner::new(config)
    };
    runner
        .run(&strategy, |(objects, description, samples)| {
            let scene = Scene::new(objects).expect("it is a scene");
            let camera = Camera::new(description).expect("it is a camera");
            let (view, options) =
                (View::new(&scene, &camera), Options { samples, ..Options::default() });
            all_agree(&view, &options, "a hostile scene");
            crops.set(crops.get() + 1);
            check_a_crop(&view, &options, crops.get());
            let mut ties = Ties::new(&view, samples);
            let mut frame = Frame::new(&camera, &options);
            rasterize::textbook::determine_visibility(&view, &options, &mut frame, &mut ties);
            edge.set(edge.get() + ties.edge);
            distance.set(distance.get() + ties.distance);
            tested.set(tested.get() + ties.tested);
            Ok(())
        })
        .expect("all renderers agree");
    #[expect(clippy::cast_precision_loss, reason = "shares need no more")]
    let share = |ties: u64| ties as f64 / tested.get() as f64;
    let shares = (share(edge.get()), share(distance.get()));
    println!(
        "{numbers:?}: {} tests of a primitive at a sample, {} exact edge ties ({:.2} %), \
         {} exact distance ties ({:.2} %)",
        tested.get(),
        edge.get(),
        100.0 * shares.0,
        distance.get(),
        100.0 * shares.1
    );
    shares
}

#[test]
fn scenes_of_few_bits_are_full_of_ties() {
    let (edge, distance) = agree_on(Numbers::FewBits, 3000);
    assert!(edge >= 0.01, "only {edge} of the tests are exact edge ties");
    assert!(distance >= 0.01, "only {distance} of the tests are exact distance ties");
}

#[test]
fn scenes_of_ordinary_numbers() {
    agree_on(Numbers::Ordinary, 500);
}

#[test]
fn scenes_of_extreme_numbers() {
    agree_on(Numbers::Extreme, 700);
}

#[test]
fn lanes_beyond_the_picture_are_not_judged() {
    // Error bounds that overflow: every sample of the picture is left open, and nothing beside it.
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

/// All four renderers on one scene.
fn agree_on_one(scene: &Scene, description: CameraDescription, what: &str) {
    let camera = Camera::new(description).expect("it is a camera");
    all_agree(&View::new(scene, &camera), &Options::default(), what);
}

/// Ways from a point of a sphere to its middle, of whole length.
const WAYS: [[f32; 3]; 5] =
    [[0.0, 0.0, -1.0], [1.0, 2.0, -2.0], [-2.0, 3.0, -6.0], [3.0, 0.0, -4.0], [-4.0, 4.0, -7.0]];

/// Two spheres, of up to 10⁹ and more, that nearly have a point in common or everything, and the plane that nearly
/// touches them there; before the eye, behind it, or on it.
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
    let lens = (any::<bool>(), -6..3_i8, 0.0..6.3_f32, prop_oneof![Just(0.0_f32), -1.5..1.5_f32]);
    (eye, away, shapes, lens, 1..3_u32).prop_map(
        move |(
            eye,
            away,
            (way, [radius, other], near_by, kind),
            (wide, zoom, yaw, pitch),
            samples,
        )| {
            let way = Vec3::from_array(WAYS[way]);
            let (ahead, length) = (way / way.length(), way.length());
            let point = eye + away * ahead;
            // For radii of few digits, these are exact.
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
                    // From the other side.
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
            // Towards the point, along the surface, or anywhere.
            let turn = Quat::from_rotation_y(if yaw < 3.0 { 0.0 } else { yaw })
                * Quat::from_rotation_x(pitch);
            let orientation = Orientation::Direction {
                direction: turn * ahead,
                up: turn * Vec3::new(0.25, 1.0, 0.125),
            };
            let side = f32::from(zoom).exp2();
            let projection = if wide { Projection::Perspective } else { Projection::Parallel };
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
fn spheres_that_nearly_touch_each_other_or_the_eye() {
    let config = Config { cases: cases(1500), failure_persistence: None, ..Config::default() };
    let rng = TestRng::deterministic_rng(config.rng_algorithm);
    let mut runner =
        if cases(1) == 1 { TestRunner::new_with_rng(config, rng) } else { TestRunner::new(config) };
    let (seen, all) = (Cell::new(0), Cell::new(0));
    runner
        .run(&nearly_touching(), |(objects, description, samples)| {
            let scene = Scene::new(objects).expect("it is a scene");
            // Looking along up is refused.
            let Ok(camera) = Camera::new(description) else { return Ok(()) };
            let options = Options { samples, ..Options::default() };
            let view = View::new(&scene, &camera);
            let frame = all_agree(&view, &options, "nearly touching spheres");
            seen.set(seen.get() + frame.ids().iter().filter(|id| **id != u32::MAX).count());
            all.set(all.get() + frame.ids().len());
            Ok(())
        })
        .expect("all renderers agree");
    println!("nearly touching spheres: {} of {} samples covered", seen.get(), all.get());
    assert!(4 * seen.get() > all.get(), "hardly anything is covered");
}

#[test]
fn spheres_are_not_left_to_the_judge() {
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
                assert!(
                    judged * 20 <= work.tests,
                    "{what}, {projection:?}, {order}: {judged} of {}",
                    work.tests
                );
            }
        }
    }
}
