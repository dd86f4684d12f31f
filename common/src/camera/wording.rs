//! Numbers as messages show them.

use glam::Vec3;
use std::fmt::{Display, LowerExp};

/// A number in the fewest digits that read back as the same number, with a power of ten if its size is below 10⁻⁴, or
/// 10⁶ or more.
pub fn readable<T: Copy + Display + LowerExp + Into<f64>>(number: T) -> String {
    let size: f64 = number.into().abs();
    let is_short = size == 0.0 || (1e-4..1e6).contains(&size) || !size.is_finite();
    if is_short { format!("{number}") } else { format!("{number:e}") }
}

/// A vector as `[x, y, z]`, with each coordinate as [`readable`] writes it.
pub fn readable_vector(vector: Vec3) -> String {
    let [x, y, z] = vector.to_array().map(readable);
    format!("[{x}, {y}, {z}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tiny_and_huge_numbers_have_a_power_of_ten() {
        let numbers = [0.0, -0.5, 0.1, 2e-4, 9e-5, 999_999.0, -1e6, 3e38, f32::INFINITY];
        let shown = ["0", "-0.5", "0.1", "0.0002", "9e-5", "999999", "-1e6", "3e38", "inf"];
        assert_eq!(numbers.map(readable), shown);
        assert_eq!(readable_vector(Vec3::new(1.0, -2.5, 1e30)), "[1, -2.5, 1e30]");
    }
}
