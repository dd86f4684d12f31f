//! Writing a scene file: one mesh before one camera.

use super::camera::square_pixels;
use bothways_common::camera::{CameraDescription, Orientation, Projection};
use glam::Vec3;
use std::fmt::Write;

/// The scene file that shows one mesh file from a camera.
///
/// Reading it gives the same camera to the last bit. A viewport that follows from the image is left
/// out, so that another image size changes it along.
///
/// ```
/// use bothways_common::{CameraDescription, scene_file::framed_mesh_toml};
///
/// let toml = framed_mesh_toml(&CameraDescription::default(), "bunny.obj");
/// assert!(toml.ends_with("[[object]]\nmesh = \"bunny.obj\"\n"));
/// ```
pub fn framed_mesh_toml(camera: &CameraDescription, mesh: &str) -> String {
    let mut toml = camera_toml(camera);
    let path = toml::Value::from(mesh);
    write!(toml, "\n[[object]]\nmesh = {path}\n").expect("a string has room");
    toml
}

fn camera_toml(camera: &CameraDescription) -> String {
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
    // `{:?}` writes the fewest digits that read back as the same number, and always as a decimal.
    lines.push(format!("distance = {distance:?}"));
    if viewport != square_pixels(image) {
        lines.push(format!("viewport = {viewport:?}"));
    }
    lines.push(format!("image = {image:?}\n"));
    lines.join("\n")
}

fn vector(key: &str, vector: Vec3) -> String {
    format!("{key} = {:?}", vector.to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::parse;
    use std::path::Path;

    fn read_back(camera: &CameraDescription) -> (CameraDescription, bool) {
        let toml = camera_toml(camera) + "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }";
        let file = parse("written.toml", &toml, Path::new("")).unwrap();
        (file.camera, file.viewport_stated)
    }

    #[test]
    fn a_camera_reads_back_to_the_last_bit() {
        let hostile = Vec3::new(1e-45, -0.0, 3.402_823_5e38);
        let orientations = [
            Orientation::LookAt {
                target: Vec3::new(0.1, 1e30, -1e-30),
                up: Vec3::new(0.3, 7.0, 0.0),
            },
            Orientation::Direction { direction: Vec3::new(16_777_216.0, 0.7, 1.5), up: Vec3::Z },
            Orientation::Frame { u: Vec3::X, v: Vec3::Y, w: Vec3::Z },
        ];
        for orientation in orientations {
            let camera = CameraDescription {
                projection: Projection::Parallel,
                eye: hostile,
                orientation,
                distance: 0.7,
                viewport: [1.0 / 3.0, 123_456.79],
                image: [641, 479],
            };
            let (read, viewport_stated) = read_back(&camera);
            assert_eq!(format!("{read:?}"), format!("{camera:?}"));
            assert!(viewport_stated);
        }
    }

    #[test]
    fn a_viewport_that_follows_from_the_image_is_not_stated() {
        let camera = CameraDescription::default();
        assert_eq!(read_back(&camera), (camera, false));
    }

    #[test]
    fn a_path_is_written_so_that_it_reads_back() {
        for path in ["a b.obj", "quote\"d", "back\\slash", "línea\n\t.obj", "'''\"\"\"", ""] {
            let toml = framed_mesh_toml(&CameraDescription::default(), path);
            let table: toml::Table = toml.parse().unwrap();
            assert_eq!(table["object"][0]["mesh"].as_str(), Some(path));
        }
    }
}
