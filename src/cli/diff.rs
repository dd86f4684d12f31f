//! `bothways diff A B`: a comparison of the output of two renderers.

mod args;
mod folders;
mod html;
mod inputs;
mod measures;
mod options;
mod read;
mod text;
mod why;

pub(super) use args::{DiffArgs, EXAMPLES};

use super::beside::Beside;
use super::failure::Failure;
use super::output::Staging;
use super::terminal;
use anstyle::{AnsiColor, Style};
use bothways::common::View;
use bothways::diff::foreign::{self, Aspect, Buffer, BufferComparison, CompareOptions, Unit};
use bothways::diff::pairs::reference;
use bothways::formats::source::quote::visible;
use bothways::picture::enlarged;
use bothways::wording::grouped;
use options::{differing, ignored, short};
use read::ReadFile;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use text::{line, number};
use why::Why;

/// The output files.
const NAMES: [&str; 2] = ["difference.png", "reasons.png"];

/// Compares and prints; the exit code is 0 if the files are equal in all compared aspects, or equal enough, otherwise 1.
pub(super) fn run(args: &DiffArgs) -> Result<ExitCode, Failure> {
    let page = html::find(args)?;
    match [&args.a, &args.b].map(|path| path.is_dir()) {
        [true, true] => folders::run(args),
        [false, false] => compare_files(args, &page),
        [a_is_folder, _] => {
            let (folder, file) = if a_is_folder { (&args.a, &args.b) } else { (&args.b, &args.a) };
            let (folder, file) = (folder.display(), file.display());
            Err(Failure::new(format!(
                "{folder} is a folder and {file} is none; compare two files, or two folders"
            )))
        }
    }
}

fn compare_files(args: &DiffArgs, page: &Beside) -> Result<ExitCode, Failure> {
    let read = read::read(args)?;
    for file in &read {
        terminal::warn(&file.named_warnings());
    }
    let [a, b] = [&read[0].buffer, &read[1].buffer];
    let options = args.comparison.options(reference(&args.a, &args.b));
    let mut comparison = foreign::compare_with(a, b, &options).map_err(|error| {
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
    // Hints must not say what is wrong with a file that is right.
    if let Some(why) = why.as_ref().filter(|why| why.explains_nothing())
        && let right @ Some(_) = why.right_side()
    {
        let options = CompareOptions { reference: right, ..options };
        if let Ok(with_reference) = foreign::compare_with(a, b, &options) {
            comparison.hints = with_reference.hints;
        }
    }
    let [width, height] = a.size();
    if let Some([i, j]) = args.pixel.filter(|&[i, j]| i >= height || j >= width) {
        return Err(Failure::new(format!(
            "--pixel {i},{j}: there is no such pixel in {width}x{height}: rows go from 0 to {}, columns from 0 to {}",
            height - 1,
            width - 1
        )));
    }
    let of_samples = by_sample.as_ref().map_or(&comparison, |fine| fine.comparison());
    if let Some(folder) = &args.folder {
        let mut staging = Staging::begin_with(folder, NAMES.map(str::to_owned).to_vec())?;
        staging.write_rgb(NAMES[0], &enlarged(comparison.picture()))?;
        if let Some(why) = &why {
            staging.write_rgb(NAMES[1], &why.picture(of_samples))?;
        }
        staging.commit()?;
    }
    html::write(page, args, [a, b], &comparison, |page| {
        if let Some(why) = &why {
            why.fill(page);
        }
    })?;
    let files = [(&args.a, a), (&args.b, b)];
    let report = FileReport { files, read: &read, comparison: &comparison, why: why.as_ref() };
    let text = match (args.pixel, &why) {
        _ if args.json => report.json()?,
        (Some(pixel), Some(why)) => why.pixel(pixel, of_samples) + &page.written(),
        _ => report.text(args.folder.as_deref()) + &page.written(),
    };
    page.print(&text)?;
    Ok(ExitCode::from(u8::from(!comparison.passes)))
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
            Some(why) if why.explains_nothing() => why.text() + &hints(&self.comparison.hints),
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
