//! One tile of the picture: its z-buffer, and the decisions that rounding left open.

use super::bins::Tiling;
use super::depth::{KeyScale, NEARER, NOTHING};
use super::round;
use super::screen::Screen;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdMask, f32x16, finish_streaming, mask32x16, stream, u32x16,
};
use bothways_common::exact::CachedJudge;
use bothways_common::frame::{NO_PRIMITIVE, Tile, stored_t};
use bothways_common::observe::{EventSink, Question};
use bothways_common::raster::{Region, Sample};
use bothways_common::{Primitive, Projection, View};
use std::cmp::Ordering;

/// What stays the same while a picture is drawn.
pub(super) struct Picture<'a> {
    pub(super) view: &'a View<'a>,
    pub(super) screen: &'a Screen<'a>,
    pub(super) keys: KeyScale,
}

/// The samples of one tile: what is seen so far, and how near it is.
#[derive(Debug)]
pub(super) struct TileBuffer {
    region: Region,
    /// Samples from one row to the next: some more than a row has, so that sixteen at a time may reach
    /// over its end.
    stride: usize,
    /// What is seen, where the key says that something is.
    ids: Vec<u32>,
    /// Depth keys; [`NOTHING`] for nothing, which all are between two tiles.
    keys: Vec<f32>,
    open: Vec<Open>,
    memory: CachedJudge,
    /// The last challenger and holder that were found to be tied everywhere without being the same.
    tied: Option<[u32; 2]>,
    /// The last two ids that were compared (at first, no primitives'), and whether they are the same
    /// triangle twice.
    compared: ([u32; 2], bool),
}

/// A fragment, or a sample that may be one, that waits for the judge.
#[derive(Clone, Copy, Debug)]
struct Open {
    index: u32,
    id: u32,
    key: f32,
    /// Whether only its depth is open.
    covered: bool,
}

/// A primitive whose fragments come to a depth test; it is looked up when it is needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Challenger {
    pub(super) id: u32,
    pub(super) primitive: Option<Primitive>,
}

impl Challenger {
    fn primitive(&mut self, picture: &Picture) -> Primitive {
        *self.primitive.get_or_insert_with(|| picture.view.primitive(self.id))
    }
}

/// Samples behind the end of a row and rows behind the last.
const SPARE: usize = 16;

/// So many fragments wait for the judge at most, in a quarter of a MiB, however many are tied.
const MOST_OPEN: usize = 1 << 14;

/// How a fragment's key relates to the one that its sample holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rank {
    Nearer,
    Farther,
    Unknown,
}

impl TileBuffer {
    /// A buffer for tiles of this size.
    pub(super) fn new(view: &View, tiling: &Tiling) -> Self {
        let stride = tiling.columns + SPARE;
        let samples = stride * (tiling.rows + 1);
        TileBuffer {
            memory: CachedJudge::new(view.judge()),
            region: Region { rows: 0..0, columns: 0..0 },
            stride,
            ids: vec![NO_PRIMITIVE; samples],
            keys: vec![NOTHING; samples],
            open: Vec::new(),
            tied: None,
            compared: ([NO_PRIMITIVE; 2], false),
        }
    }

    /// Whether it was made for tiles of this size.
    pub(super) fn fits(&self, tiling: &Tiling) -> bool {
        self.stride == tiling.columns + SPARE && self.ids.len() == self.stride * (tiling.rows + 1)
    }

    /// Starts a tile in which nothing is seen.
    pub(super) fn begin(&mut self, view: &View, region: &Region) {
        self.memory = CachedJudge::new(view.judge());
        self.tied = None;
        self.compared = ([NO_PRIMITIVE; 2], false);
        self.region = region.clone();
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

    /// Where a sample of the tile is kept.
    pub(super) fn index(&self, sample: Sample) -> usize {
        (sample.row - self.region.rows.start) * self.stride + sample.column
            - self.region.columns.start
    }

    /// The sample that is kept there.
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

    /// Whether all samples of a region hold keys larger than this one.
    #[inline(always)]
    pub(super) fn is_nearer<S: Simd>(&self, simd: S, region: &Region, key: f32) -> bool {
        let key = f32x16::splat(simd, key);
        region.rows.clone().all(|row| {
            let start = self.index(Sample { row, column: region.columns.start });
            let keys = &self.keys[start..start + region.columns.len() + SPARE];
            (0..region.columns.len()).step_by(16).all(|column| {
                let held = f32x16::from_slice(simd, &keys[column..column + 16]);
                let beyond = u64::MAX << (region.columns.len() - column).min(16);
                held.simd_gt(key).to_bitmask() | beyond == u64::MAX
            })
        })
    }

    /// Leaves to the judge whether a fragment is nearest, or whether it is one. When too many wait, all are
    /// settled at once: which fragment comes to its depth test first does not matter.
    #[inline(always)]
    pub(super) fn leave_open<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        picture: &Picture,
        (index, id, key): (usize, u32, f32),
        covered: bool,
        observer: &mut O,
    ) {
        if !F::is(Planted::TiesToLast) && covered && self.loses_tie(picture, index, id) {
            if O::ENABLED {
                // Who watches is told of it as of any other tie.
                observer.judged(self.sample(index), Question::Nearest);
                self.tell_depth_test(index, id, false, observer);
            }
            return;
        }
        if self.open.len() == MOST_OPEN {
            self.settle::<O, F>(picture, observer);
        }
        let index = u32::try_from(index).expect("a tile is small");
        self.open.push(Open { index, id, key, covered });
    }

    /// Whether a fragment is known to be tied with the one that its sample shows, as it is of the same triangle
    /// again or of one in the same plane, and is the later of the two.
    #[inline(always)]
    fn loses_tie(&mut self, picture: &Picture, index: usize, id: u32) -> bool {
        let holder = self.ids[index];
        let pair = [id, holder];
        self.keys[index] != NOTHING
            && id > holder
            && (self.tied == Some(pair) || self.are_same(picture, pair))
    }

    /// Whether this primitive is known to be the same triangle as an earlier one in the tile, so that it is seen
    /// nowhere. Who watches is told of all its fragments, and the fault decides otherwise.
    pub(super) fn is_twin<O: EventSink + ?Sized, F: Fault>(&self, id: u32) -> bool {
        let ([last, holder], are_same) = self.compared;
        let drops = !(O::ENABLED || F::is(Planted::TiesToLast));
        drops && are_same && last == id && holder < id
    }

    /// Whether two primitives are the same triangle: they mostly meet at several samples, one after the
    /// other.
    #[inline(always)]
    fn are_same(&mut self, picture: &Picture, pair: [u32; 2]) -> bool {
        if self.compared.0 != pair {
            self.compared = (pair, picture.view.scene.are_same_triangle(pair[0], pair[1]));
        }
        self.compared.1
    }

    /// The depth test: keeps the nearer of a fragment and what its sample shows so far.
    #[inline(always)]
    pub(super) fn fragment<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        picture: &Picture,
        (index, id, key): (usize, u32, f32),
        observer: &mut O,
    ) {
        let held = self.keys[index];
        let rank = rank::<F>(key, held);
        if rank == Rank::Unknown {
            self.leave_open::<O, F>(picture, (index, id, key), true, observer);
            return;
        }
        if O::ENABLED {
            self.tell_depth_test(index, id, rank == Rank::Nearer, observer);
        }
        // Both are written in any case: which is nearer cannot be guessed.
        let nearer = rank == Rank::Nearer;
        self.keys[index] = if nearer { key } else { held };
        self.ids[index] = if nearer { id } else { self.ids[index] };
    }

    /// Tells of a fragment and its depth test, before it takes effect.
    pub(super) fn tell_depth_test<O: EventSink + ?Sized>(
        &self,
        index: usize,
        id: u32,
        nearer: bool,
        observer: &mut O,
    ) {
        let is_held = self.keys[index] != NOTHING;
        if let Some(counts) = observer.counts() {
            counts.fragments += 1;
            counts.depth_tests += u64::from(is_held);
            return;
        }
        let sample = self.sample(index);
        observer.fragment(sample, id);
        if is_held {
            observer.depth_test(sample, id, self.ids[index], nearer);
        }
    }

    /// Tells of a fragment whose depth test is not left open, before it takes effect.
    pub(super) fn tell_certain<O: EventSink + ?Sized, F: Fault>(
        &self,
        index: usize,
        id: u32,
        key: f32,
        observer: &mut O,
    ) {
        let rank = rank::<F>(key, self.keys[index]);
        if rank != Rank::Unknown {
            self.tell_depth_test(index, id, rank == Rank::Nearer, observer);
        }
    }

    /// Asks the judge what was left open.
    #[inline(never)]
    pub(super) fn settle<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        picture: &Picture,
        observer: &mut O,
    ) {
        let open = std::mem::take(&mut self.open);
        let mut current: Option<Challenger> = None;
        for Open { index, id, key, covered } in &open {
            let challenger = match &mut current {
                Some(challenger) if challenger.id == *id => challenger,
                _ => current.insert(Challenger { id: *id, primitive: None }),
            };
            let index = *index as usize;
            let covered = *covered || {
                let (sample, primitive) = (self.sample(index), challenger.primitive(picture));
                judge_covers::<O, F>(picture, sample, *id, &primitive, observer)
            };
            if covered {
                self.settle_depth::<O, F>(picture, index, challenger, *key, observer);
            }
        }
        self.open = open;
        self.open.clear();
    }

    /// The depth test at once, by the judge if need be.
    pub(super) fn settle_depth<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        picture: &Picture,
        index: usize,
        challenger: &mut Challenger,
        key: f32,
        observer: &mut O,
    ) {
        let held = self.keys[index];
        let nearer = match rank::<F>(key, held) {
            Rank::Nearer => true,
            Rank::Farther => false,
            Rank::Unknown if held == NOTHING => true,
            Rank::Unknown => self.judge_nearer::<O, F>(picture, index, challenger, observer),
        };
        if O::ENABLED {
            self.tell_depth_test(index, challenger.id, nearer, observer);
        }
        if nearer {
            self.keys[index] = key;
            self.ids[index] = challenger.id;
        }
    }

    /// Asks the judge whether a primitive is seen rather than the one that the sample shows.
    fn judge_nearer<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        picture: &Picture,
        index: usize,
        challenger: &mut Challenger,
        observer: &mut O,
    ) -> bool {
        let (id, holder) = (challenger.id, self.ids[index]);
        if let Some(order) = self.compare_spheres::<F>(picture, index, challenger) {
            return order.is_lt();
        }
        if O::ENABLED {
            observer.judged(self.sample(index), Question::Nearest);
        }
        let before = (id < holder) != F::is(Planted::TiesToLast);
        // Duplicates are the most frequent ties.
        if self.are_same(picture, [id, holder]) || self.tied == Some([id, holder]) {
            return before;
        }
        let (primitive, held) = (challenger.primitive(picture), picture.view.primitive(holder));
        let Sample { row, column } = self.sample(index);
        let ray = picture.screen.grid.ray(row, column);
        let (challenger, holder) = ((id, &primitive), (holder, &held));
        match self.memory.compare(challenger, holder, &ray).decided {
            Ordering::Less => true,
            Ordering::Greater => false,
            Ordering::Equal => {
                if self.memory.are_tied(challenger, holder) {
                    self.tied = Some([id, holder.0]);
                }
                before
            }
        }
    }

    /// Whether a sphere is nearer than the one that the sample shows, if both are and `f64` is certain.
    fn compare_spheres<F: Fault>(
        &self,
        picture: &Picture,
        index: usize,
        challenger: &Challenger,
    ) -> Option<Ordering> {
        let sphere = |primitive: Primitive| match primitive {
            Primitive::Sphere { center, radius } => Some((center, radius)),
            Primitive::Triangle(_) | Primitive::Plane { .. } => None,
        };
        let ball = sphere(challenger.primitive?)?;
        if F::is(Planted::ZeroErrorBound) {
            return None;
        }
        let held = sphere(picture.view.primitive(self.ids[index]))?;
        let Sample { row, column } = self.sample(index);
        round::nearer([ball, held], &picture.screen.grid.ray(row, column))
    }

    /// Whether a flat primitive covers no sample of this camera at all; see [`CachedJudge::is_edge_on`].
    pub(super) fn is_edge_on(&mut self, id: u32, primitive: &Primitive) -> bool {
        self.memory.is_edge_on(id, primitive)
    }

    /// Writes ids and distances into the frame, and leaves the tile ready for another.
    #[inline(always)]
    pub(super) fn store<S: Simd>(&mut self, simd: S, picture: &Picture, tile: Tile) {
        for (row, (ids, t)) in tile.ids.into_iter().zip(tile.t).enumerate() {
            let start = row * self.stride;
            let (whole_ids, rest_ids) = ids.as_chunks_mut::<16>();
            let (whole_t, rest_t) = t.as_chunks_mut::<16>();
            let whole = 16 * whole_ids.len();
            let from = (start..).step_by(16);
            for ((ids, t), from) in whole_ids.iter_mut().zip(whole_t).zip(from) {
                self.store_sixteen(simd, picture, from, ids, t);
            }
            if !rest_ids.is_empty() {
                let (mut ids, mut t) = ([NO_PRIMITIVE; 16], [f32::INFINITY; 16]);
                self.store_sixteen(simd, picture, start + whole, &mut ids, &mut t);
                rest_ids.copy_from_slice(&ids[..rest_ids.len()]);
                rest_t.copy_from_slice(&t[..rest_t.len()]);
            }
        }
        finish_streaming();
    }

    /// Writes a tile in which nothing is seen.
    pub(super) fn store_nothing(tile: Tile) {
        for (ids, t) in tile.ids.into_iter().zip(tile.t) {
            let (whole_ids, rest_ids) = ids.as_chunks_mut::<16>();
            let (whole_t, rest_t) = t.as_chunks_mut::<16>();
            for (ids, t) in whole_ids.iter_mut().zip(whole_t) {
                stream([NO_PRIMITIVE; 16], ids);
                stream([f32::INFINITY; 16], t);
            }
            rest_ids.fill(NO_PRIMITIVE);
            rest_t.fill(f32::INFINITY);
        }
        finish_streaming();
    }

    #[inline(always)]
    fn store_sixteen<S: Simd>(
        &mut self,
        simd: S,
        picture: &Picture,
        from: usize,
        ids: &mut [u32; 16],
        t: &mut [f32; 16],
    ) {
        let keys = f32x16::from_slice(simd, &self.keys[from..from + 16]);
        let nothing = keys.simd_eq(f32x16::splat(simd, NOTHING));
        if nothing.all_true() {
            stream([NO_PRIMITIVE; 16], ids);
            stream([f32::INFINITY; 16], t);
            return;
        }
        f32x16::splat(simd, NOTHING).store_slice(&mut self.keys[from..from + 16]);
        let (distances, unsure) = distances(simd, &picture.keys, keys);
        let unsure = unsure & !nothing;
        let mut distances =
            nothing.select(f32x16::splat(simd, f32::INFINITY), distances).to_array();
        let seen = u32x16::from_slice(simd, &self.ids[from..from + 16]);
        let seen = nothing.select(u32x16::splat(simd, NO_PRIMITIVE), seen).to_array();
        if unsure.any_true() {
            self.judge_distances(picture, from, unsure.to_bitmask(), &mut distances);
        }
        stream(seen, ids);
        stream(distances, t);
    }

    #[cold]
    fn judge_distances(&self, picture: &Picture, from: usize, lanes: u64, t: &mut [f32; 16]) {
        let judge = picture.view.judge();
        for (lane, t) in t.iter_mut().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1) {
            let Sample { row, column } = self.sample(from + lane);
            let ray = picture.screen.grid.ray(row, column);
            let primitive = picture.view.primitive(self.ids[from + lane]);
            *t = stored_t(judge.distance(&primitive, &ray));
        }
    }
}

/// Which is nearer, if the keys' errors leave no doubt. NaN leaves it.
#[inline(always)]
fn rank<F: Fault>(key: f32, held: f32) -> Rank {
    let nearer = nearer_by::<F>();
    if key > held * nearer {
        Rank::Nearer
    } else if held > key * nearer {
        Rank::Farther
    } else {
        Rank::Unknown
    }
}

/// By which factor the key must be larger of what is certainly nearer.
pub(super) fn nearer_by<F: Fault>() -> f32 {
    if F::is(Planted::ZeroErrorBound) {
        1.0
    } else if F::is(Planted::InfiniteErrorBound) {
        f32::INFINITY
    } else {
        NEARER
    }
}

/// Distances from keys, and where they are not within 8·10⁻⁶ of the true ones.
///
/// Perspective: `1/(key + offset)` is at most `KEY_ERROR` of it off, and three roundings of 2⁻²⁴.
/// Parallel: `offset − key`, from the eye on, is off by `KEY_ERROR` of the key, less than twice the distance if
/// that is at least a third of the offset.
#[inline(always)]
fn distances<S: Simd>(simd: S, scale: &KeyScale, keys: f32x16<S>) -> (f32x16<S>, mask32x16<S>) {
    #[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
    let offset = f32x16::splat(simd, scale.from_eye as f32);
    match scale.projection {
        Projection::Perspective => {
            (f32x16::splat(simd, 1.0) / (keys + offset), !keys.simd_eq(keys))
        }
        Projection::Parallel => {
            let distances = offset - keys;
            (distances, !distances.simd_gt(offset * (1.0 / 3.0)))
        }
    }
}

/// Asks the judge whether a primitive covers a sample that rounding leaves open.
#[cold]
pub(super) fn judge_covers<O: EventSink + ?Sized, F: Fault>(
    picture: &Picture,
    sample: Sample,
    id: u32,
    primitive: &Primitive,
    observer: &mut O,
) -> bool {
    observer.judged(sample, Question::Coverage);
    let ray = picture.screen.grid.ray(sample.row, sample.column);
    let coverage = picture.view.judge().coverage(primitive, &ray);
    if let Some(edges) = coverage.edges {
        observer.edge_signs(sample, id, edges.at_sample.map(Some));
    }
    coverage.covers && !F::is(Planted::StrictComparison)
}
