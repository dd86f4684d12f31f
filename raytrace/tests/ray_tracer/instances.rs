//! A scene of instances shows what the same scene with copied vertices shows.

use bothways_common::engine::simd::levels;
use bothways_common::{Frame, Options, Scene, View, Work};
use bothways_raytrace::{fast, textbook};
use bothways_test_support::hostile::{self, Numbers, copied};
use bothways_test_support::{CROWDS, assert_same_visibility, crowd, instances_in_one_place};
use std::collections::BTreeSet;

fn render(scene: &Scene, view: &View, options: &Options) -> Frame {
    let frame = fast::render(&fast::prepare(scene), &View::new(scene, view.camera), options);
    assert!(frame.ids().narrow().is_some());
    let scene = scene.clone().with_wide_ids();
    let wide = fast::render(&fast::prepare(&scene), &View::new(&scene, view.camera), options);
    assert_same_bits(&frame, &wide);
    frame
}

/// A frame of wide ids is that of narrow ones, to the last bit.
fn assert_same_bits(narrow: &Frame, wide: &Frame) {
    assert!(wide.ids().narrow().is_none());
    assert_eq!(narrow.ids(), wide.ids());
    assert_eq!(narrow.distances(), wide.distances());
    assert!(narrow.picture() == wide.picture());
}

fn check(numbers: Numbers, count: u32) {
    hostile::for_each_of(numbers, hostile::instances(numbers), count, |view, options| {
        let copies = copied(view.scene);
        let expected = textbook::render(&View::new(&copies, view.camera), options);
        let instanced = textbook::render(view, options);
        assert_same_visibility(&expected, &instanced, "the textbook's instances");
        let wide = view.scene.clone().with_wide_ids();
        let wide = textbook::render(&View::new(&wide, view.camera), options);
        assert_same_bits(&instanced, &wide);
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
            let (mut wide_frame, mut wide_work) = (frame.clone(), Work::default());
            let wide = view.scene.clone().with_wide_ids();
            let (prepared, view) = (fast::prepare(&wide), View::new(&wide, view.camera));
            let to = &mut wide_frame;
            fast::determine_visibility(&prepared, &view, options, to, &mut wide_work);
            assert_eq!(frame.ids(), wide_frame.ids());
            assert_eq!(frame.distances(), wide_frame.distances());
            assert_eq!(work, wide_work);
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
        let seen = frame.ids().covered();
        assert!(seen * 50 > frame.ids().len(), "crowd {seed} shows {seen} samples");
    }
}

/// Every tile meets more instances than have names at a time; half of them lie where others do.
#[test]
fn names_are_given_anew_where_instances_are_many() {
    let (scene, cameras) = instances_in_one_place();
    for camera in cameras {
        let frame = render(&scene, &View::new(&scene, &camera), &Options::default());
        let seen: BTreeSet<usize> =
            frame.ids().iter().flatten().map(|id| scene.locate(id).0).collect();
        // What ties with an earlier object is seen nowhere.
        assert!(seen.iter().eq([0, 1, 2].iter()), "{seen:?}");
    }
}
