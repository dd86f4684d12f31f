//! Times both orders on one scene: the preparation, and a frame.
//!
//! `prepare` is the work on the scene alone. `visibility` is one frame of 1920 × 1080 pixels with one sample each: from
//! clearing the frame until all ids and distances are in memory. The frame is reused; nothing else is kept from one frame
//! to the next. Both run on rayon's pool of all processors.
//!
//! `cargo bench` runs them. The bunny needs `../shared/meshes`, and is left out without it.

use bothways::common::{Camera, CameraDescription, Frame, Options, View};
use bothways::scenes::{LoadedScene, load};
use bothways::{rasterize, raytrace};
use divan::Bencher;
use std::path::Path;

fn main() {
    divan::main();
}

const BUNNY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/meshes/stanford-bunny.obj");

/// The built-in scene `many`, and the bunny if its file exists.
fn scenes() -> &'static [&'static str] {
    let all = &["many", "bunny"];
    if Path::new(BUNNY).exists() { all } else { &all[..1] }
}

/// A scene, and its camera at full HD.
fn scene(name: &str) -> (LoadedScene, Camera) {
    let scene = load(if name == "bunny" { BUNNY } else { name }).expect("the scene is there");
    let description = CameraDescription {
        viewport: [scene.camera.viewport[1] * 1920.0 / 1080.0, scene.camera.viewport[1]],
        image: [1920, 1080],
        ..scene.camera
    };
    let camera = Camera::new(description).expect("it is a camera");
    (scene, camera)
}

#[divan::bench(args = scenes())]
fn prepare_object_order(bencher: Bencher, name: &str) {
    let (LoadedScene { scene, .. }, _) = scene(name);
    bencher.bench_local(|| rasterize::fast::prepare(&scene));
}

#[divan::bench(args = scenes())]
fn prepare_image_order(bencher: Bencher, name: &str) {
    let (LoadedScene { scene, .. }, _) = scene(name);
    bencher.bench_local(|| raytrace::fast::prepare(&scene));
}

#[divan::bench(args = scenes())]
fn visibility_object_order(bencher: Bencher, name: &str) {
    let (LoadedScene { scene, .. }, camera) = scene(name);
    let (view, options) = (View::new(&scene, &camera), Options::default());
    let prepared = rasterize::fast::prepare(&scene);
    let mut frame = Frame::new(&camera, &options);
    bencher.bench_local(|| {
        rasterize::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
    });
}

#[divan::bench(args = scenes())]
fn visibility_image_order(bencher: Bencher, name: &str) {
    let (LoadedScene { scene, .. }, camera) = scene(name);
    let (view, options) = (View::new(&scene, &camera), Options::default());
    let prepared = raytrace::fast::prepare(&scene);
    let mut frame = Frame::new(&camera, &options);
    bencher.bench_local(|| {
        raytrace::fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
    });
}
