//! Reads a file of any origin. The content determines the format, not the name.

use super::read_buffer::{ReadBuffer, ReadOptions};
use super::{npy, open_exr, picture};
use crate::common::SizeError;
use crate::diff::buffer::Buffer;
use crate::formats::picture::Problem;
use crate::formats::source::{READ_AT_ONCE, regular_file};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// The reason why a file cannot be read as a buffer.
#[derive(Debug, thiserror::Error)]
pub enum ReadBufferError {
    /// The file does not exist, or permission to read it is missing.
    #[error("cannot read {}: {}", .path.display(), reason(.error))]
    Open {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        error: io::Error,
    },
    /// The file has no byte.
    #[error("{} is empty; write it again", .path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The first bytes of the file belong to no known format.
    #[error(
        "{} is neither a picture (PNG, PNM, BMP, JPEG, EXR) nor a NumPy array (.npy); \
         save it as one of these",
        .path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file is an archive of arrays.
    #[error(
        "{} is an archive, perhaps of NumPy arrays (.npz); save one array alone with numpy.save",
        .path.display()
    )]
    Archive {
        /// The file.
        path: PathBuf,
    },
    /// A picture or an array is damaged, of an unsupported kind, or too large.
    #[error("{}: {problem}", .path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// The error, and the remedy.
        problem: String,
    },
    /// The file has no pixels, or too many.
    #[error(
        "{}: {error}; {}",
        .path.display(),
        match error {
            SizeError::Empty { .. } | SizeError::NoSamples => "save it again",
            SizeError::TooManySamples { .. } => "compare parts of it",
        }
    )]
    Size {
        /// The file.
        path: PathBuf,
        /// The size of the file, and the limit.
        error: SizeError,
    },
}

/// Reads a picture (PNG, PNM, BMP, 8 or 16 bits; JPEG; EXR) or a NumPy array.
///
/// `background` (in sRGB) is the colour of uncovered pixels in pictures that have colours but no alpha.
///
/// - One channel with no value but 0 and one other: a mask. More values: a grey picture, covered
///   where it is not 0. With alpha: covered where alpha is more than 0.
/// - NPY of shape H×W or H×W×N×N: `bool` is a mask, integers are ids (all ones, -1 too, are
///   nothing), floats are distances (±∞ and NaN are nothing).
/// - NPY of shape H×W×3 or H×W×4: sRGB colours, as `uint8`, `uint16` or floats from 0 to 1. Three floats are normals
///   if some are negative and all are of unit length.
/// - EXR: R, G, B (and A) are colours, linear and multiplied by alpha as this format has it, brought to sRGB; a single channel,
///   or one with a known name (`Z`, `depth`, `id`, `object_id`, …): distances of floats, ids of integers; three
///   (`normal.X`, …): normals.
///
/// # Errors
///
/// If the file cannot be read, or has none of these formats.
pub fn read(path: &Path, background: Option<[u8; 3]>) -> Result<Buffer<'static>, ReadBufferError> {
    let options = ReadOptions { background, ..ReadOptions::default() };
    read_with(path, &options).map(|read| read.buffer)
}

/// The same with more to say about the file, and with what there is to say about how it was read.
///
/// # Errors
///
/// The errors of [`read`], and channels that cannot be chosen.
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<ReadBuffer, ReadBufferError> {
    let file = regular_file(path);
    let file = file.map_err(|error| ReadBufferError::Open { path: path.to_owned(), error })?;
    read_from(path, BufReader::with_capacity(READ_AT_ONCE, file), options)
}

/// Reads the content of an input, as [`read_with`] does; messages use the name `path`.
///
/// No number in the input makes the reader allocate memory before the format is known and the size is within bounds.
///
/// # Errors
///
/// The errors of [`read_with`].
pub fn read_from(
    path: &Path,
    mut input: impl BufRead + Seek,
    options: &ReadOptions,
) -> Result<ReadBuffer, ReadBufferError> {
    let path = || path.to_owned();
    let start = start(&mut input);
    let (start, length) = start.map_err(|error| ReadBufferError::Open { path: path(), error })?;
    if start.is_empty() {
        return Err(ReadBufferError::Empty { path: path() });
    }
    if start.starts_with(b"PK\x03\x04") {
        return Err(ReadBufferError::Archive { path: path() });
    }
    let read = if start.starts_with(npy::MAGIC) {
        npy::read(input, length, options)
    } else if start.starts_with(open_exr::MAGIC) {
        open_exr::read(input, length, options)
    } else if let Ok(format) = image::guess_format(&start)
        && format.reading_enabled()
    {
        picture::read(input, length, format, options)
    } else {
        return Err(ReadBufferError::UnknownFormat { path: path() });
    };
    read.map_err(|problem| match problem {
        Problem::Content(problem) => ReadBufferError::Content { path: path(), problem },
        Problem::Size(error) => ReadBufferError::Size { path: path(), error },
        Problem::Memory => {
            let problem = format!(
                "it needs more than the {} MiB of memory that a picture may take; compare parts of it",
                picture::MOST_MEMORY >> 20
            );
            ReadBufferError::Content { path: path(), problem }
        }
        Problem::Io(error) => ReadBufferError::Open { path: path(), error },
    })
}

/// The first bytes of an input, which determine the format, and the length of the input.
fn start(input: &mut (impl BufRead + Seek)) -> io::Result<(Vec<u8>, u64)> {
    /// Enough bytes for every format.
    const MOST: u64 = 32;
    let length = input.seek(SeekFrom::End(0))?;
    input.rewind()?;
    let mut start = Vec::new();
    input.by_ref().take(MOST).read_to_end(&mut start)?;
    input.rewind()?;
    Ok((start, length))
}

/// The reason why a file cannot be opened, in words where the system has only a number.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::IsADirectory => "it is a folder".into(),
        io::ErrorKind::PermissionDenied => "there is no permission to".into(),
        io::ErrorKind::NotSeekable => "it is a pipe or a device; save it as a file first".into(),
        _ => error.to_string(),
    }
}
