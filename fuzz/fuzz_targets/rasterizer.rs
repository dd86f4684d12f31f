//! The fast rasterizer sees what its textbook sees, at any SIMD level, in tiles of any size.
#![no_main]

use bothways_common::simd::levels;
use bothways_common::{Frame, View};
use bothways_fuzz::{Case, assert_same, on_one_thread};
use bothways_rasterize::{fast, textbook};
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    init: on_one_thread(),
    |bytes: &[u8]| {
        let Some(case) = Case::decode(bytes) else {
            return;
        };
        let mut expected = Frame::new(&case.camera, &case.options);
        textbook::determine_visibility(&case.view(), &case.options, &mut expected, &mut ());

        let levels = levels();
        let level = levels[case.level % levels.len()];
        let prepared = fast::prepare(&case.scene).drawn_with(level, case.tile);
        let mut frame = Frame::new(&case.camera, &case.options);
        let draw = |view: &View, frame: &mut Frame| {
            fast::determine_visibility(&prepared, view, &case.options, frame, &mut ());
        };
        if let Some(before) = &case.before {
            draw(&View::new(&case.scene, before), &mut frame);
        }
        draw(&case.view(), &mut frame);
        assert_same(&case, &expected, &frame);
    }
);
