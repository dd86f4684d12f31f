//! How long the textbook will take, said as soon as it is seen.

use super::args::RenderArgs;
use super::progress::Bar;
use bothways::orders::Rendered;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// After so long a good guess is possible.
const FIRST_LOOK: Duration = Duration::from_secs(3);
/// What takes longer is said.
const LONG: Duration = Duration::from_secs(60);

/// Counts steps of equal length: shows them on a terminal, and says once that they will take long, on whatever stderr is.
pub(super) struct Patience<'a> {
    bar: Option<&'a Bar>,
    total: u64,
    done: AtomicU64,
    begun: Instant,
    /// Steps that were done when it was guessed; 0 before.
    guessed: AtomicU64,
    quiet: bool,
}

impl<'a> Patience<'a> {
    /// For what was rendered, of which each order answers as many samples as are asked for, in whole pixels.
    pub(super) fn new(
        args: &RenderArgs,
        rendered: &[Rendered],
        samples: u32,
        bar: Option<&'a Bar>,
    ) -> Patience<'a> {
        let pixels_of = |one: &Rendered| {
            let [width, height] = one.frame.image().map(u64::from);
            u64::from(samples).div_ceil(u64::from(one.frame.samples()).pow(2)).min(width * height)
        };
        let total = rendered.iter().map(pixels_of).sum();
        Patience {
            bar,
            total,
            done: AtomicU64::new(0),
            begun: Instant::now(),
            guessed: AtomicU64::new(0),
            quiet: args.output.quiet,
        }
    }

    /// One more is done.
    pub(super) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if let Some(bar) = self.bar {
            bar.count("answering samples by the textbook", done, self.total);
        }
        let elapsed = self.begun.elapsed();
        let first = elapsed >= FIRST_LOOK && self.guessed.load(Ordering::Relaxed) == 0;
        if first && self.guessed.swap(done, Ordering::Relaxed) == 0 {
            self.guess(done, elapsed);
        }
    }

    fn guess(&self, done: u64, elapsed: Duration) {
        #[expect(clippy::cast_precision_loss, reason = "a guess")]
        let rest = elapsed.mul_f64(self.total.saturating_sub(done) as f64 / done as f64);
        if rest > LONG && !self.quiet {
            let minutes = rest.as_secs().div_ceil(60);
            let line = format!(
                "hint: answering these samples by the textbook takes about {minutes} more minutes; --verify with a \
                 smaller number takes less"
            );
            match self.bar {
                Some(bar) => bar.suspend(|| anstream::eprintln!("{line}")),
                None => anstream::eprintln!("{line}"),
            }
        }
    }
}
