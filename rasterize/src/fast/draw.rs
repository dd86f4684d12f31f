//! Draws all primitives of a tile: first the clusters, then batch by batch all other primitives, by their size
//! classes.

use super::depth::nearer_by;
use super::few_samples;
use super::fragments::Fragments;
use super::geometry::Geometry;
use super::lanes::{Lanes, in_all_lanes};
use super::picture::Picture;
use super::search::bins::BatchBins;
use super::search::clusters::{Cluster, Sight, sight};
use super::search::extent::Extent;
use super::search::finder::Finder;
use super::search::instances::{Instance, PlacedVertices, placed_box};
use super::setup::{AxisBounds, FlatSetup, Setup};
use super::size_class::{FEW, SizeClass, VERY_FEW};
use super::tile::TileBuffer;
use super::vertices::{FixedPointRaster, ON_RASTER, OUT_OF_SIGHT, Vertex};
use super::{many_samples, one_primitive, thin};
use bothways_common::Shape;
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{
    Level, Simd, SimdBase, SimdMask, apart, dispatch_with, i32x16, mask32x16,
};
use bothways_common::observe::Events;
use bothways_common::raster::Region;
use std::ops::Range;

/// All that the tiles of a frame share while they are drawn.
pub(super) struct Drawing<'a> {
    pub(super) geometry: &'a Geometry<'a>,
    pub(super) picture: &'a Picture<'a>,
    pub(super) bins: &'a [BatchBins],
    pub(super) level: Level,
}

impl Drawing<'_> {
    /// Draws all primitives of a tile. Stops, and returns `false`, if the event sink has enough.
    pub(super) fn draw_tile<C: ScalarContext>(
        &self,
        context: &mut C,
        tile: usize,
        buffer: &mut TileBuffer,
    ) -> bool {
        let mut painter = Painter {
            drawing: self,
            finder: Finder::new(self.geometry),
            gathered: Lanes::new(),
            waiting: [Lanes::new(), Lanes::new(), Lanes::new()],
            thin: Vec::new(),
            fragments: Fragments::new(),
            large: Vec::new(),
            buffer,
            context,
        };
        painter.draw_clusters(tile);
        for bins in self.bins {
            for class in SizeClass::IN_LANES {
                painter.draw_list(class, bins.list(tile, class));
            }
            let Painter { large, finder, .. } = &mut painter;
            large.extend(bins.list(tile, SizeClass::Large).iter().map(|slot| finder.name(*slot)));
            painter.draw_large();
        }
        painter.draw_instances(tile);
        painter.goes_on()
    }
}

/// As many large primitives of instances may wait before they are drawn.
const MANY_LARGE: usize = 256;

/// Draws into one tile.
struct Painter<'a, 'b, C> {
    drawing: &'a Drawing<'a>,
    finder: Finder<'a>,
    /// Triangles of a cluster, in the order of the cluster.
    gathered: Lanes,
    /// Triangles of each of [`SizeClass::IN_LANES`] that wait until there are sixteen.
    waiting: [Lanes; 3],
    /// Thin triangles that wait for the end of a batch of sixteen.
    thin: Vec<FlatSetup>,
    fragments: Fragments,
    /// Primitives of the current batch that are drawn at its end.
    large: Vec<u32>,
    buffer: &'b mut TileBuffer,
    context: &'b mut C,
}

impl<C: ScalarContext> Painter<'_, '_, C> {
    /// Whether to go on: the event sink does not have enough yet.
    #[inline(always)]
    fn goes_on(&mut self) -> bool {
        !(C::WATCHED && self.context.sink().has_enough())
    }

    /// Draws the clusters that may be seen in the tile. The nearer ones come first, because clusters that they hide
    /// need not be drawn. Otherwise clusters keep their order, in which neighbours share vertices.
    fn draw_clusters(&mut self, tile: usize) {
        let drawing = self.drawing;
        let clusters = || drawing.bins.iter().flat_map(|bins| bins.clusters(tile));
        let keys = || clusters().map(|cluster| cluster.extent.nearest);
        let (low, high) = (keys().fold(f32::INFINITY, f32::min), keys().fold(0.0, f32::max));
        let middle = f32::midpoint(low, high);
        for nearer in [true, false] {
            for cluster in clusters().filter(|cluster| (cluster.extent.nearest >= middle) == nearer)
            {
                if !self.goes_on() {
                    return;
                }
                self.buffer.executed.clusters += 1;
                // If the loops are watched, every triangle is an event.
                if C::WATCHED || !self.hides(&cluster.extent) {
                    self.sort_cluster(cluster);
                } else {
                    self.buffer.executed.clusters_skipped += 1;
                }
            }
            for class in SizeClass::IN_LANES {
                self.draw_waiting(class);
            }
        }
        self.draw_large();
    }

    /// Whether a whole cluster or instance is certainly farther, in the tile, than what is drawn there.
    ///
    /// The depth along the view is linear in space, and the largest key is that of the least depth. In a box, that is
    /// at a corner, whose key is off by less than a fragment's key may be.
    fn hides(&self, extent: &Extent) -> bool {
        let here = extent.region().intersection(self.buffer.region());
        let farthest = extent.nearest * nearer_by::<C::Fault>();
        dispatch_with!(C::Fault, self.drawing.level, simd => self.buffer.is_nearer(simd, &here, farthest))
    }

    /// Looks at the triangles of a cluster. Those that may be seen in the tile wait until there are sixteen of their
    /// size class.
    fn sort_cluster(&mut self, cluster: &Cluster) {
        let Cluster { object, first, count, .. } = *cluster;
        let (first_name, triangles, vertices) = self.finder.object(object);
        self.sort_triangles(count, |place| {
            let index = first + place;
            let corners = triangles.corners[index as usize].map(|vertex| vertices[vertex as usize]);
            (first_name + triangles.number(index), corners)
        });
    }

    /// Sorts triangles by class, given by their places from 0 to a count; draws what does not wait any longer.
    #[inline(always)]
    fn sort_triangles(&mut self, count: u32, triangle: impl Fn(u32) -> (u32, [Vertex; 3])) {
        self.buffer.executed.triangles += u64::from(count);
        for first in (0..count).step_by(16) {
            let sixteen = (count - first).min(16) as usize;
            dispatch_with!(C::Fault, self.drawing.level, simd => {
                self.gathered.fill(simd, sixteen, |lane| {
                    triangle(first + u32::try_from(lane).expect("there are sixteen lanes"))
                });
                let Painter { drawing, gathered, waiting, large, buffer, .. } = self;
                let (raster, tile) = (drawing.geometry.raster, buffer.region());
                sort::<_, C::Fault>(simd, raster, tile, gathered, (waiting, large));
            });
            for class in SizeClass::IN_LANES {
                if self.waiting[class as usize].are_full() {
                    self.draw_waiting(class);
                }
            }
        }
    }

    /// Draws the instances that may be seen in the tile, the nearest first: those that they hide need not be drawn.
    fn draw_instances(&mut self, tile: usize) {
        let bins = self.drawing.bins;
        let mut instances: Vec<&Instance> =
            bins.iter().flat_map(|bins| bins.instances(tile)).collect();
        if instances.is_empty() {
            return;
        }
        instances.sort_by(|a, b| b.extent.nearest.total_cmp(&a.extent.nearest));
        let mut vertices = [[0; 4]; _];
        for instance in instances {
            if !self.goes_on() {
                return;
            }
            // If the loops are watched, every triangle is an event.
            if C::WATCHED || !self.hides(&instance.extent) {
                if self.buffer.names.are_used_up() {
                    self.give_names_anew();
                }
                self.sort_instance(instance, &mut vertices);
            } else {
                self.buffer.executed.clusters += 1;
                self.buffer.executed.clusters_skipped += 1;
            }
            if self.large.len() >= MANY_LARGE {
                self.draw_large();
            }
        }
        self.draw_all_waiting();
    }

    /// Draws all that waits.
    fn draw_all_waiting(&mut self) {
        for class in SizeClass::IN_LANES {
            self.draw_waiting(class);
        }
        self.draw_large();
    }

    /// Gives new names to the instances that are seen, as names are used up.
    #[cold]
    fn give_names_anew(&mut self) {
        // What waits has names that others will have.
        self.draw_all_waiting();
        self.buffer.give_names_anew();
    }

    /// Looks at the clusters of an instance, and at the triangles of those that may be seen in the tile.
    fn sort_instance(&mut self, instance: &Instance, vertices: &mut PlacedVertices) {
        let Drawing { geometry, level, .. } = *self.drawing;
        let object = instance.object as usize;
        let scene = geometry.view.scene;
        let (Shape::Instances(instances), Some(mesh)) =
            (&scene.objects()[object].shape, &geometry.shared[object])
        else {
            unreachable!("only instances of meshes are listed");
        };
        let placement = &instances.placements()[instance.number as usize];
        let triangles = mesh.triangle_count();
        let first_id = scene.first_id(object) + u64::from(instance.number) * u64::from(triangles);
        let first_name = self.buffer.names.of_instance(first_id, triangles);
        let onto = (geometry.map, geometry.raster);
        let is_whole = mesh.clusters.len() == 1;
        for cluster in &mesh.clusters {
            if !is_whole {
                self.buffer.executed.boxes_tested += 1;
                let seen = dispatch_with!(C::Fault, level, simd => {
                    sight(simd, onto, &placed_box(placement, &cluster.bounds))
                });
                match seen {
                    Sight::Nowhere => continue,
                    Sight::Within(extent) => {
                        if extent.region().intersection(self.buffer.region()).is_empty() {
                            continue;
                        }
                        if !C::WATCHED && self.hides(&extent) {
                            self.buffer.executed.clusters += 1;
                            self.buffer.executed.clusters_skipped += 1;
                            continue;
                        }
                    }
                    Sight::Anywhere => {}
                }
            }
            self.buffer.executed.clusters += 1;
            dispatch_with!(C::Fault, level, simd => {
                mesh.place(simd, onto, placement, cluster, vertices);
            });
            self.sort_triangles(cluster.count(), |place| {
                let (number, corners) = cluster.triangle(mesh, place, vertices);
                (first_name + number, corners)
            });
        }
    }

    /// Draws the triangles that wait, at most sixteen.
    fn draw_waiting(&mut self, class: SizeClass) {
        let Painter { drawing, waiting, thin, fragments, large, buffer, context, .. } = self;
        let lanes = &mut waiting[class as usize];
        let count = lanes.count();
        if count == 0 {
            return;
        }
        buffer.executed.set_ups += count as u64;
        dispatch_with!(C::Fault, drawing.level, simd => {
            let context = &mut context.with_simd(simd);
            let (raster, picture) = (drawing.geometry.raster, drawing.picture);
            let setup = Setup::new::<_, C::Fault>(simd, raster, lanes);
            if class == SizeClass::Many {
                let mut elsewhere = setup.uncertain | setup.keyless;
                large.extend(setup.ids_of(elsewhere));
                // If the loops are watched, every test is an event.
                let thin_lanes = setup.thin & !elsewhere;
                if thin_lanes != 0 && !C::WATCHED {
                    elsewhere |= thin_lanes;
                    setup.add_triangles(thin_lanes, thin);
                }
                let lanes = u16::MAX >> (16 - count) & !elsewhere;
                many_samples::draw_lanes(context, &setup, lanes, picture, buffer);
            } else {
                if setup.uncertain != 0 {
                    large.extend(setup.ids_of(setup.uncertain));
                }
                apart!(simd, few_samples::draw(context, &setup, picture, fragments, buffer));
            }
        });
        lanes.advance();
        if !self.thin.is_empty() {
            self.draw_thin();
        }
    }

    /// Draws the thin triangles that wait. A function of its own leaves the loop over others as fast as it is without.
    #[inline(never)]
    fn draw_thin(&mut self) {
        let Painter { drawing, thin, fragments, buffer, context, .. } = self;
        dispatch_with!(C::Fault, drawing.level, simd => {
            let context = &mut context.with_simd(simd);
            for triangle in thin.drain(..) {
                let here = triangle.region.intersection(buffer.region());
                thin::draw(context, &triangle, &here, (drawing.picture, fragments), buffer);
            }
        });
    }

    /// Draws the triangles of a list.
    fn draw_list(&mut self, class: SizeClass, list: &[u32]) {
        for (slots, next) in list.chunks(16).zip((16..).step_by(16)) {
            if !self.goes_on() {
                return;
            }
            let Painter { drawing, waiting, finder, buffer, .. } = self;
            buffer.executed.triangles += slots.len() as u64;
            let lanes = &mut waiting[class as usize];
            dispatch_with!(C::Fault, drawing.level, simd => {
                lanes.fill(simd, slots.len(), |lane| finder.triangle(slots[lane]));
            });
            // Larger triangles of a tile may lie anywhere in memory. Small ones are mostly neighbours, for which this
            // would cost more than it saves.
            if class == SizeClass::Many {
                finder.look_ahead(list, next);
            }
            self.draw_waiting(class);
        }
    }

    /// Draws the large primitives of a batch, and asks the judge about all that is left open.
    fn draw_large(&mut self) {
        let Painter { drawing, fragments, large, buffer, context, .. } = self;
        if !large.is_empty() {
            buffer.executed.one_by_one += large.len() as u64;
            dispatch_with!(C::Fault, drawing.level, simd => {
                let context = &mut context.with_simd(simd);
                one_primitive::draw(context, large, (drawing.picture, fragments), buffer);
            });
            large.clear();
        }
        buffer.settle(&mut context.scalar(), drawing.picture);
    }
}

/// Sorts triangles by class: those that may be seen in the tile wait with others of their class; large ones, and those whose place
/// is not known, are drawn at the end. It is compiled once for all loops that call it.
#[inline(never)]
fn sort<S: Simd, F: Fault>(
    simd: S,
    raster: &FixedPointRaster,
    tile: &Region,
    triangles: &Lanes,
    to: (&mut [Lanes; 3], &mut Vec<u32>),
) {
    apart!(simd, sort_sixteen::<S, F>(simd, raster, tile, triangles, to));
}

/// What [`sort`] does.
#[inline(always)]
fn sort_sixteen<S: Simd, F: Fault>(
    simd: S,
    raster: &FixedPointRaster,
    tile: &Region,
    triangles: &Lanes,
    (waiting, large): (&mut [Lanes; 3], &mut Vec<u32>),
) {
    let splat = |value: i32| i32x16::splat(simd, value);
    let flags = triangles.flags(simd) & splat(ON_RASTER | OUT_OF_SIGHT);
    let on_raster = triangles.used(simd) & flags.simd_eq(splat(ON_RASTER));
    let unknown = triangles.used(simd) & flags.simd_eq(splat(0));

    let down = AxisBounds::new::<F>(simd, raster, 0, &triangles.places(simd, 0));
    let across = AxisBounds::new::<F>(simd, raster, 1, &triangles.places(simd, 1));
    let overlaps = overlaps(simd, &down, &tile.rows) & overlaps(simd, &across, &tile.columns);
    let here = on_raster & overlaps;
    let short = down.is_short(simd, raster) & across.is_short(simd, raster);
    let samples = down.count * across.count;
    let few = samples.simd_le(splat(FEW.cast_signed()));
    let very_few = samples.simd_le(splat(VERY_FEW.cast_signed()));
    let small = here & short;
    let by_class = [small & very_few, small & few & !very_few, small & !few];
    for (waiting, which) in waiting.iter_mut().zip(by_class) {
        // A mesh has hardly any triangles of some classes.
        if which.any_true() {
            waiting.add(simd, triangles, which);
        }
    }
    let others = (here & !short | unknown).to_bitmask();
    if others != 0 {
        large.extend(triangles.ids_of(others));
    }
}

/// Whether sides of boxes overlap that of a tile.
#[inline(always)]
fn overlaps<S: Simd>(simd: S, side: &AxisBounds<S>, tile: &Range<usize>) -> mask32x16<S> {
    let end = side.first + side.count;
    side.count.simd_gt(i32x16::splat(simd, 0))
        & side.first.simd_lt(in_all_lanes(simd, tile.end))
        & end.simd_gt(in_all_lanes(simd, tile.start))
}
