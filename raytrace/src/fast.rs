//! Image order without the work that cannot matter.
//!
//! ```text
//! once for a scene                      a hierarchy of boxes around the primitives            (search/build, tree)
//! for each sample                       a tile of them at a time, with one map for its rays           (camera_map)
//!     for each primitive its ray may hit    boxes near to far, none beyond the hits       (search/walk, candidates)
//!         if it covers the sample           edge functions, eight triangles at once          (setup, few_, many_…)
//!             keep the nearest              depth keys as intervals that hold the true ones           (depth, tile)
//! ```
//!
//! Planes, and triangles that eight at a time are not certain of, are set up alone and tested at sixteen samples at once
//! (`one_primitive`), as are spheres (`sphere/blocks`). What these leave open is tested ray by ray in `f64`. Rounded
//! arithmetic decides wherever its bound says that the sign is certain; the exact judge decides the rest. A box is dropped, and a triangle before it is set up,
//! only when all rays of the tile certainly miss it, or when it is certainly farther than what all rays hit. `f32` is
//! enough to find that out (`search/box_culling`, `local_projection`). Edges through samples need no judge where
//! corners lie on quarters of samples (`aligned`).
//!
//! Instances are in a hierarchy of their own. Each mesh that they share has one, in its own coordinates; the rays of a tile
//! are transformed to these coordinates (`search/instance_frustum`).
//!
//! For an observer, each ray is walked alone as well, as a tile of one. So the events belong to the ray, and
//! depend on nothing else. Rays that are only counted share the tests of boxes (`search/ray_square`). The frame is that of the tiles, whether they are watched or not.

mod aligned;
mod answer;
mod any_ray;
mod bounds;
mod camera_map;
mod depth;
mod distances;
mod draw;
mod few_samples;
mod fragments;
mod high_precision;
mod lane_affine;
mod local_errors;
mod local_projection;
mod many_samples;
mod one_primitive;
mod partition;
mod plane;
mod prepared;
mod search;
mod setup;
mod size_class;
mod sphere;
mod store;
mod straight_rays;
mod tile;
mod trace;
mod triangle;
mod viewport_affine;
mod world_affine;

use bothways_common::engine::any_observer::{AnyObserver, PartObserver};
use bothways_common::engine::context::{LoopContext, ScalarContext};
use bothways_common::engine::fault::{Fault, Planted, Sound};
use bothways_common::engine::simd::{best_level, dispatch_with};
use bothways_common::engine::tasks::TaskTimes;
use bothways_common::frame::{Band, IdRows, NO_PRIMITIVE, Tile};
use bothways_common::observe::{Events, Executed, Observer};
use bothways_common::raster::Region;
use bothways_common::{Frame, Options, Scene, View};
use camera_map::CameraMap;
use one_primitive::unbounded::Unbounded;
use rayon::prelude::*;
use search::build::build;
use search::ray_square::{RaySquare, SQUARE};
use search::tile_frustum::FrustumTemplate;
use search::walk::Walker;
use store::store_wide_ids;
use tile::TileBuffer;
use trace::trace_tiles;

pub use any_ray::{Hit, WorldRay, first_hit};
pub use partition::HierarchyBox;
pub use prepared::Prepared;

/// Samples along one side of a tile.
const SIDE: usize = 32;
/// Columns of samples that one thread takes at a time, in a row of tiles, unless there are many threads and few chunks.
const CHUNK: usize = 512;
/// Each thread should get so many chunks, so that all end at about the same time.
const CHUNKS_A_THREAD: usize = 8;

/// Prepares a scene for any number of views of it: builds the hierarchy of boxes.
///
/// Runs on the rayon pool that it is called in; the number of threads does not change the hierarchy.
pub fn prepare(scene: &Scene) -> Prepared {
    build(scene, SIDE, best_level())
}

/// Renders a view of a prepared scene: what is seen at every sample, and its look.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared, as far as the number of primitives tells, or
/// [`Options::check`] refuses the options for the image.
///
/// ```
/// use bothways_raytrace::common::{Camera, Options, Scene, Sphere, View, glam::Vec3};
/// use bothways_raytrace::fast;
///
/// let sphere = Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 };
/// let scene = Scene::new(vec![sphere.into()])?;
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

/// Finds the primitive that is seen at every sample, and how far it is. Returns what was executed for its tiles; the
/// rays that are walked alone for an observer do not count.
///
/// Fits the frame to the view and writes ids and `t`s into it; [`shade`](fn@crate::shade) gives it its colours.
///
/// Runs on the rayon pool that it is called in; the number of threads changes no bit of the frame, no count and no
/// event that the observer gets.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared, as far as the number of primitives tells, or
/// [`Options::check`] refuses the options for the image.
pub fn determine_visibility(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut impl Observer,
) -> Executed {
    run(prepared, view, options, frame, observer, &SOUND)
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

/// The loops over a chunk of the picture, sound or with faults in them. [`run`] calls them through pointers: it is
/// compiled once.
struct Loops {
    is: fn(Planted) -> bool,
    watch: fn(&mut Walker, [&FrustumTemplate; 3], &Tile, &mut dyn Events),
    trace: fn(&mut Walker, &FrustumTemplate, Tile) -> Executed,
}

static SOUND: Loops = Loops::new::<Sound>();

impl Loops {
    const fn new<F: Fault>() -> Loops {
        Loops { is: F::is, watch: watch::<F>, trace: trace::<F> }
    }

    /// What tiles of this size share.
    fn template(&self, map: &CameraMap, side: usize) -> FrustumTemplate {
        let mut template = FrustumTemplate::new(map, side);
        if (self.is)(Planted::InfiniteMargin) {
            template.make_errors_infinite();
        }
        template
    }
}

fn run(
    prepared: &Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut dyn AnyObserver,
    loops: &Loops,
) -> Executed {
    assert_eq!(prepared.primitives, view.scene.primitive_count(), "another scene was prepared");
    frame.fit(view, options);
    let map = CameraMap::new(view, options.samples, &prepared.bounds);
    let unbounded = Unbounded::for_tiles(prepared, &map);
    // A box's last place matters to a ray alone: a fault there shows in tiles of one.
    let side = if (loops.is)(Planted::ShrunkBox) { 1 } else { prepared.side };
    let [of_tile, of_square, of_ray] = [side, SQUARE, 1].map(|side| loops.template(&map, side));

    let times = prepared.times.as_deref();
    let columns = chunk_for_threads(prepared, frame.region());
    let across = frame.region().tiles(usize::MAX, columns).count();
    let mut bands = frame.bands_mut(prepared.side);
    let dropped = (loops.is)(Planted::DroppedTile).then_some(bands.len() * across / 2);
    let mut executed = Executed::default();
    TaskTimes::begin_stage(times);
    observer.in_parts(bands.len() * across, &mut |mut parts| {
        let draw = |(index, (chunk, part)): (_, (Tile, &mut &mut dyn PartObserver))| {
            if dropped == Some(index) {
                drop_chunk(chunk);
                return Executed::default();
            }
            let mut walker = Walker::new(prepared, &map, &unbounded);
            if let Some(sink) = part.sink() {
                (loops.watch)(&mut walker, [&of_tile, &of_square, &of_ray], &chunk, sink);
            }
            (loops.trace)(&mut walker, &of_tile, chunk)
        };
        // A band is cut by the thread that takes it up: a slice for each row of each chunk is too much for one thread.
        let draw_band = |(index, (band, parts)): (usize, (Band, &mut [_]))| -> Executed {
            let chunks = TaskTimes::time(times, || band.tiles_mut(columns));
            let each = chunks.into_par_iter().zip(parts).with_max_len(1).enumerate();
            let numbered = each.map(|(column, chunk)| (index * across + column, chunk));
            numbered.map(|chunk| TaskTimes::time(times, || draw(chunk))).sum()
        };
        let bands = std::mem::take(&mut bands).into_par_iter().zip(parts.par_chunks_mut(across));
        executed = bands.with_max_len(1).enumerate().map(draw_band).sum();
    });
    executed
}

/// The columns of a chunk of a region.
fn chunk_for_threads(prepared: &Prepared, region: &Region) -> usize {
    let wanted = prepared.threads.saturating_mul(CHUNKS_A_THREAD);
    let are_enough = |columns: &usize| region.tiles(prepared.side, *columns).count() >= wanted;
    let sizes = [CHUNK, CHUNK / 2, CHUNK / 4];
    sizes.into_iter().find(are_enough).unwrap_or(sizes[2])
}

/// A fault: nothing is seen in a chunk of the picture.
fn drop_chunk(Tile { mut ids, t, .. }: Tile) {
    ids.clear();
    t.into_iter().for_each(|t| t.fill(f32::INFINITY));
}

/// Walks each ray of a chunk of the picture alone, for an observer, until the observer has enough. For an observer that
/// only counts, rays go through the hierarchy in squares, and those of a tile that certainly meet no box at all are counted
/// without a walk.
fn watch<F: Fault>(
    walker: &mut Walker,
    [of_tile, of_square, of_ray]: [&FrustumTemplate; 3],
    chunk: &Tile,
    sink: &mut dyn Events,
) {
    // A renderer with faults runs without an observer: the code for events is not compiled for it.
    if const { !F::SOUND } {
        return;
    }
    if sink.counts().is_some() {
        count::<F>(walker, [of_tile, of_square, of_ray], &chunk.region, sink);
    } else {
        walk_alone::<F>(walker, of_ray, &chunk.region, sink);
    }
}

/// [`watch`] for an observer that only counts.
fn count<F: Fault>(
    walker: &mut Walker,
    [of_tile, of_square, of_ray]: [&FrustumTemplate; 3],
    region: &Region,
    sink: &mut dyn Events,
) {
    let mut square = RaySquare::new([of_square, of_ray]);
    dispatch_with!(F, walker.prepared.level, simd => {
        let mut context = LoopContext::<_, dyn Events, F>::of(simd, sink);
        for tile in region.tiles(of_tile.side, of_tile.side) {
            let frustum = of_tile.frustum([tile.rows.start, tile.columns.start]);
            let missed = walker.boxes_all_missed(&context, &frustum, of_ray);
            if let (Some(boxes), Some(counts)) = (missed, context.sink().counts()) {
                counts.rays += tile.area() as u64;
                counts.nodes += boxes * tile.area() as u64;
                continue;
            }
            for rays in tile.tiles(SQUARE, SQUARE) {
                if context.sink().has_enough() {
                    return;
                }
                if !walker.walk_square(&mut context, &mut square, &rays) {
                    walk_alone::<F>(walker, of_ray, &rays, context.sink());
                }
            }
        }
    });
}

/// Walks each ray of a region alone, until the observer has enough. It is compiled once: where it is called makes no
/// difference beside the walk.
#[inline(never)]
fn walk_alone<F: Fault>(
    walker: &mut Walker,
    of_ray: &FrustumTemplate,
    region: &Region,
    sink: &mut dyn Events,
) {
    dispatch_with!(F, walker.prepared.level, simd => {
        let mut context = LoopContext::<_, dyn Events, F>::of(simd, sink);
        for row in region.rows.clone() {
            for column in region.columns.clone() {
                if context.sink().has_enough() {
                    return;
                }
                walker.walk(&mut context, of_ray, [row, column], [1, 1]);
            }
        }
    });
}

/// Traces the rays of a chunk of the picture, tile by tile. Of a tile at the border of a crop all rays are
/// traced, so that the crop shows the bits of the whole picture, and those in the chunk are stored.
fn trace<F: Fault>(walker: &mut Walker, template: &FrustumTemplate, chunk: Tile) -> Executed {
    let Tile { region, ids, mut t } = chunk;
    match ids {
        IdRows::Narrow(mut ids) => {
            trace_tiles::<F>(walker, template, &region, (&mut ids, &mut t), &mut |_, _, _| {})
        }
        IdRows::Wide(mut wide) => {
            let mut names = vec![NO_PRIMITIVE; region.area()];
            let mut names: Vec<&mut [u32]> = names.chunks_mut(region.columns.len()).collect();
            let mut store_ids = |tile: &TileBuffer, names: &[&mut [u32]], drawn: &Region| {
                store_wide_ids(tile, &region, drawn, names, &mut wide);
            };
            trace_tiles::<F>(walker, template, &region, (&mut names, &mut t), &mut store_ids)
        }
    }
}
