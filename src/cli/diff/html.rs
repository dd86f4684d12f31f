//! `bothways diff A B --html FILE`: the comparison as one page for a browser.

use super::args::DiffArgs;
use crate::cli::beside::{Beside, PAGE};
use crate::cli::failure::Failure;
use bothways::diff::foreign::{Buffer, BufferComparison};
use bothways::diff::page::Page;

/// Finds where the page goes, before anything is read.
pub(super) fn find(args: &DiffArgs) -> Result<Beside, Failure> {
    if args.html.is_some() && args.a.is_dir() && args.b.is_dir() {
        return Err(Failure::new(
            "--html shows one pair of files, and A and B are folders; name two files",
        ));
    }
    let page = Beside::find(PAGE, args.html.as_deref())?;
    if page.is_stdout() && args.json {
        return Err(Failure::new(
            "--json and the page would both go to standard output; name a file with --html",
        ));
    }
    Ok(page)
}

/// Writes the page of a comparison, as far as `change` does not replace its parts.
pub(super) fn write(
    page: &Beside,
    args: &DiffArgs,
    buffers: [&Buffer; 2],
    comparison: &BufferComparison,
    change: impl FnOnce(&mut Page),
) -> Result<(), Failure> {
    let Some(file) = page.file() else { return Ok(()) };
    let [a, b] = [&args.a, &args.b].map(|path| path.display().to_string());
    let mut content = Page::new([&a, &b], buffers, comparison)
        .map_err(|error| Failure::new(format!("cannot write {}: {error}", file.said())))?;
    change(&mut content);
    page.write(|out| content.write(out))
}
