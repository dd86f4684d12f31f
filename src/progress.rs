//! How far a rendering has come, told while it runs.
//!
//! The fast renderers report frame by frame, and chunk by chunk where a mesh is streamed. The textbooks, which
//! can take minutes for one frame, report each step of their outer loop. An observer does that: the page of a
//! textbook stays as it is, and costs nothing where there is no listener.

use crate::common::observe::{Events, Observer};
use crate::common::raster::Region;
use crate::common::raster::Sample;
use crate::orders::order::Order;
use std::sync::atomic::{AtomicU64, Ordering};

/// A function that is told of progress, from any thread; never twice of the same step.
pub type Listener<'a> = &'a (dyn Fn(Progress) + Sync);

/// How far one order has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Which order.
    pub order: Order,
    /// What it does.
    pub stage: Stage,
    /// Steps that are done, over all frames: none while the scene is prepared, in the end all.
    pub done: u64,
    /// All steps: for a textbook those of its outer loop, for a stream its chunks of triangles, otherwise
    /// frames.
    pub total: u64,
}

/// What an order does with a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// What a moving camera would not repeat.
    Preparing,
    /// Frames: one that counts the work, one to warm up if there are to be several, and the timed ones.
    Rendering,
}

/// The steps of one order, counted for a listener, if there is one.
#[derive(Clone, Copy)]
pub(crate) struct Steps<'a> {
    order: Order,
    listener: Option<Listener<'a>>,
    /// Steps within a frame, where it is watched.
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

    /// An observer that counts the steps of a frame; `None` where frames count as a whole, or there is no
    /// listener.
    pub(crate) fn watch(&self) -> Option<Watch<'a>> {
        (self.listener.is_some() && self.within_frame.is_some())
            .then_some(Watch { steps: *self, row: None })
    }

    pub(crate) fn preparing(&self) {
        self.tell(Stage::Preparing, 0);
    }

    /// How many frames are rendered.
    pub(crate) fn frames_drawn(&self) -> u64 {
        self.done.load(Ordering::Relaxed) / self.within_frame.unwrap_or(1).max(1)
    }

    /// So many frames are rendered.
    pub(crate) fn frames_done(&self, frames: u64) {
        let done = frames.saturating_mul(self.within_frame.unwrap_or(1));
        self.done.store(done, Ordering::Relaxed);
        self.tell(Stage::Rendering, done);
    }

    fn tell(&self, stage: Stage, done: u64) {
        if let Some(listener) = self.listener {
            // No run draws so many frames, but `--repeat` may ask for them.
            let total = self.frames.saturating_mul(self.within_frame.unwrap_or(1));
            listener(Progress { order: self.order, stage, done, total });
        }
    }

    /// One more step begins: those before it are done.
    pub(crate) fn begin(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed);
        // The first of a frame was told with the frame before it.
        if !done.is_multiple_of(self.within_frame.unwrap_or(1)) {
            self.tell(Stage::Rendering, done);
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
    fn primitive_begun(&mut self, _primitive: u32, _region: &Region) {
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
        let (told, done) = (Mutex::new(Vec::new()), AtomicU64::new(0));
        let listener = |progress: Progress| told.lock().unwrap().push(progress.done);
        let steps = Steps::new(Order::Image, Some(&listener), Some(3), 1, &done);
        let mut watch = steps.watch().unwrap();
        steps.frames_done(0);
        for row in 5..8 {
            (7..9).for_each(|column| watch.ray_begun(Sample { row, column }));
        }
        steps.frames_done(1);
        assert_eq!(told.into_inner().unwrap(), [0, 1, 2, 3]);
    }
}
