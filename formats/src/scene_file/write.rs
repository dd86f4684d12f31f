//! Writes a scene file: one mesh and one camera.

use super::camera::square_pixels;
use bothways_common::camera::{CameraDescription, Orientation, Projection};
use glam::Vec3;
use std::fmt::Write;

/// Writes the text of a scene file that shows one mesh file from a camera.
///
/// The text reads back as the same camera, bit for bit. A viewport that follows from the image is left out unless it is
/// stated: then another image size keeps both its sides, else it changes the viewport as well. The path `mesh` is relative
/// to the folder of the scene file.
///
/// ```
/// use bothways_common::CameraDescription;
/// use bothways_formats::scene_file::framed_mesh_toml;
///
/// let toml = framed_mesh_toml(&CameraDescription::default(), false, "bunny.obj");
/// assert!(toml.ends_with("[[object]]\nmesh = \"bunny.obj\"\n"));
/// ```
pub fn framed_mesh_toml(camera: &CameraDescription, viewport_stated: bool, mesh: &str) -> String {
    let mut toml = camera_toml(camera, viewport_stated);
    let path = toml::Value::from(mesh);
    write!(toml, "\n[[object]]\nmesh = {path}\n").expect("a string has room");
    toml
}

/// The `[camera]` table.
pub(super) fn camera_toml(camera: &CameraDescription, viewport_stated: bool) -> String {
    let CameraDescription { projection, eye, orientation, distance, viewport, image } = *camera;
    let mut lines = vec!["[camera]".to_owned()];
    if projection == Projection::Parallel {
        lines.push("projection = \"parallel\"".to_owned());
    }
    lines.push(vector("eye", eye));
    match orientation {
        Orientation::LookAt { target, up } => {
            lines.extend([vector("look_at", target), vector("up", up)]);
        }
        Orientation::Direction { direction, up } => {
            lines.extend([vector("direction", direction), vector("up", up)]);
        }
        Orientation::Frame { u, v, w } => {
            lines.extend([vector("u", u), vector("v", v), vector("w", w)]);
        }
    }
    // `{:?}` writes the fewest digits that read back as the same number, always as a decimal number.
    lines.push(format!("distance = {distance:?}"));
    if viewport_stated || viewport != square_pixels(image) {
        lines.push(format!("viewport = {viewport:?}"));
    }
    lines.push(format!("image = {image:?}\n"));
    lines.join("\n")
}

fn vector(key: &str, vector: Vec3) -> String {
    format!("{key} = {:?}", vector.to_array())
}
