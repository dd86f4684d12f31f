//! Cuts files into pieces of whole statements, and counts what is in them.

use super::error::IndexKind;
use super::statements::{Statements, continues};
use super::words::Words;
use memchr::{memchr, memrchr};

/// What a piece of a file contains, or what all pieces before it contain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    /// Line ends.
    pub(super) lines: usize,
    /// Definitions, for each [`IndexKind`].
    pub(super) defined: [usize; 3],
}

impl Counts {
    /// Counts in bytes that begin with a statement.
    pub(super) fn of(piece: &[u8]) -> Counts {
        let mut counts = Counts::default();
        let mut rest = piece;
        while !rest.is_empty() {
            // The end of a line that no other continues is the end of its statement.
            let line = memchr(b'\n', rest).unwrap_or(rest.len());
            let end = if ends_in_backslash(&rest[..line]) { statement_end(rest) } else { line };
            if let Some(kind) = defined_kind(&rest[..end]) {
                counts.defined[kind as usize] += 1;
            }
            let statement = &rest[..(end + 1).min(rest.len())];
            counts.lines += if end == line {
                usize::from(line < rest.len())
            } else {
                statement.iter().filter(|&&byte| byte == b'\n').count()
            };
            rest = &rest[statement.len()..];
        }
        counts
    }

    /// These and those that follow.
    pub(super) fn and(self, other: Counts) -> Counts {
        let add = |k: usize| self.defined[k] + other.defined[k];
        Counts { lines: self.lines + other.lines, defined: [add(0), add(1), add(2)] }
    }
}

/// What a statement defines, if it defines anything.
fn defined_kind(statement: &[u8]) -> Option<IndexKind> {
    match *statement {
        [b'v', b' ', ..] => Some(IndexKind::Vertex),
        [b'v', b'n', b' ', ..] => Some(IndexKind::Normal),
        [b'v', b't', b' ', ..] => Some(IndexKind::TextureCoordinate),
        // Any other word.
        [b'a'..=b'u' | b'w'..=b'z' | b'A'..=b'Z' | b'#', ..] | [] => None,
        _ => match Words::new(statement).next()? {
            b"v" => Some(IndexKind::Vertex),
            b"vt" => Some(IndexKind::TextureCoordinate),
            b"vn" => Some(IndexKind::Normal),
            _ => None,
        },
    }
}

fn ends_in_backslash(line: &[u8]) -> bool {
    line.strip_suffix(b"\r").unwrap_or(line).ends_with(b"\\")
}

/// The number of bytes before the end of the first statement.
fn statement_end(bytes: &[u8]) -> usize {
    let mut statements = Statements::from_line(bytes, 1);
    statements.next();
    let (rest, _) = statements.rest();
    // Whether the last statement ends with a line end or with the file makes no difference to its words.
    let whole = bytes.len() - rest.len();
    whole - usize::from(bytes[..whole].ends_with(b"\n"))
}

/// The number of bytes up to the last end of a statement, with it; 0 if no statement ends in these bytes, which begin
/// with one.
pub(super) fn whole_statements(bytes: &[u8]) -> usize {
    let mut end = bytes.len();
    while let Some(line_end) = memrchr(b'\n', &bytes[..end]) {
        let start = memrchr(b'\n', &bytes[..line_end]).map_or(0, |before| before + 1);
        if !continues(&bytes[start..line_end]) {
            return line_end + 1;
        }
        end = line_end;
    }
    0
}

/// Cuts bytes that begin with a statement into pieces of whole statements, each of about `size` bytes.
pub(super) fn cut(bytes: &[u8], size: usize) -> Vec<&[u8]> {
    let mut pieces = Vec::with_capacity(bytes.len() / size + 1);
    let mut rest = bytes;
    while rest.len() > size {
        let length = match whole_statements(&rest[..size]) {
            // The statement is longer than that.
            0 => (statement_end(rest) + 1).min(rest.len()),
            length => length,
        };
        let (piece, after) = rest.split_at(length);
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
    pieces
}
