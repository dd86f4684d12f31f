//! A scene of instances shows what the same scene with copied vertices shows.

use bothways_common::engine::simd::levels;
use bothways_common::{Frame, Options, Scene, View, Work};
use bothways_raytrace::{fast, textbook};
use bothways_test_support::hostile::{self, Numbers, copied};
use bothways_test_support::{CROWDS, assert_same_visibility, crowd};

fn render(scene: &Scene, view: &View, options: &Options) -> Frame {
    fast::render(&fast::prepare(scene), &View::new(scene, view.camera), options)
}

fn check(numbers: Numbers, count: u32) {
    hostile::for_each_of(numbers, hostile::instances(numbers), count, |view, options| {
        let copies = copied(view.scene);
        let expected = textbook::render(&View::new(&copies, view.camera), options);
        let instanced = textbook::render(view, options);
        assert_same_visibility(&expected, &instanced, "the textbook's instances");
        assert_same_visibility(&expected, &render(view.scene, view, options), "instances");
        assert_same_visibility(&expected, &render(&copies, view, options), "copies");
    });
}

#[test]
fn instances_of_few_bits() {
    check(Numbers::FewBits, 600);
}

#[test]
fn instances_of_ordinary_numbers() {
    check(Numbers::Ordinary, 300);
}

#[test]
fn instances_of_extreme_numbers() {
    check(Numbers::Extreme, 300);
}

#[test]
fn every_level_tile_and_observer_sees_the_same_instances() {
    hostile::for_each_of(
        Numbers::Ordinary,
        hostile::instances(Numbers::Ordinary),
        40,
        |view, options| {
            let expected = render(view.scene, view, options);
            for level in levels() {
                let prepared = fast::prepare(view.scene).drawn_with(level, 16);
                let frame = fast::render(&prepared, view, options);
                assert_same_visibility(&expected, &frame, "other tiles");
            }
            let (mut frame, mut work) = (Frame::new(view.camera, options), Work::default());
            let prepared = fast::prepare(view.scene);
            fast::determine_visibility(&prepared, view, options, &mut frame, &mut work);
            assert_same_visibility(&expected, &frame, "a watched frame");
            assert_eq!(work.rays, expected.ids().len() as u64);
        },
    );
}

#[test]
fn a_crowd_of_large_meshes_is_that_of_its_copies() {
    for seed in 0..CROWDS {
        let (scene, camera, options) = crowd(seed);
        let (view, copies) = (View::new(&scene, &camera), copied(&scene));
        let expected = render(&copies, &view, &options);
        let frame = render(&scene, &view, &options);
        assert_same_visibility(&expected, &frame, &format!("crowd {seed}"));
        let seen = frame.ids().iter().filter(|&&id| id < scene.primitive_count()).count();
        assert!(seen * 50 > frame.ids().len(), "crowd {seed} shows {seen} samples");
    }
}
