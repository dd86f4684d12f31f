//! A camera as OpenGL's matrices, to draw the same picture with OpenGL.
//!
//! Matrices are rows of numbers, to be multiplied with columns: `clip = projection · view · (x, y, z, 1)`. With
//! `glViewport(0, 0, W, H)` the centre of pixel `(i, j)` is OpenGL's window position `(j + ½, H − i − ½)`: OpenGL
//! counts rows from the bottom.
//!
//! Our rays have no near plane and no far plane, but OpenGL's depth needs bounds. A perspective projection here has
//! its far plane at infinity, and a near plane at a small fraction of `d`: only OpenGL cuts off the parts nearer to
//! the eye. A parallel projection reaches from the eye to a plane behind all primitives except planes.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{Camera, Primitive, Projection, Shape, Sphere, Triangle, View};

/// Four rows of four numbers.
pub type Matrix = [[f64; 4]; 4];

/// The layout of every matrix in files for programs: a list of its rows.
pub const LAYOUT: &str = "row-major";

/// OpenGL's matrices for one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrices {
    /// `camera_from_world`: eye coordinates, `x` along `u`, `y` along `v`, `z` along `w`.
    pub view: Matrix,
    /// `clip_from_camera` for depths from −1 (near) to 1 (far), OpenGL's default.
    pub projection: Matrix,
    /// `clip_from_camera` for depths from 1 (near) to 0 (far), after `glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)`,
    /// with `glDepthFunc(GL_GREATER)` and `glClearDepth(0)`: floating-point depth buffers resolve distances much
    /// better in this direction.
    pub reversed: Matrix,
    /// The depth along `−w` of the near plane.
    pub near: f64,
    /// The depth of the far plane; `None` means infinity.
    pub far: Option<f64>,
}

/// The near plane of a perspective projection, in parts of `d`: a power of two, so that the matrix
/// stays exact.
pub(crate) const NEAR: f64 = 1.0 / 1024.0;

/// The matrices that draw a view's picture, with depths that leave out as little as possible.
pub fn matrices(view: &View) -> Matrices {
    match view.camera.projection() {
        Projection::Perspective => between(view.camera, NEAR * view.camera.distance(), 0.0),
        Projection::Parallel => between(view.camera, 0.0, behind_everything(view)),
    }
}

/// The matrices of a camera with stated depths: a perspective projection begins at `near` and has no end, a parallel
/// projection begins at the eye and ends at `far`.
pub fn between(camera: &Camera, near: f64, far: f64) -> Matrices {
    let depths = match camera.projection() {
        Projection::Perspective => Depths { near, far: None },
        Projection::Parallel => Depths { near: 0.0, far: Some(far) },
    };
    let projection = |at| clip_from_camera(camera, depths, 1.0, at);
    Matrices {
        view: camera_from_world(camera),
        projection: projection([-1.0, 1.0]),
        reversed: projection([1.0, 0.0]),
        near: depths.near,
        far: depths.far,
    }
}

/// The depths of both planes along `−w`; `far` is infinite where it is `None`, which it never is for a parallel camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Depths {
    pub(crate) near: f64,
    pub(crate) far: Option<f64>,
}

/// `clip_from_camera`: `top` is the `y` of the picture's upper border, and `at` are the depths at the near and at the far
/// plane, all after the division by the clip coordinate `w`.
pub(crate) fn clip_from_camera(camera: &Camera, depths: Depths, top: f64, at: [f64; 2]) -> Matrix {
    let ([vw, vh], d) = (camera.viewport(), camera.distance());
    let ([at_near, at_far], Depths { near, far }) = (at, depths);
    match camera.projection() {
        Projection::Perspective => {
            // Depth is (a·z + b) / −z: at_near for z = −near, at_far for z = −far.
            let toward_far = far.map_or(0.0, |far| near / far);
            let b = (at_near - at_far) * near / (1.0 - toward_far);
            let a = far.map_or(0.0, |far| b / far) - at_far;
            [
                [2.0 * d / vw, 0.0, 0.0, 0.0],
                [0.0, top * 2.0 * d / vh, 0.0, 0.0],
                [0.0, 0.0, a, b],
                [0.0, 0.0, -1.0, 0.0],
            ]
        }
        Projection::Parallel => {
            // Depth is a·z + b.
            let a = far.map_or(0.0, |far| (at_near - at_far) / (far - near));
            [
                [2.0 / vw, 0.0, 0.0, 0.0],
                [0.0, top * 2.0 / vh, 0.0, 0.0],
                [0.0, 0.0, a, at_near + a * near],
                [0.0, 0.0, 0.0, 1.0],
            ]
        }
    }
}

/// The angles between opposite sides of the viewport, horizontal and vertical, in degrees; `None` for a parallel camera.
pub fn field_of_view(view: &View) -> Option<[f64; 2]> {
    let camera = view.camera;
    let angle = |side: f64| 2.0 * (side / 2.0).atan2(camera.distance()).to_degrees();
    (camera.projection() == Projection::Perspective).then(|| camera.viewport().map(angle))
}

pub(crate) fn camera_from_world(camera: &Camera) -> Matrix {
    let eye = camera.eye().as_dvec3();
    // Adding 0 turns −0 into 0.
    let row = |axis: DVec3| [axis.x, axis.y, axis.z, -axis.dot(eye) + 0.0];
    [row(camera.u()), row(camera.v()), row(camera.w()), [0.0, 0.0, 0.0, 1.0]]
}

/// A depth behind all triangles and spheres: a power of two.
pub(crate) fn behind_everything(view: &View) -> f64 {
    let depth = |point: DVec3| -point.dot(view.camera.w());
    let deepest = if view.scene.has_wide_ids() {
        // There are too many to look at each: the boxes of instances are behind their triangles.
        corners_of_all(view).map(depth).fold(0.0, f64::max)
    } else {
        let depths = view.primitives().map(|(_, primitive)| match primitive {
            Primitive::Triangle(corners) => corners.map(depth).into_iter().fold(0.0, f64::max),
            Primitive::Sphere { center, radius } => depth(center) + radius,
            Primitive::Plane { .. } => 0.0,
        });
        depths.fold(0.0, f64::max)
    };
    // The depth is strictly behind, so that the farthest corner is not cut off.
    if deepest > 0.0 { (deepest.log2().floor() + 1.0).exp2() } else { 1.0 }
}

/// The corners of boxes around all that ends, relative to the eye: one for each object, and for each instance.
fn corners_of_all<'a>(view: &'a View) -> impl Iterator<Item = DVec3> + 'a {
    let objects = view.scene.objects().iter().map(|object| &object.shape);
    objects.flat_map(move |shape| -> Box<dyn Iterator<Item = DVec3> + 'a> {
        let corner = |[low, high]: [Vec3; 2], k: usize| {
            Vec3::from_array(
                [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { high[axis] } else { low[axis] }),
            )
        };
        let bounds = match shape {
            Shape::Instances(instances) => {
                let bounds = instances.mesh().bounds();
                let placed = bounds.into_iter().flat_map(move |bounds| {
                    let corners = (0..8).map(move |k| corner(bounds, k));
                    let all = instances.placements().iter();
                    all.flat_map(move |placement| {
                        corners.clone().map(|corner| placement.position(corner))
                    })
                });
                return Box::new(placed.map(|position| view.offset(position)));
            }
            Shape::Mesh(mesh) => mesh.bounds(),
            Shape::Triangle(Triangle { a, b, c }) => Some([a.min(*b).min(*c), a.max(*b).max(*c)]),
            Shape::Sphere(Sphere { center, radius }) => {
                Some([*center - *radius, *center + *radius])
            }
            Shape::Plane(_) => None,
        };
        let corners =
            bounds.into_iter().flat_map(move |bounds| (0..8).map(move |k| corner(bounds, k)));
        Box::new(corners.map(|position| view.offset(position)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::{DVec4, Vec3};
    use crate::common::{CameraDescription, Orientation, Scene, Shape, Sphere, Triangle};

    fn camera(projection: Projection) -> Camera {
        Camera::new(CameraDescription {
            projection,
            eye: Vec3::new(1.0, 2.0, 5.0),
            orientation: Orientation::LookAt { target: Vec3::new(0.5, 0.0, 0.0), up: Vec3::Y },
            distance: 2.0,
            viewport: [4.0, 3.0],
            image: [8, 6],
        })
        .unwrap()
    }

    fn scene() -> Scene {
        let ball = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
        let (a, b, c) = (Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, -9.0));
        Scene::new(vec![ball.into(), Shape::Triangle(Triangle { a, b, c }).into()]).unwrap()
    }

    fn apply(matrix: &Matrix, point: DVec4) -> DVec4 {
        DVec4::from_array(matrix.map(|row| DVec4::from_array(row).dot(point)))
    }

    #[test]
    fn a_pixel_s_ray_ends_at_its_place_in_the_window() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let (scene, camera) = (scene(), camera(projection));
            let matrices = matrices(&View::new(&scene, &camera));
            for (i, j) in [(0, 0), (5, 7), (2, 3)] {
                let ray = camera.viewing_ray(i, j);
                let point = camera.eye().as_dvec3() + ray.origin + 1.5 * ray.direction;
                let eye = apply(&matrices.view, point.extend(1.0));
                for (projection, low) in [(matrices.projection, -1.0), (matrices.reversed, 0.0)] {
                    let clip = apply(&projection, eye);
                    let normalized = clip.truncate() / clip.w;
                    let window = (normalized + 1.0) / 2.0;
                    assert!((window.x * 8.0 - (f64::from(j) + 0.5)).abs() < 1e-12);
                    assert!((window.y * 6.0 - (5.5 - f64::from(i))).abs() < 1e-12);
                    assert!((low..1.0).contains(&normalized.z));
                }
            }
        }
    }

    #[test]
    fn depths_run_from_near_to_far() {
        let (scene, camera) = (scene(), camera(Projection::Perspective));
        let found = matrices(&View::new(&scene, &camera));
        let depth = |matrix: &Matrix, depth: f64| {
            let clip = apply(matrix, DVec4::new(0.0, 0.0, -depth, 1.0));
            clip.z / clip.w
        };
        assert_eq!((found.near, found.far), (2.0 / 1024.0, None));
        assert_eq!(depth(&found.projection, found.near), -1.0);
        assert_eq!(depth(&found.reversed, found.near), 1.0);
        assert!(depth(&found.projection, 1e30) > 0.999);
        assert!(depth(&found.reversed, 1e30) < 0.001);

        let camera = self::camera(Projection::Parallel);
        let found = matrices(&View::new(&scene, &camera));
        let far = found.far.unwrap();
        assert_eq!((found.near, far), (0.0, 16.0));
        assert_eq!((depth(&found.projection, 0.0), depth(&found.projection, far)), (-1.0, 1.0));
        assert_eq!((depth(&found.reversed, 0.0), depth(&found.reversed, far)), (1.0, 0.0));
    }

    #[test]
    fn a_field_of_view_is_an_angle_of_a_perspective_camera() {
        let scene = scene();
        let [across, down] = field_of_view(&View::new(&scene, &camera(Projection::Perspective)))
            .expect("it is a perspective camera");
        assert!((across - 90.0).abs() < 1e-12 && (down - 73.739_795_291_688_05).abs() < 1e-12);
        assert_eq!(field_of_view(&View::new(&scene, &camera(Projection::Parallel))), None);
    }
}
