//! `bothways fuzz`: random hostile scenes, drawn by all four renderers.

use super::args::{from_1, threads};
use super::failure::Failure;
use super::output::{OutputFile, Staging};
use super::shell::quoted;
use super::status_line::StatusLine;
use super::{interrupt, terminal};
use bothways::fuzz::{
    Checked, Event, Finding, Limit, Options, Renderers, Summary, command, run as fuzz, scene_files,
};
use bothways::wording::{count, grouped};
use clap::Args;
use serde::Serialize;
use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::io::Write;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use std::{panic, process};

pub(super) const EXAMPLES: &str = "\
Both fast renderers draw each scene; both textbooks draw it too, or a part of it where that would
take long. If two of the four see different primitives at a sample, or one panics, the scene is
shrunk and written as a scene file. A scene depends on the seed and its own number alone.

Examples:
  bothways fuzz                                    for a minute, with a new seed, which is printed
  bothways fuzz --seconds 3600 --threads 1         for an hour; Ctrl-C ends it early
  bothways fuzz --seed 7 --scenes 1000             the same scenes on every machine
  bothways fuzz --seed 7 --first 123 --scenes 1    one of them again

Exit codes: 0 no disagreement, 1 disagreements, 2 something went wrong or a scene did not end,
130 ended by Ctrl-C without a disagreement.";

/// How long a run takes if nothing is said.
const SECONDS: f64 = 60.0;
/// The longest run: a year.
const MOST_SECONDS: f64 = 366.0 * 86_400.0;
/// Seeds that the program chooses have few digits, because people type them.
const CHOSEN_SEEDS: u64 = 1_000_000;
/// The exit code of a run that Ctrl-C ended.
const INTERRUPTED: u8 = 130;

/// What to draw, and for how long.
#[derive(Debug, Args)]
pub(super) struct FuzzArgs {
    /// Draw scenes for S seconds [default: 60]; scenes that have begun get ten seconds more
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true,
          conflicts_with = "scenes")]
    seconds: Option<f64>,
    /// Draw N scenes
    #[arg(long, value_name = "N", value_parser = from_1, allow_negative_numbers = true)]
    scenes: Option<u32>,
    /// The seed: the same scenes for the same seed; a new one if not given
    #[arg(long, value_name = "K", value_parser = whole, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// The number of the first scene
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true,
          default_value_t = 0)]
    first: u64,
    /// Threads; each draws scenes of its own; all cores if not given
    #[arg(long, value_name = "N", value_parser = threads, allow_negative_numbers = true)]
    threads: Option<u16>,
    /// The folder for the scene files of disagreements; if all agree, it is not made
    #[arg(short = 'o', long = "output", value_name = "DIR", default_value = "out/fuzz")]
    folder: PathBuf,
    /// Print the summary as JSON
    #[arg(long)]
    json: bool,
}

/// Draws, writes what disagrees, and prints the summary.
pub(super) fn run(args: &FuzzArgs) -> Result<ExitCode, Failure> {
    // A run of hours must not learn at its end that it cannot write.
    drop(Staging::begin_with(&args.folder, Vec::new())?);
    let seed = args.seed.unwrap_or_else(|| RandomState::new().hash_one(()) % CHOSEN_SEEDS);
    let limit = match args.scenes {
        Some(scenes) => Limit::Scenes(scenes.into()),
        None => Limit::Time(Duration::from_secs_f64(args.seconds.unwrap_or(SECONDS))),
    };
    let watch = Watch::new(args, seed);
    let listener = |event: Event| watch.take(event);
    let options = Options {
        seed,
        first: args.first,
        limit,
        threads: args.threads.and_then(|threads| NonZero::new(threads.into())),
        stop: Some(interrupt::first_asks()),
        listener: Some(&listener),
        ..Options::default()
    };
    let summary = without_messages_of_caught_panics(|| fuzz(&options, &Renderers::sound()));
    let written = watch.finish();
    print(&summary, args)?;
    written?;
    Ok(ExitCode::from(status(&summary)))
}

fn print(summary: &Summary, args: &FuzzArgs) -> Result<(), Failure> {
    terminal::print(&if args.json { json(summary, args)? } else { text(summary) })
}

/// The exit code.
fn status(summary: &Summary) -> u8 {
    match summary {
        Summary { disagreements: 1.., .. } => 1,
        Summary { unfinished, .. } if !unfinished.is_empty() => 2,
        Summary { ended_early: true, .. } => INTERRUPTED,
        _ => 0,
    }
}

/// A renderer's panic is a result, and the message is a part of it.
fn without_messages_of_caught_panics<T>(run: impl FnOnce() -> T) -> T {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !bothways::fuzz::is_watched() {
            usual(info);
        }
    }));
    let result = run();
    // The default hook again.
    drop(panic::take_hook());
    result
}

/// Shows the progress, and writes findings as soon as they are there.
struct Watch<'a> {
    args: &'a FuzzArgs,
    seed: u64,
    line: StatusLine,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    scenes: u64,
    pixels: u64,
    /// The first failure to write a finding.
    failure: Option<Failure>,
}

impl<'a> Watch<'a> {
    fn new(args: &'a FuzzArgs, seed: u64) -> Watch<'a> {
        Watch { args, seed, line: StatusLine::new("drawing"), state: Mutex::default() }
    }

    fn take(&self, event: Event) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        match event {
            Event::Checked(Checked { pixels, .. }) => {
                state.scenes += 1;
                state.pixels += pixels;
                let drawn = [count(state.scenes, "scenes"), grouped(state.pixels)];
                self.line.say(format!("{}, {} pixels", drawn[0], drawn[1]));
            }
            Event::Found(finding) => {
                let written = write(finding, &self.args.folder);
                let path = path(finding, &self.args.folder).display().to_string();
                let end = match &written {
                    Ok(()) => format!("see it with: {}", command(finding, &quoted(&path))),
                    Err(failure) => failure.to_string(),
                };
                self.line.suspend(|| {
                    let text = format!("{}\n  {end}\n", finding.about());
                    // If stderr is closed, the summary still counts the disagreement.
                    let _ = anstream::stderr().write_all(terminal::tame(&text).as_bytes());
                });
                state.failure = state.failure.take().or(written.err());
            }
            Event::Slow(scene) => self.line.suspend(|| {
                let text = format!(
                    "note: scene {scene} takes long; it alone: {}\n",
                    again(self.seed, scene)
                );
                // If stderr is closed, the run still ends.
                let _ = anstream::stderr().write_all(text.as_bytes());
            }),
            Event::Overdue(summary) => self.end(summary, &state),
        }
    }

    /// Ends the program with the summary so far: threads that draw cannot be stopped.
    fn end(&self, summary: &Summary, state: &State) -> ! {
        self.line.finish();
        // No finding is being written: `take` holds the lock of the state.
        let printed = print(summary, self.args);
        let failures = [state.failure.as_ref(), printed.as_ref().err()];
        for failure in failures.into_iter().flatten() {
            failure.print();
        }
        let failed = failures.iter().any(Option::is_some);
        process::exit(if failed { 2 } else { status(summary).into() })
    }

    /// Removes the progress; fails if a finding could not be written.
    fn finish(self) -> Result<(), Failure> {
        drop(self.line);
        let state = self.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        state.failure.map_or(Ok(()), Err)
    }
}

/// The command that draws one scene of a seed.
fn again(seed: u64, scene: u64) -> String {
    format!("bothways fuzz --seed {seed} --first {scene} --scenes 1")
}

fn stem(finding: &Finding) -> String {
    format!("seed-{}-scene-{}", finding.seed, finding.scene)
}

fn path(finding: &Finding, folder: &Path) -> PathBuf {
    folder.join(stem(finding) + ".toml")
}

/// Writes the files of a finding, the scene file last.
fn write(finding: &Finding, folder: &Path) -> Result<(), Failure> {
    for (name, content) in scene_files(finding, &stem(finding)) {
        OutputFile::find(&folder.join(name))?.write(|out| out.write_all(&content))?;
    }
    Ok(())
}

fn text(summary: &Summary) -> String {
    let (bold, dimmed) = (anstyle::Style::new().bold(), anstyle::Style::new().dimmed());
    let early = if summary.ended_early { "; ended by Ctrl-C" } else { "" };
    let mut text = format!(
        "{bold}{}{bold:#}\n{dimmed}{}{early}{dimmed:#}\n",
        summary.verdict(),
        summary.about()
    );
    for &scene in &summary.unfinished {
        text += &format!("scene {scene} did not end; it alone: {}\n", again(summary.seed, scene));
    }
    text
}

/// The summary, with the file and the command of each finding.
fn json(summary: &Summary, args: &FuzzArgs) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Written<'a> {
        #[serde(flatten)]
        finding: &'a Finding,
        file: String,
        command: String,
    }
    #[derive(Serialize)]
    struct Report<'a> {
        #[serde(flatten)]
        summary: &'a Summary,
        findings: Vec<Written<'a>>,
    }
    let findings = summary.findings.iter().map(|finding| {
        let file = path(finding, &args.folder).display().to_string();
        let command = command(finding, &quoted(&file));
        Written { finding, file, command }
    });
    terminal::json(&Report { summary, findings: findings.collect() })
}

/// A time in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds > 0.0 && seconds <= MOST_SECONDS => Ok(seconds),
        _ => {
            Err("give a number of seconds greater than 0, at most a year, such as 60 or 0.5".into())
        }
    }
}

/// A seed, or the number of a scene.
fn whole(text: &str) -> Result<u64, String> {
    // Beyond this, the numbers of the scenes after it might not fit.
    const MOST: u64 = 1 << 62;
    match text.parse() {
        Ok(number) if number <= MOST => Ok(number),
        _ => Err(format!("give a whole number from 0 to {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways::fuzz::{Disagreement, Size, Witness, generate};
    use bothways::orders::{Method, Order};

    #[test]
    fn a_finding_is_written_as_soon_as_it_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let args = FuzzArgs {
            seconds: None,
            scenes: None,
            seed: None,
            first: 0,
            threads: None,
            folder: folder.path().join("new"),
            json: false,
        };
        let case = generate(7, 2);
        let size = Size::of(&case);
        let renderer = Witness { order: Order::Image, method: Method::Fast, counted: false };
        let disagreement = Disagreement::Panic { renderer, message: "planted".into() };
        let finding = Finding {
            seed: 7,
            scene: 2,
            original: size,
            shrunk: size,
            steps: 0,
            disagreement,
            case: case.clone(),
        };
        let watch = Watch::new(&args, 7);
        watch.take(Event::Found(&finding));
        watch.finish().unwrap();
        let file = args.folder.join("seed-7-scene-2.toml");
        let read = bothways::scenes::load(file.to_str().unwrap()).unwrap();
        assert_eq!(read.camera, case.camera);
        assert!(
            read.toml.starts_with("# scene 2 of seed 7: image order (fast) panicked: planted\n")
        );
    }
}
