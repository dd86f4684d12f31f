//! OpenCV: the matrix `K` of a camera without distortion, and its pose `R`, `t`.
//!
//! A point `X` of the world is `R·X + t` in the camera's axes: `x` right, `y` down, `z` forward. It lies at pixel
//! `(fx·x/z + cx, fy·y/z + cy)`, column first, where whole numbers are the middles of pixels (OpenCV documentation, "Camera
//! Calibration and 3D Reconstruction"; kornia documentation, camera conventions).

use super::depths::StatedDepths;
use super::error::ExchangeError;
use super::numbers::numbers;
use super::system::System;
use crate::common::{Camera, Projection};
use crate::wording::plain;
use serde::Serialize;

/// A camera of OpenCV.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OpenCv {
    /// `K`, as rows: `fx`, 0, `cx`; 0, `fy`, `cy`; 0, 0, 1. In pixels.
    pub k: [[f64; 3]; 3],
    /// `R`, as rows: right, down and forward in the world's axes.
    pub r: [[f64; 3]; 3],
    /// `t`: the world's origin in the camera's axes.
    pub t: [f64; 3],
    /// The image's width and height in pixels.
    pub image_size: [u32; 2],
}

impl OpenCv {
    pub(super) fn new(camera: &Camera, depths: StatedDepths) -> Result<OpenCv, ExchangeError> {
        let [fx, fy, cx, cy] = intrinsics(camera, System::OpenCv, depths)?;
        let (r, t) = pose(camera);
        Ok(OpenCv {
            k: [[fx, 0.0, cx - 0.5], [0.0, fy, cy - 0.5], [0.0, 0.0, 1.0]],
            r,
            t,
            image_size: camera.image(),
        })
    }

    pub(super) fn text(&self) -> String {
        let rows = |rows: &[[f64; 3]; 3]| {
            rows.map(|row| format!("    [{}],\n", numbers(&row, ", "))).concat()
        };
        let [width, height] = self.image_size;
        format!(
            "# OpenCV, without distortion: pixel ~ K (R X + t), column first. Whole numbers are the middles of pixels;\n\
             # the camera's x points right, its y down, its z forward.\n\
             import numpy as np\n\n\
             K = np.array([\n{}])\n\
             R = np.array([\n{}])\n\
             t = np.array([{}])\n\
             image_size = ({width}, {height})\n",
            rows(&self.k),
            rows(&self.r),
            numbers(&self.t, ", "),
        )
    }
}

/// `fx`, `fy`, `cx`, `cy` in pixels, for pixel middles at ½.
pub(super) fn intrinsics(
    camera: &Camera,
    system: System,
    depths: StatedDepths,
) -> Result<[f64; 4], ExchangeError> {
    if camera.projection() == Projection::Parallel {
        return Err(ExchangeError::Parallel { system });
    }
    depths.none(system)?;
    let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
    let d = camera.distance();
    Ok([d * width / vw, d * height / vh, width / 2.0, height / 2.0])
}

/// `R` as rows, and `t`.
pub(super) fn pose(camera: &Camera) -> ([[f64; 3]; 3], [f64; 3]) {
    let rows = [camera.u(), -camera.v(), -camera.w()];
    let eye = camera.eye().as_dvec3();
    (rows.map(plain), rows.map(|row| -row.dot(eye) + 0.0))
}
