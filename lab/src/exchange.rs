//! A camera in the words of another system, to draw the same picture there.
//!
//! Every number is an `f64` that is exact up to its last roundings, and every text is one to paste or to pipe into a
//! file of that system. What a system cannot express is an error, never a picture that is nearly the same: see
//! [`ExchangeError`]. A [`Camera`] has an orthonormal frame, also where a scene states one that
//! is a little skew, so that no system needs more than a rotation.
//!
//! Pixel `(i, j)` of ours has its middle at `(j + ½, i + ½)`, counted from the upper left corner, rightwards and
//! downwards; each file here says where the other system puts it.

mod blender;
mod clip;
mod colmap;
mod depths;
mod directx;
mod error;
mod mitsuba;
mod opencv;
mod opengl;
mod pbrt;
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

use crate::common::{Camera, View};
use serde::Serialize;

/// A system that a camera can be written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum System {
    /// OpenGL: matrices for columns, depths from −1 to 1.
    OpenGl,
    /// Vulkan: matrices for columns, `y` down, depths from 0 to 1.
    Vulkan,
    /// Direct3D: matrices for rows, right-handed, depths from 0 to 1.
    DirectX,
    /// pbrt, version 4: a part of a scene file.
    Pbrt,
    /// Mitsuba 3: a sensor in XML.
    Mitsuba,
    /// Blender: a Python script.
    Blender,
    /// OpenCV: `K`, `R` and `t`.
    OpenCv,
    /// COLMAP: a line of `cameras.txt` and one of `images.txt`.
    Colmap,
}

impl System {
    /// All systems.
    pub const ALL: [System; 8] = [
        System::OpenGl,
        System::Vulkan,
        System::DirectX,
        System::Pbrt,
        System::Mitsuba,
        System::Blender,
        System::OpenCv,
        System::Colmap,
    ];

    /// The name, as its makers write it.
    pub fn name(self) -> &'static str {
        match self {
            System::OpenGl => "OpenGL",
            System::Vulkan => "Vulkan",
            System::DirectX => "DirectX",
            System::Pbrt => "pbrt",
            System::Mitsuba => "Mitsuba",
            System::Blender => "Blender",
            System::OpenCv => "OpenCV",
            System::Colmap => "COLMAP",
        }
    }
}

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

/// How much wider than high a pixel of the camera's image is: 1 for a square.
fn pixel_aspect(camera: &Camera) -> f64 {
    let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
    vw * height / (vh * width)
}

/// Whether the pixels are squares, as far as a viewport of two `f32` can say it: each of them is rounded by up to 2⁻²⁴.
fn has_square_pixels(camera: &Camera) -> bool {
    (pixel_aspect(camera) - 1.0).abs() <= (-22f64).exp2()
}

/// The number with the fewest digits that read back as the same number, never `-0.0`. All systems here read it.
fn number(number: f64) -> String {
    format!("{:?}", number + 0.0)
}

/// Numbers with something between them.
fn numbers(numbers: &[f64], between: &str) -> String {
    numbers.iter().map(|value| number(*value)).collect::<Vec<_>>().join(between)
}
