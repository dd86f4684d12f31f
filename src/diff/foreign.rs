//! Two files of any origin: where does my renderer differ from yours, and how?
//!
//! A [`Buffer`] is a mask, ids, distances or a picture, read from a PNG, PNM, BMP or NPY file by
//! [`read`]. [`compare`] compares what both have: coverage and ids without tolerance, distances and
//! colours within the tolerances of [`diff`](super).
//!
//! ```
//! use bothways::diff::foreign::{Buffer, Content, compare};
//!
//! let mine = Buffer::new([3, 1], 1, Content::Mask(vec![true, true, false]));
//! let yours = Buffer::new([3, 1], 1, Content::Ids(vec![Some(0), None, Some(4)]));
//! let comparison = compare(&mine, &yours)?;
//! assert_eq!(comparison.first_differing, [[0, 1], [0, 2]]);
//! # Ok::<(), bothways::diff::foreign::Incomparable>(())
//! ```

mod hints;
mod npy;
mod picture;
mod png;
mod problem;
mod read;

pub use super::aspect::{Aspect, Side, Unit};
pub use super::buffer::{Buffer, Content, Covered, Picture, Pixels, distance_text};
pub use super::compare::{
    BufferColor, BufferComparison, BufferCoverage, BufferDepth, BufferIds, Incomparable,
};
pub use read::{ReadBufferError, read, read_from};

use super::buffer_pair::{BufferPair, Decides};

/// Compares whatever both buffers tell, and looks for causes of the difference.
///
/// # Errors
///
/// If they differ in size, or have nothing in common.
pub fn compare(a: &Buffer, b: &Buffer) -> Result<BufferComparison, Incomparable> {
    compare_with_reference(a, b, None)
}

/// The same, where one of the two is known to be right: no cause is looked for in the way that it is written.
///
/// # Errors
///
/// As for [`compare`].
pub fn compare_with_reference(
    a: &Buffer,
    b: &Buffer,
    reference: Option<Side>,
) -> Result<BufferComparison, Incomparable> {
    let pair = BufferPair::new(a, b, Decides::Everything);
    let mut comparison = super::compare::compare(&pair)?;
    comparison.light = a.light().or_else(|| b.light());
    if !comparison.equal {
        comparison.hints = hints::hints(&pair, reference);
    }
    Ok(comparison)
}

#[cfg(test)]
mod tests;
