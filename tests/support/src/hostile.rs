//! Difficult random scenes: degenerate, huge, tiny, behind the eye, edge-on, coplanar, duplicate, and with
//! coordinates of few bits, so that exact ties are frequent.

use crate::cases;
use bothways_common::glam::{Quat, Vec3};
use bothways_common::{
    Camera, CameraDescription, Instances, Mesh, Object, Options, Orientation, Placement, Plane,
    Projection, Scene, Shape, Sphere, Triangle, View,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRng, TestRunner};

/// Gives `count` random scenes to a check: the same scenes in every run, so that a failure can be repeated; many more
/// and different scenes with `BOTHWAYS_LONG` set.
pub fn for_each(numbers: Numbers, count: u32, check: impl Fn(&View, &Options)) {
    each(numbers, objects(numbers), count, check);
}

/// The same with scenes of up to four such shapes.
pub fn for_each_of(
    numbers: Numbers,
    shape: impl Strategy<Value = Shape>,
    count: u32,
    check: impl Fn(&View, &Options),
) {
    let objects = proptest::collection::vec(shape.prop_map(Object::from), 1..5);
    each(numbers, objects, count, check);
}

fn each(
    numbers: Numbers,
    objects: impl Strategy<Value = Vec<Object>>,
    count: u32,
    check: impl Fn(&View, &Options),
) {
    // With several samples per pixel, samples lie between the integers of few bits.
    let samples = match numbers {
        Numbers::FewBits => prop_oneof![9 => Just(1_u32), 1 => 2..4_u32].boxed(),
        Numbers::Ordinary | Numbers::Extreme => (1..4_u32).boxed(),
    };
    let strategy = (objects, camera(numbers), samples);
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
    let fan = fan(numbers).prop_map(Shape::Mesh);
    let any = prop_oneof![
        4 => triangle, 1 => degenerate, 3 => coplanar, 1 => needle, 2 => ball, 1 => plane, 2 => fan
    ];
    match numbers {
        // Most instances would leave the few coordinates at which these scenes tie.
        Numbers::FewBits => any.boxed(),
        Numbers::Ordinary | Numbers::Extreme => {
            prop_oneof![14 => any, 2 => instances(numbers)].boxed()
        }
    }
}

/// A mesh of some triangles about one corner.
fn fan(numbers: Numbers) -> impl Strategy<Value = Mesh> {
    proptest::collection::vec(point(numbers), 4..8).prop_map(|positions| {
        let count = u32::try_from(positions.len()).expect("they are few");
        let triangles = (1..count - 1).map(|k| [0, k, k + 1]).collect();
        Mesh::new(positions, triangles).expect("it is a mesh")
    })
}

/// Up to seven instances of a mesh.
pub fn instances(numbers: Numbers) -> impl Strategy<Value = Shape> {
    let placements = proptest::collection::vec(placement(numbers), 1..8);
    (fan(numbers), placements).prop_filter_map("in range", |(mesh, placements)| {
        Instances::new(mesh, placements).ok().map(Shape::Instances)
    })
}

/// Moved, turned by quarters and mirrored, flattened onto a plane or a line, and any map at all.
fn placement(numbers: Numbers) -> impl Strategy<Value = Placement> {
    let rows = move || {
        let row =
            || (point(numbers), coordinate(numbers)).prop_map(|(p, by)| p.extend(by).to_array());
        [row(), row(), row()]
    };
    let moved = point(numbers).prop_map(Placement::translation);
    let quarters = (0..6_usize, 0..8_u8, point(numbers)).prop_map(|(order, signs, by)| {
        const ORDERS: [[usize; 3]; 6] =
            [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        Placement::from_rows([0, 1, 2].map(|axis| {
            let mut row = [0.0, 0.0, 0.0, by[axis]];
            row[ORDERS[order][axis]] = if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
            row
        }))
    });
    let flat = (rows(), 0..3_usize, 0..3_usize).prop_map(|(mut rows, from, to)| {
        rows[to] = if from == to { [0.0, 0.0, 0.0, rows[to][3]] } else { rows[from] };
        Placement::from_rows(rows)
    });
    let any = rows().prop_map(Placement::from_rows);
    prop_oneof![1 => Just(Placement::IDENTITY), 3 => moved, 3 => quarters, 1 => flat, 3 => any]
}

/// The same scene with every instance a mesh of its own: its primitives have the same ids.
pub fn copied(scene: &Scene) -> Scene {
    let objects = scene.objects().iter().flat_map(|object| match &object.shape {
        Shape::Instances(instances) => (0..instances.placements().len())
            .map(|instance| {
                let shape = Shape::Mesh(instances.copied(instance));
                Object { shape, ..object.clone() }
            })
            .collect(),
        _ => vec![object.clone()],
    });
    let mut copied = Scene::new(objects.collect()).expect("it is a scene");
    copied.lights.clone_from(&scene.lights);
    copied.background = scene.background;
    copied
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
