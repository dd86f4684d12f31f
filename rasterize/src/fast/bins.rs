//! Which tiles a primitive may affect: every tile gets the lists of its primitives, in scene order.

use super::Batch;
use super::depth::DepthPlane;
use super::screen::Screen;
use super::setup::MOST_SAMPLES_ACROSS;
use super::small;
use super::vertices::{ON_RASTER, OUT_OF_SIGHT, Raster, Vertex};
use bothways_common::fault::{Fault, Planted};
use bothways_common::frame::Region;
use bothways_common::observe::Observer;
use bothways_common::simd::{Simd, SimdBase, i32x4};
use bothways_common::{Mesh, Primitive, Shape, View};

/// How a primitive is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// A triangle over few samples.
    Small,
    /// A triangle over more.
    Block,
    /// Everything else.
    Large,
}

/// All classes, in the order in which a tile draws them.
const CLASSES: usize = 3;

/// How the picture is cut into tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiling {
    /// Columns and rows of a tile.
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Tiles in a row, and rows of them.
    across: usize,
    down: usize,
}

impl Tiling {
    pub(super) fn new(screen: &Screen, [columns, rows]: [usize; 2]) -> Tiling {
        let (width, height) = (screen.grid.width(), screen.grid.height());
        let (columns, rows) = (columns.min(width), rows.min(height));
        Tiling { columns, rows, across: width.div_ceil(columns), down: height.div_ceil(rows) }
    }

    fn count(&self) -> usize {
        self.across * self.down
    }
}

/// A primitive and the samples that it may cover.
#[derive(Clone, Copy, Debug)]
struct Entry {
    id: u32,
    class: Class,
    /// First and last column and row.
    columns: [u16; 2],
    rows: [u16; 2],
}

impl Entry {
    /// # Panics
    ///
    /// If the region is empty.
    fn new(id: u32, class: Class, region: &Region) -> Entry {
        let index = |index: usize| u16::try_from(index).expect("a side has at most 65,536 samples");
        let ends = |range: &std::ops::Range<usize>| [index(range.start), index(range.end - 1)];
        Entry { id, class, rows: ends(&region.rows), columns: ends(&region.columns) }
    }

    /// The numbers of the lists, of this class, of the tiles that the region overlaps.
    #[inline(always)]
    fn lists(&self, tiling: &Tiling) -> impl Iterator<Item = usize> + use<> {
        let tiles = |[first, last]: [u16; 2], side: usize| {
            usize::from(first) / side..=usize::from(last) / side
        };
        let columns = tiles(self.columns, tiling.columns);
        let (across, class) = (tiling.across, self.class as usize);
        tiles(self.rows, tiling.rows).flat_map(move |row| {
            columns.clone().map(move |column| (row * across + column) * CLASSES + class)
        })
    }
}

/// The primitives of one batch, sorted by tile and class.
#[derive(Debug, Default)]
pub(super) struct BatchBins {
    entries: Vec<Entry>,
    ids: Vec<u32>,
    /// Where each list begins, and behind the last where it ends.
    starts: Vec<u32>,
}

/// What binning needs to know of the frame.
pub(super) struct Binning<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) screen: &'a Screen<'a>,
    pub(super) raster: &'a Raster,
    pub(super) tiling: &'a Tiling,
    /// All vertices, and for each object where its own begin.
    pub(super) vertices: &'a [Vertex],
    pub(super) first_vertices: &'a [usize],
}

impl BatchBins {
    /// The ids of one class in a tile.
    pub(super) fn list(&self, tile: usize, class: Class) -> &[u32] {
        let list = tile * CLASSES + class as usize;
        &self.ids[self.starts[list] as usize..self.starts[list + 1] as usize]
    }

    /// Finds the bounding region of every primitive of a batch, and the tiles that it overlaps.
    #[inline(always)]
    pub(super) fn fill<S: Simd, O: Observer, F: Fault>(
        &mut self,
        simd: S,
        batch: &Batch,
        binning: &Binning,
        observer: &mut O,
    ) {
        self.entries.clear();
        let objects = binning.view.scene.objects();
        let (mut object, mut local) = binning.view.scene.locate(batch.first_id);
        let mut id = batch.first_id;
        let end = batch.first_id + batch.count;
        while id < end {
            let shape = &objects[object].shape;
            let count = (shape.primitive_count() - local).min((end - id) as usize);
            match shape {
                Shape::Mesh(mesh) => {
                    let vertices = &binning.vertices[binning.first_vertices[object]..];
                    let triangles = &mesh.triangles()[local..local + count];
                    for (triangle, id) in triangles.iter().zip(id..) {
                        let corners = triangle.map(|vertex| vertices[vertex as usize]);
                        let offsets = || offsets(mesh, triangle, binning.view);
                        self.add_triangle::<S, O, F>(
                            simd, id, &corners, offsets, binning, observer,
                        );
                    }
                }
                Shape::Triangle(_) => {
                    let first = binning.first_vertices[object];
                    let corners = std::array::from_fn(|k| binning.vertices[first + k]);
                    let offsets = || match binning.view.primitive(id) {
                        Primitive::Triangle(corners) => corners,
                        _ => unreachable!("it is a triangle"),
                    };
                    self.add_triangle::<S, O, F>(simd, id, &corners, offsets, binning, observer);
                }
                Shape::Sphere(_) | Shape::Plane(_) => {
                    let region = region::<F>(&binning.view.primitive(id), binning.screen);
                    self.add(id, Class::Large, &region, observer);
                }
            }
            id += u32::try_from(count).expect("a batch is small");
            (object, local) = (object + 1, 0);
        }
        self.sort(binning.tiling);
    }

    #[inline(always)]
    fn add_triangle<S: Simd, O: Observer, F: Fault>(
        &mut self,
        simd: S,
        id: u32,
        corners: &[Vertex; 3],
        offsets: impl FnOnce() -> [glam::DVec3; 3],
        binning: &Binning,
        observer: &mut O,
    ) {
        let flags = corners[0][3] & corners[1][3] & corners[2][3];
        if flags & OUT_OF_SIGHT != 0 {
            self.add(id, Class::Small, &Region { rows: 0..0, columns: 0..0 }, observer);
        } else if flags & ON_RASTER != 0 {
            let (class, ends) = bounds::<S, F>(simd, binning.raster, corners);
            let [columns, rows] = ends;
            if O::WATCHES {
                let range = |[first, last]: [i32; 2]| {
                    let index = |place: i32| usize::try_from(place.max(0)).unwrap_or(0);
                    index(first)..index(last + 1)
                };
                let region = Region { rows: range(rows), columns: range(columns) };
                observer.primitive_begun(id, &region);
            }
            if columns[0] <= columns[1] && rows[0] <= rows[1] {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "within the picture, which has at most 65,536 samples a side"
                )]
                let index = |place: i32| place as u16;
                let entry = Entry { id, class, columns: columns.map(index), rows: rows.map(index) };
                self.entries.push(entry);
            }
        } else {
            let corners = offsets();
            let vertices = corners.map(|corner| binning.screen.vertex(corner));
            let region = binning.screen.triangle_region::<F>(&vertices, || corners);
            self.add(id, Class::Large, &region, observer);
        }
    }

    fn add<O: Observer>(&mut self, id: u32, class: Class, region: &Region, observer: &mut O) {
        observer.primitive_begun(id, region);
        if !region.is_empty() {
            self.entries.push(Entry::new(id, class, region));
        }
    }

    /// A counting sort: it keeps the order of entries within a list.
    #[inline(always)]
    fn sort(&mut self, tiling: &Tiling) {
        let lists = tiling.count() * CLASSES;
        // While it counts, each list's number stands two places behind its own; while it fills, one.
        self.starts.clear();
        self.starts.resize(lists + 2, 0);
        for entry in &self.entries {
            entry.lists(tiling).for_each(|list| self.starts[list + 2] += 1);
        }
        for list in 2..lists + 2 {
            self.starts[list] += self.starts[list - 1];
        }
        self.ids.resize(self.starts[lists + 1] as usize, 0);
        for entry in &self.entries {
            for list in entry.lists(tiling) {
                let next = &mut self.starts[list + 1];
                self.ids[*next as usize] = entry.id;
                *next += 1;
            }
        }
    }
}

/// How a triangle of trusted vertices is drawn, and the first and last column and row that it may
/// cover; see `setup::side`, which finds the same.
#[inline(always)]
fn bounds<S: Simd, F: Fault>(
    simd: S,
    raster: &Raster,
    corners: &[Vertex; 3],
) -> (Class, [[i32; 2]; 2]) {
    let splat = |value: i32| i32x4::splat(simd, value);
    let bits = raster.fraction_bits;
    let margin = if F::is(Planted::ShrunkBox) { -1 } else { 2 };
    let [a, b, c] = corners.map(|corner| i32x4::load_array(simd, corner));
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let first = ((low + splat((1 << bits) - 1 - margin)) >> bits).max(splat(0));
    let last = (high + splat(margin)) >> bits;
    let size = i32x4::load_array(simd, [raster.size[0] - 1, raster.size[1] - 1, 0, 0]);
    let last = last.min(size);
    let (first, last) = (first.to_array(), last.to_array());
    // Places span less than 2³¹ units, so that the difference is right as an unsigned number.
    let extent =
        |axis: usize| high.to_array()[axis].wrapping_sub(low.to_array()[axis]).cast_unsigned();
    let widest = extent(0).max(extent(1)) >> bits;
    let samples = (last[0] - first[0] + 1).wrapping_mul(last[1] - first[1] + 1);
    let class = if widest >= MOST_SAMPLES_ACROSS.cast_unsigned() {
        Class::Large
    } else if samples <= small::MOST_SAMPLES {
        Class::Small
    } else {
        Class::Block
    };
    (class, [[first[0], last[0]], [first[1], last[1]]])
}

fn offsets(mesh: &Mesh, triangle: &[u32; 3], view: &View) -> [glam::DVec3; 3] {
    triangle.map(|vertex| view.offset(mesh.positions()[vertex as usize]))
}

/// The samples that any primitive may cover.
pub(super) fn region<F: Fault>(primitive: &Primitive, screen: &Screen) -> Region {
    match primitive {
        Primitive::Triangle(corners) => {
            let vertices = corners.map(|corner| screen.vertex(corner));
            screen.triangle_region::<F>(&vertices, || *corners)
        }
        Primitive::Sphere { center, radius } => screen.sphere_region::<F>(*center, *radius),
        Primitive::Plane { point, normal } => {
            screen.plane_region(&DepthPlane::new(screen, *point, *normal, normal.abs()))
        }
    }
}
