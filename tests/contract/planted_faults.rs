//! The verdict can fail: each deliberate fault in the visibility code of one order changes the verdict to *differ*,
//! and without the fault the same picture is a *match*.

use bothways::common::engine::fault::{Planted, with};
use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Frame, Mesh, Object, Options, Orientation, Plane, Projection, Scene,
    Shape, Sphere, View,
};
use bothways::diff::compare;
use bothways::scenes::load;
use bothways::{rasterize, raytrace};
use bothways_test_faults as faults;
use bothways_test_support::{PROJECTIONS, camera, on_integers, scene, triangle, turned};

/// Whether both orders match when object order, or image order, has a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Verdicts {
    object_order: bool,
    image_order: bool,
}

const ALL_WELL: Verdicts = Verdicts { object_order: true, image_order: true };
const CAUGHT: Verdicts = Verdicts { object_order: false, image_order: false };

/// The verdicts with a fault in one order at a time; asserts that both orders match without it.
fn verdicts(scene: &Scene, camera: &Camera, fault: Option<Planted>) -> Verdicts {
    let (view, options) = (View::new(scene, camera), Options::default());
    let drawn = |determine_visibility: &dyn Fn(&mut Frame)| {
        let mut frame = Frame::new(camera, &options);
        determine_visibility(&mut frame);
        frame
    };
    let prepared = (rasterize::fast::prepare(scene), raytrace::fast::prepare(scene));
    let rasterized = |frame: &mut Frame| {
        rasterize::fast::determine_visibility(&prepared.0, &view, &options, frame, &mut ());
    };
    let traced = |frame: &mut Frame| {
        raytrace::fast::determine_visibility(&prepared.1, &view, &options, frame, &mut ());
    };
    let sound = (drawn(&rasterized), drawn(&traced));
    assert!(compare(&sound.0, &sound.1).matches(), "without a fault the orders match");
    let rasterized = |frame: &mut Frame| faults::rasterize(&prepared.0, &view, &options, frame);
    let traced = |frame: &mut Frame| faults::raytrace(&prepared.1, &view, &options, frame);
    let broken = with(fault, || (drawn(&rasterized), drawn(&traced)));
    Verdicts {
        object_order: compare(&broken.0, &sound.1).matches(),
        image_order: compare(&sound.0, &broken.1).matches(),
    }
}

/// A square from (−2, −2) to (2, 2) at z = −1, of two triangles.
fn square() -> Vec<Object> {
    let [a, b, c, d] = [[-2.0, -2.0, -1.0], [2.0, -2.0, -1.0], [2.0, 2.0, -1.0], [-2.0, 2.0, -1.0]];
    vec![triangle([a, b, c]), triangle([a, c, d])]
}

#[test]
fn a_sound_renderer_matches() {
    for projection in PROJECTIONS {
        assert_eq!(verdicts(&scene(square()), &on_integers(projection, 3), None), ALL_WELL);
    }
}

#[test]
fn a_dropped_tile_differs() {
    let camera = camera(Projection::Perspective, [0.0; 3], [2.0, 2.0], [200, 200]);
    assert_eq!(verdicts(&scene(square()), &camera, Some(Planted::DroppedTile)), CAUGHT);
}

#[test]
fn greater_for_greater_or_equal_differs() {
    for projection in PROJECTIONS {
        let verdicts = verdicts(
            &scene(square()),
            &on_integers(projection, 3),
            Some(Planted::StrictComparison),
        );
        assert_eq!(verdicts, CAUGHT, "{projection:?}");
    }
}

#[test]
fn a_box_one_ulp_too_small_differs() {
    for projection in PROJECTIONS {
        let verdicts =
            verdicts(&scene(square()), &on_integers(projection, 3), Some(Planted::ShrunkBox));
        assert_eq!(verdicts, CAUGHT, "{projection:?}");
    }
}

#[test]
fn an_error_bound_of_zero_differs() {
    // Triangles of the plane x + y + z = 0, one on the other and seen at an angle: every sample is an
    // exact tie of several, which rounding breaks either way.
    let on_plane = |[x, y]: [f32; 2]| [x, y, -x - y];
    let rug = |k: u8| {
        let k = f32::from(k);
        triangle([[-3.0 - k, 1.0], [2.0, -3.0 - k], [1.0 + k, 2.0 + k]].map(on_plane))
    };
    let scene = scene((0..12).map(rug).collect());
    for projection in PROJECTIONS {
        let camera = turned(projection, [2.3, 2.9, 4.1], [0.1, 0.2, 0.3], [64, 64]);
        assert_eq!(
            verdicts(&scene, &camera, Some(Planted::ZeroErrorBound)),
            CAUGHT,
            "{projection:?}"
        );
    }
}

/// A camera that sees the silhouette of a sphere so large that its rays differ by a few roundings: 3² + 4² = 5², so that
/// the middle ray touches the sphere.
fn magnified_silhouette(projection: Projection) -> (Scene, Camera) {
    let sphere = Sphere { center: Vec3::new(3.0, 4.0, -13.0), radius: 5.0 };
    let up = Vec3::new(0.3, 1.0, 0.0);
    let description = CameraDescription {
        projection,
        orientation: Orientation::Direction { direction: Vec3::NEG_Z, up },
        viewport: [f32::from(2_i8).powi(-49); 2],
        image: [48, 32],
        ..CameraDescription::default()
    };
    let camera = Camera::new(description).expect("it is a camera");
    (scene(vec![Shape::Sphere(sphere).into()]), camera)
}

#[test]
fn an_error_bound_of_zero_differs_at_the_silhouette_of_a_sphere() {
    for projection in PROJECTIONS {
        let (scene, camera) = magnified_silhouette(projection);
        let zero = verdicts(&scene, &camera, Some(Planted::ZeroErrorBound));
        assert_eq!(zero, CAUGHT, "{projection:?}");
        let infinite = verdicts(&scene, &camera, Some(Planted::InfiniteErrorBound));
        assert_eq!(infinite, ALL_WELL, "{projection:?}");
    }
}

#[test]
fn bounds_without_end_change_nothing() {
    // Then only the exact predicates decide: slowly, but correctly.
    for fault in [Planted::InfiniteErrorBound, Planted::InfiniteMargin] {
        for name in ["canonical", "ties", "behind", "slivers", "overlap", "inside"] {
            let built_in = load(name).expect("it is built in");
            for projection in PROJECTIONS {
                let image = [19, 35];
                let camera =
                    Camera::new(CameraDescription { projection, image, ..built_in.camera });
                let found =
                    verdicts(&built_in.scene, &camera.expect("it is a camera"), Some(fault));
                assert_eq!(found, ALL_WELL, "{fault:?}, {name}, {projection:?}");
            }
        }
    }
}

/// Planes and spheres, and triangles that reach behind the eye, some of them nearly edge-on.
fn large_and_round() -> Scene {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let plane = |point, normal| Shape::Plane(Plane { point, normal }).into();
    let sphere = |center, radius| Shape::Sphere(Sphere { center, radius }).into();
    let mut objects = vec![
        plane(at(0.0, -1.0, 0.0), Vec3::Y),
        plane(at(1.0, 0.0, -6.0), at(0.3, 0.4, 1.0)),
        plane(at(1e-9, 0.0, 0.0), Vec3::X),
        sphere(at(0.0, 0.0, -4.0), 1.0),
        sphere(at(0.0, 0.5, -4.0), 0.5),
        sphere(at(0.0, 1.0, 0.0), 1.0),
        sphere(at(2.0, 1.0, 1.0), 3.0),
    ];
    objects.extend([
        triangle([[-2.0, -0.5, -3.0], [2.0, -0.5, -3.0], [0.0, -0.25, 5.0]]),
        triangle([[-2.0, 1e-12, -3.0], [2.0, 0.0, -3.0], [0.0, 0.0, 5.0]]),
        triangle([[1.0, 2.0, -3.0], [-2.0, -4.0, 6.0], [0.5, 0.25, -1.0]]),
    ]);
    scene(objects)
}

#[test]
fn bounds_without_end_change_nothing_of_planes_and_spheres() {
    let scene = large_and_round();
    for fault in [Planted::InfiniteErrorBound, Planted::InfiniteMargin] {
        for projection in PROJECTIONS {
            let camera = turned(projection, [0.0; 3], [0.1, 0.0, -1.0], [35, 19]);
            assert_eq!(verdicts(&scene, &camera, Some(fault)), ALL_WELL, "{fault:?}");
        }
    }
}

#[test]
fn an_error_bound_of_zero_of_planes_differs_in_image_order() {
    // One plane, given by many points and normals.
    let planes = (1..9_u8).map(|k| {
        let k = f32::from(k);
        let point = Vec3::new(2.0 * k, 1.0 - k, -8.0 - k);
        Shape::Plane(Plane { point, normal: k * Vec3::ONE }).into()
    });
    let scene = scene(planes.collect());
    for projection in PROJECTIONS {
        let camera = turned(projection, [2.3, 2.9, 4.1], [0.1, 0.2, 0.3], [64, 64]);
        let verdicts = verdicts(&scene, &camera, Some(Planted::ZeroErrorBound));
        assert!(!verdicts.image_order, "{projection:?}");
    }
}

#[test]
fn an_error_bound_of_zero_of_triangles_that_are_nearly_edge_on_differs_in_image_order() {
    // Triangles of one plane, which the eye sees at a very small angle.
    let triangles = (0..12_u8).map(|k| {
        let k = f32::from(k);
        let on_plane = |x: f32, z: f32| [x, 1e-6, z];
        triangle([on_plane(-3.0 - k, -3.0), on_plane(3.0 + 0.3 * k, -9.0), on_plane(0.1 * k, 7.0)])
    });
    let scene = scene(triangles.collect());
    let camera = turned(Projection::Perspective, [0.0; 3], [0.1, 0.0, -1.0], [64, 64]);
    assert!(!verdicts(&scene, &camera, Some(Planted::ZeroErrorBound)).image_order);
}

#[test]
fn ties_to_the_last_primitive_differ() {
    let twice = scene([square(), square()].concat());
    for projection in PROJECTIONS {
        let verdicts = verdicts(&twice, &on_integers(projection, 3), Some(Planted::TiesToLast));
        assert_eq!(verdicts, CAUGHT, "{projection:?}");
    }
}

#[test]
fn a_forgotten_node_of_the_hierarchy_differs() {
    let positions: Vec<Vec3> =
        (0..81).map(|k| Vec3::new((k % 9) as f32 - 4.0, (k / 9) as f32 - 4.0, -4.0)).collect();
    let corner = |k: u32| k / 8 * 9 + k % 8;
    let cells = (0..64).map(corner).flat_map(|k| [[k, k + 1, k + 10], [k, k + 10, k + 9]]);
    let mesh = Mesh::new(positions, cells.collect()).unwrap();
    let scene = scene(vec![Shape::Mesh(mesh).into()]);
    let camera = camera(Projection::Perspective, [0.0; 3], [2.0, 2.0], [32, 32]);
    // Object order has no hierarchy.
    let expected = Verdicts { object_order: true, image_order: false };
    assert_eq!(verdicts(&scene, &camera, Some(Planted::ForgottenNode)), expected);
}
