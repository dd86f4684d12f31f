//! Files that are read: how they are opened, and why one cannot be.

pub mod quote;

use std::fs::{self, File, Metadata};
use std::path::Path;
use std::{fmt, io};

/// What the system knows of a file, unless it is a folder: some systems call it a lack of permission
/// when one is opened.
pub(crate) fn metadata(path: &Path) -> io::Result<Metadata> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok(metadata) }
}

/// Bytes that are read at a time.
pub const READ_AT_ONCE: usize = 1 << 18;

/// Opens a file that can be read from any place, and more than once: no folder, and no pipe, which
/// would wait for a writer.
///
/// # Errors
///
/// `IsADirectory` for a folder, `NotSeekable` for what else is no file, and what the system says.
pub fn regular_file(path: &Path) -> io::Result<File> {
    if !metadata(path)?.is_file() {
        return Err(io::ErrorKind::NotSeekable.into());
    }
    File::open(path)
}

/// The common failures in our words, the others in the system's.
#[derive(Debug)]
pub struct Unreadable<'a> {
    error: &'a io::Error,
    format: &'static str,
}

impl<'a> Unreadable<'a> {
    /// Why a file was not read that should be of a format, such as "an OBJ file".
    pub fn new(error: &'a io::Error, format: &'static str) -> Self {
        Unreadable { error, format }
    }
}

impl fmt::Display for Unreadable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.error.kind() {
            io::ErrorKind::NotFound => f.write_str("there is no such file"),
            io::ErrorKind::IsADirectory => write!(f, "this is a folder, not {}", self.format),
            io::ErrorKind::PermissionDenied => f.write_str("there is no permission to read it"),
            io::ErrorKind::NotSeekable => f.write_str(
                "this is a pipe or a device, which can be read only once; save it as a file first",
            ),
            _ => write!(f, "it cannot be read: {}", self.error),
        }
    }
}
