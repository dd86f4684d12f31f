//! Where a film goes, and in which form: the name of the file tells.

use super::video::Video;
use crate::cli::failure::Failure;
use crate::cli::output::{OutputFile, Staging};
use bothways::figure::Theme;
use bothways::film::{FASTEST_IN_BROWSERS, Film, Length};
use image::RgbImage;
use std::cell::Cell;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Where a film goes.
pub(super) enum Target {
    Gif(OutputFile),
    Apng(OutputFile),
    Video(OutputFile, Video),
    Folder(PathBuf),
}

impl Target {
    /// Finds where the film goes, before anything is rendered.
    pub(super) fn find(path: &Path, length: Length) -> Result<Target, Failure> {
        if is_folder(path) {
            // The names are checked here, and once more with the frames.
            drop(Staging::begin_with(path, names(path, length))?);
            return Ok(Target::Folder(path.to_owned()));
        }
        let file = OutputFile::find(path)?;
        let target = Target::of_file(file)?;
        let in_browsers = matches!(target, Target::Gif(_) | Target::Apng(_));
        if in_browsers && length.rate() > FASTEST_IN_BROWSERS {
            return Err(Failure::new(format!(
                "--fps {}: browsers show such short frames of a {} ten times as long; choose {FASTEST_IN_BROWSERS}, or \
                 write an .mp4 or a folder of frames",
                length.rate(),
                if matches!(target, Target::Gif(_)) { "GIF" } else { "PNG" }
            )));
        }
        Ok(target)
    }

    /// The form that the name of a file tells.
    fn of_file(file: OutputFile) -> Result<Target, Failure> {
        match file.ending().as_deref() {
            Some("gif") => Ok(Target::Gif(file)),
            Some("png" | "apng") => Ok(Target::Apng(file)),
            Some("mp4") => Ok(Target::Video(file, Video::find()?)),
            None if file.is_stdout() => Ok(Target::Gif(file)),
            ending => Err(Failure::new(format!(
                "cannot write {}: a film is a .gif, an animated .png, an .mp4, or a folder of frames, and \
                 {} is none; end the name in one of them, or in / for a folder",
                file.said(),
                ending.map_or("this".into(), |ending| format!(".{ending}"))
            ))),
        }
    }

    /// Whether the film goes to standard output.
    pub(super) fn is_stdout(&self) -> bool {
        self.file().is_some_and(OutputFile::is_stdout)
    }

    fn file(&self) -> Option<&OutputFile> {
        match self {
            Target::Gif(file) | Target::Apng(file) | Target::Video(file, _) => Some(file),
            Target::Folder(_) => None,
        }
    }

    /// The name in messages.
    pub(super) fn said(&self) -> String {
        match self {
            Target::Folder(folder) => folder.display().to_string(),
            Target::Gif(file) | Target::Apng(file) | Target::Video(file, _) => file.said(),
        }
    }

    pub(super) fn format(&self) -> &'static str {
        match self {
            Target::Gif(_) => "gif",
            Target::Apng(_) => "apng",
            Target::Video(..) => "mp4",
            Target::Folder(_) => "frames",
        }
    }

    /// Writes the film, and gives the number of bytes.
    pub(super) fn write(
        &self,
        film: &Film,
        theme: Theme,
        width: u32,
        progress: &dyn Fn(u32),
    ) -> Result<u64, Failure> {
        let written = Cell::new(0);
        let mut show = |number| progress(number);
        match self {
            Target::Gif(file) => file.write(|out| {
                let out = Counted { out, written: &written };
                film.write_gif(out, theme, width, &mut show).map(|_| ())
            })?,
            Target::Apng(file) => file.write(|out| {
                film.write_apng(Counted { out, written: &written }, theme, width, &mut show)
            })?,
            Target::Video(file, video) => {
                let made = video.make(film, theme, width, &mut show)?;
                file.write(|out| {
                    let mut out = Counted { out, written: &written };
                    io::copy(&mut made.open()?, &mut out).map(|_| ())
                })?;
            }
            Target::Folder(folder) => {
                write_folder(folder, film, theme, width, &written, &mut show)?
            }
        }
        Ok(written.get())
    }
}

/// A name that ends in a slash, belongs to a folder that is there, or has no ending and belongs to nothing.
fn is_folder(path: &Path) -> bool {
    let last = path.as_os_str().as_encoded_bytes().last();
    if last.is_some_and(|byte| std::path::is_separator(char::from(*byte))) || path.is_dir() {
        return true;
    }
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    // `.gif` is an ending without a name, and `-` is standard output.
    let has_ending = name.contains(&b'.') || path == Path::new("-");
    !has_ending && !name.is_empty() && path.symlink_metadata().is_err()
}

/// The file of a folder that is written last: the folder is complete if it is there.
const LAST: &str = "frames.txt";

fn name(number: u32) -> String {
    format!("frame-{number:04}.png")
}

/// The files that a film may write into a folder: its frames, and those of an earlier film.
fn names(folder: &Path, length: Length) -> Vec<String> {
    let own = (1..=length.frames() + length.pause()).map(name);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let earlier = entries.filter_map(|entry| entry.file_name().into_string().ok());
    let is_frame = |name: &String| {
        let number = name.strip_prefix("frame-").and_then(|rest| rest.strip_suffix(".png"));
        number.is_some_and(|digits| digits.len() >= 4 && digits.bytes().all(|b| b.is_ascii_digit()))
    };
    let mut names: Vec<String> = own.chain(earlier.filter(is_frame)).collect();
    names.sort();
    names.dedup();
    names.push(LAST.into());
    names
}

/// Writes numbered frames; the last one again and again for the pause, so that the frames are a film as they are.
fn write_folder(
    folder: &Path,
    film: &Film,
    theme: Theme,
    width: u32,
    written: &Cell<u64>,
    show: &mut dyn FnMut(u32),
) -> Result<(), Failure> {
    let length = film.length();
    let mut staging = Staging::begin_with(folder, names(folder, length))?;
    for (number, picture) in (1..).zip(film.frames(theme, width)) {
        let png = encoded(&picture).map_err(|error| Failure::new(error.to_string()))?;
        for copy in 0..length.shown(number) {
            staging.write(&name(number + copy), |out| {
                written.set(written.get() + png.len() as u64);
                out.write_all(&png)
            })?;
        }
        show(number);
    }
    let about =
        format!("{} frames, {} a second\n", length.frames() + length.pause(), length.rate());
    staging.write(LAST, |out| out.write_all(about.as_bytes()))?;
    staging.commit()
}

fn encoded(picture: &RgbImage) -> image::ImageResult<Vec<u8>> {
    let mut png = io::Cursor::new(Vec::new());
    picture.write_to(&mut png, image::ImageFormat::Png)?;
    Ok(png.into_inner())
}

/// A writer that counts.
struct Counted<'a, W> {
    out: W,
    written: &'a Cell<u64>,
}

impl<W: Write> Write for Counted<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.written.set(self.written.get() + count as u64);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
