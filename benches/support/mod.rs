//! Meshes, scenes and cameras for the benches of both orders.

use bothways::common::glam::{Vec2, Vec3};
use bothways::common::{
    Camera, CameraDescription, Crop, Mesh, Options, Plane, Projection, Scene, Shape, Sphere,
};
use bothways::formats::generate::Kind;
use bothways::scenes::Framing;

pub(crate) const FULL_HD: [u32; 2] = [1920, 1080];
/// The divisions of a sphere of a million triangles.
pub(crate) const MILLION: [u32; 2] = [1000, 501];

/// A sphere with this many divisions around the axis and from pole to pole.
pub(crate) fn sphere(divisions: [u32; 2]) -> Mesh {
    Kind::Sphere.mesh(divisions).expect("a sphere has so many divisions")
}

/// A camera that sees all of a mesh.
pub(crate) fn camera(mesh: &Mesh, image: [u32; 2]) -> Camera {
    let framing = Framing { image, ..Framing::default() };
    Camera::new(framing.camera(mesh).expect("the mesh has a size")).expect("it is a camera")
}

/// A scene of meshes.
pub(crate) fn scene(meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let objects = meshes.into_iter().map(|mesh| Shape::Mesh(mesh).into());
    Scene::new(objects.collect()).expect("it is a scene")
}

/// Where a second copy of a mesh lies.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Duplicate {
    /// At the same position: every depth test is a tie.
    Tied,
    /// Farther from the eye by a thousandth of the diagonal: no depth test is a tie.
    Behind,
}

impl Duplicate {
    /// A scene of the unit sphere `mesh` and its copy.
    pub(crate) fn with(self, mesh: Mesh, camera: &Camera) -> Scene {
        // The diagonal of the box around the unit sphere is 2·√3.
        let away = -camera.w().as_vec3() * (2.0 * 3f32.sqrt() / 1000.0);
        let moved = match self {
            Duplicate::Tied => mesh.clone(),
            Duplicate::Behind => mesh.clone().map(|p| p + away, |n| n).expect("it stays finite"),
        };
        scene([mesh, moved])
    }
}

/// The portion of the image that is rendered, at full HD.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Portion {
    /// The whole image.
    Whole,
    /// A hundredth of the image, in its middle, where the mesh is.
    Hundredth,
}

impl Portion {
    /// The options that render this portion.
    pub(crate) fn options(self) -> Options {
        let middle = Crop { row: 486, column: 864, height: 108, width: 192 };
        let crop = match self {
            Portion::Whole => None,
            Portion::Hundredth => Some(middle),
        };
        Options { crop, ..Options::default() }
    }
}

/// How a grid of squares is aligned with the samples.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Alignment {
    /// Every corner is on a sample: edges and diagonals pass through samples.
    Aligned,
    /// All corners are a third of a pixel to the right of a sample and below it.
    Shifted,
}

/// A camera for which one unit in the plane z = −1000 is one pixel.
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

/// A grid of squares over the whole image. The side of a square is in pixels.
pub(crate) fn squares(side: u32, alignment: Alignment) -> Mesh {
    let shift = match alignment {
        Alignment::Aligned => Vec2::ZERO,
        Alignment::Shifted => Vec2::new(1.0 / 3.0, -1.0 / 3.0),
    };
    let [columns, rows] = FULL_HD.map(|pixels| pixels.div_ceil(side));
    let corner = |k: u32| {
        let [column, row] = [k % (columns + 1), k / (columns + 1)].map(|step| (side * step) as f32);
        // Samples are in the middle of pixels.
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

/// A thousand spheres in a box in front of the camera of [`on_pixels`], of 20 to 100 units, along a spiral that turns
/// by the golden angle.
pub(crate) fn thousand_spheres() -> Scene {
    let sphere = |k: u16| {
        let part = f32::from(k) / 1000.0;
        let (sin, cos) = (2.399_963 * f32::from(k)).sin_cos();
        let across = 500.0 * part.sqrt();
        let depth = 1000.0 + 1000.0 * (0.618_034 * f32::from(k)).fract();
        let center = Vec3::new(1.8 * across * cos, across * sin, -depth);
        let radius = 20.0 + 80.0 * (0.754_878 * f32::from(k)).fract();
        Shape::Sphere(Sphere { center, radius }).into()
    };
    Scene::new((0..1000).map(sphere).collect()).expect("it is a scene")
}

/// Planes over the image of [`on_pixels`], through points in front of the eye, with normals in all directions.
pub(crate) fn planes(count: u16) -> Scene {
    let plane = |k: u16| {
        let part = (f32::from(k) + 0.5) / f32::from(count);
        let (sin, cos) = (2.399_963 * f32::from(k)).sin_cos();
        let across = (1.0 - part * part).sqrt();
        let point = Vec3::new(0.0, 0.0, -1000.0 - 1000.0 * (0.618_034 * f32::from(k)).fract());
        let normal = Vec3::new(across * cos, across * sin, part);
        Shape::Plane(Plane { point, normal }).into()
    };
    Scene::new((0..count).map(plane).collect()).expect("it is a scene")
}
