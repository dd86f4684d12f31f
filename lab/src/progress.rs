//! The progress of a rendering, reported while it runs.
//!
//! The fast renderers report frame by frame, and chunk by chunk if a mesh is streamed. The textbooks, which can take
//! minutes for one frame, report each step of their outer loop. An observer reports the steps: the code of a textbook
//! stays unchanged, and costs nothing without a listener.

use crate::common::observe::{Events, Observer};
use crate::common::raster::Region;
use crate::common::raster::Sample;
use crate::orders::order::Order;
use std::sync::atomic::{AtomicU64, Ordering};

/// A function that is called with the progress, from any thread; at most once for each step.
pub type Listener<'a> = &'a (dyn Fn(Progress) + Sync);

/// The progress of one order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// The order.
    pub order: Order,
    /// The stage of the order.
    pub stage: Stage,
    /// The finished steps, over all frames: none while the scene is prepared, all at the end.
    pub done: u64,
    /// The number of all steps: the steps of a textbook's outer loop, the triangle chunks of a stream, otherwise
    /// frames.
    pub total: u64,
}

/// The stages of an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The work that a moving camera would not repeat.
    Preparing,
    /// The frames: one frame for the count of the work, one frame for the warm-up if there are several frames, and
    /// the timed frames.
    Rendering,
}

/// The steps of one order, counted for a listener, if there is one.
#[derive(Clone, Copy)]
pub(crate) struct Steps<'a> {
    order: Order,
    listener: Option<Listener<'a>>,
    /// The number of steps within a frame, if the frame is observed.
    within_frame: Option<u64>,
    frames: u64,
    done: &'a AtomicU64,
}

impl<'a> Steps<'a> {
    pub(crate) fn new(
        order: Order,
        listener: Option<Listener<'a>>,
        within_frame: Option<u64>,
        frames: u64,
        done: &'a AtomicU64,
    ) -> Steps<'a> {
        Steps { order, listener, within_frame, frames, done }
    }

    /// An observer that counts the steps of a frame; `None` if frames count as a whole, or there is no listener.
    pub(crate) fn watch(&self) -> Option<Watch<'a>> {
        (self.listener.is_some() && self.within_frame.is_some())
            .then_some(Watch { steps: *self, row: None })
    }

    pub(crate) fn preparing(&self) {
        self.report(Stage::Preparing, 0);
    }

    /// The number of rendered frames.
    pub(crate) fn frames_drawn(&self) -> u64 {
        self.done.load(Ordering::Relaxed) / self.within_frame.unwrap_or(1).max(1)
    }

    /// Reports this number of finished frames.
    pub(crate) fn frames_done(&self, frames: u64) {
        let done = frames.saturating_mul(self.within_frame.unwrap_or(1));
        self.done.store(done, Ordering::Relaxed);
        self.report(Stage::Rendering, done);
    }

    fn report(&self, stage: Stage, done: u64) {
        if let Some(listener) = self.listener {
            // No run draws that number of frames, but `--repeat` may ask for it.
            let total = self.frames.saturating_mul(self.within_frame.unwrap_or(1));
            listener(Progress { order: self.order, stage, done, total });
        }
    }

    /// Begins one more step: the steps before it are finished.
    pub(crate) fn begin(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        // The first step of a frame is reported together with the previous frame.
        if !done.is_multiple_of(self.within_frame.unwrap_or(1)) {
            self.report(Stage::Rendering, done);
        }
    }
}

/// Counts the steps of an outer loop: primitives in object order, rows of samples in image order.
#[derive(Clone, Copy)]
pub(crate) struct Watch<'a> {
    steps: Steps<'a>,
    /// The row of the last ray.
    row: Option<usize>,
}

impl Observer for Watch<'_> {
    fn fork(&self) -> Self {
        *self
    }

    fn join(&mut self, _part: Self) {}
}

impl Events for Watch<'_> {
    fn primitive_begun(&mut self, _primitive: u64, _region: &Region) {
        self.steps.begin();
    }

    fn ray_begun(&mut self, sample: Sample) {
        if self.row.replace(sample.row) != Some(sample.row) {
            self.steps.begin();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn rows_count_wherever_they_begin() {
        let (reported, done) = (Mutex::new(Vec::new()), AtomicU64::new(0));
        let listener = |progress: Progress| reported.lock().unwrap().push(progress.done);
        let steps = Steps::new(Order::Image, Some(&listener), Some(3), 1, &done);
        let mut watch = steps.watch().unwrap();
        steps.frames_done(0);
        for row in 5..8 {
            (7..9).for_each(|column| watch.ray_begun(Sample { row, column }));
        }
        steps.frames_done(1);
        assert_eq!(reported.into_inner().unwrap(), [0, 1, 2, 3]);
    }
}
