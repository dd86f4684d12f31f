//! The statements of an OBJ file and the words of a statement, taken from its bytes without a copy.

use std::io::{self, BufRead, Read};

/// Walks through the statements of a file: its lines, where a backslash at the end joins the next.
///
/// Lines end with a line feed, with or without a carriage return before it.
pub(super) struct Statements<'a> {
    rest: &'a [u8],
    next_line: usize,
}

impl<'a> Statements<'a> {
    /// All statements of a file, from its first line on.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Statements { rest: bytes, next_line: 1 }
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
                return Some((first_line, Words { rest: bytes }));
            };
            let end = start + length;
            self.next_line += 1;
            if !continues(&bytes[start..end]) {
                self.rest = &bytes[end + 1..];
                return Some((first_line, Words { rest: &bytes[..end] }));
            }
            start = end + 1;
        }
    }
}

/// Takes the statements of a file out of a reader, one at a time, through a buffer of one statement.
pub(super) struct BufferedStatements<R> {
    input: R,
    statement: Vec<u8>,
    next_line: usize,
}

impl<R: BufRead> BufferedStatements<R> {
    /// All statements from here on.
    pub(super) fn new(input: R) -> Self {
        BufferedStatements { input, statement: Vec::new(), next_line: 1 }
    }

    /// As [`Statements::next`]; of a statement of more than `most` bytes, no more than one byte
    /// too many.
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
        Ok(Some((first_line, Words { rest: &self.statement })))
    }
}

/// Whether the line after this one belongs to the same statement.
fn continues(line: &[u8]) -> bool {
    // A comment ends with its line, even if it ends with a folder's name.
    let comment = || Words { rest: line }.any_comment();
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\") && !comment()
}

/// The words of a statement: what stands between blanks and joined line ends, up to a comment.
#[derive(Clone)]
pub(super) struct Words<'a> {
    rest: &'a [u8],
}

impl<'a> Words<'a> {
    /// What is left of the statement, as it stands, if it is not blank: a name, which may have blanks
    /// and `#` in it.
    pub(super) fn text(&self) -> Option<String> {
        let text = self.rest.trim_ascii();
        (!text.is_empty()).then(|| String::from_utf8_lossy(text).into_owned())
    }

    /// Bytes that are left of the statement.
    pub(super) fn length(&self) -> usize {
        self.rest.len()
    }

    fn any_comment(mut self) -> bool {
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
            // A line end inside a statement is a joined one, and the backslash there no letter.
            let after = self.rest.strip_prefix(b"\r").unwrap_or(self.rest);
            let joined = after.starts_with(b"\n");
            let word = if joined { word.strip_suffix(b"\\").unwrap_or(word) } else { word };
            if !word.is_empty() {
                return Some(word);
            }
        }
    }
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
