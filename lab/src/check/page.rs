//! The result of a check as one page of HTML: the causes, and every file that is wrong beside the truth.
//!
//! The page is one file without a script. It loads nothing from anywhere.

use super::found::{Certainty, Check, CheckedFile};
use crate::diff::Class;
use crate::diff::page::{escaped, shown, write_data_uri};
use crate::formats::source::quote::visible;
use crate::wording::{count, grouped};
use image::RgbImage;
use std::io::{self, Write};

/// Pictures are shown about this large, in whole steps.
const SHOWN: u32 = 176;

impl Check {
    /// Writes the page: HTML in UTF-8. `title` names the folder and the set.
    ///
    /// # Errors
    ///
    /// If writing fails.
    pub fn write_page(&self, title: [&str; 2], out: &mut impl Write) -> io::Result<()> {
        let [theirs, set] = title.map(|name| visible(name));
        let (theirs, set) = (escaped(&theirs), escaped(&set));
        let verdict = self.verdict();
        let (verdict, good) = (escaped(&verdict), if self.passes() { "good" } else { "bad" });
        write!(
            out,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src \
             'unsafe-inline'\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"bothways {}\">\n\
             <link rel=\"icon\" href=\"data:,\">\n<title>{theirs}: {verdict}</title>\n<style>\n{}</style>\n</head>\n<body>\n\
             <header>\n<h1 class=\"{good}\">{verdict}</h1>\n<p><b>{theirs}</b>, held to {set}</p>\n</header>\n<main>\n",
            env!("CARGO_PKG_VERSION"),
            include_str!("page.css")
        )?;
        self.write_causes(out)?;
        self.write_missing(out)?;
        self.write_files(out)?;
        out.write_all(b"</main>\n</body>\n</html>\n")
    }

    fn write_causes(&self, out: &mut impl Write) -> io::Result<()> {
        if self.causes.is_empty() {
            return Ok(());
        }
        let wrong: usize = self.causes.iter().map(|cause| cause.files.len()).sum();
        write!(out, "<section>\n<h2>Causes</h2>\n<ol class=\"causes\">\n")?;
        for cause in &self.causes {
            let files = grouped(cause.files.len() as u64);
            let guess = match cause.certainty {
                Certainty::Guess => "<b>A guess</b>, which explains less than half: ",
                Certainty::Convention | Certainty::Reason | Certainty::Unknown => "",
            };
            let sentences = |parts: &Vec<String>| escaped(&parts.join(", and ")).into_owned();
            let all: Vec<String> = cause.alternatives.iter().map(sentences).collect();
            let all = all.join("<br><i>or</i> ");
            writeln!(
                out,
                "<li><b class=\"number\">{files} of {wrong}</b><span>{guess}{all}</span></li>"
            )?;
        }
        out.write_all(b"</ol>\n</section>\n")
    }

    fn write_missing(&self, out: &mut impl Write) -> io::Result<()> {
        write_names("Missing", "scenes", self.missing.iter().map(String::as_str), out)
    }

    fn write_files(&self, out: &mut impl Write) -> io::Result<()> {
        let wrong: Vec<(usize, &CheckedFile)> =
            self.files.iter().enumerate().filter(|(_, file)| !file.is_right()).collect();
        if !wrong.is_empty() {
            writeln!(out, "<section>\n<h2>Wrong</h2>")?;
            write_legend(out)?;
            writeln!(out, "<div class=\"files\">")?;
            for (at, file) in wrong {
                self.write_file(at, file, out)?;
            }
            out.write_all(b"</div>\n</section>\n")?;
        }
        let right = self.files.iter().filter(|file| file.is_right());
        write_names("Right", "files", right.map(|file| file.file.as_str()), out)
    }

    fn write_file(&self, at: usize, file: &CheckedFile, out: &mut impl Write) -> io::Result<()> {
        let (name, point) = (visible(&file.file), visible(&file.point));
        let (name, point) = (escaped(&name), escaped(&point));
        writeln!(out, "<article>\n<h3>{name}</h3>\n<p class=\"point\">{point}</p>")?;
        let cause = self.cause_of(at);
        let cause = cause.map_or(String::new(), |cause| format!("; cause {}", cause + 1));
        let compared = match &file.compared {
            Ok(compared) => compared,
            Err(error) => {
                let reason = visible(&error.reason);
                let reason = escaped(&reason);
                return writeln!(out, "<p class=\"bad\">{reason}{cause}</p>\n</article>");
            }
        };
        let comparison = &compared.comparison;
        let [theirs, truth] = shown([&compared.theirs, &compared.truth]);
        writeln!(out, "<div class=\"pictures\">")?;
        write_picture("theirs", &theirs.picture, out)?;
        write_picture("truth", &truth.picture, out)?;
        write_picture("difference", &comparison.picture(), out)?;
        writeln!(out, "</div>")?;
        writeln!(out, "<p>{}{cause}</p>\n</article>", compared.words())
    }
}

/// A list of names under a title, if there are any.
fn write_names<'a>(
    title: &str,
    things: &str,
    names: impl Iterator<Item = &'a str>,
    out: &mut impl Write,
) -> io::Result<()> {
    let names: Vec<String> = names.map(|name| visible(name).into_owned()).collect();
    if names.is_empty() {
        return Ok(());
    }
    let number = count(names.len() as u64, things);
    let names = names.join(", ");
    writeln!(out, "<section>\n<h2>{title}</h2>\n<p>{number}: {}</p>\n</section>", escaped(&names))
}

/// What the colours of the difference images mean.
fn write_legend(out: &mut impl Write) -> io::Result<()> {
    let meanings = [
        (Class::OnlyObjectOrder, "only theirs"),
        (Class::OnlyImageOrder, "only the truth"),
        (Class::OtherPrimitive, "both, but another id or distance"),
        (Class::Alike, "both alike"),
    ];
    write!(out, "<p class=\"legend\">In the differences:")?;
    for (class, meaning) in meanings {
        let [red, green, blue] = class.color();
        write!(
            out,
            " <span><i style=\"background:rgb({red},{green},{blue})\"></i> {meaning}</span>"
        )?;
    }
    writeln!(out, "</p>")
}

fn write_picture(caption: &str, picture: &RgbImage, out: &mut impl Write) -> io::Result<()> {
    let (width, height) = picture.dimensions();
    let step = (SHOWN / width.max(height).max(1)).max(1);
    let [width, height] = [width, height].map(|side| side * step);
    write!(out, "<figure><img alt=\"{caption}\" width=\"{width}\" height=\"{height}\" src=\"")?;
    write_data_uri(picture, out)?;
    writeln!(out, "\"><figcaption>{caption}</figcaption></figure>")
}
