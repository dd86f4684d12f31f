//! Object order, one thing swept at a time: triangles, pixels, threads, and how much is tied.
//!
//! What is timed is one frame of visibility, from clearing to all ids and distances in memory, into a
//! frame and a prepared scene that are reused. Everything fills 1920 × 1080 pixels on one thread,
//! unless the bench is about that. `cargo bench --bench rasterizer` runs all; `BOTHWAYS_LONG=1` adds the
//! sphere of 8 million triangles.

mod support;

use bothways::common::{Camera, Frame, Options, Scene, View};
use bothways::rasterize::fast;
use divan::Bencher;
use divan::counter::ItemsCount;
use support::{Copy, FULL_HD, Lying, MILLION, Part, camera, on_pixels, scene, sphere, squares};

fn main() {
    divan::main();
}

/// Divisions of spheres: 10 thousand, 100 thousand, 1 million and 8 million triangles.
fn spheres() -> &'static [[u32; 2]] {
    let all = &[[100, 51], [316, 159], MILLION, [2828, 1415]];
    if std::env::var_os("BOTHWAYS_LONG").is_some() { all } else { &all[..3] }
}

/// Times one frame of visibility on so many threads.
fn time_visibility(bencher: Bencher, scene: &Scene, camera: &Camera, threads: usize) {
    time_part(bencher, scene, camera, threads, &Options::default());
}

fn time_part(bencher: Bencher, scene: &Scene, camera: &Camera, threads: usize, options: &Options) {
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

/// Time against triangles at fixed pixels: no faster than linear. Items are triangles.
#[divan::bench(args = spheres())]
fn triangles(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let camera = camera(&mesh, FULL_HD);
    let bencher = bencher.counter(ItemsCount::new(mesh.triangles().len()));
    time_visibility(bencher, &scene([mesh]), &camera, 1);
}

/// Time against pixels at fixed triangles: no faster than linear. Items are pixels.
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

/// A hundredth of the picture beside the whole one: every vertex is placed and every triangle looked at for
/// both.
#[divan::bench(args = [Part::Whole, Part::Hundredth])]
fn crop(bencher: Bencher, part: Part) {
    let mesh = sphere(MILLION);
    let camera = camera(&mesh, FULL_HD);
    time_part(bencher, &scene([mesh]), &camera, 1, &part.options());
}

/// A mesh drawn twice: ties cost at most twice what the same without ties costs.
#[divan::bench(args = [Copy::Tied, Copy::Behind], consts = [100, 1000])]
fn twice<const AROUND: u32>(bencher: Bencher, copy: Copy) {
    let mesh = sphere([AROUND, AROUND / 2 + 1]);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &copy.with(mesh, &camera), &camera, 1);
}

/// A grid of squares with sides of so many pixels over the whole picture: that its edges pass through
/// samples costs at most twice what they cost beside them.
#[divan::bench(args = [Lying::Aligned, Lying::Shifted], consts = [2, 4, 8, 32, 100])]
fn grid<const SIDE: u32>(bencher: Bencher, lying: Lying) {
    let scene = scene([squares(SIDE, lying)]);
    time_visibility(bencher, &scene, &on_pixels(), 1);
}
