//! Which tiles a primitive may affect: every tile gets the lists of its primitives, in scene order.

use super::clusters::{self, CLUSTER, Cluster, Clusters, Place};
use super::depth::DepthPlane;
use super::screen::Screen;
use super::setup::{BOX_MARGIN, MOST_SAMPLES_ACROSS};
use super::small;
use super::vertices::{ON_RASTER, OUT_OF_SIGHT, Raster, Vertex};
use super::{Batch, Piece};
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, i32x4};
use bothways_common::observe::EventSink;
use bothways_common::raster::Region;
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

    /// The samples that are drawn.
    fn region(&self) -> Region {
        let range = |axis: usize| {
            let [first, last] = [self.first[axis], self.last[axis]].map(i32::cast_unsigned);
            first as usize..last as usize + 1
        };
        Region { rows: range(1), columns: range(0) }
    }

    /// The number of the tile in this row and column of tiles.
    #[inline(always)]
    fn tile(&self, row: u32, column: u32) -> usize {
        (row * self.across + column - self.before) as usize
    }

    /// The numbers of the tiles that are drawn and in which samples lie: those from a first to a last
    /// column and row.
    pub(super) fn tiles<T: Into<u32>>(
        &self,
        bounds: [[T; 2]; 2],
    ) -> impl Iterator<Item = usize> + use<'_, T> {
        let [columns, rows] = bounds.map(|ends| ends.map(Into::into));
        let within = |[first, last]: [u32; 2], bits: u32, drawn: [u32; 2]| {
            (first >> bits).max(drawn[0])..=(last >> bits).min(drawn[1])
        };
        let columns = within(columns, self.column_bits, self.tile_columns);
        let rows = within(rows, self.row_bits, self.tile_rows);
        rows.flat_map(move |row| columns.clone().map(move |column| self.tile(row, column)))
    }
}

/// A primitive and the samples that it may cover.
#[derive(Clone, Copy, Debug)]
struct Entry {
    place: u32,
    /// Columns and rows: the first, and the last times 2¹⁶.
    ends: [u32; 2],
    /// Whether it must be drawn as [`Class::Large`].
    large: bool,
}

impl Entry {
    /// # Panics
    ///
    /// If the region is empty.
    fn new(place: u32, region: &Region) -> Entry {
        let index = |index: usize| u16::try_from(index).expect("a side has at most 65,536 samples");
        let ends = |range: &Range<usize>| {
            u32::from(index(range.start)) | u32::from(index(range.end - 1)) << 16
        };
        Entry { place, ends: [ends(&region.columns), ends(&region.rows)], large: true }
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

    /// The list of this class of a tile.
    #[inline(always)]
    fn list(&self, tile: usize) -> usize {
        tile * CLASSES as usize + self.class() as usize
    }

    /// The list of this class of the only tile that the region overlaps, one that is drawn. The class is that
    /// of the whole region: how a triangle is drawn does not depend on a crop.
    #[inline(always)]
    fn only_list(&self, tiling: &Tiling) -> Option<usize> {
        let [columns, rows] = self.bounds();
        let [row, column] = [rows[0] >> tiling.row_bits, columns[0] >> tiling.column_bits];
        let is_only =
            row == rows[1] >> tiling.row_bits && column == columns[1] >> tiling.column_bits;
        is_only.then(|| self.list(tiling.tile(row, column)))
    }
}

/// The primitives of one batch: for each tile clusters of triangles, and for each class a list of ids.
#[derive(Debug, Default)]
pub(super) struct BatchBins {
    clusters: Vec<Vec<Cluster>>,
    lists: Vec<Vec<u32>>,
    /// Of some triangles at a time: they stay in the fastest cache until they go to their lists.
    entries: Vec<Entry>,
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
    /// The clusters of every object.
    pub(super) clusters: &'a [Clusters],
}

impl BatchBins {
    /// The clusters of which triangles may be seen in a tile.
    pub(super) fn clusters(&self, tile: usize) -> &[Cluster] {
        &self.clusters[tile]
    }

    /// About how many primitives come to a tile.
    pub(super) fn work(&self, tile: usize) -> usize {
        let lists = &self.lists[tile * CLASSES as usize..][..CLASSES as usize];
        let clusters = self.clusters[tile].len() * CLUSTER as usize;
        clusters + lists.iter().map(Vec::len).sum::<usize>()
    }

    /// The primitives of one class in a tile, other than those in clusters: their places, which are as ids are, but
    /// in the order in which an object's triangles are drawn.
    pub(super) fn list(&self, tile: usize, class: Class) -> &[u32] {
        &self.lists[tile * CLASSES as usize + class as usize]
    }

    /// Finds the bounding region of every primitive of a batch, and the tiles that it overlaps.
    #[inline(always)]
    pub(super) fn fill<S: Simd, O: EventSink + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        batch: &Batch,
        binning: &Binning,
        observer: &mut O,
    ) {
        let lists = binning.tiling.lists();
        self.lists.resize_with(lists, Vec::new);
        self.lists.iter_mut().for_each(Vec::clear);
        self.clusters.resize_with(lists / CLASSES as usize, Vec::new);
        self.clusters.iter_mut().for_each(Vec::clear);
        let scene = binning.view.scene;
        for piece in batch.pieces(scene) {
            match &scene.objects()[piece.object].shape {
                Shape::Mesh(_) => self.add_clusters::<S, O, F>(simd, &piece, binning, observer),
                Shape::Triangle(_) => {
                    let first = binning.first_vertices[piece.object];
                    let corners = std::array::from_fn(|corner| binning.vertices[first + corner]);
                    self.entries.clear();
                    self.enter::<S, O, F>(simd, [piece.first_id; 2], &corners, binning, observer);
                    self.add_entries(binning.tiling);
                }
                Shape::Sphere(_) | Shape::Plane(_) => {
                    self.entries.clear();
                    self.enter_large::<O, F>([piece.first_id; 2], binning, observer);
                    self.add_entries(binning.tiling);
                }
            }
        }
    }

    /// Adds a part of a mesh: clusters as they are, where they lie in few tiles, and the triangles of others
    /// one by one.
    #[inline(always)]
    fn add_clusters<S: Simd, O: EventSink + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        piece: &Piece,
        binning: &Binning,
        observer: &mut O,
    ) {
        let shape = &binning.view.scene.objects()[piece.object].shape;
        let clusters = &binning.clusters[piece.object];
        let triangles = clusters.triangles(shape);
        let vertices = &binning.vertices[binning.first_vertices[piece.object]..];
        // Batches are cut between clusters.
        let first_id = piece.first_id - piece.first;
        let object = u32::try_from(piece.object).expect("there are fewer objects than ids");
        let all = piece.first..piece.first + piece.count;
        let bounds = &clusters.bounds()[(all.start / CLUSTER) as usize..];
        for (first, bounds) in all.clone().step_by(CLUSTER as usize).zip(bounds) {
            let places = first..all.end.min(first + CLUSTER);
            let cluster = [object, first, places.end - first];
            let place = clusters::place(simd, binning, bounds, cluster);
            if O::ENABLED || matches!(place, Place::Scattered) {
                self.entries.clear();
                for place in places {
                    let ids = [first_id + triangles.number(place), first_id + place];
                    let corners =
                        triangles.corners[place as usize].map(|vertex| vertices[vertex as usize]);
                    self.enter::<S, O, F>(simd, ids, &corners, binning, observer);
                }
            }
            match place {
                Place::Scattered => self.add_entries(binning.tiling),
                Place::Unseen => {}
                Place::Near(cluster) => {
                    for tile in binning.tiling.tiles(cluster.bounds) {
                        self.clusters[tile].push(cluster);
                    }
                }
            }
        }
    }

    /// Notes the samples that a triangle may cover, if there are any.
    #[inline(always)]
    fn enter<S: Simd, O: EventSink + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        [id, place]: [u32; 2],
        corners: &[Vertex; 3],
        binning: &Binning,
        observer: &mut O,
    ) {
        let flags = corners[0][3] & corners[1][3] & corners[2][3];
        if flags & (OUT_OF_SIGHT | ON_RASTER) == ON_RASTER {
            let (entry, is_seen) = entry::<S, F>(simd, place, binning, corners);
            if O::ENABLED {
                let drawn = binning.tiling.region();
                let region = if is_seen { entry.region().intersection(&drawn) } else { NOWHERE };
                observer.primitive_begun(id, &region);
            }
            // Written whether it is seen or not, so that nothing depends on a guess.
            self.entries.push(entry);
            self.entries.truncate(self.entries.len() - usize::from(!is_seen));
        } else if flags & OUT_OF_SIGHT != 0 {
            observer.primitive_begun(id, &NOWHERE);
        } else {
            self.enter_large::<O, F>([id, place], binning, observer);
        }
    }

    /// Notes the samples that any primitive may cover, to be drawn as [`Class::Large`].
    fn enter_large<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        [id, place]: [u32; 2],
        binning: &Binning,
        observer: &mut O,
    ) {
        let region = region::<F>(&binning.view.primitive(id), binning.screen);
        let drawn = region.intersection(&binning.tiling.region());
        observer.primitive_begun(id, &drawn);
        if !drawn.is_empty() {
            self.entries.push(Entry::new(place, &region));
        }
    }

    /// Puts what was noted into the lists.
    #[inline(always)]
    fn add_entries(&mut self, tiling: &Tiling) {
        for entry in &self.entries {
            match entry.only_list(tiling) {
                Some(list) => self.lists[list].push(entry.place),
                None => {
                    for tile in tiling.tiles(entry.bounds()) {
                        self.lists[entry.list(tile)].push(entry.place);
                    }
                }
            }
        }
    }
}

/// No sample at all.
const NOWHERE: Region = Region { rows: 0..0, columns: 0..0 };

/// The entry of a triangle of trusted vertices, and whether it may cover a sample that is drawn; see
/// [`super::setup::Side`], which finds the same bounds.
#[inline(always)]
fn entry<S: Simd, F: Fault>(
    simd: S,
    place: u32,
    binning: &Binning,
    corners: &[Vertex; 3],
) -> (Entry, bool) {
    let Binning { raster, tiling, .. } = binning;
    let bits = raster.fraction_bits;
    let margin = if F::is(Planted::ShrunkBox) { -1 } else { BOX_MARGIN };
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
    (Entry { place, ends, large }, is_seen)
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
