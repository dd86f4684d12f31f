//! Object order, one thing swept at a time: triangles, pixels, threads, and how much is tied.
//!
//! What is timed is one frame of visibility, from clearing to all ids and distances in memory, into a
//! frame and a prepared scene that are reused. Everything fills 1920 × 1080 pixels on one thread,
//! unless the bench is about that. `cargo bench --bench rasterizer` runs all; `BOTHWAYS_LONG=1` adds the
//! sphere of 8 million triangles.

use bothways::common::generate::Kind;
use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{
    Camera, CameraDescription, Frame, Mesh, Options, Projection, Scene, Shape, View,
};
use bothways::rasterize::fast;
use bothways::scenes::framed;
use divan::Bencher;
use divan::counter::ItemsCount;

fn main() {
    divan::main();
}

const FULL_HD: [u32; 2] = [1920, 1080];
/// The sphere of a million triangles.
const MILLION: [u32; 2] = [1000, 501];

/// Divisions of spheres: 10 thousand, 100 thousand, 1 million and 8 million triangles.
fn spheres() -> &'static [[u32; 2]] {
    let all = &[[100, 51], [316, 159], MILLION, [2828, 1415]];
    if std::env::var_os("BOTHWAYS_LONG").is_some() { all } else { &all[..3] }
}

fn sphere(divisions: [u32; 2]) -> Mesh {
    Kind::Sphere.mesh(divisions).expect("a sphere has so many divisions")
}

/// A camera that sees all of a mesh.
fn camera(mesh: &Mesh, image: [u32; 2]) -> Camera {
    let description = framed(mesh).expect("the mesh has a size");
    let [width, height] = image.map(|side| side as f32);
    let viewport = [description.viewport[1] * width / height, description.viewport[1]];
    Camera::new(CameraDescription { viewport, image, ..description }).expect("it is a camera")
}

fn scene(meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let objects = meshes.into_iter().map(|mesh| Shape::Mesh(mesh).into());
    Scene::new(objects.collect()).expect("it is a scene")
}

/// Times one frame of visibility on so many threads.
fn time_visibility(bencher: Bencher, scene: &Scene, camera: &Camera, threads: usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let (view, options) = (View::new(scene, camera), Options::default());
    let prepared = fast::prepare(scene);
    let mut frame = Frame::new(camera, &options);
    let pool = pool.expect("there are threads");
    bencher.bench_local(|| {
        pool.install(|| {
            fast::determine_visibility(&prepared, &view, &options, &mut frame, &mut ());
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

/// What another copy of a mesh is to the first.
#[derive(Clone, Copy, Debug)]
enum Copy {
    /// In the same place: every depth test is a tie.
    Tied,
    /// Moved away from the eye by a thousandth of the diagonal: no tie.
    Behind,
}

/// A mesh drawn twice: ties cost at most twice what the same without ties costs.
#[divan::bench(args = [Copy::Tied, Copy::Behind], consts = [100, 1000])]
fn twice<const AROUND: u32>(bencher: Bencher, copy: Copy) {
    let mesh = sphere([AROUND, AROUND / 2 + 1]);
    let camera = camera(&mesh, FULL_HD);
    // The unit sphere's box has a diagonal of 2·√3.
    let away = -camera.w().as_vec3() * (2.0 * 3f32.sqrt() / 1000.0);
    let moved = match copy {
        Copy::Tied => mesh.clone(),
        Copy::Behind => mesh.clone().map(|p| p + away, |n| n).expect("it stays finite"),
    };
    time_visibility(bencher, &scene([mesh, moved]), &camera, 1);
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
