//! What rounded arithmetic says of one ray and one primitive.

use bothways_common::engine::roundoff::Interval;

/// The answer for one ray and one primitive.
#[derive(Clone, Copy, Debug)]
pub(super) enum Answer {
    /// Certainly a hit, at a depth in this interval.
    Hit(Interval),
    /// Certainly a miss.
    Miss,
    /// The judge must decide.
    Open,
}
