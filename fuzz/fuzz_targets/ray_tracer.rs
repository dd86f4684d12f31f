//! The fast ray tracer gives the same picture as its textbook, at any SIMD level, in tiles of both sizes.
#![no_main]

use bothways_common::{Frame, View};
use bothways_fuzz::{check, on_one_thread};
use bothways_raytrace::{fast, textbook};
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    init: on_one_thread(),
    |bytes: &[u8]| check(bytes, textbook::determine_visibility, |case, level| {
        let side = if case.tile[0] % 2 == 0 { 16 } else { 32 };
        let prepared = fast::prepare(&case.scene).drawn_with(level, side);
        let options = case.options;
        move |view: &View, frame: &mut Frame| {
            fast::determine_visibility(&prepared, view, &options, frame, &mut ());
        }
    })
);
