//! What to compare, and how.

use super::inputs::{InputArgs, SceneArgs};
use super::options::ComparisonArgs;
use crate::cli::color::color;
use clap::Args;
use std::path::PathBuf;

pub(in crate::cli) const EXAMPLES: &str = "\
Examples:
  bothways render canonical --buffers npy                      writes ids and t, for what follows
  bothways diff out/canonical/object-order.ids.npy mine.npy    ids: the same primitives?
  bothways diff out/canonical/object-order.t.npy mine-t.npy    distances, within 1e-5 of t
  bothways diff out/canonical/mask-object-order.png mine.png   coverage
  bothways diff yours.png mine.png --background '#101418'      colours, and what is not background
  bothways diff a.npy b.npy -o out/diff                        writes out/diff/difference.png
  bothways diff t.npy mine.exr --channels Z --depth axis --scene canonical
                                          a depth along the axis, as t
  bothways diff a.png b.png --allow-pixels 3 --ignore 0,0,20,640
                                          equal enough, but for the first 20 rows
  bothways diff a.png b.png --html out/diff.html
                                          a page: slider, blink, zoom, values
  bothways diff mine out/vectors          a whole folder: each NAME.png or NAME.npy of mine, and
                                          which scenes it lacks

Files:
  PNG, PNM or BMP    one channel: a mask or grey picture, covered where it is not 0;
                     with alpha: covered where alpha is not 0; RGB: colours alone
  JPEG               the same, with a warning: JPEG changes pixels
  NPY, H x W         bool: a mask; integers: ids, all ones (or -1) for nothing;
                     floats: distances t, infinity (or NaN) for nothing;
                     with N x N samples a pixel, H x W x N x N
  NPY, H x W x 3|4   colours in sRGB: uint8, uint16, or floats from 0 to 1;
                     three floats of unit length, some negative: normals
  EXR                R, G, B and A: colours, linear, brought to sRGB; a single channel, or one of
                     a known name: distances (Z, depth), ids (id, object_id), normals (normal.X)

Coverage and ids are compared exactly; distances, normals and colours within tolerances.
Measures such as intersection over union, PSNR and SSIM are told, but never decide: one wrong
pixel changes them little.

Of two folders, files of the same name are compared; beside a conformance set (bothways vectors),
those that begin with a scene's name, by what is in them: ids, distances or a mask. --depth takes
the scenes of the set.

Exit codes: 0 equal in everything compared (or equal enough), 1 something differs or lacks its
partner, 2 something went wrong.";

/// What to compare.
#[derive(Debug, Args)]
pub(in crate::cli) struct DiffArgs {
    /// A mask, a picture or a buffer; or a folder of them
    pub(super) a: PathBuf,
    /// Another one of the same size; or another folder
    pub(super) b: PathBuf,
    /// The folder to write difference.png into (of two folders, NAME.difference.png of each pair that
    /// differs); without it, nothing is written
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub(super) folder: Option<PathBuf>,
    /// The colour of what is not covered, in pictures that have no alpha, such as #101418
    #[arg(long, value_name = "COLOR", value_parser = color)]
    pub(super) background: Option<[u8; 3]>,
    /// Write the comparison as a page for a browser: slider, blink, linked zoom, values, a filter; - is
    /// standard output
    #[arg(long, value_name = "FILE.html")]
    pub(super) html: Option<PathBuf>,
    /// Print the comparison as JSON
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    pub(super) comparison: ComparisonArgs,
    #[command(flatten)]
    pub(super) inputs: InputArgs,
    #[command(flatten)]
    pub(super) scene: SceneArgs,
    /// Tell of this pixel alone why it differs: its row and column, counted from 0
    #[arg(long, value_name = "ROW,COLUMN", value_parser = pixel, requires = "scene",
          conflicts_with = "json", allow_hyphen_values = true, help_heading = "Scene")]
    pub(super) pixel: Option<[u32; 2]>,
}

/// A row and a column.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    let numbers = text.split_once(',').map(|(row, column)| [number(row), number(column)]);
    match numbers {
        Some([Some(row), Some(column)]) => Ok([row, column]),
        _ => Err("write a row and a column, such as 12,40; both count from 0".into()),
    }
}
