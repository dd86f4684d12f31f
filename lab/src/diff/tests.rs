//! Frames that differ in one known way, and the result of their comparison.

use super::*;
use crate::common::{Camera, Frame, Options};
use crate::picture::picture;

/// A frame drawn by hand: a digit for the primitive of each sample, `.` for nothing; all primitives at depth 1.
fn frame(samples: u32, rows: &[&str]) -> Frame {
    let side = |length: usize| u32::try_from(length).unwrap() / samples;
    let camera = Camera::canonical(side(rows.len()), side(rows[0].len()));
    let mut frame = Frame::new(&camera, &Options { samples, ..Options::default() });
    for (row, text) in rows.iter().enumerate() {
        for (column, letter) in text.chars().enumerate() {
            if let Some(id) = letter.to_digit(10) {
                frame.set(row, column, id.into(), 1.0);
            }
        }
    }
    frame
}

#[test]
fn equal_frames_match() {
    let drawn = frame(1, &["01.", "1.."]);
    let comparison = compare(&drawn, &drawn.clone());
    assert!(comparison.matches());
    assert_eq!(comparison.coverage.both, 3);
    assert_eq!(
        comparison.verdict(),
        "match: both orders cover the same 3 samples and see the same primitive in each"
    );
}

#[test]
fn an_empty_match_says_so() {
    let nothing = frame(1, &[".."]);
    assert_eq!(
        compare(&nothing, &nothing.clone()).verdict(),
        "match: neither order covers any sample"
    );
}

#[test]
fn coverage_counts_samples_on_each_side() {
    let comparison = compare(&frame(1, &["00.", "1.2"]), &frame(1, &["0.3", "1.2"]));
    let expected = Coverage {
        object_order: 4,
        image_order: 4,
        both: 3,
        only_object_order: 1,
        only_image_order: 1,
        matches: false,
    };
    assert_eq!(comparison.coverage, expected);
    assert_eq!(comparison.visible.first_differing, [[0, 1], [0, 2]]);
    assert_eq!(
        comparison.verdict(),
        "differ: the orders see different primitives in 2 pixels, first at (0, 1); \
         2 samples are covered by one of them only"
    );
}

#[test]
fn another_primitive_differs_though_coverage_matches() {
    let comparison = compare(&frame(1, &["0."]), &frame(1, &["1."]));
    assert!(comparison.coverage.matches);
    assert!(!comparison.matches());
    assert_eq!(comparison.visible.differing_pixels, 1);
    assert_eq!(comparison.depth.max_relative_difference, 0.0);
}

#[test]
fn a_pixel_differs_if_one_of_its_samples_does() {
    let comparison = compare(&frame(2, &["0011", "0011"]), &frame(2, &["0011", "001."]));
    assert_eq!(comparison.coverage.only_object_order, 1);
    assert_eq!(comparison.visible.first_differing, [[0, 1]]);
}

#[test]
fn at_most_ten_pixels_are_named_row_by_row() {
    let (rows, empty) = (["000000"; 3], ["......"; 3]);
    let visible = compare(&frame(1, &rows), &frame(1, &empty)).visible;
    assert_eq!(visible.differing_pixels, 18);
    assert_eq!(visible.first_differing.len(), 10);
    assert_eq!(visible.first_differing[9], [1, 3]);
}

#[test]
fn depth_is_reported_and_does_not_decide() {
    let (object_order, mut image_order) = (frame(1, &["000"]), frame(1, &["000"]));
    image_order.set(0, 1, 0, 1.0 + 5e-6);
    image_order.set(0, 2, 0, 2.0);
    let comparison = compare(&object_order, &image_order);
    assert!(comparison.matches());
    assert_eq!(comparison.depth, Depth { max_relative_difference: 0.5, differing_pixels: 1 });
}

#[test]
fn color_is_reported_and_does_not_decide() {
    let (object_order, mut image_order) = (frame(1, &["00"]), frame(1, &["00"]));
    image_order.shading_bands(1)[0].picture[1] = [0, 255, 0];
    let comparison = compare(&object_order, &image_order);
    assert!(comparison.matches());
    assert_eq!(comparison.color, Color { max_difference: 255, differing_pixels: 1 });
}

#[test]
#[should_panic(expected = "the frames show different views")]
fn frames_of_other_sizes_are_a_mistake() {
    compare(&frame(1, &["00"]), &frame(1, &["0"]));
}

#[test]
fn the_worst_class_of_a_pixel_wins() {
    let object_order = frame(2, &["00110...", "00112..."]);
    let image_order = frame(2, &["00010.2.", "0011.1.."]);
    let comparison = compare(&object_order, &image_order);
    let classes = comparison.classes();
    use Class::{Alike, OnlyImageOrder, OnlyObjectOrder, OtherPrimitive};
    let drawn: Vec<_> = (0..4).map(|j| classes.at(0, j)).collect();
    assert_eq!(drawn, [Alike, OtherPrimitive, OnlyObjectOrder, OnlyImageOrder]);
}

#[test]
fn the_difference_image_has_the_stated_colors() {
    let object_order = frame(1, &["0.00."]);
    let image_order = frame(1, &[".010."]);
    let comparison = compare(&object_order, &image_order);
    let classes = comparison.classes();
    let picture = classes.picture(&picture(&object_order));
    let colors: Vec<_> = picture.pixels().map(|pixel| pixel.0).collect();
    assert_eq!(colors[0], [0xe6, 0x9f, 0x00]);
    assert_eq!(colors[1], [0x00, 0x72, 0xb2]);
    assert_eq!(colors[2], [0xcc, 0x79, 0xa7]);
    assert!(colors[3][0] > 30 && colors[3][0] == colors[3][1]);
    assert!(colors[4].iter().all(|&channel| channel < 16));
}
