//! `bothways pixel`: the viewing ray of one pixel, derived; the primitives that cover the pixel; the results of both
//! orders.

use super::args::{CameraArgs, FilesArgs, from_0, from_1};
use super::camera::camera;
use super::failure::Failure;
use super::terminal;
use bothways::common::raster::check_samples;
use bothways::common::{Options, View};
use bothways::pixel::{self, Lesson};
use clap::Args;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
ROW counts from the top, COLUMN from the left, both from 0.

Examples:
  bothways pixel lecture 240 320                the middle of the lecture's scene
  bothways pixel ties 8 8 --size 16x16          ties, and how they are broken
  bothways pixel lecture 240 320 --samples 4    all samples of the pixel, the first one derived
  bothways pixel canonical 100 200 --json       for a program to read

Exit codes: 0 both orders see what is true, 1 they do not, 2 something went wrong.";

/// Which pixel.
#[derive(Debug, Args)]
pub(super) struct PixelArgs {
    /// A built-in scene, a .toml scene file, or a mesh file (framed automatically)
    scene: String,
    /// The pixel's row from the top, counted from 0
    #[arg(value_parser = from_0, allow_negative_numbers = true)]
    row: u32,
    /// The pixel's column from the left, counted from 0
    #[arg(value_parser = from_0, allow_negative_numbers = true)]
    column: u32,
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
    /// Samples a pixel: an N×N regular grid; the first one's ray is derived
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = from_1,
          allow_negative_numbers = true)]
    samples: u32,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Computes the true result, renders and prints; the exit code is 0 if both orders saw the true primitives.
pub(super) fn run(args: &PixelArgs) -> Result<ExitCode, Failure> {
    let loaded = args.files.load(&args.scene, args.camera.size)?;
    terminal::warn(&loaded.warnings);
    let camera = camera(&loaded, &args.camera)?;
    check_samples(camera.image(), args.samples)
        .map_err(|error| Failure::new(format!("--samples {}: {error}", args.samples)))?;
    let (i, j, [width, height]) = (args.row, args.column, camera.image());
    if i >= height || j >= width {
        return Err(Failure::new(format!(
            "there is no pixel ({i}, {j}) in an image of {width}x{height}: ROW goes from 0 to {}, \
             COLUMN from 0 to {}",
            height - 1,
            width - 1
        )));
    }
    let view = View::new(&loaded.scene, &camera);
    let samples =
        pixel::report(&view, &Options { samples: args.samples, ..Options::default() }, i, j);
    let (along, pixel) = (args.samples, [i, j]);
    let lesson = Lesson { scene: &loaded.name, camera: &camera, pixel, along, samples: &samples };
    if args.json { terminal::print_json(&lesson) } else { terminal::print(&lesson.text()) }?;
    Ok(ExitCode::from(u8::from(!lesson.agrees())))
}
