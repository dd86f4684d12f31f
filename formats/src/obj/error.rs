//! Why an OBJ file could not be read: which file, where in it, what is wrong there.

use crate::source::Unreadable;
use std::fmt;
use std::io;

/// Why an OBJ file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadObjError {
    /// There is no such file, it is a folder, or the system does not give it away.
    #[error("{file}: {}", Unreadable::new(.error, "an OBJ file"))]
    Unreadable {
        /// The file.
        file: String,
        /// What the system says. The message says it too, so it is no
        /// [source](std::error::Error::source) besides.
        error: io::Error,
    },
    /// The file is so large that its vertices might not be told apart by 32-bit indices.
    #[error("{file}: an OBJ file of more than 16 GiB cannot be read; split it")]
    TooLarge {
        /// The file.
        file: String,
    },
    /// The file has no bytes at all.
    #[error("{file}: the file is empty")]
    Empty {
        /// The file.
        file: String,
    },
    /// Nothing in the file has an area.
    #[error("{file}: no faces (`f` statements), so nothing to draw; export the mesh as polygons")]
    NoFaces {
        /// The file.
        file: String,
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

/// What is wrong with a statement of an OBJ file.
///
/// Texts are quoted from the file: shortened if they are long, with `�` for what is not UTF-8.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StatementFault {
    /// The line does not begin like text.
    #[error("this is not plain text, as an OBJ or MTL file must be (a binary or UTF-16 file?)")]
    NotText,
    /// The statement's keyword is not one of the format, or one that includes other files.
    #[error("there is no statement {keyword:?} that an OBJ file may have here")]
    UnknownKeyword {
        /// The keyword.
        keyword: String,
    },
    /// The statement does not fit into the reader's buffer.
    #[error("a statement of more than {most} bytes is not read; cut the polygon up")]
    TooLong {
        /// The most bytes that it may have.
        most: usize,
    },
    /// More vertices than indices of 32 bits can name.
    #[error("there are too many vertices; at most {} can be told apart", u32::MAX - 1)]
    TooManyVertices,
    /// A coordinate is not a number.
    #[error("{text:?} is not a number")]
    NotANumber {
        /// What stands there.
        text: String,
    },
    /// A coordinate is NaN or infinite, in words.
    #[error("{text:?} is not a finite number")]
    NotFinite {
        /// What stands there.
        text: String,
    },
    /// A coordinate is a number, but rounds to infinity.
    #[error("{text:?} is out of range: single precision ends at 3.4028235e38")]
    OutOfRange {
        /// What stands there.
        text: String,
    },
    /// A `v`, `vt` or `vn` has too few numbers.
    #[error("too few coordinates for a {kind}: {found} instead of {needed}")]
    MissingCoordinates {
        /// What needs them.
        kind: IndexKind,
        /// How many it needs.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// A face has no area.
    #[error("a face needs at least 3 corners, this one has {corners}")]
    TooFewCorners {
        /// How many there are.
        corners: usize,
    },
    /// A corner of a face is not written as it must be.
    #[error("{text:?} is not a corner; write one as v, v/vt, v//vn or v/vt/vn, in whole numbers")]
    NotACorner {
        /// What stands there.
        text: String,
    },
    /// A face names something by the index 0.
    #[error("the face names {kind} 0, but they are counted from 1")]
    IndexZero {
        /// What it names.
        kind: IndexKind,
    },
    /// A face names something, counted back, from before the first.
    #[error("the face names {kind} {index}, counted back, but above it {}", Defined(*.defined))]
    UnknownAbove {
        /// What it names.
        kind: IndexKind,
        /// By which negative index.
        index: i64,
        /// How many are defined above the face.
        defined: usize,
    },
    /// A face names something that the file does not define, neither above nor below.
    #[error("the face names {kind} {index}, but in the whole file {}", Defined(*.defined))]
    Unknown {
        /// What it names.
        kind: IndexKind,
        /// By which index.
        index: i64,
        /// How many the file defines.
        defined: usize,
    },
    /// A `newmtl` of an MTL file gives no name.
    #[error("newmtl needs the material's name")]
    NoName,
    /// A statement of an MTL file describes nothing.
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
        /// How many, in words.
        needed: &'static str,
    },
    /// A number of an MTL file is too small or too large.
    #[error("{keyword} has the value {text}; it must be {range}")]
    OutOfBounds {
        /// The statement's keyword.
        keyword: String,
        /// What stands there.
        text: String,
        /// What is allowed, in words.
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

/// "only 8 are defined", in good grammar for any number.
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
