//! The progress of a film, on a terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::borrow::Cow;
use std::env;
use std::io::{IsTerminal, stderr};
use std::time::Duration;

/// A line on stderr that disappears at the end.
pub(in crate::cli) struct Progress {
    bar: ProgressBar,
    frames: u32,
}

impl Progress {
    /// The progress of a film with so many frames, or of something else.
    pub(in crate::cli) fn new(frames: u32) -> Progress {
        let erases = env::var_os("TERM").is_none_or(|terminal| terminal != "dumb");
        let is_seen = erases && stderr().is_terminal();
        let target =
            if is_seen { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let style = ProgressStyle::with_template("{msg}, {elapsed}");
        let bar = ProgressBar::with_draw_target(None, target)
            .with_style(style.expect("the template is right"));
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress { bar, frames }
    }

    pub(in crate::cli) fn say(&self, what: impl Into<Cow<'static, str>>) {
        self.bar.set_message(what);
    }

    /// A frame is written.
    pub(super) fn frame(&self, number: u32) {
        self.bar.set_message(format!("frame {number} of {}", self.frames));
    }

    pub(in crate::cli) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
