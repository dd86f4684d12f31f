//! Difficult random scenes: degenerate, huge, tiny, behind the eye, edge-on, coplanar, duplicate, and with
//! coordinates of few bits, so that exact ties are frequent.

use crate::cases;
use bothways_common::glam::{Quat, Vec3};
use bothways_common::{
    Camera, CameraDescription, Mesh, Object, Options, Orientation, Plane, Projection, Scene, Shape,
    Sphere, Triangle, View,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRng, TestRunner};

/// Gives `count` random scenes to a check: the same scenes in every run, so that a failure can be repeated; many more
/// and different scenes with `BOTHWAYS_LONG` set.
pub fn for_each(numbers: Numbers, count: u32, check: impl Fn(&View, &Options)) {
    // With several samples per pixel, samples lie between the integers of few bits.
    let samples = match numbers {
        Numbers::FewBits => prop_oneof![9 => Just(1_u32), 1 => 2..4_u32].boxed(),
        Numbers::Ordinary | Numbers::Extreme => (1..4_u32).boxed(),
    };
    let strategy = (objects(numbers), camera(numbers), samples);
    runner(count)
        .run(&strategy, |(objects, description, samples)| {
            let scene = Scene::new(objects).expect("it is a scene");
            let camera = Camera::new(description).expect("it is a camera");
            check(&View::new(&scene, &camera), &Options { samples, ..Options::default() });
            Ok(())
        })
        .expect("all scenes pass");
}

/// The same cases in every run, or many more and different cases with `BOTHWAYS_LONG` set.
pub fn runner(count: u32) -> TestRunner {
    let config = Config { cases: cases(count), failure_persistence: None, ..Config::default() };
    if cases(1) == 1 {
        let rng = TestRng::deterministic_rng(config.rng_algorithm);
        TestRunner::new_with_rng(config, rng)
    } else {
        TestRunner::new(config)
    }
}

/// The kind of a scene's coordinates.
#[derive(Clone, Copy, Debug)]
pub enum Numbers {
    /// Integers from −4 to 4, and samples on integers: samples on edges and vertices, coplanar faces,
    /// equal distances.
    FewBits,
    /// Any number of ordinary size.
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

/// A point or a direction.
pub fn point(numbers: Numbers) -> impl Strategy<Value = Vec3> {
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
    // Corners in a plane that several triangles share.
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

/// Objects. Some are followed by a copy; some triangles by a copy with another first corner, or with the opposite
/// orientation.
pub fn objects(numbers: Numbers) -> impl Strategy<Value = Vec<Object>> {
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

/// A camera with numbers of this kind.
pub fn camera(numbers: Numbers) -> impl Strategy<Value = CameraDescription> {
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
        // Some crops reach over the borders of tiles.
        Numbers::Ordinary | Numbers::Extreme => prop_oneof![
            8 => (1..14_u32, 1..14_u32).prop_map(|(width, height)| [width, height]),
            1 => Just([70, 2]), 1 => Just([3, 67]), 1 => Just([140, 1])
        ]
        .boxed(),
    };
    (projection, point(numbers), orientation, lens, sides).prop_map(
        move |(projection, eye, orientation, [distance, width, height], image)| {
            let viewport = match numbers {
                // A pixel has the size of a unit of the viewport: the pixels' centres are integers.
                Numbers::FewBits => image.map(|side| side as f32),
                Numbers::Ordinary | Numbers::Extreme => [width, height],
            };
            CameraDescription { projection, eye, orientation, distance, viewport, image }
        },
    )
}
