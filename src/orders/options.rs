//! How an order is to be run.

use crate::common::Options;
use crate::progress::Listener;

/// How an order is to be run. The default: one sample a pixel, the work counted, one frame timed, no listener.
#[derive(Clone, Copy, Default)]
pub struct RenderOptions<'a> {
    /// What a frame holds.
    pub frame: Options,
    /// With a number, everything is done once to warm up and then timed so many times, into the same
    /// buffers; without, it is timed once, warmed up by what went before. Never 0.
    pub repeat: Option<u32>,
    /// Whether the frame that counts the work is left out. It may take longer than those that are timed.
    pub no_counts: bool,
    /// Whether times are left out: then no frame is drawn to be timed, unless it is the only one.
    pub no_times: bool,
    /// A function that is told how far the rendering has come; that changes no bit of the answer.
    pub progress: Option<Listener<'a>>,
}

impl std::fmt::Debug for RenderOptions<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        let RenderOptions { frame, repeat, no_counts, no_times, progress } = self;
        let progress = progress.map(|_| "a listener");
        formatter
            .debug_struct("RenderOptions")
            .field("frame", frame)
            .field("repeat", repeat)
            .field("no_counts", no_counts)
            .field("no_times", no_times)
            .field("progress", &progress)
            .finish()
    }
}
