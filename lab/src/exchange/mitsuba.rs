//! Mitsuba 3: a sensor, as a part of a scene in XML.
//!
//! Its camera looks along `+z` with `+x` to the left and `+y` up. The film counts from the upper left, pixel middles at ½,
//! and its pixels are squares. The orthographic camera sees `x` from −1 to 1, and `to_world` may scale it, each axis by
//! itself; the perspective one refuses a scale (Mitsuba 3 documentation, "Sensors").

use super::aspect::has_square_pixels;
use super::depths::StatedDepths;
use super::error::ExchangeError;
use super::numbers::{number, numbers};
use super::system::System;
use crate::common::{Projection, View};
use crate::opengl::Matrix;
use serde::Serialize;

/// A sensor of Mitsuba.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mitsuba {
    /// The plugin: `perspective` or `orthographic`.
    #[serde(rename = "type")]
    pub plugin: &'static str,
    /// `fov` in degrees, along the axis `x`, for a perspective camera.
    pub fov: Option<f64>,
    /// `fov_axis`, for a perspective camera: `x`.
    pub fov_axis: Option<&'static str>,
    /// `near_clip`, the depth of the near plane.
    pub near_clip: f64,
    /// `far_clip`, the depth of the far plane.
    pub far_clip: f64,
    /// `to_world`, as rows, for columns.
    pub to_world: Matrix,
    /// The film's `width` and `height` in pixels.
    pub film: [u32; 2],
}

impl Mitsuba {
    pub(super) fn new(view: &View, depths: StatedDepths) -> Result<Mitsuba, ExchangeError> {
        let camera = view.camera;
        let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
        let (plugin, fov, [across, upward]) = match camera.projection() {
            Projection::Perspective if !has_square_pixels(camera) => {
                return Err(ExchangeError::not_square(System::Mitsuba, camera));
            }
            Projection::Perspective => {
                let fov = 2.0 * (vw / 2.0).atan2(camera.distance()).to_degrees();
                ("perspective", Some(fov), [1.0, 1.0])
            }
            // Without a scale, y goes from −H/W to H/W.
            Projection::Parallel => ("orthographic", None, [vw / 2.0, vh / 2.0 * width / height]),
        };
        let [near_clip, far_clip] = depths.finite(view, 0.0, "Mitsuba's lies before the eye")?;
        let (left, up, forward) = (-across * camera.u(), upward * camera.v(), -camera.w());
        let eye = camera.eye().as_dvec3();
        let row = |axis: usize| [left[axis], up[axis], forward[axis], eye[axis]].map(|x| x + 0.0);
        Ok(Mitsuba {
            plugin,
            fov,
            fov_axis: fov.map(|_| "x"),
            near_clip,
            far_clip,
            to_world: [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]],
            film: camera.image(),
        })
    }

    pub(super) fn text(&self) -> String {
        let [width, height] = self.film;
        let float = |name: &str, value| {
            format!("    <float name=\"{name}\" value=\"{}\"/>\n", number(value))
        };
        let fov = self.fov.map_or(String::new(), |fov| {
            "    <string name=\"fov_axis\" value=\"x\"/>\n".to_owned() + &float("fov", fov)
        });
        let planes = float("near_clip", self.near_clip) + &float("far_clip", self.far_clip);
        let matrix = self.to_world.map(|row| numbers(&row, " ")).join("\n                       ");
        format!(
            "<!-- The camera of Mitsuba 3. Its rays begin at the near plane and end at the far plane. -->\n\
             <sensor type=\"{}\">\n{fov}{planes}    <transform name=\"to_world\">\n        \
                 <matrix value=\"{matrix}\"/>\n    </transform>\n    <film type=\"hdrfilm\">\n        \
                 <integer name=\"width\" value=\"{width}\"/>\n        \
                 <integer name=\"height\" value=\"{height}\"/>\n    </film>\n</sensor>\n",
            self.plugin
        )
    }
}
