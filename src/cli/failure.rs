//! What the user is told when something went wrong.

use bothways::common::scene_file::{LocatedError, SceneFileError};
use bothways::scenes::LoadError;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode};
use std::fmt;
use std::io::Write;

/// One message that names the place and says what to do; the exit code is 2.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A message that says it all.
    Plain(String),
    /// A place in a scene file.
    InSceneFile(Box<Located>),
}

/// A place in a scene file, as `miette` wants it.
#[derive(Debug)]
pub(crate) struct Located {
    error: LocatedError,
    source: miette::NamedSource<String>,
}

impl Failure {
    pub(super) fn new(message: impl Into<String>) -> Failure {
        Failure::Plain(message.into())
    }

    /// Prints it to stderr: in colour on a terminal, unless `NO_COLOR` says otherwise.
    pub(super) fn print(&self) {
        let red = anstyle::AnsiColor::Red.on_default().bold();
        let text = match self {
            Failure::Plain(message) => format!("{red}error{red:#}: {message}\n"),
            Failure::InSceneFile(located) => located.drawn(),
        };
        // If nobody can be told, the exit code still says it.
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
            LoadError::SceneFile(SceneFileError::Located(error)) => {
                Failure::InSceneFile(Box::new(Located::new(error)))
            }
            error => Failure::new(error.to_string()),
        }
    }
}

impl Located {
    fn new(error: LocatedError) -> Located {
        let source = miette::NamedSource::new(&error.name, error.text.clone());
        Located { error, source }
    }

    /// The lines around the place, underlined.
    fn drawn(&self) -> String {
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode())
            .with_links(false)
            .with_width(100);
        let mut drawn = String::new();
        match handler.render_report(&mut drawn, self) {
            Ok(()) => drawn,
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
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        // An error at the end of a file still has a place in it.
        let end = self.error.text.len();
        let span = self.error.span.start.min(end)..self.error.span.end.min(end);
        Some(Box::new(std::iter::once(LabeledSpan::underline(span))))
    }
}
