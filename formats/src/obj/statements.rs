//! The statements of an OBJ or MTL file: its lines, where a backslash at the end of a line joins the next one.

use super::error::StatementFault;
use super::words::{Words, is_text};
use crate::source::without_mark;
use std::io::{self, BufRead, Read};

/// The longest statement that is read from a file: a polygon of some million corners.
pub(super) const MOST_BYTES_A_STATEMENT: usize = 1 << 24;

/// Iterates over the statements of a file in memory, without a copy.
///
/// Lines end with a line feed, with or without a carriage return before it.
pub(super) struct Statements<'a> {
    rest: &'a [u8],
    next_line: usize,
}

impl<'a> Statements<'a> {
    /// All statements of a file, after its byte order mark if it has one.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Statements::from_line(without_mark(bytes), 1)
    }

    /// The statements of a piece of a file that begins with this line.
    pub(super) fn from_line(piece: &'a [u8], line: usize) -> Self {
        Statements { rest: piece, next_line: line }
    }

    /// What has not been iterated over yet, and the number of its first line.
    pub(super) fn rest(&self) -> (&'a [u8], usize) {
        (self.rest, self.next_line)
    }

    /// Skips the first bytes of the rest, which are one line.
    pub(super) fn skip_line(&mut self, bytes: usize) {
        self.rest = &self.rest[bytes..];
        self.next_line += 1;
    }
}

impl<'a> Iterator for Statements<'a> {
    /// The line on which the statement begins, counted from 1, and its words.
    type Item = (usize, Words<'a>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let (bytes, first_line) = (self.rest, self.next_line);
        let mut start = 0;
        loop {
            let Some(length) = bytes[start..].iter().position(|&byte| byte == b'\n') else {
                self.rest = &[];
                return Some((first_line, Words::new(bytes)));
            };
            let end = start + length;
            self.next_line += 1;
            if !continues(&bytes[start..end]) {
                self.rest = &bytes[end + 1..];
                return Some((first_line, Words::new(&bytes[..end])));
            }
            start = end + 1;
        }
    }
}

/// Reads the statements of a file one at a time, into a buffer that holds one statement.
pub(super) struct BufferedStatements<R> {
    input: R,
    statement: Vec<u8>,
    next_line: usize,
}

impl<R: BufRead> BufferedStatements<R> {
    /// All statements from the position of `input` on.
    pub(super) fn new(input: R) -> Self {
        BufferedStatements { input, statement: Vec::new(), next_line: 1 }
    }

    /// Gives the next statement, as [`Statements::next`] does.
    ///
    /// A statement of more than `most` bytes is cut after `most + 1` bytes.
    pub(super) fn next(&mut self, most: usize) -> io::Result<Option<(usize, Words<'_>)>> {
        let first_line = self.next_line;
        self.statement.clear();
        loop {
            let start = self.statement.len();
            let room = (most + 1).saturating_sub(start) as u64;
            self.input.by_ref().take(room).read_until(b'\n', &mut self.statement)?;
            if self.statement.is_empty() {
                return Ok(None);
            }
            let Some(line) = self.statement[start..].strip_suffix(b"\n") else {
                break;
            };
            self.next_line += 1;
            if !continues(line) {
                self.statement.pop();
                break;
            }
        }
        Ok(Some((first_line, Words::new(&self.statement))))
    }
}

/// Makes sure that a statement is not too long to be read from a file.
pub(super) fn check_length(words: &Words) -> Result<(), StatementFault> {
    if words.length() <= MOST_BYTES_A_STATEMENT {
        return Ok(());
    }
    // The reader of statements one by one stops here, perhaps within the first word.
    match words.cut(MOST_BYTES_A_STATEMENT + 1).next() {
        Some(word) if !is_text(word) => Err(StatementFault::NotText),
        _ => Err(StatementFault::TooLong { most: MOST_BYTES_A_STATEMENT }),
    }
}

/// Tells whether the line after this one belongs to the same statement.
pub(super) fn continues(line: &[u8]) -> bool {
    // A comment ends with its line, even if its last character is a backslash, as after a folder's name.
    let has_comment = || Words::new(line).has_comment();
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") && !has_comment()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each statement with words as "line: word word".
    fn statements(text: &str) -> Vec<String> {
        let shown = |(line, words): (usize, Words)| {
            let words: Vec<_> = words.map(String::from_utf8_lossy).collect();
            format!("{line}: {}", words.join(" "))
        };
        Statements::new(text.as_bytes()).map(shown).collect()
    }

    #[test]
    fn blanks_and_line_ends_of_any_kind_separate() {
        assert_eq!(statements("v  1\t2 3 \r\n\r\nf 1\n"), ["1: v 1 2 3", "2: ", "3: f 1"]);
        assert_eq!(statements("v 1\nf 2"), ["1: v 1", "2: f 2"]);
        assert_eq!(statements(""), [""; 0]);
    }

    #[test]
    fn a_backslash_joins_lines_and_separates_words() {
        assert_eq!(statements("f 1 \\\n 2\\\r\n3\nv"), ["1: f 1 2 3", "4: v"]);
        assert_eq!(statements("f 1\\2\nf 3 \\"), ["1: f 1\\2", "2: f 3 \\"]);
        assert_eq!(statements("f 1 \\\n\\\n2"), ["1: f 1 2"]);
    }

    #[test]
    fn a_comment_ends_with_its_line() {
        assert_eq!(statements("v 1 # x\n#y\nf #\\\nf"), ["1: v 1", "2: ", "3: f", "4: f"]);
        assert_eq!(statements("# from C:\\meshes\\\nv 1"), ["1: ", "2: v 1"]);
        assert_eq!(statements("g a#1 b\n"), ["1: g a#1 b"]);
    }
}
