//! The lines that bound what a step tests, to draw over the picture of that step. They are rounded, and decide nothing.

use crate::common::View;
use crate::common::glam::Vec3;
use crate::figure::{Projector, corners_of_box};

/// Lines on the raster: the column and the row of each point, in pixels from the top left of the image.
pub type Lines = Vec<Vec<[f64; 2]>>;

/// The edges of a triangle, the outline of a sphere, the horizon of a plane. Nothing behind the eye is part of them.
///
/// # Panics
///
/// If the scene has no primitive of this id.
///
/// ```
/// use bothways_lab::common::{Camera, View};
/// use bothways_lab::film;
///
/// let loaded = bothways_lab::scenes::load("canonical")?;
/// let camera = Camera::new(loaded.camera)?;
/// assert_eq!(film::outline(&View::new(&loaded.scene, &camera), 0).len(), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn outline(view: &View, id: u32) -> Lines {
    Projector { camera: view.camera }.outline(&view.primitive(id.into()))
}

/// The edges of a box of the world, from its least to its greatest corner, as
/// [`Prepared::boxes`](crate::raytrace::fast::Prepared::boxes) gives them.
pub fn outline_of_box(view: &View, bounds: [Vec3; 2]) -> Lines {
    Projector { camera: view.camera }.edges_of_box(&corners_of_box(view, bounds))
}
