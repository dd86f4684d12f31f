//! Why a PLY file could not be read: which file, where in it, what is wrong there.

use crate::source::Unreadable;
use std::fmt;
use std::io;

/// Why a PLY file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadPlyError {
    /// There is no such file, it is a folder, or the system does not give it away.
    #[error("{file}: {}", Unreadable::new(.error, "a PLY file"))]
    Unreadable {
        /// The file.
        file: String,
        /// What the system says. The message says it too, so it is no
        /// [source](std::error::Error::source) besides.
        error: io::Error,
    },
    /// A line of the header is wrong.
    #[error("{file}:{line}: {fault}")]
    Header {
        /// The file.
        file: String,
        /// The line, counted from 1.
        line: u64,
        /// What is wrong with it, or with the header that ends there.
        fault: Box<HeaderFault>,
    },
    /// An element is wrong.
    #[error("{file}: {element} {number} ({location}): {fault}")]
    Element {
        /// The file.
        file: String,
        /// The kind of element, such as `face`.
        element: String,
        /// Which one of them, counted from 0 as the format does.
        number: u64,
        /// Where in the file the reader stopped.
        location: Location,
        /// What is wrong with it.
        fault: Box<ElementFault>,
    },
    /// More follows than the header says.
    #[error(
        "{file}: something follows the last element ({location}); \
         the header's counts or types do not fit the file, so export it again"
    )]
    Trailing {
        /// The file.
        file: String,
        /// Where it begins.
        location: Location,
    },
}

/// Where in a PLY file.
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
/// Texts are quoted from the file: shortened if they are long, with `�` for what is not UTF-8.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each field is what its message calls it")]
pub enum HeaderFault {
    /// There are no bytes.
    #[error("the file is empty")]
    Empty,
    /// The first line is another one.
    #[error("this is no PLY file, which begins with a line that says \"ply\"")]
    NotPly,
    /// The file, or a line that is far too long, ends the header.
    #[error("the header has no end; a line that says \"end_header\" must close it")]
    NoEnd,
    /// A line is none of the format.
    #[error(
        "{text:?} is no line of a PLY header; those are format, comment, obj_info, element, \
         property and end_header"
    )]
    UnknownStatement { text: String },
    /// The values are written in a way that the format does not have.
    #[error("there is no format {text:?}; it is ascii, binary_little_endian or binary_big_endian")]
    UnknownFormat { text: String },
    /// Another version than the one that there is.
    #[error("PLY of version {text:?} cannot be read; there is only 1.0")]
    UnknownVersion { text: String },
    /// A property of an unknown type.
    #[error(
        "there is no type {text:?}; a property is char, uchar, short, ushort, int, uint, float \
         or double"
    )]
    UnknownType { text: String },
    /// A number of elements that is none.
    #[error("{text:?} is no number of elements of {name}")]
    NotACount { name: String, text: String },
    /// The same thing again.
    #[error("the header has a second {what}")]
    Twice { what: String },
    /// A property before any element.
    #[error("the property {name} belongs to no element; a line \"element\" must come before it")]
    NoElement { name: String },
    /// An element that has nothing.
    #[error("the element {name} has no property")]
    NoProperties { name: String },
    /// More than a file that describes a mesh has.
    #[error("the header has more than {most} properties")]
    TooManyProperties { most: usize },
    /// A list whose length is no whole number.
    #[error("the length of the list {name} is no integer type")]
    LengthNotInteger { name: String },
    /// Nothing says how values are written.
    #[error("the header has no line \"format\"")]
    NoFormat,
    /// Nothing has a place.
    #[error("the header has no element vertex, so nothing has a place")]
    NoVertices,
    /// More than indices of 32 bits can name.
    #[error("{count} vertices are too many; at most {} can be told apart", u32::MAX - 1)]
    TooManyVertices { count: u64 },
    /// A vertex lacks a coordinate.
    #[error("the element vertex has no property {name} that is a number")]
    NoCoordinate { name: &'static str },
    /// There is nothing that has an area.
    #[error("no elements face, so nothing to draw; export the mesh as polygons")]
    NoFaces,
    /// A face does not say which vertices it has.
    #[error("the element face has no list vertex_indices (or vertex_index) of integers")]
    NoCorners,
}

/// What is wrong with an element of a PLY file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "each field is what its message calls it")]
pub enum ElementFault {
    /// The file ends before all elements have come.
    #[error("the file ends here, but its header promises {count} such elements; is it truncated?")]
    Truncated { count: u64 },
    /// A word of an ASCII file is no number.
    #[error("{text:?} is not a number")]
    NotANumber { text: String },
    /// A word of an ASCII file is no whole number, or one beyond its type.
    #[error("{text:?} is not a whole number of the property's type")]
    NotAnInteger { text: String },
    /// A coordinate is NaN or infinite.
    #[error("the coordinate {name} is {text}, which is not a finite number")]
    NotFinite { name: String, text: String },
    /// A coordinate is finite, but not as an `f32`.
    #[error(
        "the coordinate {name} = {text} is out of range: single precision ends at 3.4028235e38"
    )]
    OutOfRange { name: String, text: String },
    /// A list says that it has fewer than no items.
    #[error("its list {name} has the length {length}")]
    NegativeLength { name: String, length: i64 },
    /// A face has no area.
    #[error("a face needs at least 3 corners, this one has {corners}")]
    TooFewCorners { corners: i64 },
    /// A face names a vertex that is not there.
    #[error("it names vertex {index}, but vertices are counted from 0 and there are {count}")]
    UnknownVertex { index: i64, count: u32 },
    /// A line of an ASCII file ends before its element does.
    #[error("the line ends before its element does; an element is one line")]
    LineTooShort,
    /// A line of an ASCII file goes on behind its element.
    #[error("the line goes on behind its element with {text:?}; an element is one line")]
    LineTooLong { text: String },
}
