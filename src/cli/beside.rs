//! A file that a run writes beside its report: a page, or a table.

use super::failure::Failure;
use super::output::{Out, OutputFile};
use super::terminal;
use anstyle::Style;
use std::io;
use std::path::Path;

/// The kind of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    /// The option that names the file.
    pub(super) option: &'static str,
    /// What the file is, in a word.
    pub(super) what: &'static str,
    /// What its name ends in, in words.
    pub(super) usual: &'static str,
    /// The endings of its name, the usual one first.
    pub(super) endings: &'static [&'static str],
}

/// A page for a browser.
pub(super) const PAGE: Kind =
    Kind { option: "--html", what: "page", usual: "an .html file", endings: &["html", "htm"] };
/// A table for a spreadsheet.
pub(super) const TABLE: Kind =
    Kind { option: "--csv", what: "table", usual: "a .csv file", endings: &["csv"] };

/// The file of a run, if one is asked for.
pub(super) struct Beside {
    kind: Kind,
    file: Option<OutputFile>,
}

impl Beside {
    /// Finds where the file goes, before anything is read.
    pub(super) fn find(kind: Kind, name: Option<&Path>) -> Result<Beside, Failure> {
        let Some(name) = name else { return Ok(Beside { kind, file: None }) };
        let file = OutputFile::find_for(kind.option, name)?;
        let Kind { what, usual, endings, .. } = kind;
        match file.ending() {
            Some(ending) if !endings.contains(&ending.as_str()) => Err(Failure::new(format!(
                "cannot write {}: a {what} is {usual}, and .{ending} is none; end the name in .{}",
                file.said(),
                endings[0]
            ))),
            _ => Ok(Beside { kind, file: Some(file) }),
        }
    }

    /// Whether the file is standard output. Then the report goes to standard error.
    pub(super) fn is_stdout(&self) -> bool {
        self.file.as_ref().is_some_and(OutputFile::is_stdout)
    }

    /// The file, if one is asked for.
    pub(super) fn file(&self) -> Option<&OutputFile> {
        self.file.as_ref()
    }

    /// Writes the file, if one is asked for.
    pub(super) fn write(
        &self,
        content: impl FnOnce(&mut Out) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.file.as_ref().map_or(Ok(()), |file| file.write(content))
    }

    /// Where the file was written, as the last line of the report.
    pub(super) fn written(&self) -> String {
        let Some(file) = self.file.as_ref().filter(|file| !file.is_stdout()) else {
            return String::new();
        };
        let dimmed = Style::new().dimmed();
        format!("{dimmed}{} written to {}{dimmed:#}\n", self.kind.what, file.said())
    }

    /// Prints the report; if the file is the result on standard output, to standard error.
    pub(super) fn print(&self, text: &str) -> Result<(), Failure> {
        if self.is_stdout() {
            anstream::eprint!("{text}");
            return Ok(());
        }
        terminal::print(text)
    }
}
