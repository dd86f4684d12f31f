//! A common interface of the four renderers.

use crate::common::{Frame, Observer, Options, Scene, View};
use crate::{rasterize, raytrace};

/// The common functions of the four renderers.
pub(super) trait Renderer {
    type Prepared;
    fn prepare(scene: &Scene) -> Self::Prepared;
    fn determine_visibility(
        prepared: &Self::Prepared,
        view: &View,
        options: &Options,
        frame: &mut Frame,
        observer: &mut impl Observer,
    );
    fn shade(view: &View, frame: &mut Frame);
}

macro_rules! renderer {
    ($name:ident: fast $order:ident) => {
        pub(super) struct $name;

        impl Renderer for $name {
            type Prepared = $order::fast::Prepared;

            fn prepare(scene: &Scene) -> Self::Prepared {
                $order::fast::prepare(scene)
            }

            fn determine_visibility(
                prepared: &Self::Prepared,
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) {
                $order::fast::determine_visibility(prepared, view, options, frame, observer);
            }

            fn shade(view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
    ($name:ident: textbook $order:ident) => {
        pub(super) struct $name;

        impl Renderer for $name {
            type Prepared = ();

            fn prepare(_scene: &Scene) {}

            fn determine_visibility(
                (): &(),
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) {
                $order::textbook::determine_visibility(view, options, frame, observer);
            }

            fn shade(view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
}

renderer! { FastRasterizer: fast rasterize }
renderer! { TextbookRasterizer: textbook rasterize }
renderer! { FastRayTracer: fast raytrace }
renderer! { TextbookRayTracer: textbook raytrace }
