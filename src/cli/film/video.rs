//! A film as a video, by the program `ffmpeg`, which gets the frames through a pipe.

use crate::cli::failure::Failure;
use crate::cli::interrupt::{self, Guard};
use bothways::figure::Theme;
use bothways::film::Film;
use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread;
use tempfile::TempDir;

/// The name of the program.
const FFMPEG: &str = "ffmpeg";

/// The program that makes videos.
pub(super) struct Video;

/// A video, complete, in a folder of its own.
pub(super) struct Made {
    folder: TempDir,
    /// Removes the folder if the program is interrupted.
    _guard: Guard,
}

impl Made {
    fn path(&self) -> PathBuf {
        self.folder.path().join("film.mp4")
    }

    pub(super) fn open(&self) -> io::Result<File> {
        File::open(self.path())
    }
}

impl Video {
    /// Finds out whether the program is there.
    pub(super) fn find() -> Result<Video, Failure> {
        let mut command = Command::new(FFMPEG);
        let quiet = command.arg("-version").stdin(Stdio::null()).stdout(Stdio::null());
        match quiet.stderr(Stdio::null()).status() {
            Ok(_) => Ok(Video),
            Err(error) => Err(unavailable(&error)),
        }
    }

    /// Makes the video. It has the standard's subsampled colours, which every player shows.
    pub(super) fn make(
        &self,
        film: &Film,
        theme: Theme,
        width: u32,
        show: &mut dyn FnMut(u32),
    ) -> Result<Made, Failure> {
        let folder = tempfile::tempdir().map_err(|error| failed(&error.to_string()))?;
        let guard = interrupt::hold().guard(folder.path(), &[]);
        let made = Made { folder, _guard: guard };
        let size = format!("{width}x{}", width / 16 * 9);
        let rate = film.length().rate().to_string();
        let mut child = Command::new(FFMPEG)
            .args(["-loglevel", "error", "-nostdin", "-y"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", &size])
            .args(["-framerate", &rate, "-i", "pipe:0"])
            .args(["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"])
            .arg(made.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| unavailable(&error))?;
        let (input, mut errors) =
            (child.stdin.take().expect("it is piped"), child.stderr.take().expect("it is piped"));
        // Its messages are read meanwhile, so that it never waits for us to read them.
        let messages = thread::spawn(move || {
            let mut text = Vec::new();
            // Without its messages, its exit code tells.
            let _ = errors.read_to_end(&mut text);
            String::from_utf8_lossy(&text).into_owned()
        });
        let piped = pipe(film, theme, width, input, show);
        let status = child.wait().map_err(|error| failed(&error.to_string()))?;
        let messages = messages.join().unwrap_or_default();
        if !status.success() {
            let reason = messages.lines().rev().find(|line| !line.trim().is_empty());
            return Err(failed(reason.unwrap_or("it gave no reason")));
        }
        piped.map_err(|error| failed(&error.to_string()))?;
        Ok(made)
    }
}

/// Sends all frames, the last one for the whole pause.
fn pipe(
    film: &Film,
    theme: Theme,
    width: u32,
    mut input: impl Write,
    show: &mut dyn FnMut(u32),
) -> io::Result<()> {
    for (number, picture) in (1..).zip(film.frames(theme, width)) {
        for _ in 0..film.length().shown(number) {
            input.write_all(&picture)?;
        }
        show(number);
    }
    input.flush()
}

fn unavailable(error: &io::Error) -> Failure {
    let reason = match error.kind() {
        ErrorKind::NotFound => "it is not on the PATH".into(),
        _ => error.to_string(),
    };
    Failure::new(format!(
        "an .mp4 is made by the program {FFMPEG}, and {reason}; install it, or write a .gif, a .png or a \
         folder of frames"
    ))
}

fn failed(reason: &str) -> Failure {
    Failure::new(format!(
        "{FFMPEG} made no video: {reason}; write a .gif, a .png or a folder of frames instead"
    ))
}
