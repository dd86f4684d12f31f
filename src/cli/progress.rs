//! The bar on a terminal with the progress and the remaining time of a long rendering; and the message about a long
//! rendering, with or without a terminal.

use super::args::RenderArgs;
use super::forecast::{Forecast, advice, words};
use super::status_line::is_erasable;
use bothways::orders::Order;
use bothways::progress::{Progress, Stage};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// The shortest time of a run with a bar.
const PATIENCE: Duration = Duration::from_millis(400);
/// The interval of time updates, with or without a finished step.
const TICK: Duration = Duration::from_millis(200);

/// A bar on stderr that disappears completely when this value is dropped. If stderr is no terminal, nothing is drawn.
#[derive(Debug)]
pub(super) struct Bar<'a> {
    args: &'a RenderArgs,
    bar: ProgressBar,
    begun: Instant,
    forecast: Arc<Mutex<Forecast>>,
    /// Dropping the sender ends the wait.
    waiting: Option<Sender<()>>,
    appearing: Option<JoinHandle<()>>,
}

impl Bar<'_> {
    /// A bar that appears after a moment if stderr is a terminal that can erase the bar; `None` with `--quiet`.
    ///
    /// The destination of stdout does not matter: a user also waits for `bothways --json > report.json`.
    pub(super) fn of_run(args: &RenderArgs) -> Option<Bar<'_>> {
        (!args.output.quiet).then(|| Bar::new(args, is_erasable()))
    }

    /// Shows the name of a task during the task, if the task takes more than a moment.
    pub(super) fn during<T>(what: &'static str, args: &RenderArgs, work: impl FnOnce() -> T) -> T {
        let _bar = Bar::of_run(args).inspect(|bar| bar.say(what));
        work()
    }

    fn new(args: &RenderArgs, is_seen: bool) -> Bar<'_> {
        let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::hidden());
        let (waiting, dropped) = channel();
        let appearing = is_seen.then(|| {
            let bar = bar.clone();
            thread::spawn(move || appear(&bar, &dropped))
        });
        let forecast = Forecast::new(args.method.order.orders().len());
        let forecast = Arc::new(Mutex::new(forecast));
        Bar { args, bar, begun: Instant::now(), forecast, waiting: Some(waiting), appearing }
    }

    /// Shows the stage of an order, and its progress.
    pub(super) fn show(&self, progress: Progress) {
        let whole = locked(&self.forecast).note(progress, self.begun.elapsed());
        let order = progress.order.name();
        match progress.stage {
            Stage::Preparing => {
                self.bar.set_style(without_bar());
                self.bar.set_message(format!("{order}: preparing"));
            }
            Stage::Rendering => {
                if progress.done == 0 {
                    self.bar.set_style(self.with_bar());
                    // Both names get the same width, so that the bar does not move.
                    let room = Order::Object.name().len();
                    self.bar.set_message(format!("{order:room$}"));
                    self.bar.set_length(progress.total);
                }
                self.bar.set_position(progress.done);
            }
        }
        if let Some(whole) = whole {
            let note = advice(whole, self.args);
            self.bar.suspend(|| anstream::eprintln!("note: {note}"));
        }
    }

    /// Shows the number of finished steps of a task. The task reports each step.
    pub(super) fn count(&self, what: &'static str, total: u64) {
        let style = style("{msg} [{bar:32}] {percent:>3} %, about {eta} left");
        self.bar.set_style(style.progress_chars("=> "));
        self.bar.set_message(what);
        self.bar.set_length(total);
        self.bar.set_position(0);
        self.bar.reset_eta();
    }

    /// Counts one more finished step.
    pub(super) fn step(&self) {
        self.bar.inc(1);
    }

    /// Runs a function, such as printing a line, while the bar is hidden.
    pub(super) fn suspend(&self, work: impl FnOnce()) {
        self.bar.suspend(work);
    }

    /// Shows a task without steps.
    pub(super) fn say(&self, what: &'static str) {
        self.bar.set_style(without_bar());
        self.bar.set_message(what);
    }

    /// The style without colours, so that `NO_COLOR` needs no extra code.
    fn with_bar(&self) -> ProgressStyle {
        let (forecast, begun) = (Arc::clone(&self.forecast), self.begun);
        let left = move |_: &ProgressState, out: &mut dyn Write| {
            if let Some(left) = locked(&forecast).left(begun.elapsed()) {
                // An error in drawing the bar is not reported.
                let _ = write!(out, ", about {} left", words(left));
            }
        };
        let style = style("{msg} [{bar:32}] {percent:>3} %, {elapsed}{left}");
        style.with_key("left", left).progress_chars("=> ")
    }
}

impl Drop for Bar<'_> {
    fn drop(&mut self) {
        self.waiting = None;
        if let Some(appearing) = self.appearing.take() {
            // The thread cannot fail, and an error in drawing the bar is not reported.
            let _ = appearing.join();
        }
        self.bar.finish_and_clear();
    }
}

fn locked(forecast: &Mutex<Forecast>) -> MutexGuard<'_, Forecast> {
    forecast.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Lets the bar appear unless it is dropped before.
fn appear(bar: &ProgressBar, dropped: &Receiver<()>) {
    if dropped.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
        bar.set_draw_target(ProgressDrawTarget::stderr());
        bar.enable_steady_tick(TICK);
    }
}

fn without_bar() -> ProgressStyle {
    style("{msg}, {elapsed}")
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the template is right")
}
