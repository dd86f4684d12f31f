//! `bothways sweep`: what both orders cost as a scene grows, as a table, CSV, JSON and charts.

mod report;

use super::args::{from_1, size, threads};
use super::failure::Failure;
use super::interrupt;
use super::output::{OutputFile, Staging};
use super::status_line::StatusLine;
use super::terminal;
use super::thread_pool::thread_pool;
use bothways::common::engine::simd::best_level;
use bothways::figure::{Theme, sweep_chart};
use bothways::sweep::{Axis, Bench, Plan, Quantity, Summary, Table, json};
use clap::Args;
use std::fs;
use std::io::{ErrorKind, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::thread::available_parallelism;

pub(super) const EXAMPLES: &str = "\
Axes:
  triangles         of a sphere that is seen whole, from 100 up to --most
  pixels            of the image, from 576 to 2.4 million, for a sphere of 10,000 triangles
  depth-complexity  opaque layers behind one another, from 1 to 1024
  triangle-size     pixels a triangle, from 0.3 to 100,000, for one layer over the picture
  instances         of one sphere of 1,024 triangles, from 1 to 262,144; up to 300 times --most

Steps are counted: primitives and rays begun, boxes tested, and pairs of a primitive and a sample
tested. They are the same on every machine. Times are of a frame's visibility, without what is
prepared once for a scene. Let nothing else run meanwhile.

Every measurement goes to sweep.csv at once. A run that was interrupted goes on where it stopped if
it is started again; with more triangles or more rounds it measures only what is missing.

Examples:
  bothways sweep                                     all axes, into out/sweep; about a minute
  bothways sweep triangles --most 10M --rounds 5     on to ten million triangles
  bothways sweep --no-times                          counts alone: the same bytes on every machine
  bothways sweep pixels --theme light --png -o charts

Exit codes: 0 all is measured, 2 something went wrong, 130 interrupted (what was measured stays).";

/// The width of a PNG.
const WIDTH: u32 = 1920;
/// The most pixels of an image: a count looks at each ray alone.
const MOST_PIXELS: u64 = 1 << 24;

/// What to measure, how far, and where to.
#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    /// What grows; all axes if none is given
    #[arg(value_name = "AXIS")]
    axes: Vec<Axis>,
    /// The image, where it does not grow itself; up to 2^24 pixels
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = image)]
    size: [u32; 2],
    /// The most triangles, where they grow, from 100 to 10M; k and M stand for thousands and millions
    #[arg(long, value_name = "N", default_value = "1M", value_parser = most,
          allow_negative_numbers = true)]
    most: u64,
    /// How often each time is measured, at different moments; the least counts. A textbook is timed once, and only where
    /// that takes seconds at most
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = rounds,
          allow_negative_numbers = true)]
    rounds: u32,
    /// Threads to render with
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = threads,
          allow_negative_numbers = true)]
    threads: u16,
    /// Measure no times, so that every machine writes the same
    #[arg(long)]
    no_times: bool,
    /// Forget what an earlier run has measured
    #[arg(long)]
    fresh: bool,
    /// dark, for projectors in dim rooms, or light, for paper
    #[arg(long, default_value = "dark")]
    theme: Theme,
    /// Also write each chart as a PNG, 1920 pixels wide
    #[arg(long)]
    png: bool,
    /// The folder for sweep.csv, sweep.json, and a chart for each axis and quantity
    #[arg(short = 'o', long = "output", value_name = "DIR", default_value = "out/sweep")]
    folder: PathBuf,
    /// Print what sweep.json holds instead of the table
    #[arg(long)]
    json: bool,
}

/// The file of measurements.
const CSV: &str = "sweep.csv";
/// The file for programs.
const JSON: &str = "sweep.json";

/// Measures what is missing, draws all, and prints the table.
pub(super) fn run(args: &SweepArgs) -> Result<ExitCode, Failure> {
    // A run of minutes must not learn at its end that it cannot write.
    drop(Staging::begin_with(&args.folder, file_names())?);
    let axes = if args.axes.is_empty() { Axis::ALL.to_vec() } else { args.axes.clone() };
    let plan =
        Plan { image: args.size, most: args.most, times: !args.no_times, rounds: args.rounds };
    let conditions = if args.no_times { String::new() } else { conditions(args.threads) };
    let mut table = begun(args, &plan, &conditions)?;
    let pool = thread_pool(args.threads.into())?;
    pool.install(|| measure(args, &plan, &axes, &mut table))?;

    let summaries: Vec<Summary> = axes
        .iter()
        .flat_map(|&axis| Quantity::ALL.map(|quantity| (axis, quantity)))
        .filter_map(|(axis, quantity)| Summary::of(&table, axis, quantity))
        .collect();
    let json = json(&plan, table.conditions(), &summaries)
        .map_err(|error| Failure::new(error.to_string()))?;
    write(args, &table, &summaries, &json)?;
    let text = if args.json { json } else { report::text(&summaries, &args.folder) };
    terminal::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// What an earlier run has measured, if it can be continued.
fn begun(args: &SweepArgs, plan: &Plan, conditions: &str) -> Result<Table, Failure> {
    let path = args.folder.join(CSV);
    if args.fresh {
        return Ok(Table::new(conditions));
    }
    let advice = "give --fresh to begin anew, or another folder with -o";
    let refused = |reason: String| {
        Failure::new(format!("cannot go on with {}: {reason}; {advice}", path.display()))
    };
    match fs::read_to_string(&path) {
        Ok(text) => {
            Table::read(&text, plan, conditions).map_err(|error| refused(error.to_string()))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Table::new(conditions)),
        Err(error) if error.kind() == ErrorKind::InvalidData => {
            Err(refused("it is not a text".into()))
        }
        Err(error) => {
            let reason = super::reason::reason(&error, advice);
            Err(Failure::new(format!("cannot read {}: {reason}", path.display())))
        }
    }
}

/// Carries out what is missing. The file is complete after each measurement.
fn measure(args: &SweepArgs, plan: &Plan, axes: &[Axis], table: &mut Table) -> Result<(), Failure> {
    let mut tasks = plan.tasks(axes);
    let all = tasks.len();
    tasks.retain(|task| !table.has(task));
    if tasks.is_empty() {
        return Ok(());
    }
    let file = OutputFile::find(&args.folder.join(CSV))?;
    let line = StatusLine::with_steps(all as u64, (all - tasks.len()) as u64);
    let mut bench = Bench::default();
    interrupt::goes_on(format!("what was measured stays in {}", file.said()));
    for task in tasks {
        let x = bothways::sweep::short(task.case.x);
        line.say(format!("{x} {}", task.case.axis.unit()));
        table.insert(task, bench.measure(&task));
        file.write(|out| out.write_all(table.csv().as_bytes()))?;
        line.step();
    }
    interrupt::goes_on_no_longer();
    Ok(())
}

/// Writes the table, the JSON and the charts; charts of an earlier run that this one does not draw are removed.
fn write(
    args: &SweepArgs,
    table: &Table,
    summaries: &[Summary],
    json: &str,
) -> Result<(), Failure> {
    let mut staging = Staging::begin_with(&args.folder, file_names())?;
    for summary in summaries {
        let drawing = sweep_chart(summary, table.conditions(), args.size, args.theme);
        let name = chart_name(summary.axis, summary.quantity);
        staging.write(&format!("{name}.svg"), |out| out.write_all(drawing.svg().as_bytes()))?;
        if args.png {
            staging.write(&format!("{name}.png"), |out| out.write_all(&drawing.png(WIDTH)))?;
        }
    }
    staging.write(CSV, |out| out.write_all(table.csv().as_bytes()))?;
    staging.write(JSON, |out| out.write_all(json.as_bytes()))?;
    staging.commit()
}

/// Every file that a sweep may write; the last one shows that all are complete.
fn file_names() -> Vec<String> {
    let mut names = Vec::new();
    for axis in Axis::ALL {
        for quantity in Quantity::ALL {
            let name = chart_name(axis, quantity);
            names.extend([format!("{name}.svg"), format!("{name}.png")]);
        }
    }
    names.extend([CSV, JSON].map(str::to_owned));
    names
}

fn chart_name(axis: Axis, quantity: Quantity) -> String {
    let what = match quantity {
        Quantity::Steps => "steps",
        Quantity::Milliseconds => "times",
    };
    format!("sweep-{}-{what}", axis.name())
}

/// Under which conditions times are measured.
fn conditions(threads: u16) -> String {
    let level = format!("{:?}", best_level());
    let level = level.split('(').next().unwrap_or_default();
    let cores = available_parallelism().map_or(1, |cores| cores.get());
    let threads = bothways::wording::count(threads.into(), "threads");
    format!("{threads} of {cores} · {} · {level}", processor())
}

/// The processor's name, as the Linux kernel tells it; elsewhere its architecture.
fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let name = name.map_or(std::env::consts::ARCH, |(_, name)| name);
    name.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn image(text: &str) -> Result<[u32; 2], String> {
    let [width, height] = size(text)?;
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err("the image of a sweep may have at most 2^24 pixels, such as 4096x4096".into());
    }
    Ok([width, height])
}

/// A number of triangles, such as 300k.
fn most(text: &str) -> Result<u64, String> {
    let (digits, unit) = match text.chars().last() {
        Some('k') => (&text[..text.len() - 1], 1000),
        Some('M') => (&text[..text.len() - 1], 1_000_000),
        _ => (text, 1),
    };
    let number = digits.parse::<u64>().ok().and_then(|number| number.checked_mul(unit));
    match number {
        Some(number @ 100..=Plan::MOST) => Ok(number),
        _ => Err("give a number of triangles from 100 to 10M, such as 300k".into()),
    }
}

fn rounds(text: &str) -> Result<u32, String> {
    match from_1(text) {
        Ok(number @ 1..=Plan::MOST_ROUNDS) => Ok(number),
        _ => Err(format!("give a whole number from 1 to {}", Plan::MOST_ROUNDS)),
    }
}
