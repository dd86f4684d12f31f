//! Numbers as all systems read them.

/// The number with the fewest digits that read back as the same number, never `-0.0`. All systems here read it.
pub(super) fn number(number: f64) -> String {
    format!("{:?}", number + 0.0)
}

/// Numbers with something between them.
pub(super) fn numbers(numbers: &[f64], between: &str) -> String {
    numbers.iter().map(|value| number(*value)).collect::<Vec<_>>().join(between)
}
