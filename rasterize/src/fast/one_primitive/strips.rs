//! The strips in which triangles and planes are drawn.

use crate::fast::size_class::MOST_SAMPLES_ACROSS;
use std::ops::Range;

/// Rows and columns of a strip. Strips begin at multiples of these, so that what comes of a strip depends neither on
/// tiles nor on a crop.
pub(crate) const STRIP: [usize; 2] = [16, MOST_SAMPLES_ACROSS.cast_unsigned() as usize];

/// Rows of a tall strip, in which a triangle is set up for several strips together if `f32` is certain enough in all of them.
pub(crate) const TALL: usize = 8 * STRIP[0];

/// The pieces of `all`, cut at multiples of a length, that reach into `here`, a part of it.
pub(crate) fn strips(
    here: &Range<usize>,
    all: &Range<usize>,
    length: usize,
) -> impl Iterator<Item = Range<usize>> + use<> {
    let (all, first, end) = (all.clone(), here.start.max(all.start), here.end.min(all.end));
    let start = if first < end { first / length * length } else { end };
    (start..end)
        .step_by(length)
        .map(move |start| start.max(all.start)..(start + length).min(all.end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_are_those_of_the_whole() {
        let strips = |here, all| strips(&here, &all, 16).collect::<Vec<_>>();
        assert_eq!(strips(5..40, 5..40), [5..16, 16..32, 32..40]);
        assert_eq!(strips(20..33, 5..40), [16..32, 32..40]);
        assert_eq!(strips(16..33, 20..40), [20..32, 32..40]);
        assert!(strips(20..32, 32..40).is_empty() && strips(20..32, 5..20).is_empty());
        assert!(strips(20..20, 5..40).is_empty());
    }
}
