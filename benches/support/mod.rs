//! What the benches of both orders draw.

use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{Camera, CameraDescription, Crop, Mesh, Options, Projection, Scene, Shape};
use bothways::formats::generate::Kind;
use bothways::scenes::Framing;

pub(crate) const FULL_HD: [u32; 2] = [1920, 1080];
/// The sphere of a million triangles.
pub(crate) const MILLION: [u32; 2] = [1000, 501];

pub(crate) fn sphere(divisions: [u32; 2]) -> Mesh {
    Kind::Sphere.mesh(divisions).expect("a sphere has so many divisions")
}

/// A camera that sees all of a mesh.
pub(crate) fn camera(mesh: &Mesh, image: [u32; 2]) -> Camera {
    let framing = Framing { image, ..Framing::default() };
    Camera::new(framing.camera(mesh).expect("the mesh has a size")).expect("it is a camera")
}

pub(crate) fn scene(meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let objects = meshes.into_iter().map(|mesh| Shape::Mesh(mesh).into());
    Scene::new(objects.collect()).expect("it is a scene")
}

/// What another copy of a mesh is to the first.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Copy {
    /// In the same place: every depth test is a tie.
    Tied,
    /// Moved away from the eye by a thousandth of the diagonal: no tie.
    Behind,
}

impl Copy {
    /// Two copies of a sphere.
    pub(crate) fn with(self, mesh: Mesh, camera: &Camera) -> Scene {
        // The unit sphere's box has a diagonal of 2·√3.
        let away = -camera.w().as_vec3() * (2.0 * 3f32.sqrt() / 1000.0);
        let moved = match self {
            Copy::Tied => mesh.clone(),
            Copy::Behind => mesh.clone().map(|p| p + away, |n| n).expect("it stays finite"),
        };
        scene([mesh, moved])
    }
}

/// How much of the full HD picture is rendered.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    /// The frame.
    Whole,
    /// The hundredth in its middle, where the mesh is.
    Hundredth,
}

impl Part {
    pub(crate) fn options(self) -> Options {
        let middle = Crop { row: 486, column: 864, height: 108, width: 192 };
        let crop = match self {
            Part::Whole => None,
            Part::Hundredth => Some(middle),
        };
        Options { crop, ..Options::default() }
    }
}

/// How a grid of squares lies on the samples.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Lying {
    /// Every corner on a sample, so that edges and diagonals pass through samples.
    Aligned,
    /// The same, moved by a third of a pixel to the right and down.
    Shifted,
}

/// A camera before which one unit of the plane z = −1000 is one pixel.
pub(crate) fn on_pixels() -> Camera {
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
pub(crate) fn squares(side: u32, lying: Lying) -> Mesh {
    let shift = match lying {
        Lying::Aligned => Vec2::ZERO,
        Lying::Shifted => Vec2::new(1.0 / 3.0, -1.0 / 3.0),
    };
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
