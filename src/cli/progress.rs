//! The bar that shows, on a terminal, how far a long rendering has come.

use super::args::RenderArgs;
use bothways::orders::Order;
use bothways::progress::{Progress, Stage};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::env;
use std::io::{IsTerminal, stderr};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Who waits for less is not told.
const PATIENCE: Duration = Duration::from_millis(400);
/// How often the time is counted on, whether or not a step is done.
const TICK: Duration = Duration::from_millis(200);

/// A bar on stderr that is gone without a trace when this is dropped.
#[derive(Debug)]
pub(super) struct Bar {
    bar: ProgressBar,
    /// Dropped to stop waiting.
    waiting: Option<Sender<()>>,
    appearing: Option<JoinHandle<()>>,
}

impl Bar {
    /// A bar that appears after a moment; `None` if nobody wants one, or stderr is no terminal that
    /// could erase it.
    ///
    /// What goes to stdout does not matter: `bothways --json > report.json` has somebody waiting, too.
    pub(super) fn of_run(args: &RenderArgs) -> Option<Bar> {
        let erases = env::var_os("TERM").is_none_or(|terminal| terminal != "dumb");
        (!args.output.quiet && erases && stderr().is_terminal()).then(Bar::new)
    }

    /// Says what is being done while it is done, if that takes more than a moment.
    pub(super) fn during<T>(what: &'static str, args: &RenderArgs, work: impl FnOnce() -> T) -> T {
        let _bar = Bar::of_run(args).inspect(|bar| bar.say(what));
        work()
    }

    fn new() -> Bar {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        let (waiting, dropped) = channel();
        let appearing = thread::spawn({
            let bar = bar.clone();
            move || appear(&bar, &dropped)
        });
        Bar { bar, waiting: Some(waiting), appearing: Some(appearing) }
    }

    /// Shows what an order does, and how much of it is done.
    pub(super) fn show(&self, progress: Progress) {
        let order = progress.order.name();
        match progress.stage {
            Stage::Preparing => {
                self.bar.set_style(without_bar());
                self.bar.set_message(format!("{order}: preparing"));
            }
            Stage::Rendering => {
                if progress.done == 0 {
                    self.bar.set_style(with_bar());
                    // Both names take the same room, so that the bar stays where it is.
                    let room = Order::Object.name().len();
                    self.bar.set_message(format!("{order:room$}"));
                    self.bar.set_length(progress.total);
                }
                self.bar.set_position(progress.done);
            }
        }
    }

    /// Shows how many steps of something are done.
    pub(super) fn count(&self, what: &'static str, done: u64, total: u64) {
        if done <= 1 {
            self.bar.set_style(with_bar());
            self.bar.set_message(what);
            self.bar.set_length(total);
        }
        self.bar.set_position(done);
    }

    /// Does something, such as printing a line, while the bar is out of the way.
    pub(super) fn suspend(&self, work: impl FnOnce()) {
        self.bar.suspend(work);
    }

    /// Says what is done that has no steps.
    pub(super) fn say(&self, what: &'static str) {
        self.bar.set_style(without_bar());
        self.bar.set_message(what);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.waiting = None;
        if let Some(appearing) = self.appearing.take() {
            // It has nothing that could fail, and a bar is not worth a failure.
            let _ = appearing.join();
        }
        self.bar.finish_and_clear();
    }
}

/// Lets the bar appear unless it is dropped before.
fn appear(bar: &ProgressBar, dropped: &Receiver<()>) {
    if dropped.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        bar.enable_steady_tick(TICK);
    }
}

/// Without colours, so that `NO_COLOR` needs no care.
fn with_bar() -> ProgressStyle {
    style("{msg} [{bar:32}] {percent:>3} %, {elapsed}").progress_chars("=> ")
}

fn without_bar() -> ProgressStyle {
    style("{msg}, {elapsed}")
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the template is right")
}
