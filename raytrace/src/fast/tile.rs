//! What the rays of one tile have hit so far.

use super::ball;
use super::leaf::{self, Answer, Distance, Trust};
use super::rays::{Lens, Rays};
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x16, u32x16};
use bothways_common::exact::CachedJudge;
use bothways_common::frame::{NO_PRIMITIVE, stored_t};
use bothways_common::observe::{EventSink, Question};
use bothways_common::raster::{Region, Sample};
use bothways_common::{Primitive, Projection};
use std::ops::Range;

/// Samples along one side of a block: sixteen samples are tested at once.
pub(super) const BLOCK: usize = 4;
/// Samples along one side of the largest tile.
pub(super) const LARGEST: usize = 32;
const SAMPLES: usize = LARGEST * LARGEST;
const BLOCKS: usize = SAMPLES / 16;

/// The samples of a tile, block by block, each block row by row. Blocks are in groups of 4 × 4.
///
/// For each sample: what is hit, and an interval that holds its key, which is larger for what is nearer.
/// Both ends are −∞ where nothing is hit, and +∞ beyond the picture, where nothing can be nearer.
#[derive(Debug)]
pub(super) struct Tile {
    pub(super) ids: Box<[u32; SAMPLES]>,
    pub(super) low: Box<[f32; SAMPLES]>,
    pub(super) high: Box<[f32; SAMPLES]>,
    /// The least low end in each block.
    pub(super) block_far: [f32; BLOCKS],
    /// The least low end of all: nothing with a smaller key can be seen in the tile.
    pub(super) far: f32,
    /// How many blocks have samples at which nothing was hit; the largest number until that is counted.
    open_blocks: u32,
    /// Whether anything was hit.
    touched: bool,
    /// Blocks whose least low end must be found again.
    pub(super) dirty: u64,
    /// The first row and column, and how many rows and columns there are in the picture.
    row: usize,
    column: usize,
    height: usize,
    width: usize,
    side: usize,
    open: Vec<Open>,
    memory: CachedJudge,
}

/// A sample that one of eight triangles may cover, or be nearest at: rounding leaves it open.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    pub(super) index: u16,
    pub(super) lane: u8,
    /// Whether only its depth is open.
    pub(super) covered: bool,
}

impl Tile {
    pub(super) fn new(rays: &Rays) -> Tile {
        Tile {
            ids: Box::new([NO_PRIMITIVE; SAMPLES]),
            low: Box::new([0.0; SAMPLES]),
            high: Box::new([0.0; SAMPLES]),
            block_far: [f32::INFINITY; BLOCKS],
            far: f32::NEG_INFINITY,
            open_blocks: 0,
            touched: true,
            dirty: 0,
            row: 0,
            column: 0,
            height: 0,
            width: 0,
            side: 1,
            open: Vec::new(),
            memory: CachedJudge::new(rays.view.judge()),
        }
    }

    /// Starts a tile in which nothing is hit.
    #[inline(always)]
    pub(super) fn begin(&mut self, start: [usize; 2], size: [usize; 2], side: usize) {
        [self.row, self.column] = start;
        if !self.touched && size == [self.height, self.width] && side == self.side {
            return;
        }
        [self.height, self.width] = size;
        self.side = side;
        self.touched = false;
        let blocks = self.blocks();
        let whole = size == [side, side] && side >= BLOCK;
        let outside = if whole { f32::NEG_INFINITY } else { f32::INFINITY };
        self.low[..blocks * 16].fill(outside);
        self.high[..blocks * 16].fill(outside);
        self.block_far[..blocks].fill(outside);
        if !whole {
            for row in 0..size[0] {
                for column in 0..size[1] {
                    let index = index(side, row, column);
                    self.low[index] = f32::NEG_INFINITY;
                    self.high[index] = f32::NEG_INFINITY;
                    self.block_far[index / 16] = f32::NEG_INFINITY;
                }
            }
        }
        self.far = f32::NEG_INFINITY;
        self.open_blocks = u32::MAX;
        self.dirty = 0;
    }

    /// Samples along one side.
    pub(super) fn side(&self) -> usize {
        self.side
    }

    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        (self.side * self.side).div_ceil(16)
    }

    /// The sample in the picture that is kept there, if it is one.
    pub(super) fn sample(&self, index: usize) -> Option<Sample> {
        let (row, column) = place(self.side, index);
        let inside = row < self.height && column < self.width;
        inside.then_some(Sample { row: self.row + row, column: self.column + column })
    }

    /// Finds the farthest hit again where something was hit.
    #[inline(always)]
    pub(super) fn renew<S: Simd>(&mut self, simd: S) {
        if self.dirty == 0 {
            return;
        }
        self.touched = true;
        while self.dirty != 0 {
            let block = (self.dirty.trailing_zeros() & 63) as usize;
            self.dirty &= self.dirty - 1;
            let low = f32x16::from_slice(simd, &self.low[block * 16..block * 16 + 16]);
            self.block_far[block] = least(low);
        }
        let (mut far, nothing) =
            (f32x16::splat(simd, f32::INFINITY), f32x16::splat(simd, f32::NEG_INFINITY));
        self.open_blocks = 0;
        for group in 0..self.blocks().div_ceil(16) {
            let of_group = f32x16::from_slice(simd, &self.block_far[group * 16..group * 16 + 16]);
            self.open_blocks += of_group.simd_eq(nothing).to_bitmask().count_ones();
            far = far.min(of_group);
        }
        self.far = least(far);
    }

    /// Whether something was hit nearly everywhere, so that soon what lies farther need not be looked at.
    #[inline(always)]
    pub(super) fn is_nearly_full(&self) -> bool {
        self.open_blocks <= 2
    }

    /// Leaves a sample to [`Tile::settle`].
    #[cold]
    pub(super) fn leave_open(&mut self, index: usize, lane: usize, covered: bool) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a tile has 1024 samples, a setup 8 lanes"
        )]
        self.open.push(Open { index: index as u16, lane: lane as u8, covered });
    }

    /// The same for lanes of a block from `from` on.
    #[cold]
    pub(super) fn leave_all_open(&mut self, from: usize, mut open: u64, lane: usize, inside: u64) {
        while open != 0 {
            let at = open.trailing_zeros() as usize;
            open &= open - 1;
            self.leave_open(from + at, lane, inside >> at & 1 == 1);
        }
    }

    /// Whether a flat primitive covers no sample of this camera at all; see [`CachedJudge::is_edge_on`].
    pub(super) fn is_edge_on(&mut self, id: u32, primitive: &Primitive) -> bool {
        self.memory.is_edge_on(id, primitive)
    }

    pub(super) fn has_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// Decides what was left open.
    #[cold]
    pub(super) fn settle<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        rays: &Rays,
        primitives: &[(u32, Primitive); 8],
        observer: &mut O,
    ) {
        let open = std::mem::take(&mut self.open);
        for Open { index, lane, covered } in &open {
            let (id, primitive) = &primitives[usize::from(*lane)];
            let index = usize::from(*index);
            self.decide::<O, F>(rays, index, (*id, primitive), *covered, observer);
        }
        self.open = open;
        self.open.clear();
    }

    /// Tests one ray against one primitive in `f64`, by the judge if need be, and keeps the nearer of it
    /// and the hit so far. `covered` says that it is certainly covered, which was told already.
    pub(super) fn decide<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        rays: &Rays,
        index: usize,
        (id, primitive): (u32, &Primitive),
        covered: bool,
        observer: &mut O,
    ) {
        let Some(sample) = self.sample(index) else { return };
        let ray = rays.grid.ray(sample.row, sample.column);
        let trust = Trust::new::<F>();
        let (answer, signs) = leaf::primitive(&ray, primitive, trust);
        let distance = match answer {
            Answer::Hit(distance) | Answer::Open(distance) => distance,
            Answer::Miss => {
                observer.edge_signs(sample, id, signs);
                return;
            }
        };
        if covered {
            // Only the depth is open.
        } else if let Answer::Hit(_) = answer {
            observer.edge_signs(sample, id, signs);
        } else {
            if self.memory.is_edge_on(id, primitive) {
                return;
            }
            observer.judged(sample, Question::Coverage);
            let coverage = rays.view.judge().coverage(primitive, &ray);
            if let Some(edges) = coverage.edges {
                observer.edge_signs(sample, id, edges.at_sample.map(Some));
            }
            if !coverage.covers || F::is(Planted::StrictComparison) {
                return;
            }
        }
        observer.fragment(sample, id);
        let [low, high] = rays.keys(distance.low, distance.high);
        let nothing = self.high[index] == f32::NEG_INFINITY;
        let nearer = if nothing || low > self.high[index] {
            true
        } else if high < self.low[index] {
            false
        } else {
            self.judge_nearer::<O, F>(rays, (sample, index), (id, primitive), distance, observer)
        };
        if !nothing {
            observer.depth_test(sample, id, self.ids[index], nearer);
        }
        if nearer {
            self.ids[index] = id;
            self.low[index] = low;
            self.high[index] = high;
            self.dirty |= 1 << (index / 16);
        }
    }

    /// Whether a primitive is seen rather than the hit so far: by `f64` if that is certain, or by the
    /// judge.
    fn judge_nearer<O: EventSink + ?Sized, F: Fault>(
        &mut self,
        rays: &Rays,
        (sample, index): (Sample, usize),
        challenger: (u32, &Primitive),
        distance: Distance,
        observer: &mut O,
    ) -> bool {
        let holder = self.ids[index];
        let held = rays.view.primitive(holder);
        let ray = rays.grid.ray(sample.row, sample.column);
        let trust = Trust::new::<F>();
        if let (Answer::Hit(other) | Answer::Open(other), _) = leaf::primitive(&ray, &held, trust) {
            if distance.high < other.low {
                return true;
            }
            if distance.low > other.high {
                return false;
            }
        }
        if let (
            Primitive::Sphere { center, radius },
            Primitive::Sphere { center: other, radius: other_radius },
        ) = (*challenger.1, held)
            && trust.is_sound()
            && let Some(order) = ball::nearer([(center, radius), (other, other_radius)], &ray)
        {
            return order.is_lt();
        }
        observer.judged(sample, Question::Nearest);
        if F::is(Planted::TiesToLast) {
            let order = self.memory.compare(challenger, (holder, &held), &ray);
            return order.decided.then(holder.cmp(&challenger.0)).is_lt();
        }
        self.memory.nearer(challenger, (holder, &held), &ray)
    }

    /// Writes ids and distances into a region of a frame, as much of it as the tile holds.
    #[inline(always)]
    pub(super) fn store<S: Simd>(
        &self,
        simd: S,
        rays: &Rays,
        region: &Region,
        ids: &mut [&mut [u32]],
        t: &mut [&mut [f32]],
    ) {
        // What the region holds of the tile, counted from the tile's first row and column.
        let held = |first: usize, count: usize, of: &Range<usize>| {
            of.start.saturating_sub(first)..(of.end - first).min(count)
        };
        let rows = held(self.row, self.height, &region.rows);
        let columns = held(self.column, self.width, &region.columns);
        let line = |row: usize| row + self.row - region.rows.start;
        let place_in_line = |column: usize| column + self.column - region.columns.start;
        if !self.touched {
            let columns = place_in_line(columns.start)..place_in_line(columns.end);
            for row in rows.map(line) {
                ids[row][columns.clone()].fill(NO_PRIMITIVE);
                t[row][columns.clone()].fill(f32::INFINITY);
            }
            return;
        }
        if self.side < BLOCK {
            let (mut shown, mut far) = ([0; 16], [0.0; 16]);
            self.store_block(simd, rays, 0, &mut shown, &mut far);
            ids[line(0)][place_in_line(0)] = shown[0];
            t[line(0)][place_in_line(0)] = far[0];
            return;
        }
        for block in 0..self.blocks() {
            let (top, left) = place(self.side, block * 16);
            let rows = top.max(rows.start)..rows.end.min(top + BLOCK);
            let columns = left.max(columns.start)..columns.end.min(left + BLOCK);
            if rows.is_empty() || columns.is_empty() {
                continue;
            }
            let (mut shown, mut far) = ([0; 16], [0.0; 16]);
            self.store_block(simd, rays, block, &mut shown, &mut far);
            let (wide, start) = (columns.len(), place_in_line(columns.start));
            for row in rows {
                let from = (row - top) * BLOCK + columns.start - left;
                let (ids, t) = (&mut ids[line(row)], &mut t[line(row)]);
                if wide == BLOCK {
                    ids[start..start + BLOCK].copy_from_slice(&shown[from..from + BLOCK]);
                    t[start..start + BLOCK].copy_from_slice(&far[from..from + BLOCK]);
                } else {
                    ids[start..start + wide].copy_from_slice(&shown[from..from + wide]);
                    t[start..start + wide].copy_from_slice(&far[from..from + wide]);
                }
            }
        }
    }

    /// Ids and distances of a block. A distance is taken from the middle of its key's interval if that is
    /// narrow: within 0.75·10⁻⁶ of the true one, and three roundings of 2⁻²⁴.
    #[inline(always)]
    fn store_block<S: Simd>(
        &self,
        simd: S,
        rays: &Rays,
        block: usize,
        ids: &mut [u32; 16],
        t: &mut [f32; 16],
    ) {
        const NARROW: f32 = 1.5e-6;
        let from = block * 16;
        let low = f32x16::from_slice(simd, &self.low[from..from + 16]);
        let high = f32x16::from_slice(simd, &self.high[from..from + 16]);
        let nothing = high.simd_eq(f32x16::splat(simd, f32::NEG_INFINITY));
        let middle = low * 0.5 + high * 0.5;
        #[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
        let scale = rays.scale as f32;
        let distance = match rays.projection {
            Projection::Perspective => f32x16::splat(simd, 1.0 / scale) / middle,
            Projection::Parallel => -middle * (1.0 / scale),
        };
        // Far from overflow, underflow and their kin.
        const ORDINARY: std::ops::Range<f32> = 1e-30..1e30;
        let plain = ORDINARY.contains(&scale);
        let sure = (high - low).simd_le(middle.abs() * NARROW)
            & distance.simd_gt(f32x16::splat(simd, ORDINARY.start))
            & distance.simd_lt(f32x16::splat(simd, ORDINARY.end));
        let seen = u32x16::from_slice(simd, &self.ids[from..from + 16]);
        nothing.select(u32x16::splat(simd, NO_PRIMITIVE), seen).store_array(ids);
        nothing.select(f32x16::splat(simd, f32::INFINITY), distance).store_array(t);
        let unsure = if plain { !(sure | nothing) } else { !nothing };
        if unsure.any_true() {
            self.find_distances(rays, from, unsure.to_bitmask(), ids, t);
        }
    }

    #[cold]
    fn find_distances(
        &self,
        rays: &Rays,
        from: usize,
        lanes: u64,
        ids: &[u32; 16],
        t: &mut [f32; 16],
    ) {
        for lane in (0..16).filter(|lane| lanes >> lane & 1 == 1) {
            let Some(Sample { row, column }) = self.sample(from + lane) else { continue };
            let (ray, primitive) = (rays.grid.ray(row, column), rays.view.primitive(ids[lane]));
            let rounded = match leaf::primitive(&ray, &primitive, Trust::Sound).0 {
                Answer::Hit(distance) | Answer::Open(distance) => distance.t(),
                Answer::Miss => None,
            };
            let t = (&mut t[lane], rounded);
            *t.0 = stored_t(t.1.unwrap_or_else(|| rays.view.judge().distance(&primitive, &ray)));
        }
    }

    /// What is seen at the tile's only sample.
    pub(super) fn seen(&self) -> Option<u32> {
        (self.high[0] != f32::NEG_INFINITY).then_some(self.ids[0])
    }
}

/// The least lane; there is no NaN.
#[inline(always)]
fn least<S: Simd>(lanes: f32x16<S>) -> f32 {
    let simd = lanes.simd;
    simd.reduce_min_f32x16(lanes)
}

/// Where a sample is kept.
#[inline(always)]
pub(super) fn index(side: usize, row: usize, column: usize) -> usize {
    let group = row / 16 * side.div_ceil(16) + column / 16;
    let block = row % 16 / 4 * 4 + column % 16 / 4;
    group * 256 + block * 16 + row % 4 * 4 + column % 4
}

/// The row and column that are kept there.
pub(super) fn place(side: usize, index: usize) -> (usize, usize) {
    let (group, block, lane) = (index / 256, index / 16 % 16, index % 16);
    let across = side.div_ceil(16);
    let row = group / across * 16 + block / 4 * 4 + lane / 4;
    let column = group % across * 16 + block % 4 * 4 + lane % 4;
    (row, column)
}

impl Lens<'_> {
    /// The place of a tile's column or row, from its middle.
    #[inline(always)]
    pub(super) fn offset(&self, place: usize) -> f32 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "halves of small integers"
        )]
        let offset = (place as f64 - self.kind.half) as f32;
        offset
    }
}
