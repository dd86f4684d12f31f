//! Reads the words of an ASCII STL file.

use super::error::{ReadStlError, StlFault};
use crate::source::quote::quote;
use crate::source::{decimal, without_mark};
use glam::Vec3;
use std::io::{BufRead, Read};

/// The longest line that is read.
const MOST_BYTES_A_LINE: u64 = 1 << 16;

/// Tells whether a file that begins with these bytes is of this form.
pub(super) fn begins(bytes: &[u8]) -> bool {
    let bytes = without_mark(bytes).trim_ascii_start();
    let after = bytes.get(..5).filter(|word| word.eq_ignore_ascii_case(b"solid"));
    after.is_some() && bytes.get(5).is_none_or(u8::is_ascii_whitespace)
}

/// Visits the corners of all facets.
pub(super) fn read(
    file: &str,
    input: impl BufRead,
    facet: &mut impl FnMut([Vec3; 3]) -> Result<(), StlFault>,
) -> Result<(), ReadStlError> {
    let mut lines = Lines { input, line: 0, text: Vec::new() };
    let unreadable = |error| ReadStlError::Unreadable { file: file.to_owned(), error };
    let mut state = State::Outside;
    let mut corners = [Vec3::ZERO; 3];
    while lines.next().map_err(unreadable)? {
        let located = |fault| ReadStlError::Line { file: file.to_owned(), line: lines.line, fault };
        if lines.text.len() as u64 >= MOST_BYTES_A_LINE {
            return Err(located(StlFault::LineTooLong { most: MOST_BYTES_A_LINE }));
        }
        let text = without_mark(&lines.text);
        let mut words = text.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(word) = words.next() else { continue };
        let keyword = word.to_ascii_lowercase();
        let is_control = |byte: &u8| byte.is_ascii_control() && !byte.is_ascii_whitespace();
        let in_words = |fault| if text.iter().any(is_control) { StlFault::NotText } else { fault };
        let after = state.after(&keyword, word, &mut words, &mut corners);
        state = after.map_err(in_words).map_err(located)?;
        if state == State::Complete {
            facet(corners).map_err(located)?;
            state = State::LoopEnd;
        }
    }
    let line = lines.line;
    let located = |fault| ReadStlError::Line { file: file.to_owned(), line, fault };
    match state {
        State::Outside => Ok(()),
        open => Err(located(StlFault::Ended { expected: open.expected() })),
    }
}

/// What the next line must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// `solid`, or the end of the file.
    Outside,
    /// `facet normal` or `endsolid`.
    Solid,
    /// `outer loop`.
    Facet,
    /// The vertex of this number.
    Vertex(usize),
    /// All three vertices are there.
    Complete,
    /// `endloop`.
    LoopEnd,
    /// `endfacet`.
    FacetEnd,
}

impl State {
    fn expected(self) -> &'static str {
        match self {
            State::Outside => "solid",
            State::Solid => "facet normal\" or \"endsolid",
            State::Facet => "outer loop",
            State::Vertex(_) | State::Complete => "vertex x y z",
            State::LoopEnd => "endloop",
            State::FacetEnd => "endfacet",
        }
    }

    /// The state behind a line that begins with this keyword; the other words may follow it.
    fn after<'w>(
        self,
        keyword: &[u8],
        written: &[u8],
        words: &mut impl Iterator<Item = &'w [u8]>,
        corners: &mut [Vec3; 3],
    ) -> Result<State, StlFault> {
        let unexpected =
            |text: &[u8]| StlFault::Unexpected { text: quote(text), expected: self.expected() };
        let mut next_is = |expected: &[u8]| match words.next() {
            Some(word) if word.eq_ignore_ascii_case(expected) => Ok(()),
            other => Err(unexpected(other.unwrap_or(written))),
        };
        let state = match (self, keyword) {
            // The rest of the line is a name, or a normal.
            (State::Outside, b"solid") => return Ok(State::Solid),
            (State::Solid, b"endsolid") => return Ok(State::Outside),
            (State::Solid, b"facet") => {
                next_is(b"normal")?;
                return Ok(State::Facet);
            }
            (State::Facet, b"outer") => {
                next_is(b"loop")?;
                State::Vertex(0)
            }
            (State::Vertex(k), b"vertex") => {
                corners[k] = vertex(words)?;
                if k < 2 { State::Vertex(k + 1) } else { State::Complete }
            }
            (State::LoopEnd, b"endloop") => State::FacetEnd,
            (State::FacetEnd, b"endfacet") => State::Solid,
            (State::LoopEnd, b"vertex") => return Err(StlFault::FourthVertex),
            _ => return Err(unexpected(written)),
        };
        match words.next() {
            None => Ok(state),
            Some(word) => Err(StlFault::Excess { text: quote(word) }),
        }
    }
}

/// Reads three numbers.
fn vertex<'w>(words: &mut impl Iterator<Item = &'w [u8]>) -> Result<Vec3, StlFault> {
    let mut numbers = [0.0; 3];
    for (found, number) in numbers.iter_mut().enumerate() {
        let word = words.next().ok_or(StlFault::MissingCoordinates { found })?;
        *number = match decimal::nearest(word) {
            Some(value) if value.is_finite() => value,
            Some(_) if word.iter().any(u8::is_ascii_digit) => {
                return Err(StlFault::OutOfRange { text: quote(word) });
            }
            Some(_) => return Err(StlFault::NotFinite { text: quote(word) }),
            None => return Err(StlFault::NotANumber { text: quote(word) }),
        };
    }
    Ok(numbers.into())
}

/// Reads lines of limited length.
struct Lines<R> {
    input: R,
    /// The number of the line in `text`, counted from 1.
    line: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// Reads the next line, and tells whether there was one.
    fn next(&mut self) -> std::io::Result<bool> {
        self.text.clear();
        let mut limited = self.input.by_ref().take(MOST_BYTES_A_LINE);
        let read = limited.read_until(b'\n', &mut self.text)?;
        self.line += u64::from(read > 0);
        Ok(read > 0)
    }
}
