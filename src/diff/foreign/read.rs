//! Reads a file of any origin, by what is in it and not by its name.

use super::{Buffer, npy, picture};
use crate::common::CameraError;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Why a file could not be read as a buffer.
#[derive(Debug, thiserror::Error)]
pub enum ReadBufferError {
    /// There is no such file, or it may not be read.
    #[error("cannot read {}: {}", .path.display(), reason(.error))]
    Open {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// Its first bytes are of no known format.
    #[error(
        "{} is neither a picture (PNG, PNM, BMP) nor a NumPy array (.npy); \
         save it as one of these",
        .path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// It is an archive of arrays.
    #[error(
        "{} is an archive, perhaps of NumPy arrays (.npz); save one array alone with numpy.save",
        .path.display()
    )]
    Archive {
        /// The file.
        path: PathBuf,
    },
    /// A picture is damaged or of a kind that is not read.
    #[error("{}: {error}", .path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What its decoder says.
        error: image::ImageError,
    },
    /// An array is damaged, or not one of pixels.
    #[error("{}: {problem}", .path.display())]
    Array {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what would be right.
        problem: String,
    },
    /// It has no pixels, or too many.
    #[error("{}: {error}", .path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Its size, and the limit.
        error: CameraError,
    },
}

/// What is wrong with the content of a file, whatever its name.
#[derive(Debug)]
pub(super) enum Problem {
    Picture(image::ImageError),
    Array(String),
    Size(CameraError),
}

impl From<String> for Problem {
    fn from(problem: String) -> Self {
        Problem::Array(problem)
    }
}

impl From<CameraError> for Problem {
    fn from(error: CameraError) -> Self {
        Problem::Size(error)
    }
}

/// Reads a picture (PNG, PNM, BMP; 8 or 16 bits) or a NumPy array.
///
/// `background` (in sRGB) tells what is not covered in pictures that have colours but no alpha.
///
/// - One channel with no value but 0 and one other: a mask. More values: a grey picture, covered
///   where it is not 0. With alpha: covered where alpha is more than 0.
/// - NPY of shape H×W or H×W×N×N: `bool` is a mask, integers are ids (all ones, -1 too, are
///   nothing), floats are distances (±∞ and NaN are nothing).
/// - NPY of shape H×W×3 or H×W×4: sRGB colours, as `uint8`, `uint16` or floats from 0 to 1.
///
/// # Errors
///
/// If the file cannot be read, or is none of these.
pub fn read(path: &Path, background: Option<[u8; 3]>) -> Result<Buffer, ReadBufferError> {
    let path_of_error = || path.to_owned();
    let bytes =
        fs::read(path).map_err(|error| ReadBufferError::Open { path: path_of_error(), error })?;
    if bytes.starts_with(b"PK\x03\x04") {
        return Err(ReadBufferError::Archive { path: path_of_error() });
    }
    let read = if bytes.starts_with(npy::MAGIC) {
        npy::read(&bytes, background)
    } else if let Ok(format) = image::guess_format(&bytes)
        && format.reading_enabled()
    {
        picture::read(&bytes, format, background)
    } else {
        return Err(ReadBufferError::UnknownFormat { path: path_of_error() });
    };
    read.map_err(|problem| match problem {
        Problem::Picture(error) => ReadBufferError::Picture { path: path_of_error(), error },
        Problem::Array(problem) => ReadBufferError::Array { path: path_of_error(), problem },
        Problem::Size(error) => ReadBufferError::Size { path: path_of_error(), error },
    })
}

/// Why a file cannot be opened, in words where the system has only a number.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::IsADirectory => "it is a folder".into(),
        io::ErrorKind::PermissionDenied => "there is no permission to".into(),
        _ => error.to_string(),
    }
}
