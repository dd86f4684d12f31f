//! Polynomials in an infinitely small ε, fractions of them, and the roots of quadratics: all exact.

use bothways_common::glam::DVec3;
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero, float::FloatCore};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// A power of two that makes integers of all the numbers of one question.
///
/// Stored numbers are whole multiples of powers of two. Multiplying every length of a question by
/// the same one changes none of its answers: weights and `t` are ratios of lengths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    shift: i64,
}

impl Scale {
    /// The smallest scale that serves all these vectors.
    pub(crate) fn of(vectors: impl IntoIterator<Item = DVec3>) -> Scale {
        let numbers = vectors.into_iter().flat_map(|vector| vector.to_array());
        let smallest = numbers.filter(|&x| x != 0.0).map(|x| odd_mantissa(x).1).min();
        Scale { shift: -smallest.unwrap_or(0) }
    }

    /// A stored number as an integer of this scale.
    pub(crate) fn integer(self, x: f64) -> BigInt {
        if x == 0.0 {
            return BigInt::zero();
        }
        let (mantissa, exponent) = odd_mantissa(x);
        BigInt::from(mantissa) << (exponent + self.shift)
    }

    /// A stored vector as polynomials without ε.
    pub(crate) fn vector(self, vector: DVec3) -> Vector {
        vector.to_array().map(|x| Polynomial(vec![self.integer(x)]))
    }
}

/// `x = mantissa · 2^exponent` with an odd mantissa, for `x` other than zero.
fn odd_mantissa(x: f64) -> (i64, i64) {
    let (mantissa, exponent, sign) = FloatCore::integer_decode(x);
    let zeros = mantissa.trailing_zeros();
    let odd = i64::try_from(mantissa >> zeros).expect("a mantissa has 53 bits");
    (odd * i64::from(sign), i64::from(exponent) + i64::from(zeros))
}

/// A stored number as a rational.
pub(crate) fn rational(x: f64) -> BigRational {
    BigRational::from_float(x).expect("stored numbers are finite")
}

/// A polynomial in ε with integer coefficients, lowest power first.
#[derive(Clone, Debug)]
pub(crate) struct Polynomial(Vec<BigInt>);

/// Three coordinates.
pub(crate) type Vector = [Polynomial; 3];

impl Polynomial {
    /// The same polynomial, times ε to this power.
    pub(crate) fn times_epsilon(&self, power: usize) -> Polynomial {
        let zeros = std::iter::repeat_n(BigInt::zero(), power);
        Polynomial(zeros.chain(self.0.iter().cloned()).collect())
    }

    /// The sign for every small enough ε > 0: that of the lowest coefficient that is not zero.
    pub(crate) fn sign(&self) -> Sign {
        let lowest = self.0.iter().find(|coefficient| !coefficient.is_zero());
        lowest.map_or(Sign::NoSign, BigInt::sign)
    }

    /// What remains of it at ε = 0.
    pub(crate) fn at_zero(&self) -> BigInt {
        self.0.first().cloned().unwrap_or_default()
    }

    fn coefficient(&self, power: usize) -> BigInt {
        self.0.get(power).cloned().unwrap_or_default()
    }
}

impl Add for &Polynomial {
    type Output = Polynomial;

    fn add(self, other: &Polynomial) -> Polynomial {
        let powers = 0..self.0.len().max(other.0.len());
        Polynomial(powers.map(|k| self.coefficient(k) + other.coefficient(k)).collect())
    }
}

impl Neg for &Polynomial {
    type Output = Polynomial;

    fn neg(self) -> Polynomial {
        Polynomial(self.0.iter().map(|coefficient| -coefficient).collect())
    }
}

impl Sub for &Polynomial {
    type Output = Polynomial;

    fn sub(self, other: &Polynomial) -> Polynomial {
        self + &-other
    }
}

impl Mul for &Polynomial {
    type Output = Polynomial;

    fn mul(self, other: &Polynomial) -> Polynomial {
        let mut product = vec![BigInt::zero(); self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, b) in other.0.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                product[i + j] += a * b;
            }
        }
        Polynomial(product)
    }
}

/// Coordinate by coordinate.
pub(crate) fn combine(
    a: &Vector,
    b: &Vector,
    f: impl Fn(&Polynomial, &Polynomial) -> Polynomial,
) -> Vector {
    std::array::from_fn(|axis| f(&a[axis], &b[axis]))
}

/// `a − b`.
pub(crate) fn difference(a: &Vector, b: &Vector) -> Vector {
    combine(a, b, |a, b| a - b)
}

/// `a·b`.
pub(crate) fn dot(a: &Vector, b: &Vector) -> Polynomial {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

/// The determinant of the matrix with these columns, expanded along the first.
pub(crate) fn determinant(a: &Vector, b: &Vector, c: &Vector) -> Polynomial {
    let minor = |i: usize, j: usize| &(&b[i] * &c[j]) - &(&b[j] * &c[i]);
    dot(a, &[minor(1, 2), minor(2, 0), minor(0, 1)])
}

/// A quotient of polynomials; the denominator is not the zero polynomial.
#[derive(Clone, Debug)]
pub(crate) struct Fraction {
    /// Above the line.
    pub(crate) numerator: Polynomial,
    /// Below it.
    pub(crate) denominator: Polynomial,
}

impl Fraction {
    /// The sign for every small enough ε > 0.
    pub(crate) fn sign(&self) -> Sign {
        self.numerator.sign() * self.denominator.sign()
    }

    /// The order of two fractions for every small enough ε > 0.
    pub(crate) fn order(&self, other: &Fraction) -> Ordering {
        let numerator =
            &(&self.numerator * &other.denominator) - &(&other.numerator * &self.denominator);
        let denominator = &self.denominator * &other.denominator;
        Fraction { numerator, denominator }.sign().cmp(&Sign::NoSign)
    }

    /// The value at ε = 0, unless the denominator vanishes there.
    pub(crate) fn at_zero(&self) -> Option<BigRational> {
        let denominator = self.denominator.at_zero();
        (!denominator.is_zero()).then(|| BigRational::new(self.numerator.at_zero(), denominator))
    }
}

/// The smallest positive root of a quadratic with two roots: the only root in a closed interval.
#[derive(Clone, Debug)]
pub(crate) struct Root {
    /// Of `[0] + [1]·t + [2]·t²`, the leading one positive.
    coefficients: [BigInt; 3],
    low: BigRational,
    high: BigRational,
    /// Whether the quadratic grows as it passes the root.
    rising: bool,
}

impl Root {
    /// The smallest positive root of `c + b·t + a·t²`, `a > 0`, if it has two roots and this is one.
    ///
    /// No discriminant is formed: two roots lie on both sides of the vertex of the parabola if, and
    /// only if, the quadratic is negative there.
    pub(crate) fn smallest_positive([c, b, a]: [BigInt; 3]) -> Option<Root> {
        let zero = BigRational::zero();
        let vertex = BigRational::new(-&b, BigInt::from(2) * &a);
        // Cauchy: no root is as large as 1 + max(|b|, |c|)/a.
        let largest = BigInt::from(b.magnitude().max(c.magnitude()).clone());
        let bound = BigRational::new(&a + largest, a.clone());
        let starts_outside = c.sign() == Sign::Plus;
        let coefficients = [c, b, a];
        if sign_at(&coefficients, &vertex) != Sign::Minus {
            return None;
        }
        let (low, high) = match (starts_outside, vertex > zero) {
            (true, true) => (zero, vertex),
            (true, false) => return None,
            (false, true) => (vertex, bound),
            // Not positive at 0 and rising from there: a root lies ahead unless 0 itself is it.
            (false, false) if coefficients[0].is_zero() => return None,
            (false, false) => (zero, bound),
        };
        Some(Root { coefficients, low, high, rising: !starts_outside })
    }

    /// The order of the root and a number.
    pub(crate) fn order_with(&self, number: &BigRational) -> Ordering {
        if *number < self.low {
            return Ordering::Greater;
        }
        if *number > self.high {
            return Ordering::Less;
        }
        // Here the quadratic is monotonic; a rising one that is still negative has its root ahead.
        let sign = sign_at(&self.coefficients, number).cmp(&Sign::NoSign);
        if self.rising { sign.reverse() } else { sign }
    }

    /// The order of two roots.
    pub(crate) fn order(mut self, mut other: Root) -> Ordering {
        if self.equals(&other) {
            return Ordering::Equal;
        }
        // Different, so that halving the intervals separates them at last.
        loop {
            if self.high < other.low {
                return Ordering::Less;
            }
            if other.high < self.low {
                return Ordering::Greater;
            }
            self.halve();
            other.halve();
        }
    }

    /// One step of Euclid's algorithm: a common root of the two quadratics is a root of the
    /// remainder, which is linear, or vanishes where the quadratics have both roots in common.
    fn equals(&self, other: &Root) -> bool {
        let remainder = [0, 1].map(|power| {
            &self.coefficients[2] * &other.coefficients[power]
                - &other.coefficients[2] * &self.coefficients[power]
        });
        let [constant, slope] = remainder;
        if slope.is_zero() {
            return constant.is_zero();
        }
        let candidate = BigRational::new(-constant, slope);
        self.order_with(&candidate).is_eq() && other.order_with(&candidate).is_eq()
    }

    fn halve(&mut self) {
        let middle = (&self.low + &self.high) / BigRational::from(BigInt::from(2));
        // Any number between will do; one of few bits costs less.
        let rounded = middle.to_f64().and_then(BigRational::from_float);
        let middle = rounded.filter(|r| self.low < *r && *r < self.high).unwrap_or(middle);
        match self.order_with(&middle) {
            Ordering::Less => self.high = middle,
            Ordering::Greater => self.low = middle,
            Ordering::Equal => (self.low, self.high) = (middle.clone(), middle),
        }
    }
}

/// The sign of `c + b·t + a·t²` at `t = p/q`: that of `c·q² + b·p·q + a·p²`.
fn sign_at([c, b, a]: &[BigInt; 3], t: &BigRational) -> Sign {
    let (p, q) = (t.numer(), t.denom());
    ((a * p + b * q) * p + c * q * q).sign()
}
