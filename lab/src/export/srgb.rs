//! Linear values as sRGB values, finer than bytes (IEC 61966-2-1:1999).

use crate::common::look::color::{encoded_from_linear, linear_from_srgb, srgb_from_linear};

/// The sRGB value in 0 … 1 of a linear one: that of a byte, if a byte stands for it.
pub(super) fn encoded(linear: f32) -> f32 {
    let byte = srgb_from_linear(linear);
    if linear_from_srgb(byte) == linear {
        return f32::from(byte) / 255.0;
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounded to what is written")]
    let encoded = encoded_from_linear(linear.into()) as f32;
    encoded
}

/// The 16 bits that stand for a linear value.
pub(super) fn encoded_in_16_bits(linear: f32) -> u16 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 65535")]
    let value = (65535.0 * encoded_from_linear(linear.into())).round() as u16;
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::look::color::linear_from_encoded;

    #[test]
    fn values_of_16_bits_survive_the_way_there_and_back() {
        let back = |value: u16| encoded_in_16_bits(linear_from_encoded(f32::from(value) / 65535.0));
        assert!((0..=u16::MAX).all(|value| back(value) == value));
    }

    #[test]
    fn bytes_are_written_as_bytes() {
        let back = |byte: u8| encoded(linear_from_srgb(byte)) == f32::from(byte) / 255.0;
        assert!((0..=255).all(back));
        assert!((linear_from_encoded(encoded(0.123)) - 0.123).abs() < 1e-7);
    }
}
