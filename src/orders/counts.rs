//! The work for a frame, counted as long as there is not too much of it.

use super::options::RenderOptions;
use crate::common::Work;
use crate::common::observe::budget::{Budget, WorkWithin};

/// What was counted of the work for a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// All of it.
    Counted(Work),
    /// Nothing: it is more than so many steps, as [`Work::steps`] has them.
    TooMany {
        /// See [`most_steps`].
        most: u64,
    },
    /// Nothing: it was not to be counted.
    LeftOut,
}

/// The number of steps at which counting is given up, for a frame of so many samples: 2¹⁰ a sample and 2²⁸ besides.
/// As a rule a ray meets some hundred boxes and triangles; a scene with more could be counted for hours.
pub fn most_steps(samples: u64) -> u64 {
    (1 << 28) + (samples << 10)
}

/// Whether the work is counted.
#[derive(Clone, Copy, Debug)]
pub(super) enum Counting {
    /// In a frame of its own, as long as it is at most so many steps.
    AtMost { most: u64, samples: u64 },
    /// It is not, for a reason that is known beforehand.
    Not(Counts),
}

impl Counting {
    /// For a frame of so many samples.
    pub(super) fn new(options: &RenderOptions, samples: u64) -> Counting {
        if options.no_counts {
            return Counting::Not(Counts::LeftOut);
        }
        Counting::AtMost { most: most_steps(samples), samples }
    }

    /// The same where every primitive is tested at every sample: then it is known beforehand whether that is too much.
    pub(super) fn of_all_tests(self, primitives: u32) -> Counting {
        match self {
            Counting::AtMost { most, samples }
                if u64::from(primitives).saturating_mul(samples) > most =>
            {
                Counting::Not(Counts::TooMany { most })
            }
            counting => counting,
        }
    }

    /// How many frames are drawn to count the work.
    pub(super) fn frames(&self) -> u64 {
        u64::from(matches!(self, Counting::AtMost { .. }))
    }

    /// Counts the work of a frame that is drawn for it.
    pub(super) fn count<E>(
        &self,
        draw: impl FnOnce(&mut WorkWithin) -> Result<(), E>,
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
