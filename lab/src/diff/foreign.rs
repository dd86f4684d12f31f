//! A comparison of two files of any origin: where two renderers differ, and how.
//!
//! A [`Buffer`] is a mask, ids, distances, normals or a picture, read from a PNG, PNM, BMP, JPEG, EXR or NPY file by
//! [`read`].
//! [`compare`] compares the aspects that both buffers contain: coverage and ids without tolerance, distances and
//! colours within the tolerances of [`diff`](super).
//!
//! ```
//! use bothways_lab::diff::foreign::{Buffer, Content, compare};
//!
//! let mine = Buffer::new([3, 1], 1, Content::Mask(vec![true, true, false].into()));
//! let yours = Buffer::new([3, 1], 1, Content::Ids(vec![Some(0), None, Some(4)]));
//! let comparison = compare(&mine, &yours)?;
//! assert_eq!(comparison.first_differing, [[0, 1], [0, 2]]);
//! # Ok::<(), bothways_lab::diff::foreign::Incomparable>(())
//! ```

mod bands;
mod channels;
mod colors;
mod depth;
mod float_ids;
mod hints;
mod normals;
mod npy;
mod open_exr;
mod picture;
mod placements;
mod read;
mod read_buffer;

pub use super::aspect::{Aspect, Side, Unit};
pub use super::buffer::{Buffer, Content, Covered, Picture, Pixels, distance_text};
pub use super::compare::{
    BufferColor, BufferComparison, BufferCoverage, BufferDepth, BufferIds, BufferNormals,
    Incomparable,
};
pub use depth::{Depth, DepthError};
pub use float_ids::ids_of_floats;
pub use placements::exchanged_sides;
pub use read::{ReadBufferError, read, read_from, read_with};
pub use read_buffer::{ReadBuffer, ReadOptions};

pub use super::measures::{BorderDistance, ColorMeasures, CoverageMeasures, Measures};
pub use super::tolerance::{CompareOptions, Tolerances};

pub(super) use float_ids::{are_many, whole_numbers};

use super::buffer_pair::{BufferPair, Decides};
use super::measures;

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
    compare_with(a, b, &CompareOptions { reference, ..CompareOptions::default() })
}

/// The same with other tolerances, without some of the pixels, or with some differences allowed.
///
/// # Errors
///
/// The errors of [`compare`], and a rectangle to ignore that the buffers do not have.
///
/// ```
/// use bothways_lab::diff::foreign::{Buffer, CompareOptions, Content, compare_with};
///
/// let [mine, yours] = [2.0, 2.001].map(|t| Buffer::new([1, 1], 1, Content::Distances(vec![t])));
/// let mut options = CompareOptions::default();
/// assert!(!compare_with(&mine, &yours, &options)?.passes);
/// options.tolerances.t = 1e-3;
/// assert!(compare_with(&mine, &yours, &options)?.passes);
/// # Ok::<(), bothways_lab::diff::foreign::Incomparable>(())
/// ```
pub fn compare_with(
    a: &Buffer,
    b: &Buffer,
    options: &CompareOptions,
) -> Result<BufferComparison, Incomparable> {
    let pair = BufferPair::new(a, b, Decides::Everything).with(options);
    let mut comparison = super::compare::compare(&pair)?.allowing(options.allowed_pixels);
    if options.only_compares {
        return Ok(comparison);
    }
    comparison.measures = measures::measure(&pair, &comparison);
    comparison.light = a.difference_light().or_else(|| b.difference_light());
    if !comparison.equal {
        comparison.hints = hints::hints(&pair, comparison.classes(), options.reference);
    }
    Ok(comparison)
}

#[cfg(test)]
mod tests;
