//! The result of one order, and its cost.

use super::counts::Counts;
use super::order::{Method, Order};
use super::rules::Rule;
use super::times::Times;
use crate::common::{Executed, Frame, Work};

/// The result of one order, and its cost.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The order.
    pub order: Order,
    /// The method.
    pub method: Method,
    /// The rule of an ordinary renderer that decided; `None` is exact.
    pub rule: Option<Rule>,
    /// The frame.
    pub frame: Frame,
    /// The work of the algorithm for one frame: what every primitive or ray needs alone.
    pub work: Counts,
    /// What the first frame executed that nothing observes; it is cut into the same tiles whatever the number of threads.
    /// `None` if the method is not fast or has the rules of an ordinary renderer, or if the options leave out the times of a stream but not
    /// its counts: its file is not read again for this.
    pub executed: Option<Executed>,
    /// The times; `None` if the options leave out times.
    pub times: Option<Times>,
}

impl Rendered {
    /// The order, with its rule unless that is exact: "object order, snapped:8".
    pub fn name(&self) -> String {
        let order = self.order.name();
        self.rule.map_or(order.into(), |rule| format!("{order}, {rule}"))
    }

    /// The number of covered samples.
    pub fn covered(&self) -> u64 {
        self.frame.ids().covered() as u64
    }

    /// The work for one frame, if it was counted.
    pub fn work(&self) -> Option<&Work> {
        match &self.work {
            Counts::Counted(work) => Some(work),
            Counts::TooMany { .. } | Counts::LeftOut => None,
        }
    }
}
