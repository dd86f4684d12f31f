//! Object order without the work that cannot matter.
//!
//! ```text
//! for each primitive                    vertex stage, bounding region, bins     (vertices, bins)
//!     for each sample it may affect     tile by tile, so that a z-buffer stays in cache    (tile)
//!         if it covers the sample       edge functions, affine on the raster        (setup, edges)
//!             keep the nearest          depth keys, affine on the raster             (tile, depth)
//! ```
//!
//! Small triangles go sixteen at a time, one a lane (`small`); larger ones one at a time, sixteen samples
//! at once (`block`); both in `f32`, from vertices in fixed point. What is larger still, reaches behind
//! the eye, or is a sphere or a plane goes sample by sample in `f64` (`large`).
//!
//! Rounded arithmetic decides wherever its bound says that the sign is certain; the rest goes to the
//! exact judge. The loop over primitives decides visibility: no ray is walked, and no tree. Normals and
//! colours are computed at the end, for what is visible.

mod bins;
mod block;
mod clip;
mod depth;
mod edges;
mod large;
mod round;
mod screen;
mod setup;
mod small;
mod tile;
mod vertices;

use bins::{BatchBins, Binning, Class, Tiling};
use bothways_common::fault::{Fault, Planted, Sound};
use bothways_common::frame::Tile;
use bothways_common::observe::Observer;
use bothways_common::simd::{Level, Simd, best_level, dispatch, prefetch};
use bothways_common::{Frame, Options, Scene, Shape, View};
use depth::KeyScale;
use glam::DVec3;
use rayon::prelude::*;
use screen::Screen;
use setup::{Lanes, Setup};
use small::Fragments;
use std::sync::Mutex;
use tile::{Picture, TileBuffer};
use vertices::{Raster, Vertex};

/// Columns and rows of a tile, as powers of two: its keys and ids fill half a MiB.
const TILE: [u32; 2] = [10, 6];
/// Primitives that one thread takes up at a time: at most, and at least if there are enough.
const MOST_IN_BATCH: u32 = 1 << 15;
const LEAST_IN_BATCH: u32 = 1 << 10;

/// What a moving camera would not repeat: the scene cut into batches that threads can share, and how
/// far it reaches.
#[derive(Debug)]
pub struct Prepared {
    batches: Vec<Batch>,
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

/// Prepares a scene for any number of views of it.
pub fn prepare(scene: &Scene) -> Prepared {
    let primitives = scene.primitive_count();
    // Some dozens of batches share well between threads.
    let most = (primitives / 64).clamp(LEAST_IN_BATCH, MOST_IN_BATCH);
    let first_ids = (0..primitives).step_by(most as usize);
    let batch = |first_id| Batch { first_id, count: most.min(primitives - first_id) };
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
    let corner =
        |k: usize| DVec3::from_array(std::array::from_fn(|axis| bounds[k >> axis & 1][axis]));
    Prepared {
        batches: first_ids.map(batch).collect(),
        primitives,
        first_vertices,
        bounds: std::array::from_fn(corner),
        has_planes,
        level: best_level(),
        tile: TILE,
        spare: Mutex::default(),
    }
}

impl Prepared {
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
    let keys = KeyScale::new(view.camera, &prepared.bounds, prepared.has_planes);
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
    };
    spare.bins.resize_with(prepared.batches.len(), BatchBins::default);
    let seen: &O = observer;
    let parts: Vec<O> = prepared
        .batches
        .par_iter()
        .zip(&mut spare.bins)
        .map(|(batch, bins)| {
            let mut observer = seen.fork();
            dispatch!(prepared.level, simd => {
                bins.fill::<_, O, F>(simd, batch, &binning, &mut observer)
            });
            observer
        })
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));

    let picture = Picture { view, screen: &screen, keys };
    let drawing = Drawing { binning: &binning, picture: &picture, bins: &spare.bins };
    let seen: &O = observer;
    let tiles: Vec<Tile> = frame.tiles_mut(tiling.columns, tiling.rows);
    let dropped = F::is(Planted::DroppedTile).then_some(tiles.len() / 2);
    let buffers = Mutex::new(std::mem::take(&mut spare.tiles));
    let parts: Vec<O> = tiles
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .map(|(index, tile)| {
            let mut observer = seen.fork();
            let buffer = lock(&buffers).pop().filter(|buffer| buffer.fits(&tiling));
            let mut buffer = buffer.unwrap_or_else(|| TileBuffer::new(view, &tiling));
            buffer.begin(view, &tile.region);
            dispatch!(prepared.level, simd => {
                if dropped != Some(index) {
                    drawing.draw_tile::<_, O, F>(simd, index, &mut buffer, &mut observer);
                }
                buffer.store(simd, &picture, tile);
            });
            lock(&buffers).push(buffer);
            observer
        })
        .collect();
    parts.into_iter().for_each(|part| observer.join(part));
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
    vertices.resize(prepared.first_vertices[prepared.first_vertices.len() - 1], [0; 4]);
    let mut rest = vertices.as_mut_slice();
    for object in view.scene.objects() {
        let place = |positions: &[glam::Vec3], vertices: &mut [Vertex]| {
            dispatch!(prepared.level, simd => raster.place(simd, screen, positions, vertices));
        };
        match &object.shape {
            Shape::Mesh(mesh) => {
                let positions = mesh.positions();
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

/// What drawing needs to know of the frame.
struct Drawing<'a> {
    binning: &'a Binning<'a>,
    picture: &'a Picture<'a>,
    bins: &'a [BatchBins],
}

impl Drawing<'_> {
    /// Draws all primitives of a tile: batch by batch in scene order, in each class by class.
    #[inline(always)]
    fn draw_tile<S: Simd, O: Observer, F: Fault>(
        &self,
        simd: S,
        tile: usize,
        buffer: &mut TileBuffer,
        observer: &mut O,
    ) {
        let mut lanes = Lanes::new();
        let mut find = Finder::new(self.binning);
        let mut fragments = Fragments::new();
        let mut large = Vec::new();
        for bins in self.bins {
            large.clear();
            for class in [Class::Tiny, Class::Small] {
                for ids in bins.list(tile, class).chunks(16) {
                    lanes.fill(ids, |id| find.vertices(id));
                    let setup = Setup::new::<S, F>(simd, self.binning.raster, &lanes);
                    if setup.doubtful != 0 {
                        large.extend(setup.lanes(setup.doubtful));
                    }
                    small::draw::<S, O, F>(simd, &setup, &mut fragments, buffer, observer);
                }
            }
            let list = bins.list(tile, Class::Block);
            for (k, ids) in list.chunks(16).enumerate() {
                lanes.fill(ids, |id| find.vertices(id));
                find.look_ahead(list, 16 * k + 16);
                let setup = Setup::new::<S, F>(simd, self.binning.raster, &lanes);
                let elsewhere = setup.doubtful | setup.keyless;
                large.extend(setup.lanes(elsewhere));
                for lane in (0..ids.len()).filter(|lane| elsewhere >> lane & 1 == 0) {
                    block::draw::<S, O, F>(simd, &setup, lane, buffer, observer);
                }
            }
            large.extend_from_slice(bins.list(tile, Class::Large));
            for id in &large {
                large::draw::<O, F>(*id, self.picture, buffer, observer);
            }
            buffer.settle::<O, F>(self.picture, observer);
        }
    }
}

/// Finds the vertices of triangles, which mostly come in the order of the scene.
struct Finder<'a> {
    binning: &'a Binning<'a>,
    /// The ids of the current object's primitives.
    ids: std::ops::Range<u32>,
    /// Its triangles' vertices, none for a triangle that is no mesh, and its first vertex.
    triangles: &'a [[u32; 3]],
    vertices: &'a [Vertex],
}

impl<'a> Finder<'a> {
    fn new(binning: &'a Binning<'a>) -> Self {
        Finder { binning, ids: 0..0, triangles: &[], vertices: &[] }
    }

    #[inline(always)]
    fn vertices(&mut self, id: u32) -> [Vertex; 3] {
        if !self.ids.contains(&id) {
            self.find_object(id);
        }
        let triangle = (id - self.ids.start) as usize;
        let corners = self.triangles.get(triangle).copied().unwrap_or([0, 1, 2]);
        corners.map(|vertex| self.vertices[vertex as usize])
    }

    /// Prepares for the sixteen triangles from `next` on, and a little for the sixteen behind them.
    ///
    /// Larger triangles of a tile may lie anywhere in memory. Small ones are neighbours, as meshes go, so
    /// that this would cost more than it saves.
    #[inline(always)]
    fn look_ahead(&self, ids: &[u32], next: usize) {
        let triangle = |id: u32| id.wrapping_sub(self.ids.start) as usize;
        let from = |start: usize| ids.get(start..).unwrap_or_default().iter().take(16);
        for &id in from(next + 16) {
            self.triangles.get(triangle(id)).into_iter().for_each(prefetch);
        }
        for &id in from(next) {
            for vertex in self.triangles.get(triangle(id)).into_iter().flatten() {
                prefetch(&self.vertices[*vertex as usize]);
            }
        }
    }

    #[cold]
    fn find_object(&mut self, id: u32) {
        let scene = self.binning.view.scene;
        let (object, local) = scene.locate(id);
        let shape = &scene.objects()[object].shape;
        let number = |count: usize| u32::try_from(count).expect("ids are u32");
        let first = id - number(local);
        self.ids = first..first + number(shape.primitive_count());
        self.triangles = match shape {
            Shape::Mesh(mesh) => mesh.triangles(),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => &[],
        };
        self.vertices = &self.binning.vertices[self.binning.first_vertices[object]..];
    }
}
