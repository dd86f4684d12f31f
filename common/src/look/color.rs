//! Colours: linear values, which light adds up in, and the sRGB bytes of pictures.

/// An sRGB byte from a linear value in 0 … 1; values outside are clamped.
///
/// IEC 61966-2-1:1999.
pub fn srgb_from_linear(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let byte = (encoded * 255.0).round() as u8;
    byte
}

/// The linear value in 0 … 1 that an sRGB byte stands for.
pub fn linear_from_srgb(byte: u8) -> f32 {
    linear_from_encoded(f32::from(byte) / 255.0)
}

/// The linear value in 0 … 1 that an sRGB value in 0 … 1 stands for.
pub fn linear_from_encoded(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_bytes_survive_the_way_there_and_back() {
        assert!((0..=255).all(|byte| srgb_from_linear(linear_from_srgb(byte)) == byte));
    }
}
