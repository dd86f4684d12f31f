//! What a page shows.

use super::groups::Group;
use crate::diff::buffer::Buffer;
use crate::diff::compare::BufferComparison;

/// The most samples whose values are in a page; of more samples, only the pictures are.
pub(super) const MOST_VALUES: u64 = 4096 * 4096;

/// What a page shows. [`Page::new`] fills in what the comparison itself tells; every field may be replaced.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// The names of A and B, in any characters.
    pub names: [String; 2],
    /// A and B.
    pub buffers: [&'a Buffer<'a>; 2],
    /// Their comparison.
    pub comparison: &'a BufferComparison,
    /// The heading: whether A and B differ, in one sentence.
    pub verdict: String,
    /// Whether the verdict is good: usually, whether no more pixels differ than are allowed to.
    pub good: bool,
    /// The differing pixels by class or by reason. A pixel in several groups has the colour of the first one that is
    /// shown.
    pub groups: Vec<Group>,
    /// What may be the cause of the difference as a whole, a sentence each.
    pub findings: Vec<String>,
    /// Counts and measures: a label and a value each.
    pub figures: Vec<(String, String)>,
    /// The beginning of the command that explains a pixel, such as `bothways pixel ties`; the page appends row and
    /// column. `None` if the scene is unknown.
    pub why: Option<String>,
}

impl Page<'_> {
    /// Whether the values of all samples are part of the page.
    pub(super) fn has_values(&self) -> bool {
        let pixels: u64 = self.comparison.size.map(u64::from).iter().product();
        let samples = self.buffers.map(|buffer| u64::from(buffer.samples()).pow(2));
        pixels * samples[0].max(samples[1]) <= MOST_VALUES
    }
}
