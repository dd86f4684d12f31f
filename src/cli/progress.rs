//! The bar that shows, on a terminal, how far a long rendering has come and how long it still takes; and the
//! line that says that it will be long, on a terminal or not.

use super::args::RenderArgs;
use super::forecast::{Forecast, advice, words};
use bothways::orders::Order;
use bothways::progress::{Progress, Stage};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::env;
use std::fmt::Write;
use std::io::{IsTerminal, stderr};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// A run that is shorter shows no bar.
const PATIENCE: Duration = Duration::from_millis(400);
/// How often the time is counted on, whether or not a step is done.
const TICK: Duration = Duration::from_millis(200);

/// A bar on stderr that is gone without a trace when this is dropped. Where stderr is no terminal nothing is
/// drawn.
#[derive(Debug)]
pub(super) struct Bar<'a> {
    args: &'a RenderArgs,
    bar: ProgressBar,
    begun: Instant,
    forecast: Arc<Mutex<Forecast>>,
    /// Dropped to stop waiting.
    waiting: Option<Sender<()>>,
    appearing: Option<JoinHandle<()>>,
}

impl Bar<'_> {
    /// A bar that appears after a moment if stderr is a terminal that can erase it; `None` with
    /// `--quiet`.
    ///
    /// Where stdout goes does not matter: a person waits for `bothways --json > report.json`, too.
    pub(super) fn of_run(args: &RenderArgs) -> Option<Bar<'_>> {
        let erases = env::var_os("TERM").is_none_or(|terminal| terminal != "dumb");
        (!args.output.quiet).then(|| Bar::new(args, erases && stderr().is_terminal()))
    }

    /// Says what is being done while it is done, if that takes more than a moment.
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

    /// Shows what an order does, and how much of it is done.
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
                    // Both names take the same room, so that the bar stays where it is.
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

    /// Shows how many steps of something are done, each of which is told of.
    pub(super) fn count(&self, what: &'static str, total: u64) {
        let style = style("{msg} [{bar:32}] {percent:>3} %, about {eta} left");
        self.bar.set_style(style.progress_chars("=> "));
        self.bar.set_message(what);
        self.bar.set_length(total);
        self.bar.set_position(0);
        self.bar.reset_eta();
    }

    /// One more of them is done.
    pub(super) fn step(&self) {
        self.bar.inc(1);
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

    /// Without colours, so that `NO_COLOR` needs no care.
    fn with_bar(&self) -> ProgressStyle {
        let (forecast, begun) = (Arc::clone(&self.forecast), self.begun);
        let left = move |_: &ProgressState, out: &mut dyn Write| {
            if let Some(left) = locked(&forecast).left(begun.elapsed()) {
                // A bar is not worth a failure.
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
            // It has nothing that could fail, and a bar is not worth a failure.
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
