//! Object order for meshes that are larger than memory.
//!
//! ```text
//! for each triangle in the file         one chunk at a time, drawn as a small scene of its own
//!     for each sample it may affect     by `fast`, into a frame of the chunk
//!         keep the nearest              of the chunk's winners and those of all chunks before
//! ```
//!
//! Object order needs one object at a time. A drawn triangle is not needed again, unless a sample shows it. So this
//! is the same loop as in [`fast`], with a pause after each chunk.
//!
//! The nearest triangle is a minimum over a total order: by exact `t`, then by the nudged ray, then by id. The
//! minimum of the minima of all chunks is the minimum over all triangles: the ids are the same as for the whole mesh
//! in memory, for chunks of any size. Image order cannot do this: any ray may need any triangle.
//!
//! ```
//! use bothways_rasterize::common::scene::Positions;
//! use bothways_rasterize::common::{Camera, Options, glam::Vec3};
//! use bothways_rasterize::stream::{Canvas, CHUNK, Look};
//!
//! let mut positions = Positions::default();
//! for position in [[-9.0, -9.0, -4.0], [9.0, -9.0, -4.0], [0.0, 9.0, -4.0]] {
//!     positions.push(Vec3::from_array(position));
//! }
//! let camera = Camera::canonical(5, 5);
//! let mut canvas = Canvas::new(&camera, &Options::default());
//! let mut observer = ();
//! let mut pass = canvas.begin(&camera, CHUNK, &mut observer);
//! // The triangles may come from anywhere, one at a time.
//! pass.draw(&positions, [0, 1, 2]);
//! pass.finish(&positions);
//! canvas.shade(&positions, &camera, &Look::default());
//! assert_eq!(canvas.frame().id(2, 2), Some(0));
//! assert_eq!(canvas.frame().t(2, 2), Some(4.0));
//! ```

use crate::fast;
use bothways_common::exact::CachedJudge;
use bothways_common::frame::NO_PRIMITIVE;
use bothways_common::observe::{Events, Executed, Observer, Question};
use bothways_common::raster::{Region, Sample};
use bothways_common::scene::Positions;
use bothways_common::{
    Camera, Frame, Light, Material, Mesh, Object, Options, Primitive, SampleGrid, Scene, Shape,
    Sign, View, Work,
};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::mem;

/// The usual number of triangles in a chunk: at this number, clearing and merging a frame for each chunk is a small
/// part of the work, in some tens of megabytes.
pub const CHUNK: usize = 1 << 18;

/// What lasts from chunk to chunk and from pass to pass: the visible triangle at every sample. It takes 40 bytes a
/// sample, half of them in the frame.
#[derive(Debug)]
pub struct Canvas {
    /// The frame of the chunk during a pass; the frame of the whole mesh at the end.
    frame: Frame,
    ids: Vec<u32>,
    t: Vec<f32>,
    /// The three vertices of the triangle that a sample shows: they are stored only here.
    corners: Vec<[u32; 3]>,
    options: Options,
}

/// The material of a streamed mesh, and its light.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// The material of all triangles.
    pub material: Material,
    /// The lights, as in a [`Scene`].
    pub lights: Vec<Light>,
    /// The background, as in a [`Scene`].
    pub background: Vec3,
}

impl Default for Look {
    /// The look of a scene that does not state one.
    fn default() -> Self {
        let Scene { lights, background, .. } = scene_of([], &Positions::default());
        Look { material: Material::default(), lights, background }
    }
}

/// One pass over a mesh, with the triangles one after another.
#[derive(Debug)]
pub struct Pass<'a, O> {
    camera: &'a Camera,
    canvas: &'a mut Canvas,
    observer: &'a mut O,
    chunk: usize,
    waiting: Vec<[u32; 3]>,
    /// The id of the first waiting triangle.
    first_id: u32,
    /// The corners of a box around all vertices, from the first use on.
    bounds: Option<[DVec3; 8]>,
    /// What was executed for the chunks so far.
    executed: Executed,
}

impl Canvas {
    /// A canvas for pictures of this camera's size.
    ///
    /// # Panics
    ///
    /// If [`Options::check`] refuses the options for the image.
    pub fn new(camera: &Camera, options: &Options) -> Canvas {
        let frame = Frame::new(camera, options);
        let count = frame.ids().len();
        let (ids, t) = (vec![NO_PRIMITIVE; count], vec![f32::INFINITY; count]);
        Canvas { frame, ids, t, corners: vec![[0; 3]; count], options: *options }
    }

    /// The same canvas, whose frame keeps the linear colour and the normal of every sample.
    pub fn with_colors_and_normals(self) -> Canvas {
        Canvas { frame: self.frame.with_colors().with_normals(), ..self }
    }

    /// Begins a pass with an empty frame. Each chunk has `chunk` triangles.
    ///
    /// # Panics
    ///
    /// If `chunk` is 0, or the camera's image has another size than the canvas.
    pub fn begin<'a, O: Observer>(
        &'a mut self,
        camera: &'a Camera,
        chunk: usize,
        observer: &'a mut O,
    ) -> Pass<'a, O> {
        assert!(chunk > 0, "a chunk has at least one triangle");
        assert_eq!(self.frame.camera_image(), camera.image(), "the canvas fits another picture");
        self.ids.fill(NO_PRIMITIVE);
        self.t.fill(f32::INFINITY);
        Pass {
            camera,
            canvas: self,
            observer,
            chunk,
            waiting: Vec::new(),
            first_id: 0,
            bounds: None,
            executed: Executed::default(),
        }
    }

    /// Computes the flat normal and the colour of every sample, for visible triangles only.
    ///
    /// # Panics
    ///
    /// If the camera or the positions are not those of the last pass, or that pass is not finished.
    pub fn shade(&mut self, positions: &Positions, camera: &Camera, look: &Look) {
        let seen = self.ids.iter().zip(&self.corners).filter(|(id, _)| **id != NO_PRIMITIVE);
        let mut visible: Vec<(u32, [u32; 3])> = seen.map(|(id, corners)| (*id, *corners)).collect();
        visible.par_sort_unstable();
        visible.dedup();
        let shape = mesh_of(visible.iter().map(|(_, corners)| *corners), positions);
        let Look { material, lights, background } = look.clone();
        let mut scene = checked(Object { shape, material });
        (scene.lights, scene.background) = (lights, background);
        // The small scene contains only visible triangles.
        let ids = mem::take(&mut self.ids);
        self.put(&ids, |id| visible.partition_point(|&(seen, _)| seen < id));
        crate::shade(&View::new(&scene, camera), &mut self.frame);
        self.put(&ids, |id| id as usize);
        self.ids = ids;
    }

    /// The frame: visible primitives after a pass, colours after shading.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The frame, without the rest of the canvas.
    pub fn into_frame(self) -> Frame {
        self.frame
    }

    /// Writes distances into the frame, and ids with other numbers.
    fn put(&mut self, ids: &[u32], renamed: impl Fn(u32) -> usize) {
        self.frame.clear();
        let width = self.frame.width();
        let Region { rows, columns } = self.frame.region().clone();
        for (index, &id) in ids.iter().enumerate().filter(|(_, id)| **id != NO_PRIMITIVE) {
            let id = u32::try_from(renamed(id)).expect("there are fewer names than ids");
            let (row, column) = (rows.start + index / width, columns.start + index % width);
            self.frame.set(row, column, id.into(), self.t[index].into());
        }
    }
}

impl<O: Observer> Pass<'_, O> {
    /// Draws the next triangle of the mesh: its id is the number of the earlier triangles. The triangle may wait for
    /// others before it is drawn.
    ///
    /// # Panics
    ///
    /// If a vertex has no position, or all ids are used up.
    pub fn draw(&mut self, positions: &Positions, triangle: [u32; 3]) {
        self.waiting.push(triangle);
        if self.waiting.len() == self.chunk {
            self.draw_chunk(positions);
        }
    }

    /// Draws the waiting triangles, and writes ids and distances into the canvas's frame. Returns what was executed for
    /// all chunks together.
    pub fn finish(mut self, positions: &Positions) -> Executed {
        self.draw_chunk(positions);
        let ids = mem::take(&mut self.canvas.ids);
        self.canvas.put(&ids, |id| id as usize);
        self.canvas.ids = ids;
        self.executed
    }

    fn draw_chunk(&mut self, positions: &Positions) {
        if self.waiting.is_empty() {
            return;
        }
        let scene = scene_of(self.waiting.iter().copied(), positions);
        let view = View::new(&scene, self.camera);
        let mut observer = Shifted { inner: self.observer.fork(), by: self.first_id.into() };
        let Canvas { frame, options, .. } = &mut *self.canvas;
        let bounds = *self.bounds.get_or_insert_with(|| {
            let ends = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            fast::corners(positions.iter().fold(ends, |[low, high], position| {
                [low.min(position.as_dvec3()), high.max(position.as_dvec3())]
            }))
        });
        let prepared = fast::prepare(&scene).within(bounds);
        self.executed +=
            fast::determine_visibility(&prepared, &view, options, frame, &mut observer);
        self.observer.join(observer.inner);
        self.merge(positions, &view);
        let drawn = u32::try_from(self.waiting.len()).expect("a scene has fewer primitives");
        self.first_id = self.first_id.checked_add(drawn).expect("there are ids for all triangles");
        self.waiting.clear();
    }

    /// The depth test between the winners of the chunk and the winners of the earlier chunks.
    fn merge(&mut self, positions: &Positions, view: &View) {
        let Canvas { frame, ids, t, corners, options } = &mut *self.canvas;
        let (frame, width, observer) = (&*frame, frame.width(), &*self.observer);
        let Region { rows, columns } = frame.region().clone();
        let grid = &self.camera.sample_grid(options.samples);
        let (first_id, chunk) = (self.first_id, self.waiting.as_slice());
        let held = ids.par_chunks_mut(width).zip(t.par_chunks_mut(width));
        let held = held.zip(corners.par_chunks_mut(width));
        let ids_of_chunk = frame.ids().narrow().expect("a chunk has few triangles");
        let drawn = ids_of_chunk.par_chunks(width).zip(frame.distances().par_chunks(width));
        let begin = || CachedJudge::new(view.judge());
        let parts: Vec<O> = rows
            .into_par_iter()
            .zip(held.zip(drawn))
            .map_init(begin, |judge, (row, (((ids, t), corners), (new_ids, new_t)))| {
                let mut depth_test =
                    DepthTest { positions, view, grid, judge, observer: observer.fork() };
                for (index, (column, &local)) in columns.clone().zip(new_ids).enumerate() {
                    if local == NO_PRIMITIVE {
                        continue;
                    }
                    let triangle = chunk[local as usize];
                    let incoming = Seen { id: first_id + local, t: new_t[index], triangle };
                    let stored = Seen { id: ids[index], t: t[index], triangle: corners[index] };
                    if depth_test.passes(Sample { row, column }, &incoming, &stored) {
                        ids[index] = incoming.id;
                        t[index] = incoming.t;
                        corners[index] = incoming.triangle;
                    }
                }
                depth_test.observer
            })
            .collect();
        parts.into_iter().for_each(|part| self.observer.join(part));
    }
}

/// Triangles with corners of their own, as a scene of one mesh.
fn scene_of(triangles: impl IntoIterator<Item = [u32; 3]>, positions: &Positions) -> Scene {
    checked(mesh_of(triangles, positions).into())
}

fn checked(object: Object) -> Scene {
    Scene::new(vec![object]).expect("a mesh was checked, and ids suffice")
}

fn mesh_of(triangles: impl IntoIterator<Item = [u32; 3]>, positions: &Positions) -> Shape {
    let corners: Vec<Vec3> =
        triangles.into_iter().flatten().map(|vertex| positions.get(vertex)).collect();
    let count = u32::try_from(corners.len() / 3).expect("a chunk has fewer triangles than ids");
    // Three times the count is also a valid vertex number, for up to 2³² / 3 triangles.
    let triangles = (0..count).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    Shape::Mesh(Mesh::new(corners, triangles).expect("positions are finite, and all are there"))
}

/// The triangle of a sample.
#[derive(Clone, Copy, Debug)]
struct Seen {
    id: u32,
    t: f32,
    triangle: [u32; 3],
}

/// The depth test between a winner of a chunk and a winner of the earlier chunks.
struct DepthTest<'a, O> {
    positions: &'a Positions,
    view: &'a View<'a>,
    grid: &'a SampleGrid<'a>,
    judge: &'a mut CachedJudge,
    observer: O,
}

impl<O: Observer> DepthTest<'_, O> {
    /// Whether the incoming triangle is nearer than the stored triangle, if there is one.
    fn passes(&mut self, sample: Sample, incoming: &Seen, stored: &Seen) -> bool {
        if stored.id == NO_PRIMITIVE {
            return true;
        }
        let nearer = surely_nearer(incoming.t, stored.t)
            .unwrap_or_else(|| self.judge(sample, incoming, stored));
        self.observer.depth_test(sample, incoming.id.into(), stored.id.into(), nearer);
        nearer
    }

    #[cold]
    fn judge(&mut self, sample: Sample, incoming: &Seen, stored: &Seen) -> bool {
        self.observer.judged(sample, Question::Nearest);
        let ray = self.grid.ray(sample.row, sample.column);
        let [first, second] = [incoming, stored].map(|seen| {
            let corner = |vertex| self.view.offset(self.positions.get(vertex));
            Primitive::Triangle(seen.triangle.map(corner))
        });
        self.judge.nearer((incoming.id, &first), (stored.id, &second), &ray)
    }
}

/// Which of two stored distances belongs to the nearer triangle, if rounding leaves no doubt.
///
/// A stored `t` is within 8·10⁻⁶ of the true one, relatively, where it is at least 2⁻¹⁰⁰: so the fast
/// rasterizer derives it. Two of them are in order if they differ by more than 1.6·10⁻⁵ of the larger;
/// 2·10⁻⁵ leaves room for rounding. Where the smaller one is below 2⁻¹⁰⁰, its error is far below 2⁻¹⁰⁰·10⁻⁵ however it
/// was rounded, and the larger alone must be above. A true `t` beyond `f32::MAX` is stored as that: as
/// the larger one it is even larger, and two such are never in order.
fn surely_nearer(incoming: f32, stored: f32) -> Option<bool> {
    const DOUBT: f64 = 2e-5;
    /// 2⁻¹⁰⁰.
    const LEAST: f32 = f32::from_bits(27 << 23);
    let (near, far) = (incoming.min(stored), incoming.max(stored));
    let certain = far >= LEAST && f64::from(near) < f64::from(far) * (1.0 - DOUBT);
    certain.then_some(incoming < stored)
}

/// An observer of a chunk that receives the ids of the whole mesh.
struct Shifted<O> {
    inner: O,
    by: u64,
}

impl<O: Observer> Observer for Shifted<O> {
    const WATCHES: bool = O::WATCHES;

    fn fork(&self) -> Self {
        Shifted { inner: self.inner.fork(), by: self.by }
    }

    fn join(&mut self, part: Self) {
        self.inner.join(part.inner);
    }
}

impl<O: Events> Events for Shifted<O> {
    fn counts(&mut self) -> Option<&mut Work> {
        self.inner.counts()
    }

    fn has_enough(&mut self) -> bool {
        self.inner.has_enough()
    }

    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        self.inner.primitive_begun(primitive + self.by, region);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.inner.sample_tested(sample, primitive + self.by);
    }

    fn edge_signs(&mut self, sample: Sample, primitive: u64, signs: [Option<Sign>; 3]) {
        self.inner.edge_signs(sample, primitive + self.by, signs);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.inner.fragment(sample, primitive + self.by);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        self.inner.depth_test(sample, incoming + self.by, stored + self.by, replaced);
    }

    fn judged(&mut self, sample: Sample, question: Question) {
        self.inner.judged(sample, question);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_that_rounding_cannot_tell_apart_go_to_the_judge() {
        assert_eq!(surely_nearer(1.0, 1.0), None);
        assert_eq!(surely_nearer(1.0, 1.000_01), None);
        assert_eq!(surely_nearer(1.0, 1.000_03), Some(true));
        assert_eq!(surely_nearer(1.000_03, 1.0), Some(false));
        assert_eq!(surely_nearer(f32::MAX, f32::MAX), None);
        assert_eq!(surely_nearer(f32::MAX, 1e38), Some(false));
        // Stored denormal numbers contain little information about the exact numbers.
        assert_eq!(surely_nearer(f32::from_bits(1), f32::from_bits(9)), None);
        assert_eq!(surely_nearer(f32::from_bits(1), 1e-20), Some(true));
    }
}
