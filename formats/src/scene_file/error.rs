//! Errors about scene files: those in the text know their place.

use super::excerpt::Excerpt;
use crate::mesh_file::EXTENSIONS;
use crate::source::Unreadable;
use crate::source::quote::visible;
use std::borrow::Cow;
use std::fmt;
use std::io;
use std::ops::Range;

/// Why a scene file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadSceneError {
    /// The file does not exist, is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "a scene file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// The file is larger than any scene needs, and would take too much memory.
    #[error(
        "{file}: a scene file of more than 8 MiB is not read; put its triangles into a mesh file \
         ({EXTENSIONS}) and name it in the scene"
    )]
    TooLarge {
        /// The file.
        file: String,
    },
    /// The file is not UTF-8 text.
    #[error("{file} is not UTF-8 text: byte {byte} on line {line} begins no character")]
    NotText {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: usize,
        /// The first wrong byte, counted from 0.
        byte: usize,
    },
    /// Something in the text is wrong.
    #[error(transparent)]
    Located(#[from] LocatedError),
}

/// What is wrong with the text of a scene file, and where.
///
/// It is displayed as one line, `scene.toml:3:7: message; help`. Its fields serve tools that underline the place in the
/// text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocatedError {
    /// The name of the text in messages.
    pub file: String,
    /// The whole text.
    pub text: String,
    /// The bytes of the text to underline.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

impl LocatedError {
    /// The line and the column at which the place begins, both counted from 1. Columns count characters.
    pub fn line_and_column(&self) -> (usize, usize) {
        let before = &self.text.as_bytes()[..self.span.start.min(self.text.len())];
        let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        let in_line = String::from_utf8_lossy(&before[line_start..]);
        // A byte order mark is not visible.
        let column = in_line.trim_start_matches('\u{feff}').chars().count() + 1;
        (line, column)
    }

    /// The lines around the place, safe to show on a terminal.
    pub fn excerpt(&self) -> Excerpt {
        Excerpt::around(&self.text, self.span.clone())
    }
}

impl fmt::Display for LocatedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (line, column) = self.line_and_column();
        write!(f, "{}:{line}:{column}: {}", visible(&self.file), self.message)?;
        self.help.iter().try_for_each(|help| write!(f, "; {help}"))
    }
}

impl std::error::Error for LocatedError {}

/// A [`LocatedError`] without the text and its name.
#[derive(Debug)]
pub(super) struct Problem {
    span: Range<usize>,
    message: String,
    help: Option<String>,
}

impl Problem {
    /// A problem at a place in the text.
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Problem {
        Problem { span, message: message.into(), help: None }
    }

    /// Adds what to do about it.
    pub(super) fn help(self, help: impl Into<String>) -> Problem {
        Problem { help: Some(help.into()), ..self }
    }

    /// The error in a text that messages call `file`.
    pub(super) fn in_text(self, file: &str, text: &str) -> LocatedError {
        let Problem { span, message, help } = self;
        let span = on_last_line(text, span);
        // The message may quote this file, or a mesh file that it names.
        let (message, help) = (visible(&message).into_owned(), help.as_deref().map(visible));
        let help = help.map(Cow::into_owned);
        LocatedError { file: file.to_owned(), text: text.to_owned(), span, message, help }
    }
}

/// Moves an empty place on a blank line at the end of a text to the end of the last line that is not blank.
fn on_last_line(text: &str, span: Range<usize>) -> Range<usize> {
    let Some((before, after)) = text.split_at_checked(span.start).filter(|_| span.is_empty())
    else {
        return span;
    };
    let end = before.trim_end().len();
    let is_line_blank = before[end..].contains('\n') && after.trim().is_empty();
    if end > 0 && is_line_blank { end..end } else { span }
}

impl From<toml::de::Error> for Problem {
    /// The message of the TOML parser, which may quote the file.
    fn from(error: toml::de::Error) -> Problem {
        let span = error.span().unwrap_or(0..0);
        let is_something = !span.is_empty();
        let problem = Problem::new(span, error.message());
        // The parser takes two numbers without a comma for a text.
        if is_something && error.message().starts_with("string values must be quoted") {
            return problem.help("put a text in quotes, and a comma between two values");
        }
        problem
    }
}
