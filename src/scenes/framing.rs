//! A camera that shows all of a mesh, whatever its size and place.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{CameraDescription, Mesh, Orientation};

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
        "the triangles reach over {diagonal:.2e}, too far for a camera that sees them all; \
         scale them down in a scene file"
    )]
    TooLarge {
        /// The diagonal of their bounding box.
        diagonal: f64,
    },
    /// The triangles are so small where they lie that the eye would be among them.
    #[error(
        "the triangles reach over {diagonal:.2e} only, too little for the numbers around them; move \
         them to the origin or scale them up in a scene file"
    )]
    TooSmall {
        /// The diagonal of their bounding box.
        diagonal: f64,
    },
}

/// From the middle of the mesh to the eye, before it is scaled: from the right, above and in front.
const TOWARDS_EYE: DVec3 = DVec3::new(1.0, 0.7, 1.5);
/// From the middle of the mesh to the eye, in diagonals of its bounding box.
const EYE_DISTANCE: f64 = 1.6;

/// A camera that looks at the middle of the mesh from a little above, and sees about all of it.
///
/// The mesh is what triangles use of its vertices. The numbers are those of the programs that
/// `bothways` is measured against, so that all see one picture; they suit models that are rounder
/// than their bounding box, and a box itself loses its outermost corners.
///
/// # Errors
///
/// A mesh without triangles or without size, or one that leads out of the range of `f32`.
pub fn framed(mesh: &Mesh) -> Result<CameraDescription, FrameMeshError> {
    let (low, high) = bounds(mesh).ok_or(FrameMeshError::Empty)?;
    let (center, diagonal) = (0.5 * (low + high), (high - low).length());
    if diagonal == 0.0 {
        return Err(FrameMeshError::Point);
    }
    let eye = (center + EYE_DISTANCE * diagonal * TOWARDS_EYE.normalize()).as_vec3();
    let target = center.as_vec3();
    if !eye.is_finite() {
        return Err(FrameMeshError::TooLarge { diagonal });
    }
    // Rounding may put the eye anywhere once neighbouring f32 numbers are about as far apart.
    if !(1.0..2.0 * EYE_DISTANCE).contains(&((eye.as_dvec3() - center).length() / diagonal)) {
        return Err(FrameMeshError::TooSmall { diagonal });
    }
    Ok(CameraDescription {
        eye,
        orientation: Orientation::LookAt { target, up: Vec3::Y },
        distance: 2.2,
        ..CameraDescription::default()
    })
}

/// The least and the greatest coordinates of what triangles use.
fn bounds(mesh: &Mesh) -> Option<(DVec3, DVec3)> {
    let used = mesh.triangles().iter().flatten();
    let points = used.map(|&vertex| mesh.positions()[vertex as usize]);
    let boxes = points.map(|point| (point, point));
    let (low, high) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some((low.as_dvec3(), high.as_dvec3()))
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
    fn the_camera_is_that_of_the_programs_we_measure_against() {
        // The box of the triangle's vertices, without the one that no triangle uses: centre
        // (3, 5, 7), sides 2, 2 and 1, so the diagonal is 3 and the eye 4.8 from the centre.
        let mesh =
            corners(&[[2.0, 4.0, 6.5], [4.0, 4.0, 7.5], [2.0, 6.0, 7.0], [900.0, 900.0, 900.0]]);
        let camera = Camera::new(framed(&mesh).unwrap()).unwrap();
        let w = DVec3::new(1.0, 0.7, 1.5).normalize();
        let u = DVec3::Y.cross(w).normalize();
        assert_eq!(camera.eye(), (DVec3::new(3.0, 5.0, 7.0) + 4.8 * w).as_vec3());
        assert!((camera.w() - w).length() < 1e-6 && (camera.u() - u).length() < 1e-6);
        assert_eq!((camera.distance(), camera.viewport()[1]), (f64::from(2.2f32), 1.0));
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
        let far = 16_777_216.0;
        let small = corners(&[[far, far, far], [far + 2.0, far, far], [far, far, far]]);
        let message = "the triangles reach over 2.00e0 only, too little for the numbers around \
                       them; move them to the origin or scale them up in a scene file";
        assert_eq!(says(&small), message);
    }
}
