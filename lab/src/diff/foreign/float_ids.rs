//! Ids that are saved as floating-point numbers, which are read as distances.

use crate::diff::buffer::{Buffer, Content};
use std::collections::HashSet;

/// So many different whole numbers are no distances.
const MANY: usize = 8;
/// Beyond this, not every whole number is one of `f64`.
const LARGEST: f64 = 9_007_199_254_740_992.0;

/// The ids that the distances of a buffer are, if they are whole numbers, and either many or mostly those of `ids`, which shows the
/// same. −1 and the largest numbers of unsigned integers stand for nothing, as an infinity does.
///
/// ```
/// use bothways_lab::diff::foreign::{Buffer, Content, ids_of_floats};
///
/// let floats = |numbers: Vec<f64>| Buffer::new([3, 1], 1, Content::Distances(numbers));
/// let ids = Buffer::new([3, 1], 1, Content::Ids(vec![Some(4), Some(0), None]));
/// assert_eq!(ids_of_floats(&floats(vec![4.0, 0.0, -1.0]), &ids), Some(ids.clone()));
/// assert_eq!(ids_of_floats(&floats(vec![4.0, 0.5, -1.0]), &ids), None);
/// assert_eq!(ids_of_floats(&floats(vec![2.0, 2.0, f64::INFINITY]), &ids), None);
/// ```
pub fn ids_of_floats(buffer: &Buffer, ids: &Buffer) -> Option<Buffer<'static>> {
    let (Content::Distances(numbers), Content::Ids(ids)) = (buffer.content(), ids.content()) else {
        return None;
    };
    let meant = whole_numbers(numbers)?;
    let of_both = || meant.iter().zip(ids).filter(|(one, other)| one.is_some() && other.is_some());
    let equal = of_both().filter(|(one, other)| one == other).count();
    let is_likely = are_many(&meant) || equal > 0 && 2 * equal >= of_both().count();
    (is_likely && numbers.len() == ids.len())
        .then(|| Buffer::new(buffer.size(), buffer.samples(), Content::Ids(meant)))
}

/// Floating-point numbers as ids; `None` unless all of them are whole.
pub(in crate::diff) fn whole_numbers(numbers: &[f64]) -> Option<Vec<Option<u64>>> {
    numbers.iter().map(|&number| id(number)).collect()
}

/// Whether ids are so many different ones that they are no distances.
pub(in crate::diff) fn are_many(ids: &[Option<u64>]) -> bool {
    let mut different = HashSet::new();
    ids.iter().flatten().any(|id| different.insert(id) && different.len() >= MANY)
}

/// The id that a number is, or that it is nothing; `None` if it is neither.
fn id(number: f64) -> Option<Option<u64>> {
    // All ones of 32 and of 64 bits, also as the nearest `f32`.
    const NOTHING: [f64; 4] =
        [-1.0, 4_294_967_295.0, 4_294_967_296.0, 18_446_744_073_709_552_000.0];
    if !number.is_finite() || NOTHING.contains(&number) {
        return Some(None);
    }
    let is_id = number.fract() == 0.0 && (0.0..LARGEST).contains(&number);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number of at most 53 bits"
    )]
    let id = number as u64;
    is_id.then_some(Some(id))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_whole_numbers_are_ids_whatever_the_other_file_shows() {
        let floats = |count: u8| {
            let numbers = (0..20).map(|at| f64::from(at % count)).collect();
            Buffer::new([20, 1], 1, Content::Distances(numbers))
        };
        let ids = Buffer::new([20, 1], 1, Content::Ids(vec![Some(70); 20]));
        assert!(ids_of_floats(&floats(8), &ids).is_some());
        assert!(ids_of_floats(&floats(7), &ids).is_none());
    }

    #[test]
    fn every_number_of_nothing_is_known() {
        for number in [-1.0, f64::from(u32::MAX), 4_294_967_296.0, f64::NAN] {
            assert_eq!(id(number), Some(None), "{number}");
        }
        assert_eq!([0.0, 7.0].map(id), [Some(Some(0)), Some(Some(7))]);
        assert_eq!([0.5, -2.0, 1e30].map(id), [None; 3]);
    }
}
