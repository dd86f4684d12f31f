//! What was found of a renderer.

use crate::diff::foreign::{Buffer, BufferComparison};

/// What was found of a renderer.
#[derive(Debug)]
pub struct Check {
    /// The files, in the order of the set.
    pub files: Vec<CheckedFile>,
    /// The scenes of the set without a file.
    pub missing: Vec<String>,
    /// The files that belong to no scene.
    pub ignored: Vec<String>,
    /// The causes, those of most files first.
    pub causes: Vec<Cause>,
}

/// A file of the renderer.
#[derive(Debug)]
pub struct CheckedFile {
    /// The name of the scene.
    pub scene: String,
    /// The name of the file in its folder.
    pub file: String,
    /// The point of the scene.
    pub point: String,
    /// What the file and the truth look like, if the file can be compared.
    pub compared: Result<Compared, NotCompared>,
}

/// Why a file was not compared with the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct NotCompared {
    /// The reason, as a sentence.
    pub reason: String,
    /// The content of the file, if it has as many rows as the picture of its scene has columns, and as many columns as
    /// that has rows: what the renderer does otherwise in all its pictures may explain it.
    pub exchanged: Option<Buffer<'static>>,
}

impl From<String> for NotCompared {
    fn from(reason: String) -> NotCompared {
        NotCompared { reason, exchanged: None }
    }
}

/// A file that was compared with the truth.
#[derive(Debug)]
pub struct Compared {
    /// The content of the file.
    pub theirs: Buffer<'static>,
    /// The same of the exact picture.
    pub truth: Buffer<'static>,
    /// Their comparison: A is the file, B the truth.
    pub comparison: BufferComparison,
}

/// Why files are wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cause {
    /// Sentences about the renderer, one for each part; several lists if they explain equally much.
    pub alternatives: Vec<Vec<String>>,
    /// How sure it is.
    pub certainty: Certainty,
    /// The indices of the files.
    pub files: Vec<usize>,
}

/// How sure a cause is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certainty {
    /// It explains every pixel of its files, and at least half of all files that are wrong.
    Convention,
    /// It explains every pixel of its files, but less than half of all files that are wrong.
    Guess,
    /// It is the reason of most differing pixels of its files.
    Reason,
    /// There is no explanation.
    Unknown,
}
