//! The sign of a real number. Every decision about visibility is one.

use std::ops::{Mul, Neg};

/// The sign of a real number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Sign {
    /// Less than zero.
    Negative,
    /// Exactly zero.
    Zero,
    /// Greater than zero.
    Positive,
}

impl Sign {
    /// The sign of a number.
    ///
    /// # Panics
    ///
    /// If the number is NaN, which has none.
    pub fn of(number: f64) -> Sign {
        if number > 0.0 {
            Sign::Positive
        } else if number < 0.0 {
            Sign::Negative
        } else {
            assert!(!number.is_nan(), "NaN has no sign");
            Sign::Zero
        }
    }

    /// This sign, or the other one if this is zero: how a nudge decides a tie.
    #[must_use]
    pub fn or_else(self, other: impl FnOnce() -> Sign) -> Sign {
        if self == Sign::Zero { other() } else { self }
    }
}

impl Neg for Sign {
    type Output = Sign;

    fn neg(self) -> Sign {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Sign;

    fn mul(self, other: Sign) -> Sign {
        match self {
            Sign::Negative => -other,
            Sign::Zero => Sign::Zero,
            Sign::Positive => other,
        }
    }
}
