//! Progress of steps of equal length, such as samples for the textbook: a bar on a terminal, and a message in advance
//! if the steps take long.

use super::forecast::words;
use super::progress::Bar;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// The time after which a good estimate is possible.
const FIRST_LOOK: Duration = Duration::from_secs(3);
/// A longer estimate gets a message.
const LONG: Duration = Duration::from_secs(60);

/// A counter of steps.
pub(super) struct Patience<'a> {
    /// `None` with `--quiet`.
    bar: Option<&'a Bar<'a>>,
    total: u64,
    done: AtomicU64,
    begun: Instant,
    /// The number of steps done at the time of the estimate; 0 before.
    guessed: AtomicU64,
}

impl<'a> Patience<'a> {
    /// A counter for this number of samples that the textbook answers.
    pub(super) fn new(total: u64, bar: Option<&'a Bar<'a>>) -> Patience<'a> {
        if let Some(bar) = bar {
            bar.count("answering samples by the textbook", total);
        }
        let (done, guessed) = (AtomicU64::new(0), AtomicU64::new(0));
        Patience { bar, total, done, begun: Instant::now(), guessed }
    }

    /// Counts one more step.
    pub(super) fn step(&self) {
        let Some(bar) = self.bar else { return };
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        bar.step();
        let elapsed = self.begun.elapsed();
        let first = elapsed >= FIRST_LOOK && self.guessed.load(Ordering::Relaxed) == 0;
        if first && self.guessed.swap(done, Ordering::Relaxed) == 0 {
            self.guess(bar, done, elapsed);
        }
    }

    fn guess(&self, bar: &Bar, done: u64, elapsed: Duration) {
        #[expect(clippy::cast_precision_loss, reason = "a guess")]
        let all = elapsed.mul_f64(self.total as f64 / done as f64);
        if all > LONG {
            let all = words(all);
            bar.suspend(|| {
                anstream::eprintln!(
                    "note: answering these samples by the textbook takes about {all}, as it tests every primitive at \
                     each: a smaller --verify shortens it"
                );
            });
        }
    }
}
