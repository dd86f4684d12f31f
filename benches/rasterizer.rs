//! Object order, one thing swept at a time: triangles, pixels, threads, and how much is tied.
//!
//! What is timed is one frame of visibility, from clearing to all ids and distances in memory, into a
//! frame and a prepared scene that are reused. Everything fills 1920 × 1080 pixels on one thread,
//! unless the bench is about that. `cargo bench --bench rasterizer` runs all; `BOTHWAYS_LONG=1` adds the
//! sphere of 8 million triangles.

mod support;

use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{Camera, CameraDescription, Frame, Mesh, Options, Projection, Scene, View};
use bothways::rasterize::fast;
use divan::Bencher;
use divan::counter::ItemsCount;
use support::{Copy, FULL_HD, MILLION, Part, camera, scene, sphere};

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

/// How a grid of squares lies on the samples.
#[derive(Clone, Copy, Debug)]
enum Lying {
    /// Every corner on a sample, so that edges and diagonals pass through samples.
    Aligned,
    /// The same, moved by a third of a pixel to the right and down.
    Shifted,
}

/// A grid of squares with sides of so many pixels over the whole picture: that its edges pass through
/// samples costs at most twice what they cost beside them.
#[divan::bench(args = [Lying::Aligned, Lying::Shifted], consts = [2, 4, 8, 32, 100])]
fn grid<const SIDE: u32>(bencher: Bencher, lying: Lying) {
    let shift = match lying {
        Lying::Aligned => Vec2::ZERO,
        Lying::Shifted => Vec2::new(1.0 / 3.0, -1.0 / 3.0),
    };
    let scene = scene([squares(SIDE, shift)]);
    time_visibility(bencher, &scene, &on_pixels(), 1);
}

/// A camera before which one unit of the plane z = −1000 is one pixel.
fn on_pixels() -> Camera {
    let description = CameraDescription {
        projection: Projection::Perspective,
        distance: 1000.0,
        viewport: FULL_HD.map(|side| side as f32),
        image: FULL_HD,
        ..CameraDescription::default()
    };
    Camera::new(description).expect("it is a camera")
}

/// Squares over the whole picture, their corners on samples before they are shifted.
fn squares(side: u32, shift: Vec2) -> Mesh {
    let [columns, rows] = FULL_HD.map(|pixels| pixels.div_ceil(side));
    let corner = |k: u32| {
        let [column, row] = [k % (columns + 1), k / (columns + 1)].map(|step| (side * step) as f32);
        // Samples lie in the middle of pixels.
        let (x, y) = (column - 959.5 + shift.x, 539.5 - row + shift.y);
        Vec3::new(x, y, -1000.0)
    };
    let square = |k: u32| {
        let a = k / columns * (columns + 1) + k % columns;
        let [b, c, d] = [a + columns + 1, a + columns + 2, a + 1];
        [[a, b, c], [a, c, d]]
    };
    let positions = (0..(columns + 1) * (rows + 1)).map(corner).collect();
    Mesh::new(positions, (0..columns * rows).flat_map(square).collect()).expect("it is a mesh")
}
