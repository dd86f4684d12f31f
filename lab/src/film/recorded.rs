//! What is kept of a film.

use super::length::Length;
use super::track::Track;
use crate::common::View;
use crate::diff::Comparison;
use crate::orders::Method;

/// A film of a scene.
#[derive(Debug)]
pub struct Film<'a> {
    pub(super) scene: String,
    pub(super) view: View<'a>,
    pub(super) method: Method,
    pub(super) length: Length,
    /// The clock at each frame.
    pub(super) moments: Vec<u64>,
    pub(super) tracks: [Track; 2],
    /// The pixels finished at each frame.
    pub(super) finished: Vec<[u64; 2]>,
    pub(super) comparison: Comparison,
}
