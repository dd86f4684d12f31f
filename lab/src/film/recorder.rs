//! Records the loops of a renderer: every change of the stored picture, and where the loops are at every frame.

use crate::common::raster::{Region, Sample};
use crate::common::{Events, Observer};
use crate::orders::Order;
use std::collections::HashMap;

/// A line of the pseudocode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Line {
    /// The outer loop takes its next value.
    #[default]
    Outer,
    /// The inner loop takes its next value; in image order, a box of the hierarchy is tested.
    Inner,
    /// A pair of an object and a pixel is tested.
    Test,
    /// The object affects the pixel: the nearest is kept.
    Keep,
    /// Both loops are over.
    Done,
}

/// Where the loops are between two steps: the line, and the loop variables as far as they have values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Position {
    /// The line that ran last.
    pub line: Line,
    /// The primitive.
    pub primitive: Option<u32>,
    /// The sample.
    pub sample: Option<Sample>,
    /// The box of the hierarchy that was tested, and whether the ray enters it.
    pub node: Option<(u32, bool)>,
    /// In the line [`Line::Keep`]: the primitive that is stored now.
    pub kept: Option<u32>,
}

/// A change of the stored picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Change {
    /// The steps that were done by then.
    pub(super) steps: u64,
    pub(super) sample: Sample,
    /// The primitive that is stored from now on; `None` once it is known that nothing is seen.
    pub(super) id: Option<u32>,
}

/// When the recorder looks where the loops are.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    /// The steps after which the recorder looks, ascending.
    pub(super) moments: Vec<u64>,
    /// The steps before each part of the picture, by the sample of the part's first step.
    pub(super) parts: HashMap<Sample, u64>,
}

/// An observer that records. The clock counts steps: pairs of a primitive and a sample, and boxes.
///
/// A part of the picture that gets a recorder of its own counts its own steps. For the moments of the plan it must know
/// the steps before it: a [`Survey`] has found them.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    order: Order,
    plan: &'a Plan,
    steps: u64,
    /// The steps before this part, once its first step is there.
    before: Option<u64>,
    next: usize,
    now: Position,
    /// What was where at the moments of the plan, each with its number.
    pub(super) moments: Vec<(usize, Position)>,
    pub(super) changes: Vec<Change>,
    /// The nearest primitive so far: at each sample in object order, and in image order at the sample of the ray.
    stored: HashMap<Sample, u32>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(order: Order, plan: &'a Plan) -> Recorder<'a> {
        Recorder {
            order,
            plan,
            steps: 0,
            before: None,
            next: 0,
            now: Position::default(),
            moments: Vec::new(),
            changes: Vec::new(),
            stored: HashMap::new(),
        }
    }

    /// The steps so far.
    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    fn begin_step(&mut self, sample: Sample) {
        let before = *self.before.get_or_insert_with(|| {
            // The renderers that do not work in parts are in no plan.
            let before = self.plan.parts.get(&sample).copied().unwrap_or(0);
            self.next = self.plan.moments.partition_point(|&moment| moment < before);
            before
        });
        let moments = &self.plan.moments;
        while moments.get(self.next).is_some_and(|&moment| moment == before + self.steps) {
            self.moments.push((self.next, self.now));
            self.next += 1;
        }
        self.steps += 1;
    }

    /// Keeps a primitive as the nearest so far. Object order writes it into the picture at once; image order has a
    /// variable for it, and writes when the ray is done.
    fn keep(&mut self, sample: Sample, id: u32) {
        self.stored.insert(sample, id);
        self.now.kept = Some(id);
        if self.order == Order::Object {
            self.changes.push(Change { steps: self.steps, sample, id: Some(id) });
        }
    }
}

impl Observer for Recorder<'_> {
    fn fork(&self) -> Self {
        Recorder::new(self.order, self.plan)
    }

    fn join(&mut self, part: Self) {
        let before = self.steps;
        debug_assert!(part.before.is_none_or(|expected| expected == before), "as in the survey");
        let later = |change: Change| Change { steps: before + change.steps, ..change };
        self.changes.extend(part.changes.into_iter().map(later));
        self.moments.extend(part.moments);
        self.steps += part.steps;
    }
}

impl Events for Recorder<'_> {
    fn primitive_begun(&mut self, primitive: u64, _region: &Region) {
        self.now = Position { primitive: Some(short(primitive)), ..Position::default() };
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.now = Position { sample: Some(sample), ..Position::default() };
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.begin_step(sample);
        let node = Some((node, entered));
        self.now =
            Position { line: Line::Inner, sample: Some(sample), node, ..Position::default() };
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.begin_step(sample);
        let (sample, primitive) = (Some(sample), Some(short(primitive)));
        self.now = Position { line: Line::Test, sample, primitive, ..Position::default() };
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        let primitive = short(primitive);
        let (at, id) = (Some(sample), Some(primitive));
        self.now = Position { line: Line::Keep, sample: at, primitive: id, ..Position::default() };
        match self.stored.get(&sample) {
            // A depth test follows.
            Some(stored) => self.now.kept = Some(*stored),
            None => self.keep(sample, primitive),
        }
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, _stored: u64, replaced: bool) {
        if replaced {
            self.keep(sample, short(incoming));
        }
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u64>) {
        self.changes.push(Change { steps: self.steps, sample, id: primitive.map(short) });
        self.stored.clear();
    }
}

/// An observer that finds out how many steps come before each part of the picture.
#[derive(Debug, Default)]
pub(super) struct Survey {
    steps: u64,
    first: Option<Sample>,
    pub(super) parts: HashMap<Sample, u64>,
}

impl Survey {
    /// The steps so far.
    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    fn step(&mut self, sample: Sample) {
        self.first.get_or_insert(sample);
        self.steps += 1;
    }
}

impl Observer for Survey {
    fn fork(&self) -> Self {
        Survey::default()
    }

    fn join(&mut self, part: Self) {
        if let Some(first) = part.first {
            self.parts.insert(first, self.steps);
        }
        self.steps += part.steps;
    }
}

impl Events for Survey {
    fn node_opened(&mut self, sample: Sample, _node: u32, _entered: bool) {
        self.step(sample);
    }

    fn sample_tested(&mut self, sample: Sample, _primitive: u64) {
        self.step(sample);
    }
}

/// An id as films keep it: no scene of wider ones is filmed.
pub(super) fn short(id: u64) -> u32 {
    u32::try_from(id).expect("a film shows narrow ids alone")
}
