//! Agreement fuzzing: random hostile scenes, drawn by all four renderers.
//!
//! [`run`] draws scene after scene by both fast renderers, and all of a small picture or a part of a large one by both
//! textbooks. Whenever two of the four see different primitives at a sample, or one panics, it shrinks the scene to
//! the fewest primitives, the smallest picture and the simplest numbers that still show it: a [`Finding`].
//! [`scene_files`] writes one as a scene file.
//!
//! The scene of a number depends on the seed and the number alone, so that a seed means the same scenes on any number of
//! threads.
//!
//! ```
//! use bothways_lab::fuzz::{self, Limit, Options, Renderers};
//!
//! let options = Options { seed: 7, limit: Limit::Scenes(20), ..Options::default() };
//! let summary = fuzz::run(&options, &Renderers::sound());
//! assert_eq!((summary.scenes, summary.disagreements), (20, 0));
//! ```
//!
//! A renderer with a fault takes the place of a sound one by [`Renderers::with`].
//!
//! The cargo-fuzz targets in `fuzz/` are the other half. There, coverage feedback steers arbitrary bytes into rare branches of
//! one fast renderer at a time, at all SIMD levels and sizes of tiles, on small pictures. Here, a generator makes close calls
//! on purpose and draws whole pictures of many tiles as users do, with the program as it is installed.

mod case;
mod check;
mod close_calls;
mod dice;
mod generate;
mod panics;
mod renderers;
mod scene_files;
mod shrink;
mod summary;
mod watch;

pub use case::Case;
pub use check::{Checked, Disagreement, Witness};
pub use close_calls::CloseCalls;
pub use generate::generate;
pub use panics::is_watched;
pub use renderers::{Draw, Renderers};
pub use scene_files::{command, scene_files};
pub use summary::{Finding, Size, Summary};

use dice::Dice;
use rayon::ThreadPoolBuilder;
use std::num::NonZero;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use watch::Watch;

/// The findings that a run shrinks. A renderer with a fault may fail in every scene.
const MOST_FINDINGS: usize = 10;

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// After this many scenes.
    Scenes(u64),
    /// After this time. Scenes that have begun are finished, and findings are shrunk; see [`Event::Overdue`].
    Time(Duration),
}

/// What to run.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The seed: the same scenes for the same seed.
    pub seed: u64,
    /// The number of the first scene.
    pub first: u64,
    /// When to end.
    pub limit: Limit,
    /// The threads; each draws scenes of its own. `None` for one for each core.
    pub threads: Option<NonZero<usize>>,
    /// Ends the run early once it is true.
    pub stop: Option<&'a AtomicBool>,
    /// A scene that takes longer is reported, and so is a run that should have ended so long ago.
    pub patience: Duration,
    /// Receives every scene and every finding, in the order in which they end.
    pub listener: Option<&'a (dyn Fn(Event) + Sync)>,
}

impl Default for Options<'_> {
    /// 1000 scenes of seed 0, on all cores.
    fn default() -> Self {
        Options {
            seed: 0,
            first: 0,
            limit: Limit::Scenes(1000),
            threads: None,
            stop: None,
            patience: Duration::from_secs(10),
            listener: None,
        }
    }
}

impl std::fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Options { seed, first, limit, threads, .. } = self;
        write!(f, "Options {{ seed: {seed}, first: {first}, {limit:?}, threads: {threads:?}, .. }}")
    }
}

/// What a run tells while it goes on.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// One more scene is checked.
    Checked(&'a Checked),
    /// A disagreement is shrunk.
    Found(&'a Finding),
    /// The scene of this number takes long; told once.
    Slow(u64),
    /// The run should have ended, and scenes that had begun have not: the summary so far, with their numbers; told once.
    /// The run goes on until they end. Whoever cannot wait ends the program.
    Overdue(&'a Summary),
}

/// Draws random scenes by all four renderers, until the limit or an order to stop.
///
/// Every scene is drawn on one thread. The summary is the same for any number of threads if the limit is a number of scenes.
/// The scenes of the first ten disagreements are shrunk.
pub fn run(options: &Options, renderers: &Renderers) -> Summary {
    let threads = options.threads.or_else(|| thread::available_parallelism().ok());
    let threads = threads.map_or(1, NonZero::get);
    let run = Run {
        options,
        renderers,
        begun: Instant::now(),
        next: AtomicU64::new(options.first),
        summary: Mutex::new(Summary::new(options.seed, options.first)),
        watch: Watch::new(threads),
    };
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| run.work());
        }
        run.watch();
    });
    let mut summary = run.summary.into_inner().unwrap_or_else(PoisonError::into_inner);
    summary.ended_early = is_stopped(options);
    summary.findings.truncate(MOST_FINDINGS);
    summary
}

fn is_stopped(options: &Options) -> bool {
    options.stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
}

/// What the threads of a run share.
struct Run<'a> {
    options: &'a Options<'a>,
    renderers: &'a Renderers,
    begun: Instant,
    /// The number of the next scene.
    next: AtomicU64,
    summary: Mutex<Summary>,
    watch: Watch,
}

impl Run<'_> {
    /// Takes scene after scene, on one thread: the renderers find a pool of this thread alone.
    fn work(&self) {
        let _guard = self.watch.guard();
        let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        let pool = pool.expect("a pool of the current thread needs no other");
        pool.install(|| {
            while let Some(number) = self.next_scene() {
                let _guard = self.watch.scene(number);
                self.check(number);
            }
        });
    }

    /// Tells of scenes that take long, until the other threads have ended.
    fn watch(&self) {
        let mut since_the_end: Option<Instant> = None;
        let mut is_told = false;
        while self.watch.goes_on(self.options.patience) {
            for scene in self.watch.slow(self.options.patience) {
                self.tell(Event::Slow(scene));
            }
            if since_the_end.is_none() && self.is_over() {
                since_the_end = Some(Instant::now());
            }
            let is_late = since_the_end.is_some_and(|end| end.elapsed() >= self.options.patience);
            if is_late && !is_told {
                is_told = true;
                let mut summary = self.with_summary(|summary| summary.clone());
                summary.unfinished = self.watch.scenes();
                summary.ended_early = is_stopped(self.options);
                self.tell(Event::Overdue(&summary));
            }
        }
    }

    /// Whether no more scenes begin, because of time or of an order to stop.
    fn is_over(&self) -> bool {
        self.is_late(Duration::ZERO) || is_stopped(self.options)
    }

    /// Whether the time of the run has ended so long ago.
    fn is_late(&self, by: Duration) -> bool {
        matches!(self.options.limit, Limit::Time(time) if self.begun.elapsed() >= time + by)
    }

    fn next_scene(&self) -> Option<u64> {
        let Options { first, limit, .. } = *self.options;
        if self.is_over() {
            return None;
        }
        let number = self.next.fetch_add(1, Ordering::Relaxed);
        let is_over = matches!(limit, Limit::Scenes(scenes) if number - first >= scenes);
        (!is_over).then_some(number)
    }

    fn check(&self, number: u64) {
        let mut dice = Dice::new(self.options.seed, number);
        let case = generate::generate_with(&mut dice);
        let checked = check::check(&case, self.renderers, None, &mut dice);
        let checked = checked.expect("only accepted cases are generated");
        let disagreement = checked.disagreement.clone();
        self.with_summary(|summary| summary.count(&checked));
        self.tell(Event::Checked(&checked));
        let Some(disagreement) = disagreement else { return };
        let earlier = self.with_summary(|summary| {
            summary.findings.iter().filter(|finding| finding.scene < number).count()
        });
        if earlier < MOST_FINDINGS {
            let finding = self.shrunk(number, case, disagreement);
            self.tell(Event::Found(&finding));
            self.with_summary(|summary| summary.add(finding));
        }
    }

    fn shrunk(&self, number: u64, case: Case, disagreement: Disagreement) -> Finding {
        let original = Size::of(&case);
        // What is found late is shrunk for as long as the run may be late.
        let is_stopped = || is_stopped(self.options) || self.is_late(self.options.patience / 2);
        let shrunk = shrink::shrink(case, disagreement, self.renderers, &is_stopped);
        Finding {
            seed: self.options.seed,
            scene: number,
            original,
            shrunk: Size::of(&shrunk.case),
            steps: shrunk.steps,
            disagreement: shrunk.disagreement,
            case: shrunk.case,
        }
    }

    fn tell(&self, event: Event) {
        if let Some(listener) = self.options.listener {
            listener(event);
        }
    }

    fn with_summary<T>(&self, change: impl FnOnce(&mut Summary) -> T) -> T {
        change(&mut self.summary.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
