//! Numbers of twice as many digits, each the sum of two `f64`, with a bound of their error.
//!
//! Exact numbers of any length cost microseconds. These cost a tenth of that, and settle nearly every sign that
//! rounded arithmetic leaves open; a zero, too, where it needs few digits.

use super::real::{Real, UNDERFLOW};
use super::sign::Sign;
use crate::engine::roundoff::EPS53;

/// A number within `error` of `high + low`, where `low` is at most half of the last place of `high`.
///
/// Unlike in [`Bounded`](super::bounded::Bounded), what each operation loses is found rather than bounded
/// wherever that is cheap. So `error` stays zero as long as 106 digits are enough, and zero is recognised.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double {
    high: f64,
    low: f64,
    error: f64,
}

impl Double {
    /// The number to within its error and a rounding, if the error is at most so large.
    pub(super) fn within(&self, error: f64) -> Option<f64> {
        (self.error <= error).then_some(self.high)
    }

    /// The number, rounded; its error says how far that may be off besides.
    pub(super) fn rounded(&self) -> f64 {
        self.high
    }

    /// The error as computed by at most twenty roundings, of which each may have lost one part in 2⁵³, made
    /// large enough again.
    fn up(error: f64) -> f64 {
        error * (1.0 + 32.0 * EPS53)
    }

    fn sum(&self, high: f64, low: f64, error: f64) -> Self {
        let (sum, lost) = two_sum(self.high, high);
        let (lows, lost_of_lows) = two_sum(self.low, low);
        let (rest, lost_of_rest) = two_sum(lost, lows);
        // What was lost is found, not bounded: it is zero if nothing was.
        let error = self.error + error + (lost_of_lows.abs() + lost_of_rest.abs());
        let (high, low) = two_sum(sum, rest);
        Double { high, low, error: if error == 0.0 { 0.0 } else { Self::up(error) } }
    }
}

impl Real for Double {
    fn new(number: f64) -> Self {
        Double { high: number, low: 0.0, error: 0.0 }
    }

    fn plus(&self, other: &Self) -> Self {
        self.sum(other.high, other.low, other.error)
    }

    fn minus(&self, other: &Self) -> Self {
        self.sum(-other.high, -other.low, other.error)
    }

    /// With `p = P + p′ + δ` and so on, of which `P` is high, `p′` low and `δ` within the error:
    /// `p·q = P·Q + (P·q′ + p′·Q) + p′·q′ + …`. The first is found without error; of the next two each is
    /// rounded, their sum is, and it is again when what the first lost is added; the last is left out. What
    /// errors bring is `|p|·ε + |q|·δ + δ·ε`, where `|p|` is at most `|P|` and a part in 2⁵³.
    fn times(&self, other: &Self) -> Self {
        let (product, lost) = two_product(self.high, other.high);
        // Beneath this, what was lost may have underflowed.
        let tiny = product.abs() < LEAST && self.high != 0.0 && other.high != 0.0;
        let mut error = if tiny { UNDERFLOW } else { 0.0 };
        let mut rest = lost;
        if self.low != 0.0 || other.low != 0.0 {
            let (one, two) = (self.high * other.low, self.low * other.high);
            let crosswise = one + two;
            rest += crosswise;
            let rounded = one.abs() + two.abs() + crosswise.abs() + rest.abs();
            error += EPS53 * rounded + (self.low * other.low).abs() + UNDERFLOW;
        }
        if self.error != 0.0 || other.error != 0.0 {
            let carried = self.high.abs() * other.error + other.high.abs() * self.error;
            error += carried + self.error * other.error + UNDERFLOW;
        }
        let (high, low) = two_sum(product, rest);
        Double { high, low, error: if error == 0.0 { 0.0 } else { Self::up(error) } }
    }

    fn sign(&self) -> Option<Sign> {
        // Twice the low part is less than one part in 2⁵² of the high one.
        let least = self.high.abs() * (1.0 - 4.0 * EPS53);
        let is_zero = self.high == 0.0 && self.error == 0.0;
        (is_zero || least > self.error).then(|| Sign::of(self.high))
    }
}

/// Products beyond this keep all that rounding loses: 53 digits more are far above 2⁻¹⁰⁷⁴.
const LEAST: f64 = f64::MIN_POSITIVE / (4.0 * EPS53 * EPS53);

/// A rounded sum, and what rounding lost: exactly, unless the sum overflows.
///
/// Knuth, "The Art of Computer Programming", volume 2, 4.2.2, theorem C.
pub fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// A rounded product, and what rounding lost: exactly, where that does not underflow; NaN or infinite where
/// something overflows.
///
/// Dekker, "A Floating-Point Technique for Extending the Available Precision", Numerische Mathematik 18,
/// 1971.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ([a_high, a_low], [b_high, b_low]) = (halves(a), halves(b));
    let rest = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, rest)
}

/// Two numbers of 26 digits with this sum.
fn halves(number: f64) -> [f64; 2] {
    let scaled = 134_217_729.0 * number;
    let high = scaled - (scaled - number);
    [high, number - high]
}

#[cfg(test)]
mod tests {
    use super::super::dyadic::Dyadic;
    use super::*;

    /// Numbers of any size and number of digits, the same in every run.
    fn numbers() -> impl Iterator<Item = f64> {
        let mut state = 1_u64;
        std::iter::repeat_with(move || {
            let mut next = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                state >> 11
            };
            let digits =
                [1.0, 8.0, 2f64.powi(20), 2f64.powi(52)][usize::try_from(next() % 4).unwrap()];
            #[expect(clippy::cast_precision_loss, reason = "53 bits")]
            let mantissa =
                (next() as f64 / 2f64.powi(53) * digits).round() - (0.5 * digits).round();
            let exponent = i32::try_from(next() % 60).unwrap() - 30;
            mantissa * 2f64.powi(exponent)
        })
    }

    /// The same formula in both arithmetics, one operation after the other.
    fn formula<R: Real>(values: &[f64], operations: u64) -> R {
        let mut result = R::new(values[0]);
        for (k, value) in values[1..].iter().enumerate() {
            let value = R::new(*value);
            result = match operations >> (2 * k) & 3 {
                0 => result.plus(&value),
                1 => result.minus(&value),
                2 => result.times(&value),
                _ => result.square().minus(&value),
            };
        }
        result
    }

    #[test]
    fn bounds_hold_the_exact_number() {
        let mut numbers = numbers();
        let (mut certain, mut zeros) = (0, 0);
        for operations in 0..40_000 {
            let mut values: Vec<f64> = numbers.by_ref().take(6).collect();
            // Differences that cancel.
            let last = formula::<Double>(&values, operations).high;
            if !last.is_finite() {
                continue;
            }
            values.push(last);
            let operations = operations & 0x3ff | 1 << 10;
            let (double, exact) =
                (formula::<Double>(&values, operations), formula::<Dyadic>(&values, operations));
            let computed = Dyadic::new(double.high).plus(&Dyadic::new(double.low));
            let off = exact.minus(&computed);
            let bound = Dyadic::new(double.error);
            assert_ne!(bound.minus(&off).sign(), Some(Sign::Negative), "{values:?} {operations}");
            assert_ne!(bound.plus(&off).sign(), Some(Sign::Negative), "{values:?} {operations}");
            if let Some(sign) = double.sign() {
                assert_eq!(Some(sign), exact.sign(), "{values:?} {operations}");
                certain += 1;
                zeros += u32::from(sign == Sign::Zero);
            }
        }
        assert!(certain > 30_000 && zeros > 1_000, "{certain} certain, {zeros} zeros");
    }

    #[test]
    fn what_underflows_or_overflows_is_not_certain() {
        let (tiny, huge) = (Double::new(1e-170), Double::new(1e200));
        assert_eq!(tiny.square().sign(), None);
        assert_eq!(huge.square().sign(), None);
        assert_eq!(huge.square().minus(&huge.square()).sign(), None);
        assert_eq!(Double::new(0.0).times(&huge).sign(), Some(Sign::Zero));
    }
}
