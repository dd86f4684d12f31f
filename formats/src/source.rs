//! Opens files to read, and words the messages about files that cannot be read.

pub(crate) mod decimal;
pub mod files;
pub mod quote;

pub use files::{Files, FindFileError, GivenFile, InputFile, Reach};

use std::fs::{self, File, Metadata};
use std::path::Path;
use std::{fmt, io};

/// Returns what the system knows about a file.
///
/// A folder is an error here: some systems report a lack of permission when a folder is opened.
pub(crate) fn metadata(path: &Path) -> io::Result<Metadata> {
    let metadata = fs::metadata(path)?;
    if metadata.is_dir() { Err(io::ErrorKind::IsADirectory.into()) } else { Ok(metadata) }
}

/// The size of read buffers, in bytes.
pub const READ_AT_ONCE: usize = 1 << 18;

/// The byte order mark that some editors write before the first line.
pub(crate) const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The bytes of a file behind its byte order mark, if it has one.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes)
}

/// Opens a regular file, which can be read from any position and more than once.
///
/// Folders are refused, and pipes too: to open one would wait for a program that writes to it.
///
/// # Errors
///
/// `IsADirectory` for a folder, `NotSeekable` for a pipe or a device, and any error of the system.
pub fn regular_file(path: &Path) -> io::Result<File> {
    if !metadata(path)?.is_file() {
        return Err(io::ErrorKind::NotSeekable.into());
    }
    File::open(path)
}

/// Displays why a file could not be read: common reasons in words of our own, others in those of the system.
///
/// ```
/// use bothways_formats::source::Unreadable;
/// use std::io::{Error, ErrorKind};
///
/// let error = Error::from(ErrorKind::IsADirectory);
/// let message = Unreadable::new(&error, "an OBJ file").to_string();
/// assert_eq!(message, "this is a folder, not an OBJ file");
/// ```
#[derive(Debug)]
pub struct Unreadable<'a> {
    error: &'a io::Error,
    format: &'static str,
}

impl<'a> Unreadable<'a> {
    /// The reason `error`, for a file that was expected to be of a format, such as "an OBJ file".
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
