//! A common interface of the four renderers, and of the ordinary ones of the rules.

use crate::common::{Executed, Frame, Observer, Options, Scene, View};
use crate::rules::{image_order, object_order};
use crate::{rasterize, raytrace};

/// The common functions of all renderers.
pub(super) trait Renderer {
    type Prepared;
    fn prepare(&self, scene: &Scene) -> Self::Prepared;
    /// Cuts the frames to come for so many threads. Whether that makes a difference.
    fn cut_for_threads(&self, _prepared: &mut Self::Prepared, _threads: usize) -> bool {
        false
    }
    /// Finds the visible primitives. A fast renderer returns what it executed.
    fn determine_visibility(
        &self,
        prepared: &Self::Prepared,
        view: &View,
        options: &Options,
        frame: &mut Frame,
        observer: &mut impl Observer,
    ) -> Option<Executed>;
    fn shade(&self, view: &View, frame: &mut Frame);
}

macro_rules! renderer {
    ($name:ident: fast $order:ident) => {
        pub(super) struct $name;

        impl Renderer for $name {
            type Prepared = $order::fast::Prepared;

            fn prepare(&self, scene: &Scene) -> Self::Prepared {
                $order::fast::prepare(scene)
            }

            fn cut_for_threads(&self, prepared: &mut Self::Prepared, threads: usize) -> bool {
                prepared.cut_for_threads(threads);
                true
            }

            fn determine_visibility(
                &self,
                prepared: &Self::Prepared,
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) -> Option<Executed> {
                let executed =
                    $order::fast::determine_visibility(prepared, view, options, frame, observer);
                Some(executed)
            }

            fn shade(&self, view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
    ($name:ident: textbook $order:ident) => {
        pub(super) struct $name;

        impl Renderer for $name {
            type Prepared = ();

            fn prepare(&self, _scene: &Scene) {}

            fn determine_visibility(
                &self,
                (): &(),
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) -> Option<Executed> {
                $order::textbook::determine_visibility(view, options, frame, observer);
                None
            }

            fn shade(&self, view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
}

renderer! { FastRasterizer: fast rasterize }
renderer! { TextbookRasterizer: textbook rasterize }
renderer! { FastRayTracer: fast raytrace }
renderer! { TextbookRayTracer: textbook raytrace }

/// An ordinary rasterizer. It tells nothing to observers.
pub(super) struct OrdinaryRasterizer(pub(super) object_order::Rule);

impl Renderer for OrdinaryRasterizer {
    type Prepared = ();

    fn prepare(&self, _scene: &Scene) {}

    fn determine_visibility(
        &self,
        (): &(),
        view: &View,
        options: &Options,
        frame: &mut Frame,
        _observer: &mut impl Observer,
    ) -> Option<Executed> {
        object_order::determine_visibility(view, options, self.0, frame);
        None
    }

    fn shade(&self, view: &View, frame: &mut Frame) {
        object_order::shade(view, self.0, frame);
    }
}

/// An ordinary ray tracer. It tells nothing to observers.
pub(super) struct OrdinaryRayTracer(pub(super) image_order::Rule);

impl Renderer for OrdinaryRayTracer {
    type Prepared = image_order::Prepared;

    fn prepare(&self, scene: &Scene) -> image_order::Prepared {
        image_order::prepare(scene)
    }

    fn determine_visibility(
        &self,
        prepared: &image_order::Prepared,
        view: &View,
        options: &Options,
        frame: &mut Frame,
        _observer: &mut impl Observer,
    ) -> Option<Executed> {
        image_order::determine_visibility(prepared, view, options, self.0, frame);
        None
    }

    fn shade(&self, view: &View, frame: &mut Frame) {
        image_order::shade(view, self.0, frame);
    }
}
