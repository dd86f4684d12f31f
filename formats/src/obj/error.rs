//! Errors about OBJ and MTL files: each names the file, the line and the fault.

use crate::picture::ReadTextureError;
use crate::source::Unreadable;
use std::fmt;
use std::io;

/// Why an OBJ or MTL file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadObjError {
    /// The file does not exist, is a folder or a pipe, or the system reports another error.
    #[error("{file}: {}", Unreadable::new(.error, "an OBJ file"))]
    Unreadable {
        /// The file.
        file: String,
        /// The system's error. The message contains it, so it is not a [source](std::error::Error::source) as well.
        error: io::Error,
    },
    /// The file is so large that 32-bit indices might not be enough for its vertices.
    #[error("{file}: an OBJ file of more than 16 GiB cannot be read; split it")]
    TooLarge {
        /// The file.
        file: String,
    },
    /// The file has no bytes.
    #[error("{file}: the file is empty")]
    Empty {
        /// The file.
        file: String,
    },
    /// The file has no faces.
    #[error("{file}: no faces (`f` statements), so nothing to draw; export the mesh as polygons")]
    NoFaces {
        /// The file.
        file: String,
    },
    /// A material file names a picture that cannot be read.
    #[error("{file}:{line}: {error}")]
    Picture {
        /// The material file.
        file: String,
        /// The line that names the picture, counted from 1.
        line: usize,
        /// What is wrong with the picture.
        error: ReadTextureError,
    },
    /// A statement is wrong.
    #[error("{file}:{line}: {fault}")]
    Statement {
        /// The file.
        file: String,
        /// The line on which the statement begins, counted from 1.
        line: usize,
        /// What is wrong with it.
        fault: StatementFault,
    },
}

/// What is wrong with a statement of an OBJ or MTL file.
///
/// Texts are quoted from the file: shortened if they are long, with `�` in place of bytes that are not UTF-8.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StatementFault {
    /// The first word of the line is not text.
    #[error("this is not plain text, as an OBJ or MTL file must be (a binary or UTF-16 file?)")]
    NotText,
    /// The keyword is not one of the format, or it would include another file or run a command.
    #[error("there is no statement {keyword:?} that an OBJ file may have here")]
    UnknownKeyword {
        /// The keyword.
        keyword: String,
    },
    /// The statement does not fit into the buffer of the reader. It may be a comment.
    #[error(
        "a statement or a comment of more than {most} bytes is not read; cut a polygon up, and break a comment into lines"
    )]
    TooLong {
        /// The most bytes that it may have.
        most: usize,
    },
    /// There are more vertices than 32-bit indices can name.
    #[error("there are too many vertices; at most {} can be told apart", u32::MAX - 1)]
    TooManyVertices,
    /// A coordinate is not a number.
    #[error("{text:?} is not a number")]
    NotANumber {
        /// The word of the file.
        text: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("{text:?} is not a finite number")]
    NotFinite {
        /// The word of the file.
        text: String,
    },
    /// A coordinate is a number, but rounds to infinity.
    #[error("{text:?} is out of range: single precision ends at 3.4028235e38")]
    OutOfRange {
        /// The word of the file.
        text: String,
    },
    /// A `v`, `vt` or `vn` has too few numbers.
    #[error("too few coordinates for a {kind}: {found} instead of {needed}")]
    MissingCoordinates {
        /// What the statement defines.
        kind: IndexKind,
        /// The number of those needed.
        needed: usize,
        /// The number of those found.
        found: usize,
    },
    /// A face has fewer than three corners.
    #[error("a face needs at least 3 corners, this one has {corners}")]
    TooFewCorners {
        /// The number of those found.
        corners: usize,
    },
    /// A corner of a face has none of the forms of the format.
    #[error("{text:?} is not a corner; write one as v, v/vt, v//vn or v/vt/vn, in whole numbers")]
    NotACorner {
        /// The word of the file.
        text: String,
    },
    /// An index of a face is 0.
    #[error("the face names {kind} 0, but they are counted from 1")]
    IndexZero {
        /// What the index names.
        kind: IndexKind,
    },
    /// A negative index of a face counts back beyond the first definition.
    #[error("the face names {kind} {index}, counted back, but above it {}", Defined(*.defined))]
    UnknownAbove {
        /// What the index names.
        kind: IndexKind,
        /// The negative index.
        index: i64,
        /// The number of definitions above the face.
        defined: usize,
    },
    /// A positive index of a face is not defined anywhere in the file.
    #[error("the face names {kind} {index}, but in the whole file {}", Defined(*.defined))]
    Unknown {
        /// What the index names.
        kind: IndexKind,
        /// The index.
        index: i64,
        /// The number of definitions in the file.
        defined: usize,
    },
    /// A `newmtl` of an MTL file has no name.
    #[error("newmtl needs the material's name")]
    NoName,
    /// A statement of an MTL file stands before the first `newmtl`.
    #[error("{keyword} stands before the first newmtl, so it describes no material")]
    NoMaterial {
        /// The statement's keyword.
        keyword: String,
    },
    /// A statement of an MTL file has too few numbers.
    #[error("{keyword} needs {needed}")]
    MissingNumbers {
        /// The statement's keyword.
        keyword: String,
        /// The number of those needed, in words.
        needed: &'static str,
    },
    /// A number of an MTL file is too small or too large.
    #[error("{keyword} has the value {text}; it must be {range}")]
    OutOfBounds {
        /// The statement's keyword.
        keyword: String,
        /// The word of the file.
        text: String,
        /// The allowed range, in words.
        range: &'static str,
    },
}

/// What an index of a face names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum IndexKind {
    /// A position, `v`.
    Vertex,
    /// A texture coordinate, `vt`.
    TextureCoordinate,
    /// A normal, `vn`.
    Normal,
}

impl fmt::Display for IndexKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            IndexKind::Vertex => "vertex",
            IndexKind::TextureCoordinate => "texture coordinate",
            IndexKind::Normal => "normal",
        })
    }
}

/// Displays "only 8 are defined", with the right grammar for any number.
struct Defined(usize);

impl fmt::Display for Defined {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            0 => f.write_str("none is defined"),
            1 => f.write_str("only 1 is defined"),
            count => write!(f, "only {count} are defined"),
        }
    }
}
