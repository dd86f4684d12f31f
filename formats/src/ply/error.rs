//! Errors about PLY files: each names the file, the location and the fault.

use crate::source::Unreadable;
use std::fmt;
use std::io;

/// Why a PLY file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadPlyError {
    /// The file does not exist, is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "a PLY file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// A line of the header is wrong.
    #[error("{file}:{line}: {fault}")]
    Header {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong with the line, or with the header that ends there.
        fault: Box<HeaderFault>,
    },
    /// An element is wrong.
    #[error("{file}: {element} {number} ({location}): {fault}")]
    Element {
        /// The file.
        file: String,
        /// The kind of element, such as `face`.
        element: String,
        /// The number of the element among those of its kind, counted from 0 as in the format.
        number: u64,
        /// The location at which the reader stopped.
        location: Location,
        /// What is wrong with it.
        fault: Box<ElementFault>,
    },
    /// The file has more content than the header announces.
    #[error(
        "{file}: something follows the last element ({location}); \
         the header's counts or types do not fit the file, so export it again"
    )]
    Trailing {
        /// The file.
        file: String,
        /// The location at which that content begins.
        location: Location,
    },
}

/// A location in a PLY file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// A byte of a binary file, counted from 0.
    Byte(u64),
    /// A line of an ASCII file, counted from 1.
    Line(u64),
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Location::Byte(byte) => write!(f, "byte {byte}"),
            Location::Line(line) => write!(f, "line {line}"),
        }
    }
}

/// What is wrong with the header of a PLY file.
///
/// Texts are quoted from the file: shortened if they are long, with `�` in place of bytes that are not UTF-8.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages explain the fields")]
pub enum HeaderFault {
    /// The file has no bytes.
    #[error("the file is empty")]
    Empty,
    /// The first line is not `ply`.
    #[error("this is no PLY file, which begins with a line that says \"ply\"")]
    NotPly,
    /// The file ends within the header, or a line is far too long.
    #[error("the header has no end; a line that says \"end_header\" must close it")]
    NoEnd,
    /// A line is not one of the format.
    #[error(
        "{text:?} is no line of a PLY header; those are format, comment, obj_info, element, \
         property and end_header"
    )]
    UnknownStatement { text: String },
    /// The encoding is not one of the format.
    #[error("there is no format {text:?}; it is ascii, binary_little_endian or binary_big_endian")]
    UnknownFormat { text: String },
    /// The version is not the only one of the format.
    #[error("PLY of version {text:?} cannot be read; there is only 1.0")]
    UnknownVersion { text: String },
    /// The type of a property is not one of the format.
    #[error(
        "there is no type {text:?}; a property is char, uchar, short, ushort, int, uint, float \
         or double"
    )]
    UnknownType { text: String },
    /// The number of elements is not a whole number.
    #[error("{text:?} is no number of elements of {name}")]
    NotACount { name: String, text: String },
    /// A format, an element or a property is there twice.
    #[error("the header has a second {what}")]
    Twice { what: String },
    /// A property stands before the first element.
    #[error("the property {name} belongs to no element; a line \"element\" must come before it")]
    NoElement { name: String },
    /// An element has no property.
    #[error("the element {name} has no property")]
    NoProperties { name: String },
    /// The header has more properties than any mesh needs.
    #[error("the header has more than {most} properties")]
    TooManyProperties { most: usize },
    /// The length of a list has a type that is not for whole numbers.
    #[error("the length of the list {name} is no integer type")]
    LengthNotInteger { name: String },
    /// The header does not name the encoding.
    #[error("the header has no line \"format\"")]
    NoFormat,
    /// The header has no vertices.
    #[error("the header has no element vertex, so nothing has a place")]
    NoVertices,
    /// There are more vertices than 32-bit indices can name.
    #[error("{count} vertices are too many; at most {} can be told apart", u32::MAX - 1)]
    TooManyVertices { count: u64 },
    /// A vertex lacks a coordinate.
    #[error("the element vertex has no property {name} that is a number")]
    NoCoordinate { name: &'static str },
    /// The header has no faces.
    #[error("no elements face, so nothing to draw; export the mesh as polygons")]
    NoFaces,
    /// Faces have no list of vertices.
    #[error("the element face has no list vertex_indices (or vertex_index) of integers")]
    NoCorners,
}

/// What is wrong with an element of a PLY file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages explain the fields")]
pub enum ElementFault {
    /// The file ends before the last element.
    #[error("the file ends here, but its header promises {count} such elements; is it truncated?")]
    Truncated { count: u64 },
    /// A word of an ASCII file is not a number.
    #[error("{text:?} is not a number")]
    NotANumber { text: String },
    /// A word of an ASCII file is not a whole number, or is out of the range of its type.
    #[error("{text:?} is not a whole number of the property's type")]
    NotAnInteger { text: String },
    /// A coordinate is NaN or infinite.
    #[error("the coordinate {name} is {text}, which is not a finite number")]
    NotFinite { name: String, text: String },
    /// A coordinate is finite, but rounds to infinity as an `f32`.
    #[error(
        "the coordinate {name} = {text} is out of range: single precision ends at 3.4028235e38"
    )]
    OutOfRange { name: String, text: String },
    /// The length of a list is negative.
    #[error("its list {name} has the length {length}")]
    NegativeLength { name: String, length: i64 },
    /// A face has fewer than three corners.
    #[error("a face needs at least 3 corners, this one has {corners}")]
    TooFewCorners { corners: i64 },
    /// A face names a vertex that does not exist.
    #[error("it names vertex {index}, but vertices are counted from 0 and there are {count}")]
    UnknownVertex { index: i64, count: u32 },
    /// A line of an ASCII file ends before its element does.
    #[error("the line ends before its element does; an element is one line")]
    LineTooShort,
    /// A line of an ASCII file continues after its element.
    #[error("the line goes on behind its element with {text:?}; an element is one line")]
    LineTooLong { text: String },
}
