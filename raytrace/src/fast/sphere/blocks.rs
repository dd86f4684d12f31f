//! One sphere against the samples of a tile: sixteen blocks at once, then sixteen samples of each block that is left.
//!
//! With the way `m` from the ray's origin to the centre, `B = m·D`, `A = D·D` and `d = A·r² − |m × D|²` (a quarter of the
//! discriminant, by Lagrange's identity), the ray meets the sphere at `t = (B ∓ √d)/A`. On the raster, `B` is affine and
//! `d` a polynomial of the second degree. So are keys nearly: of a perspective camera `C = m·m − r²` is the same for
//! all rays, and `1/t` of the two roots is `(B ± √d)/C`; of a parallel camera `A` is, and `−t` is `(−B ± √d)/A`.

use crate::fast::answer::{FLOOR, Trust};
use crate::fast::camera_map::CameraMap;
use crate::fast::many_samples::{STEPS, WITHIN, columns, rows};
use crate::fast::search::tile_frustum::TileFrustum;
use crate::fast::tile::{TileBuffer, place};
use crate::fast::viewport_affine::TileViewport;
use crate::fast::world_affine::upward;
use bothways_common::engine::roundoff::{EPS24, EPS53};
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, SimdWiden, apart, f32x16, f64x8,
    mask32x16, mask64x8, u32x16,
};
use bothways_common::look::lanes::each;
use glam::DVec3;

/// A sphere on the raster of a tile, in the unit of keys: `d` times the square of what `B` is multiplied with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereSetup {
    kind: Kind,
    /// `d` at the tile's middle; times columns and rows; times the squares of columns, their products, the squares of rows.
    discriminant: [f64; 6],
    discriminant_error: f64,
    /// What a key is besides the root: at the tile's middle, across, down.
    affine: [f64; 3],
    affine_error: f32,
    /// The other errors of a key, as a fraction of it.
    relative: f32,
}

/// Which root is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The near one, where the ray goes towards the centre: `B > 0`.
    Outside,
    /// The far one.
    Inside,
    /// Each sample decides: the near one if it is in front of the eye.
    Parallel,
}

/// The rays of a tile and a sphere.
struct Vectors {
    /// `m × D` at the tile's middle, and what it gains from a column and a row to the next.
    crossed: [DVec3; 3],
    /// Likewise `B`.
    toward: [f64; 3],
    /// `D`, of a parallel camera for all rays.
    direction: [DVec3; 3],
    /// `σ`, and `R` of [`SphereSetup::new`].
    longest: f64,
    reach: f64,
}

impl SphereSetup {
    /// The sphere in a tile; `None` where it is not certain whether the eye of a perspective camera is inside.
    ///
    /// # The errors, rounding by rounding
    ///
    /// Write `σ` for the longest direction of a ray of the tile, of a parallel camera 1, and `S` for the sum of the
    /// coordinates on the viewport, of a perspective camera with `d`: then `σ = S`. `P`, a ray's `D` (of a parallel
    /// camera its `O`), is within `12·ε₅₃·S` of what the middle's and so many columns and rows make of it:
    /// [`ViewportAffine::of_rays`](crate::fast::viewport_affine::ViewportAffine::of_rays) counts four roundings of a
    /// coordinate; `P` itself carries 3, the middle's 3, and a step 1. `R` is `|m|·σ` (perspective), or `|center| + S`,
    /// which no `m` exceeds. `v` bounds `|m × D|` in the tile.
    ///
    /// *`m × D`*: 12 of `R` for the ray, 1 for `m`, and 2 of the products in each coordinate, which make `2·√3`: less
    /// than `18·ε₅₃·R`, and `36·ε₅₃·v·R + (18·ε₅₃·R)²` for its square.
    ///
    /// *`A·r²`*: `25·ε₅₃·r²·σ²` for the ray.
    ///
    /// *The polynomial's* coefficients: 3 for an inner product, 1 for its product with `r²` (which is exact), 1 for the
    /// difference, 2 for the unit of keys. At a sample, from the middle of a block, at most 9 more; where blocks are
    /// dropped, 12. All parts together are at most `r²·σ² + v²`: 20 of that are more.
    ///
    /// *`B`*: 12 of `R` for the ray, 1 for `m`, 3 for the product, 1 for the unit, 4 at a sample: less than 24.
    ///
    /// *The factor*: `C` is off by `6·ε₅₃·(m·m + r²)`, which is less than a sixteenth of it, and brings 1.1 times what
    /// that is relative to it; `A` carries 3 roundings, a quotient and the scale one each.
    ///
    /// *In `f32`* a key is rounded by its conversion and at the ends of its interval; [`SphereSetup::draw`] adds what the
    /// root is off by.
    pub(crate) fn new(
        map: &CameraMap,
        frustum: &TileFrustum,
        (center, radius): (DVec3, f64),
        trust: Trust,
    ) -> Option<SphereSetup> {
        let vectors = Vectors::new(map, frustum, center);
        let (square, scale) = (radius * radius, map.depth.scale);
        let (kind, factor, relative) = if frustum.template.parallel {
            (Kind::Parallel, scale / vectors.direction[0].length_squared(), 6.0 * EPS53)
        } else {
            let c = center.length_squared() - square;
            let error = 6.0 * EPS53 * (center.length_squared() + square) + FLOOR;
            let is_certain = 16.0 * trust.of(error) < c.abs();
            if !is_certain {
                return None;
            }
            let kind = if c > 0.0 { Kind::Outside } else { Kind::Inside };
            (kind, 1.0 / (c.abs() * scale), 1.1 * error / c.abs() + 4.0 * EPS53)
        };
        let (unit, half) = (factor * factor, frustum.template.half);
        let Vectors { crossed, toward, direction, longest, reach } = &vectors;
        let (v, r) = (spread(crossed, half), square * longest * longest);
        let of_cross = 18.0 * EPS53 * reach;
        let error = EPS53 * (46.0 * r + 21.0 * v * v) + (2.0 * v + of_cross) * of_cross + FLOOR;
        let coefficient = |i: usize, j: usize| {
            let twice = if i == j { 1.0 } else { 2.0 };
            let difference = square * direction[i].dot(direction[j]) - crossed[i].dot(crossed[j]);
            twice * difference * unit
        };
        let places = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        let sign = if kind == Kind::Outside { factor } else { -factor };
        let affine_error = 24.0 * EPS53 * reach * factor * 1.001 + f64::from(f32::MIN_POSITIVE);
        Some(SphereSetup {
            kind,
            discriminant: places.map(|(i, j)| coefficient(i, j)),
            discriminant_error: trust.of(error * unit * (1.0 + 8.0 * EPS53)),
            affine: toward.map(|part| part * sign),
            affine_error: upward(trust.of(affine_error)),
            relative: upward(trust.of(relative + 2.5 * f64::from(EPS24))),
        })
    }

    /// Tests the sphere at the samples of the tile. It is compiled once for all loops that call it.
    #[inline(never)]
    pub(crate) fn draw<S: Simd>(
        &self,
        simd: S,
        frustum: &TileFrustum,
        id: u32,
        tile: &mut TileBuffer,
    ) {
        apart!(simd, self.draw_groups(simd, frustum, id, tile));
    }

    /// What [`SphereSetup::draw`] does.
    #[inline(always)]
    fn draw_groups<S: Simd>(&self, simd: S, frustum: &TileFrustum, id: u32, tile: &mut TileBuffer) {
        let within = Within::new(simd, self);
        for group in 0..tile.blocks() / 16 {
            let blocks = Blocks::new(simd, self, frustum, group, tile);
            let mut left = blocks.left;
            tile.executed.blocks += u64::from(left.count_ones());
            while left != 0 {
                let block = (left.trailing_zeros() & 15) as usize;
                left &= left - 1;
                let samples = Samples::new(simd, self, &within, &blocks, block);
                samples.test(simd, id, group * 16 + block, tile);
            }
        }
    }
}

impl Vectors {
    fn new(map: &CameraMap, frustum: &TileFrustum, center: DVec3) -> Vectors {
        let (camera, tile) = (map.view.camera, TileViewport::new(frustum));
        let (u, v, forward) = (camera.u(), camera.v(), -camera.w());
        let ([x, y], [step_x, step_y]) = (tile.middle, tile.step);
        let on_viewport = tile.most[0] + tile.most[1];
        let (at_middle, across, down) = (x * u + y * v, step_x * u, step_y * v);
        if frustum.template.parallel {
            let ways = [center - at_middle, -across, -down];
            Vectors {
                crossed: ways.map(|way| way.cross(forward)),
                toward: ways.map(|way| way.dot(forward)),
                direction: [forward, DVec3::ZERO, DVec3::ZERO],
                longest: 1.0,
                reach: center.length() + on_viewport,
            }
        } else {
            let direction = [at_middle + camera.distance() * forward, across, down];
            let longest = on_viewport + camera.distance();
            Vectors {
                crossed: direction.map(|part| center.cross(part)),
                toward: direction.map(|part| center.dot(part)),
                direction,
                longest,
                reach: center.length() * longest,
            }
        }
    }
}

/// The length that such a vector may have within `half` columns and rows.
fn spread([at_middle, across, down]: &[DVec3; 3], half: f64) -> f64 {
    at_middle.length() + half * (across.length() + down.length())
}

/// What the samples of a block add to the functions at its middle, the same for all blocks: eight samples and eight.
struct Within<S: Simd> {
    columns: [f64x8<S>; 2],
    rows: [f64x8<S>; 2],
    discriminant: [f64x8<S>; 2],
    affine: [f64x8<S>; 2],
}

impl<S: Simd> Within<S> {
    #[inline(always)]
    fn new(simd: S, setup: &SphereSetup) -> Within<S> {
        let [_, _, _, of_columns, of_both, of_rows] = setup.discriminant;
        let [_, across, down] = setup.affine;
        let (x0, x1) = columns(simd, WITHIN).widen();
        let (y0, y1) = rows(simd, WITHIN).widen();
        Within {
            columns: [x0, x1],
            rows: [y0, y1],
            discriminant: each!(place in [(x0, y0), (x1, y1)] => {
                let (x, y) = place;
                x * x * of_columns + (x * of_both + y * of_rows) * y
            }),
            affine: [x0 * across + y0 * down, x1 * across + y1 * down],
        }
    }
}

/// The blocks of a group: the functions at their middles, and which of them are left.
struct Blocks {
    discriminant: [[f64; 8]; 2],
    /// What `d` gains to the right, and down.
    across: [[f64; 8]; 2],
    down: [[f64; 8]; 2],
    affine: [[f64; 8]; 2],
    left: u64,
}

impl Blocks {
    #[inline(always)]
    fn new<S: Simd>(
        simd: S,
        setup: &SphereSetup,
        frustum: &TileFrustum,
        group: usize,
        tile: &TileBuffer,
    ) -> Blocks {
        let [top, left] = place(tile.side(), group * 256);
        let by = rows(simd, STEPS) + (frustum.centered(top) + 1.5);
        let bx = columns(simd, STEPS) + (frustum.centered(left) + 1.5);
        let ((x0, x1), (y0, y1)) = (bx.widen(), by.widen());
        let (one, other) = (EightBlocks::new(setup, x0, y0), EightBlocks::new(setup, x1, y1));
        let missed = (one.missed.to_bitmask() & 0xff) | (other.missed.to_bitmask() & 0xff) << 8;
        let nearest = one.nearest.narrow(other.nearest);
        let nearest = nearest + nearest.abs() * setup.relative + setup.affine_error;
        let far = f32x16::from_slice(simd, &tile.block_far[group * 16..group * 16 + 16]);
        let hidden = nearest.simd_lt(far).to_bitmask();
        Blocks {
            discriminant: [one.discriminant.to_array(), other.discriminant.to_array()],
            across: [one.across.to_array(), other.across.to_array()],
            down: [one.down.to_array(), other.down.to_array()],
            affine: [one.affine.to_array(), other.affine.to_array()],
            left: !(missed | hidden) & 0xffff,
        }
    }
}

/// Half of the blocks of a group.
struct EightBlocks<S: Simd> {
    discriminant: f64x8<S>,
    across: f64x8<S>,
    down: f64x8<S>,
    affine: f64x8<S>,
    /// The blocks of which no ray meets the sphere.
    missed: mask64x8<S>,
    /// No key of a block is greater, but for the errors of keys in `f32`.
    nearest: f64x8<S>,
}

impl<S: Simd> EightBlocks<S> {
    /// For blocks with these middles. The farthest samples are 1.5 columns and rows away from them.
    #[inline(always)]
    fn new(setup: &SphereSetup, x: f64x8<S>, y: f64x8<S>) -> Self {
        let [at_middle, of_column, of_row, of_columns, of_both, of_rows] = setup.discriminant;
        let [key, key_across, key_down] = setup.affine;
        let discriminant =
            (y * of_rows + of_row) * y + at_middle + (x * of_columns + y * of_both + of_column) * x;
        let across = x * (2.0 * of_columns) + y * of_both + of_column;
        let down = y * (2.0 * of_rows) + x * of_both + of_row;
        let curved = 2.25 * (of_columns.abs() + of_both.abs() + of_rows.abs());
        let greatest = discriminant + (across.abs() + down.abs()) * 1.5 + curved;
        let zero = discriminant * 0.0;
        let affine = x * key_across + y * key_down + key;
        let of_affine = affine + 1.5 * (key_across.abs() + key_down.abs());
        let root = (greatest.max(zero) + setup.discriminant_error).sqrt();
        EightBlocks {
            discriminant,
            across,
            down,
            affine,
            missed: greatest.simd_lt(zero - setup.discriminant_error),
            nearest: of_affine + root,
        }
    }
}

/// What the key of a root may be off by.
#[inline(always)]
fn error_of<S: Simd>(setup: &SphereSetup, root_error: f32x16<S>, key: f32x16<S>) -> f32x16<S> {
    (root_error + setup.affine_error + key.abs() * setup.relative) * 1.001
}

/// Sixteen samples of a block.
struct Samples<S: Simd> {
    /// Those that certainly see the sphere, and those that certainly do not.
    seen: mask32x16<S>,
    missed: mask32x16<S>,
    low: f32x16<S>,
    high: f32x16<S>,
}

impl<S: Simd> Samples<S> {
    /// The keys of a block. A root of `d` that is off by `e` is off by at most `e/√d`, where `d` is larger than `e`.
    #[inline(always)]
    fn new(
        simd: S,
        setup: &SphereSetup,
        within: &Within<S>,
        blocks: &Blocks,
        block: usize,
    ) -> Samples<S> {
        let (half, lane) = (block / 8, block % 8);
        let (across, down) = (blocks.across[half][lane], blocks.down[half][lane]);
        let (middle, key) = (blocks.discriminant[half][lane], blocks.affine[half][lane]);
        let zero = f64x8::splat(simd, 0.0);
        let [(d0, root0, key0), (d1, root1, key1)] = each!(k in [0, 1] => {
            let d = within.discriminant[k] + within.columns[k] * across;
            let d = d + (within.rows[k] * down + middle);
            (d, d.max(zero).sqrt(), within.affine[k] + key)
        });
        let error = f64x8::splat(simd, setup.discriminant_error);
        let (met0, met1) = (d0.simd_gt(error), d1.simd_gt(error));
        let (passed0, passed1) = (d0.simd_lt(-error), d1.simd_lt(-error));
        let both = |one: mask64x8<S>, other: mask64x8<S>| {
            let bits = one.to_bitmask() & 0xff | (other.to_bitmask() & 0xff) << 8;
            mask32x16::from_bitmask(simd, bits)
        };
        let root_error = upward(setup.discriminant_error) * 1.001;
        let root_error = f32x16::splat(simd, root_error) / root0.narrow(root1);
        let affine = key0.narrow(key1);
        let near = (root0 + key0).narrow(root1 + key1);
        let far = (key0 - root0).narrow(key1 - root1);
        let zero = f32x16::splat(simd, 0.0);
        let (met, missed) = (both(met0, met1), both(passed0, passed1));
        match setup.kind {
            Kind::Outside => {
                let error = f32x16::splat(simd, setup.affine_error) + affine.abs() * setup.relative;
                let leaves = affine.simd_lt(-error);
                let met = met & affine.simd_gt(error);
                Samples::around(near, error_of(setup, root_error, near), [met, missed | leaves])
            }
            Kind::Inside => {
                let nowhere = mask32x16::splat(simd, false);
                Samples::around(near, error_of(setup, root_error, near), [met, nowhere])
            }
            Kind::Parallel => {
                let error = error_of(setup, root_error, near);
                let (in_front, behind) = (near.simd_lt(-error), near.simd_gt(error));
                let root = in_front.select(near, far);
                let error = error_of(setup, root_error, root);
                let root = Samples::around(root, error, [met, missed]);
                let certain = in_front | behind;
                Samples {
                    seen: met & certain & root.high.simd_lt(zero),
                    missed: missed | met & behind & root.low.simd_gt(zero),
                    low: root.low,
                    // It may be the near root.
                    high: certain.select(root.high, f32x16::splat(simd, f32::INFINITY)),
                }
            }
        }
    }

    /// Samples whose keys may be off by an error.
    #[inline(always)]
    fn around(key: f32x16<S>, error: f32x16<S>, [seen, missed]: [mask32x16<S>; 2]) -> Samples<S> {
        Samples { seen, missed, low: key - error, high: key + error }
    }

    /// The depth test at the samples of a block.
    #[inline(always)]
    fn test(&self, simd: S, id: u32, block: usize, tile: &mut TileBuffer) {
        let from = block * 16;
        let stored_low = f32x16::from_slice(simd, &tile.low[from..from + 16]);
        let stored_high = f32x16::from_slice(simd, &tile.high[from..from + 16]);
        let farther = self.missed | self.high.simd_lt(stored_low);
        let ordinary = self.high.simd_lt(f32x16::splat(simd, f32::MAX));
        let nearer = self.seen & ordinary & self.low.simd_gt(stored_high);
        if nearer.any_true() {
            nearer.select(self.low, stored_low).store_slice(&mut tile.low[from..from + 16]);
            nearer.select(self.high, stored_high).store_slice(&mut tile.high[from..from + 16]);
            let ids = u32x16::from_slice(simd, &tile.ids[from..from + 16]);
            let ids = nearer.select(u32x16::splat(simd, id), ids);
            ids.store_slice(&mut tile.ids[from..from + 16]);
            tile.dirty |= 1 << block;
        }
        let open = !(farther | nearer).to_bitmask() & 0xffff;
        if open != 0 {
            tile.leave_all_open(from, open, 0, self.seen.to_bitmask());
        }
    }
}
