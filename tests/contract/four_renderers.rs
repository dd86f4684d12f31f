//! The four renderers: the textbook renderer and the fast renderer of each order.

use bothways::common::{Frame, Options, View};
use bothways::{rasterize, raytrace};
use bothways_test_support::{Owners, assert_same_visibility};

pub(crate) type Render = fn(&View, &Options) -> Frame;

/// The name and the function of each renderer.
pub(crate) const RENDERERS: [(&str, Render); 4] = [
    ("object order, textbook", rasterize::textbook::render),
    ("image order, textbook", raytrace::textbook::render),
    ("object order, fast", |view, options| {
        rasterize::fast::render(&rasterize::fast::prepare(view.scene), view, options)
    }),
    ("image order, fast", |view, options| {
        raytrace::fast::render(&raytrace::fast::prepare(view.scene), view, options)
    }),
];

/// Asserts that all four renderers agree in ids and, within the contract's tolerance, in distances; returns the frame
/// of the first.
pub(crate) fn all_agree(view: &View, options: &Options, what: &str) -> Frame {
    let frames = RENDERERS.map(|(name, render)| (name, render(view, options)));
    let (_, expected) = &frames[0];
    for (name, frame) in &frames[1..] {
        assert_same_visibility(expected, frame, &format!("{what}: {name}"));
    }
    frames[0].1.clone()
}

/// The number of primitives that cover each sample, counted by an observer of each renderer.
pub(crate) fn owners(view: &View, options: &Options) -> [(&'static str, Vec<u32>); 4] {
    let mut counts = [(); 4].map(|()| Owners::new(view.camera, options));
    let mut frame = Frame::new(view.camera, options);
    let [a, b, c, d] = &mut counts;
    rasterize::textbook::determine_visibility(view, options, &mut frame, a);
    raytrace::textbook::determine_visibility(view, options, &mut frame, b);
    let prepared = rasterize::fast::prepare(view.scene);
    rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, c);
    let prepared = raytrace::fast::prepare(view.scene);
    raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, d);
    let mut names = RENDERERS.iter().map(|(name, _)| *name);
    counts.map(|owners| (names.next().expect("there are four"), owners.counts))
}
