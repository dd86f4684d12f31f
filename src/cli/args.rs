//! The options of `render`, and how their values are read.

use super::failure::Failure;
use bothways::common::glam::Vec3;
use bothways::common::raster::{MAX_SAMPLES, MAX_SIDE};
use bothways::common::{Crop, Options, Projection, Scene};
use bothways::formats::source::Reach;
use bothways::orders::{Method, Order, Rules};
use bothways::rules::{ParseRuleError, image_order, object_order};
use bothways::scenes::{LoadError, LoadOptions, LoadedScene, load_with};
use bothways::wording::{count, grouped};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// What to render, how, and where to.
#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    /// A built-in scene, a .toml scene file, or a mesh file (.obj, .ply, .stl, .gltf or .glb, framed automatically)
    #[arg(default_value = "lecture")]
    pub(super) scene: String,
    #[command(flatten)]
    pub(super) files: FilesArgs,
    #[command(flatten)]
    pub(super) camera: CameraArgs,
    #[command(flatten)]
    pub(super) method: MethodArgs,
    #[command(flatten)]
    pub(super) output: OutputArgs,
}

/// Which files a scene may name.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct FilesArgs {
    /// Read files outside of the scene's folder, too: meshes, materials, pictures and buffers that the scene, or a mesh,
    /// names. Without it they are refused
    #[arg(long)]
    pub(super) allow_outside: bool,
}

impl FilesArgs {
    /// How to load a scene; a mesh is framed for an image of this size.
    pub(super) fn options(self, image: Option<[u32; 2]>) -> LoadOptions {
        let reach = if self.allow_outside { Reach::Anywhere } else { Reach::Folder };
        LoadOptions { image, reach }
    }

    /// Loads a scene; a mesh is framed for an image of this size.
    pub(super) fn load(
        self,
        source: &str,
        image: Option<[u32; 2]>,
    ) -> Result<LoadedScene, LoadError> {
        load_with(source, self.options(image))
    }

    /// The same for what looks at each primitive of a scene: a scene of wide ids has too many.
    pub(super) fn load_narrow(
        self,
        source: &str,
        image: Option<[u32; 2]>,
        what: &str,
    ) -> Result<LoadedScene, Failure> {
        let loaded = self.load(source, image)?;
        check_narrow(&loaded.scene, &loaded.name, what)?;
        Ok(loaded)
    }
}

/// Refuses a scene of more primitives than have ids of 32 bits.
pub(super) fn check_narrow(scene: &Scene, name: &str, what: &str) -> Result<(), Failure> {
    if !scene.has_wide_ids() {
        return Ok(());
    }
    Err(Failure::new(format!(
        "{name} has {} primitives with all instances, and {what} at most {}; leave some instances out",
        grouped(scene.primitive_count()),
        grouped(u64::from(u32::MAX) - 1)
    )))
}

/// What to change in the scene's camera.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Camera")]
pub(super) struct CameraArgs {
    /// The image in pixels; the viewport keeps its height, and gets the image's form unless the
    /// scene states a viewport
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true)]
    pub(super) size: Option<[u32; 2]>,
    /// Perspective or parallel; eye and frame stay, and the viewport is scaled so that what
    /// is looked at keeps its size (unless --viewport is given)
    #[arg(long, value_enum)]
    pub(super) projection: Option<ProjectionArg>,
    /// The eye
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(super) eye: Option<Vec3>,
    /// The point in the middle of the picture
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(super) look_at: Option<Vec3>,
    /// Which way is up
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub(super) up: Option<Vec3>,
    /// From the eye to the viewport
    #[arg(long, value_name = "D", value_parser = number, allow_hyphen_values = true)]
    pub(super) distance: Option<f32>,
    /// The viewport's width and height
    #[arg(long, value_name = "VW,VH", value_parser = pair, allow_hyphen_values = true)]
    pub(super) viewport: Option<[f32; 2]>,
    /// The vertical field of view, instead of a viewport: its height at the distance, and the width
    /// that the image's form asks for
    #[arg(long, value_name = "DEGREES", value_parser = number, allow_hyphen_values = true,
          conflicts_with = "viewport")]
    pub(super) fov: Option<f32>,
}

/// How to render.
#[derive(Debug, Args)]
#[command(next_help_heading = "Method")]
pub(super) struct MethodArgs {
    /// Which order to render in
    #[arg(long, value_enum, default_value_t = OrderArg::Both)]
    pub(super) order: OrderArg,
    /// The fast renderer, or the lecture's double loop
    #[arg(long, value_enum, default_value_t = MethodArg::Fast)]
    pub(super) method: MethodArg,
    /// Give object order the rules of an ordinary rasterizer, to see what they get wrong; 'bothways rules' lists them
    #[arg(long, value_name = "RULE", default_value = "exact",
          value_parser = rules::<object_order::Rule>)]
    pub(super) object_rules: RulesArg<object_order::Rule>,
    /// Give image order the rules of an ordinary ray tracer
    #[arg(long, value_name = "RULE", default_value = "exact",
          value_parser = rules::<image_order::Rule>)]
    pub(super) image_rules: RulesArg<image_order::Rule>,
    /// Samples a pixel: an N×N regular grid
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = from_1,
          allow_negative_numbers = true)]
    pub(super) samples: u32,
    /// Render this part of the image alone: its first row and column, counted from 0, and how many rows
    /// and columns. The output has its size; pixels keep their numbers and their bits
    #[arg(long, value_name = "ROW,COLUMN,HEIGHT,WIDTH", value_parser = crop,
          allow_hyphen_values = true)]
    pub(super) crop: Option<Crop>,
    /// Threads to render with; all cores if not given
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    pub(super) threads: Option<u16>,
    /// Draw a mesh file that may be larger than memory: only its vertices are kept, its faces are read in passes
    /// (with --order object; flat normals)
    #[arg(long)]
    pub(super) stream: bool,
    /// Answer N samples by the textbook as well (exact ties, silhouettes and edges first, the rest anywhere), and
    /// fail with exit code 1 if it sees otherwise: a proof on scenes that are too large for --method textbook
    #[arg(long, value_name = "N", value_parser = from_1, allow_negative_numbers = true,
          conflicts_with = "stream")]
    pub(super) verify: Option<u32>,
    /// Render N times after a warm-up, and report the spread of times
    #[arg(long, value_name = "N", value_parser = from_1, allow_negative_numbers = true)]
    pub(super) repeat: Option<u32>,
}

impl MethodArgs {
    /// The options for both orders.
    pub(super) fn options(&self) -> Options {
        Options { samples: self.samples, crop: self.crop }
    }

    /// The rules of both orders.
    pub(super) fn rules(&self) -> Rules {
        Rules { object_order: self.object_rules.rule(), image_order: self.image_rules.rule() }
    }
}

/// What to write, and where.
#[derive(Debug, Args)]
#[command(next_help_heading = "Output")]
pub(super) struct OutputArgs {
    /// The folder to write into [default: out/NAME]. It shows one run: files of an earlier run that
    /// this one does not write are removed, other files are left alone
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub(super) folder: Option<PathBuf>,
    /// Also write what each order saw at every sample, for other programs to read
    #[arg(long, value_enum, default_value_t = BuffersArg::None)]
    pub(super) buffers: BuffersArg,
    /// Write only these of the files, separated by commas, and draw only what they need; buffers as --buffers says. The
    /// work of the algorithm is counted only for the report (also that of --json) and the slide
    #[arg(long, value_name = "WHAT", value_enum, value_delimiter = ',')]
    pub(super) only: Vec<OnlyArg>,
    /// Leave measured times out, so that every run writes the same
    #[arg(long)]
    pub(super) no_times: bool,
    /// Leave the work of the algorithm uncounted. It is counted in a frame of its own, which takes longer than those
    /// that are timed; beyond 2^28 steps and 2^10 a sample that is given up. What a timed frame executed is counted in
    /// that frame
    #[arg(long)]
    pub(super) no_counts: bool,
    /// Print nothing but errors
    #[arg(long, conflicts_with = "json")]
    pub(super) quiet: bool,
    /// Print the report as JSON instead of the table
    #[arg(long)]
    pub(super) json: bool,
}

impl OutputArgs {
    /// Whether this file is to be written.
    pub(super) fn wants(&self, what: OnlyArg) -> bool {
        self.only.is_empty() || self.only.contains(&what)
    }

    /// Whether the work of the algorithm is to be counted.
    pub(super) fn counts(&self) -> bool {
        let shown = self.json
            || [OnlyArg::Report, OnlyArg::Slide].map(|what| self.wants(what)) != [false; 2];
        shown && !self.no_counts
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum OnlyArg {
    /// The picture of each order, object-order.png and image-order.png
    Picture,
    /// The coverage of each order, mask-object-order.png and mask-image-order.png
    Mask,
    /// Where the orders differ, difference.png
    Difference,
    /// Both orders side by side, side-by-side.png
    Slide,
    /// All numbers, report.json
    Report,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ProjectionArg {
    Perspective,
    Parallel,
}

impl From<ProjectionArg> for Projection {
    fn from(projection: ProjectionArg) -> Self {
        match projection {
            ProjectionArg::Perspective => Projection::Perspective,
            ProjectionArg::Parallel => Projection::Parallel,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum OrderArg {
    /// One after the other, and compared
    Both,
    /// Object order alone: rasterization
    Object,
    /// Image order alone: ray tracing
    Image,
}

impl OrderArg {
    pub(super) fn orders(self) -> &'static [Order] {
        match self {
            OrderArg::Both => &[Order::Object, Order::Image],
            OrderArg::Object => &[Order::Object],
            OrderArg::Image => &[Order::Image],
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum MethodArg {
    /// With bounds and hierarchies that skip what cannot matter
    Fast,
    /// Every primitive at every sample: slow, and readable in five minutes
    Textbook,
}

impl From<MethodArg> for Method {
    fn from(method: MethodArg) -> Self {
        match method {
            MethodArg::Fast => Method::Fast,
            MethodArg::Textbook => Method::Textbook,
        }
    }
}

/// The rules of one order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RulesArg<R> {
    Exact,
    Ordinary(R),
}

impl<R> RulesArg<R> {
    pub(super) fn rule(self) -> Option<R> {
        match self {
            RulesArg::Exact => None,
            RulesArg::Ordinary(rule) => Some(rule),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum BuffersArg {
    /// No buffers
    None,
    /// NumPy arrays, .npy: ids and distances of each order, and pictures coloured by id
    Npy,
    /// One EXR file, buffers.exr, with layers for each order: colours, normals, depths, t, ids (and as colours), coverage
    /// and work. Several samples a pixel make it so many times as wide and high: nothing is averaged
    Exr,
}

pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) =
        text.split_once(['x', 'X']).ok_or("write it as WIDTHxHEIGHT, such as 640x480")?;
    let (width, height) = (side(width)?, side(height)?);
    if u64::from(width) * u64::from(height) > MAX_SAMPLES {
        return Err(format!("an image may have at most {MAX_SAMPLES} samples (2^30)"));
    }
    Ok([width, height])
}

fn side(text: &str) -> Result<u32, String> {
    if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err(format!("'{text}' is not a number of pixels; write it like 640x480"));
    }
    // A number with too many digits for a u32 also means too many pixels.
    match text.parse().unwrap_or(u32::MAX) {
        0 => Err("both sides need at least 1 pixel".into()),
        pixels if pixels > MAX_SIDE => {
            Err(format!("a side may have at most {MAX_SIDE} pixels (2^16)"))
        }
        pixels => Ok(pixels),
    }
}

/// A whole number from 1.
pub(super) fn from_1(text: &str) -> Result<u32, String> {
    let most = u32::MAX;
    match text.parse() {
        Ok(number @ 1..) => Ok(number),
        _ => Err(format!("give a whole number from 1 to {most}")),
    }
}

/// `exact`, or a rule of an ordinary renderer.
pub(super) fn rules<R: FromStr<Err = ParseRuleError>>(
    text: &str,
) -> Result<RulesArg<R>, ParseRuleError> {
    match text {
        "exact" => Ok(RulesArg::Exact),
        rule => rule.parse().map(RulesArg::Ordinary),
    }
}

/// Four numbers of pixels. This function does not check whether the image has these pixels.
pub(super) fn crop(text: &str) -> Result<Crop, String> {
    let whole = |number: &str| {
        let digits = number.trim();
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(format!("'{number}' is not a whole number from 0; give {CROP}"));
        }
        // The only remaining error is too many digits.
        digits.parse::<u32>().map_err(|_| {
            format!("{digits} is out of range; an image has at most {MAX_SIDE} rows and columns")
        })
    };
    let numbers = text.split(',').map(whole).collect::<Result<Vec<u32>, String>>()?;
    let given = count(numbers.len() as u64, "numbers");
    let four = <[u32; 4]>::try_from(numbers);
    four.map(Crop::from).map_err(|_| format!("it has {given}, but needs four; give {CROP}"))
}

/// The format of a crop.
const CROP: &str = "ROW,COLUMN,HEIGHT,WIDTH in pixels of the image, such as 100,200,48,64";

/// A row or a column.
pub(super) fn from_0(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "give a whole number; pixels are counted from 0".into())
}

/// A number of threads, up to the number of cores of a large machine.
pub(super) fn threads(text: &str) -> Result<u16, String> {
    match text.parse() {
        Ok(number @ 1..=1024) => Ok(number),
        _ => Err("give a whole number from 1 to 1024".into()),
    }
}

fn vector(text: &str) -> Result<Vec3, String> {
    numbers(text, "three, such as 1,-2,0.5").map(Vec3::from_array)
}

pub(super) fn pair(text: &str) -> Result<[f32; 2], String> {
    numbers(text, "two, such as 1.6,1")
}

fn numbers<const N: usize>(text: &str, expected: &str) -> Result<[f32; N], String> {
    let numbers = text.split(',').map(number).collect::<Result<Vec<f32>, String>>()?;
    let given = numbers.len();
    numbers
        .try_into()
        .map_err(|_| format!("it has {}, but needs {expected}", count(given as u64, "numbers")))
}

pub(super) fn number(text: &str) -> Result<f32, String> {
    let text = text.trim();
    let number: f32 = text.parse().map_err(|_| format!("'{text}' is not a number"))?;
    if number.is_finite() {
        Ok(number)
    } else if text.bytes().any(|byte| byte.is_ascii_digit()) {
        Err(format!("{text} is out of range; numbers go up to 3.4e38"))
    } else {
        Err(format!("{text} is not a finite number"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_width_by_height() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert_eq!(size("1X65536"), Ok([1, 65_536]));
        for bad in ["640", "x", "640x", "-1x4", "4x4x4", "1.5x2", " 4x4", "+4x4"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_beyond_the_limits_name_them() {
        let problem = |text| size(text).unwrap_err();
        assert_eq!(problem("0x4"), "both sides need at least 1 pixel");
        assert_eq!(problem("65537x1"), "a side may have at most 65536 pixels (2^16)");
        assert_eq!(problem("1x99999999999999999999"), problem("65537x1"));
        let many = "an image may have at most 1073741824 samples (2^30)";
        assert_eq!(problem("65536x65536"), many);
    }

    #[test]
    fn crops_are_four_whole_numbers() {
        assert_eq!(crop("1,2,3,4"), Ok(Crop { row: 1, column: 2, height: 3, width: 4 }));
        assert_eq!(
            crop(" 0, 0, 1, 65536"),
            Ok(Crop { row: 0, column: 0, height: 1, width: 65_536 })
        );
        for bad in ["", ",", "1,2,3", "1,2,3,4,5", "1;2;3;4", "1,2,3,+4", "-1,2,3,4", "1,2,3,4.0"] {
            assert!(crop(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn vectors_are_three_finite_numbers() {
        assert_eq!(vector("1,-2.5, 3e2"), Ok(Vec3::new(1.0, -2.5, 300.0)));
        let problem = |text| vector(text).unwrap_err();
        assert_eq!(problem("1,2"), "it has 2 numbers, but needs three, such as 1,-2,0.5");
        assert_eq!(problem("1,2,x"), "'x' is not a number");
        assert_eq!(problem("1,NaN,3"), "NaN is not a finite number");
        assert_eq!(problem("1,2,-inf"), "-inf is not a finite number");
        assert_eq!(problem("1e39,2,3"), "1e39 is out of range; numbers go up to 3.4e38");
    }
}
