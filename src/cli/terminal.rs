//! Printing to stdout.

use super::failure::Failure;
use std::io::{ErrorKind, Write};

/// Prints a text; its colours are kept on a terminal only, and not if `NO_COLOR` is set.
///
/// A reader that has seen enough (`bothways | head`) is no failure.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = anstream::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("cannot print to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
