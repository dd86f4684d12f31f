//! Errors in a picture file, reported by the reader of its format.

use bothways_common::SizeError;
use std::io;

/// An error in the content of a file, without the name of the file.
#[derive(Debug)]
pub enum Problem {
    /// The text of a message: the error, and the remedy.
    Content(String),
    /// It has no pixels, or too many.
    Size(SizeError),
    /// Decoding needs more memory than the reader may take.
    Memory,
    /// The system cannot read the file.
    Io(io::Error),
}

/// The message for a file with fewer bytes than expected.
pub fn ends_early(bytes: u64) -> String {
    format!("the file ends early, after {bytes} bytes; copy it or write it again")
}

impl From<String> for Problem {
    fn from(problem: String) -> Self {
        Problem::Content(problem)
    }
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Problem::Io(error)
    }
}

impl From<SizeError> for Problem {
    fn from(error: SizeError) -> Self {
        Problem::Size(error)
    }
}
