//! What a comparison can be about.

use serde::Serialize;

/// Something that two buffers may both tell of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Aspect {
    /// Whether something is there.
    Coverage,
    /// Which primitive it is.
    Ids,
    /// How far it is.
    T,
    /// What it looks like.
    #[serde(rename = "colour")]
    Color,
}

impl Aspect {
    /// All of them, in the order in which they are reported.
    pub const ALL: [Aspect; 4] = [Aspect::Coverage, Aspect::Ids, Aspect::T, Aspect::Color];

    /// What a sentence calls it.
    pub fn name(self) -> &'static str {
        match self {
            Aspect::Coverage => "coverage",
            Aspect::Ids => "ids",
            Aspect::T => "t",
            Aspect::Color => "colour",
        }
    }
}

/// What coverage is counted in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Each sample for itself; with one sample a pixel, that is a pixel.
    Samples,
    /// The files have different numbers of samples: a pixel is covered if one of its samples is.
    Pixels,
}

/// One of two files, or of two folders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The first.
    A,
    /// The second.
    B,
}
