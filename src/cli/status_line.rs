//! A line on stderr that says what a command is doing: on a terminal, and only during the work.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::borrow::Cow;
use std::env;
use std::io::{IsTerminal, stderr};
use std::time::Duration;

/// Whether stderr is a terminal that can erase a line.
pub(super) fn is_erasable() -> bool {
    stderr().is_terminal() && env::var_os("TERM").is_none_or(|terminal| terminal != "dumb")
}

/// A line that disappears when this value is dropped. Where it cannot, it is never shown.
#[derive(Debug)]
pub(super) struct StatusLine {
    bar: ProgressBar,
}

impl StatusLine {
    /// A line with what is done, and how long it has taken.
    pub(super) fn new(what: &'static str) -> StatusLine {
        let line = StatusLine::styled(None, "{msg}, {elapsed}");
        line.say(what);
        line
    }

    /// A line with a bar of so many steps, of which some are done.
    pub(super) fn with_steps(all: u64, done: u64) -> StatusLine {
        let line = StatusLine::styled(Some(all), "[{bar:32}] {pos} of {len}, {elapsed}: {msg}");
        line.bar.set_position(done);
        line
    }

    fn styled(steps: Option<u64>, template: &str) -> StatusLine {
        let target = match is_erasable() {
            true => ProgressDrawTarget::stderr(),
            false => ProgressDrawTarget::hidden(),
        };
        let style = ProgressStyle::with_template(template).expect("the template is right");
        let bar = ProgressBar::with_draw_target(steps, target);
        bar.set_style(style.progress_chars("=> "));
        bar.enable_steady_tick(Duration::from_millis(200));
        StatusLine { bar }
    }

    /// Says what is done now.
    pub(super) fn say(&self, what: impl Into<Cow<'static, str>>) {
        self.bar.set_message(what);
    }

    /// One more step is done.
    pub(super) fn step(&self) {
        self.bar.inc(1);
    }

    /// Runs a function, such as printing a line, while this line is hidden.
    pub(super) fn suspend(&self, work: impl FnOnce()) {
        self.bar.suspend(work);
    }

    /// Erases the line before the value is dropped.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for StatusLine {
    fn drop(&mut self) {
        self.finish();
    }
}
