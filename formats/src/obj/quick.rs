//! Parses the statements that fill most files in one pass over their bytes: `v`, `vn`, `vt` and `f` with few corners, each
//! on a line of its own, without comment.

use super::error::{IndexKind, StatementFault};
use super::parser::{INDEX_KINDS, Parser};
use super::visitor::Visitor;
use crate::attributes::NONE;
use crate::source::decimal;

/// The most numbers of a definition, and the most corners of a face.
const MOST_NUMBERS: usize = 8;
const MOST_CORNERS: usize = 4;

/// Indices of a corner as the file writes them; 0 is none.
type WrittenCorner = [i64; 3];

impl<V: Visitor> Parser<V> {
    /// Parses the line at the beginning of `bytes`, and tells how many bytes it has, with its end.
    ///
    /// `None` leaves everything to [`Parser::statement`], which does the same with each line that is parsed here: the line
    /// is of another kind, or wrong, or unusual, or has no end.
    pub(super) fn quick_line(
        &mut self,
        line: usize,
        bytes: &[u8],
    ) -> Result<Option<usize>, StatementFault> {
        let [first, second, third, ..] = *bytes else { return Ok(None) };
        Ok(match (first, second, third) {
            (b'f', b' ', _) => return self.quick_face(line, bytes),
            (b'v', b' ', _) => quick_numbers(&bytes[1..], 3).map(|(numbers, found, length)| {
                self.vertex(numbers, found);
                1 + length
            }),
            (b'v', b'n', b' ') => {
                quick_numbers(&bytes[2..], 3).map(|([x, y, z, ..], _, length)| {
                    self.visitor.normal([x, y, z].into());
                    self.defined[IndexKind::Normal as usize] += 1;
                    2 + length
                })
            }
            (b'v', b't', b' ') => quick_numbers(&bytes[2..], 1).map(|([u, v, ..], _, length)| {
                self.visitor.texture_coordinate([u, v].into());
                self.defined[IndexKind::TextureCoordinate as usize] += 1;
                2 + length
            }),
            _ => None,
        })
    }

    fn quick_face(&mut self, line: usize, bytes: &[u8]) -> Result<Option<usize>, StatementFault> {
        let mut written = [[0; 3]; MOST_CORNERS];
        let (mut corners, mut at) = (0, 1);
        loop {
            at = after_blanks(bytes, at);
            if bytes.get(at) == Some(&b'\n') {
                break;
            }
            match written.get_mut(corners).and_then(|corner| quick_corner(bytes, at, corner)) {
                Some(end) => at = end,
                None => return Ok(None),
            }
            corners += 1;
        }
        if corners < 3 || at > MOST_BYTES {
            return Ok(None);
        }
        let mut known = [[NONE; 3]; MOST_CORNERS];
        for (known, written) in known.iter_mut().zip(&written[..corners]) {
            for ((known, &index), kind) in known.iter_mut().zip(written).zip(INDEX_KINDS) {
                if index != 0 {
                    *known = self.resolve(line, kind, index)?;
                }
            }
        }
        self.visitor.polygon(&known[..corners]);
        Ok(Some(at + 1))
    }
}

/// A line as long as this is left to the parser of statements, which has a limit.
const MOST_BYTES: usize = 4096;

/// Reads the numbers up to the end of the line, at least `needed`. Tells the first six, with 0 for those that are missing, how
/// many there are, and how many bytes they have, with the end of the line.
fn quick_numbers(bytes: &[u8], needed: usize) -> Option<([f32; 6], usize, usize)> {
    let mut numbers = [0.0; MOST_NUMBERS];
    let (mut found, mut at) = (0, 0);
    loop {
        at = after_blanks(bytes, at);
        if bytes.get(at) == Some(&b'\n') {
            break;
        }
        let slot = numbers.get_mut(found)?;
        let (number, length) = decimal::leading(&bytes[at..])?;
        *slot = number;
        at += length;
        found += 1;
        if !is_blank(*bytes.get(at)?) && bytes[at] != b'\n' {
            return None;
        }
    }
    let [x, y, z, red, green, blue, ..] = numbers;
    let first = [x, y, z, red, green, blue];
    (found >= needed && at <= MOST_BYTES).then_some((first, found, at + 1))
}

/// Reads one corner, `v`, `v/vt`, `v//vn` or `v/vt/vn`, and tells where it ends: before a blank or the end of the line.
fn quick_corner(bytes: &[u8], mut at: usize, corner: &mut WrittenCorner) -> Option<usize> {
    for (position, index) in corner.iter_mut().enumerate() {
        let is_left_out = position == 1 && bytes.get(at) == Some(&b'/');
        if !is_left_out {
            (*index, at) = quick_index(bytes, at)?;
        }
        match *bytes.get(at)? {
            b'/' if position < 2 => at += 1,
            byte if is_blank(byte) || byte == b'\n' => return Some(at),
            _ => return None,
        }
    }
    None
}

/// Reads an index that is not 0, and tells where it ends.
fn quick_index(bytes: &[u8], mut at: usize) -> Option<(i64, usize)> {
    /// Far fewer than would overflow.
    const MOST_DIGITS: usize = 10;
    let is_negative = bytes.get(at) == Some(&b'-');
    at += usize::from(is_negative);
    let (start, mut index) = (at, 0_i64);
    while let Some(digit @ b'0'..=b'9') = bytes.get(at) {
        index = index.wrapping_mul(10).wrapping_add(i64::from(digit - b'0'));
        at += 1;
    }
    let is_usual = index != 0 && at - start <= MOST_DIGITS;
    is_usual.then_some((if is_negative { -index } else { index }, at))
}

fn after_blanks(bytes: &[u8], mut at: usize) -> usize {
    while bytes.get(at).is_some_and(|&byte| is_blank(byte)) {
        at += 1;
    }
    at
}

/// Tells whether a byte separates words within a line; a carriage return before the line's end is a blank, too.
fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r')
}
