//! `bothways diff FOLDER FOLDER`: a comparison of each file of one folder with its partner in the other, such as a whole
//! conformance set.

use super::args::DiffArgs;
use super::options::differing;
use super::read;
use super::text::count_of;
use crate::cli::failure::Failure;
use crate::cli::output::Staging;
use crate::cli::shell::quoted;
use crate::cli::terminal;
use anstyle::{AnsiColor, Style};
use bothways::diff::foreign::Side;
use bothways::diff::foreign::{self, BufferComparison};
use bothways::diff::pairs::{Pair, Pairs};
use bothways::formats::source::quote::visible;
use bothways::wording::count;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Compares all pairs and prints a table; the exit code is 0 if all pairs are equal and no file lacks its partner, 2 if
/// a pair cannot be compared, otherwise 1.
pub(super) fn run(args: &DiffArgs) -> Result<ExitCode, Failure> {
    let pairs = Pairs::find(&args.a, &args.b).map_err(|error| Failure::new(error.to_string()))?;
    let mut staging = staging(args, &pairs)?;
    let mut rows = Vec::new();
    for pair in &pairs.pairs {
        let compared = compared(args, pair, pairs.set);
        if let (Some(staging), Ok(comparison)) = (&mut staging, &compared)
            && !comparison.equal
        {
            staging.write_rgb(&picture_of(pair), &comparison.picture())?;
        }
        rows.push(Compared { pair, compared });
    }
    if let Some(staging) = staging {
        staging.commit()?;
    }
    let report = FolderReport { args, pairs: &pairs, rows: &rows };
    terminal::print(&if args.json { report.json()? } else { report.text() })?;
    Ok(ExitCode::from(report.status()))
}

/// The folder for difference images, if the command line names one.
fn staging(args: &DiffArgs, pairs: &Pairs) -> Result<Option<Staging>, Failure> {
    let Some(folder) = &args.folder else { return Ok(None) };
    let names = pairs.pairs.iter().map(picture_of).collect();
    Staging::begin_with(folder, names).map(Some)
}

fn picture_of(pair: &Pair) -> String {
    format!("{}.difference.png", pair.name)
}

fn compared(args: &DiffArgs, pair: &Pair, set: Option<Side>) -> Result<BufferComparison, String> {
    let paths = [args.a.join(&pair.a), args.b.join(&pair.b)];
    let of_set = scene_of(args, pair, set);
    let read =
        read::read_pair(args, &paths, of_set.as_deref()).map_err(|error| error.to_string())?;
    for file in &read {
        terminal::warn(&file.named_warnings());
    }
    foreign::compare_with(&read[0].buffer, &read[1].buffer, &args.comparison.options(set))
        .map_err(|error| error.to_string())
}

/// The scene file of a pair beside a conformance set.
fn scene_of(args: &DiffArgs, pair: &Pair, set: Option<Side>) -> Option<PathBuf> {
    let folder = match set? {
        Side::A => &args.a,
        Side::B => &args.b,
    };
    let name = pair.name.split('.').next()?;
    Some(folder.join(format!("{name}.toml")))
}

/// A pair, and the result of its comparison.
struct Compared<'a> {
    pair: &'a Pair,
    compared: Result<BufferComparison, String>,
}

/// The content of the report.
struct FolderReport<'a> {
    args: &'a DiffArgs,
    pairs: &'a Pairs,
    rows: &'a [Compared<'a>],
}

/// The report for programs.
#[derive(Serialize)]
struct Json<'a> {
    a: String,
    b: String,
    equal: bool,
    passes: bool,
    pairs: Vec<JsonPair<'a>>,
    missing_in_a: Vec<String>,
    missing_in_b: Vec<String>,
}

#[derive(Serialize)]
struct JsonPair<'a> {
    name: &'a str,
    a: &'a str,
    b: &'a str,
    point: Option<&'a str>,
    error: Option<&'a str>,
    #[serde(flatten)]
    comparison: Option<&'a BufferComparison>,
}

impl FolderReport<'_> {
    fn status(&self) -> u8 {
        if self.rows.iter().any(|row| row.compared.is_err()) {
            return 2;
        }
        u8::from(!self.passes())
    }

    fn equal(&self) -> bool {
        self.rows.iter().all(|row| row.is(|comparison| comparison.equal))
            && self.pairs.is_complete()
    }

    fn passes(&self) -> bool {
        self.rows.iter().all(|row| row.is(|comparison| comparison.passes))
            && self.pairs.is_complete()
    }

    fn json(&self) -> Result<String, Failure> {
        let pairs = self.rows.iter().map(|row| JsonPair {
            name: &row.pair.name,
            a: &row.pair.a,
            b: &row.pair.b,
            point: row.pair.point.as_deref(),
            error: row.compared.as_ref().err().map(String::as_str),
            comparison: row.compared.as_ref().ok(),
        });
        terminal::json(&Json {
            a: self.args.a.display().to_string(),
            b: self.args.b.display().to_string(),
            equal: self.equal(),
            passes: self.passes(),
            pairs: pairs.collect(),
            missing_in_a: self.pairs.missing_in_a.clone(),
            missing_in_b: self.pairs.missing_in_b.clone(),
        })
    }

    fn text(&self) -> String {
        let mut text = self.heading();
        let widest = self.rows.iter().map(|row| row.pair.name.chars().count()).max().unwrap_or(0);
        for row in self.rows {
            let name = visible(&row.pair.name).into_owned();
            text += &format!("{name:widest$}  {}\n", row.words());
        }
        text += &self.missing();
        text += &self.verdict();
        text + &self.next_step()
    }

    fn heading(&self) -> String {
        let bold = Style::new().bold();
        let mut text = String::new();
        let folders = [("A", &self.args.a, Side::A), ("B", &self.args.b, Side::B)];
        for (name, folder, side) in folders {
            let is_set = self.pairs.set == Some(side);
            let what = if is_set { ": the conformance set" } else { "" };
            writeln!(text, "{bold}{name}{bold:#}  {}{what}", folder.display())
                .expect("a string takes all");
        }
        text + "\n"
    }

    /// The files or scenes that have no partner.
    fn missing(&self) -> String {
        let mut text = String::new();
        let missing =
            [("A", &self.pairs.missing_in_a), ("B", &self.pairs.missing_in_b)].into_iter();
        for (name, missing) in missing.filter(|(_, missing)| !missing.is_empty()) {
            let number = count(missing.len() as u64, self.pairs.things());
            let names: Vec<String> =
                missing.iter().map(|name| visible(name).into_owned()).collect();
            text += &format!("\n{name} lacks {number}: {}\n", names.join(", "));
        }
        if !self.pairs.ignored.is_empty() {
            let files = count(self.pairs.ignored.len() as u64, "files");
            let first = visible(&self.pairs.ignored[0]);
            text += &format!("\nnot of the set, and left out: {files}, such as {first}\n");
        }
        text
    }

    fn verdict(&self) -> String {
        let color = if self.passes() { AnsiColor::Green } else { AnsiColor::Yellow };
        let style = color.on_default().bold();
        let number =
            |state: fn(&Compared) -> bool| self.rows.iter().filter(|row| state(row)).count();
        let passing = number(|row| row.is(|comparison| comparison.passes));
        let equal = number(|row| row.is(|comparison| comparison.equal));
        let failed = number(|row| row.compared.is_err());
        let missing = self.pairs.missing_in_a.len() + self.pairs.missing_in_b.len();
        let pairs = count(self.rows.len() as u64, "pairs");
        let enough = if passing > equal { " enough" } else { "" };
        let mut words = vec![format!("{passing} of {pairs} equal{enough}")];
        let differ = self.rows.len() - passing - failed;
        words.extend((differ > 0).then(|| count_of(differ, "differs", "differ")));
        let cannot = "cannot be compared";
        words.extend((failed > 0).then(|| count_of(failed, cannot, cannot)));
        words.extend((missing > 0).then(|| count_of(missing, "is missing", "are missing")));
        format!("\n{style}{}{style:#}\n", words.join(", "))
    }

    /// The commands for a look at the first pair that differs.
    fn next_step(&self) -> String {
        let differs = |row: &&Compared| row.is(|comparison| !comparison.passes);
        let Some(row) = self.rows.iter().find(differs) else { return String::new() };
        let file = |folder: &Path, file: &str| quoted(&folder.join(file).display().to_string());
        let (a, b) = (file(&self.args.a, &row.pair.a), file(&self.args.b, &row.pair.b));
        let mut text = format!("next: bothways diff {a} {b} -o out/diff\n");
        let first = row.compared.as_ref().ok().and_then(|one| one.first_differing.first());
        let scene = scene_of(self.args, row.pair, self.pairs.set);
        if let (Some(scene), Some([i, j])) = (scene, first) {
            text +=
                &format!("why:  bothways pixel {} {i} {j}\n", quoted(&scene.display().to_string()));
        }
        text
    }
}

impl Compared<'_> {
    /// Whether the files were compared, and the comparison is in a state.
    fn is(&self, state: fn(&BufferComparison) -> bool) -> bool {
        self.compared.as_ref().is_ok_and(state)
    }

    /// The result in words, with the point of a scene that differs.
    fn words(&self) -> String {
        let comparison = match &self.compared {
            Ok(comparison) => comparison,
            Err(error) => return format!("cannot be compared: {error}"),
        };
        let compared: Vec<&str> = comparison.compared.iter().map(|what| what.name()).collect();
        if comparison.equal {
            let dimmed = Style::new().dimmed();
            return format!("{dimmed}equal in {}{dimmed:#}", compared.join(", "));
        }
        let pixels = differing(comparison);
        let first = comparison.first_differing.first();
        let first = first.map_or(String::new(), |[i, j]| format!(", first ({i}, {j})"));
        let yellow = AnsiColor::Yellow.on_default();
        let point = self.pair.point.as_ref().map_or(String::new(), |point| format!(". {point}"));
        if comparison.passes {
            return format!("equal enough: {pixels} differ{first}");
        }
        format!("{yellow}{pixels} differ{yellow:#}{first}{point}")
    }
}
