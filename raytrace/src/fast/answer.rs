//! What rounded arithmetic says of one ray and one primitive.

use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::roundoff::{EPS53, Interval};

/// The answer for one ray and one primitive.
#[derive(Clone, Copy, Debug)]
pub(super) enum Answer {
    /// Certainly a hit, with its `t` in this interval.
    Hit(Interval),
    /// Certainly a miss.
    Miss,
    /// The judge must decide; if it is a hit, its `t` is in this interval.
    Open(Interval),
}

/// Below this, products may have underflowed; it is far above what that can lose.
pub(super) const FLOOR: f64 = 1e-200;

/// The interval of a `t` that is known to within `error`, which is rounded up; any distance, if the numbers are not
/// ordinary.
pub(super) fn distance_around(t: f64, error: f64) -> Interval {
    let error = error * (1.0 + 8.0 * EPS53);
    Interval::around(t, error).unwrap_or(Interval::NOT_NEGATIVE)
}

/// An interval of `t` is narrow if it is no longer than this part of its middle.
pub(super) const NARROW: f64 = 1e-7;

/// The middle of an interval of `t`, if the interval is as narrow as a stored `t` needs.
pub(super) fn narrow_middle(distance: Interval) -> Option<f64> {
    let t = distance.middle();
    (t.is_finite() && distance.high - distance.low <= NARROW * t).then_some(t)
}

/// Whether error bounds are used as derived, or replaced by a planted fault.
#[derive(Clone, Copy, Debug)]
pub(super) enum Trust {
    /// As derived.
    Sound,
    /// Every bound is zero.
    Blind,
    /// Every bound is infinite.
    None,
}

impl Trust {
    pub(super) fn new<F: Fault>() -> Trust {
        if F::is(Planted::ZeroErrorBound) {
            Trust::Blind
        } else if F::is(Planted::InfiniteErrorBound) {
            Trust::None
        } else {
            Trust::Sound
        }
    }

    pub(super) fn is_sound(self) -> bool {
        matches!(self, Trust::Sound)
    }

    /// A derived bound, or what replaces it.
    #[inline(always)]
    pub(super) fn of(self, bound: f64) -> f64 {
        match self {
            Trust::Sound => bound,
            Trust::Blind => 0.0,
            Trust::None => f64::INFINITY,
        }
    }
}
