//! The vocabulary of rounding errors: the constants that every bound is stated in, and intervals.
//!
//! Bounds themselves are not here. Each order derives its own, so that a mistake in one shows up against the other.
//!
//! In comments, `ε₅₃` is [`EPS53`] and `ε₂₄` is [`EPS24`]: the largest relative error of one rounding to `f64` and
//! to `f32` (Higham, "Accuracy and Stability of Numerical Algorithms", 2nd edition, 2002, 2.1, calls it the unit
//! roundoff).

use glam::DVec3;

/// `ε₅₃ = 2⁻⁵³`, the unit roundoff of `f64`: half the distance from 1 to the next number.
pub const EPS53: f64 = f64::EPSILON / 2.0;
/// `ε₂₄ = 2⁻²⁴`, the unit roundoff of `f32`.
pub const EPS24: f32 = f32::EPSILON / 2.0;

/// Two numbers between which a number lies, or on which.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Not greater than the number.
    pub low: f64,
    /// Not less than the number.
    pub high: f64,
}

impl Interval {
    /// All numbers: nothing is known.
    pub const ALL: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
    /// The numbers that are not negative: all that is known of a distance.
    pub const NOT_NEGATIVE: Interval = Interval { low: 0.0, high: f64::INFINITY };

    /// The numbers within `error` of the middle, each end rounded once; `None` where there are none, or NaN is
    /// among what is given.
    #[inline(always)]
    pub fn around(middle: f64, error: f64) -> Option<Interval> {
        let (low, high) = (middle - error, middle + error);
        // False for NaN, which must not look like an order.
        (low <= high).then_some(Interval { low, high })
    }

    /// The middle, rounded.
    #[inline(always)]
    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }
}

/// `|p| × |q|` with sums for differences. A rounded cross product is off by a few roundings of it (it is the
/// permanent to the cross product's determinant).
#[inline(always)]
pub fn cross_permanent(p: DVec3, q: DVec3) -> DVec3 {
    let (p, q) = (p.abs(), q.abs());
    DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_no_interval() {
        assert_eq!(Interval::around(1.0, 0.5), Some(Interval { low: 0.5, high: 1.5 }));
        for (middle, error) in [(f64::NAN, 1.0), (1.0, f64::NAN), (1.0, -1.0)] {
            assert_eq!(Interval::around(middle, error), None);
        }
    }

    #[test]
    fn one_rounding_is_off_by_half_a_last_place() {
        let beyond = 1.001;
        assert_eq!([1.0 + EPS53, 1.0 + beyond * EPS53], [1.0, 1.0_f64.next_up()]);
        assert_eq!([1.0 + EPS24, 1.0 + EPS24.next_up()], [1.0, 1.0_f32.next_up()]);
    }
}
