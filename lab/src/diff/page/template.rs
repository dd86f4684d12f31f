//! The frame of a page, and the rules for putting texts into it.

use super::content::Page;
use super::escape::escaped;
use super::{data, summary};
use crate::formats::source::quote::visible;
use std::io::{self, Write};

/// The page; `{{name}}` stands for a part of it.
const HTML: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// The script: one module in three files.
const SCRIPT: [&str; 3] =
    [include_str!("data.js"), include_str!("views.js"), include_str!("page.js")];

/// Writes the page, part by part: no part is looked through for the names of others.
pub(super) fn write(page: &Page, out: &mut impl Write) -> io::Result<()> {
    let mut rest = HTML;
    while let Some((text, (name, after))) =
        rest.split_once("{{").and_then(|(text, rest)| Some((text, rest.split_once("}}")?)))
    {
        out.write_all(text.as_bytes())?;
        write_part(name, page, out)?;
        rest = after;
    }
    out.write_all(rest.as_bytes())
}

fn write_part(name: &str, page: &Page, out: &mut impl Write) -> io::Result<()> {
    match name {
        "title" => out.write_all(escaped(&title(page)).as_bytes()),
        "version" => out.write_all(env!("CARGO_PKG_VERSION").as_bytes()),
        "style" => out.write_all(STYLE.as_bytes()),
        "script" => SCRIPT.iter().try_for_each(|file| out.write_all(file.as_bytes())),
        "summary" => summary::write(page, out),
        "pictures" => data::write_pictures(page, out),
        "data" => data::write_data(page, out),
        _ => unreachable!("page.html names {name}, which is no part of a page"),
    }
}

fn title(page: &Page) -> String {
    let [a, b] = page.names.each_ref().map(|name| visible(name));
    format!("{a} and {b}: {}", visible(&page.verdict))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn our_script_ends_no_script() {
        for file in SCRIPT {
            assert!(!file.contains("</script") && !file.contains("<!--"));
        }
        assert!(!STYLE.contains("</style"));
    }
}
