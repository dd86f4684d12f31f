//! Printing: results to stdout, warnings to stderr.

use super::failure::Failure;
use super::reason::reason;
use bothways::formats::source::quote::visible;
use serde::Serialize;
use std::borrow::Cow;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};

/// Prints a text with colours only on a terminal, and only if `NO_COLOR` is not set.
///
/// A reader that stops early (`bothways | head`) is no failure.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    // A file keeps every byte of the result; on a terminal, only our colour sequences may have an effect.
    let text = if io::stdout().is_terminal() { tame(text) } else { Cow::Borrowed(text) };
    let mut stdout = anstream::stdout().lock();
    printed(stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()))
}

/// Prints a report that may be larger than memory, as [`json`] writes it.
pub(super) fn print_json(report: &impl Serialize) -> Result<(), Failure> {
    if io::stdout().is_terminal() {
        return print(&json(report)?);
    }
    let mut stdout = BufWriter::new(io::stdout().lock());
    let written = serde_json::to_writer_pretty(&mut stdout, report).map_err(io::Error::from);
    printed(written.and_then(|()| stdout.write_all(b"\n")).and_then(|()| stdout.flush()))
}

fn printed(result: io::Result<()>) -> Result<(), Failure> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let reason = reason(&error, "send it elsewhere");
            Err(Failure::new(format!("cannot print to standard output: {reason}")))
        }
        _ => Ok(()),
    }
}

/// A text of several lines with no control sequence except colours: scenes are printed without other changes, and may
/// contain any characters.
pub(super) fn tame(text: &str) -> Cow<'_, str> {
    let kept = |c: char| c == '\n' || c == '\t';
    if visible(text).len() == text.len() {
        return Cow::Borrowed(text);
    }
    let mut tamed = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(character) = rest.chars().next() {
        let length = color_sequence(rest).unwrap_or(character.len_utf8());
        let (part, after) = rest.split_at(length);
        if length > character.len_utf8() || kept(character) {
            tamed.push_str(part);
        } else {
            tamed.push_str(&visible(part));
        }
        rest = after;
    }
    Cow::Owned(tamed)
}

/// The length of the sequence for colours and weights at the beginning of a text, if there is one.
fn color_sequence(text: &str) -> Option<usize> {
    let numbers = text.strip_prefix("\u{1b}[")?;
    let end = numbers.find(|c: char| !c.is_ascii_digit() && c != ';')?;
    numbers[end..].starts_with('m').then_some(2 + end + 1)
}

/// Prints warnings to stderr, in colour in the same cases as [`print()`].
pub(super) fn warn(warnings: &[String]) {
    let yellow = anstyle::AnsiColor::Yellow.on_default().bold();
    for warning in warnings {
        // If stderr is closed, the result is the same.
        let _ = writeln!(anstream::stderr(), "{yellow}warning{yellow:#}: {}", visible(warning));
    }
}

/// The width of the terminal in characters: 80 if the width is unknown.
pub(super) fn width() -> usize {
    terminal_size::terminal_size().map_or(80, |(width, _)| width.0.into())
}

/// A report as JSON for programs, with a newline at its end.
pub(super) fn json(report: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(report);
    text.map(|text| text + "\n").map_err(|error| Failure::new(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_obeys_nothing_but_colors() {
        let ours = "\u{1b}[1;33mA\u{1b}[0m\tb\n";
        assert_eq!(tame(ours), ours);
        let hostile = "# \u{1b}[2J\u{1b}]0;x\u{7} \u{202e}\u{9b}m\r\u{1b}[1";
        let shown = r"# \u{1b}[2J\u{1b}]0;x\u{7} \u{202e}\u{9b}m\u{d}\u{1b}[1";
        assert_eq!(tame(hostile), shown);
    }
}
