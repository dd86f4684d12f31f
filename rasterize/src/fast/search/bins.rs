//! Lists for every tile of the primitives that may affect it, in the order of the clusters.

use super::batches::{Batch, Piece, pieces};
use super::clusters::{self, CLUSTER, Cluster, ClusterExtent, Sight};
use super::extent::Extent;
use super::instances::{Instance, SharedMesh, placed_box};
use super::tiling::Tiling;
use crate::fast::bounds::region;
use crate::fast::geometry::Geometry;
use crate::fast::setup::BOX_MARGIN;
use crate::fast::size_class::{FEW, MOST_SAMPLES_ACROSS, SizeClass, VERY_FEW};
use crate::fast::vertices::{ON_RASTER, OUT_OF_SIGHT, Vertex};
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, i32x4};
use bothways_common::observe::{Events, Executed};
use bothways_common::raster::Region;
use bothways_common::{Placement, Shape};
use std::ops::Range;

/// A primitive and the samples that it may cover.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// The primitive's slot; see [`BatchBins::list`].
    slot: u32,
    /// Rows and columns: the first, and the last times 2¹⁶.
    ends: [u32; 2],
    /// Whether it must be drawn as [`SizeClass::Large`].
    large: bool,
}

impl Entry {
    /// # Panics
    ///
    /// If the region is empty.
    fn new(slot: u32, region: &Region) -> Entry {
        let index = |index: usize| u16::try_from(index).expect("a side has at most 65,536 samples");
        let ends = |range: &Range<usize>| {
            u32::from(index(range.start)) | u32::from(index(range.end - 1)) << 16
        };
        Entry { slot, ends: [ends(&region.rows), ends(&region.columns)], large: true }
    }

    fn region(&self) -> Region {
        let range = |[first, last]: [u32; 2]| first as usize..last as usize + 1;
        let [rows, columns] = self.bounds();
        Region { rows: range(rows), columns: range(columns) }
    }

    /// First and last row, first and last column.
    #[inline(always)]
    fn bounds(&self) -> [[u32; 2]; 2] {
        self.ends.map(|ends| [ends & 0xffff, ends >> 16])
    }

    /// The size class, without a branch: sizes come in no order that the machine could predict.
    #[inline(always)]
    fn class(&self) -> u32 {
        let [rows, columns] = self.bounds();
        let samples = (rows[1] - rows[0] + 1) * (columns[1] - columns[0] + 1);
        const { assert!(SizeClass::Few as u32 == 1 && SizeClass::Many as u32 == 2) };
        let by_samples = u32::from(samples > VERY_FEW) + u32::from(samples > FEW);
        by_samples.max(u32::from(self.large) * SizeClass::Large as u32)
    }

    /// The list of this class of a tile.
    #[inline(always)]
    fn list(&self, tile: usize) -> usize {
        tile * SizeClass::COUNT as usize + self.class() as usize
    }

    /// The list of this class of the only tile that the region meets, one that is drawn. The class is that
    /// of the whole region: how a triangle is drawn does not depend on a crop.
    #[inline(always)]
    fn only_list(&self, tiling: &Tiling) -> Option<usize> {
        tiling.only_tile(self.bounds()).map(|tile| self.list(tile))
    }
}

/// The primitives of one batch: for each tile clusters of triangles, and for each size class a list of slots.
#[derive(Debug, Default)]
pub(crate) struct BatchBins {
    clusters: Vec<Vec<Cluster>>,
    /// For each tile the instances of meshes that may be seen there, and how many triangles they have.
    instances: Vec<Vec<Instance>>,
    instanced: Vec<usize>,
    lists: Vec<Vec<u32>>,
    /// See [`BatchBins::work`].
    work: Vec<(usize, usize)>,
    /// The entries of some triangles at a time: they stay in the fastest cache until they go to their lists.
    entries: Vec<Entry>,
}

impl BatchBins {
    /// The clusters whose triangles may be seen in a tile.
    pub(crate) fn clusters(&self, tile: usize) -> &[Cluster] {
        &self.clusters[tile]
    }

    /// The instances that may be seen in a tile.
    pub(crate) fn instances(&self, tile: usize) -> &[Instance] {
        &self.instances[tile]
    }

    /// The tiles to which primitives of the batch come, and about how many to each.
    pub(crate) fn work(&self) -> &[(usize, usize)] {
        &self.work
    }

    /// The primitives of one class in a tile, other than those in clusters, by their slots: a slot is a name, if the
    /// triangles of an object are counted in the order in which they are drawn.
    pub(crate) fn list(&self, tile: usize, class: SizeClass) -> &[u32] {
        &self.lists[tile * SizeClass::COUNT as usize + class as usize]
    }

    /// Finds the bounding region of every primitive of a batch, and the tiles that the region meets. Returns what was
    /// executed for the batch.
    #[inline(always)]
    pub(crate) fn fill<C: Context>(
        &mut self,
        context: &mut C,
        batch: &Batch,
        geometry: &Geometry,
    ) -> Executed {
        let mut executed = Executed::default();
        let tiles = geometry.tiling.count();
        self.lists.resize_with(tiles * SizeClass::COUNT as usize, Vec::new);
        self.lists.iter_mut().for_each(Vec::clear);
        self.clusters.resize_with(tiles, Vec::new);
        self.clusters.iter_mut().for_each(Vec::clear);
        self.instances.resize_with(tiles, Vec::new);
        self.instances.iter_mut().for_each(Vec::clear);
        self.instanced.clear();
        self.instanced.resize(tiles, 0);
        match *batch {
            Batch::Primitives { first_name, count } => {
                self.add_primitives(context, (first_name, count), geometry, &mut executed);
            }
            Batch::Instances { object, first, count } => {
                let numbers = first..first + count;
                self.add_instances(context, (object, numbers), geometry, &mut executed);
            }
        }
        self.count_work();
        executed
    }

    fn count_work(&mut self) {
        let lists = self.lists.chunks(SizeClass::COUNT as usize);
        let tiles = lists.zip(&self.clusters).zip(&self.instanced);
        let work = tiles.map(|((lists, clusters), instanced)| {
            let listed = lists.iter().map(Vec::len).sum::<usize>();
            clusters.len() * CLUSTER as usize + instanced + listed
        });
        self.work.clear();
        self.work.extend(work.enumerate().filter(|(_, work)| *work > 0));
    }

    /// Adds consecutive primitives that are not of instances: the first one's name, and how many.
    #[inline(always)]
    fn add_primitives<C: Context>(
        &mut self,
        context: &mut C,
        (first_name, count): (u32, u32),
        geometry: &Geometry,
        executed: &mut Executed,
    ) {
        let scene = geometry.view.scene;
        for piece in pieces(scene, first_name, count) {
            let id_and_slot = (piece.first_id, piece.first_name);
            match &scene.objects()[piece.object].shape {
                Shape::Mesh(_) => self.add_clusters(context, &piece, geometry, executed),
                Shape::Instances(_) => unreachable!("they have batches of their own"),
                Shape::Triangle(_) => {
                    executed.binned += 1;
                    let first = geometry.first_vertices[piece.object];
                    let corners = std::array::from_fn(|corner| geometry.vertices[first + corner]);
                    self.entries.clear();
                    self.enter(context, id_and_slot, &corners, geometry);
                    self.add_entries(geometry.tiling);
                }
                Shape::Sphere(_) | Shape::Plane(_) => {
                    executed.binned += 1;
                    self.entries.clear();
                    self.enter_large(context, id_and_slot, geometry);
                    self.add_entries(geometry.tiling);
                }
            }
        }
    }

    /// Adds a piece of a mesh: clusters that lie in few tiles as they are, the triangles of others one by one.
    #[inline(always)]
    fn add_clusters<C: Context>(
        &mut self,
        context: &mut C,
        piece: &Piece,
        geometry: &Geometry,
        executed: &mut Executed,
    ) {
        let shape = &geometry.view.scene.objects()[piece.object].shape;
        let clusters = &geometry.clusters[piece.object];
        let triangles = clusters.triangles(shape);
        let vertices = &geometry.vertices[geometry.first_vertices[piece.object]..];
        // Batches are cut between clusters.
        let first_id = piece.first_id - u64::from(piece.first);
        let first_slot = piece.first_name - piece.first;
        let object = u32::try_from(piece.object).expect("there are fewer objects than ids");
        let all = piece.first..piece.first + piece.count;
        let on = (geometry.map, geometry.raster, geometry.tiling);
        let bounds = &clusters.bounds()[(all.start / CLUSTER) as usize..];
        for (first, bounds) in all.clone().step_by(CLUSTER as usize).zip(bounds) {
            let indices = first..all.end.min(first + CLUSTER);
            let cluster = [object, first, indices.end - first];
            executed.boxes_tested += 1;
            let extent = clusters::extent(context.simd(), on, bounds, cluster);
            if C::WATCHED || matches!(extent, ClusterExtent::ManyTiles) {
                self.entries.clear();
                for index in indices {
                    let id = first_id + u64::from(triangles.number(index));
                    let id_and_slot = (id, first_slot + index);
                    let corners =
                        triangles.corners[index as usize].map(|vertex| vertices[vertex as usize]);
                    self.enter(context, id_and_slot, &corners, geometry);
                }
            }
            match extent {
                ClusterExtent::ManyTiles => {
                    executed.binned += u64::from(cluster[2]);
                    self.add_entries(geometry.tiling);
                }
                ClusterExtent::Nowhere => {}
                ClusterExtent::FewTiles(cluster) => {
                    for tile in geometry.tiling.tiles(cluster.extent.bounds) {
                        self.clusters[tile].push(cluster);
                    }
                }
            }
        }
    }

    /// Adds some instances of an object: those that may be seen, each by its box.
    #[inline(always)]
    fn add_instances<C: Context>(
        &mut self,
        context: &mut C,
        (object, numbers): (usize, Range<u32>),
        geometry: &Geometry,
        executed: &mut Executed,
    ) {
        let scene = geometry.view.scene;
        let (Shape::Instances(instances), Some(mesh)) =
            (&scene.objects()[object].shape, &geometry.shared[object])
        else {
            unreachable!("instances share a mesh")
        };
        let triangles = mesh.triangle_count();
        let of_object = scene.first_id(object);
        let object = u32::try_from(object).expect("there are fewer objects than ids");
        for number in numbers {
            let placement = &instances.placements()[number as usize];
            executed.boxes_tested += 1;
            let bounds = placed_box(placement, &mesh.bounds);
            let sight = clusters::sight(context.simd(), (geometry.map, geometry.raster), &bounds);
            let extent = match sight {
                Sight::Nowhere => None,
                Sight::Anywhere => Some(Extent::anywhere(geometry.raster)),
                Sight::Within(extent) => Some(extent),
            };
            if C::WATCHED {
                let first_id = of_object + u64::from(number) * u64::from(triangles);
                self.tell(context, (mesh, placement), (first_id, extent), geometry);
            }
            let Some(extent) = extent else { continue };
            for tile in geometry.tiling.tiles(extent.bounds) {
                self.instances[tile].push(Instance { object, number, extent });
                self.instanced[tile] += triangles as usize;
            }
        }
    }

    /// Tells an observer that the triangles of an instance begin: to one that only counts, how many there are. In a scene of
    /// wide ids, there are too many to tell of those that certainly cover no sample that is drawn.
    #[inline(always)]
    fn tell<C: Context>(
        &mut self,
        context: &mut C,
        (mesh, placement): (&SharedMesh, &Placement),
        (first_id, extent): (u64, Option<Extent>),
        geometry: &Geometry,
    ) {
        if let Some(counts) = context.sink().counts() {
            counts.primitives += u64::from(mesh.triangle_count());
            return;
        }
        let drawn = geometry.tiling.region();
        let is_drawn = |extent: Extent| !extent.region().intersection(&drawn).is_empty();
        if geometry.view.scene.has_wide_ids() && !extent.is_some_and(is_drawn) {
            return;
        }
        let mut vertices = [[0; 4]; _];
        for cluster in &mesh.clusters {
            let onto = (geometry.map, geometry.raster);
            mesh.place(context.simd(), onto, placement, cluster, &mut vertices);
            for place in 0..cluster.count() {
                let (number, corners) = cluster.triangle(mesh, place, &vertices);
                self.entries.clear();
                // These have no slots.
                let id_and_slot = (first_id + u64::from(number), u32::MAX);
                self.enter(context, id_and_slot, &corners, geometry);
            }
        }
        self.entries.clear();
    }

    /// Enters the samples that a triangle may cover, if there are any.
    #[inline(always)]
    fn enter<C: Context>(
        &mut self,
        context: &mut C,
        (id, slot): (u64, u32),
        corners: &[Vertex; 3],
        geometry: &Geometry,
    ) {
        let flags = corners[0][3] & corners[1][3] & corners[2][3];
        if flags & (OUT_OF_SIGHT | ON_RASTER) == ON_RASTER {
            let (entry, is_seen) = entry::<_, C::Fault>(context.simd(), slot, geometry, corners);
            if C::WATCHED {
                let drawn = geometry.tiling.region();
                let region = if is_seen { entry.region().intersection(&drawn) } else { NOWHERE };
                context.sink().primitive_begun(id, &region);
            }
            // Pushed whether it is seen or not, so that there is no branch to predict.
            self.entries.push(entry);
            self.entries.truncate(self.entries.len() - usize::from(!is_seen));
        } else if flags & OUT_OF_SIGHT != 0 {
            context.sink().primitive_begun(id, &NOWHERE);
        } else {
            self.enter_large(context, (id, slot), geometry);
        }
    }

    /// Enters the samples that any primitive may cover, to be drawn as [`SizeClass::Large`].
    fn enter_large<C: ScalarContext>(
        &mut self,
        context: &mut C,
        (id, slot): (u64, u32),
        geometry: &Geometry,
    ) {
        let region = region::<C::Fault>(&geometry.view.primitive(id), geometry.map);
        let drawn = region.intersection(&geometry.tiling.region());
        context.sink().primitive_begun(id, &drawn);
        if !drawn.is_empty() {
            self.entries.push(Entry::new(slot, &region));
        }
    }

    /// Puts all entries into the lists.
    #[inline(always)]
    fn add_entries(&mut self, tiling: &Tiling) {
        for entry in &self.entries {
            match entry.only_list(tiling) {
                Some(list) => self.lists[list].push(entry.slot),
                None => {
                    for tile in tiling.tiles(entry.bounds()) {
                        self.lists[entry.list(tile)].push(entry.slot);
                    }
                }
            }
        }
    }
}

/// No sample at all.
const NOWHERE: Region = Region { rows: 0..0, columns: 0..0 };

/// The entry of a triangle of trusted vertices, and whether it may cover a sample that is drawn; see
/// [`crate::fast::setup::AxisBounds`], which finds the same bounds.
#[inline(always)]
fn entry<S: Simd, F: Fault>(
    simd: S,
    slot: u32,
    geometry: &Geometry,
    corners: &[Vertex; 3],
) -> (Entry, bool) {
    let Geometry { raster, tiling, .. } = geometry;
    let bits = raster.fraction_bits;
    let margin = if F::is(Planted::ShrunkBox) { -1 } else { BOX_MARGIN };
    let [height, width] = raster.size;
    // Of the four numbers of a vertex, the first two are of interest.
    let a = i32x4::load_array(simd, corners[0]);
    let b = i32x4::load_array(simd, corners[1]);
    let c = i32x4::load_array(simd, corners[2]);
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let first = (low + i32x4::splat(simd, (1 << bits) - 1 - margin)) >> bits;
    let first = first.max(i32x4::splat(simd, 0));
    let last = (high + i32x4::splat(simd, margin)) >> bits;
    let last = last.min(i32x4::load_array(simd, [height - 1, width - 1, 0, 0]));
    let drawn = [&tiling.first, &tiling.last].map(|ends| i32x4::load_array_ref(simd, ends));
    let is_seen = first.max(drawn[0]).simd_le(last.min(drawn[1])).to_bitmask() & 3 == 3;
    let [rows, columns, ..] = (first | (last << 16)).to_array();
    // Places span less than 2³² units: what wraps is negative.
    let [tall, wide, ..] = (high - low).to_array();
    let most = MOST_SAMPLES_ACROSS.cast_unsigned() << bits;
    let large = tall.cast_unsigned().max(wide.cast_unsigned()) >= most;
    let ends = [rows.cast_unsigned(), columns.cast_unsigned()];
    (Entry { slot, ends, large }, is_seen)
}
