//! Exact arithmetic: the last rung of [`evaluate`](super::evaluate), which leaves no sign open.

use super::real::Real;
use super::sign::Sign;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, SquareRoot, UnsignedAbs};

/// `mantissa · 2^exponent`: sums, differences and products of stored numbers, without error.
#[derive(Clone, Debug)]
pub(super) struct Dyadic {
    mantissa: IBig,
    exponent: i64,
}

impl Dyadic {
    /// The mantissa at a smaller or equal exponent.
    fn at(&self, exponent: i64) -> IBig {
        let shift =
            usize::try_from(self.exponent - exponent).expect("exponents differ by thousands");
        &self.mantissa << shift
    }

    fn combine(&self, other: &Self, operation: impl FnOnce(IBig, IBig) -> IBig) -> Self {
        let exponent = self.exponent.min(other.exponent);
        Dyadic { mantissa: operation(self.at(exponent), other.at(exponent)), exponent }
    }

    /// The number to within 2⁻⁵² of itself: cut to 63 bits, then rounded. It must lie within the range of `f64`.
    pub(super) fn to_f64(&self) -> f64 {
        let excess = self.mantissa.bit_len().saturating_sub(63);
        let leading = i64::try_from(&self.mantissa >> excess).expect("63 bits are left");
        #[expect(clippy::cast_precision_loss, reason = "this is the rounding that is asked for")]
        let leading = leading as f64;
        scale(leading, self.exponent + to_i64(excess))
    }

    /// The square root, to within 2⁻⁵² of itself, of a number that is not negative.
    pub(super) fn square_root(&self) -> f64 {
        // 128 bits under the root give 64 bits of it; the exponent must be even.
        let wanted = to_i64(130_usize.saturating_sub(self.mantissa.bit_len()));
        let shift = wanted + (self.exponent - wanted).rem_euclid(2);
        let exponent = self.exponent - shift;
        let mantissa = self.at(exponent).unsigned_abs().sqrt();
        Dyadic { mantissa: mantissa.into(), exponent: exponent / 2 }.to_f64()
    }
}

impl Real for Dyadic {
    fn new(number: f64) -> Self {
        assert!(number.is_finite(), "a stored number is finite");
        let bits = number.to_bits();
        let (biased, fraction) = (to_i64(bits >> 52 & 0x7ff), bits & ((1 << 52) - 1));
        let (mantissa, exponent) = match biased {
            0 => (fraction, -1074),
            _ => (fraction | 1 << 52, biased - 1075),
        };
        // Stored numbers have mostly 24 bits; short mantissas are cheap.
        let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
        let magnitude = IBig::from(mantissa >> zeros);
        let mantissa = if number < 0.0 { -magnitude } else { magnitude };
        Dyadic { mantissa, exponent: exponent + i64::from(zeros) }
    }

    fn plus(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    fn minus(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    fn times(&self, other: &Self) -> Self {
        Dyadic {
            mantissa: &self.mantissa * &other.mantissa,
            exponent: self.exponent + other.exponent,
        }
    }

    fn sign(&self) -> Option<Sign> {
        Some(if self.mantissa == IBig::ZERO {
            Sign::Zero
        } else if self.mantissa < IBig::ZERO {
            Sign::Negative
        } else {
            Sign::Positive
        })
    }
}

/// `number · 2^exponent` in two steps, of which neither overflows when the result does not.
fn scale(number: f64, exponent: i64) -> f64 {
    let half = i32::try_from(exponent / 2).expect("exponents have thousands at most");
    let rest = i32::try_from(exponent - exponent / 2).expect("exponents have thousands at most");
    number * 2f64.powi(half) * 2f64.powi(rest)
}

fn to_i64<T: TryInto<i64, Error: std::fmt::Debug>>(number: T) -> i64 {
    number.try_into().expect("small numbers fit")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_numbers_keep_every_bit() {
        let tiny = Dyadic::new(f64::from_bits(1));
        let huge = Dyadic::new(f64::MAX);
        assert_eq!(huge.plus(&tiny).minus(&huge).minus(&tiny).sign(), Some(Sign::Zero));
        assert_eq!(huge.minus(&tiny).minus(&huge).sign(), Some(Sign::Negative));
        assert_eq!(Dyadic::new(-0.1).to_f64(), -0.1);
        assert_eq!(Dyadic::new(1e300).times(&Dyadic::new(1e-300)).to_f64(), 1e300 * 1e-300);
    }

    #[test]
    fn square_roots_are_close() {
        for number in [2.0, 1e-200, 3e250, 0.25, 1.0] {
            let root = Dyadic::new(number).square_root();
            assert!((root / number.sqrt() - 1.0).abs() < 1e-15, "{number}: {root}");
        }
    }
}
