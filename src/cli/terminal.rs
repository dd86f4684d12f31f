//! Printing: results to stdout, warnings to stderr.

use super::failure::Failure;
use super::output::reason;
use serde::Serialize;
use std::io::{ErrorKind, Write};

/// Prints a text; its colours are kept on a terminal only, and not if `NO_COLOR` is set.
///
/// A reader that has seen enough (`bothways | head`) is no failure.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let reason = reason(&error, "send it elsewhere");
            Err(Failure::new(format!("cannot print to standard output: {reason}")))
        }
        _ => Ok(()),
    }
}

/// Prints to stderr what is missing but stops nothing, in colour as [`print()`] does.
pub(super) fn warn(warnings: &[String]) {
    let yellow = anstyle::AnsiColor::Yellow.on_default().bold();
    for warning in warnings {
        // If nobody can be told, the result is the same.
        let _ = writeln!(anstream::stderr(), "{yellow}warning{yellow:#}: {warning}");
    }
}

/// How many characters fit beside each other: 80 where nobody can tell.
pub(super) fn width() -> usize {
    terminal_size::terminal_size().map_or(80, |(width, _)| width.0.into())
}

/// A report as JSON for programs, with a newline at its end.
pub(super) fn json(report: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(report);
    text.map(|text| text + "\n").map_err(|error| Failure::new(error.to_string()))
}
