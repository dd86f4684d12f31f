//! Both fast renderers with faults that tests plant in them.
//!
//! They are a package of their own so that they are optimised like the renderers without faults, while the tests
//! are compiled quickly: vector code that is not optimised overflows the stack.

use bothways_common::engine::fault::Faulty;
use bothways_common::{Frame, Options, View};
use bothways_rasterize::fast as object_order;
use bothways_raytrace::fast as image_order;

/// Object order with the fault that [`with`](bothways_common::engine::fault::with) plants, if any.
///
/// # Panics
///
/// Where [`object_order::determine_visibility`] does.
pub fn rasterize(
    prepared: &object_order::Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
) {
    object_order::determine_visibility_with_fault(prepared, view, options, frame, Faulty);
}

/// Image order with the fault that [`with`](bothways_common::engine::fault::with) plants, if any.
///
/// # Panics
///
/// Where [`image_order::determine_visibility`] does.
pub fn raytrace(
    prepared: &image_order::Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
) {
    image_order::determine_visibility_with_fault(prepared, view, options, frame, Faulty);
}
