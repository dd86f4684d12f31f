//! A scene with all that a moving camera would not repeat: what both orders prepared of it, and their frames.

use crate::observer::Observed;
use bothways_lab::common::{Camera, Frame, Observer, Options, View};
use bothways_lab::diff::why::PixelReason;
use bothways_lab::orders::{Order, Rule};
use bothways_lab::rules::{image_order, object_order};
use bothways_lab::scenes::LoadedScene;
use bothways_lab::{rasterize, raytrace};

/// The open scene.
#[derive(Debug)]
pub(crate) struct Stage {
    pub(crate) loaded: LoadedScene,
    /// The camera of the last picture.
    pub(crate) camera: Camera,
    pub(crate) rasterizer: rasterize::fast::Prepared,
    pub(crate) ray_tracer: raytrace::fast::Prepared,
    /// Prepared for the rules of ordinary ray tracers, once one is asked for.
    ordinary: Option<image_order::Prepared>,
    /// The last frames of object order and of image order.
    pub(crate) frames: [Frame; 2],
    /// What the view from outside keeps, once it is shown.
    pub(crate) observed: Option<Observed>,
    /// Why they differ, if that was the last question.
    pub(crate) reasons: Vec<PixelReason>,
}

impl Stage {
    /// Prepares a scene for both orders.
    ///
    /// # Errors
    ///
    /// A camera that is refused.
    pub(crate) fn new(loaded: LoadedScene) -> Result<Stage, String> {
        let camera = Camera::new(loaded.camera).map_err(|error| error.to_string())?;
        let frame = Frame::new(&camera, &Options::default());
        Ok(Stage {
            rasterizer: rasterize::fast::prepare(&loaded.scene),
            ray_tracer: raytrace::fast::prepare(&loaded.scene),
            ordinary: None,
            frames: [frame.clone(), frame],
            observed: None,
            reasons: Vec::new(),
            camera,
            loaded,
        })
    }

    /// The scene from the camera of the last picture.
    pub(crate) fn view(&self) -> View<'_> {
        View::new(&self.loaded.scene, &self.camera)
    }

    /// Finds what is seen in one order, by its exact rules or by the rule of an ordinary renderer, from the camera of the
    /// stage. An ordinary renderer tells the observer nothing.
    pub(crate) fn determine_visibility(
        &mut self,
        order: Order,
        rule: Option<Rule>,
        observer: &mut impl Observer,
    ) {
        let options = &Options::default();
        let Stage { loaded, camera, rasterizer, ray_tracer, ordinary, frames, .. } = self;
        let view = &View::new(&loaded.scene, camera);
        let frame = &mut frames[order as usize];
        match (order, rule) {
            (_, Some(Rule::Object(rule))) => {
                object_order::determine_visibility(view, options, rule, frame);
            }
            (_, Some(Rule::Image(rule))) => {
                let prepared = ordinary.get_or_insert_with(|| image_order::prepare(view.scene));
                image_order::determine_visibility(prepared, view, options, rule, frame);
            }
            (Order::Object, None) => {
                rasterize::fast::determine_visibility(rasterizer, view, options, frame, observer);
            }
            (Order::Image, None) => {
                raytrace::fast::determine_visibility(ray_tracer, view, options, frame, observer);
            }
        }
    }

    /// Gives what is seen its look, as the same renderer does.
    pub(crate) fn shade(&mut self, order: Order, rule: Option<Rule>) {
        let view = &View::new(&self.loaded.scene, &self.camera);
        let frame = &mut self.frames[order as usize];
        match (order, rule) {
            (_, Some(Rule::Object(rule))) => object_order::shade(view, rule, frame),
            (_, Some(Rule::Image(rule))) => image_order::shade(view, rule, frame),
            (Order::Object, None) => rasterize::shade(view, frame),
            (Order::Image, None) => raytrace::shade(view, frame),
        }
    }
}
