//! The vertex stage: every vertex once a frame, to a fixed-point place on the raster and a depth key.

use super::aligned::ExactRaster;
use super::depth::{KeyScale, LARGEST_KEY};
use super::screen::Screen;
use bothways_common::Projection;
use bothways_common::engine::simd::{
    Bytes, Select, Simd, SimdBase, SimdInterleaved, SimdMask, f32x16, f64x8, i32x4, i32x16,
    mask64x8,
};
use glam::{DVec3, Vec3};

/// One vertex on the raster: column and row in fixed point, the bits of its depth key (an `f32`), and
/// flags.
///
/// Columns and rows count in units of [`Raster::unit`] of a sample, 0 at the first sample, each within
/// [`Raster::slack`] of the true one. They and the key mean something if [`ON_RASTER`] is set.
pub(super) type Vertex = [i32; 4];

/// The place and the key can be trusted.
pub(super) const ON_RASTER: i32 = 1;
/// Certainly not in front of the eye.
pub(super) const BEHIND: i32 = 2;
/// Certainly left of the first sample, right of the last, above, below; all in front of the eye.
pub(super) const LEFT: i32 = 4;
const RIGHT: i32 = 8;
const ABOVE: i32 = 16;
const BELOW: i32 = 32;
/// A triangle whose vertices share one of these is not seen.
pub(super) const OUT_OF_SIGHT: i32 = BEHIND | LEFT | RIGHT | ABOVE | BELOW;
/// The place is exactly the true one, and a multiple of a quarter of a sample.
pub(super) const ALIGNED: i32 = 64;

/// The fixed-point raster of one camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raster {
    /// Bits behind the point of a column or row.
    pub(super) fraction_bits: u32,
    /// One fixed-point unit, in samples.
    pub(super) unit: f32,
    /// Columns and rows of samples.
    pub(super) size: [i32; 2],
    /// How far the fixed-point column or row of a vertex, less that of a sample, may be from the true
    /// difference: in samples, for the differences along two edges' ends together.
    pub(super) slack: f32,
    /// How depth is stored.
    pub(super) keys: KeyScale,
    /// Whether vertices can be trusted at all: the camera is not too extreme.
    trusted: bool,
    /// The same without rounding, where there is none.
    exact: Option<ExactRaster>,
}

impl Raster {
    /// Fixed point leaves room for places from half a picture before the first sample to half a
    /// picture behind the last: with `2^s` at least as large as both sides (and as the largest box that
    /// `f32` takes, 256), places are between `−2^(s − 1)` and `1.5·2^s`, so that `30 − s` bits remain.
    ///
    /// A place is off by half a unit of rounding and by the screen's margin, which speaks of vertices
    /// and of the rays; vertices are trusted if the margin is no larger than one unit. An edge function
    /// between two vertices, at a sample in their triangle's box of `w × h` samples, moves by at most
    /// `2(w + h)` times the one for both vertices together and once `(w + h)` times the margin for the
    /// sample: `unit + 3·margin` in all, for each of `w` and `h`.
    pub(super) fn new(screen: &Screen, keys: KeyScale) -> Raster {
        let [width, height] = [screen.grid.width(), screen.grid.height()];
        let bits = 30 - width.max(height).next_power_of_two().max(256).ilog2();
        let unit = 0.5f64.powi(bits.cast_signed());
        let margin = screen.margin[0].max(screen.margin[1]);
        let size = |side: usize| i32::try_from(side).expect("at most 65,536");
        #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
        let slack = (1.01 * (unit + 3.0 * margin)) as f32;
        Raster {
            fraction_bits: bits,
            unit: 0.5f32.powi(bits.cast_signed()),
            size: [size(width), size(height)],
            slack,
            keys,
            trusted: margin <= unit,
            exact: ExactRaster::new(screen),
        }
    }

    /// The vertex stage for any number of vertices.
    #[inline(always)]
    pub(super) fn place<S: Simd>(
        &self,
        simd: S,
        screen: &Screen,
        positions: &[Vec3],
        vertices: &mut [Vertex],
    ) {
        let (positions, rest) = positions.as_chunks::<16>();
        let (vertices, last) = vertices.split_at_mut(16 * positions.len());
        for (positions, vertices) in positions.iter().zip(vertices.chunks_exact_mut(16)) {
            self.place_sixteen(simd, screen, positions, vertices.as_flattened_mut());
        }
        if !rest.is_empty() {
            let mut padded = [Vec3::ZERO; 16];
            padded[..rest.len()].copy_from_slice(rest);
            let mut placed = [[0; 4]; 16];
            self.place_sixteen(simd, screen, &padded, placed.as_flattened_mut());
            last.copy_from_slice(&placed[..rest.len()]);
        }
    }

    #[inline(always)]
    fn place_sixteen<S: Simd>(
        &self,
        simd: S,
        screen: &Screen,
        positions: &[Vec3; 16],
        vertices: &mut [i32],
    ) {
        let (x, y, z) = (
            coordinates(simd, positions, 0),
            coordinates(simd, positions, 1),
            coordinates(simd, positions, 2),
        );
        let upper = self.place_eight(simd, screen, [x.0, y.0, z.0]);
        let lower = self.place_eight(simd, screen, [x.1, y.1, z.1]);
        let columns = integers(upper.column, lower.column).to_array();
        let rows = integers(upper.row, lower.row).to_array();
        let keys = simd.narrow_f64x8(upper.key, lower.key).bitcast::<i32x16<S>>().to_array();
        let flags = integers(upper.flags, lower.flags).to_array();
        for (four, vertices) in vertices.chunks_exact_mut(16).enumerate() {
            let part = |lanes: &[i32; 16]| i32x4::from_slice(simd, &lanes[four * 4..four * 4 + 4]);
            let parts = [part(&columns), part(&rows), part(&keys), part(&flags)];
            i32x4::store_four_interleaved(parts, vertices);
        }
    }

    /// The places of a box's corners, the keys of those (as `f32`) and the flags that they share; none
    /// unless all of them are on the raster.
    #[inline(always)]
    pub(super) fn place_corners<S: Simd>(
        &self,
        simd: S,
        screen: &Screen,
        [low, high]: [Vec3; 2],
    ) -> Corners {
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let x = [low.x, high.x, low.x, high.x, low.x, high.x, low.x, high.x];
        let y = [low.y, low.y, high.y, high.y, low.y, low.y, high.y, high.y];
        let z = [low.z, low.z, low.z, low.z, high.z, high.z, high.z, high.z];
        let corners =
            [f64x8::load_array(simd, x), f64x8::load_array(simd, y), f64x8::load_array(simd, z)];
        let placed = self.place_eight(simd, screen, corners);
        let columns = integers(placed.column, placed.column).to_array();
        let rows = integers(placed.row, placed.row).to_array();
        let flags = integers(placed.flags, placed.flags).to_array();
        let keys = simd.narrow_f64x8(placed.key, placed.key).to_array();
        let ends = |places: &[i32; 16]| {
            [
                places.iter().fold(i32::MAX, |low, place| low.min(*place)),
                places.iter().fold(i32::MIN, |high, place| high.max(*place)),
            ]
        };
        Corners {
            columns: ends(&columns),
            rows: ends(&rows),
            nearest: keys.into_iter().fold(0.0, f32::max),
            flags: flags.into_iter().fold(-1, |common, flags| common & flags),
        }
    }

    /// Columns and rows in fixed point, keys and flags of eight vertices.
    ///
    /// What is trusted, and why, says [`Screen::new`]: `ζ ≥ 2⁻¹⁰·s` for the depth `ζ` along the view.
    /// Then `1/t = d/ζ` (perspective) is known to within 2⁻⁴¹ of itself, and a key that is at least 2⁻¹⁵ of it to
    /// within 2⁻²⁶; `t` from the waypoint on (parallel) is known to within 2⁻⁴⁸ of the vertex' distance from
    /// there, and a key that is at least 2⁻²⁰ of that to within 2⁻²⁷. Rounding to `f32` adds 2⁻²⁴.
    #[inline(always)]
    fn place_eight<S: Simd>(
        &self,
        simd: S,
        screen: &Screen,
        [x, y, z]: [f64x8<S>; 3],
    ) -> Placed<S> {
        let splat = |value: f64| f64x8::splat(simd, value);
        let eye = screen.camera.eye().as_dvec3();
        // Relative to the eye, as the contract says.
        let (x, y, z) = (x - splat(eye.x), y - splat(eye.y), z - splat(eye.z));
        let along = |axis: DVec3| x * splat(axis.x) + y * splat(axis.y) + z * splat(axis.z);
        let extent = x.abs() + y.abs() + z.abs();
        let depth = -along(screen.w);
        let zero = splat(0.0);

        let behind = depth.simd_lt(extent * splat(-(-46f64).exp2()));
        let in_front = depth.simd_ge(extent * splat((-10f64).exp2())) & depth.simd_gt(zero);
        let (right, up, onto_viewport, key, least_key, safe) = match self.keys.projection {
            Projection::Perspective => {
                let onto = splat(screen.distance) / depth;
                let (right, up) = (along(screen.u), along(screen.v));
                let key = onto - splat(self.keys.offset);
                (right, up, onto, key, onto * splat((-15f64).exp2()), in_front)
            }
            Projection::Parallel => {
                let [high, low] = screen.waypoint.parts();
                let x = x - splat(high.x) - splat(low.x);
                let y = y - splat(high.y) - splat(low.y);
                let z = z - splat(high.z) - splat(low.z);
                let along = |axis: DVec3| x * splat(axis.x) + y * splat(axis.y) + z * splat(axis.z);
                let extent = x.abs() + y.abs() + z.abs();
                let close = extent.simd_le(splat(screen.trusted_extent));
                let key = splat(self.keys.offset) + along(screen.w);
                let least_key = extent * splat((-20f64).exp2());
                (along(screen.u), along(screen.v), splat(1.0), key, least_key, in_front & close)
            }
        };
        let safe = safe & mask64x8::splat(simd, self.trusted);
        let column = right * onto_viewport * splat(screen.scale[0]) + splat(screen.middle[0]);
        let row = up * onto_viewport * splat(screen.scale[1]) + splat(screen.middle[1]);
        let key_trusted = key.simd_ge(least_key)
            & key.simd_ge(splat(1.0 / LARGEST_KEY))
            & key.simd_le(splat(LARGEST_KEY));

        let [width, height] = self.size.map(f64::from);
        let one = splat(1.0);
        let side = f64::from(1 << (30 - self.fraction_bits));
        let within =
            |place: f64x8<S>| place.simd_ge(splat(-0.5 * side)) & place.simd_lt(splat(1.49 * side));
        let on_raster = safe & key_trusted & within(column) & within(row);
        let flag = |mask: mask64x8<S>, flag: i32| mask.select(splat(f64::from(flag)), zero);
        let mut flags = flag(on_raster, ON_RASTER)
            + flag(behind, BEHIND)
            + flag(safe & column.simd_lt(-one), LEFT)
            + flag(safe & column.simd_gt(splat(width)), RIGHT)
            + flag(safe & row.simd_lt(-one), ABOVE)
            + flag(safe & row.simd_gt(splat(height)), BELOW);
        if let Some(exact) = &self.exact {
            let across = exact.holds(simd, 0, [column, right, depth]);
            let down = exact.holds(simd, 1, [row, -up, depth]);
            let aligned = on_raster & across & down;
            flags += flag(aligned, ALIGNED);
        }
        let scale = splat(f64::from(1 << self.fraction_bits));
        Placed {
            column: on_raster.select(column * scale, zero),
            row: on_raster.select(row * scale, zero),
            key: on_raster.select(key, zero),
            flags,
        }
    }
}

/// Eight vertices, all numbers still `f64`.
struct Placed<S: Simd> {
    column: f64x8<S>,
    row: f64x8<S>,
    key: f64x8<S>,
    flags: f64x8<S>,
}

/// What the eight corners of a box have in common.
pub(super) struct Corners {
    /// The least and the greatest.
    pub(super) columns: [i32; 2],
    pub(super) rows: [i32; 2],
    /// The largest key.
    pub(super) nearest: f32,
    /// The flags that all of them have.
    pub(super) flags: i32,
}

/// One coordinate of sixteen positions.
#[inline(always)]
fn coordinates<S: Simd>(simd: S, positions: &[Vec3; 16], axis: usize) -> (f64x8<S>, f64x8<S>) {
    let mut along = [0.0; 16];
    for (along, position) in along.iter_mut().zip(positions) {
        *along = position.to_array()[axis];
    }
    simd.widen_f32x16(f32x16::load_array(simd, along))
}

/// The nearest integers, which must be within 31 bits: those of `upper`, then those of `lower`.
///
/// Added to 1.5·2⁵², a number has no bits left behind the point, and its last 32 bits are the integer in
/// two's complement.
#[inline(always)]
fn integers<S: Simd>(upper: f64x8<S>, lower: f64x8<S>) -> i32x16<S> {
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    // The last 32 bits come first in memory.
    (upper + MAGIC).bitcast::<i32x16<S>>().unzip_low((lower + MAGIC).bitcast::<i32x16<S>>())
}
