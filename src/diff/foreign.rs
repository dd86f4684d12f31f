//! A comparison of two files of any origin: where two renderers differ, and how.
//!
//! A [`Buffer`] is a mask, ids, distances or a picture, read from a PNG, PNM, BMP or NPY file by [`read`].
//! [`compare`] compares the aspects that both buffers contain: coverage and ids without tolerance, distances and
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

/// Compares all aspects that both buffers contain, and searches for causes of the difference.
///
/// # Errors
///
/// If the buffers differ in size, or have no aspect in common.
pub fn compare(a: &Buffer, b: &Buffer) -> Result<BufferComparison, Incomparable> {
    compare_with_reference(a, b, None)
}

/// Compares two buffers of which one may be known to be right: the search for causes leaves out errors in the encoding
/// of the reference.
///
/// # Errors
///
/// The errors of [`compare`].
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
