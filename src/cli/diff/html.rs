//! `bothways diff A B --html FILE`: the comparison as one page for a browser.

use super::DiffArgs;
use crate::cli::failure::Failure;
use crate::cli::output::OutputFile;
use crate::cli::terminal;
use anstyle::Style;
use bothways::diff::foreign::{Buffer, BufferComparison};
use bothways::diff::page::Page;

/// The page of a run, if one is asked for.
pub(super) struct Html {
    file: Option<OutputFile>,
}

impl Html {
    /// Finds where the page goes, before anything is read.
    pub(super) fn find(args: &DiffArgs) -> Result<Html, Failure> {
        let Some(name) = &args.html else { return Ok(Html { file: None }) };
        if args.a.is_dir() && args.b.is_dir() {
            return Err(Failure::new(
                "--html shows one pair of files, and A and B are folders; name two files",
            ));
        }
        let file = OutputFile::find_for("--html", name)?;
        if file.is_stdout() && args.json {
            return Err(Failure::new(
                "--json and the page would both go to standard output; name a file with --html",
            ));
        }
        match file.ending().as_deref() {
            None | Some("html" | "htm") => Ok(Html { file: Some(file) }),
            Some(ending) => Err(Failure::new(format!(
                "cannot write {}: a page is an .html file, and .{ending} is none; end the name in .html",
                file.said()
            ))),
        }
    }

    /// Writes the page of a comparison, as far as `change` does not replace its parts.
    pub(super) fn write(
        &self,
        args: &DiffArgs,
        buffers: [&Buffer; 2],
        comparison: &BufferComparison,
        change: impl FnOnce(&mut Page),
    ) -> Result<(), Failure> {
        let Some(file) = &self.file else { return Ok(()) };
        let [a, b] = [&args.a, &args.b].map(|path| path.display().to_string());
        let mut page = Page::new([&a, &b], buffers, comparison)
            .map_err(|error| Failure::new(format!("cannot write {}: {error}", file.said())))?;
        change(&mut page);
        file.write(|out| page.write(out))
    }

    /// Where the page was written, as the last line of the report.
    pub(super) fn written(&self) -> String {
        let Some(file) = self.file.as_ref().filter(|file| !file.is_stdout()) else {
            return String::new();
        };
        let dimmed = Style::new().dimmed();
        format!("{dimmed}page written to {}{dimmed:#}\n", file.said())
    }

    /// Prints the report; if the page is the result on stdout, to stderr.
    pub(super) fn print(&self, text: &str) -> Result<(), Failure> {
        if self.file.as_ref().is_some_and(OutputFile::is_stdout) {
            anstream::eprint!("{text}");
            return Ok(());
        }
        terminal::print(text)
    }
}
