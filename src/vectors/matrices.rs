//! The matrices that make a graphics interface see what a camera sees.

use crate::common::glam::{DMat4, DVec4};
use crate::common::{Camera, Projection};

/// The view matrix `camera_from_world`: the eye becomes the origin, `u`, `v`, `w` the axes.
pub fn camera_from_world(camera: &Camera) -> DMat4 {
    let eye = camera.eye().as_dvec3();
    let axes = [camera.u(), camera.v(), camera.w()];
    let rows = axes.map(|axis| axis.extend(-axis.dot(eye)));
    DMat4::from_cols(rows[0], rows[1], rows[2], DVec4::W).transpose()
}

/// OpenGL's projection matrix `clip_from_camera`: `-w ≤ x, y, z ≤ w`.
///
/// The renderers have no near and no far plane. A perspective matrix needs a near one, so it gets
/// `near`, and its far plane lies at infinity; a parallel one begins at the eye and ends at `far`.
pub fn clip_from_camera(camera: &Camera, near: f64, far: f64) -> DMat4 {
    let [vw, vh] = camera.viewport();
    let columns = match camera.projection() {
        Projection::Perspective => {
            let d = camera.distance();
            [
                [2.0 * d / vw, 0.0, 0.0, 0.0],
                [0.0, 2.0 * d / vh, 0.0, 0.0],
                [0.0, 0.0, -1.0, -1.0],
                [0.0, 0.0, -2.0 * near, 0.0],
            ]
        }
        Projection::Parallel => [
            [2.0 / vw, 0.0, 0.0, 0.0],
            [0.0, 2.0 / vh, 0.0, 0.0],
            [0.0, 0.0, -2.0 / far, 0.0],
            [0.0, 0.0, -1.0, 1.0],
        ],
    };
    DMat4::from_cols_array_2d(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::CameraDescription;
    use crate::common::glam::DVec3;

    #[test]
    fn corners_of_the_viewport_become_corners_of_the_clip_cube() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description = CameraDescription {
                projection,
                distance: 2.0,
                viewport: [3.0, 1.0],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).unwrap();
            let ray = camera.ray_through(1.5, -0.5);
            let matrix = clip_from_camera(&camera, 1.0, 8.0) * camera_from_world(&camera);
            let clip = matrix * (ray.origin + 2.0 * ray.direction).extend(1.0);
            assert_eq!((clip.truncate() / clip.w).truncate().to_array(), [1.0, -1.0]);
            let depth = |z: f64| matrix.project_point3(DVec3::new(0.0, 0.0, -z)).z;
            match projection {
                Projection::Perspective => assert_eq!(depth(1.0), -1.0),
                Projection::Parallel => assert_eq!([depth(0.0), depth(8.0)], [-1.0, 1.0]),
            }
        }
    }
}
