//! Functions that make cameras from few numbers.

use bothways_common::glam::Vec3;
use bothways_common::{Camera, CameraDescription, Orientation, Projection};

/// Both projections.
pub const PROJECTIONS: [Projection; 2] = [Projection::Perspective, Projection::Parallel];

/// A camera at `eye` that looks down the negative z axis, up along y, at a distance of 1 from its viewport.
pub fn camera(
    projection: Projection,
    eye: [f32; 3],
    viewport: [f32; 2],
    image: [u32; 2],
) -> Camera {
    let eye = Vec3::from_array(eye);
    let description =
        CameraDescription { projection, eye, viewport, image, ..CameraDescription::default() };
    Camera::new(description).expect("it is a camera")
}

/// A camera at `eye` that looks at `target`, with y up. The viewport's sides are 1.5 at a distance of 1 in perspective,
/// and 6 for parallel rays.
pub fn turned(projection: Projection, eye: [f32; 3], target: [f32; 3], image: [u32; 2]) -> Camera {
    let orientation = Orientation::LookAt { target: Vec3::from_array(target), up: Vec3::Y };
    let eye = Vec3::from_array(eye);
    let viewport = match projection {
        Projection::Perspective => [1.5, 1.5],
        Projection::Parallel => [6.0, 6.0],
    };
    let description = CameraDescription {
        projection,
        eye,
        orientation,
        viewport,
        image,
        ..CameraDescription::default()
    };
    Camera::new(description).expect("it is a camera")
}

/// A camera with samples at the integer points from −`half` to `half`, one unit apart.
pub fn on_integers(projection: Projection, half: u32) -> Camera {
    let side = 2 * half + 1;
    camera(projection, [0.0; 3], [side as f32; 2], [side; 2])
}
