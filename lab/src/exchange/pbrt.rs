//! pbrt, version 4: the lines of a scene file before `WorldBegin`.
//!
//! pbrt's camera space is left-handed: `LookAt` puts `up × view` at the right. `Scale -1 1 1` before it mirrors that back,
//! so that a right-handed world is seen as it is. Raster coordinates count from the upper left, pixel middles at ½
//! (Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th edition, 2023, 3.9.4 and 5.2; pbrt-v4 file format).
//!
//! `fov` is the angle at which the screen window's unit is seen, so that at 90 degrees the window is that of the plane
//! at distance 1, and no trigonometric function is needed. A window of any form makes pixels of any form.

use super::depths::StatedDepths;
use super::error::ExchangeError;
use super::numbers::{number, numbers};
use super::system::System;
use crate::common::{Camera, Projection};
use crate::wording::plain;
use serde::Serialize;

/// A camera of pbrt.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pbrt {
    /// The camera's name: `perspective` or `orthographic`.
    pub camera: &'static str,
    /// The first three numbers of `LookAt`, in the world. It is to be preceded by `Scale -1 1 1`.
    pub eye: [f64; 3],
    /// The next three: a point of the world in the middle of the picture.
    pub look: [f64; 3],
    /// The last three: up, a unit vector.
    pub up: [f64; 3],
    /// `fov` in degrees, for a perspective camera.
    pub fov: Option<f64>,
    /// `screenwindow`: least and largest `x`, least and largest `y`.
    pub screen_window: [f64; 4],
    /// `xresolution` and `yresolution`.
    pub resolution: [u32; 2],
}

impl Pbrt {
    pub(super) fn new(camera: &Camera, depths: StatedDepths) -> Result<Pbrt, ExchangeError> {
        depths.none(System::Pbrt)?;
        let eye = camera.eye().as_dvec3();
        // pbrt computes in f32. A point about as far from the eye as that is from the origin keeps the direction best.
        let step = eye.abs().max_element().max(1.0).log2().ceil().exp2();
        let (name, fov, unit) = match camera.projection() {
            Projection::Perspective => ("perspective", Some(90.0), camera.distance()),
            Projection::Parallel => ("orthographic", None, 1.0),
        };
        let [x, y] = camera.viewport().map(|side| side / (2.0 * unit));
        Ok(Pbrt {
            camera: name,
            eye: plain(eye),
            look: plain(eye - step * camera.w()),
            up: plain(camera.v()),
            fov,
            screen_window: [-x, x, -y, y],
            resolution: camera.image(),
        })
    }

    pub(super) fn text(&self) -> String {
        let [width, height] = self.resolution;
        let fov = self
            .fov
            .map_or(String::new(), |fov| format!("\n    \"float fov\" [ {} ]", number(fov)));
        format!(
            "# The camera of pbrt-v4, which stands before WorldBegin. The scale mirrors pbrt's left-handed camera: the world is right-handed.\n\
             Scale -1 1 1\n\
             LookAt {}\n       {}\n       {}\n\
             Camera \"{}\"{fov}\n    \"float screenwindow\" [ {} ]\n\
             Film \"rgb\"\n    \"integer xresolution\" [ {width} ]\n    \"integer yresolution\" [ {height} ]\n",
            numbers(&self.eye, " "),
            numbers(&self.look, " "),
            numbers(&self.up, " "),
            self.camera,
            numbers(&self.screen_window, " "),
        )
    }
}
