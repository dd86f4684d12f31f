//! Powers in SIMD, with derived bounds.

use crate::engine::simd::{
    Bytes, Select, Simd, SimdBase, SimdFloat, SimdInt, f32x16, i32x16, mask32x16,
};
use std::f32::consts::{FRAC_1_SQRT_2, LN_2, LOG2_E};

/// An exponent, and from which base on its powers are worth computing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exponent {
    exponent: f32,
    /// Powers of smaller bases are below 2⁻²², or the bases are subnormal.
    least: f32,
    /// The exponent in halves, if it is a whole number of them and not large.
    halves: Option<u32>,
}

/// Larger exponents are not multiplied out.
const MANY_HALVES: f32 = 256.0;

impl Exponent {
    /// A positive exponent.
    pub(crate) fn new(exponent: f32) -> Exponent {
        // The power is below 2^−22 if log₂ base < −22 / exponent; eighths of an octave are fine enough. Roots and products
        // are rounded alike on every machine; a hundredth of an octave is more than all their roundings.
        let eighths = (8.0 * 22.01 / exponent).ceil();
        let eighth = 0.5_f32.sqrt().sqrt().sqrt();
        let (mut least, mut count) = (1.0, 0.0);
        while count < eighths && least > f32::MIN_POSITIVE {
            least *= eighth;
            count += 1.0;
        }
        let halves = 2.0 * exponent;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small whole number, and positive"
        )]
        let halves = (halves <= MANY_HALVES && halves.fract() == 0.0).then_some(halves as u32);
        Exponent { exponent, least: least.max(f32::MIN_POSITIVE), halves }
    }

    /// Where the power of a quotient is not certainly 0: what is left out is below 2⁻²². Nothing is divided for that; the
    /// rounding of the product is one more that the hundredth of an octave is enough for.
    #[inline(always)]
    pub(crate) fn is_some<S: Simd>(self, simd: S, [above, below]: [f32x16<S>; 2]) -> mask32x16<S> {
        above.simd_ge(f32x16::splat(simd, self.least) * below)
    }
}

/// `base^exponent` for a base in 0 … 1 and a positive exponent; a base above 1 counts as 1. Where
/// [`Exponent::is_some`] is false, the result means nothing, and 0 is to be taken: so it is for what is not a number.
///
/// Most exponents are half a whole shininess: see [`multiplied`]. The result for others is within 2⁻²¹ of the true power,
/// absolutely. The derivation, with `ε₂₄ = 2⁻²⁴` for one rounding:
///
/// - `base = 2^e · m` with `m` between √½ and √2, exactly. `f = m − 1` is exact, too. With `s = f / (2 + f)`, `|s| ≤
///   0.1716`, is `log₂ m = 2/ln 2 · (s + s³/3 + s⁵/5 + s⁷/7 + s⁹/9 + …)`. The terms that are left out are at most
///   `s¹⁰/11 / (1 − s²) < 2.1·10⁻⁹ < ε₂₄/28` of the sum. `s` has two roundings, the polynomial of `s²` less than three
///   more (all that follows its leading 1 is below 0.011), and two products: a relative error below `8ε₂₄`. The sum with
///   `e` adds one rounding; where `e ≠ 0`, the sum is at least ½ and no smaller than `|log₂ m|`, so the error of
///   `log₂ base` stays below `9ε₂₄`, relatively.
/// - `y = exponent · log₂ base` has a relative error of less than `10ε₂₄`, and is raised to −126 if it is below that.
/// - `y = n + g` with `|g| ≤ ½`, exactly. `2^g = e^{g ln 2}` is summed up to the seventh power; what is left out is less
///   than `0.3466⁸/8! · 1.04 < 5.4·10⁻⁹ < ε₂₄/11`. The argument's two roundings weigh `0.35 · 2ε₂₄`, those of Horner's
///   scheme less than `2.6ε₂₄` in all: less than `4ε₂₄`. The scaling by `2^n` is exact.
/// - An absolute error `δ` of `y` is a relative error of about `δ ln 2` of the power. So the error is at most
///   `2^y · (10ε₂₄ · |y| ln 2 + 4ε₂₄) ≤ 10ε₂₄/e + 4ε₂₄ < 8ε₂₄ = 2⁻²¹`, as `2^y · |y| ln 2 ≤ 1/e`. Where `y` was raised to
///   −126, both the result and the true power are below 2⁻¹²⁵.
#[inline(always)]
pub(crate) fn power<S: Simd>(simd: S, base: f32x16<S>, exponent: Exponent) -> f32x16<S> {
    let splat = |value: f32| f32x16::splat(simd, value);
    let base = base.simd_lt(splat(1.0)).select(base, splat(1.0));
    if let Some(halves) = exponent.halves {
        // Smaller bases, which mean nothing, would lead to subnormal numbers, which some machines are slow with.
        let base = base.simd_gt(splat(exponent.least)).select(base, splat(exponent.least));
        return multiplied(simd, base, halves);
    }

    let bits: i32x16<S> = base.bitcast();
    let root_half = i32x16::splat(simd, FRAC_1_SQRT_2.to_bits().cast_signed());
    let e = (bits - root_half) >> 23;
    let m: f32x16<S> = (bits - (e << 23)).bitcast();
    let f = m - splat(1.0);
    let s = f / (f + splat(2.0));
    let square = s * s;
    let mut sum = splat(1.0 / 9.0);
    for coefficient in [1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0] {
        sum = sum * square + splat(coefficient);
    }
    let logarithm = s * sum * splat(2.0 * LOG2_E) + e.to_float::<f32x16<S>>();

    let y = splat(exponent.exponent) * logarithm;
    let y = y.simd_gt(splat(-126.0)).select(y, splat(-126.0));
    let n = y.round_ties_even();
    let g = (y - n) * splat(LN_2);
    let mut sum = splat(1.0 / 5040.0);
    for coefficient in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 1.0 / 2.0, 1.0, 1.0] {
        sum = sum * g + splat(coefficient);
    }
    let scaled: i32x16<S> = sum.bitcast::<i32x16<S>>() + (n.to_int::<i32x16<S>>() << 23);
    scaled.bitcast()
}

/// The power of a base in 0 … 1 to some halves, by squares of squares, and a root.
///
/// A square has twice the relative error of what is squared, and one rounding more; a product has both errors, and one rounding
/// more. So `base^n` has no more than `n − 1` roundings, and with the root in front of it, `base^(n + ½)` no more than `n + 1`: a
/// relative error of at most `1.001 · 13 · 2⁻²⁴` for an exponent of 12.5, and of about 2⁻¹⁷ for the largest. The last place of the base
/// itself weighs as much.
#[inline(always)]
fn multiplied<S: Simd>(simd: S, base: f32x16<S>, halves: u32) -> f32x16<S> {
    let mut product = if halves % 2 == 1 { base.sqrt() } else { f32x16::splat(simd, 1.0) };
    let (mut square, mut left) = (base, halves / 2);
    while left != 0 {
        if left % 2 == 1 {
            product *= square;
        }
        square *= square;
        left /= 2;
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{Level, dispatch, levels};

    fn powers(level: Level, bases: [f32; 16], exponent: f32) -> [f32; 16] {
        dispatch!(level, simd => {
            let (base, exponent) = (f32x16::from_slice(simd, &bases), Exponent::new(exponent));
            let is_some = exponent.is_some(simd, [base, f32x16::splat(simd, 1.0)]);
            is_some.select(power(simd, base, exponent), f32x16::splat(simd, 0.0)).to_array()
        })
    }

    #[test]
    fn powers_are_within_their_bound_at_every_level() {
        let multiplied = [0.5, 1.0, 2.0, 12.5, 25.0, 31.5, 120.0, 127.5, 128.0];
        let others = [1e-6, 0.01, 1.0 / 2.4, 3.7, 128.5, 5000.0, 1e6, f32::MAX];
        for exponent in multiplied.into_iter().chain(others) {
            let mut worst = 0.0_f64;
            for step in 0..20_000_u32 {
                // All exponents of two, and close to 1 all numbers.
                let bits = |lane: u32| {
                    let at = 16 * step + lane;
                    if step < 2000 { 0x3f80_0000 - at } else { (at - 32_000) * 3678 }
                };
                let bases: [f32; 16] = std::array::from_fn(|lane| {
                    f32::from_bits(bits(u32::try_from(lane).unwrap()).min(0x3f80_0000))
                });
                let all = levels().into_iter().map(|level| powers(level, bases, exponent));
                let all: Vec<[f32; 16]> = all.collect();
                assert!(all.iter().all(|one| one.map(f32::to_bits) == all[0].map(f32::to_bits)));
                for (base, found) in bases.into_iter().zip(all[0]) {
                    if base >= f32::MIN_POSITIVE {
                        let exact = f64::from(base).powf(f64::from(exponent));
                        worst = worst.max((f64::from(found) - exact).abs());
                    }
                }
            }
            let is_multiplied = Exponent::new(exponent).halves.is_some();
            assert_eq!(is_multiplied, multiplied.contains(&exponent));
            let bound = if is_multiplied {
                (1.001 * f64::from(exponent + 0.5) * 2f64.powi(-24)).max(2f64.powi(-22))
            } else {
                2f64.powi(-21)
            };
            println!("{exponent}: 2^{:.2} of 2^{:.2}", worst.log2(), bound.log2());
            assert!(worst < bound, "{exponent}: {worst:e}");
        }
    }

    #[test]
    fn only_powers_that_are_too_small_to_be_seen_are_left_out() {
        for exponent in [0.01_f32, 0.25, 1.0, 3.7, 12.5, 30.0, 60.0, 500.0, 1e5] {
            let least = f64::from(Exponent::new(exponent).least);
            let left_out = least.powf(f64::from(exponent));
            let ends = least <= f64::from(f32::MIN_POSITIVE);
            assert!(
                least < 1.0 && (ends || left_out <= 2f64.powi(-22)),
                "{exponent}: {left_out:e}"
            );
            // Not even an eighth of an octave more than needed, unless numbers end.
            let next = (least * 2f64.powf(0.13)).min(1.0).powf(f64::from(exponent));
            assert!(ends || next > 2f64.powf(-22.01), "{exponent}: {next:e}");
        }
    }

    #[test]
    fn what_is_no_base_is_0_or_1() {
        let mut bases = [0.0; 16];
        bases[..6].copy_from_slice(&[f32::NAN, -1.0, 1.0, 1.5, f32::INFINITY, 1e-40]);
        for level in levels() {
            assert_eq!(powers(level, bases, 2.5)[..7], [0.0, 0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
        }
    }
}
