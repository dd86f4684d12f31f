//! What a sweep has measured so far: a CSV with one line for each measurement.

use super::case::Axis;
use super::plan::{Plan, Quantity, Task};
use crate::orders::{Method, Order};
use std::collections::BTreeMap;
use std::fmt::Write;
use thiserror::Error;

/// How a value is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Counted while the loops ran.
    Counted,
    /// Known by the definition of a textbook's loops, without a run.
    ByDefinition,
    /// A measured time.
    Measured,
}

impl Source {
    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Source::Counted => "counted",
            Source::ByDefinition => "by definition",
            Source::Measured => "measured",
        }
    }
}

/// The result of one measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Steps or milliseconds; positive.
    pub value: f64,
    /// How it is known.
    pub source: Source,
}

/// The first line. All columns but the last three tell which measurement it is. The conditions are those of a time.
const COLUMNS: &str =
    "axis,x,triangles,width,height,order,method,quantity,round,value,source,conditions";

/// Measurements, in the order of their axes, scenes, orders and rounds, whatever the order in which they were made.
#[derive(Clone, Debug, Default)]
pub struct Table {
    rows: BTreeMap<Key, (Task, Measured)>,
    /// Under which conditions times are measured: machine, threads; empty for counts alone. Without commas.
    conditions: String,
}

/// The place of a measurement in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    axis: Axis,
    /// The bits of a positive number are in its order.
    x: u64,
    pixels: u64,
    method: bool,
    order: bool,
    quantity: Quantity,
    round: u32,
}

impl Key {
    fn of(task: &Task) -> Key {
        Key {
            axis: task.case.axis,
            x: task.case.x.to_bits(),
            pixels: task.case.samples(),
            method: task.method == Method::Textbook,
            order: task.order == Order::Image,
            quantity: task.quantity,
            round: task.round,
        }
    }
}

/// Why a file of measurements cannot be continued.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ReadTableError {
    /// The file is none of these, or not of this version.
    #[error("line {line} is not what a sweep writes ({reason})")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// Its times were measured on another machine or with other options.
    #[error("it has times of \"{theirs}\", and this run {}", ours_said(.ours))]
    OtherConditions {
        /// Those of the file.
        theirs: String,
        /// Those of this run.
        ours: String,
    },
    /// Its scenes are others than those of this run.
    #[error("it has {theirs} along {axis}, which is no scene of a sweep with this --size")]
    OtherScenes {
        /// The axis.
        axis: &'static str,
        /// The scene.
        theirs: String,
    },
}

impl Table {
    /// No measurements yet. The conditions of times are words without commas.
    pub fn new(conditions: &str) -> Table {
        let conditions = conditions.replace([',', '"', '\n', '\r'], " ");
        Table { conditions, ..Table::default() }
    }

    /// Under which conditions times are measured; empty for counts alone.
    pub fn conditions(&self) -> &str {
        &self.conditions
    }

    /// Stores a measurement.
    pub fn insert(&mut self, task: Task, measured: Measured) {
        self.rows.insert(Key::of(&task), (task, measured));
    }

    /// Whether a measurement is there.
    pub fn has(&self, task: &Task) -> bool {
        self.rows.contains_key(&Key::of(task))
    }

    /// All measurements.
    pub fn rows(&self) -> impl Iterator<Item = &(Task, Measured)> {
        self.rows.values()
    }

    /// The text of the file.
    pub fn csv(&self) -> String {
        let mut text = format!("{COLUMNS}\n");
        for (task, Measured { value, source }) in self.rows() {
            let conditions = match source {
                Source::Measured => self.conditions.as_str(),
                Source::Counted | Source::ByDefinition => "",
            };
            let (identity, source) = (identity(task), source.name());
            writeln!(text, "{identity},{value},{source},{conditions}").expect("a string takes all");
        }
        text
    }

    /// Reads the text of a file, to go on with a plan under its conditions.
    ///
    /// # Errors
    ///
    /// A file of other conditions or of an image of another size, and whatever no sweep writes.
    pub fn read(text: &str, plan: &Plan, conditions: &str) -> Result<Table, ReadTableError> {
        let mut table = Table::new(conditions);
        let refused = |line, reason: &str| ReadTableError::Line { line, reason: reason.into() };
        let mut lines = text.lines().zip(1..);
        if lines.next().is_none_or(|(columns, _)| columns != COLUMNS) {
            return Err(refused(1, "its columns are others"));
        }
        // A run may go on with more triangles or more rounds than those before: all of these are its scenes.
        let widest = Plan { most: u64::MAX, rounds: Plan::MOST_ROUNDS, times: true, ..*plan };
        let tasks = widest.tasks(&Axis::ALL);
        let tasks: BTreeMap<String, Task> =
            tasks.into_iter().map(|task| (identity(&task), task)).collect();
        for (line, number) in lines {
            let mut parts = line.rsplitn(4, ',');
            let (Some(theirs), Some(source), Some(value), Some(identity)) =
                (parts.next(), parts.next(), parts.next(), parts.next())
            else {
                return Err(refused(number, "it has too few columns"));
            };
            let task = tasks.get(identity).ok_or_else(|| other_scene(identity, number))?;
            let value = value.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
            let source = [Source::Counted, Source::ByDefinition, Source::Measured]
                .into_iter()
                .find(|one| one.name() == source);
            let (Some(value), Some(source)) = (value, source) else {
                return Err(refused(number, "its value is no positive number of a known source"));
            };
            if source == Source::Measured && theirs != table.conditions {
                let (theirs, ours) = (theirs.to_owned(), table.conditions);
                return Err(ReadTableError::OtherConditions { theirs, ours });
            }
            table.insert(*task, Measured { value, source });
        }
        Ok(table)
    }
}

fn ours_said(ours: &str) -> String {
    if ours.is_empty() { "takes none".into() } else { format!("is \"{ours}\"") }
}

/// All columns that tell which measurement it is.
fn identity(task: &Task) -> String {
    let Task { case, order, method, quantity, round } = task;
    let [width, height] = case.image;
    format!(
        "{},{},{},{width},{height},{},{},{},{round}",
        case.axis.name(),
        case.x,
        case.triangles,
        order.name(),
        method.name(),
        quantity.name()
    )
}

fn other_scene(identity: &str, line: usize) -> ReadTableError {
    let parts: Vec<&str> = identity.split(',').collect();
    let axis = Axis::ALL.into_iter().find(|axis| parts.first() == Some(&axis.name()));
    match (axis, parts.as_slice()) {
        (Some(axis), [_, _, triangles, width, height, ..]) if parts.len() == 9 => {
            ReadTableError::OtherScenes {
                axis: axis.name(),
                theirs: format!("{triangles} triangles in {width}x{height} pixels"),
            }
        }
        _ => ReadTableError::Line { line, reason: "it names no measurement".into() },
    }
}
