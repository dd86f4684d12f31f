//! Which way a corner turns, and which way round a polygon goes: exactly.

use bothways_common::exact::{Sign, two_sum};

/// A corner in the plane. Both coordinates are numbers of an `f32`, so a product of two has 48 digits, none of them below
/// 2⁻²⁹⁸, and is exact.
pub(super) type Point = [f64; 2];

/// The sign of the area of the triangle `a`, `b`, `c`: positive if the way from `a` by `b` to `c` turns left, from the first
/// axis to the second.
pub(super) fn turn(a: Point, b: Point, c: Point) -> Sign {
    let (left, right) = ((b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0]));
    let area = left - right;
    // Both are exactly zero: a difference that is not is at least 2⁻¹⁴⁹, and no product underflows.
    let is_zero = left == 0.0 && right == 0.0;
    if is_zero || area.abs() > MOST_LOST * (left.abs() + right.abs()) {
        Sign::of(area)
    } else {
        area_sign(&[a, b, c])
    }
}

/// Tells whether a corner `b` of three on a line is not between the other two: the way goes back from it, or stands still.
pub(super) fn goes_back(a: Point, b: Point, c: Point) -> bool {
    // On a line, the order of the coordinates is that of the points.
    !(a < b && b < c || c < b && b < a)
}

/// Two differences and their product are rounded, three times one part in 2⁵³ of `left` and of `right`; so is the last
/// difference, one part in 2⁵³ of the area. A fourth part leaves room for the products of these parts, and for the three roundings of the bound.
/// The filter A of Shewchuk's `orient2d`, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", Discrete & Computational Geometry 18, 1997, has the factor 3.
const MOST_LOST: f64 = 4.0 * (f64::EPSILON / 2.0);

/// The sign of a polygon's area, in which what it goes around twice counts twice: positive if it goes around to the left.
pub(super) fn area_sign(points: &[Point]) -> Sign {
    // Twice the area is the sum of these products, none of which is rounded (the surveyor's formula).
    let next = points.iter().cycle().skip(1);
    sum_sign(points.iter().zip(next).flat_map(|(a, b)| [a[0] * b[1], -(a[1] * b[0])]))
}

/// The sign of a sum, without rounding.
///
/// The sum is kept as an expansion: parts from the least to the largest whose digits do not overlap, so the last one has its
/// sign. Each term is added by the algorithm `GROW-EXPANSION` of Shewchuk, 1997, theorem 10.
fn sum_sign(terms: impl Iterator<Item = f64>) -> Sign {
    let mut parts: Vec<f64> = Vec::new();
    for mut sum in terms {
        let mut kept = 0;
        for k in 0..parts.len() {
            let (rounded, lost) = two_sum(sum, parts[k]);
            sum = rounded;
            if lost != 0.0 {
                parts[kept] = lost;
                kept += 1;
            }
        }
        parts.truncate(kept);
        if sum != 0.0 {
            parts.push(sum);
        }
    }
    parts.last().map_or(Sign::Zero, |&largest| Sign::of(largest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_lies_on_a_line_but_for_the_last_digit_is_told_apart() {
        // Differences of these numbers are not exact in `f64`.
        let tiny = f64::from(f32::from_bits(1));
        let (a, b) = ([tiny, tiny], [f64::from(f32::MAX); 2]);
        assert_eq!(turn(a, b, [1.0, 1.0]), Sign::Zero);
        assert_eq!(turn([0.0, tiny], b, [1.0, 1.0]), Sign::Negative);
        assert_eq!(turn([tiny, 0.0], b, [1.0, 1.0]), Sign::Positive);
        let above = f64::from(1.0 + f32::EPSILON);
        assert_eq!(turn(a, b, [1.0, above]), Sign::Positive);
        assert_eq!(turn(a, b, [above, 1.0]), Sign::Negative);
    }

    #[test]
    fn a_polygon_has_the_sign_of_its_larger_loop() {
        let eight = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(area_sign(&eight), Sign::Zero);
        let larger = |height: f32| [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, f64::from(height)]];
        assert_eq!(area_sign(&larger(2.0 + 2.0 * f32::EPSILON)), Sign::Positive);
        assert_eq!(area_sign(&larger(2.0 - f32::EPSILON)), Sign::Negative);
    }

    proptest! {
        #[test]
        fn signs_are_those_of_whole_numbers(
            corners in proptest::array::uniform3([-8_i16..8, -8_i16..8]),
            scale in -40_i32..40,
            far in [0_u8..3, 0_u8..3],
        ) {
            let [a, b, c] = corners.map(|of| {
                let value = |k: usize| i64::from(of[k]) + (i64::from(far[k]) << 18);
                [value(0), value(1)]
            });
            let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            let point = |of: [i64; 2]| of.map(|value| {
                f64::from(i32::try_from(value).unwrap()) * 2f64.powi(scale)
            });
            let [a, b, c] = [a, b, c].map(point);
            prop_assert_eq!(turn(a, b, c) as i64, area.signum() + 1);
            prop_assert_eq!(area_sign(&[a, b, c]) as i64, area.signum() + 1);
        }
    }
}
