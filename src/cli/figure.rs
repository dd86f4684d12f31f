//! `bothways figure`: a drawing of what the renderers do with a scene, as SVG or PNG.

use super::args::{CameraArgs, FilesArgs, RulesArg, from_1, rules};
use super::camera::camera;
use super::failure::Failure;
use super::memory;
use super::npy;
use super::output::{OutputFile, Staging};
use super::run::folder_name;
use super::terminal;
use bothways::common::raster::check_samples;
use bothways::common::{Options, View};
use bothways::figure::{Drawing, Kind, Subject, Theme, WorkMap, work_figure, work_maps};
use bothways::formats::scene_file::nearest_name;
use bothways::orders::Rules;
use bothways::rules::{image_order, object_order};
use bothways::scenes::DEFAULT;
use bothways::wording::count;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) fn examples() -> String {
    let mut text = String::from("Kinds:\n");
    for kind in Kind::ALL {
        text += &format!("  {:17}{}\n", kind.name(), kind.about());
    }
    text + EXAMPLES
}

const EXAMPLES: &str = "
Every figure is drawn from a render of the scene. It is 16:9; the same input gives the same bytes.

Examples:
  bothways figure camera                              the lecture's scene, into out/figures
  bothways figure camera lecture -o camera.png        as a PNG, 1920 pixels wide
  bothways figure grid ties --pixel 32,31             the samples around one pixel
  bothways figure camera inside --theme light -o -    SVG to standard output, for white paper
  bothways figure reasons ties --object-rules inclusive";

/// The width of a PNG, if no other is given.
const WIDTH: u32 = 1920;

/// What to draw, and where to.
#[derive(Debug, Args)]
pub(super) struct FigureArgs {
    /// What the figure shows; the kinds are listed below
    #[arg(value_parser = kind)]
    kind: Kind,
    /// A built-in scene, a .toml scene file, or a mesh file (framed automatically)
    #[arg(default_value = DEFAULT)]
    scene: String,
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
    /// The pixel to look at, its row from the top and its column from the left, both from 0; for the kind camera it can
    /// be given several times. If it is left out, the figure chooses a telling one
    #[arg(long, value_name = "ROW,COLUMN", value_parser = pixel, allow_hyphen_values = true)]
    pixel: Vec<[u32; 2]>,
    /// Samples a pixel: an N×N regular grid, for the kind side-by-side
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = from_1,
          allow_negative_numbers = true)]
    samples: u32,
    /// Give object order the rules of an ordinary rasterizer, for the kinds that compare
    #[arg(long, value_name = "RULE", default_value = "exact",
          value_parser = rules::<object_order::Rule>)]
    object_rules: RulesArg<object_order::Rule>,
    /// Give image order the rules of an ordinary ray tracer
    #[arg(long, value_name = "RULE", default_value = "exact",
          value_parser = rules::<image_order::Rule>)]
    image_rules: RulesArg<image_order::Rule>,
    /// dark, for projectors in dim rooms, or light, for paper
    #[arg(long, default_value = "dark")]
    theme: Theme,
    /// For the kind work: also write the counts as NumPy arrays into this folder, H×W, u64, one file an order and method
    #[arg(long, value_name = "DIR")]
    counts: Option<PathBuf>,
    /// The width of a PNG in pixels; its height is nine sixteenths of it
    #[arg(long, value_name = "PIXELS", default_value_t = WIDTH, value_parser = width,
          allow_negative_numbers = true)]
    width: u32,
    /// The file, SVG or PNG as its name ends; - is standard output, as SVG [default: out/figures/SCENE-KIND.svg]
    #[arg(short = 'o', long = "output", value_name = "FILE.svg")]
    file: Option<PathBuf>,
}

/// How the drawing is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

/// Draws the figure, writes it and says where it is.
pub(super) fn run(args: &FigureArgs) -> Result<ExitCode, Failure> {
    check(args)?;
    let named = args.file.as_deref().map(OutputFile::find).transpose()?;
    let format = named.as_ref().map_or(Ok(Format::Svg), format)?;
    let loaded = args.files.load_narrow(&args.scene, args.camera.size, "a figure shows")?;
    terminal::warn(&loaded.warnings);
    let file = match named {
        Some(file) => file,
        None => OutputFile::find(&default_file(&loaded.name, args.kind))?,
    };
    let camera = camera(&loaded, &args.camera)?;
    check_samples(camera.image(), args.samples)
        .map_err(|error| Failure::new(format!("--samples {}: {error}", args.samples)))?;
    memory::check_both_orders(&camera, &Options { samples: args.samples, ..Options::default() })?;
    let subject = Subject {
        name: &loaded.name,
        about: loaded.about(),
        view: View::new(&loaded.scene, &camera),
        pixels: &args.pixel,
        samples: args.samples,
        rules: Rules {
            object_order: args.object_rules.rule(),
            image_order: args.image_rules.rule(),
        },
        theme: args.theme,
    };
    let (drawing, counts) = match &args.counts {
        None => (args.kind.draw(&subject), None),
        Some(folder) => {
            let maps = work_maps(&subject.view);
            (Ok(work_figure(&subject, &maps)), Some(staged_counts(&maps, folder)?))
        }
    };
    let drawing = drawing.map_err(|error| {
        Failure::new(format!("cannot draw {} of '{}': {error}", args.kind, loaded.name))
    })?;
    write(&drawing, &file, format, args.width)?;
    if let (Some(counts), Some(folder)) = (counts, &args.counts) {
        counts.commit()?;
        anstream::eprintln!("wrote {}", folder.display());
    }
    anstream::eprintln!("wrote {}", file.said());
    Ok(ExitCode::SUCCESS)
}

/// Refuses options that would change nothing in a figure of this kind.
fn check(args: &FigureArgs) -> Result<(), Failure> {
    let kind = args.kind;
    let refused = |option: &str, why: &str| {
        let kinds = Kind::ALL.into_iter().filter(|kind| match option {
            "--pixel" => kind.most_pixels() > 0,
            "--samples" => kind.takes_samples(),
            _ => kind.compares(),
        });
        let kinds: Vec<&str> = kinds.map(Kind::name).collect();
        Failure::new(format!("{option} {why}, and {kind} does not; it is for {}", kinds.join(", ")))
    };
    let ordinary = args.object_rules.rule().is_some() || args.image_rules.rule().is_some();
    match kind.most_pixels() {
        0 if !args.pixel.is_empty() => Err(refused("--pixel", "chooses what a figure looks at")),
        most if args.pixel.len() > most => Err(Failure::new(format!(
            "{kind} looks at {}, but --pixel is given {} times",
            count(most as u64, "pixels"),
            args.pixel.len()
        ))),
        _ if args.counts.is_some() && kind != Kind::Work => Err(Failure::new(format!(
            "--counts writes what the kind work shows, and {kind} shows no work; draw work"
        ))),
        _ if args.samples > 1 && !kind.takes_samples() => {
            Err(refused("--samples", "changes figures that show pictures by sample"))
        }
        _ if ordinary && !kind.compares() => Err(refused(
            "--object-rules and --image-rules",
            "change figures that compare the orders",
        )),
        _ => Ok(()),
    }
}

/// Where a figure goes if nobody says where.
fn default_file(scene: &str, kind: Kind) -> PathBuf {
    PathBuf::from(format!("out/figures/{}-{kind}.svg", folder_name(scene)))
}

fn format(file: &OutputFile) -> Result<Format, Failure> {
    match file.ending().as_deref() {
        None | Some("svg") => Ok(Format::Svg),
        Some("png") => Ok(Format::Png),
        Some(ending) => Err(Failure::new(format!(
            "cannot write {}: a figure is written as SVG or PNG, and .{ending} is neither; end the name in .svg or \
             .png",
            file.said()
        ))),
    }
}

fn write(drawing: &Drawing, file: &OutputFile, format: Format, width: u32) -> Result<(), Failure> {
    let bytes = match format {
        Format::Svg => drawing.svg().into_bytes(),
        Format::Png => drawing.png(width),
    };
    file.write(|out| out.write_all(&bytes))
}

/// The counts of each order and method as arrays, ready to be moved into their folder.
fn staged_counts(maps: &[WorkMap], folder: &Path) -> Result<Staging, Failure> {
    let name = |map: &WorkMap| format!("{}.{}.work.npy", map.order.file_stem(), map.method.name());
    let mut staging = Staging::begin_for("--counts", folder, maps.iter().map(name).collect())?;
    for map in maps {
        staging.write(&name(map), |out| npy::write_counts(map.size, &map.counts, out))?;
    }
    Ok(staging)
}

fn kind(name: &str) -> Result<Kind, String> {
    Kind::named(name).ok_or_else(|| {
        let names = Kind::ALL.map(Kind::name);
        let suggestion = nearest_name(name, names)
            .map_or(String::new(), |near| format!("did you mean {near}? "));
        format!("{suggestion}the kinds are {}", names.join(", "))
    })
}

/// A row and a column.
fn pixel(text: &str) -> Result<[u32; 2], String> {
    let number = |text: &str| text.trim().parse::<u32>().ok();
    let both = text.split_once(',').and_then(|(row, column)| Some([number(row)?, number(column)?]));
    both.ok_or_else(|| "give ROW,COLUMN in whole numbers counted from 0, such as 20,30".into())
}

/// The width of a picture.
fn width(text: &str) -> Result<u32, String> {
    match text.parse() {
        Ok(width @ 160..=7680) => Ok(width),
        _ => Err("give a whole number of pixels from 160 to 7680".into()),
    }
}
