//! Reads decimal numbers as the nearest `f32`, most of them in one pass over their digits.

/// Reads a word as the nearest `f32`, as `str::parse` does: the same words, the same bits.
///
/// The word is rounded once: rounding to `f64` first could give a neighbour of the nearest `f32`.
pub(crate) fn nearest(word: &[u8]) -> Option<f32> {
    match leading(word) {
        Some((value, length)) if length == word.len() => Some(value),
        _ => str::from_utf8(word).ok()?.parse().ok(),
    }
}

/// The most digits whose number fits into a `u64`, whatever they are.
const MOST_DIGITS: usize = 19;
/// Powers of ten that are exact in `f64`: 5²² has 52 bits.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Reads the number at the beginning of `bytes`, and tells how many bytes it has. `None` if there is none, or if it is of
/// a form that only [`nearest`] reads: with more than 19 digits, a large exponent, or too close a call.
pub(crate) fn leading(bytes: &[u8]) -> Option<(f32, usize)> {
    let is_negative = bytes.first() == Some(&b'-');
    let start = usize::from(is_negative || bytes.first() == Some(&b'+'));
    let (mut number, mut at) = (0_u64, start);
    while let Some(digit) = digit(bytes, at) {
        number = number.wrapping_mul(10).wrapping_add(digit);
        at += 1;
    }
    let mut digits = at - start;
    let mut after_point = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        let point = at;
        while let Some(digit) = digit(bytes, at) {
            number = number.wrapping_mul(10).wrapping_add(digit);
            at += 1;
        }
        after_point = at - point;
        digits += after_point;
    }
    if digits == 0 || digits > MOST_DIGITS {
        return None;
    }
    let mut exponent = -i32::try_from(after_point).ok()?;
    if let Some(b'e' | b'E') = bytes.get(at) {
        let (stated, length) = small_exponent(&bytes[at + 1..])?;
        exponent += stated;
        at += 1 + length;
    }
    let value = scaled(number, exponent)?;
    Some((if is_negative { -value } else { value }, at))
}

fn digit(bytes: &[u8], at: usize) -> Option<u64> {
    let digit = bytes.get(at)?.wrapping_sub(b'0');
    (digit < 10).then(|| digit.into())
}

/// Reads an exponent of one or two digits, with or without a sign, and tells how many bytes it has.
fn small_exponent(bytes: &[u8]) -> Option<(i32, usize)> {
    let is_negative = bytes.first() == Some(&b'-');
    let start = usize::from(is_negative || bytes.first() == Some(&b'+'));
    let (mut exponent, mut at) = (0, start);
    while let Some(digit @ b'0'..=b'9') = bytes.get(at) {
        exponent = 10 * exponent + i32::from(digit - b'0');
        at += 1;
        if at - start > 2 {
            return None;
        }
    }
    (at > start).then_some((if is_negative { -exponent } else { exponent }, at))
}

/// The nearest `f32` of `number` times a power of ten, where `f64` can tell it.
///
/// Clinger's fast path ("How to Read Floating Point Numbers Accurately", PLDI 1990), one precision lower: rounding the
/// number to `f64` and multiplying it by an exact power (or dividing it by one) have a relative error of at most 2⁻⁵³
/// each, together less than 2⁻⁵² + 2⁻¹⁰⁵. Neighbours in `f64` differ by at least 2⁻⁵³ of their size, so the product is less
/// than 3 of them from the truth. It rounds to the same `f32` as the truth unless a middle between two `f32` is that
/// near. In the normal range of `f32` such middles are the `f64` whose last 29 bits are 1 followed by zeros.
fn scaled(number: u64, exponent: i32) -> Option<f32> {
    const MIDDLE: u64 = 1 << 28;
    if number == 0 {
        return Some(0.0);
    }
    let power = *POWERS.get(usize::try_from(exponent.unsigned_abs()).ok()?)?;
    #[expect(clippy::cast_precision_loss, reason = "the bound takes it into account")]
    let number = number as f64;
    let value = if exponent < 0 { number / power } else { number * power };
    let last = value.to_bits() & (2 * MIDDLE - 1);
    // Beyond either end of the normal range, middles are elsewhere.
    let is_normal = (1.2e-38..3.4e38).contains(&value);
    #[expect(clippy::cast_possible_truncation, reason = "to the nearest")]
    (is_normal && last.abs_diff(MIDDLE) > 3).then_some(value as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What the standard library reads, as bits.
    fn standard(word: &str) -> Option<u32> {
        word.parse::<f32>().ok().map(f32::to_bits)
    }

    fn ours(word: &str) -> Option<u32> {
        nearest(word.as_bytes()).map(f32::to_bits)
    }

    #[test]
    fn unusual_words_are_read_as_the_standard_library_reads_them() {
        let words = [
            "",
            "-",
            "+",
            ".",
            "-.",
            "1.",
            ".5",
            "+.5",
            "-0",
            "-0.0",
            "0e99",
            "1e",
            "1e+",
            "1e5",
            "1E-05",
            "1e-400",
            "1e400",
            "1.5e38",
            "3.4028235e38",
            "3.4028236e38",
            "1e-38",
            "1e-45",
            "1e-46",
            "nan",
            "inf",
            "-infinity",
            "0x10",
            "1_0",
            "1 ",
            " 1",
            "1,5",
            "12345678901234567890",
            "1.2.3",
            "--1",
            "00000000000000000000001",
            "0.00000000000000000000000000000001",
            "16777217",
            "16777219",
            "33554434.0000000000",
            "9007199254740993",
            "1e22",
            "1e23",
            "1e-22",
            "5e-23",
            "1e001",
        ];
        for word in words {
            assert_eq!(ours(word), standard(word), "{word}");
        }
    }

    #[test]
    fn most_numbers_of_files_take_the_short_way() {
        for word in
            ["0", "-1", "0.1", "-0.99999756", "123.456789", "0.12345678901234567", "-4.93e-6"]
        {
            let (value, length) = leading(word.as_bytes()).unwrap();
            assert_eq!((Some(value.to_bits()), length), (standard(word), word.len()), "{word}");
        }
    }

    /// Middles between neighbours, written in full, and numbers a little beside them: the closest calls there are.
    #[test]
    fn middles_between_neighbours_round_as_they_do_in_the_standard_library() {
        for bits in (0x0080_0000_u32..0x7f7f_ffff).step_by(65_521) {
            let (low, high) =
                (f64::from(f32::from_bits(bits)), f64::from(f32::from_bits(bits + 1)));
            let middle = (low + high) / 2.0;
            for near in [middle.next_down(), middle, middle.next_up()] {
                for word in [
                    format!("{near}"),
                    format!("{near:e}"),
                    format!("{near:.17}"),
                    format!("{near:.18e}"),
                ] {
                    assert_eq!(ours(&word), standard(&word), "{word}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn words_of_digits_are_read_as_the_standard_library_reads_them(
            word in "[-+]?[0-9]{0,12}[.]?[0-9]{0,12}([eE][-+]?[0-9]{0,3})?",
        ) {
            prop_assert_eq!(ours(&word), standard(&word), "{}", word);
        }

        #[test]
        fn all_floats_are_read_back(bits in any::<u32>(), double in any::<u64>()) {
            let (single, double) = (f32::from_bits(bits), f64::from_bits(double));
            for word in [format!("{single}"), format!("{single:e}"), format!("{double:e}"), format!("{}", f64::from(single) / 3.0)] {
                // The sign of NaN is lost in either way.
                prop_assert_eq!(nearest(word.as_bytes()).map(|v| format!("{v:?}")), word.parse::<f32>().ok().map(|v| format!("{v:?}")), "{}", word);
            }
        }
    }
}
