//! The fast ray tracer sees what its textbook sees, at any SIMD level, in tiles of both sizes.
#![no_main]

use bothways_common::simd::levels;
use bothways_common::{Frame, View};
use bothways_fuzz::{Case, assert_same, on_one_thread};
use bothways_raytrace::{fast, textbook};
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
        let side = if case.tile[0] % 2 == 0 { 16 } else { 32 };
        let prepared = fast::prepare(&case.scene).drawn_with(level, side);
        let mut frame = Frame::new(&case.camera, &case.options);
        let trace = |view: &View, frame: &mut Frame| {
            fast::determine_visibility(&prepared, view, &case.options, frame, &mut ());
        };
        if let Some(before) = &case.before {
            trace(&View::new(&case.scene, before), &mut frame);
        }
        trace(&case.view(), &mut frame);
        assert_same(&case, &expected, &frame);
    }
);
