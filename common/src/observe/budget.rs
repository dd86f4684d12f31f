//! Counts work up to a limit, because the amount is not known in advance.

use crate::exact::Sign;
use crate::observe::{Events, Observer, Question, Work};
use crate::raster::{Region, Sample};
use std::sync::atomic::{AtomicU64, Ordering};

/// A bound for what is counted of one frame, shared by all threads.
#[derive(Debug)]
pub struct Budget {
    most: u64,
    spent: AtomicU64,
}

impl Budget {
    /// At most so many steps, as [`Work::steps`] has them.
    pub fn new(most: u64) -> Budget {
        Budget { most, spent: AtomicU64::new(0) }
    }
}

/// Counts work until a budget is spent.
///
/// Whether the budget is enough depends on the work alone: neither on threads nor on time.
///
/// ```
/// use bothways_common::observe::budget::{Budget, WorkWithin};
/// use bothways_common::observe::Events;
/// use bothways_common::Sample;
///
/// let budget = Budget::new(2);
/// let mut counted = WorkWithin::new(&budget);
/// let sample = Sample { row: 0, column: 0 };
/// counted.sample_tested(sample, 0);
/// counted.sample_tested(sample, 1);
/// assert_eq!(counted.clone().work().map(|work| work.tests), Some(2));
/// counted.sample_tested(sample, 2);
/// assert!(counted.has_enough() && counted.work().is_none());
/// ```
#[derive(Clone, Debug)]
pub struct WorkWithin<'a> {
    work: Work,
    /// The steps of it that the budget has counted.
    told: u64,
    budget: &'a Budget,
}

impl<'a> WorkWithin<'a> {
    /// Nothing is counted yet.
    pub fn new(budget: &'a Budget) -> WorkWithin<'a> {
        WorkWithin { work: Work::default(), told: 0, budget }
    }

    /// All the work, if it is within the budget.
    pub fn work(self) -> Option<Work> {
        (self.work.steps() <= self.budget.most).then_some(self.work)
    }
}

impl Observer for WorkWithin<'_> {
    fn fork(&self) -> Self {
        WorkWithin::new(self.budget)
    }

    fn join(&mut self, part: Self) {
        self.work.join(part.work);
        self.told += part.told;
    }
}

impl Events for WorkWithin<'_> {
    fn counts(&mut self) -> Option<&mut Work> {
        Some(&mut self.work)
    }

    fn has_enough(&mut self) -> bool {
        let steps = self.work.steps();
        let more = steps - self.told;
        // Threads that tell of every step wait for one another. What is not told yet is not lost: a budget that seems
        // to be enough without it is asked again, and at the end all the work decides.
        let before = if more > self.budget.most >> 16 {
            self.told = steps;
            self.budget.spent.fetch_add(more, Ordering::Relaxed)
        } else {
            self.budget.spent.load(Ordering::Relaxed)
        };
        before.saturating_add(more) > self.budget.most
    }

    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        self.work.primitive_begun(primitive, region);
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.work.ray_begun(sample);
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.work.node_opened(sample, node, entered);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.work.sample_tested(sample, primitive);
    }

    fn edge_signs(&mut self, sample: Sample, primitive: u64, signs: [Option<Sign>; 3]) {
        self.work.edge_signs(sample, primitive, signs);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.work.fragment(sample, primitive);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        self.work.depth_test(sample, incoming, stored, replaced);
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u64>) {
        self.work.hit(sample, primitive);
    }

    fn judged(&mut self, sample: Sample, question: Question) {
        self.work.judged(sample, question);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_threads_spend_one_budget() {
        let budget = Budget::new(5);
        let whole = WorkWithin::new(&budget);
        let mut parts = [whole.fork(), whole.fork()];
        let sample = Sample { row: 0, column: 0 };
        for (part, tests) in parts.iter_mut().zip([3, 3]) {
            (0..tests).for_each(|k| part.sample_tested(sample, k));
        }
        assert!(!parts[0].has_enough(), "3 of 5");
        assert!(parts[1].has_enough(), "6 of 5");
        assert!(parts[0].has_enough(), "who counted less has enough, too");
        let mut whole = whole;
        parts.into_iter().for_each(|part| whole.join(part));
        assert_eq!(whole.work(), None);
    }

    #[test]
    fn a_question_to_the_judge_is_more_than_a_test() {
        let work = Work { tests: 3, judged_nearest: 1, ..Work::default() };
        assert!(work.steps() > 100);
    }
}
