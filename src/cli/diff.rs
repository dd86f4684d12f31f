//! `bothways diff A B`: a comparison of the output of two renderers.

mod folders;
mod html;
mod inputs;
mod measures;
mod options;
mod why;

use super::failure::Failure;
use super::output::Staging;
use super::terminal;
use anstyle::{AnsiColor, Style};
use bothways::common::View;
use bothways::diff::foreign::{self, Aspect, Buffer, BufferComparison, Unit};
use bothways::diff::pairs::reference;
use bothways::formats::source::quote::visible;
use bothways::picture::enlarged;
use bothways::wording::grouped;
use clap::Args;
use inputs::{InputArgs, ReadFile, SceneArgs};
use options::{ComparisonArgs, differing, ignored, short};
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use why::Why;

pub(super) const EXAMPLES: &str = "\
Examples:
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

/// The output files.
const NAMES: [&str; 2] = ["difference.png", "reasons.png"];

/// What to compare.
#[derive(Debug, Args)]
pub(super) struct DiffArgs {
    /// A mask, a picture or a buffer; or a folder of them
    a: PathBuf,
    /// Another one of the same size; or another folder
    b: PathBuf,
    /// The folder to write difference.png into (of two folders, NAME.difference.png of each pair that
    /// differs); without it, nothing is written
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    folder: Option<PathBuf>,
    /// The colour of what is not covered, in pictures that have no alpha, such as #101418
    #[arg(long, value_name = "COLOR", value_parser = color)]
    background: Option<[u8; 3]>,
    /// Write the comparison as a page for a browser: slider, blink, linked zoom, values, a filter; - is
    /// standard output
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    comparison: ComparisonArgs,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    scene: SceneArgs,
    /// Tell of this pixel alone why it differs: its row and column, counted from 0
    #[arg(long, value_name = "ROW,COLUMN", value_parser = pixel, requires = "scene",
          conflicts_with = "json", allow_hyphen_values = true, help_heading = "Scene")]
    pixel: Option<[u32; 2]>,
}

/// Compares and prints; the exit code is 0 if the files are equal in all compared aspects, or equal enough, otherwise 1.
pub(super) fn run(args: &DiffArgs) -> Result<ExitCode, Failure> {
    let page = html::find(args)?;
    match [&args.a, &args.b].map(|path| path.is_dir()) {
        [true, true] => return folders::run(args),
        [false, false] => {}
        [a_is_folder, _] => {
            let (folder, file) = if a_is_folder { (&args.a, &args.b) } else { (&args.b, &args.a) };
            let (folder, file) = (folder.display(), file.display());
            return Err(Failure::new(format!(
                "{folder} is a folder and {file} is none; compare two files, or two folders"
            )));
        }
    }
    let read = inputs::read(args)?;
    for file in &read {
        terminal::warn(&file.named_warnings());
    }
    let [a, b] = [&read[0].buffer, &read[1].buffer];
    let options = args.comparison.options(reference(&args.a, &args.b));
    let comparison = foreign::compare_with(a, b, &options).map_err(|error| {
        let (a_path, b_path) = (args.a.display(), args.b.display());
        let cause = why::of_sizes(&args.scene, [a, b]);
        Failure::new(format!("A = {a_path}, B = {b_path}: {error}{cause}"))
    })?;
    let scene = inputs::scene_of_size(&args.scene, None, Some(a.size()))?;
    let by_sample = why::BySample::new([a, b], &options, scene.as_ref().map(|(_, camera)| camera))?;
    let why = scene.as_ref().map(|(loaded, camera)| {
        let words = why::arguments(&args.scene, a.size());
        match &by_sample {
            Some(fine) => fine.why(&loaded.scene, words),
            None => Why::find(&View::new(&loaded.scene, camera), [a, b], &comparison, words, 1),
        }
    });
    let [width, height] = a.size();
    if let Some([i, j]) = args.pixel.filter(|&[i, j]| i >= height || j >= width) {
        return Err(Failure::new(format!(
            "--pixel {i},{j}: there is no such pixel in {width}x{height}: rows go from 0 to {}, columns from 0 to {}",
            height - 1,
            width - 1
        )));
    }
    if let Some(folder) = &args.folder {
        let mut staging = Staging::begin_with(folder, NAMES.map(str::to_owned).to_vec())?;
        staging.write_rgb(NAMES[0], &enlarged(comparison.picture()))?;
        if let Some(why) = &why {
            let comparison = by_sample.as_ref().map_or(&comparison, |fine| fine.comparison());
            staging.write_rgb(NAMES[1], &why.picture(comparison))?;
        }
        staging.commit()?;
    }
    html::write(&page, args, [a, b], &comparison, |page| {
        if let Some(why) = &why {
            why.fill(page);
        }
    })?;
    let files = [(&args.a, a), (&args.b, b)];
    let report = FileReport { files, read: &read, comparison: &comparison, why: why.as_ref() };
    let text = match (args.pixel, &why) {
        _ if args.json => report.json()?,
        (Some(pixel), Some(why)) => why.pixel(pixel) + &page.written(),
        _ => report.text(args.folder.as_deref()) + &page.written(),
    };
    page.print(&text)?;
    Ok(ExitCode::from(u8::from(!comparison.passes)))
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

/// A colour in sRGB.
pub(super) fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
    let bytes = digits
        .filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
        .and_then(|digits| u32::from_str_radix(digits, 16).ok())
        .map(u32::to_be_bytes);
    match bytes {
        Some([_, red, green, blue]) => Ok([red, green, blue]),
        None => Err("write a # and six hexadecimal digits, such as '#101418'".into()),
    }
}

/// The content of the report.
struct FileReport<'a> {
    files: [(&'a PathBuf, &'a Buffer<'a>); 2],
    /// The same files, with how they were read.
    read: &'a [ReadFile; 2],
    comparison: &'a BufferComparison,
    /// Why they differ, if their scene is known.
    why: Option<&'a Why<'a>>,
}

/// The comparison for programs.
#[derive(Serialize)]
struct Json<'a> {
    a: JsonFile<'a>,
    b: JsonFile<'a>,
    #[serde(flatten)]
    comparison: &'a BufferComparison,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<why::WhyJson>,
}

#[derive(Serialize)]
struct JsonFile<'a> {
    file: String,
    kind: &'static str,
    samples: u32,
    notes: &'a [String],
    warnings: &'a [String],
}

impl FileReport<'_> {
    fn json(&self) -> Result<String, Failure> {
        let file = |side: usize| {
            let ((path, buffer), read) = (self.files[side], &self.read[side]);
            JsonFile {
                file: path.display().to_string(),
                kind: buffer.kind(),
                samples: buffer.samples(),
                notes: &read.notes,
                warnings: &read.warnings,
            }
        };
        let [a, b] = [file(0), file(1)];
        terminal::json(&Json { a, b, comparison: self.comparison, why: self.why.map(Why::json) })
    }

    fn text(&self, folder: Option<&Path>) -> String {
        let mut text = self.heading();
        self.counts(&mut text);
        text += &measures::text(self.comparison);
        self.largest(&mut text);
        self.first(&mut text);
        text += &match self.why {
            Some(why) => why.text(),
            None => hints(&self.comparison.hints),
        };
        let color = if self.comparison.passes { AnsiColor::Green } else { AnsiColor::Yellow };
        let style = color.on_default().bold();
        line(&mut text, format_args!("{style}{}{style:#}", self.verdict()));
        if let Some(folder) = folder {
            let dimmed = Style::new().dimmed();
            let written = if self.why.is_some() { &NAMES[..] } else { &NAMES[..1] };
            let files: Vec<String> =
                written.iter().map(|name| folder.join(name).display().to_string()).collect();
            line(&mut text, format_args!("{dimmed}written to {}{dimmed:#}", files.join(" and ")));
        }
        text
    }

    /// The names and the kinds of the files.
    fn heading(&self) -> String {
        let bold = Style::new().bold();
        let mut text = String::new();
        let files = ["A", "B"].into_iter().zip(self.files).zip(self.read);
        for ((name, (path, buffer)), read) in files {
            let samples = match buffer.samples() {
                1 => String::new(),
                n => format!(", {n} x {n} samples a pixel"),
            };
            let (path, kind) = (path.display().to_string(), buffer.kind());
            let (path, notes) = (visible(&path), read.notes_in_words());
            line(&mut text, format_args!("{bold}{name}{bold:#}  {path}: {kind}{samples}{notes}"));
        }
        let [width, height] = self.comparison.size;
        line(&mut text, format_args!("\n{width} x {height} pixels, compared: {}", self.compared()));
        for what in &self.comparison.not_compared {
            line(&mut text, format_args!("not compared: {what}"));
        }
        if let Some(ignored) = ignored(self.comparison) {
            line(&mut text, format_args!("{ignored}"));
        }
        text.push('\n');
        text
    }

    fn compared(&self) -> String {
        let names: Vec<&str> = self.comparison.compared.iter().map(|what| what.name()).collect();
        names.join(", ")
    }

    /// The compared aspects, and the tolerances.
    fn judged(&self) -> String {
        let tolerances = self.comparison.tolerances;
        let judged = |aspect: &Aspect| match aspect {
            Aspect::Coverage | Aspect::Ids => aspect.name().to_owned(),
            Aspect::T => format!("t (within {})", short(tolerances.t)),
            Aspect::Normals => format!("normals (within {} degrees)", tolerances.normals),
            Aspect::Color => format!("colour (within {}/255)", tolerances.color),
        };
        self.comparison.compared.iter().map(judged).collect::<Vec<_>>().join(", ")
    }

    fn counts(&self, text: &mut String) {
        let tolerances = self.comparison.tolerances;
        let mut rows = Vec::new();
        if let Some(coverage) = self.comparison.coverage {
            let one_sample = self.files.iter().all(|(_, buffer)| buffer.samples() == 1);
            let things = match coverage.unit {
                Unit::Samples if !one_sample => "samples",
                Unit::Samples | Unit::Pixels => "pixels",
            };
            rows.extend([
                (format!("{things} covered in A"), coverage.a),
                (format!("{things} covered in B"), coverage.b),
                ("in both".into(), coverage.both),
                ("only in A".into(), coverage.only_a),
                ("only in B".into(), coverage.only_b),
            ]);
        }
        if let Some(ids) = self.comparison.ids {
            rows.push(("in both, but other ids".into(), ids.differing_samples));
        }
        if let Some(depth) = self.comparison.depth {
            rows.push((
                format!("pixels with t beyond {}", short(tolerances.t)),
                depth.differing_pixels,
            ));
        }
        if let Some(normals) = self.comparison.normals {
            let label = format!("pixels with normals beyond {}°", tolerances.normals);
            rows.push((label, normals.differing_pixels));
        }
        if let Some(color) = self.comparison.color {
            let label = format!("pixels beyond {}/255 in colour", tolerances.color);
            rows.push((label, color.differing_pixels));
        }
        for (label, number) in rows {
            line(text, format_args!("{label:30}{:>14}", grouped(number)));
        }
        text.push('\n');
    }

    fn largest(&self, text: &mut String) {
        if let Some(depth) = self.comparison.depth
            && let (Some([i, j]), Some([a, b])) = (depth.at, depth.t)
        {
            let most = depth.max_relative_difference;
            let [a, b] = [a, b].map(foreign::distance_text);
            line(
                text,
                format_args!(
                    "largest difference in t: {most:.1e} of it, at ({i}, {j}): A {a}, B {b}"
                ),
            );
        }
        if let Some(normals) = self.comparison.normals
            && let Some(at @ [i, j]) = normals.at
        {
            let [a, b] = self.files.map(|(_, buffer)| buffer.seen(at));
            let most = short(normals.max_degrees);
            line(
                text,
                format_args!(
                    "largest angle of normals: {most} degrees, at ({i}, {j}): A {a}, B {b}"
                ),
            );
        }
        if let Some(color) = self.comparison.color
            && let Some(at @ [i, j]) = color.at
        {
            let most = number(color.max_difference);
            let [a, b] = self.files.map(|(_, buffer)| buffer.seen(at));
            line(
                text,
                format_args!(
                    "largest difference in colour: {most}/255, at ({i}, {j}): A {a}, B {b}"
                ),
            );
        }
    }

    fn first(&self, text: &mut String) {
        let first = &self.comparison.first_differing;
        if first.is_empty() {
            return;
        }
        line(text, format_args!("first pixels (row, column) that differ:"));
        let rows: Vec<[String; 3]> = first
            .iter()
            .map(|&[i, j]| {
                let [a, b] = self.files.map(|(_, buffer)| buffer.seen([i, j]));
                [format!("({i}, {j})"), format!("A {a}"), format!("B {b}")]
            })
            .collect();
        let widest = |column: usize| rows.iter().map(|row| row[column].len()).max().unwrap_or(0);
        let (place, a) = (widest(0), widest(1));
        for row in &rows {
            line(text, format_args!("  {:place$}  {:a$}  {}", row[0], row[1], row[2]));
        }
    }

    fn verdict(&self) -> String {
        let comparison = self.comparison;
        let Some([row, column, height, width]) = comparison.region else {
            return format!("equal in everything compared: {}", self.judged());
        };
        let (bottom, right) = (row + height - 1, column + width - 1);
        let place = if comparison.differing_pixels == 1 {
            format!("at ({row}, {column})")
        } else {
            format!("in the bounding box from ({row}, {column}) to ({bottom}, {right})")
        };
        let verdict = if comparison.passes { "equal enough: they differ in" } else { "differ:" };
        format!("{verdict} {}, {place}", differing(comparison))
    }
}

/// `1 differs`, `2 differ`.
fn count_of(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}

/// The possible causes; if several causes explain everything, each of them is possible.
fn hints(hints: &[String]) -> String {
    let mut text = String::new();
    match hints {
        [] => {}
        [hint] => line(&mut text, format_args!("hint: {hint}")),
        several => {
            line(&mut text, format_args!("hint: each of these alone explains every difference"));
            for hint in several {
                line(&mut text, format_args!("  - {hint}"));
            }
        }
    }
    text
}

fn line(text: &mut String, content: std::fmt::Arguments) {
    writeln!(text, "{content}").expect("a string takes all");
}

/// A number without unnecessary decimals.
fn number(steps: f32) -> String {
    if steps.fract() == 0.0 { format!("{steps}") } else { format!("{steps:.2}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_six_digits() {
        assert_eq!(color("#0172fF"), Ok([0x01, 0x72, 0xff]));
        for bad in ["", "#", "101418", "#10141", "#1014188", "#+01418", "#12345é", "black"] {
            assert!(color(bad).is_err(), "{bad}");
        }
    }
}
