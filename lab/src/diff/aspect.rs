//! The aspects of a comparison.

use serde::Serialize;

/// A property of a pixel that two buffers may both contain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Aspect {
    /// Whether a primitive is visible.
    Coverage,
    /// Which primitive is visible.
    Ids,
    /// The distance of the visible primitive.
    T,
    /// The direction of the visible surface.
    Normals,
    /// The colour of the pixel.
    #[serde(rename = "colour")]
    Color,
}

impl Aspect {
    /// All aspects, in the order of the report.
    pub const ALL: [Aspect; 5] =
        [Aspect::Coverage, Aspect::Ids, Aspect::T, Aspect::Normals, Aspect::Color];

    /// The name of the aspect in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Aspect::Coverage => "coverage",
            Aspect::Ids => "ids",
            Aspect::T => "t",
            Aspect::Normals => "normals",
            Aspect::Color => "colour",
        }
    }
}

/// The unit of coverage counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Each sample counts separately; with one sample per pixel, a sample is a pixel.
    Samples,
    /// The files have different numbers of samples: a pixel is covered if one of its samples is covered.
    Pixels,
}

/// One of two files, or of two folders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The first file or folder.
    A,
    /// The second file or folder.
    B,
}
