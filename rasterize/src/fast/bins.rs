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
use bothways_common::simd::{Simd, SimdBase, SimdMask, i32x4};
use bothways_common::{Mesh, Primitive, Shape, View};
use std::ops::Range;

/// How a primitive is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// A triangle over very few samples.
    Tiny,
    /// A triangle over few.
    Small,
    /// A triangle over more.
    Block,
    /// Everything else.
    Large,
}

const CLASSES: u32 = 4;

/// How the picture is cut into tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiling {
    /// Columns and rows of a tile.
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The logarithms of both, before they were cut to the picture.
    column_bits: u32,
    row_bits: u32,
    /// Tiles in a row, and rows of them.
    across: u32,
    down: u32,
}

impl Tiling {
    /// Tiles of `2^column_bits` by `2^row_bits` samples.
    pub(super) fn new(screen: &Screen, [column_bits, row_bits]: [u32; 2]) -> Tiling {
        let (width, height) = (screen.grid.width(), screen.grid.height());
        let (columns, rows) = (width.min(1 << column_bits), height.min(1 << row_bits));
        let tiles = |side: usize, of: usize| {
            u32::try_from(side.div_ceil(of)).expect("a side has at most 65,536 samples")
        };
        let (across, down) = (tiles(width, columns), tiles(height, rows));
        Tiling { columns, rows, column_bits, row_bits, across, down }
    }

    fn lists(&self) -> usize {
        (self.across * self.down * CLASSES) as usize
    }
}

/// A primitive and the samples that it may cover.
#[derive(Clone, Copy, Debug)]
struct Entry {
    id: u32,
    /// Columns and rows: the first, and the last times 2¹⁶.
    ends: [u32; 2],
    /// Whether it must be drawn as [`Class::Large`].
    large: bool,
}

impl Entry {
    const NONE: Entry = Entry { id: 0, ends: [0; 2], large: false };

    /// # Panics
    ///
    /// If the region is empty.
    fn new(id: u32, region: &Region) -> Entry {
        let index = |index: usize| u16::try_from(index).expect("a side has at most 65,536 samples");
        let ends = |range: &Range<usize>| {
            u32::from(index(range.start)) | u32::from(index(range.end - 1)) << 16
        };
        Entry { id, ends: [ends(&region.columns), ends(&region.rows)], large: true }
    }

    /// First and last column, first and last row.
    #[inline(always)]
    fn bounds(&self) -> [[u32; 2]; 2] {
        let [columns, rows] = self.ends;
        [[columns & 0xffff, columns >> 16], [rows & 0xffff, rows >> 16]]
    }

    #[inline(always)]
    fn class(&self) -> Class {
        let [columns, rows] = self.bounds();
        let samples = (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1);
        if self.large {
            Class::Large
        } else if samples <= small::VERY_FEW_SAMPLES {
            Class::Tiny
        } else if samples <= small::MOST_SAMPLES {
            Class::Small
        } else {
            Class::Block
        }
    }

    /// The list of this class of the only tile that the region overlaps.
    #[inline(always)]
    fn only_list(&self, tiling: &Tiling) -> Option<usize> {
        let [columns, rows] = self.bounds();
        let [row, column] = [rows[0] >> tiling.row_bits, columns[0] >> tiling.column_bits];
        let is_only =
            row == rows[1] >> tiling.row_bits && column == columns[1] >> tiling.column_bits;
        let list = (row * tiling.across + column) * CLASSES + self.class() as u32;
        is_only.then_some(list as usize)
    }

    /// Does something for the list, of this class, of every tile that the region overlaps.
    #[inline(always)]
    fn for_each_list(&self, tiling: &Tiling, mut action: impl FnMut(usize)) {
        let [columns, rows] = self.bounds();
        let class = self.class() as u32;
        for row in rows[0] >> tiling.row_bits..=rows[1] >> tiling.row_bits {
            for column in columns[0] >> tiling.column_bits..=columns[1] >> tiling.column_bits {
                action(((row * tiling.across + column) * CLASSES + class) as usize);
            }
        }
    }
}

/// The primitives of one batch, for each tile and class a list of ids.
#[derive(Debug, Default)]
pub(super) struct BatchBins {
    lists: Vec<Vec<u32>>,
    /// Some entries on their way to the lists.
    entries: Vec<Entry>,
    count: usize,
}

/// So many entries stay in the fastest cache.
const ENTRIES: usize = 512;

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
        &self.lists[tile * CLASSES as usize + class as usize]
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
        self.lists.resize_with(binning.tiling.lists(), Vec::new);
        self.lists.iter_mut().for_each(Vec::clear);
        self.entries.resize(ENTRIES, Entry::NONE);
        self.count = 0;
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
                    let mut id = id;
                    for some in triangles.chunks(ENTRIES) {
                        self.make_room(some.len(), binning.tiling);
                        for triangle in some {
                            let corners = triangle.map(|vertex| vertices[vertex as usize]);
                            let offsets = || offsets(mesh, triangle, binning.view);
                            self.add_triangle::<S, O, F>(
                                simd, id, &corners, offsets, binning, observer,
                            );
                            id += 1;
                        }
                    }
                }
                Shape::Triangle(_) => {
                    let first = binning.first_vertices[object];
                    let corners = std::array::from_fn(|k| binning.vertices[first + k]);
                    let offsets = || match binning.view.primitive(id) {
                        Primitive::Triangle(corners) => corners,
                        _ => unreachable!("it is a triangle"),
                    };
                    self.make_room(1, binning.tiling);
                    self.add_triangle::<S, O, F>(simd, id, &corners, offsets, binning, observer);
                }
                Shape::Sphere(_) | Shape::Plane(_) => {
                    let region = region::<F>(&binning.view.primitive(id), binning.screen);
                    self.make_room(1, binning.tiling);
                    self.add(id, &region, observer);
                }
            }
            id += u32::try_from(count).expect("a batch is small");
            (object, local) = (object + 1, 0);
        }
        self.make_room(ENTRIES, binning.tiling);
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
            self.add(id, &Region { rows: 0..0, columns: 0..0 }, observer);
        } else if flags & ON_RASTER != 0 {
            let (entry, is_seen) = entry::<S, F>(simd, id, binning.raster, corners);
            if O::WATCHES {
                let range = |[first, last]: [u32; 2]| first as usize..last as usize + 1;
                let [columns, rows] = entry.bounds();
                let region = if is_seen {
                    Region { rows: range(rows), columns: range(columns) }
                } else {
                    Region { rows: 0..0, columns: 0..0 }
                };
                observer.primitive_begun(id, &region);
            }
            self.entries[self.count] = entry;
            self.count += usize::from(is_seen);
        } else {
            let corners = offsets();
            let vertices = corners.map(|corner| binning.screen.vertex(corner));
            let region = binning.screen.triangle_region::<F>(&vertices, || corners);
            self.add(id, &region, observer);
        }
    }

    fn add<O: Observer>(&mut self, id: u32, region: &Region, observer: &mut O) {
        observer.primitive_begun(id, region);
        if !region.is_empty() {
            self.entries[self.count] = Entry::new(id, region);
            self.count += 1;
        }
    }

    /// Brings entries to their lists if there is no room for so many more.
    #[inline(always)]
    fn make_room(&mut self, more: usize, tiling: &Tiling) {
        if self.count + more <= ENTRIES {
            return;
        }
        for entry in &self.entries[..self.count] {
            match entry.only_list(tiling) {
                Some(list) => self.lists[list].push(entry.id),
                None => entry.for_each_list(tiling, |list| self.lists[list].push(entry.id)),
            }
        }
        self.count = 0;
    }
}

/// The entry of a triangle of trusted vertices, and whether it may cover a sample at all; see
/// `setup::side`, which finds the same bounds.
#[inline(always)]
fn entry<S: Simd, F: Fault>(
    simd: S,
    id: u32,
    raster: &Raster,
    corners: &[Vertex; 3],
) -> (Entry, bool) {
    let bits = raster.fraction_bits;
    let margin = if F::is(Planted::ShrunkBox) { -1 } else { 2 };
    let [width, height] = raster.size;
    // Of the four numbers of a vertex, the first two are of interest.
    let a = i32x4::load_array(simd, corners[0]);
    let b = i32x4::load_array(simd, corners[1]);
    let c = i32x4::load_array(simd, corners[2]);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let first = (low + i32x4::splat(simd, (1 << bits) - 1 - margin)) >> bits;
    let first = first.max(i32x4::splat(simd, 0));
    let last = (high + i32x4::splat(simd, margin)) >> bits;
    let last = last.min(i32x4::load_array(simd, [width - 1, height - 1, 0, 0]));
    let is_seen = first.simd_le(last).to_bitmask() & 3 == 3;
    let [columns, rows, ..] = (first | (last << 16)).to_array();
    // Places span less than 2³² units: what wraps is negative.
    let [wide, tall, ..] = (high - low).to_array();
    let most = MOST_SAMPLES_ACROSS.cast_unsigned() << bits;
    let large = wide.cast_unsigned().max(tall.cast_unsigned()) >= most;
    let ends = [columns.cast_unsigned(), rows.cast_unsigned()];
    (Entry { id, ends, large }, is_seen)
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
