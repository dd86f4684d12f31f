//! Object order without the work that cannot matter.
//!
//! ```text
//! for each primitive                    vertex stage, bounding region, bins       (vertices, search)
//!     for each sample it may affect     tile by tile: a z-buffer stays in cache   (draw, tile)
//!         if it covers the sample       edge functions, affine on the raster      (setup)
//!             keep the nearest          depth keys, affine on the raster          (depth, tile)
//! ```
//!
//! Neighbouring triangles of a mesh go to their tile together, as a cluster. A cluster is left out if the tile
//! already shows something certainly nearer wherever the cluster may lie (`search/clusters`). How a primitive is
//! drawn depends on its size (`size_class`):
//!
//! - Triangles over few samples are drawn sixteen triangles at a time, one a lane (`few_samples`).
//! - Triangles over more samples are drawn one at a time, sixteen samples at once (`many_samples`), those with few columns in
//!   each of many rows sixteen rows at once (`thin`).
//! - Everything else is set up in `f64`, one primitive at a time (`one_primitive`): planes, and triangles that are
//!   larger still or reach behind the eye. They are drawn strip by strip, sixteen samples at once wherever `f32` is
//!   certain enough. Spheres are drawn row by row, sixteen samples at once in `f64` (`sphere`).
//!
//! The first two work in `f32`, from vertices in fixed point (`vertices`).
//!
//! Rounded arithmetic decides wherever its bound says that the sign is certain; the rest goes to the
//! exact judge. The loop over primitives decides visibility: no ray is walked, and no tree. Normals and
//! colours are computed at the end, for what is visible.
//!
//! An instance of a mesh is dropped by its box (`search/instances`): from tiles where it is not seen, and where the tile
//! already shows something nearer. Only then clusters are looked at, and their vertices placed; none is kept.

mod aligned;
mod answer;
mod bounds;
mod camera_map;
mod depth;
mod draw;
mod few_samples;
mod fragments;
mod geometry;
mod high_precision;
mod lanes;
mod local_origin;
mod many_samples;
mod one_primitive;
mod partition;
mod picture;
mod plane;
mod prepared;
mod search;
mod setup;
mod size_class;
mod sphere;
mod store;
mod thin;
mod tile;
mod triangle;
mod vertices;
mod viewport_affine;

pub use partition::ClusterBox;
pub use prepared::Prepared;
pub(crate) use prepared::corners;

use bothways_common::engine::any_observer::AnyObserver;
use bothways_common::engine::context::LoopContext;
use bothways_common::engine::fault::{Fault, Planted, Sound};
use bothways_common::engine::memory::filled;
use bothways_common::engine::simd::{Level, dispatch, dispatch_with};
use bothways_common::engine::tasks::TaskTimes;
use bothways_common::frame::Tile;
use bothways_common::observe::{Events, Executed, Observer};
use bothways_common::{Frame, Options, Scene, Shape, View};
use camera_map::CameraMap;
use depth::KeyScale;
use draw::Drawing;
use geometry::Geometry;
use glam::Vec3;
use picture::Picture;
use prepared::Recycled;
use rayon::prelude::*;
use search::batches::Batch;
use search::bins::BatchBins;
use search::tiling::{Tiling, tile_for_threads};
use std::cmp::Reverse;
use std::sync::{Mutex, MutexGuard, PoisonError};
use store::{stays_in_caches, store, store_nothing};
use tile::TileBuffer;
use vertices::{FixedPointRaster, Vertex};

/// Prepares a scene for any number of views of it: cuts it into batches, and its meshes into clusters.
///
/// Runs on the rayon pool that it is called in; the number of threads does not change what is prepared.
pub fn prepare(scene: &Scene) -> Prepared {
    Prepared::new(scene)
}

/// Renders a view of a prepared scene: what is seen at every sample, and its look.
///
/// # Panics
///
/// If the view's scene is not the one that was prepared, as far as the number of primitives tells, or
/// [`Options::check`] refuses the options for the image.
///
/// ```
/// use bothways_rasterize::common::{Camera, Options, Scene, Sphere, View, glam::Vec3};
/// use bothways_rasterize::fast;
///
/// let sphere = Sphere { center: Vec3::new(0.0, 0.0, -4.0), radius: 1.0 };
/// let scene = Scene::new(vec![sphere.into()])?;
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

/// Finds the primitive that is seen at every sample, and how far it is. Returns what was executed for it; only without
/// an observer, that is with `()`, hidden clusters are skipped.
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

/// The loops, sound or with faults in them, watched or not. [`run`] calls them through pointers: it is compiled once.
struct Loops {
    is: fn(Planted) -> bool,
    fill: fn(&mut BatchBins, &Batch, &Geometry, Level, Option<&mut dyn Events>) -> Executed,
    draw_tile: fn(&Drawing, usize, &mut TileBuffer, Option<&mut dyn Events>),
}

static SOUND: Loops = Loops::new::<Sound>();

impl Loops {
    const fn new<F: Fault>() -> Loops {
        Loops { is: F::is, fill: fill::<F>, draw_tile: draw_tile::<F> }
    }
}

fn fill<F: Fault>(
    bins: &mut BatchBins,
    batch: &Batch,
    geometry: &Geometry,
    level: Level,
    sink: Option<&mut dyn Events>,
) -> Executed {
    // A renderer with faults runs without an observer: the code for events is not compiled for it.
    if const { F::SOUND }
        && let Some(sink) = sink
    {
        return dispatch_with!(F, level, simd => {
            bins.fill(&mut LoopContext::<_, _, F>::of(simd, sink), batch, geometry)
        });
    }
    dispatch_with!(F, level, simd => {
        bins.fill(&mut LoopContext::<_, _, F>::of(simd, &mut ()), batch, geometry)
    })
}

fn draw_tile<F: Fault>(
    drawing: &Drawing,
    tile: usize,
    buffer: &mut TileBuffer,
    sink: Option<&mut dyn Events>,
) {
    if const { F::SOUND }
        && let Some(sink) = sink
    {
        if drawing.draw_tile(&mut LoopContext::<_, _, F>::of((), sink), tile, buffer) {
            return;
        }
        // The sink needs no more events. The tile is drawn again, without them.
        buffer.clear();
    }
    drawing.draw_tile(&mut LoopContext::<_, _, F>::of((), &mut ()), tile, buffer);
}

/// The outer loop: the vertex stage, then all batches of primitives, then all tiles.
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
    let grid = view.camera.sample_grid(options.samples);
    let raster = view.camera.raster(options.samples);
    let mut map = CameraMap::new(view.camera, &grid, raster, &prepared.bounds);
    if (loops.is)(Planted::InfiniteMargin) {
        map.margin = [f64::INFINITY; 2];
    }
    let keys = KeyScale::new(&map, &prepared.bounds, prepared.has_planes);
    let raster = FixedPointRaster::new(&map, keys);
    let tile = tile_for_threads(prepared.tile, prepared.threads, frame.region());
    let tiling = Tiling::new(&map, tile, frame.region());
    // A thread that panicked left nothing that matters.
    let mut recycled = std::mem::take(&mut *lock(&prepared.recycled));

    place_vertices(prepared, view, &map, &raster, &mut recycled.vertices);
    let Recycled { vertices, bins, tiles } = &mut recycled;
    let geometry = Geometry {
        view,
        map: &map,
        raster: &raster,
        tiling: &tiling,
        vertices,
        first_vertices: &prepared.first_vertices,
        clusters: &prepared.clusters,
        shared: &prepared.shared,
    };
    let times = prepared.times.as_deref();
    let past_caches = !stays_in_caches(prepared, frame.region().area());
    let mut cut = Vec::new();
    // Both are one stage: binning needs no tile of the frame.
    TaskTimes::begin_stage(times);
    let mut executed = rayon::in_place_scope(|scope| {
        scope.spawn(|_| cut = cut_into_tiles(frame, &tiling, times));
        bin_primitives(prepared, &geometry, bins, observer, loops)
    });

    let picture = Picture { view, map: &map, keys, past_caches };
    let drawing = Drawing { geometry: &geometry, picture: &picture, bins, level: prepared.level };
    executed += draw_tiles(&drawing, cut, tiles, observer, loops, times);
    *lock(&prepared.recycled) = recycled;
    executed
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The vertex stage, for the vertices of all objects.
fn place_vertices(
    prepared: &Prepared,
    view: &View,
    map: &CameraMap,
    raster: &FixedPointRaster,
    vertices: &mut Vec<Vertex>,
) {
    /// Vertices that one thread takes up at a time.
    const CHUNK: usize = 1024;
    let count = prepared.first_vertices[prepared.first_vertices.len() - 1];
    let times = prepared.times.as_deref();
    if vertices.len() != count {
        *vertices = filled([0; 4], count);
    }
    let place = |positions: &[Vec3], vertices: &mut [Vertex]| {
        raster.place(prepared.level, map, positions, vertices);
    };
    let mut rest = vertices.as_mut_slice();
    let mut chunks = Vec::new();
    for (object, clusters) in view.scene.objects().iter().zip(&prepared.clusters) {
        match &object.shape {
            Shape::Mesh(mesh) => {
                let positions = clusters.positions(mesh);
                let (own, others) = rest.split_at_mut(positions.len());
                rest = others;
                chunks.extend(positions.chunks(CHUNK).zip(own.chunks_mut(CHUNK)));
            }
            Shape::Triangle(triangle) => {
                let (own, others) = rest.split_at_mut(3);
                rest = others;
                place(&[triangle.a, triangle.b, triangle.c], own);
            }
            // Vertices of instances are placed where they are drawn.
            Shape::Sphere(_) | Shape::Plane(_) | Shape::Instances(_) => {}
        }
    }
    TaskTimes::begin_stage(times);
    let place = |(positions, vertices): (&[Vec3], &mut [Vertex])| {
        TaskTimes::time(times, || place(positions, vertices));
    };
    if count <= CHUNK {
        chunks.into_iter().for_each(place);
    } else {
        chunks.into_par_iter().for_each(place);
    }
}

/// Lists for every batch which of its primitives may affect which tile.
fn bin_primitives(
    prepared: &Prepared,
    geometry: &Geometry,
    bins: &mut Vec<BatchBins>,
    observer: &mut dyn AnyObserver,
    loops: &Loops,
) -> Executed {
    bins.resize_with(prepared.batches.len(), BatchBins::default);
    let mut executed = Executed::default();
    let times = prepared.times.as_deref();
    observer.in_parts(bins.len(), &mut |parts| {
        let batches = prepared.batches.par_iter().zip(bins.par_iter_mut()).zip(parts);
        let of_batches = batches.map(|((batch, bins), part)| {
            TaskTimes::time(times, || {
                (loops.fill)(bins, batch, geometry, prepared.level, part.sink())
            })
        });
        executed = of_batches.sum();
    });
    executed
}

/// The tiles of a frame, cut by all threads: a slice for each row of each tile is too much for one.
fn cut_into_tiles<'a>(
    frame: &'a mut Frame,
    tiling: &Tiling,
    times: Option<&TaskTimes>,
) -> Vec<Tile<'a>> {
    let bands = frame.bands_mut(tiling.rows).into_par_iter();
    bands.flat_map_iter(|band| TaskTimes::time(times, || band.tiles_mut(tiling.columns))).collect()
}

/// Draws every tile, and stores it in the frame. `buffers` are those of earlier frames, and become those of this one.
fn draw_tiles(
    drawing: &Drawing,
    mut tiles: Vec<Tile>,
    buffers: &mut Vec<TileBuffer>,
    observer: &mut dyn AnyObserver,
    loops: &Loops,
    times: Option<&TaskTimes>,
) -> Executed {
    let Drawing { geometry: &Geometry { view, tiling, .. }, picture, bins, level } = *drawing;
    let dropped = (loops.is)(Planted::DroppedTile).then_some(tiles.len() / 2);
    let mut work = vec![0; tiles.len()];
    bins.iter().flat_map(BatchBins::work).for_each(|(tile, some)| work[*tile] += some);
    let free = Mutex::new(std::mem::take(buffers));
    let mut executed = Executed::default();
    TaskTimes::begin_stage(times);
    observer.in_parts(tiles.len(), &mut |parts| {
        // Tiles with most to draw come first, so that all threads end at about the same time.
        let mut queue: Vec<_> =
            std::mem::take(&mut tiles).into_iter().zip(parts).enumerate().collect();
        queue.sort_by_key(|(index, _)| Reverse(work[*index]));
        let (count, queue) = (queue.len(), Mutex::new(queue.into_iter()));
        let of_tiles = (0..count).into_par_iter().with_max_len(1).map(|_| {
            let (index, (tile, part)) = lock(&queue).next().expect("there are as many");
            if dropped == Some(index) || work[index] == 0 {
                TaskTimes::time(times, || store_nothing(picture, tile));
                return Executed::default().of_one_tile();
            }
            let buffer = lock(&free).pop().filter(|buffer| buffer.fits(tiling));
            let mut buffer = buffer.unwrap_or_else(|| TileBuffer::new(view, tiling));
            TaskTimes::time(times, || {
                buffer.begin(view, &tile.region);
                (loops.draw_tile)(drawing, index, &mut buffer, part.sink());
                dispatch!(level, simd => store(simd, picture, &mut buffer, tile));
            });
            let executed = buffer.executed.of_one_tile();
            lock(&free).push(buffer);
            executed
        });
        executed = of_tiles.sum();
    });
    *buffers = free.into_inner().unwrap_or_default();
    executed
}
