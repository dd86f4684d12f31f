//! `bothways camera`: a scene's camera in numbers, for other renderers.

use super::args::{CameraArgs, FilesArgs, number};
use super::camera::camera;
use super::failure::Failure;
use super::terminal;
use bothways::common::glam::Vec3;
use bothways::common::{Projection, View};
use bothways::exchange::{self, Exchanged, StatedDepths, System};
use bothways::opengl::{self, Matrices, Matrix};
use bothways::scenes::DEFAULT;
use bothways::wording::{plain, vector};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Examples:
  bothways camera canonical                          the lecture's first camera
  bothways camera bunny.obj                          the camera that frames a mesh
  bothways camera --projection parallel --json       for a program to read
  bothways camera scene.toml --eye 0,1,4 --size 64x64
  bothways camera lecture --as blender               the same camera in another program
  bothways camera canonical --as vulkan --near 0.1 --far 100";

/// Which camera.
#[derive(Debug, Args)]
pub(super) struct ShowCameraArgs {
    /// A built-in scene, a .toml scene file, or a mesh file (framed automatically)
    #[arg(default_value = DEFAULT)]
    scene: String,
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print the camera for another system, as text to paste or to pipe into a file; what that
    /// system cannot express is an error
    #[arg(long = "as", value_name = "SYSTEM", value_enum, help_heading = "Exchange")]
    system: Option<SystemArg>,
    /// The depth of the near plane, in lengths of the world, where the system has one; otherwise
    /// as near as possible
    #[arg(long, value_name = "DEPTH", value_parser = number, allow_hyphen_values = true,
          requires = "system", help_heading = "Exchange")]
    near: Option<f32>,
    /// The depth of the far plane; otherwise at infinity, or behind everything
    #[arg(long, value_name = "DEPTH", value_parser = number, allow_hyphen_values = true,
          requires = "system", help_heading = "Exchange")]
    far: Option<f32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum SystemArg {
    /// View and projection for columns, depths from -1 to 1
    Opengl,
    /// View and projection for columns, y down, depths from 0 to 1
    Vulkan,
    /// View and projection for rows, right-handed, depths from 0 to 1
    Directx,
    /// The head of a pbrt-v4 file, before its world begins
    Pbrt,
    /// A sensor of Mitsuba 3, in XML
    Mitsuba,
    /// A Python script for Blender
    Blender,
    /// K, R and t; pixel middles are whole numbers
    Opencv,
    /// Lines of cameras.txt and images.txt; pixel middles at .5
    Colmap,
}

impl SystemArg {
    fn system(self) -> System {
        match self {
            SystemArg::Opengl => System::OpenGl,
            SystemArg::Vulkan => System::Vulkan,
            SystemArg::Directx => System::DirectX,
            SystemArg::Pbrt => System::Pbrt,
            SystemArg::Mitsuba => System::Mitsuba,
            SystemArg::Blender => System::Blender,
            SystemArg::Opencv => System::OpenCv,
            SystemArg::Colmap => System::Colmap,
        }
    }
}

/// Prints the camera.
pub(super) fn run(args: &ShowCameraArgs) -> Result<ExitCode, Failure> {
    let loaded = args.files.load(&args.scene, args.camera.size)?;
    let camera = camera(&loaded, &args.camera)?;
    let view = View::new(&loaded.scene, &camera);
    if let Some(system) = args.system {
        terminal::print(&exchanged(&loaded.name, &view, system.system(), args)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let report = Report::new(&loaded.name, &view);
    let text = if args.json { terminal::json(&report)? } else { report.text() };
    terminal::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// The text for another system, or with `--json` the same numbers for a program.
fn exchanged(
    scene: &str,
    view: &View,
    system: System,
    args: &ShowCameraArgs,
) -> Result<String, Failure> {
    let depths = StatedDepths { near: args.near.map(f64::from), far: args.far.map(f64::from) };
    let camera = exchange::exchange(view, system, depths)
        .map_err(|error| Failure::new(format!("the camera of '{scene}': {error}")))?;
    if !args.json {
        return Ok(camera.text());
    }
    terminal::json(&ExchangeReport { scene, system: system.name(), camera })
}

/// The output of `--as SYSTEM --json`. All numbers are those of the text.
#[derive(Debug, Serialize)]
struct ExchangeReport<'a> {
    scene: &'a str,
    system: &'static str,
    camera: Exchanged,
}

/// The output of `--json`, in this order. Numbers that the camera stores as `f32` have the fewest digits that read
/// back as the same `f32`.
#[derive(Debug, Serialize)]
struct Report {
    scene: String,
    projection: &'static str,
    eye: [f32; 3],
    u: [f64; 3],
    v: [f64; 3],
    w: [f64; 3],
    distance: f32,
    viewport: [f32; 2],
    image: [u32; 2],
    field_of_view_degrees: Option<[f64; 2]>,
    opengl: OpenGl,
}

/// Matrices as rows.
#[derive(Debug, Serialize)]
struct OpenGl {
    layout: &'static str,
    near: f64,
    far: Option<f64>,
    view: Matrix,
    projection: Matrix,
    projection_reversed_depth: Matrix,
}

impl Report {
    fn new(scene: &str, view: &View) -> Report {
        let camera = view.camera;
        let Matrices { view: camera_from_world, projection, reversed, near, far } =
            opengl::matrices(view);
        Report {
            scene: scene.into(),
            projection: match camera.projection() {
                Projection::Perspective => "perspective",
                Projection::Parallel => "parallel",
            },
            eye: (camera.eye() + Vec3::ZERO).to_array(),
            u: plain(camera.u()),
            v: plain(camera.v()),
            w: plain(camera.w()),
            distance: camera.description().distance,
            viewport: camera.description().viewport,
            image: camera.image(),
            field_of_view_degrees: opengl::field_of_view(view),
            opengl: OpenGl {
                layout: opengl::LAYOUT,
                near,
                far,
                view: camera_from_world,
                projection,
                projection_reversed_depth: reversed,
            },
        }
    }

    fn text(&self) -> String {
        let ([vw, vh], [width, height]) = (self.viewport, self.image);
        let mut text = format!("{}: {} camera\n\n", self.scene, self.projection);
        let mut line = |name: &str, value: String| text += &format!("{name:15}{value}\n");
        line("eye", vector(self.eye));
        line("u (right)", vector(self.u));
        line("v (up)", vector(self.v));
        line("w (back)", vector(self.w));
        line("d", format!("{}", self.distance));
        line("viewport", format!("vw = {vw}, vh = {vh}"));
        line("image", format!("W = {width}, H = {height}"));
        if let Some([across, down]) = self.field_of_view_degrees {
            line("field of view", format!("{across:.3} degrees across, {down:.3} down"));
        }
        text + &self.opengl.text(self.image)
    }
}

impl OpenGl {
    fn text(&self, [width, height]: [u32; 2]) -> String {
        let [near, far] = [Some(self.near), self.far].map(|depth| depth.map(single));
        let far = far.map_or("at infinity".into(), |far| format!("at {far}"));
        let bounds = format!("near plane at {}, far plane {far}", near.unwrap_or_default());
        format!(
            "\n\
             OpenGL, with glViewport(0, 0, {width}, {height}); row i of the picture is its row {last} - i.\n\
             Matrices are row by row, as 32-bit floats; glUniformMatrix4fv wants column by column: pass\n\
             GL_TRUE as its transpose argument, or transpose them.\n\
             \n\
             view (camera_from_world)\n{}\
             \n\
             projection: {bounds}, depths -1 to 1\n{}\
             \n\
             the same with reversed depth, 1 to 0: glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE),\n\
             glDepthFunc(GL_GREATER), glClearDepth(0)\n{}\
             \n\
             This program's rays have no near and no far plane; OpenGL cuts off what is beyond. It also\n\
             rounds vertices to a grid, so that pixels on an edge may differ.\n",
            matrix(&self.view),
            matrix(&self.projection),
            matrix(&self.projection_reversed_depth),
            last = height - 1,
        )
    }
}

/// The number in OpenGL's precision.
#[expect(clippy::cast_possible_truncation, reason = "OpenGL's floats are f32")]
fn single(number: f64) -> f32 {
    number as f32 + 0.0
}

/// The rows of the matrix, with aligned columns.
fn matrix(matrix: &Matrix) -> String {
    let words = matrix.map(|row| row.map(|number| format!("{:?}", single(number))));
    let width = words.as_flattened().iter().map(String::len).max().unwrap_or(0);
    let row = |row: &[String; 4]| {
        let cells = row.iter().map(|word| format!("  {word:>width$}"));
        cells.collect::<String>() + "\n"
    };
    words.iter().map(row).collect()
}
