//! An observer that keeps all steps of the loops, and the changes of the stored picture.

use super::recorder::{Plan, Recorder, short};
use super::step::{Outcome, Run, Tested, Told};
use crate::common::raster::{Region, Sample};
use crate::common::{Events, Observer};
use crate::orders::{Method, Order};
use std::collections::HashMap;

/// The most entries that are kept of a textbook, of runs of the inner loop and of what was told together: tens of megabytes.
pub(super) const MOST_KEPT: usize = 3_000_000;

/// A function that is called now and then with the number of steps that are done.
pub(super) type Listener<'a> = &'a (dyn Fn(u32) + Sync);

/// The steps after which the listener is called again: few enough to be called several times within any moment.
const TELLS_EVERY: u32 = 1 << 16;

/// An observer that keeps all steps, and the changes of the stored picture, as long as there is room.
pub(super) struct Keeper<'a> {
    order: Order,
    width: u32,
    listener: Listener<'a>,
    pub(super) count: u32,
    pub(super) runs: Vec<Run>,
    pub(super) told: Vec<Told>,
    /// The changes; nothing reaches it once there is no room.
    pub(super) recorder: Recorder<'a>,
    /// What the last step tested, and where.
    last: Option<(Tested, u32)>,
    /// The steps that tested each pair, if what came of a test may be told after further tests: the fast renderers test some pairs
    /// at once, and tell the results together.
    pairs: Option<HashMap<(Sample, u32), u32>>,
}

impl<'a> Keeper<'a> {
    pub(super) fn new(
        order: Order,
        method: Method,
        width: u32,
        plan: &'a Plan,
        listener: Listener<'a>,
    ) -> Keeper<'a> {
        Keeper {
            order,
            width,
            listener,
            count: 0,
            runs: Vec::new(),
            told: Vec::new(),
            recorder: Recorder::new(order, plan),
            last: None,
            pairs: (method == Method::Fast).then(HashMap::new),
        }
    }

    /// Whether nothing had to be left out.
    pub(super) fn has_room(&self) -> bool {
        // By the fast methods, every step may be a run and told: their number is limited before.
        self.pairs.is_some() || self.runs.len() + self.told.len() <= MOST_KEPT
    }

    /// Sorts what was told late, and keeps the last word about each step.
    pub(super) fn sort(&mut self) {
        self.told.sort_by_key(|told| told.step);
        self.told.dedup_by(|later, earlier| {
            let same = later.step == earlier.step;
            if same {
                *earlier = *later;
            }
            same
        });
    }

    fn begin(&mut self, sample: Sample, tested: Tested) {
        let small = |index| u32::try_from(index).expect("a side of a picture");
        let pixel = small(sample.row) * self.width + small(sample.column);
        let goes_on = match (self.order, self.last, tested) {
            (Order::Object, Some((last, at)), _) => last == tested && at + 1 == pixel,
            (Order::Image, Some((Tested::Primitive(last), at)), Tested::Primitive(id)) => {
                last + 1 == id && at == pixel
            }
            _ => false,
        };
        if !goes_on {
            self.runs.push(Run { first: self.count, tested, pixel });
        }
        self.last = Some((tested, pixel));
        self.count += 1;
        if self.count.is_multiple_of(TELLS_EVERY) {
            (self.listener)(self.count);
        }
    }

    /// Notes what came of a step, which may be told in two words: that it is covered, and then whether it is nearer.
    fn tell(&mut self, step: u32, outcome: Outcome) {
        match self.told.last_mut().filter(|last| last.step == step) {
            Some(last) => last.outcome = outcome,
            None => self.told.push(Told { step, outcome, t: None }),
        }
    }

    /// Notes what came of the test of a pair.
    fn tell_of(&mut self, sample: Sample, primitive: u32, outcome: Outcome) {
        let step = match &self.pairs {
            Some(pairs) => pairs.get(&(sample, primitive)).copied(),
            None => self.count.checked_sub(1),
        };
        if let Some(step) = step {
            self.tell(step, outcome);
        }
    }
}

impl Observer for Keeper<'_> {
    fn fork(&self) -> Self {
        Keeper {
            count: 0,
            runs: Vec::new(),
            told: Vec::new(),
            recorder: self.recorder.fork(),
            last: None,
            pairs: self.pairs.as_ref().map(|_| HashMap::new()),
            ..*self
        }
    }

    fn join(&mut self, part: Self) {
        let before = self.count;
        self.recorder.join(part.recorder);
        self.runs.extend(part.runs.into_iter().map(|run| Run { first: before + run.first, ..run }));
        self.told
            .extend(part.told.into_iter().map(|told| Told { step: before + told.step, ..told }));
        self.count += part.count;
        self.last = None;
    }
}

impl Events for Keeper<'_> {
    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        self.recorder.primitive_begun(primitive, region);
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.recorder.ray_begun(sample);
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        if !self.has_room() {
            return;
        }
        self.begin(sample, Tested::Node(node));
        self.tell(self.count - 1, if entered { Outcome::Entered } else { Outcome::Missed });
        self.recorder.node_opened(sample, node, entered);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        if !self.has_room() {
            return;
        }
        if let Some(pairs) = &mut self.pairs {
            pairs.insert((sample, short(primitive)), self.count);
        }
        self.begin(sample, Tested::Primitive(short(primitive)));
        self.recorder.sample_tested(sample, primitive);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        if !self.has_room() {
            return;
        }
        self.tell_of(sample, short(primitive), Outcome::First);
        self.recorder.fragment(sample, primitive);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        if !self.has_room() {
            return;
        }
        let outcome = if replaced { Outcome::Nearer } else { Outcome::Behind };
        self.tell_of(sample, short(incoming), outcome);
        self.recorder.depth_test(sample, incoming, stored, replaced);
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u64>) {
        if self.has_room() {
            self.recorder.hit(sample, primitive);
        }
    }
}
