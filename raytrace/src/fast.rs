//! Image order without the work that cannot matter.
//!
//! ```text
//! once for a scene                      a hierarchy of boxes around the primitives     (build, tree)
//! for each sample                       a tile of them at a time, their rays as one map        (rays)
//!     for each primitive its ray may hit    boxes near to far, none beyond the hits   (walk, sieve)
//!         if it covers the sample           edge functions, eight triangles at once     (setup, draw)
//!             keep the nearest              keys as intervals that hold the true ones           (tile)
//! ```
//!
//! Spheres and planes go ray by ray (`round`, `leaf`). Rounded arithmetic decides wherever its bound says
//! that the sign is certain; the rest goes to the exact judge. Boxes, and triangles before they are set up, are
//! dropped only when all rays of the tile certainly miss them or they are certainly farther than what all rays
//! hit: to find that out, `f32` is enough (`rough`, `anchor`). Edges through samples need no judge where corners lie on
//! quarters of samples (`aligned`).
//!
//! For an observer each ray walks alone as well, as a tile of one: so what is told belongs to the ray, and
//! depends on nothing else. The frame is that of the tiles, watched or not.

mod aligned;
mod anchor;
mod any_ray;
mod ball;
mod build;
mod corners;
mod draw;
mod leaf;
mod precise;
mod rays;
mod rough;
mod round;
mod setup;
mod sieve;
mod tile;
mod tree;
mod walk;

use bothways_common::engine::fault::{Fault, Planted, Sound};
use bothways_common::engine::simd::{Level, dispatch_with};
use bothways_common::frame::{NO_PRIMITIVE, Tile};
use bothways_common::observe::{Events, Observer};
use bothways_common::{Frame, Options, Scene, View};
use rayon::prelude::*;
use rays::{LensKind, Rays};
use std::ops::Range;
use walk::Walker;

pub use any_ray::{Hit, WorldRay, first_hit};
pub use build::Prepared;

/// Samples along one side of a tile.
const SIDE: usize = 32;
/// Columns of samples that one thread takes up at a time.
const SHARE: usize = 512;

/// Prepares a scene for any number of views of it: builds the hierarchy of boxes.
///
/// Runs on the rayon pool that it is called in; the number of threads does not change the hierarchy.
pub fn prepare(scene: &Scene) -> Prepared {
    build::build(scene, SIDE)
}

impl Prepared {
    /// The same, traced at another level of SIMD and in tiles of 16 × 16 or 32 × 32 samples: for tests,
    /// which see that neither changes a bit.
    ///
    /// # Panics
    ///
    /// If `side` is another number.
    #[doc(hidden)]
    #[must_use]
    pub fn drawn_with(self, level: Level, side: usize) -> Prepared {
        assert!([16, 32].contains(&side), "tiles have 16 or 32 samples a side, not {side}");
        Prepared { level, side, ..self }
    }
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
    run(prepared, view, options, frame, observer, &SOUND);
}

/// [`determine_visibility`] with faults in it, for tests of the verdict.
#[doc(hidden)]
pub fn determine_visibility_with_fault<F: Fault>(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    _fault: F,
) {
    run(prepared, view, options, frame, &mut (), &const { Loops::new::<F>() });
}

/// The loops, sound or with faults in them. So [`run`], which is compiled for each observer, is not what takes
/// long to compile.
struct Loops {
    is: fn(Planted) -> bool,
    watch: fn(&mut Walker, &LensKind, &Tile, &mut dyn Events),
    trace: fn(&mut Walker, &LensKind, Tile),
}

static SOUND: Loops = Loops::new::<Sound>();

impl Loops {
    const fn new<F: Fault>() -> Loops {
        Loops { is: F::is, watch: watch::<F>, trace: trace::<F> }
    }
}

fn run<O: Observer>(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut O,
    loops: &Loops,
) {
    assert_eq!(prepared.primitives, view.scene.primitive_count(), "another scene was prepared");
    frame.fit(view.camera, options);
    let rays = Rays::new(view, options.samples, walk::reach(prepared, view));
    // A box's last place matters to a ray alone: a fault there shows in tiles of one.
    let side = if (loops.is)(Planted::ShrunkBox) { 1 } else { prepared.side };
    let (mut kind, mut kind_of_one) = (rays.lens_kind(side), rays.lens_kind(1));
    if (loops.is)(Planted::InfiniteMargin) {
        kind.distrust();
        kind_of_one.distrust();
    }

    let (seen, shares): (&O, Vec<Tile>) = (observer, frame.tiles_mut(prepared.side, SHARE));
    let dropped = (loops.is)(Planted::DroppedTile).then_some(shares.len() / 2);
    let parts: Vec<O> = shares
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .map_init(
            || Walker::new(prepared, &rays),
            |walker, (index, share)| {
                let mut observer = seen.fork();
                if dropped == Some(index) {
                    let Tile { ids, t, .. } = share;
                    ids.into_iter().for_each(|ids| ids.fill(NO_PRIMITIVE));
                    t.into_iter().for_each(|t| t.fill(f32::INFINITY));
                } else {
                    if let Some(watcher) = observer.sink() {
                        (loops.watch)(walker, &kind_of_one, &share, watcher);
                    }
                    (loops.trace)(walker, &kind, share);
                }
                observer
            },
        )
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));
}

/// Walks each ray of a share of the picture alone, for an observer, until that has enough.
fn watch<F: Fault>(walker: &mut Walker, kind: &LensKind, share: &Tile, observer: &mut dyn Events) {
    dispatch_with!(F, walker.prepared.level, simd => {
        for row in share.region.rows.clone() {
            for column in share.region.columns.clone() {
                if observer.has_enough() {
                    return;
                }
                walker.walk::<_, dyn Events, F>(simd, kind, [row, column], [1, 1], observer);
            }
        }
    });
}

/// Traces the rays of a share of the picture, tile by tile. Of a tile at the border of a crop all rays are
/// traced, so that the crop shows the bits of the whole picture, and those in the share are stored.
fn trace<F: Fault>(walker: &mut Walker, kind: &LensKind, share: Tile) {
    let Tile { region, mut ids, mut t } = share;
    let (rays, side) = (walker.rays, kind.side);
    let tiles = |range: &Range<usize>| (range.start / side * side..range.end).step_by(side);
    dispatch_with!(F, walker.prepared.level, simd => {
        for top in tiles(&region.rows) {
            for left in tiles(&region.columns) {
                let size =
                    [rays.grid.height() - top, rays.grid.width() - left].map(|s| s.min(side));
                walker.walk::<_, (), F>(simd, kind, [top, left], size, &mut ());
                walker.tile.store(simd, rays, &region, &mut ids, &mut t);
            }
        }
    });
}
