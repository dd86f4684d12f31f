//! Rounded arithmetic with a proved bound of its error: the first rung of [`evaluate`](super::evaluate).

use super::real::{Real, UNDERFLOW};
use super::sign::Sign;
use crate::engine::roundoff::EPS53;

/// A rounded number and a bound of its error: the real number is within `error` of `value`.
///
/// Each operation adds the error of its own rounding to what its operands bring (a running error
/// analysis: Higham, "Accuracy and Stability of Numerical Algorithms", 2nd edition, 2002, 3.3).
/// A number that depends on NaN or infinity has no certain sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

impl Bounded {
    /// A bound computed by at most ten roundings, of which each may have lost one part in 2⁵³, made
    /// large enough again.
    fn up(error: f64) -> f64 {
        error * (1.0 + 16.0 * EPS53)
    }

    fn with_error(value: f64, error: f64) -> Self {
        Bounded { value, error: Self::up(error + EPS53 * value.abs()) }
    }

    /// The quotient; not certain where the divisor's sign is not.
    pub(super) fn over(self, divisor: Bounded) -> Bounded {
        // With p = P + e, q = Q + f: |p/q − P/Q| = |e − (p/q)·f| / |Q| ≤ (e + |p/q|·f)/(|q| − f).
        let value = self.value / divisor.value;
        let room = divisor.value.abs() * (1.0 - 4.0 * EPS53) - divisor.error;
        if room > 0.0 {
            let carried = (self.error + value.abs() * divisor.error) / room;
            Self::with_error(value, carried * (1.0 + 8.0 * EPS53) + UNDERFLOW)
        } else {
            Bounded { value, error: f64::INFINITY }
        }
    }

    /// The square root of a number that is certainly positive.
    pub(super) fn square_root(self) -> Bounded {
        // |√(V + e) − √V| ≤ |e|/√V with V the rounded number: the slope is largest at the smaller
        // end, where (√V − √(V − e)) = e/(√V + √(V − e)) ≤ e/√V.
        let value = self.value.sqrt();
        Self::with_error(value, self.error / value + UNDERFLOW)
    }
}

impl Real for Bounded {
    fn new(number: f64) -> Self {
        Bounded { value: number, error: 0.0 }
    }

    fn plus(&self, other: &Self) -> Self {
        // Sums do not underflow.
        Self::with_error(self.value + other.value, self.error + other.error)
    }

    fn minus(&self, other: &Self) -> Self {
        Self::with_error(self.value - other.value, self.error + other.error)
    }

    fn times(&self, other: &Self) -> Self {
        let carried = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        Self::with_error(self.value * other.value, carried + UNDERFLOW)
    }

    fn sign(&self) -> Option<Sign> {
        (self.value.abs() > self.error).then(|| Sign::of(self.value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::dyadic::Dyadic;

    #[test]
    fn a_bound_holds_the_rounding_of_each_step() {
        // Rounding swallows the 2⁻⁶⁰ in (1 + 2⁻⁶⁰) − 1; the bound covers that.
        let sum = |bounded: bool| {
            if bounded {
                let [a, b, c] = [1.0, (-60f64).exp2(), 1.0].map(Bounded::new);
                a.plus(&b).minus(&c).sign()
            } else {
                let [a, b, c] = [1.0, (-60f64).exp2(), 1.0].map(Dyadic::new);
                a.plus(&b).minus(&c).sign()
            }
        };
        assert_eq!(sum(true), None);
        assert_eq!(sum(false), Some(Sign::Positive));
    }

    #[test]
    fn what_is_not_finite_is_not_certain() {
        let huge = Bounded::new(1e200);
        assert_eq!(huge.times(&huge).sign(), None);
        assert_eq!(huge.times(&huge).minus(&huge.times(&huge)).sign(), None);
        assert_eq!(Bounded::new(1.0).over(Bounded::new(0.0)).sign(), None);
        assert_eq!(Bounded::new(-1.0).square_root().sign(), None);
    }
}
