//! A camera that shows all of a mesh, whatever its size and place.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{CameraDescription, Mesh, Orientation};
use crate::wording::readable;

/// Why no camera frames a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrameMeshError {
    /// There is nothing to see.
    #[error("there is no triangle to frame")]
    Empty,
    /// What is to be seen has no size.
    #[error("all triangles lie in one point, so no camera can frame them")]
    Point,
    /// The eye would be where no `f32` number reaches.
    #[error(
        "the triangles reach over {}, too far for a camera that sees them all; \
         scale them down in a scene file",
        about(*.diagonal)
    )]
    TooLarge {
        /// The diagonal of their bounding box.
        diagonal: f64,
    },
    /// The triangles are so small where they lie that rounding moves the eye among them.
    #[error(
        "the triangles reach over {} only, too little for the numbers around them; \
         move them to the origin or scale them up in a scene file",
        about(*.diagonal)
    )]
    TooSmall {
        /// The diagonal of their bounding box.
        diagonal: f64,
    },
}

/// The first three digits of a length.
fn about(length: f64) -> String {
    readable::<f64>(format!("{length:.2e}").parse().expect("a number is written as a number"))
}

/// From the middle of the mesh to the eye, before it is scaled: from the right, above and in front.
const TOWARDS_EYE: DVec3 = DVec3::new(1.0, 0.7, 1.5);
/// `d`, with a viewport one high: a lens that is a little longer than the eye's, as for a portrait.
const DISTANCE: f32 = 2.2;
/// How much of the viewport's height the mesh may fill.
const FILLED: f64 = 0.92;

/// A camera that looks at the middle of the mesh from a little above and sees all of it, in any image
/// that is not higher than wide.
///
/// The mesh is what triangles use of its vertices.
///
/// # Errors
///
/// A mesh without triangles or without size, or one that leads out of the range of `f32`.
pub fn framed(mesh: &Mesh) -> Result<CameraDescription, FrameMeshError> {
    let used = mesh.triangles().iter().flatten();
    framed_positions(used.map(|&vertex| mesh.positions()[vertex as usize]))
}

/// The same camera for the positions that the mesh's triangles use, each at least once.
///
/// # Errors
///
/// As for [`framed`].
pub fn framed_positions(
    positions: impl Iterator<Item = Vec3> + Clone,
) -> Result<CameraDescription, FrameMeshError> {
    let points = positions.map(|position| position.as_dvec3());
    let (low, high) = bounds(points.clone()).ok_or(FrameMeshError::Empty)?;
    let (center, diagonal) = (0.5 * (low + high), (high - low).length());
    if diagonal == 0.0 {
        return Err(FrameMeshError::Point);
    }
    let w = TOWARDS_EYE.normalize();
    let u = DVec3::Y.cross(w).normalize();
    let v = w.cross(u);
    // A point at height h beside the axis is seen at h·d/(eye's distance − its own) on the viewport.
    let lens = 2.0 * f64::from(DISTANCE) / FILLED;
    let needed = |point: DVec3| {
        let p = point - center;
        p.dot(w) + lens * p.dot(u).abs().max(p.dot(v).abs())
    };
    let away = points.map(needed).fold(0.5 * diagonal, f64::max);
    let eye = (center + away * w).as_vec3();
    let target = center.as_vec3();
    if !eye.is_finite() {
        return Err(FrameMeshError::TooLarge { diagonal });
    }
    // Where neighbouring f32 numbers are farther apart than the mesh is wide, the eye is rounded to
    // somewhere else.
    if ((eye.as_dvec3() - center).length() / away - 1.0).abs() > 0.01 {
        return Err(FrameMeshError::TooSmall { diagonal });
    }
    Ok(CameraDescription {
        eye,
        orientation: Orientation::LookAt { target, up: Vec3::Y },
        distance: DISTANCE,
        ..CameraDescription::default()
    })
}

/// The least and the greatest coordinates.
fn bounds(points: impl Iterator<Item = DVec3>) -> Option<(DVec3, DVec3)> {
    points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::Camera;

    fn corners(corners: &[[f32; 3]]) -> Mesh {
        let positions = corners.iter().copied().map(Vec3::from_array).collect();
        Mesh::new(positions, vec![[0, 1, 2]]).unwrap()
    }

    #[test]
    fn all_of_a_mesh_is_seen_and_touches_the_margin() {
        // The last vertex belongs to no triangle.
        let mesh =
            corners(&[[2.0, 4.0, 6.5], [4.0, 4.0, 7.5], [2.0, 6.0, 7.0], [900.0, 900.0, 900.0]]);
        let camera = Camera::new(framed(&mesh).unwrap()).unwrap();
        let farthest = (0..3).map(|k| {
            let p = mesh.positions()[k].as_dvec3() - camera.eye().as_dvec3();
            let onto_viewport = camera.distance() / -p.dot(camera.w());
            (p.dot(camera.u()) * onto_viewport).abs().max((p.dot(camera.v()) * onto_viewport).abs())
        });
        assert!((farthest.fold(0.0, f64::max) - 0.46).abs() < 1e-5);
    }

    #[test]
    fn meshes_of_all_sizes_are_framed() {
        for size in [1e-36, 1e-3, 1.0, 1e6, 1e37] {
            let mesh = corners(&[[0.0, 0.0, 0.0], [size, 0.0, 0.0], [0.0, size, 0.0]]);
            Camera::new(framed(&mesh).unwrap()).unwrap();
        }
    }

    #[test]
    fn a_mesh_that_no_camera_frames_is_refused() {
        let says = |mesh: &Mesh| framed(mesh).unwrap_err().to_string();
        assert_eq!(says(&Mesh::default()), "there is no triangle to frame");
        let point = corners(&[[1.0; 3]; 3]);
        assert_eq!(says(&point), "all triangles lie in one point, so no camera can frame them");
        let large = corners(&[[-3e38, 0.0, 0.0], [3e38, 0.0, 0.0], [0.0, 3e38, 0.0]]);
        let message = "the triangles reach over 6.71e38, too far for a camera that sees them all; \
                       scale them down in a scene file";
        assert_eq!(says(&large), message);
        let small = corners(&[[1e8, 0.0, 1e8], [1e8, 0.125, 1e8], [1e8, 0.0, 1e8]]);
        let message = "the triangles reach over 0.125 only, too little for the numbers around \
                       them; move them to the origin or scale them up in a scene file";
        assert_eq!(says(&small), message);
    }
}
