//! The cameras of a glTF file, as cameras of the lecture.

use super::error::GltfFault;
use super::item::{Located, item};
use super::nodes::Placed;
use ::gltf::json::Root;
use ::gltf::json::camera::{Camera, Orthographic, Perspective};
use bothways_common::camera::{CameraDescription, Orientation, Projection};
use glam::DVec3;

/// A camera of a glTF file.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfCamera {
    /// Its name, or that of its node; empty if neither has one.
    pub name: String,
    /// The camera, for an image of 480 rows.
    ///
    /// A perspective camera has a viewport of height 1 at the distance `d = 1/(2·tan(yfov/2))`, whose width is the aspect ratio.
    /// A parallel one has a viewport of `2·xmag` by `2·ymag`. Near and far planes are left out: there are none here.
    pub camera: CameraDescription,
    /// Whether the file states an aspect ratio. If it does not, the viewport follows from the image.
    pub aspect_stated: bool,
}

/// The height of the image, in pixels.
const ROWS: u32 = 480;

/// The cameras of all nodes, in their order.
pub(super) fn cameras(root: &Root, placed: &[Placed]) -> Result<Vec<GltfCamera>, Located> {
    let mut cameras = Vec::new();
    for place in placed {
        let Some(index) = place.node.camera else { continue };
        let (number, camera) =
            item(&root.cameras, index, "camera").map_err(|fault| place.located(fault))?;
        let described =
            describe(camera, place).map_err(|fault| (format!("camera {number}"), fault))?;
        let name = camera.name.as_ref().or(place.node.name.as_ref());
        let (camera, aspect_stated) = described;
        cameras.push(GltfCamera { name: name.cloned().unwrap_or_default(), camera, aspect_stated });
    }
    Ok(cameras)
}

fn describe(camera: &Camera, place: &Placed) -> Result<(CameraDescription, bool), GltfFault> {
    let axis = |k: usize| place.world_from_node.col(k).truncate().normalize_or_zero();
    // The camera looks along −z of its node. The frame is made perpendicular where the node is skewed.
    let (right, back) = (axis(0), axis(2));
    let up = back.cross(right).normalize_or_zero();
    let frame = [up.cross(back).normalize_or_zero(), up, back];
    let eye = place.world_from_node.w_axis.truncate().as_vec3();
    if frame.contains(&DVec3::ZERO) || !eye.is_finite() {
        return Err(GltfFault::TransformNotFinite);
    }
    let [u, v, w] = frame.map(|axis| axis.as_vec3());
    let placed = CameraDescription {
        eye,
        orientation: Orientation::Frame { u, v, w },
        image: [640, ROWS],
        ..CameraDescription::default()
    };
    match (&camera.perspective, &camera.orthographic) {
        (Some(perspective), None) => with_perspective(placed, perspective),
        (None, Some(parallel)) => with_parallel_rays(placed, parallel).map(|camera| (camera, true)),
        _ => Err(GltfFault::Invalid { what: "its projection, of which there must be one," }),
    }
}

fn with_perspective(
    placed: CameraDescription,
    perspective: &Perspective,
) -> Result<(CameraDescription, bool), GltfFault> {
    let yfov = perspective.yfov;
    if !(yfov > 0.0 && yfov < std::f32::consts::PI) {
        return Err(GltfFault::Camera { what: "yfov", value: yfov, range: "between 0 and pi" });
    }
    // libm gives the same result on every machine.
    let distance = rounded(0.5 / libm::tan(f64::from(yfov) / 2.0));
    let camera = CameraDescription { distance, ..placed };
    match perspective.aspect_ratio {
        Some(aspect) => {
            with_viewport(camera, [aspect, 1.0], "aspectRatio").map(|camera| (camera, true))
        }
        None => Ok((CameraDescription { viewport: [640.0 / 480.0, 1.0], ..camera }, false)),
    }
}

fn with_parallel_rays(
    placed: CameraDescription,
    parallel: &Orthographic,
) -> Result<CameraDescription, GltfFault> {
    let [width, height] = [parallel.xmag, parallel.ymag].map(|half| 2.0 * half.abs());
    let camera = CameraDescription { projection: Projection::Parallel, ..placed };
    with_viewport(camera, [width, height], "ratio of xmag to ymag")
}

/// The camera with a viewport, and an image of the same shape.
fn with_viewport(
    camera: CameraDescription,
    viewport: [f32; 2],
    what: &'static str,
) -> Result<CameraDescription, GltfFault> {
    let aspect = viewport[0] / viewport[1];
    // Up to the widest and the highest image of so many rows.
    if !(0.01..=100.0).contains(&aspect) {
        return Err(GltfFault::Camera { what, value: aspect, range: "from 0.01 to 100" });
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "up to 48,000")]
    let columns = (aspect * ROWS as f32).round() as u32;
    Ok(CameraDescription { viewport, image: [columns.max(1), ROWS], ..camera })
}

#[expect(clippy::cast_possible_truncation, reason = "the camera stores f32, and checks its range")]
fn rounded(value: f64) -> f32 {
    value as f32
}
