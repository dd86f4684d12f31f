//! Numbers in a form for readers: `1,234,567 samples`.

use crate::common::Crop;
use crate::common::glam::DVec3;

pub use crate::common::camera::wording::readable;

/// A whole number with its digits in groups of three.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// A number of three digits.
pub(crate) fn three_digits(number: f64) -> String {
    let short = format!("{number:.2e}").parse::<f64>();
    short.map_or_else(|_| number.to_string(), |short| short.to_string())
}

/// A number of things; for one thing, without the s of the plural.
pub fn count(number: u64, things: &str) -> String {
    let things = if number == 1 { things.trim_end_matches('s') } else { things };
    format!("{} {things}", grouped(number))
}

/// The pixels of a picture: all pixels of an image of this width and height, or a crop. `times` stands between two
/// sides.
///
/// ```
/// use bothways_lab::{common::Crop, wording::pixels_shown};
///
/// let crop = Crop { row: 486, column: 864, height: 108, width: 192 };
/// assert_eq!(pixels_shown([1920, 1080], None, "x"), "1920 x 1080 pixels");
/// let shown = "crop of 192 x 108 pixels at (486, 864) in 1920 x 1080";
/// assert_eq!(pixels_shown([1920, 1080], Some(crop), "x"), shown);
/// ```
pub fn pixels_shown([width, height]: [u32; 2], crop: Option<Crop>, times: &str) -> String {
    let Some(crop) = crop else {
        return format!("{width} {times} {height} pixels");
    };
    let pixels = format!("{} {times} {} pixels", crop.width, crop.height);
    format!("crop of {pixels} at ({}, {}) in {width} {times} {height}", crop.row, crop.column)
}

/// A time in milliseconds, with its unit: two decimals below 10 ms, one below 100 ms, none above.
pub fn milliseconds(time: f64) -> String {
    let decimals = match time {
        time if time < 9.995 => 2,
        time if time < 99.95 => 1,
        _ => 0,
    };
    format!("{time:.decimals$} ms")
}

/// The vector without a negative zero.
pub fn plain(vector: DVec3) -> [f64; 3] {
    (vector + DVec3::ZERO).to_array()
}

/// `(x, y, z)`, each number with the fewest digits that read back as the same number.
pub fn vector<T: std::fmt::Display>([x, y, z]: [T; 3]) -> String {
    format!("({x}, {y}, {z})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_come_in_threes() {
        let numbers = [0, 7, 999, 1000, 12_345, 123_456, 1_234_567, u64::MAX];
        assert_eq!(
            numbers.map(grouped),
            [
                "0",
                "7",
                "999",
                "1,000",
                "12,345",
                "123,456",
                "1,234,567",
                "18,446,744,073,709,551,615"
            ]
        );
    }

    #[test]
    fn one_thing_is_singular() {
        assert_eq!([count(0, "samples"), count(1, "samples")], ["0 samples", "1 sample"]);
    }

    #[test]
    fn times_keep_three_digits() {
        assert_eq!(
            [0.0, 1.234, 9.996, 99.96, 1234.5].map(milliseconds),
            ["0.00 ms", "1.23 ms", "10.0 ms", "100 ms", "1234 ms"]
        );
    }
}
