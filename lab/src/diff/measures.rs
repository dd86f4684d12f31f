//! Numbers that say how far two buffers are apart as a whole. A measure is never the verdict: one pixel on the wrong side
//! of an edge changes no such number much, and is a mistake all the same.
//!
//! There is no ꟻLIP (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020) among them. The
//! permissive implementation in reach, the crate `nv-flip`, binds C++, which needs a C++ compiler and `unsafe` beneath, and its
//! result depends on a viewing distance that no file states.

mod band;
mod color;
mod distance;
mod similarity;
mod values;

pub use color::ColorMeasures;
pub use distance::BorderDistance;
pub use values::{CoverageMeasures, Measures};

use super::aspect::Aspect;
use super::buffer_pair::BufferPair;
use super::classes::Class;
use super::compare::BufferComparison;

/// Measures all aspects that were compared.
pub(super) fn measure(pair: &BufferPair, comparison: &BufferComparison) -> Measures {
    let colors = pair.compares(Aspect::Color);
    Measures {
        coverage: comparison.coverage.map(|counted| {
            let any = counted.both + counted.only_a + counted.only_b;
            CoverageMeasures {
                differing_pixels: covered_otherwise(comparison),
                intersection_over_union: (any > 0).then(|| ratio(counted.both, any)),
                largest_border_distance: largest_border_distance(pair, comparison),
            }
        }),
        color: colors.then(|| color::measure(pair)).flatten(),
    }
}

/// The number of pixels with a sample that only one of the two covers.
fn covered_otherwise(comparison: &BufferComparison) -> u64 {
    if comparison.equal {
        return 0;
    }
    let classes = [Class::OnlyObjectOrder, Class::OnlyImageOrder];
    classes.map(|class| comparison.classes().count(class)).iter().sum()
}

#[expect(clippy::cast_precision_loss, reason = "at most 2^30 samples")]
fn ratio(part: u64, whole: u64) -> f64 {
    part as f64 / whole as f64
}

/// The largest distance of a pixel that only one buffer covers from the pixels that the other one covers. Ignored pixels
/// do not count as differing, but they are part of the masks.
fn largest_border_distance(
    pair: &BufferPair,
    comparison: &BufferComparison,
) -> Option<BorderDistance> {
    let sides = [(Class::OnlyObjectOrder, pair.b), (Class::OnlyImageOrder, pair.a)];
    let [top, left] = pair.a.origin();
    let found = sides.into_iter().filter_map(|(class, other)| {
        let differing = comparison.classes().differing();
        let wanted: Vec<[u32; 2]> =
            differing.filter(|&(_, of)| of == class).map(|(pixel, _)| pixel).collect();
        if wanted.is_empty() {
            return None;
        }
        let BorderDistance { pixels, at: [i, j] } =
            distance::farthest(other.size(), &other.covered_pixels(), &wanted)?;
        Some(BorderDistance { pixels, at: [top + i, left + j] })
    });
    // Of equal distances, the first pixel of A.
    found.reduce(|most, other| if other.pixels > most.pixels { other } else { most })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::foreign::{Buffer, CompareOptions, Content, compare, compare_with};

    fn mask(drawn: &[&str]) -> Buffer<'static> {
        let size = [drawn[0].len(), drawn.len()].map(|side| u32::try_from(side).unwrap());
        let mask: Vec<bool> = drawn.concat().chars().map(|letter| letter == '#').collect();
        Buffer::new(size, 1, Content::Mask(mask.into()))
    }

    fn measured(a: &[&str], b: &[&str]) -> CoverageMeasures {
        compare(&mask(a), &mask(b)).unwrap().measures.coverage.unwrap()
    }

    #[test]
    fn overlap_is_measured_and_two_empty_masks_overlap_in_nothing() {
        let overlap = |a, b| measured(&[a], &[b]).intersection_over_union;
        assert_eq!(overlap("####", "####"), Some(1.0));
        assert_eq!(overlap("####", "##.."), Some(0.5));
        assert_eq!(overlap("##..", "..##"), Some(0.0));
        assert_eq!(overlap("##..", "...."), Some(0.0));
        assert_eq!(overlap("....", "...."), None);
    }

    #[test]
    fn the_farthest_pixel_is_measured_from_the_other_mask() {
        let a = ["#.....", "......", "......", "#...#."];
        let b = ["#.....", ".#....", "......", "#....."];
        let farthest = |a: &[&str], b: &[&str]| measured(a, b).largest_border_distance;
        // (3, 4) of A lies 4 columns from (3, 0) of B, and nearer, √(2² + 3²), to (1, 1).
        let expected = Some(BorderDistance { pixels: 13.0_f64.sqrt(), at: [3, 4] });
        assert_eq!(farthest(&a, &b), expected);
        assert_eq!(farthest(&b, &a), expected);
        assert_eq!(farthest(&a, &a), None);
        let nothing = ["......"; 4];
        assert_eq!(farthest(&a, &nothing), None);
        assert_eq!(measured(&a, &nothing).differing_pixels, 3);
    }

    #[test]
    fn an_ignored_pixel_does_not_differ_but_is_part_of_its_mask() {
        let (a, b) = (mask(&["#....#"]), mask(&["#.#..."]));
        let ignored = vec![[0, 2, 1, 1].into()];
        let options = CompareOptions { ignored, ..CompareOptions::default() };
        let measures = compare_with(&a, &b, &options).unwrap().measures.coverage.unwrap();
        let expected = BorderDistance { pixels: 3.0, at: [0, 5] };
        assert_eq!(measures.largest_border_distance, Some(expected));
        assert_eq!((measures.differing_pixels, measures.intersection_over_union), (1, Some(0.5)));
    }
}
