//! The work of the algorithm for a frame, counted up to a limit.

use super::options::RenderOptions;
use super::order::Order;
use crate::common::Work;
use crate::common::observe::budget::{Budget, WorkWithin};

/// The counted work of the algorithm for a frame. What the frame executed is another count:
/// [`Executed`](crate::common::Executed).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// The complete count.
    Counted(Work),
    /// No count: the work is more than `most` steps, in the unit of [`Work::steps`].
    TooMany {
        /// The limit, from [`most_steps`].
        most: u64,
    },
    /// No count: the options turn counting off, or the order has the rules of an ordinary renderer.
    LeftOut,
}

/// The number of steps at which counting stops, for a frame with this number of samples: 2¹⁰ per sample plus 2²⁸.
/// Usually a ray meets some hundred boxes and triangles; counting a scene with more could take hours.
pub fn most_steps(samples: u64) -> u64 {
    (1 << 28) + (samples << 10)
}

/// Whether the work is counted.
#[derive(Clone, Copy, Debug)]
pub(super) enum Counting {
    /// The work is counted in a separate frame, up to `most` steps.
    AtMost { most: u64, samples: u64 },
    /// The work is not counted, for a reason known in advance.
    Not(Counts),
}

impl Counting {
    /// The way of counting for a frame with this number of samples.
    pub(super) fn new(options: &RenderOptions, order: Order, samples: u64) -> Counting {
        if options.no_counts || options.rules.of(order).is_some() {
            return Counting::Not(Counts::LeftOut);
        }
        Counting::AtMost { most: most_steps(samples), samples }
    }

    /// The same where every primitive is tested at every sample: the number of steps is then known in advance.
    pub(super) fn of_all_tests(self, primitives: u64) -> Counting {
        match self {
            Counting::AtMost { most, samples } if primitives.saturating_mul(samples) > most => {
                Counting::Not(Counts::TooMany { most })
            }
            counting => counting,
        }
    }

    /// The number of frames drawn to count the work.
    pub(super) fn frames(&self) -> u64 {
        u64::from(matches!(self, Counting::AtMost { .. }))
    }

    /// Counts the work of a separate frame.
    pub(super) fn count<T, E>(
        &self,
        draw: impl FnOnce(&mut WorkWithin) -> Result<T, E>,
    ) -> Result<Counts, E> {
        match *self {
            Counting::Not(counts) => Ok(counts),
            Counting::AtMost { most, .. } => {
                let budget = Budget::new(most);
                let mut work = WorkWithin::new(&budget);
                draw(&mut work)?;
                Ok(work.work().map_or(Counts::TooMany { most }, Counts::Counted))
            }
        }
    }
}
