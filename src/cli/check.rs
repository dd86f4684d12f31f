//! `bothways check THEIRS [VECTORS]`: a renderer held to a whole conformance set.

use super::beside::{Beside, PAGE};
use super::color::color;
use super::failure::Failure;
use super::shell::quoted;
use super::terminal;
use anstyle::{AnsiColor, Style};
use bothways::check::{Certainty, Check, CheckedFile, ConformanceSet, check};
use bothways::diff::foreign::Content;
use bothways::formats::source::quote::visible;
use bothways::wording::count;
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub(super) const EXAMPLES: &str = "\
Draw the scenes of the set with a renderer of your own, and save each as NAME.png (a mask) or
NAME.npy (ids or distances), NAME being the scene's name. Each is held to the exact picture of its
scene, and what is wrong is summed up by cause: conventions that explain many scenes at once, then
the reasons of each scene.

Examples:
  bothways vectors -o vectors               the scenes, as files to draw
  bothways check mine                       my pictures of them, in the folder mine
  bothways check mine --html check.html     and a page with each picture that is wrong
  bothways check mine vectors --json        a set in a folder; for a program to read

Exit codes: 0 every scene is there and right, 1 some are wrong or missing, 2 a file cannot be read
or compared, or something else went wrong.";

/// What to check.
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// The folder of the renderer's pictures: masks, ids or distances
    theirs: PathBuf,
    /// The folder of a conformance set, as 'bothways vectors' writes it; the built-in set if not given
    vectors: Option<PathBuf>,
    /// The colour of what is not covered, in pictures that have no alpha, such as #101418
    #[arg(long, value_name = "COLOR", value_parser = color)]
    background: Option<[u8; 3]>,
    /// Write the result as a page for a browser, with each picture that is wrong beside the truth; - is
    /// standard output
    #[arg(long, value_name = "FILE.html", conflicts_with = "json")]
    html: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// Checks and prints.
pub(super) fn run(args: &CheckArgs) -> Result<ExitCode, Failure> {
    let page = Beside::find(PAGE, args.html.as_deref())?;
    let set = match &args.vectors {
        Some(folder) => ConformanceSet::Folder(folder.clone()),
        None => ConformanceSet::BuiltIn,
    };
    let checked = check(&args.theirs, &set, args.background)
        .map_err(|error| Failure::new(error.to_string()))?;
    let report = Report { args, checked: &checked };
    let title = [args.theirs.display().to_string(), report.set()];
    page.write(|out| checked.write_page([&title[0], &title[1]], out))?;
    page.print(&if args.json { report.json()? } else { report.text() + &page.written() })?;
    if args.json {
        report.warn_of_unreadable();
    }
    Ok(ExitCode::from(match (checked.passes(), checked.unreadable()) {
        (true, _) => 0,
        (false, 0) => 1,
        (false, _) => 2,
    }))
}

/// The content of the report.
struct Report<'a> {
    args: &'a CheckArgs,
    checked: &'a Check,
}

/// The report for programs.
#[derive(Serialize)]
struct Json<'a> {
    theirs: String,
    set: String,
    passes: bool,
    verdict: String,
    right: usize,
    missing: &'a [String],
    causes: Vec<CauseJson<'a>>,
    files: Vec<FileJson<'a>>,
}

#[derive(Serialize)]
struct CauseJson<'a> {
    certainty: &'static str,
    /// Each explains as much as the others.
    alternatives: &'a [Vec<String>],
    files: Vec<&'a str>,
}

#[derive(Serialize)]
struct FileJson<'a> {
    scene: &'a str,
    file: &'a str,
    point: &'a str,
    right: bool,
    differing_pixels: Option<u64>,
    first_differing: Option<[u32; 2]>,
    error: Option<&'a str>,
}

impl Report<'_> {
    fn set(&self) -> String {
        match &self.args.vectors {
            Some(folder) => folder.display().to_string(),
            None => "the built-in set".into(),
        }
    }

    fn json(&self) -> Result<String, Failure> {
        let Check { files, missing, causes, .. } = self.checked;
        let cause = |cause: &'_ bothways::check::Cause| match cause.certainty {
            Certainty::Convention => "convention",
            Certainty::Guess => "guess",
            Certainty::Reason => "reason",
            Certainty::Unknown => "unknown",
        };
        terminal::json(&Json {
            theirs: self.args.theirs.display().to_string(),
            set: self.set(),
            passes: self.checked.passes(),
            verdict: self.checked.verdict(),
            right: self.checked.right(),
            missing,
            causes: causes
                .iter()
                .map(|one| CauseJson {
                    certainty: cause(one),
                    alternatives: &one.alternatives,
                    files: one.files.iter().map(|&at| files[at].file.as_str()).collect(),
                })
                .collect(),
            files: files.iter().map(file_json).collect(),
        })
    }

    fn text(&self) -> String {
        let bold = Style::new().bold();
        let theirs = self.args.theirs.display().to_string();
        let (theirs, set) = (visible(&theirs).into_owned(), self.set());
        let mut text = format!("{bold}{theirs}{bold:#}, held to {}\n", visible(&set));
        text += &self.causes();
        text += &self.files();
        text += &self.missing();
        let color = if self.checked.passes() { AnsiColor::Green } else { AnsiColor::Yellow };
        let style = color.on_default().bold();
        text += &format!("\n{style}{}{style:#}\n", visible(&self.checked.verdict()));
        text + &self.next_step()
    }

    fn causes(&self) -> String {
        let causes = &self.checked.causes;
        if causes.is_empty() {
            return String::new();
        }
        let wrong: usize = causes.iter().map(|cause| cause.files.len()).sum();
        let bold = Style::new().bold();
        let mut text = format!("\n{bold}causes{bold:#}\n");
        for cause in causes {
            let number = format!("{} of {wrong}", cause.files.len());
            let mut lines = Vec::new();
            for parts in &cause.alternatives {
                let lead = if lines.is_empty() { "" } else { "or " };
                lines.extend(parts.iter().enumerate().map(|(index, part)| match index {
                    0 => format!("{lead}{part}"),
                    _ => format!("  and {part}"),
                }));
            }
            if cause.certainty == Certainty::Guess {
                lines.insert(0, "a guess, which explains less than half:".into());
            }
            for (index, line) in lines.iter().enumerate() {
                let number = if index == 0 { number.as_str() } else { "" };
                text += &format!("{number:>10}  {}\n", visible(line));
            }
        }
        text
    }

    /// The files that are wrong, a line each.
    fn files(&self) -> String {
        let wrong: Vec<(usize, &CheckedFile)> =
            self.checked.files.iter().enumerate().filter(|(_, file)| !file.is_right()).collect();
        let name = |file: &CheckedFile| visible(&file.file).into_owned();
        let widest =
            wrong.iter().map(|(_, file)| name(file).chars().count()).max().unwrap_or_default();
        let mut text = if wrong.is_empty() { String::new() } else { "\n".to_owned() };
        for (at, file) in wrong {
            text += &format!("{:widest$}  {}\n", name(file), self.words(at, file));
        }
        text
    }

    fn words(&self, at: usize, file: &CheckedFile) -> String {
        let cause = self.checked.cause_of(at).map(|cause| &self.checked.causes[cause]);
        let compared = match (&file.compared, cause) {
            (Ok(compared), _) => compared,
            (Err(error), Some(_)) => return visible(&error.reason).into_owned(),
            (Err(error), None) => return format!("cannot be compared: {}", visible(&error.reason)),
        };
        let point = match cause.map(|cause| cause.certainty) {
            Some(Certainty::Convention) => String::new(),
            _ => format!(". {}", visible(&file.point)),
        };
        compared.words() + &point
    }

    fn missing(&self) -> String {
        let Check { missing, ignored, .. } = self.checked;
        let mut text = String::new();
        if !missing.is_empty() {
            let number = count(missing.len() as u64, "scenes");
            let names: Vec<String> =
                missing.iter().map(|name| visible(name).into_owned()).collect();
            text += &format!("\nno file of {number}: {}\n", names.join(", "));
        }
        if let Some(first) = ignored.first() {
            let files = count(ignored.len() as u64, "files");
            text += &format!("\nof no scene, and left out: {files}, such as {}\n", visible(first));
        }
        text
    }

    /// Says on stderr why the exit code is 2, where no text says it.
    fn warn_of_unreadable(&self) {
        let files = self.checked.files.iter().enumerate();
        let mut errors = files.filter_map(|(at, file)| {
            let error = file.compared.as_ref().err()?;
            self.checked.cause_of(at).is_none().then_some((&file.file, &error.reason))
        });
        let Some((file, reason)) = errors.next() else { return };
        let more = errors.count() as u64;
        let others = match more {
            0 => String::new(),
            _ => format!(" (and {})", count(more, "other files")),
        };
        Failure::new(format!("{file}{others} cannot be compared: {reason}")).print();
    }

    /// The commands for a look at the first file that is wrong.
    fn next_step(&self) -> String {
        let wrong = |file: &&CheckedFile| file.compared.is_ok() && !file.is_right();
        let Some(file) = self.checked.files.iter().find(wrong) else { return String::new() };
        let (first, folder) = match &self.args.vectors {
            Some(folder) => ("", folder.as_path()),
            None => ("bothways vectors; ", Path::new("out/vectors")),
        };
        let ending =
            file.compared.as_ref().map_or("mask.png", |compared| match compared.truth.content() {
                Content::Ids(_) => "ids.npy",
                Content::Distances(_) => "t.npy",
                _ => "mask.png",
            });
        let background = self.args.background.map_or(String::new(), |[red, green, blue]| {
            format!(" --background '#{red:02x}{green:02x}{blue:02x}'")
        });
        let word = |path: PathBuf| quoted(&path.display().to_string());
        let of_set = |ending: &str| word(folder.join(format!("{}.{ending}", file.scene)));
        let (theirs, truth, scene) =
            (word(self.args.theirs.join(&file.file)), of_set(ending), of_set("toml"));
        format!("next: {first}bothways diff {theirs} {truth} --scene {scene}{background}\n")
    }
}

fn file_json(file: &CheckedFile) -> FileJson<'_> {
    let comparison = file.compared.as_ref().ok().map(|compared| &compared.comparison);
    FileJson {
        scene: &file.scene,
        file: &file.file,
        point: &file.point,
        right: file.is_right(),
        differing_pixels: comparison.map(|comparison| comparison.differing_pixels),
        first_differing: comparison
            .and_then(|comparison| comparison.first_differing.first().copied()),
        error: file.compared.as_ref().err().map(|error| error.reason.as_str()),
    }
}
