//! What the rays of one tile have hit so far: ids and depth keys, the depth test, and what is left open.

use super::one_primitive::flat::FlatCache;
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::names::Names;
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x16};
use bothways_common::exact::CachedJudge;
use bothways_common::frame::NO_PRIMITIVE;
use bothways_common::observe::{Events, Executed};
use bothways_common::raster::Sample;
use bothways_common::{Primitive, View};

/// Samples along one side of a block: sixteen samples are tested at once.
pub(super) const BLOCK: usize = 4;
/// Samples along one side of the largest tile.
pub(super) const LARGEST_SIDE: usize = 32;
const SAMPLES: usize = LARGEST_SIDE * LARGEST_SIDE;
const BLOCKS: usize = SAMPLES / 16;

/// The samples of a tile, block by block, each block row by row. Blocks are in groups of 4 × 4.
///
/// For each sample: what is hit, and an interval that holds its key, which is larger for what is nearer.
/// Both ends are −∞ where nothing is hit, and +∞ beyond the picture, where nothing can be nearer.
#[derive(Debug)]
pub(super) struct TileBuffer {
    /// By their names: see [`Names`].
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
    pub(super) touched: bool,
    /// Blocks whose least low end must be found again.
    pub(super) dirty: u64,
    /// The first row and column, and how many rows and columns of it there are in the picture.
    pub(super) start: [usize; 2],
    pub(super) size: [usize; 2],
    side: usize,
    open: Vec<OpenFragment>,
    pub(super) judge: CachedJudge,
    pub(super) names: Names,
    /// Triangles that were set up alone.
    pub(super) flats: FlatCache,
    /// What was executed for the tile.
    pub(super) executed: Executed,
}

/// A sample that one of eight triangles may cover, or be nearest at: rounding leaves it open.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenFragment {
    pub(super) index: u16,
    pub(super) lane: u8,
    /// Whether only its depth is open.
    pub(super) covered: bool,
}

/// What a ray alone has hit so far: see [`TileBuffer::resume`].
#[derive(Clone, Copy, Debug)]
pub(super) struct RayHit {
    id: u32,
    low: f32,
    high: f32,
}

impl RayHit {
    pub(super) const NOTHING: RayHit =
        RayHit { id: NO_PRIMITIVE, low: f32::NEG_INFINITY, high: f32::NEG_INFINITY };
}

impl TileBuffer {
    /// A tile without samples; [`TileBuffer::begin`] gives it some.
    pub(super) fn new(view: &View) -> TileBuffer {
        TileBuffer {
            ids: Box::new([NO_PRIMITIVE; SAMPLES]),
            low: Box::new([0.0; SAMPLES]),
            high: Box::new([0.0; SAMPLES]),
            block_far: [f32::INFINITY; BLOCKS],
            far: f32::NEG_INFINITY,
            open_blocks: 0,
            touched: true,
            dirty: 0,
            start: [0; 2],
            size: [0; 2],
            side: 1,
            open: Vec::new(),
            judge: CachedJudge::new(view.judge()),
            names: Names::new(view.scene),
            flats: FlatCache::default(),
            executed: Executed::default(),
        }
    }

    /// Starts a tile in which nothing is hit. The tile begins at the row and column `start`; `size` is how many of its
    /// rows and columns lie in the picture.
    #[inline(always)]
    pub(super) fn begin(&mut self, start: [usize; 2], size: [usize; 2], side: usize) {
        self.start = start;
        self.executed = Executed::default();
        if !self.touched && size == self.size && side == self.side {
            return;
        }
        self.size = size;
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
                    let index = index(row, column);
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

    /// What the only ray of the tile has hit.
    #[inline(always)]
    pub(super) fn hit_alone(&self) -> RayHit {
        RayHit { id: self.ids[0], low: self.low[0], high: self.high[0] }
    }

    /// Goes on with another ray, which has hit this. The tile has begun as one of a ray alone.
    #[inline(always)]
    pub(super) fn resume(&mut self, start: [usize; 2], hit: RayHit) {
        self.start = start;
        self.touched = true;
        (self.ids[0], self.low[0], self.high[0]) = (hit.id, hit.low, hit.high);
        (self.block_far[0], self.far) = (hit.low, hit.low);
    }

    /// Samples along one side.
    pub(super) fn side(&self) -> usize {
        self.side
    }

    /// How many blocks there are.
    pub(super) fn blocks(&self) -> usize {
        (self.side * self.side).div_ceil(16)
    }

    /// Whether the tile has groups of sixteen blocks; one of a ray alone has not.
    pub(super) fn has_groups(&self) -> bool {
        self.side >= 4 * BLOCK
    }

    /// The sample of the picture that is kept at an index, if there is one.
    pub(super) fn sample(&self, index: usize) -> Option<Sample> {
        let [row, column] = place(self.side, index);
        let inside = row < self.size[0] && column < self.size[1];
        inside.then_some(Sample { row: self.start[0] + row, column: self.start[1] + column })
    }

    /// Updates the farthest hits where something was hit since the last time.
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

    /// Whether something was hit nearly everywhere, so that soon what lies farther can be skipped.
    #[inline(always)]
    pub(super) fn is_nearly_full(&self) -> bool {
        self.open_blocks <= 2
    }

    /// Leaves a sample to [`settle`](super::one_primitive::settle).
    #[cold]
    pub(super) fn leave_open(&mut self, index: usize, lane: usize, covered: bool) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a tile has 1024 samples, a setup 8 lanes"
        )]
        self.open.push(OpenFragment { index: index as u16, lane: lane as u8, covered });
    }

    /// The same for the lanes of a block that starts at index `from`.
    #[cold]
    pub(super) fn leave_all_open(&mut self, from: usize, mut open: u64, lane: usize, inside: u64) {
        while open != 0 {
            let at = open.trailing_zeros() as usize;
            open &= open - 1;
            self.leave_open(from + at, lane, inside >> at & 1 == 1);
        }
    }

    /// Gives new names to the instances that are seen, as names are used up. Nothing is open, and nothing waits.
    #[cold]
    pub(super) fn give_names_anew(&mut self) {
        let TileBuffer { names, ids, high, judge, flats, .. } = self;
        names.give_anew(&mut ids[..], |index| high[index] != f32::NEG_INFINITY);
        judge.forget();
        flats.forget();
    }

    /// Whether a triangle or plane covers no sample of this camera at all; see [`CachedJudge::is_edge_on`].
    pub(super) fn is_edge_on(&mut self, id: u32, primitive: &Primitive) -> bool {
        self.judge.is_edge_on(id, primitive)
    }

    /// Whether fragments are left open.
    pub(super) fn has_open(&self) -> bool {
        !self.open.is_empty()
    }

    /// The fragments that are left open. The vector is given back to [`TileBuffer::clear_open`].
    pub(super) fn take_open(&mut self) -> Vec<OpenFragment> {
        std::mem::take(&mut self.open)
    }

    /// Leaves no fragment open, and keeps the memory of the vector.
    pub(super) fn clear_open(&mut self, open: Vec<OpenFragment>) {
        self.open = open;
        self.open.clear();
    }

    /// Whether nothing is hit at a sample.
    #[inline(always)]
    pub(super) fn is_empty_at(&self, at: usize) -> bool {
        self.high[at] == f32::NEG_INFINITY
    }

    /// Stores a fragment as the nearest one so far; its key lies between `low` and `high`.
    #[inline(always)]
    pub(super) fn keep(&mut self, at: usize, id: u32, [low, high]: [f32; 2]) {
        self.low[at] = low;
        self.high[at] = high;
        self.ids[at] = id;
        self.dirty |= 1 << (at / 16);
    }

    /// The depth test: keeps a fragment if it is certainly the nearest so far, and leaves it open if that, or whether
    /// it is a fragment at all, is not certain.
    #[inline(always)]
    pub(super) fn fragment<C: ScalarContext>(
        &mut self,
        context: &mut C,
        at: usize,
        (lane, id): (usize, u32),
        certain: bool,
        [low, high]: [f32; 2],
    ) {
        let farther = high < self.low[at];
        let nearer = certain && low > self.high[at];
        let emits = C::WATCHED && certain && (farther || nearer);
        if emits && let Some(sample) = self.sample(at) {
            let id = self.names.id(id);
            context.sink().fragment(sample, id);
            if !self.is_empty_at(at) {
                let stored = self.names.id(self.ids[at]);
                context.sink().depth_test(sample, id, stored, nearer);
            }
        }
        if nearer {
            self.keep(at, id, [low, high]);
        } else if !farther {
            self.leave_open(at, lane, certain);
        }
    }

    /// The least low end in the blocks that hold these rows and columns of samples: the first and the last of each.
    pub(super) fn far_in(&self, [rows, columns]: [[usize; 2]; 2]) -> f32 {
        let blocks = |[first, last]: [usize; 2]| first / BLOCK..=last / BLOCK;
        let mut far = f32::INFINITY;
        for row in blocks(rows) {
            for column in blocks(columns) {
                far = far.min(self.block_far[index(BLOCK * row, BLOCK * column) / 16]);
            }
        }
        far
    }

    /// Whether everything at these rows and columns of samples, the first and the last of each, has a larger key than this one.
    /// Where they are many, blocks decide: then all of these must.
    #[inline(always)]
    pub(super) fn hides<S: Simd>(
        &self,
        simd: S,
        [rows, columns]: [[usize; 2]; 2],
        key: f32,
    ) -> bool {
        if [rows[0], columns[0]] == [rows[1], columns[1]] {
            return key < self.low[index(rows[0], columns[0])];
        }
        let count = |[first, last]: [usize; 2]| last + 1 - first;
        if count(rows) * count(columns) > BLOCK * BLOCK {
            return key < self.far_in([rows, columns]);
        }
        let key = f32x16::splat(simd, key);
        let blocks = |[first, last]: [usize; 2]| first / BLOCK..=last / BLOCK;
        for row in blocks(rows) {
            let of_rows = lanes_between(rows, row);
            for column in blocks(columns) {
                let at = index(BLOCK * row, BLOCK * column);
                let nearer = f32x16::from_slice(simd, &self.low[at..at + 16]).simd_gt(key);
                let asked = SPREAD[of_rows] & (0x1111 * lanes_between(columns, column) as u64);
                if asked & !nearer.to_bitmask() != 0 {
                    return false;
                }
            }
        }
        true
    }

    /// What is seen at the tile's only sample.
    pub(super) fn seen(&self) -> Option<u32> {
        (self.high[0] != f32::NEG_INFINITY).then_some(self.ids[0])
    }
}

/// Which rows of a block, or which columns, lie between two of the tile: a bit for each.
#[inline(always)]
fn lanes_between([first, last]: [usize; 2], block: usize) -> usize {
    let from = first.saturating_sub(BLOCK * block);
    let to = (last - BLOCK * block).min(BLOCK - 1);
    0xf << from & 0xf >> (BLOCK - 1 - to)
}

/// For bits of rows those of all their samples in a block.
const SPREAD: [u64; 1 << BLOCK] = {
    let mut all = [0; 1 << BLOCK];
    let mut rows = 0;
    while rows < 1 << BLOCK {
        let mut row = 0;
        while row < BLOCK {
            if rows >> row & 1 == 1 {
                all[rows] |= 0xf << (BLOCK * row);
            }
            row += 1;
        }
        rows += 1;
    }
    all
};

/// The least lane; there is no NaN.
#[inline(always)]
fn least<S: Simd>(lanes: f32x16<S>) -> f32 {
    let simd = lanes.simd;
    simd.reduce_min_f32x16(lanes)
}

/// The index at which a sample of a tile is kept: the sum of what its row and its column bring. It is the same in tiles of all
/// sizes, as those that are smaller than the largest have one group.
#[inline(always)]
pub(super) fn index(row: usize, column: usize) -> usize {
    usize::from(OF_ROW[row % LARGEST_SIDE]) + usize::from(OF_COLUMN[column % LARGEST_SIDE])
}

const OF_ROW: [u16; LARGEST_SIDE] = steps([4, 64, 512]);
const OF_COLUMN: [u16; LARGEST_SIDE] = steps([1, 16, 256]);

/// What rows or columns bring to an index: a step within a block, a step to the next block and one to the next group.
const fn steps([within, block, group]: [u16; 3]) -> [u16; LARGEST_SIDE] {
    let mut all = [0; LARGEST_SIDE];
    let (mut k, mut at) = (0, 0);
    while k < LARGEST_SIDE {
        all[k] = at % 4 * within + at % 16 / 4 * block + at / 16 * group;
        k += 1;
        at += 1;
    }
    all
}

/// The row and column of the sample that is kept there.
pub(super) fn place(side: usize, index: usize) -> [usize; 2] {
    let (group, block, lane) = (index / 256, index / 16 % 16, index % 16);
    let across = side.div_ceil(16);
    let row = group / across * 16 + block / 4 * 4 + lane / 4;
    let column = group % across * 16 + block % 4 * 4 + lane % 4;
    [row, column]
}
