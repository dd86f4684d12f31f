//! A camera in the words of another system, to draw the same picture there.
//!
//! Every number is an `f64` that is exact up to its last roundings, and every text is one to paste or to pipe into a
//! file of that system. What a system cannot express is an error, never a picture that is nearly the same: see
//! [`ExchangeError`]. A [`Camera`](crate::common::Camera) has an orthonormal frame, also where a scene states one that
//! is a little skew, so that no system needs more than a rotation.
//!
//! Pixel `(i, j)` of ours has its middle at `(j + ½, i + ½)`, counted from the upper left corner, rightwards and
//! downwards; each file here says where the other system puts it.

mod aspect;
mod blender;
mod clip;
mod colmap;
mod depths;
mod directx;
mod error;
mod mitsuba;
mod numbers;
mod opencv;
mod opengl;
mod pbrt;
mod system;
#[cfg(test)]
mod tests;
mod vulkan;

pub use blender::Blender;
pub use clip::ClipMatrices;
pub use colmap::Colmap;
pub use depths::StatedDepths;
pub use error::ExchangeError;
pub use mitsuba::Mitsuba;
pub use opencv::OpenCv;
pub use pbrt::Pbrt;
pub use system::System;

use crate::common::View;
use serde::Serialize;

/// A camera in the words of one system.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Exchanged {
    /// For [`System::OpenGl`].
    OpenGl(ClipMatrices),
    /// For [`System::Vulkan`].
    Vulkan(ClipMatrices),
    /// For [`System::DirectX`].
    DirectX(ClipMatrices),
    /// For [`System::Pbrt`].
    Pbrt(Pbrt),
    /// For [`System::Mitsuba`].
    Mitsuba(Mitsuba),
    /// For [`System::Blender`].
    Blender(Blender),
    /// For [`System::OpenCv`].
    OpenCv(OpenCv),
    /// For [`System::Colmap`].
    Colmap(Colmap),
}

impl Exchanged {
    /// The text for that system, or for a person who programs it.
    pub fn text(&self) -> String {
        match self {
            Exchanged::OpenGl(matrices) => opengl::text(matrices),
            Exchanged::Vulkan(matrices) => vulkan::text(matrices),
            Exchanged::DirectX(matrices) => directx::text(matrices),
            Exchanged::Pbrt(camera) => camera.text(),
            Exchanged::Mitsuba(sensor) => sensor.text(),
            Exchanged::Blender(camera) => camera.text(),
            Exchanged::OpenCv(camera) => camera.text(),
            Exchanged::Colmap(camera) => camera.text(),
        }
    }
}

/// The view's camera in the words of a system.
///
/// # Errors
///
/// What that system cannot express, and depths that are none: see [`ExchangeError`].
///
/// ```
/// use bothways_lab::common::{Camera, View};
/// use bothways_lab::exchange::{self, Exchanged, StatedDepths, System};
/// use bothways_lab::scenes;
///
/// let loaded = scenes::load("canonical")?;
/// let camera = Camera::new(loaded.camera)?;
/// let view = View::new(&loaded.scene, &camera);
/// let exchanged = exchange::exchange(&view, System::OpenCv, StatedDepths::default())?;
/// let Exchanged::OpenCv(camera) = exchanged else { panic!("it was asked for") };
/// // The first pixel's middle is at (0, 0) there.
/// assert_eq!(camera.k[0], [480.0, 0.0, 239.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn exchange(
    view: &View,
    system: System,
    depths: StatedDepths,
) -> Result<Exchanged, ExchangeError> {
    Ok(match system {
        System::OpenGl => Exchanged::OpenGl(opengl::matrices(view, depths)?),
        System::Vulkan => Exchanged::Vulkan(vulkan::matrices(view, depths)?),
        System::DirectX => Exchanged::DirectX(directx::matrices(view, depths)?),
        System::Pbrt => Exchanged::Pbrt(Pbrt::new(view.camera, depths)?),
        System::Mitsuba => Exchanged::Mitsuba(Mitsuba::new(view, depths)?),
        System::Blender => Exchanged::Blender(Blender::new(view, depths)?),
        System::OpenCv => Exchanged::OpenCv(OpenCv::new(view.camera, depths)?),
        System::Colmap => Exchanged::Colmap(Colmap::new(view.camera, depths)?),
    })
}
