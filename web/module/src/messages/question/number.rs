//! A number as a student writes it: a fraction or a decimal.

use std::str::FromStr;

/// A number, and how exactly it was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    /// How far the true value may be away.
    tolerance: f64,
}

/// From so many decimals on, a number may be rounded.
const DECIMALS: usize = 3;
/// What the camera's own `f32` numbers may be away from tenths.
const ROUNDING: f64 = 1e-6;

impl Number {
    /// Whether the number stands for this value.
    pub(super) fn is(&self, value: f64) -> bool {
        (self.value - value).abs() <= self.tolerance + ROUNDING * value.abs().max(1.0)
    }
}

impl FromStr for Number {
    type Err = String;

    fn from_str(text: &str) -> Result<Number, String> {
        // A minus sign as it is printed, and a decimal comma.
        let plain = text.trim().replace('\u{2212}', "-").replace(',', ".");
        let read = match plain.split_once('/') {
            Some((above, below)) => decimal(above).zip(decimal(below)).map(|(above, below)| {
                let value = above.value / below.value;
                Number { value, tolerance: 0.0 }
            }),
            None => decimal(&plain),
        };
        read.filter(|number| number.value.is_finite())
            .ok_or_else(|| format!("{text:?} is not a number; write it as -3/8 or -0.375"))
    }
}

/// A sign, digits, and perhaps a point: no exponent, and no names of numbers.
fn decimal(text: &str) -> Option<Number> {
    let text = text.trim();
    let digits = text.trim_start_matches(['-', '+']);
    if !digits.chars().all(|letter| letter.is_ascii_digit() || letter == '.') {
        return None;
    }
    let value = text.parse().ok()?;
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let tolerance = match i32::try_from(decimals) {
        Ok(many) if decimals >= DECIMALS => 0.5 * 10_f64.powi(-many),
        _ => 0.0,
    };
    Some(Number { value, tolerance })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(text: &str, value: f64) -> bool {
        text.parse::<Number>().unwrap().is(value)
    }

    #[test]
    fn fractions_and_decimals_are_numbers() {
        assert!(is("-3/8", -0.375) && is("\u{2212}3/8", -0.375) && is("-0,375", -0.375));
        assert!(is(" 2 ", 2.0) && is("+.5", 0.5) && is("6 / 4", 1.5));
        assert!(!is("3/8", 0.25) && !is("0.37", 0.375));
        for text in ["", "a", "1/0", "1/2/3", "1e3", "nan", "inf", "--1", "1 2"] {
            assert!(text.parse::<Number>().is_err(), "{text}");
        }
    }

    #[test]
    fn three_decimals_may_be_rounded() {
        assert!(is("0.333", 1.0 / 3.0) && is("0.6667", 2.0 / 3.0));
        assert!(!is("0.33", 1.0 / 3.0) && !is("0.334", 1.0 / 3.0));
    }
}
