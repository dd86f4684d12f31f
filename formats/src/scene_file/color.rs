//! Colours in scene files.

use super::document::Item;
use super::error::Problem;
use crate::source::quote::quoted;
use bothways_common::look::color::linear_from_srgb;
use glam::Vec3;

/// Reads a colour as screens show it, `"#rrggbb"`, and returns it as linear red, green and blue.
pub(super) fn color(item: &Item) -> Result<Vec3, Problem> {
    let text = item.text()?;
    let byte = |range| u8::from_str_radix(text.get(range)?, 16).ok();
    // `from_str_radix` would accept a sign in place of a digit.
    let digits = text.len() == 7 && text.chars().skip(1).all(|c| c.is_ascii_hexdigit());
    let bytes =
        (digits && text.starts_with('#')).then(|| Some([byte(1..3)?, byte(3..5)?, byte(5..7)?]));
    match bytes.flatten() {
        Some(bytes) => Ok(Vec3::from_array(bytes.map(linear_from_srgb))),
        None => Err(item
            .problem(format!("is {}; it must be a # and six hexadecimal digits", quoted(text)))
            .help("write for example \"#c8553d\"")),
    }
}
