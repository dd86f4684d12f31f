//! Twice as many digits as an `f64` has, for the few samples that need them.

use std::ops::{Add, Mul, Sub};

/// `high + low`, where `low` is at most half of the last place of `high`.
///
/// A sum is off by less than 4ε₅₃² of itself, a product by less than 8ε₅₃² (Joldes, Muller and Popescu,
/// "Tight and Rigorous Error Bounds for Basic Building Blocks of Double-Word Arithmetic", ACM Transactions on
/// Mathematical Software 44, 2017: `AccurateDWPlusDW` and `DWTimesDW1`), unless something underflows.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoubleDouble {
    pub(super) high: f64,
    pub(super) low: f64,
}

impl DoubleDouble {
    pub(super) const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };

    /// A number, without error.
    pub(super) fn new(number: f64) -> Self {
        DoubleDouble { high: number, low: 0.0 }
    }

    /// The difference of two numbers, without error.
    pub(super) fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    /// Whether one `f64` holds it.
    pub(super) fn is_short(self) -> bool {
        self.low == 0.0
    }

    /// The sum of two numbers, without error: Knuth, "The Art of Computer Programming", volume 2, 4.2.2.
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let of_b = high - a;
        DoubleDouble { high, low: (a - (high - of_b)) + (b - of_b) }
    }

    /// The product of two numbers, without error: Dekker, "A Floating-Point Technique for Extending the Available
    /// Precision", Numerische Mathematik 18, 1971.
    pub(super) fn product(a: f64, b: f64) -> Self {
        // Two numbers with half of the digits each.
        let halves = |number: f64| {
            let scaled = 134_217_729.0 * number;
            let leading = scaled - (scaled - number);
            (leading, number - leading)
        };
        let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
        let high = a * b;
        DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;

    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (highs, lows) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::sum(highs.high, highs.low + lows.high);
        Self::sum(first.high, lows.low + first.low)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;

    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + DoubleDouble { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;

    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let highs = Self::product(self.high, other.high);
        let crosswise = self.high * other.low + self.low * other.high;
        Self::sum(highs.high, highs.low + crosswise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_lose_nothing() {
        let product = |a: f64, b: f64| {
            let DoubleDouble { high, low } = DoubleDouble::product(a, b);
            [high, low]
        };
        // (1 + 2⁻⁵²)² = 1 + 2⁻⁵¹ + 2⁻¹⁰⁴.
        let a = 1.0 + f64::EPSILON;
        assert_eq!(product(a, a), [1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON]);
        assert_eq!(product(3.0, -0.5), [-1.5, 0.0]);
    }
}
