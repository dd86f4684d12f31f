//! `bothways grade SCENE FILE…`: marks for pictures of one scene.

use super::args::{CameraArgs, FilesArgs};
use super::beside::{Beside, TABLE};
use super::camera::camera;
use super::color::color;
use super::failure::Failure;
use super::terminal;
use anstyle::{AnsiColor, Style};
use bothways::common::View;
use bothways::diff::foreign::{ReadOptions, read_with};
use bothways::formats::source::quote::visible;
use bothways::grade::{FORMULA, Grade, Verdict, grade};
use bothways::wording::count;
use clap::Args;
use serde::Serialize;
use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Each file is a mask, ids or distances of the scene, one sample a pixel. Its score:

  score = 100 (right + explained / 2^mistakes) / seen

seen        pixels that the scene or the file covers
right       those of them in which the file shows what the scene does
explained   wrong pixels that have an explanation, if at least half of them have one: conventions,
            or exact ties, rounding, culled or clipped faces, a mesh for a sphere
mistakes    how many conventions it takes to explain them; 1 if it takes none
So one mistake that explains everything gives half of the credit back, two give a quarter; a guess
gives nothing, nor does what is left out where less than half is right. A file that cannot be read,
or has another size, is a row without a score.

Examples:
  bothways grade canonical mine.png                            my own, before I hand it in
  bothways grade task.toml handed-in/*.npy --csv marks.csv     those of a course
  bothways grade lecture */ids.npy --size 160x120 --json       for a program to read

Exit codes: 0 every file is right, 1 some are not, 2 something else went wrong.";

/// What to grade.
#[derive(Debug, Args)]
pub(super) struct GradeArgs {
    /// The scene that the files show: a built-in one, a .toml scene file or a mesh file
    scene: String,
    /// The files: masks, ids or distances (PNG, PNM, BMP, EXR or NPY)
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write the grades as a table, a row for each file; - is standard output
    #[arg(long, value_name = "FILE.csv", conflicts_with = "json")]
    csv: Option<PathBuf>,
    /// The colour of what is not covered, in pictures that have no alpha, such as #101418
    #[arg(long, value_name = "COLOR", value_parser = color)]
    background: Option<[u8; 3]>,
    /// Print the grades as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scene_files: FilesArgs,
    #[command(flatten)]
    camera: CameraArgs,
}

/// Grades and prints.
pub(super) fn run(args: &GradeArgs) -> Result<ExitCode, Failure> {
    let table = Beside::find(TABLE, args.csv.as_deref())?;
    let loaded =
        args.scene_files.load_narrow(&args.scene, args.camera.size, "reasons are found among")?;
    terminal::warn(&loaded.warnings);
    let camera = camera(&loaded, &args.camera)?;
    let view = View::new(&loaded.scene, &camera);
    let rows: Vec<Row> = args.files.iter().map(|path| Row::new(path, args, &view)).collect();
    table.write(|out| write_csv(&rows, out))?;
    table.print(&if args.json {
        terminal::json(&json(&rows))?
    } else {
        text(&rows) + &table.written()
    })?;
    let all_right = rows.iter().all(Row::is_right);
    Ok(ExitCode::from(u8::from(!all_right)))
}

/// A file and its grade.
struct Row {
    file: String,
    /// The grade, or why there is none.
    grade: Result<Grade, String>,
}

/// A row for programs, and of the table.
#[derive(Serialize)]
struct Record<'a> {
    file: &'a str,
    /// Nothing for a file that cannot be graded.
    verdict: Option<Verdict>,
    score: Option<f64>,
    seen: Option<u64>,
    right: Option<u64>,
    explained: Option<u64>,
    mistakes: Option<u32>,
    likely_mistake: &'a str,
}

#[derive(Serialize)]
struct Json<'a> {
    formula: &'static str,
    grades: Vec<Record<'a>>,
}

impl Row {
    fn new(path: &std::path::Path, args: &GradeArgs, view: &View) -> Row {
        let options = ReadOptions { background: args.background, ..ReadOptions::default() };
        let read = read_with(path, &options).map_err(|error| error.to_string());
        let grade =
            read.and_then(|read| grade(view, &read.buffer).map_err(|error| error.to_string()));
        Row { file: path.display().to_string(), grade }
    }

    fn is_right(&self) -> bool {
        self.grade.as_ref().is_ok_and(|grade| grade.verdict == Verdict::Right)
    }

    fn record(&self) -> Record<'_> {
        let grade = self.grade.as_ref().ok();
        Record {
            file: &self.file,
            verdict: grade.map(|grade| grade.verdict),
            score: grade.map(Grade::score),
            seen: grade.map(|grade| grade.seen),
            right: grade.map(|grade| grade.right),
            explained: grade.map(|grade| grade.explained),
            mistakes: grade.map(|grade| grade.mistakes),
            likely_mistake: match &self.grade {
                Ok(grade) => &grade.likely_mistake,
                Err(error) => error,
            },
        }
    }
}

fn json(rows: &[Row]) -> Json<'_> {
    Json { formula: FORMULA, grades: rows.iter().map(Row::record).collect() }
}

/// The grades as lines of text: what is likely wrong stands below its file.
fn text(rows: &[Row]) -> String {
    let bold = Style::new().bold();
    let mut text = format!("{bold}{:>5}  {:16}  file{bold:#}\n", "score", "verdict");
    for row in rows {
        let Record { verdict, score, likely_mistake, .. } = row.record();
        let verdict = verdict.map_or("not graded", Verdict::name);
        let score = score.map_or("-".into(), |score| format!("{score:.1}"));
        let color = if row.is_right() { AnsiColor::Green } else { AnsiColor::Yellow };
        let style = color.on_default();
        let file = visible(&row.file);
        text += &format!("{score:>5}  {style}{verdict:16}{style:#}  {file}");
        text.push('\n');
        if !likely_mistake.is_empty() {
            text += &format!("{:5}  {}\n", "", visible(likely_mistake));
        }
    }
    let right = rows.iter().filter(|row| row.is_right()).count();
    let files = count(rows.len() as u64, "files");
    text += &format!("\n{bold}{right} of {files} right{bold:#}; {FORMULA}\n");
    text
}

fn write_csv(rows: &[Row], out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for row in rows {
        let record = row.record();
        let [file, mistake] = [record.file, record.likely_mistake].map(harmless);
        table
            .serialize(Record { file: &file, likely_mistake: &mistake, ..record })
            .map_err(io::Error::other)?;
    }
    table.flush()
}

/// A cell that no spreadsheet takes for a formula.
fn harmless(cell: &str) -> String {
    let cell = visible(cell);
    if cell.starts_with(['=', '+', '-', '@']) { format!("'{cell}") } else { cell.into_owned() }
}

#[cfg(test)]
mod tests {
    use super::harmless;

    #[test]
    fn no_cell_is_a_formula() {
        assert_eq!(["=1+2", "-x.png", "a=b"].map(harmless), ["'=1+2", "'-x.png", "a=b"]);
    }
}
