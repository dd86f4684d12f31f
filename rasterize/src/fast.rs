//! Object order without the work that cannot matter.
//!
//! ```text
//! for each primitive                    vertex stage, bounding region, bins       (screen, bins)
//!     for each sample it may affect     tile by tile, so that a z-buffer stays in cache    (tile)
//!         if it covers the sample       edge functions, affine on the viewport            (edges)
//!             keep the nearest          depth as an interval that holds the true one      (depth)
//! ```
//!
//! Rounded arithmetic decides wherever its bound says that the sign is certain; the rest goes to the
//! exact judge. The loop over primitives decides visibility: no ray is walked, and no tree.

mod bins;
mod clip;
mod depth;
mod edges;
mod round;
mod screen;
mod tile;

use bins::Bins;
use bothways_common::fault::{Fault, Planted, Sound};
use bothways_common::frame::Tile;
use bothways_common::observe::Observer;
use bothways_common::{Frame, Options, Scene, View};
use rayon::prelude::*;
use screen::Screen;
use tile::TileBuffer;

/// Samples along one side of a tile: its depth intervals and ids fill 80 KiB.
const TILE: usize = 64;
/// Primitives that one thread takes up at a time.
const BATCH: u32 = 4096;

/// What a moving camera would not repeat: the scene cut into batches that threads can share.
#[derive(Clone, Debug)]
pub struct Prepared {
    batches: Vec<Batch>,
    primitives: u32,
}

/// Some consecutive primitives, of one object or of several.
#[derive(Clone, Copy, Debug)]
struct Batch {
    /// The id of the batch's first primitive.
    first_id: u32,
    count: u32,
}

/// Prepares a scene for any number of views of it.
pub fn prepare(scene: &Scene) -> Prepared {
    let primitives = scene.primitive_count();
    let first_ids = (0..primitives).step_by(BATCH as usize);
    let batch = |first_id| Batch { first_id, count: BATCH.min(primitives - first_id) };
    Prepared { batches: first_ids.map(batch).collect(), primitives }
}

/// Renders a view of a prepared scene: what is seen at every sample, and its look.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared.
///
/// ```
/// use bothways_rasterize::common::{Camera, Options, Scene, Shape, Sphere, View, glam::Vec3};
/// use bothways_rasterize::fast;
///
/// let ball = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 });
/// let scene = Scene::new(vec![ball.into()])?;
/// let camera = Camera::canonical(5, 5);
/// let prepared = fast::prepare(&scene);
/// let frame = fast::render(&prepared, &View::new(&scene, &camera), &Options::default());
/// assert_eq!(frame.id(2, 2), Some(0));
/// assert_eq!(frame.t(2, 2), Some(3.0));
/// assert_eq!(frame.id(0, 0), None);
/// # Ok::<(), bothways_rasterize::common::SceneError>(())
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
    let screen = Screen::new(view.camera, &grid);
    let bins = Bins::fill::<O, F>(&prepared.batches, view, &screen, observer);

    let (seen, tiles): (&O, Vec<Tile>) = (observer, frame.tiles_mut(TILE));
    let dropped = F::is(Planted::DroppedTile).then_some(tiles.len() / 2);
    let parts: Vec<O> = tiles
        .into_par_iter()
        .enumerate()
        .map_init(
            || TileBuffer::new(view),
            |buffer, (index, tile)| {
                let mut observer = seen.fork();
                buffer.begin(&tile.region);
                if dropped != Some(index) {
                    for entry in bins.of_tile(index) {
                        buffer.draw::<O, F>(entry, view, &screen, &mut observer);
                    }
                }
                buffer.store(view, &screen, tile);
                observer
            },
        )
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));
}
