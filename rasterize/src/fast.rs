//! Object order without the work that cannot matter.
//!
//! ```text
//! for each primitive                    vertex stage, bounding region, bins   (vertices, clusters, bins)
//!     for each sample it may affect     tile by tile, so that a z-buffer stays in cache    (paint, tile)
//!         if it covers the sample       edge functions, affine on the raster        (setup, edges)
//!             keep the nearest          depth keys, affine on the raster             (tile, depth)
//! ```
//!
//! Neighbouring triangles of a mesh go to their tile together, as a cluster, and not at all if the tile
//! already shows something certainly nearer wherever they may lie (`clusters`). Small triangles are then
//! drawn sixteen at a time, one a lane (`small`); larger ones one at a time, sixteen samples
//! at once (`block`); both in `f32`, from vertices in fixed point. What is larger still, reaches behind
//! the eye or is a plane is set up in `f64`, and drawn the same way part by part wherever `f32` is certain
//! enough (`large`, `narrow`). Spheres go sample by sample in `f64`.
//!
//! Rounded arithmetic decides wherever its bound says that the sign is certain; the rest goes to the
//! exact judge. The loop over primitives decides visibility: no ray is walked, and no tree. Normals and
//! colours are computed at the end, for what is visible.

mod aligned;
mod bins;
mod block;
mod clip;
mod clusters;
mod depth;
mod edges;
mod lanes;
mod large;
mod narrow;
mod paint;
mod round;
mod round_from_afar;
mod screen;
mod setup;
mod small;
mod tile;
mod twofold;
mod vertices;
mod waypoint;

use bins::{BatchBins, Binning, Tiling};
use bothways_common::engine::fault::{Fault, Planted, Sound};
use bothways_common::engine::memory::filled;
use bothways_common::engine::simd::{Level, best_level, dispatch, dispatch_with};
use bothways_common::frame::Tile;
use bothways_common::observe::{Events, Observer};
use bothways_common::{Frame, Options, Scene, Shape, View};
use clusters::{CLUSTER, Clusters};
use depth::KeyScale;
use glam::DVec3;
use paint::Drawing;
use rayon::prelude::*;
use screen::Screen;
use std::cmp::Reverse;
use std::sync::Mutex;
use tile::{Picture, TileBuffer};
use vertices::{Raster, Vertex};

/// Columns and rows of a tile, as powers of two: its keys and ids fill a MiB. Of Full HD that makes 20, enough
/// for some threads.
const TILE: [u32; 2] = [9, 8];
/// Primitives that one thread takes up at a time: at most, and at least if there are enough.
const MOST_IN_BATCH: u32 = 1 << 15;
const LEAST_IN_BATCH: u32 = 1 << 10;

/// What a moving camera would not repeat: the scene cut into batches that threads can share, its meshes
/// into clusters of neighbouring triangles, and how far it reaches.
#[derive(Debug)]
pub struct Prepared {
    batches: Vec<Batch>,
    /// The clusters of every object.
    clusters: Vec<Clusters>,
    primitives: u32,
    /// For each object, where its vertices begin among all of them; behind the last, how many there are.
    first_vertices: Vec<usize>,
    /// The corners of a box around everything but planes.
    bounds: [DVec3; 8],
    has_planes: bool,
    level: Level,
    tile: [u32; 2],
    /// Of the last frame, for its allocations alone.
    spare: Mutex<Spare>,
}

/// Memory that frames pass on to the next: none of what it holds.
#[derive(Debug, Default)]
struct Spare {
    vertices: Vec<Vertex>,
    bins: Vec<BatchBins>,
    tiles: Vec<TileBuffer>,
}

/// Some consecutive primitives, of one object or of several.
#[derive(Clone, Copy, Debug)]
struct Batch {
    /// The id of the batch's first primitive.
    first_id: u32,
    count: u32,
}

/// A part of a batch: consecutive primitives of one object.
struct Piece {
    object: usize,
    /// The first, among the object's, and its id.
    first: u32,
    first_id: u32,
    count: u32,
}

impl Batch {
    /// The parts of a batch, object by object.
    fn pieces(&self, scene: &Scene) -> impl Iterator<Item = Piece> {
        let end = self.first_id + self.count;
        let (mut object, first) = scene.locate(self.first_id);
        let number = |count: usize| u32::try_from(count).expect("ids are u32");
        let (mut first, mut first_id) = (number(first), self.first_id);
        std::iter::from_fn(move || {
            let shape = &scene.objects().get(object).filter(|_| first_id < end)?.shape;
            let count = (number(shape.primitive_count()) - first).min(end - first_id);
            let piece = Piece { object, first, first_id, count };
            (object, first, first_id) = (object + 1, 0, first_id + count);
            Some(piece)
        })
    }
}

/// Prepares a scene for any number of views of it.
pub fn prepare(scene: &Scene) -> Prepared {
    let primitives = scene.primitive_count();
    // Some dozens of batches share well between threads.
    let most = (primitives / 64).clamp(LEAST_IN_BATCH, MOST_IN_BATCH);
    let mut first_vertices = vec![0];
    let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let mut has_planes = false;
    for object in scene.objects() {
        let mut include = |low: DVec3, high: DVec3| {
            bounds = [bounds[0].min(low), bounds[1].max(high)];
        };
        let vertices = match &object.shape {
            Shape::Mesh(mesh) => {
                for position in mesh.positions() {
                    include(position.as_dvec3(), position.as_dvec3());
                }
                mesh.positions().len()
            }
            Shape::Triangle(triangle) => {
                for corner in [triangle.a, triangle.b, triangle.c] {
                    include(corner.as_dvec3(), corner.as_dvec3());
                }
                3
            }
            Shape::Sphere(sphere) => {
                let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
                include(center - radius, center + radius);
                0
            }
            Shape::Plane(_) => {
                has_planes = true;
                0
            }
        };
        first_vertices.push(first_vertices[first_vertices.len() - 1] + vertices);
    }
    let clusters = scene.objects().par_iter().map(|object| Clusters::new(&object.shape));
    Prepared {
        batches: batches(scene, most),
        clusters: clusters.collect(),
        primitives,
        first_vertices,
        bounds: corners(bounds),
        has_planes,
        level: best_level(),
        tile: TILE,
        spare: Mutex::default(),
    }
}

/// The corners of a box.
pub(crate) fn corners(bounds: [DVec3; 2]) -> [DVec3; 8] {
    std::array::from_fn(|k| {
        DVec3::from_array(std::array::from_fn(|axis| bounds[k >> axis & 1][axis]))
    })
}

/// Cuts a scene into batches of at most so many primitives, meshes only between clusters.
fn batches(scene: &Scene, most: u32) -> Vec<Batch> {
    let mut batches = Vec::new();
    let mut batch = Batch { first_id: 0, count: 0 };
    for object in scene.objects() {
        let mut rest = u32::try_from(object.shape.primitive_count()).expect("ids are u32");
        while rest > 0 {
            let room = most - batch.count;
            let count = if rest <= room { rest } else { room - room % CLUSTER };
            batch.count += count;
            rest -= count;
            if rest > 0 {
                batches.push(batch);
                batch = Batch { first_id: batch.first_id + batch.count, count: 0 };
            }
        }
    }
    batches.push(batch);
    batches.retain(|batch| batch.count > 0);
    batches
}

impl Prepared {
    /// The same as a part of a larger scene, of which these are the corners of a box around: it is drawn as it is
    /// within that, to the last bit.
    pub(crate) fn within(self, bounds: [DVec3; 8]) -> Prepared {
        Prepared { bounds, ..self }
    }

    /// The same, drawn at another level of SIMD and in tiles of other columns and rows (powers of
    /// two): for tests, which see that neither changes a bit.
    #[doc(hidden)]
    #[must_use]
    pub fn drawn_with(self, level: Level, tile: [u32; 2]) -> Prepared {
        Prepared { level, tile, ..self }
    }
}

impl Clone for Prepared {
    fn clone(&self) -> Self {
        Prepared {
            batches: self.batches.clone(),
            clusters: self.clusters.clone(),
            first_vertices: self.first_vertices.clone(),
            spare: Mutex::default(),
            ..*self
        }
    }
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

/// The loops, sound or with faults in them; somebody may watch. So [`run`], which is compiled for each
/// observer, is not what takes long to compile.
struct Loops {
    is: fn(Planted) -> bool,
    fill: fn(&mut BatchBins, &Batch, &Binning, Level, Option<&mut dyn Events>),
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
    binning: &Binning,
    level: Level,
    watcher: Option<&mut dyn Events>,
) {
    dispatch_with!(F, level, simd => match watcher {
        None => bins.fill::<_, (), F>(simd, batch, binning, &mut ()),
        Some(watcher) => bins.fill::<_, dyn Events, F>(simd, batch, binning, watcher),
    });
}

fn draw_tile<F: Fault>(
    drawing: &Drawing,
    tile: usize,
    buffer: &mut TileBuffer,
    watcher: Option<&mut dyn Events>,
) {
    if let Some(watcher) = watcher {
        if drawing.draw_tile::<dyn Events, F>(tile, buffer, watcher) {
            return;
        }
        // Who watches has enough: once more, for nobody.
        buffer.clear();
    }
    drawing.draw_tile::<(), F>(tile, buffer, &mut ());
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
    let grid = view.camera.sample_grid(options.samples);
    let mut screen = Screen::new(view.camera, &grid, &prepared.bounds);
    if (loops.is)(Planted::InfiniteMargin) {
        screen.margin = [f64::INFINITY; 2];
    }
    let keys = KeyScale::new(&screen, &prepared.bounds, prepared.has_planes);
    let raster = Raster::new(&screen, keys);
    let tiling = Tiling::new(&screen, prepared.tile, frame.region());
    // A thread that panicked left nothing that matters.
    let mut spare = std::mem::take(&mut *lock(&prepared.spare));

    place_vertices(prepared, view, &screen, &raster, &mut spare.vertices);
    let binning = Binning {
        view,
        screen: &screen,
        raster: &raster,
        tiling: &tiling,
        vertices: &spare.vertices,
        first_vertices: &prepared.first_vertices,
        clusters: &prepared.clusters,
    };
    spare.bins.resize_with(prepared.batches.len(), BatchBins::default);
    let seen: &O = observer;
    let parts: Vec<O> = prepared
        .batches
        .par_iter()
        .zip(&mut spare.bins)
        .map(|(batch, bins)| {
            let mut observer = seen.fork();
            (loops.fill)(bins, batch, &binning, prepared.level, observer.sink());
            observer
        })
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));

    let picture = Picture { view, screen: &screen, keys };
    let (bins, level) = (&spare.bins, prepared.level);
    let drawing = Drawing { binning: &binning, picture: &picture, bins, level };
    let seen: &O = observer;
    let tiles: Vec<Tile> = frame.tiles_mut(tiling.rows, tiling.columns);
    let dropped = (loops.is)(Planted::DroppedTile).then_some(tiles.len() / 2);
    let buffers = Mutex::new(std::mem::take(&mut spare.tiles));
    // Those with most to draw come first, so that all threads end at about the same time.
    let mut queue: Vec<(usize, Tile)> = tiles.into_iter().enumerate().collect();
    queue.sort_by_cached_key(|(index, _)| {
        Reverse(bins.iter().map(|bins| bins.work(*index)).sum::<usize>())
    });
    let (count, queue) = (queue.len(), Mutex::new(queue.into_iter()));
    let mut parts: Vec<(usize, O)> = (0..count)
        .into_par_iter()
        .with_max_len(1)
        .map(|_| {
            let (index, tile) = lock(&queue).next().expect("there are as many");
            let mut observer = seen.fork();
            if dropped == Some(index) || bins.iter().all(|bins| bins.work(index) == 0) {
                TileBuffer::store_nothing(tile);
                return (index, observer);
            }
            let buffer = lock(&buffers).pop().filter(|buffer| buffer.fits(&tiling));
            let mut buffer = buffer.unwrap_or_else(|| TileBuffer::new(view, &tiling));
            buffer.begin(view, &tile.region);
            (loops.draw_tile)(&drawing, index, &mut buffer, observer.sink());
            dispatch!(level, simd => buffer.store(simd, &picture, tile));
            lock(&buffers).push(buffer);
            (index, observer)
        })
        .collect();
    parts.sort_unstable_by_key(|(index, _)| *index);
    parts.into_iter().for_each(|(_, part)| observer.join(part));
    spare.tiles = buffers.into_inner().unwrap_or_default();
    *lock(&prepared.spare) = spare;
}

fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// The vertex stage, for the vertices of all objects.
fn place_vertices(
    prepared: &Prepared,
    view: &View,
    screen: &Screen,
    raster: &Raster,
    vertices: &mut Vec<Vertex>,
) {
    /// Vertices that one thread takes up at a time.
    const SHARE: usize = 4096;
    let count = prepared.first_vertices[prepared.first_vertices.len() - 1];
    if vertices.len() != count {
        *vertices = filled([0; 4], count);
    }
    let mut rest = vertices.as_mut_slice();
    for (object, clusters) in view.scene.objects().iter().zip(&prepared.clusters) {
        let place = |positions: &[glam::Vec3], vertices: &mut [Vertex]| {
            dispatch!(prepared.level, simd => raster.place(simd, screen, positions, vertices));
        };
        match &object.shape {
            Shape::Mesh(mesh) => {
                let positions = clusters.positions(mesh);
                let (own, others) = rest.split_at_mut(positions.len());
                rest = others;
                if positions.len() <= SHARE {
                    place(positions, own);
                } else {
                    let shares = positions.par_chunks(SHARE).zip(own.par_chunks_mut(SHARE));
                    shares.for_each(|(positions, vertices)| place(positions, vertices));
                }
            }
            Shape::Triangle(triangle) => {
                let (own, others) = rest.split_at_mut(3);
                rest = others;
                place(&[triangle.a, triangle.b, triangle.c], own);
            }
            Shape::Sphere(_) | Shape::Plane(_) => {}
        }
    }
}
