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
use bothways_common::{Primitive, Shape, View};
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
    /// Of the picture's tiles, those that hold what is drawn: the first and the last in a row, and the
    /// first and the last row of them.
    tile_columns: [u32; 2],
    tile_rows: [u32; 2],
    /// How many of them are in a row.
    across: u32,
    /// What a row of tiles times `across` and the tile's column count more than the lists do.
    before: u32,
    /// The first and the last sample that is drawn: column and row, as a vertex has them.
    first: [i32; 4],
    last: [i32; 4],
}

impl Tiling {
    /// Tiles of `2^column_bits` by `2^row_bits` samples, of which those are drawn that hold a region.
    pub(super) fn new(
        screen: &Screen,
        [column_bits, row_bits]: [u32; 2],
        region: &Region,
    ) -> Tiling {
        let (width, height) = (screen.grid.width(), screen.grid.height());
        let (columns, rows) = (width.min(1 << column_bits), height.min(1 << row_bits));
        let number = |place: usize| i32::try_from(place).expect("at most 65,536 samples");
        let first = [region.columns.start, region.rows.start].map(number);
        let last = [region.columns.end - 1, region.rows.end - 1].map(number);
        let tiles = |axis: usize, bits: u32| {
            [first[axis].cast_unsigned() >> bits, last[axis].cast_unsigned() >> bits]
        };
        let (tile_columns, tile_rows) = (tiles(0, column_bits), tiles(1, row_bits));
        let across = tile_columns[1] - tile_columns[0] + 1;
        Tiling {
            columns,
            rows,
            column_bits,
            row_bits,
            tile_columns,
            tile_rows,
            across,
            before: tile_rows[0] * across + tile_columns[0],
            first: [first[0], first[1], 0, 0],
            last: [last[0], last[1], 0, 0],
        }
    }

    fn lists(&self) -> usize {
        let down = self.tile_rows[1] - self.tile_rows[0] + 1;
        (self.across * down * CLASSES) as usize
    }

    /// The list of a class of the tile in this row and column of tiles.
    #[inline(always)]
    fn list(&self, row: u32, column: u32, class: u32) -> usize {
        ((row * self.across + column - self.before) * CLASSES + class) as usize
    }

    /// The samples that are drawn.
    fn region(&self) -> Region {
        let range = |axis: usize| {
            let [first, last] = [self.first[axis], self.last[axis]].map(i32::cast_unsigned);
            first as usize..last as usize + 1
        };
        Region { rows: range(1), columns: range(0) }
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

    fn region(&self) -> Region {
        let range = |[first, last]: [u32; 2]| first as usize..last as usize + 1;
        let [columns, rows] = self.bounds();
        Region { rows: range(rows), columns: range(columns) }
    }

    /// First and last column, first and last row.
    #[inline(always)]
    fn bounds(&self) -> [[u32; 2]; 2] {
        let [columns, rows] = self.ends;
        [[columns & 0xffff, columns >> 16], [rows & 0xffff, rows >> 16]]
    }

    /// Without a branch: sizes come in no order that could be guessed.
    #[inline(always)]
    fn class(&self) -> u32 {
        let [columns, rows] = self.bounds();
        let samples = (columns[1] - columns[0] + 1) * (rows[1] - rows[0] + 1);
        const { assert!(Class::Small as u32 == 1 && Class::Block as u32 == 2) };
        let by_samples =
            u32::from(samples > small::VERY_FEW_SAMPLES) + u32::from(samples > small::MOST_SAMPLES);
        by_samples.max(u32::from(self.large) * Class::Large as u32)
    }

    /// The list of this class of the only tile that the region overlaps, one that is drawn.
    #[inline(always)]
    fn only_list(&self, tiling: &Tiling) -> Option<usize> {
        let [columns, rows] = self.bounds();
        let [row, column] = [rows[0] >> tiling.row_bits, columns[0] >> tiling.column_bits];
        let is_only =
            row == rows[1] >> tiling.row_bits && column == columns[1] >> tiling.column_bits;
        is_only.then(|| tiling.list(row, column, self.class()))
    }

    /// Does something for the list, of this class, of every tile that the region overlaps and that is
    /// drawn. The class is that of the whole region: how a triangle is drawn does not depend on a crop.
    #[inline(always)]
    fn for_each_list(&self, tiling: &Tiling, mut action: impl FnMut(usize)) {
        let [columns, rows] = self.bounds();
        let class = self.class();
        let within = |[first, last]: [u32; 2], bits: u32, drawn: [u32; 2]| {
            (first >> bits).max(drawn[0])..=(last >> bits).min(drawn[1])
        };
        for row in within(rows, tiling.row_bits, tiling.tile_rows) {
            for column in within(columns, tiling.column_bits, tiling.tile_columns) {
                action(tiling.list(row, column, class));
            }
        }
    }
}

/// The primitives of one batch, for each tile and class a list of ids.
#[derive(Debug, Default)]
pub(super) struct BatchBins {
    lists: Vec<Vec<u32>>,
}

/// Triangles whose bounds are found before the first goes to its list: their entries stay in the fastest
/// cache.
const SOME: usize = 256;

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
                    for (some, first_id) in triangles.chunks(SOME).zip((id..).step_by(SOME)) {
                        self.add_triangles::<S, O, F>(
                            simd, first_id, some, vertices, binning, observer,
                        );
                    }
                }
                Shape::Triangle(_) => {
                    let vertices = &binning.vertices[binning.first_vertices[object]..];
                    self.add_triangles::<S, O, F>(
                        simd,
                        id,
                        &[[0, 1, 2]],
                        vertices,
                        binning,
                        observer,
                    );
                }
                Shape::Sphere(_) | Shape::Plane(_) => self.add_large::<O, F>(id, binning, observer),
            }
            id += u32::try_from(count).expect("a batch is small");
            (object, local) = (object + 1, 0);
        }
    }

    /// Adds at most [`SOME`] triangles of one object.
    #[inline(always)]
    fn add_triangles<S: Simd, O: Observer, F: Fault>(
        &mut self,
        simd: S,
        first_id: u32,
        triangles: &[[u32; 3]],
        vertices: &[Vertex],
        binning: &Binning,
        observer: &mut O,
    ) {
        let mut entries = [Entry::NONE; SOME];
        let mut count = 0;
        for (triangle, id) in triangles.iter().zip(first_id..) {
            let corners = triangle.map(|vertex| vertices[vertex as usize]);
            let flags = corners[0][3] & corners[1][3] & corners[2][3];
            if flags & (OUT_OF_SIGHT | ON_RASTER) == ON_RASTER {
                let (entry, is_seen) = entry::<S, F>(simd, id, binning, &corners);
                if O::WATCHES {
                    let drawn = binning.tiling.region();
                    let region =
                        if is_seen { entry.region().intersection(&drawn) } else { NOWHERE };
                    observer.primitive_begun(id, &region);
                }
                // Written whether it is seen or not, so that nothing depends on a guess.
                entries[count % SOME] = entry;
                count += usize::from(is_seen);
            } else if flags & OUT_OF_SIGHT != 0 {
                observer.primitive_begun(id, &NOWHERE);
            } else {
                self.add_large::<O, F>(id, binning, observer);
            }
        }
        for entry in &entries[..count] {
            self.add(entry, binning.tiling);
        }
    }

    /// Adds any primitive as [`Class::Large`].
    fn add_large<O: Observer, F: Fault>(&mut self, id: u32, binning: &Binning, observer: &mut O) {
        let region = region::<F>(&binning.view.primitive(id), binning.screen);
        let drawn = region.intersection(&binning.tiling.region());
        observer.primitive_begun(id, &drawn);
        if !drawn.is_empty() {
            self.add(&Entry::new(id, &region), binning.tiling);
        }
    }

    #[inline(always)]
    fn add(&mut self, entry: &Entry, tiling: &Tiling) {
        match entry.only_list(tiling) {
            Some(list) => self.lists[list].push(entry.id),
            None => entry.for_each_list(tiling, |list| self.lists[list].push(entry.id)),
        }
    }
}

/// No sample at all.
const NOWHERE: Region = Region { rows: 0..0, columns: 0..0 };

/// The entry of a triangle of trusted vertices, and whether it may cover a sample that is drawn; see
/// `setup::side`, which finds the same bounds.
#[inline(always)]
fn entry<S: Simd, F: Fault>(
    simd: S,
    id: u32,
    binning: &Binning,
    corners: &[Vertex; 3],
) -> (Entry, bool) {
    let Binning { raster, tiling, .. } = binning;
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
    let drawn = [&tiling.first, &tiling.last].map(|ends| i32x4::load_array_ref(simd, ends));
    let is_seen = first.max(drawn[0]).simd_le(last.min(drawn[1])).to_bitmask() & 3 == 3;
    let [columns, rows, ..] = (first | (last << 16)).to_array();
    // Places span less than 2³² units: what wraps is negative.
    let [wide, tall, ..] = (high - low).to_array();
    let most = MOST_SAMPLES_ACROSS.cast_unsigned() << bits;
    let large = wide.cast_unsigned().max(tall.cast_unsigned()) >= most;
    let ends = [columns.cast_unsigned(), rows.cast_unsigned()];
    (Entry { id, ends, large }, is_seen)
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
