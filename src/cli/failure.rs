//! The messages about errors.

use bothways::formats::scene_file::{Excerpt, LocatedError, ReadSceneError};
use bothways::formats::source::quote::visible;
use bothways::scenes::LoadError;
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError,
    MietteSpanContents, SourceCode, SourceSpan, SpanContents,
};
use std::fmt;
use std::io::Write;

/// One message that names the place and the remedy; the exit code is 2.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A complete message.
    Plain(String),
    /// A place in a scene file.
    InSceneFile(Box<Located>),
}

/// A place in a scene file, in the form for `miette`.
#[derive(Debug)]
pub(crate) struct Located {
    error: LocatedError,
    lines: Lines,
}

/// The lines around the place, with their position in the file.
///
/// This type never holds the whole file: `miette` panics if a place is beyond column 65,535, and prints the text of
/// the file without changes.
#[derive(Debug)]
struct Lines {
    excerpt: Excerpt,
    /// `scene.toml:3:7`
    place: String,
}

impl Failure {
    pub(super) fn new(message: impl Into<String>) -> Failure {
        Failure::Plain(message.into())
    }

    /// Prints the failure to stderr: in colour on a terminal, unless `NO_COLOR` is set.
    pub(super) fn print(&self) {
        let red = anstyle::AnsiColor::Red.on_default().bold();
        let text = match self {
            // A terminal must not execute control sequences in quoted text.
            Failure::Plain(message) => format!("{red}error{red:#}: {}\n", visible(message)),
            Failure::InSceneFile(located) => located.drawn(),
        };
        // If stderr is closed, the exit code still reports the failure.
        let _ = anstream::stderr().write_all(text.as_bytes());
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Plain(message) => f.write_str(message),
            Failure::InSceneFile(located) => located.fmt(f),
        }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::SceneFile(ReadSceneError::Located(error)) => {
                Failure::InSceneFile(Box::new(Located::new(error)))
            }
            error => Failure::new(error.to_string()),
        }
    }
}

impl Located {
    fn new(error: LocatedError) -> Located {
        let (line, column) = error.line_and_column();
        let place = format!("{}:{line}:{column}", visible(&error.file));
        let lines = Lines { excerpt: error.excerpt(), place };
        Located { error, lines }
    }

    /// The lines around the place, underlined.
    fn drawn(&self) -> String {
        let mut theme = GraphicalTheme::unicode();
        theme.characters.error = "error:".into();
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_links(false)
            .without_primary_span_start()
            .with_width(100);
        let mut drawn = String::new();
        match handler.render_report(&mut drawn, self) {
            // As all errors, it begins with this word.
            Ok(()) => drawn.trim_start_matches(' ').to_owned(),
            Err(fmt::Error) => format!("error: {}\n", self.error),
        }
    }
}

impl fmt::Display for Located {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.error.message)
    }
}

impl std::error::Error for Located {}

impl Diagnostic for Located {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.error.help.as_ref().map(|help| Box::new(help) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.lines)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.lines.excerpt.span.clone();
        Some(Box::new(std::iter::once(LabeledSpan::underline(span))))
    }
}

impl SourceCode for Lines {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.excerpt.text.read_span(span, before, after)?;
        let line = found.line() + self.excerpt.first_line - 1;
        Ok(Box::new(MietteSpanContents::new_named(
            self.place.clone(),
            found.data(),
            *found.span(),
            line,
            found.column(),
            found.line_count(),
        )))
    }
}
