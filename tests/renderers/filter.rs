//! The fast arithmetic makes nearly all decisions: the exact judge makes very few.

use bothways::common::glam::Vec3;
use bothways::common::{Camera, CameraDescription, Frame, Options, Orientation, Scene, View, Work};
use bothways::formats::obj;
use bothways::{rasterize, raytrace, scenes};
use std::path::Path;

/// The bunny of `../shared`, if the file exists.
fn bunny() -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/meshes/stanford-bunny.obj");
    if !path.exists() {
        println!("skipped: ../shared/meshes/stanford-bunny.obj is absent");
        return None;
    }
    let bunny = obj::read(&path).expect("it is an OBJ file");
    Some(bothways_test_support::scene(vec![bothways_test_support::mesh(bunny)]))
}

/// Views from six sides, near and far.
fn views() -> impl Iterator<Item = Camera> {
    let sides = [[1.0, 0.7, 1.5], [-1.0, 0.2, 0.3], [0.1, 3.0, 0.2], [0.0, 0.0, 1.0]];
    let more = [[-0.6, 0.1, -0.4], [0.3, -2.0, 0.4]];
    sides.into_iter().chain(more).zip([1.0, 0.6, 0.3, 0.5, 0.25, 1.0]).map(|(side, distance)| {
        let target = Vec3::new(-0.017, 0.11, 0.0);
        let eye = target + distance * Vec3::from_array(side).normalize() * 0.4;
        let description = CameraDescription {
            eye,
            orientation: Orientation::LookAt { target, up: Vec3::Z + Vec3::Y },
            distance: 2.2,
            viewport: [16.0 / 9.0, 1.0],
            image: [1920, 1080],
            ..CameraDescription::default()
        };
        Camera::new(description).expect("it is a camera")
    })
}

/// Renders with both orders, and counts the decisions of the judge in each order.
fn assert_the_judge_is_seldom_asked(scene: &Scene, camera: &Camera) {
    let prepared = (rasterize::fast::prepare(scene), raytrace::fast::prepare(scene));
    let (view, options) = (View::new(scene, camera), Options::default());
    let mut frames = [(); 2].map(|()| Frame::new(camera, &options));
    let mut works = [Work::default(); 2];
    let [object, image] = &mut frames;
    let [object_work, image_work] = &mut works;
    rasterize::fast::determine_visibility(&prepared.0, &view, &options, object, object_work);
    raytrace::fast::determine_visibility(&prepared.1, &view, &options, image, image_work);
    assert_eq!(frames[0].ids(), frames[1].ids());
    for (order, work) in ["object order", "image order"].into_iter().zip(works) {
        let decisions = work.tests + work.depth_tests;
        let asked = work.judged_coverage + work.judged_nearest;
        println!("{order}: {asked} of {decisions} decisions asked the judge");
        assert!(work.fragments > 100_000, "the mesh fills a part of the picture");
        assert!(1000 * asked < decisions, "{order}: {work:?}");
    }
}

#[test]
fn on_the_bunny_fewer_than_one_decision_in_a_thousand_asks_the_judge() {
    let Some(scene) = bunny() else { return };
    for camera in views() {
        assert_the_judge_is_seldom_asked(&scene, &camera);
    }
}

#[test]
fn on_a_built_in_scene_fewer_than_one_decision_in_a_thousand_asks_the_judge() {
    let many = scenes::load("many").expect("it is built in");
    let camera = Camera::new(many.camera).expect("it is a camera");
    assert_the_judge_is_seldom_asked(&many.scene, &camera);
}
