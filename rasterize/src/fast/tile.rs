//! One tile of the picture: its z-buffer, and the decisions that rounding left open.

use super::depth::{NOTHING, Rank, rank};
use super::picture::{Picture, judge_covers};
use super::search::tiling::Tiling;
use super::sphere::nearer;
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::names::Names;
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x16};
use bothways_common::exact::CachedJudge;
use bothways_common::frame::NO_PRIMITIVE;
use bothways_common::observe::{Events, Executed, Question};
use bothways_common::raster::{Region, Sample};
use bothways_common::{Primitive, View};
use std::cmp::Ordering;

/// The samples of one tile: what is seen so far, and how near it is.
#[derive(Debug)]
pub(super) struct TileBuffer {
    region: Region,
    /// Samples from one row to the next: more than a row has, so that sixteen at a time may reach
    /// over its end.
    stride: usize,
    /// The name of the primitive that is seen, where the key says that one is.
    ids: Vec<u32>,
    /// Depth keys; [`NOTHING`] where nothing is seen, and everywhere between two tiles.
    keys: Vec<f32>,
    open: Vec<OpenFragment>,
    judge: CachedJudge,
    pub(super) names: Names,
    /// The last ids, incoming and stored, that were found to be tied everywhere without being the same.
    tied: Option<[u32; 2]>,
    /// The last two ids that were compared (at first, those of no primitive), and whether they are the same
    /// triangle twice.
    compared: ([u32; 2], bool),
    /// What was executed for the tile.
    pub(super) executed: Executed,
}

/// A fragment, or a sample that may be one, that waits for the judge.
#[derive(Clone, Copy, Debug)]
struct OpenFragment {
    index: u32,
    id: u32,
    key: f32,
    /// Whether only its depth is open.
    covered: bool,
}

/// A primitive whose fragments come to a depth test. It is looked up when it is needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Incoming {
    pub(super) id: u32,
    pub(super) primitive: Option<Primitive>,
}

impl Incoming {
    fn primitive(&mut self, picture: &Picture, names: &Names) -> Primitive {
        *self.primitive.get_or_insert_with(|| names.primitive(picture.view, self.id))
    }
}

/// The samples of room behind the end of a row.
const SPARE: usize = 16;

/// The most fragments that wait for the judge: they fill a quarter of a MiB.
const MOST_OPEN: usize = 1 << 14;

impl TileBuffer {
    /// A buffer for tiles of this size.
    pub(super) fn new(view: &View, tiling: &Tiling) -> Self {
        let stride = tiling.columns + SPARE;
        let samples = stride * (tiling.rows + 1);
        TileBuffer {
            judge: CachedJudge::new(view.judge()),
            names: Names::new(view.scene),
            region: Region { rows: 0..0, columns: 0..0 },
            stride,
            ids: vec![NO_PRIMITIVE; samples],
            keys: vec![NOTHING; samples],
            open: Vec::new(),
            tied: None,
            compared: ([NO_PRIMITIVE; 2], false),
            executed: Executed::default(),
        }
    }

    /// Whether it was made for tiles of this size.
    pub(super) fn fits(&self, tiling: &Tiling) -> bool {
        self.stride == tiling.columns + SPARE && self.ids.len() == self.stride * (tiling.rows + 1)
    }

    /// Starts a tile in which nothing is seen.
    pub(super) fn begin(&mut self, view: &View, region: &Region) {
        self.judge = CachedJudge::new(view.judge());
        self.names = Names::new(view.scene);
        self.tied = None;
        self.compared = ([NO_PRIMITIVE; 2], false);
        self.region = region.clone();
        self.executed = Executed::default();
    }

    /// Forgets what was drawn into the tile.
    pub(super) fn clear(&mut self) {
        self.keys.fill(NOTHING);
        self.open.clear();
    }

    /// Where the tile lies in the picture.
    pub(super) fn region(&self) -> &Region {
        &self.region
    }

    /// Samples from one row to the next.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// The index of a sample of the tile.
    pub(super) fn index(&self, sample: Sample) -> usize {
        (sample.row - self.region.rows.start) * self.stride + sample.column
            - self.region.columns.start
    }

    /// The sample of an index.
    pub(super) fn sample(&self, index: usize) -> Sample {
        Sample {
            row: self.region.rows.start + index / self.stride,
            column: self.region.columns.start + index % self.stride,
        }
    }

    /// Ids and keys of the samples from `index` on.
    pub(super) fn from(&mut self, index: usize) -> (&mut [u32], &mut [f32]) {
        (&mut self.ids[index..], &mut self.keys[index..])
    }

    /// Whether all keys that are stored in a region are larger than this one.
    #[inline(always)]
    pub(super) fn is_nearer<S: Simd>(&self, simd: S, region: &Region, key: f32) -> bool {
        let key = f32x16::splat(simd, key);
        region.rows.clone().all(|row| {
            let start = self.index(Sample { row, column: region.columns.start });
            let keys = &self.keys[start..start + region.columns.len() + SPARE];
            (0..region.columns.len()).step_by(16).all(|column| {
                let stored = f32x16::from_slice(simd, &keys[column..column + 16]);
                let beyond = u64::MAX << (region.columns.len() - column).min(16);
                stored.simd_gt(key).to_bitmask() | beyond == u64::MAX
            })
        })
    }

    /// Leaves to the judge whether a fragment is nearest, or whether it is one. When too many wait, all are
    /// settled at once: the order of depth tests changes nothing.
    #[inline(always)]
    pub(super) fn leave_open<C: ScalarContext>(
        &mut self,
        context: &mut C,
        picture: &Picture,
        (index, id, key): (usize, u32, f32),
        covered: bool,
    ) {
        if !C::has(Planted::TiesToLast) && covered && self.loses_tie(picture, index, id) {
            if C::WATCHED {
                // The event is that of any other tie.
                context.sink().judged(self.sample(index), Question::Nearest);
                self.emit_depth_test(context, index, id, false);
            }
            return;
        }
        if self.open.len() == MOST_OPEN {
            self.settle(&mut context.scalar(), picture);
        }
        let index = u32::try_from(index).expect("a tile is small");
        self.open.push(OpenFragment { index, id, key, covered });
    }

    /// Whether a fragment is known to be tied with the stored one, because its triangle is the same or lies in the same
    /// plane, and is the later of the two.
    #[inline(always)]
    fn loses_tie(&mut self, picture: &Picture, index: usize, id: u32) -> bool {
        let stored = self.ids[index];
        let pair = [id, stored];
        self.keys[index] != NOTHING
            && self.names.precedes(stored, id)
            && (self.tied == Some(pair) || self.are_same(picture, pair))
    }

    /// Whether this primitive is known to be the same triangle as an earlier one in the tile, so that it is seen
    /// nowhere. Not if the loops are watched, because all its fragments are events; nor with the fault that decides
    /// otherwise.
    pub(super) fn is_duplicate<C: ScalarContext>(&self, id: u32) -> bool {
        let ([last, stored], are_same) = self.compared;
        let drops = !(C::WATCHED || C::has(Planted::TiesToLast));
        drops && are_same && last == id && self.names.precedes(stored, id)
    }

    /// Whether two primitives are the same triangle: they mostly meet at several samples, one after the
    /// other.
    #[inline(always)]
    fn are_same(&mut self, picture: &Picture, pair: [u32; 2]) -> bool {
        if self.compared.0 != pair {
            let [one, other] = pair.map(|name| self.names.id(name));
            self.compared = (pair, picture.view.scene.are_same_triangle(one, other));
        }
        self.compared.1
    }

    /// The depth test: keeps the nearer of a fragment and what is stored.
    #[inline(always)]
    pub(super) fn fragment<C: ScalarContext>(
        &mut self,
        context: &mut C,
        picture: &Picture,
        (index, id, key): (usize, u32, f32),
    ) {
        let stored = self.keys[index];
        let rank = rank::<C::Fault>(key, stored);
        if rank == Rank::Unknown {
            self.leave_open(context, picture, (index, id, key), true);
            return;
        }
        if C::WATCHED {
            self.emit_depth_test(context, index, id, rank == Rank::Nearer);
        }
        // Both are written in any case: the machine cannot predict which is nearer.
        let nearer = rank == Rank::Nearer;
        self.keys[index] = if nearer { key } else { stored };
        self.ids[index] = if nearer { id } else { self.ids[index] };
    }

    /// Emits a fragment and its depth test, before it takes effect.
    fn emit_depth_test<C: ScalarContext>(
        &self,
        context: &mut C,
        index: usize,
        id: u32,
        nearer: bool,
    ) {
        let meets_earlier = self.keys[index] != NOTHING;
        let sink = context.sink();
        if let Some(counts) = sink.counts() {
            counts.fragments += 1;
            counts.depth_tests += u64::from(meets_earlier);
            return;
        }
        let sample = self.sample(index);
        let id = self.names.id(id);
        sink.fragment(sample, id);
        if meets_earlier {
            sink.depth_test(sample, id, self.names.id(self.ids[index]), nearer);
        }
    }

    /// Emits a fragment whose depth test is not left open, before it takes effect.
    pub(super) fn emit_certain<C: ScalarContext>(
        &self,
        context: &mut C,
        index: usize,
        id: u32,
        key: f32,
    ) {
        let rank = rank::<C::Fault>(key, self.keys[index]);
        if rank != Rank::Unknown {
            self.emit_depth_test(context, index, id, rank == Rank::Nearer);
        }
    }

    /// Asks the judge about all fragments that were left open.
    #[inline(never)]
    pub(super) fn settle<C: ScalarContext>(&mut self, context: &mut C, picture: &Picture) {
        let open = std::mem::take(&mut self.open);
        let mut current: Option<Incoming> = None;
        for OpenFragment { index, id, key, covered } in &open {
            let incoming = match &mut current {
                Some(incoming) if incoming.id == *id => incoming,
                _ => current.insert(Incoming { id: *id, primitive: None }),
            };
            let index = *index as usize;
            let covered = *covered || {
                let primitive = incoming.primitive(picture, &self.names);
                let (sample, id) = (self.sample(index), self.names.id(*id));
                judge_covers(context, picture, sample, id, &primitive)
            };
            if covered {
                self.settle_depth(context, picture, index, incoming, *key);
            }
        }
        self.open = open;
        self.open.clear();
    }

    /// The depth test at once, by the judge if need be.
    pub(super) fn settle_depth<C: ScalarContext>(
        &mut self,
        context: &mut C,
        picture: &Picture,
        index: usize,
        incoming: &mut Incoming,
        key: f32,
    ) {
        let stored = self.keys[index];
        let nearer = match rank::<C::Fault>(key, stored) {
            Rank::Nearer => true,
            Rank::Farther => false,
            Rank::Unknown if stored == NOTHING => true,
            Rank::Unknown => self.judge_nearer(context, picture, index, incoming),
        };
        if C::WATCHED {
            self.emit_depth_test(context, index, incoming.id, nearer);
        }
        if nearer {
            self.keys[index] = key;
            self.ids[index] = incoming.id;
        }
    }

    /// Asks the judge whether a primitive is nearer than the one that is stored.
    fn judge_nearer<C: ScalarContext>(
        &mut self,
        context: &mut C,
        picture: &Picture,
        index: usize,
        incoming: &mut Incoming,
    ) -> bool {
        let (id, stored_id) = (incoming.id, self.ids[index]);
        if let Some(order) = self.compare_spheres::<C>(picture, index, incoming) {
            return order.is_lt();
        }
        if C::WATCHED {
            context.sink().judged(self.sample(index), Question::Nearest);
        }
        let before = self.names.precedes(id, stored_id) != C::has(Planted::TiesToLast);
        // Duplicates are the most frequent ties.
        if self.are_same(picture, [id, stored_id]) || self.tied == Some([id, stored_id]) {
            return before;
        }
        let primitive = incoming.primitive(picture, &self.names);
        let other = self.names.primitive(picture.view, stored_id);
        let Sample { row, column } = self.sample(index);
        let ray = picture.map.grid.ray(row, column);
        let (incoming, stored) = ((id, &primitive), (stored_id, &other));
        match self.judge.compare(incoming, stored, &ray).decided {
            Ordering::Less => true,
            Ordering::Greater => false,
            Ordering::Equal => {
                if self.judge.are_tied(incoming, stored) {
                    self.tied = Some([id, stored_id]);
                }
                before
            }
        }
    }

    /// Compares a sphere with the sphere that is stored, if both are spheres and `f64` is certain.
    fn compare_spheres<C: ScalarContext>(
        &self,
        picture: &Picture,
        index: usize,
        incoming: &Incoming,
    ) -> Option<Ordering> {
        let sphere = |primitive: Primitive| match primitive {
            Primitive::Sphere { center, radius } => Some((center, radius)),
            Primitive::Triangle(_) | Primitive::Plane { .. } => None,
        };
        let incoming = sphere(incoming.primitive?)?;
        if C::has(Planted::ZeroErrorBound) {
            return None;
        }
        let stored = sphere(self.names.primitive(picture.view, self.ids[index]))?;
        let Sample { row, column } = self.sample(index);
        nearer([incoming, stored], &picture.map.grid.ray(row, column))
    }

    /// Gives new names to the instances that are seen, as names are used up. Nothing is open, and nothing waits.
    pub(super) fn give_names_anew(&mut self) {
        let TileBuffer { names, ids, keys, .. } = self;
        names.give_anew(ids, |index| keys[index] != NOTHING);
        self.judge.forget();
        self.tied = None;
        self.compared = ([NO_PRIMITIVE; 2], false);
    }

    /// Whether a flat primitive covers no sample of this camera at all; see [`CachedJudge::is_edge_on`].
    pub(super) fn is_edge_on(&mut self, id: u32, primitive: &Primitive) -> bool {
        self.judge.is_edge_on(id, primitive)
    }
}
