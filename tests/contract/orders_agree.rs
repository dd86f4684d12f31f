//! One suite, four renderers: every built-in scene, both projections, sizes down to 1 × 1, and up to
//! 3 × 3 samples a pixel.

use crate::four_renderers::{RENDERERS, all_agree};
use bothways::common::{Camera, CameraDescription, Frame, Options, Orientation, Projection, View};
use bothways::diff::compare;
use bothways::scenes::{BUILT_IN, LoadedScene, load};
use bothways::{rasterize, raytrace};
use bothways_test_support::{PROJECTIONS, Ties};

const SIZES: [[u32; 2]; 6] = [[1, 1], [2, 1], [1, 3], [8, 8], [17, 13], [32, 20]];

/// The scene's camera with another projection and size. A parallel camera's viewport is as large as
/// what the perspective one sees around its target.
fn camera(scene: &LoadedScene, projection: Projection, image: [u32; 2]) -> Camera {
    let was = scene.camera;
    let depth = match was.orientation {
        Orientation::LookAt { target, .. } => was.eye.distance(target),
        Orientation::Direction { .. } | Orientation::Frame { .. } => 4.0,
    };
    let grow = match (was.projection, projection) {
        (Projection::Perspective, Projection::Parallel) => depth / was.distance,
        (Projection::Parallel, Projection::Perspective) => was.distance / depth,
        _ => 1.0,
    };
    let viewport = was.viewport.map(|side| side * grow);
    Camera::new(CameraDescription { projection, viewport, image, ..was }).expect("it is a camera")
}

/// Asserts that all four renderers agree, and that the fast pair also agrees in colour.
fn check(scene: &LoadedScene, projection: Projection, image: [u32; 2], samples: u32) {
    let camera = camera(scene, projection, image);
    let (view, options) =
        (View::new(&scene.scene, &camera), Options { samples, ..Options::default() });
    let what = format!("{} {projection:?} {image:?} x {samples}", scene.name);
    all_agree(&view, &options, &what);
    check_looks(&view, &options, &what);
}

/// Asserts that the fast pair agrees: in coverage and ids exactly, in depth and colour within the tolerances of `diff`.
/// Returns the frame of object order.
fn check_looks(view: &View, options: &Options, what: &str) -> Frame {
    let [_, _, (_, object_order), (_, image_order)] = RENDERERS;
    let (object_order, image_order) = (object_order(view, options), image_order(view, options));
    let comparison = compare(&object_order, &image_order);
    assert!(comparison.matches(), "{what}: {}", comparison.verdict());
    assert_eq!(comparison.depth.differing_pixels, 0, "{what}: depth");
    assert_eq!(comparison.color.differing_pixels, 0, "{what}: colour");
    object_order
}

#[test]
fn the_smaller_built_in_scenes_agree() {
    for built_in in BUILT_IN.iter().filter(|scene| scene.name != "many" && scene.name != "lecture")
    {
        let scene = load(built_in.name).expect("it is built in");
        // The textbook tests every primitive at every sample: less of both for large scenes.
        let sizes = if scene.scene.primitive_count() > 500 { &SIZES[..4] } else { &SIZES[..] };
        for (&image, projection) in sizes.iter().flat_map(|size| PROJECTIONS.map(|p| (size, p))) {
            for samples in 1..=3 {
                check(&scene, projection, image, samples);
            }
        }
    }
}

#[test]
fn the_large_built_in_scenes_agree_at_small_sizes() {
    for name in ["many", "lecture"] {
        let scene = load(name).expect("it is built in");
        for projection in PROJECTIONS {
            // The textbook pair on a few samples, the fast pair on all.
            for (image, samples) in [([1, 1], 1), ([1, 1], 3), ([5, 4], 1), ([3, 2], 2)] {
                check(&scene, projection, image, samples);
            }
            for (image, samples) in SIZES.iter().flat_map(|size| (1..=3).map(move |n| (size, n))) {
                let camera = camera(&scene, projection, *image);
                let what = format!("{name} {projection:?} {image:?} x {samples}");
                check_looks(
                    &View::new(&scene.scene, &camera),
                    &Options { samples, ..Options::default() },
                    &what,
                );
            }
        }
    }
}

#[test]
fn the_fast_pair_agrees_at_full_size() {
    for built_in in BUILT_IN {
        let scene = load(built_in.name).expect("it is built in");
        for projection in PROJECTIONS {
            let camera = camera(&scene, projection, scene.camera.image);
            let what = format!("{} {projection:?} at full size", scene.name);
            check_looks(&View::new(&scene.scene, &camera), &Options::default(), &what);
        }
    }
}

#[test]
fn the_scene_inside_covers_every_sample() {
    let scene = load("inside").expect("it is built in");
    for image in [[64, 48], [33, 77]] {
        let camera = camera(&scene, Projection::Perspective, image);
        let view = View::new(&scene.scene, &camera);
        let frame = check_looks(&view, &Options { samples: 2, ..Options::default() }, "inside");
        assert!(
            frame.ids().iter().all(|id| id.is_some_and(|id| id < scene.scene.primitive_count()))
        );
    }
}

#[test]
fn the_scene_of_ties_is_full_of_them() {
    let scene = load("ties").expect("it is built in");
    for projection in PROJECTIONS {
        let camera = camera(&scene, projection, scene.camera.image);
        let (view, options) = (View::new(&scene.scene, &camera), Options::default());
        let mut ties = Ties::new(&view, 1);
        let mut frame = Frame::new(&camera, &options);
        let prepared = rasterize::fast::prepare(&scene.scene);
        rasterize::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ties);
        let samples = u64::try_from(frame.ids().len()).expect("they are few");
        println!("ties, {projection:?}: {} exact edge ties at {samples} samples", ties.edge);
        assert!(ties.edge > samples / 3, "{} ties at {samples} samples", ties.edge);
    }
}

#[test]
fn one_prepared_scene_serves_several_cameras() {
    let scene = load("many").expect("it is built in");
    let prepared = (rasterize::fast::prepare(&scene.scene), raytrace::fast::prepare(&scene.scene));
    for (projection, image) in PROJECTIONS.into_iter().zip([[97, 61], [40, 80]]) {
        let camera = camera(&scene, projection, image);
        let (view, options) = (View::new(&scene.scene, &camera), Options::default());
        let object_order = rasterize::fast::render(&prepared.0, &view, &options);
        let image_order = raytrace::fast::render(&prepared.1, &view, &options);
        assert_eq!(object_order.ids(), image_order.ids());
    }
}
