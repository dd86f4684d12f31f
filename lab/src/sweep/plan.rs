//! The measurements of a sweep, in the order in which they are made.

use super::case::{Axis, Case};
use crate::orders::{Method, Order};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Steps of the loops: primitives and rays begun, boxes tested, and pairs of a primitive and a sample tested. The
    /// same on every machine.
    Steps,
    /// Milliseconds of a frame's visibility.
    Milliseconds,
}

impl Quantity {
    /// Both.
    pub const ALL: [Quantity; 2] = [Quantity::Steps, Quantity::Milliseconds];

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Steps => "steps",
            Quantity::Milliseconds => "milliseconds",
        }
    }
}

/// One measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// The scene.
    pub case: Case,
    /// The order.
    pub order: Order,
    /// The method.
    pub method: Method,
    /// What is measured.
    pub quantity: Quantity,
    /// The round of a time, from 1; 0 for steps, which need no repetition.
    pub round: u32,
}

/// How far a sweep goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// The image's width and height, where the image does not grow.
    pub image: [u32; 2],
    /// The most triangles, where they grow.
    pub most: u64,
    /// Whether times are measured.
    pub times: bool,
    /// How often each time is measured, at different moments; the least counts. A textbook is timed once.
    pub rounds: u32,
}

impl Default for Plan {
    /// 320 × 180 pixels, up to a million triangles, three rounds of times.
    fn default() -> Self {
        Plan { image: [320, 180], most: 1_000_000, times: true, rounds: 3 }
    }
}

/// A textbook that tests more pairs of a primitive and a sample than this is not timed: it would take more than a few seconds.
const TIMED_BY_TEXTBOOK: u64 = 1 << 25;

impl Plan {
    /// The most triangles of any sweep.
    pub const MOST: u64 = 10_000_000;
    /// The most rounds.
    pub const MOST_ROUNDS: u32 = 100;

    /// The measurements along some axes: first all counts, then the rounds of times, so that a disturbance by other
    /// programs does not hit all rounds of one point.
    pub fn tasks(&self, axes: &[Axis]) -> Vec<Task> {
        let cases: Vec<Case> = Axis::ALL
            .into_iter()
            .filter(|axis| axes.contains(axis))
            .flat_map(|axis| axis.cases(self.most.min(Plan::MOST), self.image))
            .collect();
        let mut tasks = Vec::new();
        for round in 0..=if self.times { self.rounds } else { 0 } {
            let quantity = if round == 0 { Quantity::Steps } else { Quantity::Milliseconds };
            for &case in &cases {
                for method in [Method::Fast, Method::Textbook] {
                    let pairs = case.triangles * case.samples();
                    let is_long = round > 1 || round == 1 && pairs > TIMED_BY_TEXTBOOK;
                    if method == Method::Textbook && is_long {
                        continue;
                    }
                    tasks.extend(Order::ALL.map(|order| Task {
                        case,
                        order,
                        method,
                        quantity,
                        round,
                    }));
                }
            }
        }
        tasks
    }
}
