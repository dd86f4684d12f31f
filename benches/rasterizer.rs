//! Times object order. Each bench varies one quantity: triangles, pixels, threads, the cropped portion, ties, spheres,
//! planes, or how ordinary a scene is.
//!
//! A time is that of one frame of visibility: from clearing the frame until all ids and distances are in memory. The frame
//! and the prepared scene are reused. The image has 1920 × 1080 pixels and one thread draws it, unless the bench varies
//! them. `cargo bench --bench rasterizer` runs all benches; `BOTHWAYS_LONG=1` adds the sphere of 8 million triangles.

#[path = "support/pathological.rs"]
mod pathological_scenes;
mod support;

use bothways::common::glam::Vec3;
use bothways::common::{Camera, Frame, Options, Scene, Shape, Sphere, View};
use bothways::rasterize::fast;
use divan::Bencher;
use divan::counter::ItemsCount;
use pathological_scenes::Case;
use support::{
    Alignment, Duplicate, FULL_HD, MILLION, Portion, camera, on_pixels, planes, scene, sphere,
    squares, thousand_spheres,
};

fn main() {
    divan::main();
}

/// Divisions of spheres: 10 thousand, 100 thousand, 1 million and 8 million triangles.
fn divisions() -> &'static [[u32; 2]] {
    let all = &[[100, 51], [316, 159], MILLION, [2828, 1415]];
    if std::env::var_os("BOTHWAYS_LONG").is_some() { all } else { &all[..3] }
}

/// Times one frame of visibility of the whole image.
fn time_visibility(bencher: Bencher, scene: &Scene, camera: &Camera, threads: usize) {
    time_frame(bencher, scene, camera, threads, &Options::default());
}

/// Times one frame of visibility.
fn time_frame(bencher: Bencher, scene: &Scene, camera: &Camera, threads: usize, options: &Options) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let view = View::new(scene, camera);
    let prepared = fast::prepare(scene);
    let mut frame = Frame::new(camera, options);
    let pool = pool.expect("there are threads");
    bencher.bench_local(|| {
        pool.install(|| {
            fast::determine_visibility(&prepared, &view, options, &mut frame, &mut ());
        });
    });
}

/// Time against triangles, at the same number of pixels. It should grow at most linearly. Items are triangles.
#[divan::bench(args = divisions())]
fn triangles(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let camera = camera(&mesh, FULL_HD);
    let bencher = bencher.counter(ItemsCount::new(mesh.triangles().len()));
    time_visibility(bencher, &scene([mesh]), &camera, 1);
}

/// Time against pixels, at the same number of triangles. It should grow at most linearly. Items are pixels.
#[divan::bench(args = [[640, 360], [1280, 720], FULL_HD, [2560, 1440], [3840, 2160]])]
fn pixels(bencher: Bencher, image: [u32; 2]) {
    let mesh = sphere([316, 159]);
    let camera = camera(&mesh, image);
    let bencher = bencher.counter(ItemsCount::new(image[0] * image[1]));
    time_visibility(bencher, &scene([mesh]), &camera, 1);
}

/// The sphere of a million triangles on one thread and on two.
#[divan::bench(args = [1, 2])]
fn threads(bencher: Bencher, threads: usize) {
    let mesh = sphere(MILLION);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &scene([mesh]), &camera, threads);
}

/// A hundredth of the image against the whole image. Both transform every vertex and test every triangle.
#[divan::bench(args = [Portion::Whole, Portion::Hundredth])]
fn crop(bencher: Bencher, portion: Portion) {
    let mesh = sphere(MILLION);
    let camera = camera(&mesh, FULL_HD);
    time_frame(bencher, &scene([mesh]), &camera, 1, &portion.options());
}

/// A mesh drawn twice. With ties it should take at most twice as long as without ties.
#[divan::bench(args = [Duplicate::Tied, Duplicate::Behind], consts = [100, 1000])]
fn twice<const AROUND: u32>(bencher: Bencher, duplicate: Duplicate) {
    let mesh = sphere([AROUND, AROUND / 2 + 1]);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &duplicate.with(mesh, &camera), &camera, 1);
}

/// A grid of squares over the whole image. With edges through samples it should take at most twice as long as with edges
/// beside samples.
#[divan::bench(args = [Alignment::Aligned, Alignment::Shifted], consts = [2, 4, 8, 32, 100])]
fn grid<const SIDE: u32>(bencher: Bencher, alignment: Alignment) {
    let scene = scene([squares(SIDE, alignment)]);
    time_visibility(bencher, &scene, &on_pixels(), 1);
}

/// A sphere that fills the whole image, one in its middle, and a thousand.
#[divan::bench(args = [Spheres::Filling, Spheres::One, Spheres::Thousand])]
fn spheres(bencher: Bencher, spheres: Spheres) {
    time_visibility(bencher, &spheres.scene(), &on_pixels(), 1);
}

#[derive(Clone, Copy, Debug)]
enum Spheres {
    Filling,
    One,
    Thousand,
}

impl Spheres {
    fn scene(self) -> Scene {
        let sphere = |z: f32, radius: f32| {
            let center = Vec3::new(100.0, 50.0, z);
            Scene::new(vec![Shape::Sphere(Sphere { center, radius }).into()])
                .expect("it is a scene")
        };
        match self {
            Spheres::Filling => sphere(-3000.0, 2500.0),
            Spheres::One => sphere(-4000.0, 1000.0),
            Spheres::Thousand => thousand_spheres(),
        }
    }
}

/// Planes over the whole image.
#[divan::bench]
fn full_screen_planes(bencher: Bencher) {
    time_visibility(bencher, &planes(300), &on_pixels(), 1);
}

/// Scenes that are meant to hurt, each beside an ordinary one. Items are pairs of a triangle and a sample that it covers:
/// a pair should take at most 20 times as long as an ordinary one.
#[divan::bench(args = Case::ALL)]
fn pathological(bencher: Bencher, case: &Case) {
    let (scene, covered) = case.scene();
    time_visibility(bencher.counter(ItemsCount::new(covered)), &scene, &on_pixels(), 1);
}
