//! The options for one order.

use super::rules::Rules;
use crate::common::Options;
use crate::progress::Listener;

/// The options for one order. The default: one sample per pixel, exact rules, the work counted, one frame timed, no listener.
#[derive(Clone, Copy, Default)]
pub struct RenderOptions<'a> {
    /// The options of the frame.
    pub frame: Options,
    /// The rules of ordinary renderers that take the place of the exact ones, in an order that has some. The work of
    /// such an order is not counted.
    pub rules: Rules,
    /// With a number, each phase runs once for the warm-up and then this many times for measurement, into the same
    /// buffers; without a number, each phase is timed once, warmed up by the phases before. Never 0.
    pub repeat: Option<u32>,
    /// Whether to leave out the frame that counts the work of the algorithm. That frame may take longer than the timed
    /// frames. What a frame executed is counted in any case, in the frame itself.
    pub no_counts: bool,
    /// Whether to leave out times. Then no frame is repeated for timing: at most one is drawn beside the frame that
    /// counts. WebAssembly without a system has no clock, and needs this.
    pub no_times: bool,
    /// Whether shading also stores the linear colour and the normal of every sample, for
    /// [`Frame::colors`](crate::common::Frame::colors) and [`Frame::normals`](crate::common::Frame::normals).
    pub colors_and_normals: bool,
    /// A function that is called with the progress of the rendering; the call changes no bit of the result.
    pub progress: Option<Listener<'a>>,
}

impl std::fmt::Debug for RenderOptions<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        let RenderOptions { frame, rules, repeat, no_counts, no_times, progress, .. } = self;
        let progress = progress.map(|_| "a listener");
        formatter
            .debug_struct("RenderOptions")
            .field("frame", frame)
            .field("rules", rules)
            .field("repeat", repeat)
            .field("no_counts", no_counts)
            .field("no_times", no_times)
            .field("colors_and_normals", &self.colors_and_normals)
            .field("progress", &progress)
            .finish()
    }
}
