//! Instances of a mesh: all four renderers agree, and see what they see of copies.

use crate::four_renderers::{RENDERERS, all_agree};
use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Frame, Instances, Mesh, Object, Options, Placement, Scene, Shape,
    View,
};
use bothways::formats::generate::Kind;
use bothways::formats::scene_file;
use bothways::formats::source::{InputFile, Reach};
use bothways::{rasterize, raytrace};
use bothways_test_support::hostile::{self, Numbers, copied};
use bothways_test_support::{PROJECTIONS, assert_same_visibility, scene, turned};
use std::collections::BTreeSet;
use std::path::Path;

fn instances(mesh: Mesh, placements: &[[[f32; 4]; 3]]) -> Object {
    let placements = placements.iter().map(|rows| Placement::from_rows(*rows)).collect();
    Shape::Instances(Instances::new(mesh, placements).expect("they are near")).into()
}

fn diagonal([x, y, z]: [f32; 3], [a, b, c]: [f32; 3]) -> [[f32; 4]; 3] {
    [[x, 0.0, 0.0, a], [0.0, y, 0.0, b], [0.0, 0.0, z, c]]
}

fn ball() -> Mesh {
    Kind::Sphere.mesh([12, 6]).expect("a sphere has so many divisions")
}

/// All renderers agree on a scene of instances, and on its copies.
fn agree(scene: &Scene, camera: &Camera, what: &str) -> Frame {
    let options = Options::default();
    let frame = all_agree(&View::new(scene, camera), &options, what);
    let copies = copied(scene);
    let of_copies = all_agree(&View::new(&copies, camera), &options, what);
    assert_same_visibility(&of_copies, &frame, what);
    let wide = scene.clone().with_wide_ids();
    let of_wide = all_agree(&View::new(&wide, camera), &options, what);
    assert_eq!(of_wide.ids(), frame.ids(), "{what}");
    frame
}

#[test]
fn mirrored_flattened_and_vanishing_instances() {
    let all = [
        diagonal([1.0; 3], [-2.0, 1.0, -6.0]),
        diagonal([-1.0, 1.0, 1.0], [0.0, 1.0, -6.0]),
        diagonal([-1.0, -0.5, -2.0], [2.0, 1.0, -6.0]),
        // Onto a plane that is seen, onto one that is edge-on, onto a line, onto a point.
        diagonal([1.0, 1.0, 0.0], [-2.0, -1.5, -6.0]),
        diagonal([1.0, 0.0, 1.0], [0.0, 0.0, -6.0]),
        diagonal([1.0, 0.0, 0.0], [0.0, -1.5, -6.0]),
        diagonal([0.0; 3], [2.0, -1.5, -6.0]),
        [[0.5, 0.5, 0.0, 2.0], [0.5, 0.5, 0.0, -1.5], [0.0, 0.0, 1.0, -6.0]],
    ];
    let scene = scene(vec![instances(ball(), &all)]);
    for projection in PROJECTIONS {
        let camera = turned(projection, [0.1, 0.2, 0.0], [0.0, 0.0, -6.0], [61, 47]);
        let frame = agree(&scene, &camera, &format!("{projection:?}"));
        let triangles = ball().triangles().len() as u64;
        let seen = |k: u64| {
            frame
                .ids()
                .iter()
                .flatten()
                .any(|id| (k * triangles..(k + 1) * triangles).contains(&id))
        };
        assert_eq!([0, 1, 2, 3, 5, 6].map(seen), [true, true, true, true, false, false]);
    }
}

#[test]
fn an_eye_among_instances_in_front_behind_and_around_it() {
    let all = [
        diagonal([1.0; 3], [0.0, 0.0, 4.0]),
        diagonal([3.0; 3], [0.0, 0.0, 0.5]),
        diagonal([1.0; 3], [0.5, 0.0, -2.0]),
        diagonal([9.0; 3], [0.0; 3]),
        diagonal([0.25; 3], [0.0, 0.0, 0.1]),
    ];
    let scene = scene(vec![instances(ball(), &all)]);
    for projection in PROJECTIONS {
        let camera = turned(projection, [0.05, 0.1, 0.0], [0.0, 0.0, -6.0], [50, 40]);
        let frame = agree(&scene, &camera, &format!("{projection:?}"));
        // The largest is all around.
        assert!(frame.ids().iter().all(|id| id.is_some_and(|id| id < scene.primitive_count())));
    }
}

#[test]
fn of_coplanar_instances_the_first_is_seen() {
    let square = || Kind::Grid.mesh([3, 3]).expect("a grid has so many divisions");
    let at = |x: f32| diagonal([1.0; 3], [x, 0.0, -4.0]);
    let scene = scene(vec![
        instances(square(), &[at(0.0), at(0.25), at(0.0), at(-0.25)]),
        instances(square(), &[at(0.0), diagonal([-1.0, 1.0, 1.0], [0.5, 0.0, -4.0])]),
    ]);
    let triangles = u64::try_from(square().triangles().len()).unwrap();
    for projection in PROJECTIONS {
        let description = CameraDescription {
            projection,
            image: [64, 64],
            viewport: [1.0; 2],
            ..Default::default()
        };
        let frame = agree(&scene, &Camera::new(description).unwrap(), &format!("{projection:?}"));
        let of = |id: u64| id / triangles;
        let seen = |instance: u64| frame.ids().iter().flatten().any(|id| of(id) == instance);
        // What lies wholly in the same place as an earlier one is seen nowhere.
        assert_eq!([0, 2, 4].map(seen), [true, false, false]);
        assert!(frame.id(32, 32).is_some_and(|id| of(id) == 0));
    }
}

#[test]
fn objects_that_share_a_mesh_are_as_if_each_had_its_own() {
    let mesh = std::sync::Arc::new(ball());
    let at = |x: f32| {
        let by = Vec3::new(x, 0.0, -5.0);
        let one = Instances::new(mesh.clone(), vec![Placement::translation(by)]);
        Object::from(Shape::Instances(one.expect("it is near")))
    };
    let scene = scene(vec![at(-1.5), at(1.5), at(0.0)]);
    let camera = turned(PROJECTIONS[0], [0.0; 3], [0.0, 0.0, -5.0], [60, 40]);
    agree(&scene, &camera, "three objects");
}

#[test]
fn hostile_instances_look_alike_in_both_orders() {
    hostile::for_each_of(
        Numbers::Ordinary,
        hostile::instances(Numbers::Ordinary),
        60,
        |view, options| {
            let frame = all_agree(view, options, "instances");
            let wide = view.scene.clone().with_wide_ids();
            for (name, render) in RENDERERS {
                let picture = render(view, options);
                let of_wide = render(&View::new(&wide, view.camera), options);
                assert_eq!(of_wide.ids(), picture.ids(), "{name}");
                assert!(of_wide.picture() == picture.picture(), "{name}");
                let differ =
                    |(a, b): (&[u8; 3], &[u8; 3])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 2);
                let count = frame
                    .picture()
                    .iter()
                    .zip(picture.picture())
                    .filter(|pair| differ(*pair))
                    .count();
                assert_eq!(count, 0, "{name}");
            }
        },
    );
}

#[test]
fn the_crowd_is_the_same_in_both_orders_and_on_any_number_of_threads() {
    let file = InputFile::on_disk(Path::new("scenes/crowd.toml"), Reach::Folder);
    let file = scene_file::read(&file).expect("it is a scene file");
    assert!(file.scene.primitive_count() > 10_000_000);
    let camera = CameraDescription { image: [240, 135], ..file.camera };
    let camera = Camera::new(camera).expect("it is a camera");
    let (view, options) = (View::new(&file.scene, &camera), Options::default());
    let by_object =
        rasterize::fast::render(&rasterize::fast::prepare(&file.scene), &view, &options);
    let by_image = raytrace::fast::render(&raytrace::fast::prepare(&file.scene), &view, &options);
    assert_same_visibility(&by_object, &by_image, "the crowd");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let alone = pool
        .install(|| raytrace::fast::render(&raytrace::fast::prepare(&file.scene), &view, &options));
    assert_eq!(alone.ids(), by_image.ids());
    assert_eq!(alone.distances(), by_image.distances());
    assert_eq!(alone.picture(), by_image.picture());
}

/// The last numbers of 32 bits: the first scene has as many primitives as have narrow ids, the last one has one of which the
/// id is the narrow number for nothing.
#[test]
fn ids_at_the_border_of_32_bits() {
    // All triangles but the last are points.
    let mesh = |triangles: usize| {
        let corners = [[-0.4, -0.4, 0.0], [0.4, -0.3, 0.1], [0.0, 0.5, 0.0]].map(Vec3::from);
        let mut all = vec![[0; 3]; triangles];
        all[triangles - 1] = [0, 1, 2];
        Mesh::new(corners.to_vec(), all).expect("it is a mesh")
    };
    let rows = |k: u16| match k {
        0..65_532 => diagonal([0.1; 3], [f32::from(k % 256) - 128.0, f32::from(k / 256), 60.0]),
        _ => diagonal([1.0; 3], [f32::from(k - 65_532) - 1.0, 0.5, -4.0]),
    };
    for extra in [65_534, 65_535, 65_536] {
        let placements: Vec<_> = (0..u16::MAX).map(rows).collect();
        let last = mesh(extra).map(|corner| corner + Vec3::new(0.0, -0.8, -4.0), |normal| normal);
        let last = Shape::Mesh(last.expect("it is near")).into();
        let scene = scene(vec![instances(mesh(65_536), &placements), last]);
        let all = 65_536 * 65_535 + extra as u64;
        assert_eq!((scene.primitive_count(), scene.has_wide_ids()), (all, extra > 65_534));
        for projection in PROJECTIONS {
            let description = CameraDescription {
                projection,
                image: [64, 48],
                viewport: if projection == PROJECTIONS[0] { [1.2, 0.9] } else { [4.0, 3.0] },
                ..Default::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            let (view, options) = (View::new(&scene, &camera), Options::default());
            let prepared = rasterize::fast::prepare(&scene);
            let by_object = rasterize::fast::render(&prepared, &view, &options);
            let prepared = raytrace::fast::prepare(&scene);
            let by_image = raytrace::fast::render(&prepared, &view, &options);
            assert_same_visibility(&by_object, &by_image, "the border of 32 bits");
            let seen: BTreeSet<u64> = by_image.ids().iter().flatten().collect();
            let lasts = [65_533, 65_534, 65_535].map(|after: u64| 65_536 * after - 1);
            assert!(seen.iter().copied().eq(lasts.into_iter().chain([all - 1])), "{seen:?}");
        }
    }
}
