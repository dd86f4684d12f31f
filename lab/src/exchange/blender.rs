//! Blender: a Python script that adds the camera to the open file.
//!
//! Its camera looks along its own `−z` with `+x` to the right and `+y` up, as ours. With a horizontal fit the sensor's
//! width, seen at the distance of the lens, or `ortho_scale` is the viewport's width; the height follows from the
//! resolution and the form of a pixel (Blender 4.5, Python API, `Camera` and `RenderSettings`, and
//! `BKE_camera_params_compute_viewplane`).

use super::aspect::{has_square_pixels, pixel_aspect};
use super::depths::StatedDepths;
use super::error::ExchangeError;
use super::numbers::{number, numbers};
use crate::common::{Camera, Projection, View};
use crate::opengl::Matrix;
use serde::Serialize;

/// A camera of Blender, by the names of its properties.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Blender {
    /// `PERSP` or `ORTHO`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// `HORIZONTAL`: the widths below are those of the picture.
    pub sensor_fit: &'static str,
    /// In millimetres, for a perspective camera.
    pub sensor_width: Option<f64>,
    /// The focal length in millimetres, for a perspective camera.
    pub lens: Option<f64>,
    /// The width of what a parallel camera sees.
    pub ortho_scale: Option<f64>,
    /// The picture's middle lies on the axis: both are 0.
    pub shift: [f64; 2],
    /// The depth of the near plane.
    pub clip_start: f64,
    /// The depth of the far plane.
    pub clip_end: f64,
    /// The location and the axes of the camera as an object: rows, for columns.
    pub matrix_world: Matrix,
    /// `resolution_x` and `resolution_y` of the scene's render settings.
    pub resolution: [u32; 2],
    /// `pixel_aspect_x` and `pixel_aspect_y` of the scene's render settings; the smaller one is 1.
    pub pixel_aspect: [f64; 2],
}

/// Full frame, what Blender begins with.
const SENSOR_WIDTH: f64 = 36.0;

/// What Blender raises a smaller near plane to, without a word.
const LEAST_NEAR: f64 = 1e-6;

impl Blender {
    pub(super) fn new(view: &View, depths: StatedDepths) -> Result<Blender, ExchangeError> {
        let camera = view.camera;
        let [width, height] = camera.image();
        if width < 4 || height < 4 {
            return Err(ExchangeError::SmallImage { width, height });
        }
        let [vw, _] = camera.viewport();
        let (kind, lens, ortho_scale) = match camera.projection() {
            // No lens is shorter than 1 mm; a wider sensor sees as much.
            Projection::Perspective => {
                let lens = SENSOR_WIDTH * camera.distance() / vw;
                let sensor = if lens < 1.0 { vw / camera.distance() } else { SENSOR_WIDTH };
                ("PERSP", Some([lens.max(1.0), sensor]), None)
            }
            Projection::Parallel => ("ORTHO", None, Some(vw)),
        };
        let [clip_start, clip_end] =
            depths.finite(view, LEAST_NEAR, "Blender's is at 0.000001 at least")?;
        let (u, v, w, eye) = (camera.u(), camera.v(), camera.w(), camera.eye().as_dvec3());
        let row = |axis: usize| [u[axis], v[axis], w[axis], eye[axis]].map(|x| x + 0.0);
        Ok(Blender {
            kind,
            sensor_fit: "HORIZONTAL",
            sensor_width: lens.map(|[_, sensor]| sensor),
            lens: lens.map(|[lens, _]| lens),
            ortho_scale,
            shift: [0.0, 0.0],
            clip_start,
            clip_end,
            matrix_world: [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]],
            resolution: [width, height],
            pixel_aspect: aspects(camera)?,
        })
    }

    pub(super) fn text(&self) -> String {
        let optional = |name: &str, value: Option<f64>| {
            value.map_or(String::new(), |value| format!("data.{name} = {}\n", number(value)))
        };
        let size = optional("sensor_width", self.sensor_width)
            + &optional("lens", self.lens)
            + &optional("ortho_scale", self.ortho_scale);
        let matrix =
            self.matrix_world.map(|row| format!("    ({}),\n", numbers(&row, ", "))).concat();
        let [width, height] = self.resolution;
        let [[shift_x, shift_y], [aspect_x, aspect_y]] =
            [self.shift, self.pixel_aspect].map(|pair| pair.map(number));
        format!(
            "# Blender, for its Python console. Coordinates are those of the scene: import meshes without turning\n\
             # them (forward Y, up Z). What is beyond clip_start and clip_end is cut off.\n\
             import bpy\n\
             from mathutils import Matrix\n\n\
             data = bpy.data.cameras.new(\"bothways\")\n\
             data.type = '{}'\n\
             data.sensor_fit = '{}'\n\
             {size}data.shift_x = {shift_x}\n\
             data.shift_y = {shift_y}\n\
             data.clip_start = {}\n\
             data.clip_end = {}\n\n\
             camera = bpy.data.objects.new(\"bothways\", data)\n\
             camera.matrix_world = Matrix((\n{matrix}))\n\n\
             scene = bpy.context.scene\n\
             scene.collection.objects.link(camera)\n\
             scene.camera = camera\n\
             scene.render.resolution_x = {width}\n\
             scene.render.resolution_y = {height}\n\
             scene.render.resolution_percentage = 100\n\
             scene.render.pixel_aspect_x = {aspect_x}\n\
             scene.render.pixel_aspect_y = {aspect_y}\n",
            self.kind,
            self.sensor_fit,
            number(self.clip_start),
            number(self.clip_end),
        )
    }
}

/// The sides of a pixel, of which Blender wants the shorter one to be 1.
fn aspects(camera: &Camera) -> Result<[f64; 2], ExchangeError> {
    let aspect = pixel_aspect(camera);
    let sides = match aspect {
        _ if has_square_pixels(camera) => [1.0, 1.0],
        aspect if aspect > 1.0 => [aspect, 1.0],
        aspect => [1.0, 1.0 / aspect],
    };
    if sides[0].max(sides[1]) > 200.0 {
        return Err(ExchangeError::LongPixels { aspect });
    }
    Ok(sides)
}
