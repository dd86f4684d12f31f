//! The fast ray tracer sees what its textbook sees in random scenes that are meant to hurt.
//!
//! All four renderers together meet more of them in the root package's `contract`.

use bothways_raytrace::{fast, textbook};
use bothways_test_support::assert_same_visibility;
use bothways_test_support::hostile::{self, Numbers};

fn check(numbers: Numbers, count: u32) {
    hostile::for_each(numbers, count, |view, options| {
        let expected = textbook::render(view, options);
        let frame = fast::render(&fast::prepare(view.scene), view, options);
        assert_same_visibility(&expected, &frame, "a hostile scene");
    });
}

#[test]
fn scenes_of_few_bits() {
    check(Numbers::FewBits, 1000);
}

#[test]
fn scenes_of_ordinary_numbers() {
    check(Numbers::Ordinary, 300);
}

#[test]
fn scenes_of_extreme_numbers() {
    check(Numbers::Extreme, 400);
}
