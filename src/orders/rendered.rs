//! What one order saw, and what that cost.

use super::counts::Counts;
use super::order::{Method, Order};
use super::times::Times;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::{Frame, Work};

/// What one order saw, and what it cost.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Which order it was.
    pub order: Order,
    /// How it was run.
    pub method: Method,
    /// What it saw.
    pub frame: Frame,
    /// How much was done for one frame.
    pub work: Counts,
    /// How long it took; `None` if times are to be left out.
    pub times: Option<Times>,
}

impl Rendered {
    /// How many samples are covered.
    pub fn covered(&self) -> u64 {
        self.frame.ids().iter().filter(|&&id| id != NO_PRIMITIVE).count() as u64
    }

    /// The work for one frame, if it was counted.
    pub fn work(&self) -> Option<&Work> {
        match &self.work {
            Counts::Counted(work) => Some(work),
            Counts::TooMany { .. } | Counts::LeftOut => None,
        }
    }
}
