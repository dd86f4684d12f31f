//! How a file is read, and what was read.

use crate::diff::buffer::Buffer;

/// How files are read whose content alone does not say enough.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The colour (in sRGB) of uncovered pixels in pictures that have colours but no alpha.
    pub background: Option<[u8; 3]>,
    /// The channels to read of an EXR, by their names; if empty, those that its names suggest.
    pub channels: Vec<String>,
    /// Whether three floats of a pixel are a normal, whatever their values.
    pub normals: bool,
}

/// A buffer, and what there is to say about how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadBuffer {
    /// What the file holds.
    pub buffer: Buffer<'static>,
    /// Which parts of the file were read, in a few words each.
    pub notes: Vec<String>,
    /// What makes the content doubtful.
    pub warnings: Vec<String>,
}

impl From<Buffer<'static>> for ReadBuffer {
    fn from(buffer: Buffer<'static>) -> ReadBuffer {
        ReadBuffer { buffer, notes: Vec::new(), warnings: Vec::new() }
    }
}
