//! The same camera with another projection.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{
    Camera, CameraDescription, CameraError, Orientation, Projection, Scene, Shape,
};

/// The same camera with another projection: eye and frame stay, and the viewport is scaled so that what is looked at
/// keeps its size in the picture. Without a target, that is the middle of all objects of finite size.
///
/// # Errors
///
/// A camera that [`Camera::new`] refuses.
pub fn with_projection(
    camera: &CameraDescription,
    projection: Projection,
    scene: &Scene,
) -> Result<CameraDescription, CameraError> {
    if projection == camera.projection {
        return Ok(*camera);
    }
    let scale = scale_for(projection, camera, scene)?;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the camera stores f32, and checks its range"
    )]
    let viewport = camera.viewport.map(|side| (f64::from(side) * scale) as f32);
    Ok(CameraDescription { projection, viewport, ..*camera })
}

/// The factor for the viewport that keeps the size of the target in the picture.
///
/// At a depth `z` a perspective camera sees a rectangle `z/d` times its viewport.
fn scale_for(
    projection: Projection,
    camera: &CameraDescription,
    scene: &Scene,
) -> Result<f64, CameraError> {
    let depth = match camera.orientation {
        Orientation::LookAt { target, .. } => {
            Some((target.as_dvec3() - camera.eye.as_dvec3()).length())
        }
        Orientation::Direction { .. } | Orientation::Frame { .. } => {
            let back = Camera::new(*camera)?.w();
            middle(scene).map(|middle| -(middle - camera.eye.as_dvec3()).dot(back))
        }
    };
    let ratio = match depth {
        Some(depth) if depth > 0.0 => depth / f64::from(camera.distance),
        _ => 1.0,
    };
    Ok(match projection {
        Projection::Parallel => ratio,
        Projection::Perspective => 1.0 / ratio,
    })
}

/// The middle of the box around all objects of finite size.
fn middle(scene: &Scene) -> Option<DVec3> {
    let mut bounds: Option<[DVec3; 2]> = None;
    let mut include = |point: Vec3, radius: f32| {
        let (point, radius) = (point.as_dvec3(), DVec3::splat(radius.into()));
        let [low, high] = bounds.unwrap_or([point; 2]);
        bounds = Some([low.min(point - radius), high.max(point + radius)]);
    };
    for object in scene.objects() {
        match &object.shape {
            Shape::Triangle(triangle) => {
                [triangle.a, triangle.b, triangle.c].into_iter().for_each(|p| include(p, 0.0));
            }
            Shape::Sphere(sphere) => include(sphere.center, sphere.radius),
            Shape::Mesh(mesh) => {
                // A file may define vertices that no triangle uses.
                let used = mesh.triangles().iter().flatten();
                used.for_each(|&vertex| include(mesh.positions()[vertex as usize], 0.0));
            }
            Shape::Instances(instances) => {
                let Some([low, high]) = instances.mesh().bounds() else { continue };
                for placement in instances.placements() {
                    for corner in 0..8 {
                        let side =
                            |axis: usize| if corner >> axis & 1 == 1 { high } else { low }[axis];
                        include(placement.position(Vec3::new(side(0), side(1), side(2))), 0.0);
                    }
                }
            }
            Shape::Plane(_) => {}
        }
    }
    bounds.map(|[low, high]| low.midpoint(high))
}
