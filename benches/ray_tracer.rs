//! Times image order. Each bench varies one quantity: triangles, pixels, threads, the cropped portion, ties, the
//! projection, or the kind of primitives.
//!
//! A time is that of one frame of visibility, as in `rasterizer`: 1920 × 1080 pixels on one thread, into a frame and with a
//! prepared scene that are reused, unless the bench varies them. `prepare` times the construction of the hierarchy.
//! `cargo bench --bench ray_tracer` runs all benches; `BOTHWAYS_LONG=1` adds the sphere of 8 million triangles.

#[path = "support/pathological.rs"]
mod pathological_scenes;
mod support;

use bothways::common::glam::Vec3;
use bothways::common::{
    Camera, CameraDescription, Frame, Mesh, Options, Projection, Scene, Shape, Sphere, View,
};
use bothways::raytrace::fast;
use divan::Bencher;
use divan::counter::ItemsCount;
use pathological_scenes::Case;
use rayon::ThreadPool;
use support::{
    Alignment, Duplicate, FULL_HD, MILLION, Portion, camera, on_pixels, planes, scene, sphere,
    squares, thousand_spheres,
};

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

/// Times one frame of visibility.
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

/// The construction of the hierarchy, on one thread and on two. Items are triangles.
#[divan::bench(args = spheres(), consts = [1, 2])]
fn prepare<const THREADS: usize>(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let bencher = bencher.counter(ItemsCount::new(mesh.triangles().len()));
    let (pool, scene) = (pool(THREADS), scene([mesh]));
    bencher.bench_local(|| pool.install(|| fast::prepare(&scene)));
}

/// Time against triangles, at the same number of pixels, on one thread and on two. It should grow with the depth of the
/// hierarchy.
#[divan::bench(args = spheres(), consts = [1, 2])]
fn triangles<const THREADS: usize>(bencher: Bencher, divisions: &[u32; 2]) {
    let mesh = sphere(*divisions);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &scene([mesh]), &camera, THREADS, &Options::default());
}

/// Time against pixels, at the same number of triangles. It should grow at most linearly. Items are pixels.
#[divan::bench(args = [[640, 360], [1280, 720], FULL_HD, [3840, 2160]])]
fn pixels(bencher: Bencher, image: [u32; 2]) {
    let mesh = sphere([316, 159]);
    let camera = camera(&mesh, image);
    let bencher = bencher.counter(ItemsCount::new(image[0] * image[1]));
    time_visibility(bencher, &scene([mesh]), &camera, 1, &Options::default());
}

/// A hundredth of the image against the whole image. It should take at most a fiftieth of the time, plus 0.1 ms.
#[divan::bench(args = [Portion::Whole, Portion::Hundredth], consts = [1, 2])]
fn crop<const THREADS: usize>(bencher: Bencher, portion: Portion) {
    let mesh = sphere(MILLION);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &scene([mesh]), &camera, THREADS, &portion.options());
}

/// A mesh drawn twice. With ties it should take at most twice as long as without ties.
#[divan::bench(args = [Duplicate::Tied, Duplicate::Behind], consts = [100, 1000])]
fn twice<const AROUND: u32>(bencher: Bencher, duplicate: Duplicate) {
    let mesh = sphere([AROUND, AROUND / 2 + 1]);
    let camera = camera(&mesh, FULL_HD);
    time_visibility(bencher, &duplicate.with(mesh, &camera), &camera, 1, &Options::default());
}

/// A grid of squares over the whole image. With edges through samples it should take at most twice as long as with edges
/// beside samples.
#[divan::bench(args = [Alignment::Aligned, Alignment::Shifted], consts = [2, 4, 8, 32, 100])]
fn grid<const SIDE: u32>(bencher: Bencher, alignment: Alignment) {
    let scene = scene([squares(SIDE, alignment)]);
    time_visibility(bencher, &scene, &on_pixels(), 1, &Options::default());
}

/// The sphere of a million triangles in both projections, of equal size in the images.
#[divan::bench(args = [Projection::Perspective, Projection::Parallel])]
fn projections(bencher: Bencher, projection: Projection) {
    let mesh = sphere(MILLION);
    let perspective = camera(&mesh, FULL_HD);
    let description = perspective.description();
    let enlarged = match projection {
        Projection::Perspective => 1.0,
        // The centre of the sphere is the origin.
        Projection::Parallel => description.eye.length() / description.distance,
    };
    let viewport = description.viewport.map(|side| side * enlarged);
    let description = CameraDescription { projection, viewport, ..*description };
    let camera = Camera::new(description).expect("it is a camera");
    time_visibility(bencher, &scene([mesh]), &camera, 1, &Options::default());
}

/// What is not a small triangle in front of the eye.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Spheres,
    /// One sphere around the eye.
    Ball,
    Planes,
    /// One plane.
    Ground,
    /// Triangles that reach behind the eye, in a plane below it.
    Floor,
    /// Triangles that reach behind the eye, and that it sees almost edge-on.
    EdgeOn,
}

impl Kind {
    fn scene(self) -> Scene {
        match self {
            Kind::Spheres => thousand_spheres(),
            Kind::Ball => ball(),
            Kind::Planes => planes(300),
            Kind::Ground => planes(1),
            Kind::Floor => scene([strips(100, 300.0)]),
            Kind::EdgeOn => scene([strips(100, 1e-12)]),
        }
    }
}

/// A sphere around the eye of [`on_pixels`].
fn ball() -> Scene {
    let ball = Sphere { center: Vec3::new(100.0, 0.0, -500.0), radius: 900.0 };
    Scene::new(vec![Shape::Sphere(ball).into()]).expect("it is a scene")
}

/// Strips of triangles from far before the eye to far behind it, in a plane so far below it.
fn strips(count: u16, below: f32) -> Mesh {
    let corner = |k: u16| {
        let (x, z) = (100.0 * f32::from(k / 2) - 50.0 * f32::from(count), f32::from(k % 2) - 0.5);
        Vec3::new(x, -below, 20_000.0 * z)
    };
    let first = |k: u16| u32::from(2 * k);
    let triangles = (0..count).map(first).flat_map(|a| [[a, a + 1, a + 3], [a, a + 3, a + 2]]);
    Mesh::new((0..2 * count + 2).map(corner).collect(), triangles.collect()).expect("it is a mesh")
}

/// Spheres, planes, and triangles that reach behind the eye.
#[divan::bench(args = [
    Kind::Spheres, Kind::Ball, Kind::Planes, Kind::Ground, Kind::Floor, Kind::EdgeOn,
])]
fn kinds(bencher: Bencher, kind: Kind) {
    time_visibility(bencher, &kind.scene(), &on_pixels(), 1, &Options::default());
}

/// What a renderer may stumble over, and ordinary scenes of as many triangles that cover as many samples. A pair of a
/// triangle and a sample that it covers should cost at most 20 times as much. Items are these pairs.
#[divan::bench(args = Case::ALL)]
fn pathological(bencher: Bencher, case: &Case) {
    let (scene, covered) = case.scene();
    let bencher = bencher.counter(ItemsCount::new(covered));
    time_visibility(bencher, &scene, &on_pixels(), 1, &Options::default());
}
