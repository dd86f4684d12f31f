//! Errors about STL files: each names the file, the line or the facet, and the fault.

use super::layout::binary_size;
use crate::source::Unreadable;
use std::io;

/// Why an STL file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadStlError {
    /// The file does not exist, is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "an STL file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// The file has no bytes.
    #[error("{file}: the file is empty")]
    Empty {
        /// The file.
        file: String,
    },
    /// The file is neither text that begins with `solid`, nor has it the size of a binary file.
    #[error("{file}: this is no STL file: it {}{}", no_text(*.begins), size_of(*.size, *.facets))]
    Neither {
        /// The file.
        file: String,
        /// Whether it begins with `solid`, but is no text.
        begins: bool,
        /// Its size, in bytes.
        size: u64,
        /// The number of facets that it would promise as a binary file.
        facets: Option<u32>,
    },
    /// The file has no facets.
    #[error("{file}: no facets, so nothing to draw; export the mesh as triangles")]
    NoFacets {
        /// The file.
        file: String,
    },
    /// A line of an ASCII file is wrong.
    #[error("{file}:{line}: {fault}")]
    Line {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong with it.
        fault: StlFault,
    },
    /// A facet of a binary file is wrong.
    #[error("{file}: facet {facet}: {fault}")]
    Facet {
        /// The file.
        file: String,
        /// The facet, counted from 0.
        facet: u64,
        /// What is wrong with it.
        fault: StlFault,
    },
}

/// Why a file is no ASCII file.
fn no_text(begins: bool) -> &'static str {
    if begins { "begins with \"solid\", but is no text" } else { "does not begin with \"solid\"" }
}

/// How the size of a file differs from that of a binary file.
fn size_of(size: u64, facets: Option<u32>) -> String {
    let Some(facets) = facets else {
        return format!(", and a binary one has at least 84 bytes, this one has {size}");
    };
    let stated = binary_size(facets);
    let cause = if size < stated {
        "is it truncated?"
    } else {
        "is its number of facets wrong, or something appended to it?"
    };
    format!(
        ", and as a binary one of {facets} facets it would have {stated} bytes, but has {size}; {cause}"
    )
}

/// What is wrong with a line or a facet of an STL file.
///
/// Texts are quoted from the file: shortened if they are long, with `�` in place of bytes that are not UTF-8.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages explain the fields")]
pub enum StlFault {
    /// A word stands where the format has another.
    #[error("{text:?} stands here in place of \"{expected}\"")]
    Unexpected { text: String, expected: &'static str },
    /// The line has bytes that no text has.
    #[error("this is not plain text, as an ASCII STL file must be; is the file damaged?")]
    NotText,
    /// The file ends within a solid.
    #[error("the file ends here, before \"{expected}\"; is it truncated?")]
    Ended { expected: &'static str },
    /// The line goes on.
    #[error("the line goes on with {text:?}, which does not belong there")]
    Excess { text: String },
    /// The line is longer than any of the format.
    #[error("the line has {most} bytes or more; is this an STL file?")]
    LineTooLong { most: u64 },
    /// A corner was not there when the vertices were read.
    #[error("the file has changed since its vertices were read; render it again")]
    Changed,
    /// A facet has more than three vertices.
    #[error("this facet has a fourth vertex, but STL has triangles only")]
    FourthVertex,
    /// A vertex has fewer than three coordinates.
    #[error("a vertex needs 3 coordinates, this one has {found}")]
    MissingCoordinates { found: usize },
    /// A coordinate is not a number.
    #[error("{text:?} is not a number")]
    NotANumber { text: String },
    /// A coordinate is NaN or infinite.
    #[error("a coordinate is {text}, which is not a finite number")]
    NotFinite { text: String },
    /// A coordinate is a number, but rounds to infinity.
    #[error("{text:?} is out of range: single precision ends at 3.4028235e38")]
    OutOfRange { text: String },
    /// There are more vertices than 32-bit indices can name.
    #[error("there are too many vertices; at most {} can be told apart", u32::MAX - 1)]
    TooManyVertices,
}
