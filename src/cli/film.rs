//! `bothways film`: both orders draw one picture, as a GIF, an animated PNG, a video or a folder of frames.

mod target;
mod video;

use super::args::{CameraArgs, FilesArgs, MethodArg};
use super::camera::{camera, squashed};
use super::failure::Failure;
use super::memory;
use super::run::folder_name;
use super::status_line::StatusLine;
use super::terminal;
use bothways::common::{Options, View};
use bothways::figure::Theme;
use bothways::film::{Film, Length, MOST_SECONDS, WIDTH_STEP, WIDTHS, default_size, rates};
use bothways::wording::{count, grouped};
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use target::Target;

pub(super) const EXAMPLES: &str = "\
Both orders share one clock, which counts the work done. One step is a pair of an object and a
pixel that is tested, or by the fast method a box of the hierarchy. Without --size the picture is
small, so that its pixels are seen.

Examples:
  bothways film lecture                              into out/films/lecture.gif
  bothways film lecture --method fast -o fast.gif    with bounds and hierarchies
  bothways film canonical --theme light -o light.png an animated PNG
  bothways film ties --size 16x16 -o frames/         frames/frame-0001.png and so on
  bothways film overlap --fps 100 -o overlap.mp4     where ffmpeg is installed

Exit codes: 0 both orders see the same, 1 they differ, 2 something went wrong.";

/// What to film, how, and where to.
#[derive(Debug, Args)]
pub(super) struct FilmArgs {
    /// A built-in scene, a .toml scene file, or a mesh file (framed automatically)
    scene: String,
    /// The lecture's double loop, or the fast renderers
    #[arg(long, value_enum, default_value_t = MethodArg::Textbook)]
    method: MethodArg,
    /// How long both orders draw
    #[arg(long, value_name = "S", default_value_t = 8.0, value_parser = seconds,
          allow_negative_numbers = true)]
    seconds: f64,
    /// How long the finished picture stays at the end, in seconds
    #[arg(long, value_name = "S", default_value_t = 2.0, value_parser = pause,
          allow_negative_numbers = true)]
    pause: f64,
    /// Frames a second: 1, 2, 4, 5, 10, 20, 25 or 50; 100 in a video or a folder
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = rate,
          allow_negative_numbers = true)]
    fps: u32,
    /// The width of the film in pixels, a multiple of 32; its height is nine sixteenths of it
    #[arg(long, value_name = "N", default_value_t = 960, value_parser = width,
          allow_negative_numbers = true)]
    width: u32,
    /// dark for dim rooms, light for bright ones
    #[arg(long, value_name = "THEME", default_value = "dark")]
    theme: Theme,
    /// A .gif, .png (animated) or .mp4 (by ffmpeg) file, or a folder for numbered frames; - is standard
    /// output, which gets a GIF [default: out/films/NAME.gif]
    #[arg(short = 'o', long = "output", value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the facts as JSON
    #[arg(long)]
    json: bool,
    // Last, because its heading holds for what follows.
    #[command(flatten)]
    files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
}

/// Records, draws, writes and prints; the exit code is 0 if both orders see the same.
pub(super) fn run(args: &FilmArgs) -> Result<ExitCode, Failure> {
    let length = Length::new(args.seconds, args.fps, args.pause)
        .map_err(|error| Failure::new(format!("--seconds, --fps and --pause: {error}")))?;
    let mut loaded = args.files.load_narrow(&args.scene, args.camera.size, "a film shows")?;
    terminal::warn(&loaded.warnings);
    let method = args.method.into();
    if args.camera.size.is_none() {
        loaded.camera.image = default_size(loaded.camera.image, method);
        if !loaded.viewport_stated {
            loaded.camera.viewport[0] = loaded.camera.width_of_square_pixels();
        }
    }
    let camera = camera(&loaded, &args.camera)?;
    memory::check_both_orders(&camera, &Options::default())?;
    let output = args
        .output
        .clone()
        .unwrap_or_else(|| Path::new("out").join("films").join(folder_name(&loaded.name) + ".gif"));
    let target = Target::find(&output, length)?;
    if args.json && target.is_stdout() {
        return Err(Failure::new(
            "--json and the film would both go to standard output; name a file with -o",
        ));
    }
    if let Some(hint) = squashed(&camera, &args.camera) {
        anstream::eprintln!("hint: {hint}");
    }
    let line = StatusLine::new("watching both orders");
    let view = View::new(&loaded.scene, &camera);
    let film = Film::record(&loaded.name, &view, method, length)
        .map_err(|error| Failure::new(format!("a film of {}: {error}", loaded.name)))?;
    let show = |number| line.say(format!("frame {number} of {}", length.frames()));
    let bytes = target.write(&film, args.theme, args.width, &show)?;
    drop(line);
    let facts = Facts::new(args, &loaded.name, &film, &target, bytes);
    facts.print(args.json, target.is_stdout())?;
    Ok(ExitCode::from(u8::from(!film.comparison().matches())))
}

/// What is said about a film that is written.
#[derive(Debug, Serialize)]
struct Facts {
    scene: String,
    file: String,
    format: &'static str,
    method: &'static str,
    /// The picture's width and height.
    size: [u32; 2],
    width: u32,
    height: u32,
    frames_per_second: u32,
    /// The frames that differ; the last one stays for the pause.
    frames: u32,
    pause_frames: u32,
    seconds: f64,
    bytes: u64,
    steps: Steps,
    verdict: String,
    matches: bool,
}

/// The steps of both orders.
#[derive(Debug, Serialize)]
struct Steps {
    object_order: u64,
    image_order: u64,
}

impl Facts {
    fn new(args: &FilmArgs, scene: &str, film: &Film, target: &Target, bytes: u64) -> Facts {
        let size = film.pictures()[0].dimensions().into();
        let ([object_order, image_order], length) = (film.steps(), film.length());
        Facts {
            scene: scene.into(),
            file: target.said(),
            format: target.format(),
            method: bothways::orders::Method::from(args.method).name(),
            size,
            width: args.width,
            height: args.width / 16 * 9,
            frames_per_second: length.rate(),
            frames: length.frames(),
            pause_frames: length.pause(),
            seconds: length.seconds(),
            bytes,
            steps: Steps { object_order, image_order },
            verdict: film.comparison().verdict(),
            matches: film.comparison().matches(),
        }
    }

    fn print(&self, json: bool, film_is_printed: bool) -> Result<(), Failure> {
        if json {
            return terminal::print(&terminal::json(self)?);
        }
        let Steps { object_order, image_order } = &self.steps;
        let text = format!(
            "{}\n{} at {} a second, {} s, {} x {} pixels, {} bytes; {} in object order, {} in image order\n{}\n",
            self.file,
            count(self.frames.into(), "frames"),
            self.frames_per_second,
            self.seconds,
            self.width,
            self.height,
            grouped(self.bytes),
            count(*object_order, "steps"),
            grouped(*image_order),
            self.verdict,
        );
        if film_is_printed {
            anstream::eprint!("{text}");
            return Ok(());
        }
        terminal::print(&text)
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds <= MOST_SECONDS => Ok(seconds),
        _ => Err(format!("give a number of seconds greater than 0, at most {MOST_SECONDS}")),
    }
}

fn pause(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=MOST_SECONDS).contains(&seconds) => Ok(seconds),
        _ => Err(format!("give a number of seconds from 0 to {MOST_SECONDS}")),
    }
}

fn rate(text: &str) -> Result<u32, String> {
    let rate = text.parse().ok().filter(|rate| Length::new(1.0, *rate, 0.0).is_ok());
    rate.ok_or_else(|| format!("choose {}: a GIF counts hundredths of a second", rates()))
}

fn width(text: &str) -> Result<u32, String> {
    let [least, most] = WIDTHS;
    match text.parse() {
        Ok(width) if (least..=most).contains(&width) && width % WIDTH_STEP == 0 => Ok(width),
        _ => Err(format!(
            "give a multiple of {WIDTH_STEP} from {least} to {most}, such as 960 or 1920"
        )),
    }
}
