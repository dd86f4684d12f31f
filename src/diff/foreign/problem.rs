//! What is wrong with a file, told by the reader of its format.

use crate::common::SizeError;
use std::io;

/// What is wrong with the content of a file, whatever its name.
#[derive(Debug)]
pub(super) enum Problem {
    /// In the words of a message: what is wrong, and what would be right.
    Content(String),
    Size(SizeError),
    /// The system does not give the file away.
    Io(io::Error),
}

/// What is said of a file that has fewer bytes than it should.
pub(super) fn ends_early(bytes: u64) -> String {
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
