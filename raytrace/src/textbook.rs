//! The lecture's image order, every sample × every primitive:
//!
//! ```text
//! for each pixel in the image {
//!   for each object in the scene {
//!     if (object affects pixel) {
//!       do something
//!     }
//!   }
//! }
//! ```
//!
//! *Affects* is the exact predicate. *Do something* is to keep the nearest primitive so far: one variable is
//! enough for that, because a ray is finished before the next one begins.

use bothways_common::observe::Events;
use bothways_common::raster::Sample;
use bothways_common::{Frame, Options, View};

/// Renders a view: what is seen at every sample, and its look.
///
/// # Panics
///
/// If [`Options::check`] refuses the options for the image.
pub fn render(view: &View, options: &Options) -> Frame {
    let mut frame = Frame::new(view.camera, options);
    determine_visibility(view, options, &mut frame, &mut ());
    crate::shade(view, &mut frame);
    frame
}

/// Finds the primitive that is seen at every sample, and how far it is.
///
/// Fits the frame to the view and writes ids and `t`s into it; [`shade`](fn@crate::shade) gives it its colours.
///
/// # Panics
///
/// If [`Options::check`] refuses the options for the image.
pub fn determine_visibility(
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut dyn Events,
) {
    frame.fit(view, options);
    frame.clear();
    let judge = view.judge();
    let grid = view.camera.sample_grid(options.samples);
    let picture = frame.region().clone();

    for row in picture.rows {
        for column in picture.columns.clone() {
            let sample = Sample { row, column };
            let ray = grid.ray(row, column);
            observer.ray_begun(sample);
            let mut nearest = None;
            for (id, primitive) in view.primitives() {
                observer.sample_tested(sample, id);
                let test = judge.test(&primitive, &ray);
                if let Some(signs) = test.edge_signs {
                    observer.edge_signs(sample, id, signs.map(Some));
                }
                if !test.covers {
                    continue;
                }
                observer.fragment(sample, id);
                if let Some((stored, held)) = nearest {
                    let nearer = judge.nearer((id, &primitive), (stored, &held), &ray);
                    observer.depth_test(sample, id, stored, nearer);
                    if !nearer {
                        continue;
                    }
                }
                nearest = Some((id, primitive));
            }
            observer.hit(sample, nearest.map(|(id, _)| id));
            if let Some((id, primitive)) = nearest {
                frame.set(row, column, id, judge.distance(&primitive, &ray));
            }
        }
    }
}
