//! COLMAP: a line of `cameras.txt` and one of `images.txt`.
//!
//! As OpenCV, but for two things: the middle of the first pixel is at (½, ½), and the rotation is a unit quaternion
//! (COLMAP documentation, "Output Format" and "Camera Models").

use super::depths::StatedDepths;
use super::error::ExchangeError;
use super::numbers::numbers;
use super::opencv::{intrinsics, pose};
use super::system::System;
use crate::common::Camera;
use crate::common::glam::{DMat3, DQuat, DVec3};
use serde::Serialize;

/// A camera of COLMAP, and the image that it took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Colmap {
    /// The model: `PINHOLE`.
    pub model: &'static str,
    /// The image's width and height in pixels.
    pub image: [u32; 2],
    /// `fx`, `fy`, `cx`, `cy` in pixels.
    pub params: [f64; 4],
    /// `qw`, `qx`, `qy`, `qz`: the rotation from the world's axes to the camera's.
    pub quaternion: [f64; 4],
    /// `tx`, `ty`, `tz`: the world's origin in the camera's axes.
    pub translation: [f64; 3],
}

impl Colmap {
    pub(super) fn new(camera: &Camera, depths: StatedDepths) -> Result<Colmap, ExchangeError> {
        let params = intrinsics(camera, System::Colmap, depths)?;
        let (rows, translation) = pose(camera);
        let [right, down, forward] = rows.map(DVec3::from_array);
        let rotation = DMat3::from_cols(right, down, forward).transpose();
        let turn = DQuat::from_mat3(&rotation).normalize();
        // Both signs are the same rotation.
        let turn = if turn.w < 0.0 { -turn } else { turn };
        Ok(Colmap {
            model: "PINHOLE",
            image: camera.image(),
            params,
            quaternion: [turn.w, turn.x, turn.y, turn.z].map(|x| x + 0.0),
            translation,
        })
    }

    pub(super) fn text(&self) -> String {
        let [width, height] = self.image;
        format!(
            "# COLMAP, cameras.txt: CAMERA_ID, MODEL, WIDTH, HEIGHT, fx, fy, cx, cy\n\
             1 {} {width} {height} {}\n\
             # COLMAP, images.txt: IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME; an empty line: no points\n\
             1 {} {} 1 object-order.png\n\n",
            self.model,
            numbers(&self.params, " "),
            numbers(&self.quaternion, " "),
            numbers(&self.translation, " "),
        )
    }
}
