//! Draws all primitives of a tile: first the clusters, then batch by batch what is not in clusters, by how
//! large it is.

use super::bins::{BatchBins, Binning, Class};
use super::clusters::{Cluster, Triangles};
use super::lanes::Lanes;
use super::setup::{Setup, Side};
use super::small::{self, Fragments};
use super::tile::{Picture, TileBuffer, nearer_by};
use super::vertices::{ON_RASTER, OUT_OF_SIGHT, Vertex};
use super::{block, large};
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{
    Level, Simd, SimdBase, SimdMask, dispatch_with, i32x16, mask32x16, prefetch,
};
use bothways_common::observe::EventSink;
use std::ops::Range;

/// What drawing needs to know of the frame.
pub(super) struct Drawing<'a> {
    pub(super) binning: &'a Binning<'a>,
    pub(super) picture: &'a Picture<'a>,
    pub(super) bins: &'a [BatchBins],
    pub(super) level: Level,
}

impl Drawing<'_> {
    /// Draws all primitives of a tile; or not all, and tells so, if who watches has enough.
    pub(super) fn draw_tile<O: EventSink + ?Sized, F: Fault>(
        &self,
        tile: usize,
        buffer: &mut TileBuffer,
        observer: &mut O,
    ) -> bool {
        let mut painter = Painter {
            drawing: self,
            find: Finder::new(self.binning),
            gathered: Lanes::new(),
            waiting: [Lanes::new(), Lanes::new(), Lanes::new()],
            fragments: Fragments::new(),
            large: Vec::new(),
            buffer,
            observer,
        };
        painter.draw_clusters::<F>(tile);
        for bins in self.bins {
            for class in IN_LANES {
                painter.draw_list::<F>(class, bins.list(tile, class));
            }
            let Painter { large, find, .. } = &mut painter;
            large.extend(bins.list(tile, Class::Large).iter().map(|place| find.id(*place)));
            painter.draw_large::<F>();
        }
        painter.goes_on()
    }
}

/// The classes whose triangles are set up together.
const IN_LANES: [Class; 3] = [Class::Tiny, Class::Small, Class::Block];

/// Draws into one tile.
struct Painter<'a, 'b, O: ?Sized> {
    drawing: &'a Drawing<'a>,
    find: Finder<'a>,
    /// Triangles of a cluster, as they come.
    gathered: Lanes,
    /// Triangles of each of [`IN_LANES`] that wait until there are sixteen.
    waiting: [Lanes; 3],
    fragments: Fragments,
    /// Primitives of the current batch that are drawn at its end.
    large: Vec<u32>,
    buffer: &'b mut TileBuffer,
    observer: &'b mut O,
}

impl<O: EventSink + ?Sized> Painter<'_, '_, O> {
    /// Whether there is anybody to draw for.
    #[inline(always)]
    fn goes_on(&mut self) -> bool {
        !(O::ENABLED && self.observer.has_enough())
    }

    /// Draws the clusters that may be seen in the tile: the nearer ones first, because what they hide need
    /// not be drawn. Otherwise clusters keep their order, in which neighbours share vertices.
    fn draw_clusters<F: Fault>(&mut self, tile: usize) {
        let drawing = self.drawing;
        let clusters = || drawing.bins.iter().flat_map(|bins| bins.clusters(tile));
        let keys = || clusters().map(|cluster| cluster.nearest);
        let (low, high) = (keys().fold(f32::INFINITY, f32::min), keys().fold(0.0, f32::max));
        let middle = f32::midpoint(low, high);
        for nearer in [true, false] {
            for cluster in clusters().filter(|cluster| (cluster.nearest >= middle) == nearer) {
                if !self.goes_on() {
                    return;
                }
                // Who watches is told of every triangle.
                if O::ENABLED || !self.hides::<F>(cluster) {
                    self.sort_cluster::<F>(cluster);
                }
            }
            for class in IN_LANES {
                self.draw_waiting::<F>(class);
            }
        }
        self.draw_large::<F>();
    }

    /// Whether all of a cluster in the tile is certainly farther than what is drawn there.
    ///
    /// The depth along the view is linear in space, and the largest key is that of the least depth: of a box
    /// at a corner, from which it is off by less than a fragment's key may be.
    fn hides<F: Fault>(&self, cluster: &Cluster) -> bool {
        let here = cluster.region().intersection(self.buffer.region());
        let farthest = cluster.nearest * nearer_by::<F>();
        dispatch_with!(F, self.drawing.level, simd => self.buffer.is_nearer(simd, &here, farthest))
    }

    /// Looks at the triangles of a cluster, and lets those that may be seen in the tile wait for others of
    /// their class.
    fn sort_cluster<F: Fault>(&mut self, cluster: &Cluster) {
        let Cluster { object, first, count, .. } = *cluster;
        let (first_id, triangles, vertices) = self.find.object(object);
        for first in (first..first + count).step_by(16) {
            let sixteen = (cluster.first + count - first).min(16) as usize;
            dispatch_with!(F, self.drawing.level, simd => {
                self.gathered.fill(simd, sixteen, |lane| {
                    let place = first + u32::try_from(lane).expect("there are sixteen lanes");
                    let corners = triangles.corners[place as usize].map(|vertex| vertices[vertex as usize]);
                    (first_id + triangles.number(place), corners)
                });
                self.sort::<_, F>(simd);
            });
            for class in IN_LANES {
                if self.waiting[class as usize].are_full() {
                    self.draw_waiting::<F>(class);
                }
            }
        }
    }

    /// Shares the gathered triangles out by class.
    #[inline(always)]
    fn sort<S: Simd, F: Fault>(&mut self, simd: S) {
        let (raster, lanes) = (self.drawing.binning.raster, &self.gathered);
        let splat = |value: i32| i32x16::splat(simd, value);
        let flags = lanes.flags(simd) & splat(ON_RASTER | OUT_OF_SIGHT);
        let on_raster = lanes.used(simd) & flags.simd_eq(splat(ON_RASTER));
        let unknown = lanes.used(simd) & flags.simd_eq(splat(0));

        let across = Side::new::<F>(simd, raster, 0, &lanes.places(simd, 0));
        let down = Side::new::<F>(simd, raster, 1, &lanes.places(simd, 1));
        let tile = self.buffer.region();
        let overlaps = overlaps(simd, &across, &tile.columns) & overlaps(simd, &down, &tile.rows);
        let here = on_raster & overlaps;
        let short = across.is_short(simd, raster) & down.is_short(simd, raster);
        let samples = across.count * down.count;
        let few = samples.simd_le(splat(small::MOST_SAMPLES.cast_signed()));
        let very_few = samples.simd_le(splat(small::VERY_FEW_SAMPLES.cast_signed()));
        let small = here & short;
        let by_class = [small & very_few, small & few & !very_few, small & !few];
        for (waiting, which) in self.waiting.iter_mut().zip(by_class) {
            // Of some classes a mesh has hardly any.
            if which.any_true() {
                waiting.add(simd, lanes, which);
            }
        }
        let large = (here & !short | unknown).to_bitmask();
        if large != 0 {
            self.large.extend(lanes.ids_of(large));
        }
    }

    /// Draws the triangles that wait, at most sixteen.
    fn draw_waiting<F: Fault>(&mut self, class: Class) {
        let Painter { drawing, waiting, fragments, large, buffer, observer, .. } = self;
        let lanes = &mut waiting[class as usize];
        let count = lanes.count();
        if count == 0 {
            return;
        }
        dispatch_with!(F, drawing.level, simd => {
            let setup = Setup::new::<_, F>(simd, drawing.binning.raster, lanes);
            if class == Class::Block {
                let elsewhere = setup.doubtful | setup.keyless;
                large.extend(setup.lanes(elsewhere));
                for lane in (0..count).filter(|lane| elsewhere >> lane & 1 == 0) {
                    let picture = drawing.picture;
                    block::draw::<_, O, F>(simd, &setup.triangle(lane), picture, buffer, *observer);
                }
            } else {
                if setup.doubtful != 0 {
                    large.extend(setup.lanes(setup.doubtful));
                }
                let picture = drawing.picture;
                small::draw::<_, O, F>(simd, &setup, picture, fragments, buffer, *observer);
            }
        });
        lanes.advance();
    }

    /// Draws the triangles of a list.
    fn draw_list<F: Fault>(&mut self, class: Class, list: &[u32]) {
        for (places, next) in list.chunks(16).zip((16..).step_by(16)) {
            if !self.goes_on() {
                return;
            }
            let Painter { drawing, waiting, find, .. } = self;
            let lanes = &mut waiting[class as usize];
            dispatch_with!(F, drawing.level, simd => {
                lanes.fill(simd, places.len(), |lane| find.triangle(places[lane]));
            });
            // Larger triangles of a tile may lie anywhere in memory. Small ones are neighbours, as meshes
            // go, so that this would cost more than it saves.
            if class == Class::Block {
                find.look_ahead(list, next);
            }
            self.draw_waiting::<F>(class);
        }
    }

    /// Draws what is left of a batch, and asks the judge what is left open.
    fn draw_large<F: Fault>(&mut self) {
        let Painter { drawing, large, buffer, observer, .. } = self;
        if !large.is_empty() {
            dispatch_with!(F, drawing.level, simd => {
                large::draw::<_, O, F>(simd, large, drawing.picture, buffer, *observer);
            });
            large.clear();
        }
        buffer.settle::<O, F>(drawing.picture, *observer);
    }
}

/// Whether sides of boxes overlap that of a tile.
#[inline(always)]
fn overlaps<S: Simd>(simd: S, side: &Side<S>, tile: &Range<usize>) -> mask32x16<S> {
    let splat = |value: usize| {
        i32x16::splat(simd, i32::try_from(value).expect("a side has at most 65,536 samples"))
    };
    let end = side.first + side.count;
    side.count.simd_gt(splat(0))
        & side.first.simd_lt(splat(tile.end))
        & end.simd_gt(splat(tile.start))
}

/// Finds triangles by their places, which mostly come in their order.
struct Finder<'a> {
    binning: &'a Binning<'a>,
    /// The ids of the current object's primitives.
    ids: Range<u32>,
    /// Its triangles, none for what is no mesh.
    triangles: Triangles<'a>,
    /// Its vertices, and those behind.
    vertices: &'a [Vertex],
}

impl<'a> Finder<'a> {
    fn new(binning: &'a Binning<'a>) -> Self {
        Finder { binning, ids: 0..0, triangles: Triangles::NONE, vertices: &[] }
    }

    /// The id of an object's first primitive, its triangles and vertices.
    fn object(&mut self, object: u32) -> (u32, Triangles<'a>, &'a [Vertex]) {
        let object = object as usize;
        let Binning { view, clusters, vertices, first_vertices, .. } = self.binning;
        let first_id = view.scene.first_id(object);
        let triangles = clusters[object].triangles(&view.scene.objects()[object].shape);
        (first_id, triangles, &vertices[first_vertices[object]..])
    }

    /// The id and the vertices of a triangle.
    #[inline(always)]
    fn triangle(&mut self, place: u32) -> (u32, [Vertex; 3]) {
        self.find_object(place);
        let own = place - self.ids.start;
        let id = self.ids.start + self.triangles.number(own);
        let triangle = self.triangles.corners.get(own as usize).copied().unwrap_or([0, 1, 2]);
        (id, triangle.map(|vertex| self.vertices[vertex as usize]))
    }

    /// The id of any primitive.
    fn id(&mut self, place: u32) -> u32 {
        self.find_object(place);
        self.ids.start + self.triangles.number(place - self.ids.start)
    }

    /// Prepares for the sixteen triangles from `next` on, and a little for the sixteen behind them.
    #[inline(always)]
    fn look_ahead(&self, places: &[u32], next: usize) {
        let corners = self.triangles.corners;
        let triangle = |place: u32| corners.get(place.wrapping_sub(self.ids.start) as usize);
        let from = |start: usize| places.get(start..).unwrap_or_default().iter().take(16);
        for &place in from(next + 16) {
            triangle(place).into_iter().for_each(prefetch);
        }
        for &place in from(next) {
            for vertex in triangle(place).into_iter().flatten() {
                prefetch(&self.vertices[*vertex as usize]);
            }
        }
    }

    #[inline(always)]
    fn find_object(&mut self, place: u32) {
        if !self.ids.contains(&place) {
            self.find_other_object(place);
        }
    }

    #[cold]
    fn find_other_object(&mut self, place: u32) {
        let scene = self.binning.view.scene;
        let (object, _) = scene.locate(place);
        let number = |count: usize| u32::try_from(count).expect("ids are u32");
        let count = number(scene.objects()[object].shape.primitive_count());
        let (first, triangles, vertices) = self.object(number(object));
        (self.ids, self.triangles, self.vertices) = (first..first + count, triangles, vertices);
    }
}
