//! Image order without the work that cannot matter.
//!
//! ```text
//! once for a scene                      a hierarchy of boxes around the primitives         (build)
//! for each sample                       tile by tile, so that neighbours share the cache
//!     for each primitive its ray may hit    nodes near to far, none beyond the hit          (walk)
//!         if it covers the sample           edge functions of the ray                       (leaf)
//!             keep the nearest              distance as an interval that holds the true one
//! ```
//!
//! Rounded arithmetic decides wherever its bound says that the sign is certain; the rest goes to the
//! exact judge. Boxes are dropped only when the ray certainly misses them or they are certainly
//! farther than what was hit.

mod build;
mod leaf;
mod walk;

use bothways_common::fault::{Fault, Planted, Sound};
use bothways_common::frame::{NO_PRIMITIVE, Tile, stored_t};
use bothways_common::observe::{Observer, Sample};
use bothways_common::{Frame, Options, Scene, View};
use rayon::prelude::*;
use walk::Walker;

pub use build::Prepared;

/// Samples along one side of a tile.
const TILE: usize = 32;

/// Prepares a scene for any number of views of it: builds the hierarchy of boxes.
///
/// Runs on the rayon pool that it is called in; the number of threads does not change the hierarchy.
pub fn prepare(scene: &Scene) -> Prepared {
    build::build(scene)
}

/// Renders a view of a prepared scene: what is seen at every sample, and its look.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared.
///
/// ```
/// use bothways_raytrace::common::{Camera, Options, Scene, Shape, Sphere, View, glam::Vec3};
/// use bothways_raytrace::fast;
///
/// let ball = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 });
/// let scene = Scene::new(vec![ball.into()])?;
/// let camera = Camera::canonical(5, 5);
/// let prepared = fast::prepare(&scene);
/// let frame = fast::render(&prepared, &View::new(&scene, &camera), &Options::default());
/// assert_eq!(frame.id(2, 2), Some(0));
/// assert_eq!(frame.t(2, 2), Some(3.0));
/// assert_eq!(frame.id(0, 0), None);
/// # Ok::<(), bothways_raytrace::common::SceneError>(())
/// ```
pub fn render(prepared: &Prepared, view: &View, options: &Options) -> Frame {
    let mut frame = Frame::new(view.camera, options);
    determine_visibility(prepared, view, options, &mut frame, &mut ());
    crate::shade(view, &mut frame);
    frame
}

/// Finds the primitive that is seen at every sample, and how far it is.
///
/// Runs on the rayon pool that it is called in; the number of threads changes no bit of the frame and
/// nothing that the observer is told.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared.
pub fn determine_visibility(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut impl Observer,
) {
    determine_visibility_with_fault(prepared, view, options, frame, observer, Sound);
}

/// [`determine_visibility`] with a fault in it, for tests of the verdict.
#[doc(hidden)]
pub fn determine_visibility_with_fault<O: Observer, F: Fault>(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut O,
    _fault: F,
) {
    assert_eq!(prepared.primitives, view.scene.primitive_count(), "another scene was prepared");
    frame.fit(view.camera, options);
    let grid = view.camera.sample_grid(options.samples);

    let (seen, tiles): (&O, Vec<Tile>) = (observer, frame.tiles_mut(TILE, TILE));
    let dropped = F::is(Planted::DroppedTile).then_some(tiles.len() / 2);
    let parts: Vec<O> = tiles
        .into_par_iter()
        .enumerate()
        .map_init(
            || Walker::new(prepared, view),
            |walker, (index, tile)| {
                let mut observer = seen.fork();
                let lines = tile.ids.into_iter().zip(tile.t);
                for (row, (ids, t)) in tile.region.rows.zip(lines) {
                    let line = ids.iter_mut().zip(t.iter_mut());
                    for (column, (id, t)) in tile.region.columns.clone().zip(line) {
                        let sample = Sample { row, column };
                        let ray = grid.ray(row, column);
                        let hit = if dropped == Some(index) {
                            None
                        } else {
                            walker.first_hit::<O, F>(&ray, sample, &mut observer)
                        };
                        (*id, *t) = match hit {
                            Some(hit) => (hit.id, stored_t(walker.t(&hit, &ray))),
                            None => (NO_PRIMITIVE, f32::INFINITY),
                        };
                    }
                }
                observer
            },
        )
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));
}
