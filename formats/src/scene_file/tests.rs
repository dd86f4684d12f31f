//! A written scene file reads back as the camera and the path that it was written from.

use super::write::camera_toml;
use super::*;
use bothways_common::camera::{Orientation, Projection};
use glam::Vec3;

fn read_back(camera: &CameraDescription, stated: bool) -> (CameraDescription, bool) {
    let toml =
        camera_toml(camera, stated) + "[[object]]\nsphere = { center = [0, 0, 0], radius = 1 }";
    let file = parse("written.toml", &toml, &Files::none()).unwrap();
    (file.camera, file.viewport_stated)
}

#[test]
fn a_camera_reads_back_to_the_last_bit() {
    let hostile = Vec3::new(1e-45, -0.0, 3.402_823_5e38);
    let orientations = [
        Orientation::LookAt { target: Vec3::new(0.1, 1e30, -1e-30), up: Vec3::new(0.3, 7.0, 0.0) },
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
        let (read, viewport_stated) = read_back(&camera, false);
        assert_eq!(format!("{read:?}"), format!("{camera:?}"));
        assert!(viewport_stated);
    }
}

#[test]
fn a_viewport_that_follows_from_the_image_is_stated_on_request_only() {
    let camera = CameraDescription::default();
    for stated in [false, true] {
        assert_eq!(read_back(&camera, stated), (camera, stated));
    }
}

#[test]
fn a_path_is_written_so_that_it_reads_back() {
    for path in ["a b.obj", "quote\"d", "back\\slash", "línea\n\t.obj", "'''\"\"\"", ""] {
        let toml = framed_mesh_toml(&CameraDescription::default(), false, path);
        let table: toml::Table = toml.parse().unwrap();
        assert_eq!(table["object"][0]["mesh"].as_str(), Some(path));
    }
}
