//! Tolerances, allowed pixels and ignored pixels.

use super::*;
use crate::common::Crop;

fn ignoring(rectangles: &[[u32; 4]]) -> CompareOptions {
    let ignored = rectangles.iter().map(|&rectangle| Crop::from(rectangle)).collect();
    CompareOptions { ignored, ..CompareOptions::default() }
}

#[test]
fn a_tolerance_is_the_largest_difference_that_is_equal() {
    let (a, b) = (distances(&[1.0, 4.0]), distances(&[1.0, 3.0]));
    let differing = |t: f64| {
        let tolerances = Tolerances { t, ..Tolerances::default() };
        let options = CompareOptions { tolerances, ..CompareOptions::default() };
        let comparison = compare_with(&a, &b, &options).unwrap();
        assert_eq!(comparison.depth.unwrap().differing_pixels, comparison.differing_pixels);
        comparison.differing_pixels
    };
    assert_eq!([0.0, 0.249, 0.25, 1.0].map(differing), [1, 1, 0, 0]);
    assert!(compare(&a, &a).unwrap().equal);

    let (a, b) = (colors(&[[9.0; 4]], Covered::Unknown), colors(&[[5.0; 4]], Covered::Unknown));
    let differing = |color: f32| {
        let tolerances = Tolerances { color, ..Tolerances::default() };
        let options = CompareOptions { tolerances, ..CompareOptions::default() };
        compare_with(&a, &b, &options).unwrap().color.unwrap().differing_pixels
    };
    assert_eq!([0.0, 3.5, 4.0].map(differing), [1, 1, 0]);
}

#[test]
fn no_tolerance_touches_coverage_and_ids() {
    let tolerances = Tolerances { t: 1e9, normals: 360.0, color: 1e9 };
    let options = CompareOptions { tolerances, ..CompareOptions::default() };
    let (a, b) = (ids([3, 1], "01."), ids([3, 1], "020"));
    assert_eq!(compare_with(&a, &b, &options).unwrap().differing_pixels, 2);
}

#[test]
fn some_pixels_may_be_allowed_to_differ() {
    let (a, b) = (ids([3, 1], "01."), ids([3, 1], "020"));
    let passes = |allowed_pixels| {
        let options = CompareOptions { allowed_pixels, ..CompareOptions::default() };
        let comparison = compare_with(&a, &b, &options).unwrap();
        assert_eq!((comparison.equal, comparison.allowed_pixels), (false, allowed_pixels));
        comparison.passes
    };
    assert_eq!([0, 1, 2, 9].map(passes), [false, false, true, true]);
}

#[test]
fn ignored_pixels_count_nowhere_and_have_a_color_of_their_own() {
    let (a, b) = (ids([4, 2], "01.22..."), ids([4, 2], "02.1211."));
    // The second and the third column, and one pixel of them again.
    let comparison = compare_with(&a, &b, &ignoring(&[[0, 1, 2, 2], [1, 1, 1, 1]])).unwrap();
    assert_eq!((comparison.ignored_pixels, comparison.differing_pixels), (4, 1));
    assert_eq!(comparison.first_differing, [[0, 3]]);
    let coverage = comparison.coverage.unwrap();
    assert_eq!((coverage.both, coverage.only_a, coverage.only_b), (3, 0, 0));
    assert_eq!(comparison.ids.unwrap().differing_samples, 1);
    let picture = comparison.picture();
    let green = |pixel: &image::Rgb<u8>| pixel.0 == Class::Ignored.color();
    assert_eq!(picture.pixels().filter(|&pixel| green(pixel)).count(), 4);
    assert!(green(&picture[(1, 0)]) && green(&picture[(2, 1)]));

    assert!(compare_with(&a, &b, &ignoring(&[[0, 1, 2, 3]])).unwrap().equal);
}

#[test]
fn rectangles_to_ignore_lie_in_the_image() {
    let a = ids([4, 2], "01.22...");
    let problem = |rectangles: &[[u32; 4]]| {
        compare_with(&a, &a, &ignoring(rectangles)).unwrap_err().to_string()
    };
    let outside = problem(&[[0, 0, 1, 1], [1, 2, 1, 3]]);
    let said = "--ignore: the rectangle 1,2,1,3 ends at pixel (1, 4), outside of an image of 4x2";
    assert!(outside.starts_with(said), "{outside}");
    assert!(problem(&[[0, 0, 0, 1]]).contains("holds no pixel"));
    assert!(problem(&[[0, 0, 2, 3], [0, 3, 2, 1]]).contains("nothing is left to compare"));
}

#[test]
fn many_rows_give_what_few_give() {
    // Differences in the first and the last of many rows, with equal maxima, and more than are named.
    let rows = |t: &dyn Fn(usize, usize) -> f64| {
        let t = (0..100).flat_map(|i| (0..3).map(move |j| t(i, j)));
        Buffer::new([3, 100], 1, Content::Distances(t.collect()))
    };
    let a = rows(&|_, _| 1.0);
    let b = rows(&|i, j| match (i, j) {
        (20 | 90, 1) => 2.0,
        (95, 2) => f64::INFINITY,
        (30..40, 0) => 1.25,
        _ => 1.0,
    });
    let comparison = compare(&a, &b).unwrap();
    let depth = comparison.depth.unwrap();
    assert_eq!((depth.max_relative_difference, depth.at), (0.5, Some([20, 1])));
    assert_eq!((depth.differing_pixels, comparison.differing_pixels), (12, 13));
    assert_eq!(comparison.region, Some([20, 0, 76, 3]));
    assert_eq!((comparison.first_differing.len(), comparison.first_differing[9]), (10, [38, 0]));
    let coverage = comparison.coverage.unwrap();
    assert_eq!((coverage.both, coverage.only_a), (299, 1));
}
