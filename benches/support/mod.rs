//! What the benches of both orders draw.

use bothways::common::generate::Kind;
use bothways::common::{Camera, CameraDescription, Crop, Mesh, Options, Scene, Shape};
use bothways::scenes::framed;

pub(crate) const FULL_HD: [u32; 2] = [1920, 1080];
/// The sphere of a million triangles.
pub(crate) const MILLION: [u32; 2] = [1000, 501];

pub(crate) fn sphere(divisions: [u32; 2]) -> Mesh {
    Kind::Sphere.mesh(divisions).expect("a sphere has so many divisions")
}

/// A camera that sees all of a mesh.
pub(crate) fn camera(mesh: &Mesh, image: [u32; 2]) -> Camera {
    let description = framed(mesh).expect("the mesh has a size");
    let [width, height] = image.map(|side| side as f32);
    let viewport = [description.viewport[1] * width / height, description.viewport[1]];
    Camera::new(CameraDescription { viewport, image, ..description }).expect("it is a camera")
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
