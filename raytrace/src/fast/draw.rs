//! Triangles that were set up, tested at the samples of a tile.
//!
//! Over few samples: eight triangles at a time, each at one of its samples. Over more: one triangle at a
//! time, first at sixteen blocks at once, then at the sixteen samples of each block that is left.

use super::aligned::TIE;
use super::rays::{Lens, Rays};
use super::setup::{Affine, Eight, Setup};
use super::tile::{Tile, index, place};
use bothways_common::Sign;
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x8, f32x16, u32x16};
use bothways_common::observe::EventSink;

/// Boxes of at most this many samples are tested one triangle a lane.
const FEW: f32 = 8.0;
/// Boxes of at most this many are tiny.
const TINY: f32 = 3.0;

/// How many samples the largest of some triangles may cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Extent {
    Tiny,
    Few,
    Many,
}

/// A setup, lane by lane.
struct Lanes {
    /// For each edge, and for the key: at the middle, across, down.
    affine: [[[f32; 8]; 3]; 4],
    error: [f32; 8],
    key_error: [f32; 8],
    columns: [[f32; 8]; 2],
    rows: [[f32; 8]; 2],
}

impl Lanes {
    #[inline(always)]
    fn new<S: Simd>(setup: &Setup<S>) -> Lanes {
        let [ab, bc, ca] = &setup.edges;
        Lanes {
            affine: [arrays(ab), arrays(bc), arrays(ca), arrays(&setup.key)],
            error: setup.error.to_array(),
            key_error: setup.key_error.to_array(),
            columns: [setup.columns[0].to_array(), setup.columns[1].to_array()],
            rows: [setup.rows[0].to_array(), setup.rows[1].to_array()],
        }
    }
}

#[inline(always)]
fn arrays<S: Simd>(affine: &Affine<S>) -> [[f32; 8]; 3] {
    [affine.at_middle.to_array(), affine.across.to_array(), affine.down.to_array()]
}

/// Tests some of eight triangles at the samples of the tile; tells how many one of them may cover.
#[inline(always)]
pub(super) fn draw<S: Simd, O: EventSink + ?Sized, F: Fault>(
    simd: S,
    rays: &Rays,
    lens: &Lens,
    (eight, used): (&Eight, u64),
    tile: &mut Tile,
    observer: &mut O,
) -> Extent {
    let setup = Setup::new::<F>(simd, lens, tile.side(), eight, used, tile.far);
    if O::ENABLED {
        tell(&setup, eight, used, tile, observer);
    }
    let alive = setup.alive.to_bitmask();
    if alive == 0 {
        return Extent::Few;
    }
    let doubtful = alive & setup.doubtful.to_bitmask();
    let wide = setup.columns[1] - setup.columns[0] + 1.0;
    let high = setup.rows[1] - setup.rows[0] + 1.0;
    let samples = wide * high;
    let few = samples.simd_le(f32x8::splat(simd, FEW)).to_bitmask() & alive & !doubtful;
    let lanes = Lanes::new(&setup);
    if few != 0 {
        draw_few::<S, O>(simd, lens, &setup, few, samples, eight, tile, observer);
    }
    let mut many = alive & !few & !doubtful;
    let tiny = samples.simd_le(f32x8::splat(simd, TINY)).to_bitmask();
    let extent = match (many, few & !tiny) {
        (0, 0) => Extent::Tiny,
        (0, _) => Extent::Few,
        _ => Extent::Many,
    };
    while many != 0 {
        let lane = (many.trailing_zeros() & 7) as usize;
        many &= many - 1;
        draw_many::<S>(simd, lens, &lanes, lane, eight.ids[lane], tile);
    }
    let mut doubtful = doubtful;
    while doubtful != 0 {
        let lane = (doubtful.trailing_zeros() & 7) as usize;
        doubtful &= doubtful - 1;
        if !tile.is_edge_on(eight.ids[lane], &eight.primitive(&rays.view, lane)) {
            (0..tile.blocks() * 16).for_each(|sample| tile.leave_open(sample, lane, false));
        }
    }
    if tile.has_open() {
        let primitives =
            std::array::from_fn(|lane| (eight.ids[lane], eight.primitive(&rays.view, lane)));
        tile.settle::<O, F>(rays, &primitives, observer);
    }
    tile.renew(simd);
    extent
}

/// Triangles over few samples: each lane goes through its own.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "all is known already")]
fn draw_few<S: Simd, O: EventSink + ?Sized>(
    simd: S,
    lens: &Lens,
    setup: &Setup<S>,
    few: u64,
    samples: f32x8<S>,
    eight: &Eight,
    tile: &mut Tile,
    observer: &mut O,
) {
    let half = f32x8::splat(simd, lens.offset(0));
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let (first, end) = (setup.columns[0], setup.columns[1]);
    let (mut column, mut row) = (first, setup.rows[0]);
    let mut done = zero;
    let minus_error = -setup.error;
    let [ab, bc, ca] = &setup.edges;
    loop {
        let active = samples.simd_gt(done).to_bitmask() & few;
        if active == 0 {
            break;
        }
        let (across, down) = (column + half, row + half);
        let (e0, e1, e2) = (ab.at(across, down), bc.at(across, down), ca.at(across, down));
        let least = e0.min(e1).min(e2);
        let out = e0.simd_lt(minus_error) | e1.simd_lt(minus_error) | e2.simd_lt(minus_error);
        let mut perhaps = !out.to_bitmask() & active;
        if perhaps != 0 {
            let key = setup.key.at(across, down);
            let (low, high) = (key - setup.key_error, key + setup.key_error);
            let mut inside = least.simd_gt(setup.error);
            if lens.kind.parallel {
                // In front of the eye a key is negative; behind it there is nothing to see.
                perhaps &= !low.simd_gt(zero).to_bitmask();
                inside &= high.simd_lt(zero);
            }
            let inside = inside.to_bitmask();
            let (low, high) = (low.to_array(), high.to_array());
            let (columns, rows) = (column.to_array(), row.to_array());
            while perhaps != 0 {
                let lane = (perhaps.trailing_zeros() & 7) as usize;
                perhaps &= perhaps - 1;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a column and a row of the tile"
                )]
                let at =
                    index(tile.side(), rows[lane] as u32 as usize, columns[lane] as u32 as usize);
                let certain = inside >> lane & 1 == 1;
                tile.fragment(at, lane, eight.ids[lane], certain, low[lane], high[lane], observer);
            }
        }
        done += one;
        column += one;
        let wraps = column.simd_gt(end);
        column = wraps.select(first, column);
        row += wraps.select(one, zero);
    }
}

/// Middles of the blocks of a group, from the middle of the first; and of a block's samples, from its
/// middle.
const STEPS: [f32; 4] = [0.0, 4.0, 8.0, 12.0];
const WITHIN: [f32; 4] = [-1.5, -0.5, 0.5, 1.5];

#[inline(always)]
fn columns<S: Simd>(simd: S, of: [f32; 4]) -> f32x16<S> {
    let [a, b, c, d] = of;
    f32x16::load_array(simd, [a, b, c, d, a, b, c, d, a, b, c, d, a, b, c, d])
}

#[inline(always)]
fn rows<S: Simd>(simd: S, of: [f32; 4]) -> f32x16<S> {
    let [a, b, c, d] = of;
    f32x16::load_array(simd, [a, a, a, a, b, b, b, b, c, c, c, c, d, d, d, d])
}

/// One triangle at many samples.
#[inline(always)]
fn draw_many<S: Simd>(simd: S, lens: &Lens, lanes: &Lanes, lane: usize, id: u32, tile: &mut Tile) {
    let brushes = [
        Brush::new(simd, &lanes.affine[0], lane),
        Brush::new(simd, &lanes.affine[1], lane),
        Brush::new(simd, &lanes.affine[2], lane),
        Brush::new(simd, &lanes.affine[3], lane),
    ];
    let [ab, bc, ca, key] = &brushes;
    let error = f32x16::splat(simd, lanes.error[lane]);
    let key_error = f32x16::splat(simd, lanes.key_error[lane]);
    let (minus_error, zero) = (-error, f32x16::splat(simd, 0.0));
    let side = tile.side();
    let half = lens.offset(0);
    let [first, last] = [lanes.columns[0][lane] + half, lanes.columns[1][lane] + half];
    let [upper, lower] = [lanes.rows[0][lane] + half, lanes.rows[1][lane] + half];
    for group in 0..tile.blocks() / 16 {
        let (top, left) = place(side, group * 256);
        let bx = columns(simd, STEPS) + (lens.offset(left) + 1.5);
        let by = rows(simd, STEPS) + (lens.offset(top) + 1.5);
        let (v0, v1, v2, v3) = (ab.at(bx, by), bc.at(bx, by), ca.at(bx, by), key.at(bx, by));
        // Blocks that are certainly outside of an edge, of the box, or hidden.
        let outside = (v0 + ab.spread).simd_lt(minus_error)
            | (v1 + bc.spread).simd_lt(minus_error)
            | (v2 + ca.spread).simd_lt(minus_error);
        let far = f32x16::from_slice(simd, &tile.block_far[group * 16..group * 16 + 16]);
        let hidden = (v3 + key.spread + key_error).simd_lt(far);
        let beside = bx.simd_lt(f32x16::splat(simd, first - 1.5))
            | bx.simd_gt(f32x16::splat(simd, last + 1.5))
            | by.simd_lt(f32x16::splat(simd, upper - 1.5))
            | by.simd_gt(f32x16::splat(simd, lower + 1.5));
        let mut left = !(outside | hidden | beside).to_bitmask() & 0xffff;
        let values = [v0.to_array(), v1.to_array(), v2.to_array(), v3.to_array()];
        while left != 0 {
            let block = (left.trailing_zeros() & 15) as usize;
            left &= left - 1;
            let e0 = ab.within + values[0][block];
            let e1 = bc.within + values[1][block];
            let e2 = ca.within + values[2][block];
            let keys = key.within + values[3][block];
            let least = e0.min(e1).min(e2);
            let (low, high) = (keys - key_error, keys + key_error);
            let from = (group * 16 + block) * 16;
            let held_low = f32x16::from_slice(simd, &tile.low[from..from + 16]);
            let held_high = f32x16::from_slice(simd, &tile.high[from..from + 16]);
            let mut inside = least.simd_gt(error);
            // Not the least of the three: it need not be NaN where one of them is.
            let out = e0.simd_lt(minus_error) | e1.simd_lt(minus_error) | e2.simd_lt(minus_error);
            let mut nowhere = out | high.simd_lt(held_low);
            if lens.kind.parallel {
                nowhere |= low.simd_gt(zero);
                inside &= high.simd_lt(zero);
            }
            let nearer = inside & low.simd_gt(held_high);
            if nearer.any_true() {
                nearer.select(low, held_low).store_slice(&mut tile.low[from..from + 16]);
                nearer.select(high, held_high).store_slice(&mut tile.high[from..from + 16]);
                let ids = u32x16::from_slice(simd, &tile.ids[from..from + 16]);
                let ids = nearer.select(u32x16::splat(simd, id), ids);
                ids.store_slice(&mut tile.ids[from..from + 16]);
                tile.dirty |= 1 << (group * 16 + block);
            }
            let open = !(nowhere | nearer).to_bitmask() & 0xffff;
            if open != 0 {
                tile.leave_all_open(from, open, lane, inside.to_bitmask());
            }
        }
    }
}

/// An affine function of one triangle, in every lane.
struct Brush<S: Simd> {
    at_middle: f32x16<S>,
    across: f32x16<S>,
    down: f32x16<S>,
    /// From the middle of a block to its samples.
    within: f32x16<S>,
    /// At most how far from its value at the middle it is at a sample of the block.
    spread: f32x16<S>,
}

impl<S: Simd> Brush<S> {
    #[inline(always)]
    fn new(simd: S, of: &[[f32; 8]; 3], lane: usize) -> Self {
        let [at_middle, across, down] = [of[0][lane], of[1][lane], of[2][lane]];
        let (across, down) = (f32x16::splat(simd, across), f32x16::splat(simd, down));
        Brush {
            at_middle: f32x16::splat(simd, at_middle),
            across,
            down,
            within: across * columns(simd, WITHIN) + down * rows(simd, WITHIN),
            spread: (across.abs() + down.abs()) * 1.500_001,
        }
    }

    #[inline(always)]
    fn at(&self, across: f32x16<S>, down: f32x16<S>) -> f32x16<S> {
        (self.at_middle + self.down * down) + self.across * across
    }
}

impl Tile {
    /// Keeps a fragment if it is certainly the nearest so far; leaves it open if that, or whether it is a
    /// fragment at all, is not certain.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "all that is known of a fragment")]
    fn fragment<O: EventSink + ?Sized>(
        &mut self,
        at: usize,
        lane: usize,
        id: u32,
        certain: bool,
        low: f32,
        high: f32,
        observer: &mut O,
    ) {
        let farther = high < self.low[at];
        let nearer = certain && low > self.high[at];
        let told = O::ENABLED && certain && (farther || nearer);
        if told && let Some(sample) = self.sample(at) {
            observer.fragment(sample, id);
            if self.high[at] != f32::NEG_INFINITY {
                observer.depth_test(sample, id, self.ids[at], nearer);
            }
        }
        if nearer {
            self.low[at] = low;
            self.high[at] = high;
            self.ids[at] = id;
            self.dirty |= 1 << (at / 16);
        } else if !farther {
            self.leave_open(at, lane, certain);
        }
    }
}

/// Tells of the edge functions of triangles at the only ray of a tile, as far as they are certain.
#[cold]
fn tell<S: Simd, O: EventSink + ?Sized>(
    setup: &Setup<S>,
    eight: &Eight,
    used: u64,
    tile: &Tile,
    observer: &mut O,
) {
    if observer.counts().is_some() {
        return;
    }
    let Some(sample) = tile.sample(0) else { return };
    let values = setup.edges.map(|edge| edge.at_middle.to_array());
    let (error, facing) = (setup.error.to_array(), setup.facing.to_array());
    let doubtful = setup.doubtful.to_bitmask();
    for lane in (0..8).filter(|lane| used >> lane & 1 == 1) {
        let edges = values.map(|values| values[lane]);
        let out = edges.iter().any(|edge| *edge < -error[lane]);
        let inside = edges.iter().all(|edge| *edge > error[lane]);
        if doubtful >> lane & 1 == 0 && (out || inside) {
            let sign = |edge: f32| {
                let on_edge = error[lane] == 0.0 && edge.abs() == TIE;
                let sign = if on_edge { 0.0 } else { f64::from(facing[lane] * edge) };
                (edge.abs() > error[lane]).then(|| Sign::of(sign))
            };
            observer.edge_signs(sample, eight.ids[lane], edges.map(sign));
        }
    }
}
