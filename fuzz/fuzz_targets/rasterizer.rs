//! The fast rasterizer gives the same picture as its textbook, at any SIMD level, in tiles of any size.
#![no_main]

use bothways_common::{Frame, View};
use bothways_fuzz::{check, on_one_thread};
use bothways_rasterize::{fast, textbook};
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    init: on_one_thread(),
    |bytes: &[u8]| check(bytes, textbook::determine_visibility, |case, level| {
        let prepared = fast::prepare(&case.scene).drawn_with(level, case.tile);
        let options = case.options;
        move |view: &View, frame: &mut Frame| {
            fast::determine_visibility(&prepared, view, &options, frame, &mut ());
        }
    })
);
