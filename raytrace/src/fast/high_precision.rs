//! Sums of products to twice as many digits, for the few rays at which one `f64` has too few.

use bothways_common::engine::roundoff::EPS53;

/// A number within `error` of `high + low`, where `low` is at most half of the last place of `high`.
#[derive(Clone, Copy, Debug)]
pub(super) struct DoubleDouble {
    pub(super) high: f64,
    pub(super) low: f64,
    /// Zero where nothing was lost.
    pub(super) error: f64,
}

impl DoubleDouble {
    pub(super) const ZERO: DoubleDouble = DoubleDouble::exact(0.0);

    pub(super) const fn exact(number: f64) -> DoubleDouble {
        DoubleDouble { high: number, low: 0.0, error: 0.0 }
    }

    /// The sum of products `p·q`.
    pub(super) fn of_products<const N: usize>(p: [f64; N], q: [f64; N]) -> DoubleDouble {
        DoubleDouble::sum_of_products(p.into_iter().zip(q))
    }

    /// The sum of products.
    ///
    /// What rounding takes from each product and each partial sum is found without error, and added up
    /// (Ogita, Rump and Oishi, "Accurate Sum and Dot Product", SIAM Journal on Scientific Computing 26, 2005:
    /// `Dot2`). That is rounded: twice for each product, each time by less than a part in 2⁵³ of all that was
    /// found, whose sizes are added up as well. The bound has half as much again.
    #[inline(always)]
    pub(super) fn sum_of_products(products: impl IntoIterator<Item = (f64, f64)>) -> DoubleDouble {
        /// Of smaller products, what is lost may underflow; it is far less than this itself.
        const TINY: f64 = 1e-250;
        let (mut high, mut low, mut lost) = (0.0, 0.0, 0.0_f64);
        let (mut underflow, mut count) = (0.0, 0.0);
        for (p, q) in products {
            let (product, of_product) = product(p, q);
            let (sum, of_sum) = sum(high, product);
            high = sum;
            low += of_product + of_sum;
            lost += of_product.abs() + of_sum.abs();
            count += 1.0;
            if product.abs() < TINY && p != 0.0 && q != 0.0 {
                underflow = TINY;
            }
        }
        let error = 3.0 * (count + 1.0) * EPS53 * lost + underflow;
        let (high, low) = sum(high, low);
        DoubleDouble { high, low, error }
    }

    pub(super) fn is_positive(&self) -> bool {
        self.high * (1.0 - 4.0 * EPS53) > self.error
    }

    pub(super) fn is_negative(&self) -> bool {
        -self.high * (1.0 - 4.0 * EPS53) > self.error
    }

    pub(super) fn is_zero(&self) -> bool {
        self.high == 0.0 && self.error == 0.0
    }
}

impl std::ops::Neg for DoubleDouble {
    type Output = DoubleDouble;

    fn neg(self) -> DoubleDouble {
        DoubleDouble { high: -self.high, low: -self.low, error: self.error }
    }
}

/// A rounded sum and what it lost: Knuth, "The Art of Computer Programming", volume 2, 4.2.2.
pub(super) fn sum(a: f64, b: f64) -> (f64, f64) {
    let rounded = a + b;
    let part = rounded - a;
    (rounded, (a - (rounded - part)) + (b - part))
}

/// A rounded product and what it lost: Dekker, "A Floating-Point Technique for Extending the Available Precision",
/// Numerische Mathematik 18, 1971.
fn product(a: f64, b: f64) -> (f64, f64) {
    let rounded = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (rounded, a2 * b2 - (((rounded - a1 * b1) - a2 * b1) - a1 * b2))
}

/// Into halves of 26 digits: Veltkamp's way.
fn split(number: f64) -> (f64, f64) {
    let large = number * 134_217_729.0;
    let leading = large - (large - number);
    (leading, number - leading)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_leaves_its_digits() {
        let e = f64::EPSILON;
        // (1 + e)² − 1 − 2e = e².
        let sum = DoubleDouble::of_products([1.0 + e, -1.0, -2.0], [1.0 + e, 1.0, e]);
        assert_eq!((sum.high, sum.low), (e * e, 0.0));
        assert!(sum.is_positive() && !sum.is_negative() && !sum.is_zero());
        let zero = DoubleDouble::of_products([3.0, 4.0, -5.0], [3.0, 4.0, 5.0]);
        assert!(zero.is_zero() && !zero.is_positive());
        // Of products that underflow nothing is certain.
        let tiny = DoubleDouble::of_products([1e-200], [1e-200]);
        assert!(!(tiny.is_zero() || tiny.is_positive() || tiny.is_negative()));
    }
}
