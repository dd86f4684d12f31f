//! Lines and numbers of a comparison.

use std::fmt::Write;

/// `1 differs`, `2 differ`.
pub(super) fn count_of(number: usize, one: &str, several: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { several })
}

pub(super) fn line(text: &mut String, content: std::fmt::Arguments) {
    writeln!(text, "{content}").expect("a string takes all");
}

/// A number without unnecessary decimals.
pub(super) fn number(steps: f32) -> String {
    if steps.fract() == 0.0 { format!("{steps}") } else { format!("{steps:.2}") }
}
