//! What a search for conventions may find.

use super::convention::{Change, Convention};
use super::encoding::{Encoding, IdEncoding};
use super::layout::Layout;
use super::missing::Missing;

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Findings {
    /// The number of pixels of the file.
    pub pixels: u64,
    /// The number of pixels that are not what is true of the scene.
    pub differing: u64,
    /// What was found.
    pub finding: Finding,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// The file shows what is true of the scene.
    True,
    /// The file can say nothing about conventions; the reason, as a sentence.
    NoEvidence(String),
    /// By rounding alone it differs: each of these pixels lies nearly on an outline, or where two distances are nearly equal, and no
    /// way of rounding that is known explains most of them. Its conventions are ours.
    Rounded,
    /// These conventions explain pixels; all of them explain the same number.
    Explained(Vec<Explanation>),
    /// No convention explains as much as a quarter of the pixels. What all of them show or should show, as a sentence, if that is
    /// one thing.
    Unexplained(Option<String>),
}

/// Conventions that explain differing pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// Where and how the renderer samples, and what it draws.
    pub convention: Convention,
    /// What its numbers stand for.
    pub encoding: Encoding,
    /// Primitives that are missing, and in whose absence those behind them have smaller ids; mostly none.
    pub missing: Vec<Missing>,
    /// Where its numbers lie in a buffer, if not row by row.
    pub layout: Option<Layout>,
    /// The number of differing pixels that are as expected under these conventions.
    pub explained: u64,
    /// The number of pixels that differ under these conventions, too.
    pub remaining: u64,
    /// The explained pixels `[i, j]`, row by row; none if the file has another size than the camera's image.
    pub pixels: Vec<[u32; 2]>,
}

impl Explanation {
    /// The middle one of the explained pixels.
    pub fn telling(&self) -> Option<[u32; 2]> {
        self.pixels.get(self.pixels.len() / 2).copied()
    }

    /// Whether the explanation moves much of the picture, rather than a few samples on edges, or nearly so, or at equal distances.
    pub fn is_coarse(&self) -> bool {
        !self.missing.is_empty()
            || self.layout.is_some()
            || !self.encoding.is_ours()
            || self.convention.changes().into_iter().any(Change::is_coarse)
    }

    /// Whether another explanation may be better than this one.
    pub(super) fn may_be_bettered(&self) -> bool {
        self.remaining > 0 || self.encoding.ids == IdEncoding::OneToOne
    }

    /// Whether it leaves fewer pixels than another one. Numbers of its own for each primitive say less than anything.
    pub(super) fn is_better_than(&self, other: &Explanation) -> bool {
        self.remaining < other.remaining || other.encoding.ids == IdEncoding::OneToOne
    }

    /// Whether less than half of the differing pixels are explained.
    pub fn is_a_guess(&self, differing: u64) -> bool {
        self.explained * 2 < differing
    }
}
