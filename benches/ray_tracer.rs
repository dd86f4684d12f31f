//! Image order, one thing swept at a time: triangles, pixels, threads, how much is tied, and how much of the
//! picture is asked for.
//!
//! As in `rasterizer`, what is timed is one frame of visibility at 1920 × 1080 pixels on one thread, into a
//! frame and a prepared scene that are reused, unless the bench says otherwise; `prepare` times the building
//! of the hierarchy. `cargo bench --bench ray_tracer` runs all; `BOTHWAYS_LONG=1` adds the sphere of 8 million
//! triangles.

mod support;

use bothways::common::{Camera, CameraDescription, Frame, Options, Projection, Scene, View};
use bothways::raytrace::fast;
use divan::Bencher;
use divan::counter::ItemsCount;
use rayon::ThreadPool;
use support::{Copy, FULL_HD, Lying, MILLION, Part, camera, on_pixels, scene, sphere, squares};

fn main() {
    divan::main();
}

/// Divisions of spheres: 10 thousand, 1 million and 8 million triangles.
fn spheres() -> &'static [[u32; 2]] {
    let all = &[[100, 51], MILLION, [2828, 1415]];
    if std::env::var_os("BOTHWAYS_LONG").is_some() { all } else { &all[..2] }
}

fn pool(threads: usize) -> ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("there are threads")
}

/// Times one frame of visibility on so many threads.
fn time_visibility(
    bencher: Bencher,
    scene: &Scene,
    camera: &Camera,
    threads: usize,
    options: &Options,
) {
    let (pool, view) = (pool(threads), View::new(scene, camera));
    let prepared = fast::prepare(scene);
    let mut frame = Frame::new(camera, options);
    bencher.bench_local(|| {
        pool.install(|| {
            fast::determine_visibility(&prepared, &view, options, &mut frame, &mut ());
        });
    });
}

/// Building the hierarchy, on one thread and on two. Items are triangles.
#[divan::bench(args = spheres(), consts = [1, 2])]
fn prepare<const THREADS: usize>(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let bencher = bencher.counter(ItemsCount::new(mesh.triangles().len()));
    let (pool, scene) = (pool(THREADS), scene([mesh]));
    bencher.bench_local(|| pool.install(|| fast::prepare(&scene)));
}

/// Time against triangles at fixed pixels, on one thread and on two: it grows with the hierarchy's depth.
#[divan::bench(args = spheres(), consts = [1, 2])]
fn triangles<const THREADS: usize>(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &scene([mesh]), &camera, THREADS, &Options::default());
}

/// Time against pixels at fixed triangles: no faster than linear. Items are pixels.
#[divan::bench(args = [[640, 360], [1280, 720], FULL_HD, [3840, 2160]])]
fn pixels(bencher: Bencher, image: [u32; 2]) {
    let mesh = sphere([316, 159]);
    let camera = camera(&mesh, image);
    let bencher = bencher.counter(ItemsCount::new(image[0] * image[1]));
    time_visibility(bencher, &scene([mesh]), &camera, 1, &Options::default());
}

/// A hundredth of the picture beside the whole one: at most a fiftieth of its time, and 0.1 ms.
#[divan::bench(args = [Part::Whole, Part::Hundredth], consts = [1, 2])]
fn crop<const THREADS: usize>(bencher: Bencher, part: Part) {
    let mesh = sphere(MILLION);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &scene([mesh]), &camera, THREADS, &part.options());
}

/// A mesh drawn twice: ties cost at most twice what the same without ties costs.
#[divan::bench(args = [Copy::Tied, Copy::Behind], consts = [100, 1000])]
fn twice<const AROUND: u32>(bencher: Bencher, copy: Copy) {
    let mesh = sphere([AROUND, AROUND / 2 + 1]);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &copy.with(mesh, &camera), &camera, 1, &Options::default());
}

/// A grid of squares with sides of so many pixels over the whole picture: that its edges pass through
/// samples costs at most twice what they cost beside them.
#[divan::bench(args = [Lying::Aligned, Lying::Shifted], consts = [2, 4, 8, 32, 100])]
fn grid<const SIDE: u32>(bencher: Bencher, lying: Lying) {
    let scene = scene([squares(SIDE, lying)]);
    time_visibility(bencher, &scene, &on_pixels(), 1, &Options::default());
}

/// The sphere of a million triangles by either camera, as large in both pictures.
#[divan::bench(args = [Projection::Perspective, Projection::Parallel])]
fn projections(bencher: Bencher, projection: Projection) {
    let mesh = sphere(MILLION);
    let perspective = camera(&mesh, FULL_HD);
    let description = perspective.description();
    let enlarged = match projection {
        Projection::Perspective => 1.0,
        // The sphere's middle is the origin.
        Projection::Parallel => description.eye.length() / description.distance,
    };
    let viewport = description.viewport.map(|side| side * enlarged);
    let description = CameraDescription { projection, viewport, ..*description };
    let camera = Camera::new(description).expect("it is a camera");
    time_visibility(bencher, &scene([mesh]), &camera, 1, &Options::default());
}
