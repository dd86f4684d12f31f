//! The scene without its endless planes, for an observer beside the camera.

use bothways_lab::common::{Camera, Frame, Options, Scene, SceneError, Shape};
use bothways_lab::rasterize;

/// What an observer of the stage needs, kept from one picture to the next.
#[derive(Debug)]
pub(crate) struct Observed {
    /// The scene without its planes, and what object order prepared of it, if the scene has planes.
    pub(crate) bounded: Option<(Scene, rasterize::fast::Prepared)>,
    pub(crate) frame: Frame,
}

impl Observed {
    /// Leaves the planes out.
    ///
    /// # Errors
    ///
    /// A scene that is refused, which the rest of an open scene is not.
    pub(crate) fn new(scene: &Scene, camera: &Camera) -> Result<Observed, SceneError> {
        let is_plane = |shape: &Shape| matches!(shape, Shape::Plane(_));
        let objects = scene.objects();
        let bounded = if objects.iter().any(|object| is_plane(&object.shape)) {
            let rest = objects.iter().filter(|object| !is_plane(&object.shape));
            let mut bounded = Scene::new(rest.cloned().collect())?;
            bounded.lights.clone_from(&scene.lights);
            bounded.background = scene.background;
            let prepared = rasterize::fast::prepare(&bounded);
            Some((bounded, prepared))
        } else {
            None
        };
        Ok(Observed { bounded, frame: Frame::new(camera, &Options::default()) })
    }
}
