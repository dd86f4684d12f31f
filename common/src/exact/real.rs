//! One formula, three arithmetics: rounded with a proved bound, rounded to twice as many digits, and exact.
//!
//! A predicate is written once, over [`Real`]. It is evaluated in [`Bounded`] arithmetic first; where the
//! bound leaves the sign open, in [`Double`](super::double::Double) numbers, whose bound is smaller by 2⁻⁵³; and only where even
//! that is not certain, in [`Dyadic`] numbers, which have no error (a floating-point filter: Shewchuk,
//! "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", Discrete &
//! Computational Geometry 18, 1997).

use super::sign::Sign;
use dashu_int::IBig;
use dashu_int::ops::{BitTest, SquareRoot, UnsignedAbs};
use glam::DVec3;

/// A number that a predicate computes with.
pub(super) trait Real: Sized {
    /// A stored number, exactly.
    fn new(number: f64) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// The sign of the real number that is meant, if it is certain.
    fn sign(&self) -> Option<Sign>;
    fn square(&self) -> Self {
        self.times(self)
    }
}

/// Evaluates a predicate in bounded, then in doubled, and where that is not certain in exact arithmetic.
macro_rules! exactly {
    ($predicate:ident ( $($argument:expr),* )) => {
        $predicate::<crate::exact::real::Bounded>($($argument),*)
            .or_else(|| $predicate::<crate::exact::double::Double>($($argument),*))
            .or_else(|| $predicate::<crate::exact::real::Dyadic>($($argument),*))
            .expect("exact arithmetic leaves no sign open")
    };
}
pub(super) use exactly;

/// A vector of stored numbers.
pub(super) fn vector<R: Real>(v: DVec3) -> [R; 3] {
    [R::new(v.x), R::new(v.y), R::new(v.z)]
}

/// `p − q` of stored points: the real difference, not the rounded one.
pub(super) fn difference<R: Real>(p: DVec3, q: DVec3) -> [R; 3] {
    let coordinate = |p: f64, q: f64| R::new(p).minus(&R::new(q));
    [coordinate(p.x, q.x), coordinate(p.y, q.y), coordinate(p.z, q.z)]
}

pub(super) fn dot<R: Real>(p: &[R; 3], q: &[R; 3]) -> R {
    p[0].times(&q[0]).plus(&p[1].times(&q[1])).plus(&p[2].times(&q[2]))
}

pub(super) fn cross<R: Real>(p: &[R; 3], q: &[R; 3]) -> [R; 3] {
    let minor = |k: usize, l: usize| p[k].times(&q[l]).minus(&p[l].times(&q[k]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// A rounded number and a bound of its error: the real number is within `error` of `value`.
///
/// Each operation adds the error of its own rounding to what its operands bring (a running error
/// analysis: Higham, "Accuracy and Stability of Numerical Algorithms", 2nd edition, 2002, 3.3).
/// Whatever meets NaN or infinity has no certain sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// Half the distance from 1 to the next number: one rounding changes a result by at most this part.
pub(super) const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
/// More than all underflows of one operation and of its bound can lose.
pub(super) const UNDERFLOW: f64 = 8.0 * f64::MIN_POSITIVE;

impl Bounded {
    /// A bound computed by at most ten roundings, of which each may have lost one part in 2⁵³, made
    /// large enough again.
    fn up(error: f64) -> f64 {
        error * (1.0 + 16.0 * UNIT_ROUNDOFF)
    }

    fn with_error(value: f64, error: f64) -> Self {
        Bounded { value, error: Self::up(error + UNIT_ROUNDOFF * value.abs()) }
    }

    /// The quotient; not certain where the divisor's sign is not.
    pub(super) fn over(self, divisor: Bounded) -> Bounded {
        // With p = P + e, q = Q + f: |p/q − P/Q| = |e − (p/q)·f| / |Q| ≤ (e + |p/q|·f)/(|q| − f).
        let value = self.value / divisor.value;
        let room = divisor.value.abs() * (1.0 - 4.0 * UNIT_ROUNDOFF) - divisor.error;
        if room > 0.0 {
            let carried = (self.error + value.abs() * divisor.error) / room;
            Self::with_error(value, carried * (1.0 + 8.0 * UNIT_ROUNDOFF) + UNDERFLOW)
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

    /// The number to within 2⁻⁶² of itself. It must lie within the range of `f64`.
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

    #[test]
    fn a_bound_holds_the_rounding_of_each_step() {
        // Rounding swallows the 2⁻⁶⁰ in (1 + 2⁻⁶⁰) − 1; the bound knows that it may have.
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
