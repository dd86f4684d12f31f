//! The words of a statement, and the numbers that words stand for.

use super::error::StatementFault;
use crate::source::decimal;
use crate::source::quote::quote;

/// Iterates over the words of a statement, up to a comment. Blanks and joined line ends separate words.
#[derive(Clone)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
}

impl<'a> Words<'a> {
    /// The words of these bytes.
    pub(super) fn new(statement: &'a [u8]) -> Self {
        Words { rest: statement }
    }

    /// The rest of the statement as it is written, or `None` if it is blank: a name, which may contain blanks
    /// and `#`.
    pub(super) fn text(&self) -> Option<String> {
        let text = self.rest.trim_ascii();
        (!text.is_empty()).then(|| String::from_utf8_lossy(text).into_owned())
    }

    /// The words of so many bytes of the rest of the statement.
    pub(super) fn cut(&self, bytes: usize) -> Self {
        Words { rest: &self.rest[..bytes.min(self.rest.len())] }
    }

    /// The number of bytes in the rest of the statement.
    pub(super) fn length(&self) -> usize {
        self.rest.len()
    }

    /// Tells whether a comment begins in the rest of the statement.
    pub(super) fn has_comment(mut self) -> bool {
        while let Some(word) = self.split_word() {
            if word.starts_with(b"#") {
                return true;
            }
        }
        false
    }

    fn split_word(&mut self) -> Option<&'a [u8]> {
        let start = self.rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = &self.rest[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let (word, rest) = rest.split_at(end);
        self.rest = rest;
        Some(word)
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        loop {
            let word = self.split_word()?;
            if word.starts_with(b"#") {
                self.rest = &[];
                return None;
            }
            // A line end inside a statement is a joined one, and the backslash before it is not part of the word.
            let after = self.rest.strip_prefix(b"\r").unwrap_or(self.rest);
            let joined = after.starts_with(b"\n");
            let word = if joined { word.strip_suffix(b"\\").unwrap_or(word) } else { word };
            if !word.is_empty() {
                return Some(word);
            }
        }
    }
}

/// Reads a word as the nearest `f32`.
pub(super) fn number(word: &[u8]) -> Result<f32, StatementFault> {
    match decimal::nearest(word) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) if word.iter().any(u8::is_ascii_digit) => {
            Err(StatementFault::OutOfRange { text: quote(word) })
        }
        Some(_) => Err(StatementFault::NotFinite { text: quote(word) }),
        None => Err(StatementFault::NotANumber { text: quote(word) }),
    }
}

/// Reads a word as a whole number.
pub(super) fn integer(text: &[u8]) -> Option<i64> {
    str::from_utf8(text).ok()?.parse().ok()
}

/// Tells whether a word is UTF-8 without control characters.
pub(super) fn is_text(word: &[u8]) -> bool {
    str::from_utf8(word).is_ok_and(|text| !text.contains(char::is_control))
}
