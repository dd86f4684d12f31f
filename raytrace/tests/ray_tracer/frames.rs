//! What one `Prepared` answers does not depend on what it answered before.

use bothways_raytrace::fast;
use bothways_test_support::repeats::{check_repeats, still_life};

#[test]
fn image_order_starts_every_frame_afresh() {
    let prepared = fast::prepare(&still_life());
    check_repeats(
        &|view, options, frame, work| {
            fast::determine_visibility(&prepared, view, options, frame, work);
        },
        &|view, options, frame, work| {
            let prepared = fast::prepare(view.scene);
            fast::determine_visibility(&prepared, view, options, frame, work);
        },
    );
}
