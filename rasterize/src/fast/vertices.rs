//! The vertex stage: every vertex is mapped once a frame, to a fixed-point place on the raster and a depth key.

use super::aligned::AlignmentTest;
use super::camera_map::CameraMap;
use super::depth::{KeyScale, LARGEST_KEY};
use bothways_common::Projection;
use bothways_common::engine::simd::{
    Bytes, Level, Select, Simd, SimdBase, SimdInterleaved, SimdMask, SimdSplit, dispatch, f32x8,
    f32x16, f64x8, i32x4, i32x8, i32x16, mask64x8,
};
use bothways_common::look::lanes::each;
use glam::{DVec3, Vec3};

/// One vertex on the raster: row and column in fixed point, the bits of its depth key (an `f32`), and
/// flags.
///
/// Rows and columns count in units of [`FixedPointRaster::unit`] of a sample, 0 at the first sample, each within
/// [`FixedPointRaster::slack`] of the true one. They and the key mean something if [`ON_RASTER`] is set.
pub(super) type Vertex = [i32; 4];

/// The place and the key can be trusted.
pub(super) const ON_RASTER: i32 = 1;
/// Certainly not in front of the eye.
pub(super) const BEHIND: i32 = 2;
/// Certainly left of the first sample, right of the last, above, below; all in front of the eye.
const LEFT: i32 = 4;
const RIGHT: i32 = 8;
const ABOVE: i32 = 16;
const BELOW: i32 = 32;
/// A triangle whose vertices share one of these is not seen.
pub(super) const OUT_OF_SIGHT: i32 = BEHIND | LEFT | RIGHT | ABOVE | BELOW;
/// The place is exactly the true one, and a multiple of a quarter of a sample.
pub(super) const ALIGNED: i32 = 64;

/// The fixed-point raster of one camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct FixedPointRaster {
    /// Bits behind the point of a row or column.
    pub(super) fraction_bits: u32,
    /// One fixed-point unit, in samples.
    pub(super) unit: f32,
    /// Rows and columns of samples.
    pub(super) size: [i32; 2],
    /// How far the difference of fixed-point rows or columns between a vertex and a sample may be from the true one:
    /// in samples, for both ends of an edge together.
    pub(super) slack: f32,
    /// How depth is stored.
    pub(super) keys: KeyScale,
    /// Whether vertices can be trusted at all: the camera is not too extreme.
    trusted: bool,
    /// The test for aligned vertices, if there may be any.
    alignment: Option<AlignmentTest>,
}

impl FixedPointRaster {
    /// Fixed point leaves room for places from half a picture before the first sample to half a
    /// picture behind the last: with `2^s` at least as large as both sides (and as the largest box that
    /// `f32` takes, 256), places are between `−2^(s − 1)` and `1.5·2^s`, so that `30 − s` bits remain.
    ///
    /// A place is off by half a unit of rounding and by the camera map's margin, which holds for vertices
    /// and for rays; vertices are trusted if the margin is no larger than one unit. An edge function
    /// between two vertices, at a sample in their triangle's box of `w × h` samples, moves by at most
    /// `2(w + h)` times the one for both vertices together and once `(w + h)` times the margin for the
    /// sample: `unit + 3·margin` in all, for each of `w` and `h`.
    pub(super) fn new(map: &CameraMap, keys: KeyScale) -> FixedPointRaster {
        let [rows, columns] = map.raster.size();
        let bits = 30 - rows.max(columns).next_power_of_two().max(256).ilog2();
        let unit = 0.5f64.powi(bits.cast_signed());
        let margin = map.margin[0].max(map.margin[1]);
        #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
        let slack = (1.01 * (unit + 3.0 * margin)) as f32;
        FixedPointRaster {
            fraction_bits: bits,
            unit: 0.5f32.powi(bits.cast_signed()),
            size: [rows, columns].map(u32::cast_signed),
            slack,
            keys,
            trusted: margin <= unit,
            alignment: AlignmentTest::new(map),
        }
    }

    /// The vertex stage for any number of vertices, in the vector instructions of a level.
    pub(super) fn place(
        &self,
        level: Level,
        map: &CameraMap,
        positions: &[Vec3],
        vertices: &mut [Vertex],
    ) {
        if positions.len() < 16 {
            let (mut padded, mut placed) = ([Vec3::ZERO; 16], [[0; 4]; 16]);
            padded[..positions.len()].copy_from_slice(positions);
            self.place(level, map, &padded, &mut placed);
            vertices.copy_from_slice(&placed[..positions.len()]);
            return;
        }
        dispatch!(level, simd => self.place_many(simd, map, positions, vertices));
    }

    /// The vertex stage for sixteen vertices or more. Some of the last sixteen may have been placed before: they
    /// get the same places again.
    #[inline(always)]
    fn place_many<S: Simd>(
        &self,
        simd: S,
        map: &CameraMap,
        positions: &[Vec3],
        vertices: &mut [Vertex],
    ) {
        for at in (0..positions.len()).step_by(16) {
            let at = at.min(positions.len() - 16);
            let sixteen = positions[at..].first_chunk().expect("there are sixteen or more");
            self.place_sixteen(simd, map, &rows(sixteen), &mut vertices[at..at + 16]);
        }
    }

    /// The vertex stage for sixteen vertices, given as rows of x, y and z.
    #[inline(always)]
    pub(super) fn place_sixteen<S: Simd>(
        &self,
        simd: S,
        map: &CameraMap,
        [x, y, z]: &[[f32; 16]; 3],
        vertices: &mut [Vertex],
    ) {
        let wide = |row: &[f32; 16]| simd.widen_f32x16(f32x16::load_array_ref(simd, row));
        let (x, y, z) = (wide(x), wide(y), wide(z));
        let upper = self.place_eight(simd, map, [x.0, y.0, z.0]);
        let lower = self.place_eight(simd, map, [x.1, y.1, z.1]);
        let rows = integers(upper.row, lower.row).to_array();
        let columns = integers(upper.column, lower.column).to_array();
        let keys = simd.narrow_f64x8(upper.key, lower.key).bitcast::<i32x16<S>>().to_array();
        let flags = integers(upper.flags, lower.flags).to_array();
        for (four, vertices) in vertices.as_flattened_mut().chunks_exact_mut(16).enumerate() {
            let part = |lanes: &[i32; 16]| i32x4::from_slice(simd, &lanes[four * 4..four * 4 + 4]);
            let parts = [part(&rows), part(&columns), part(&keys), part(&flags)];
            i32x4::store_four_interleaved(parts, vertices);
        }
    }

    /// The places of a box's corners, their keys (as `f32`) and the flags that they share. Places and keys mean
    /// something if all corners are on the raster.
    #[inline(always)]
    pub(super) fn place_corners<S: Simd>(
        &self,
        simd: S,
        map: &CameraMap,
        [low, high]: [Vec3; 2],
    ) -> Corners {
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let x = [low.x, high.x, low.x, high.x, low.x, high.x, low.x, high.x];
        let y = [low.y, low.y, high.y, high.y, low.y, low.y, high.y, high.y];
        let z = [low.z, low.z, low.z, low.z, high.z, high.z, high.z, high.z];
        let corners =
            [f64x8::load_array(simd, x), f64x8::load_array(simd, y), f64x8::load_array(simd, z)];
        let placed = self.place_eight(simd, map, corners);
        // Numbers of eight corners are in the lower half.
        let (rows, _) = integers(placed.row, placed.row).split();
        let (columns, _) = integers(placed.column, placed.column).split();
        let (flags, _) = integers(placed.flags, placed.flags).split();
        let (keys, _) = simd.narrow_f64x8(placed.key, placed.key).split();
        Corners {
            rows: [least(rows), greatest(rows)],
            columns: [least(columns), greatest(columns)],
            nearest: greatest_key(keys),
            flags: common_bits(flags),
        }
    }

    /// Rows and columns in fixed point, keys and flags of eight vertices, given in the world.
    #[inline(always)]
    fn place_eight<S: Simd>(
        &self,
        simd: S,
        map: &CameraMap,
        [x, y, z]: [f64x8<S>; 3],
    ) -> Placed<S> {
        let splat = |value: f64| f64x8::splat(simd, value);
        let eye = map.camera.eye().as_dvec3();
        // Relative to the eye, as the contract says.
        let offset = [x - splat(eye.x), y - splat(eye.y), z - splat(eye.z)];
        let projected = self.project(simd, map, offset);
        let Projected { right, up, onto_viewport, key, .. } = projected;
        let row = up * onto_viewport * splat(map.scale[0]) + splat(map.middle[0]);
        let column = right * onto_viewport * splat(map.scale[1]) + splat(map.middle[1]);
        let (on_raster, flags) = self.flags(simd, &projected, [row, column]);
        let (scale, zero) = (splat(f64::from(1 << self.fraction_bits)), splat(0.0));
        Placed {
            row: on_raster.select(row * scale, zero),
            column: on_raster.select(column * scale, zero),
            key: on_raster.select(key, zero),
            flags,
        }
    }

    /// Eight vertices as the camera sees them.
    ///
    /// [`CameraMap::new`] says what is trusted, and why: `ζ ≥ 2⁻¹⁰·s` for the depth `ζ` along the view.
    /// Then `1/t = d/ζ` (perspective) is known to within 2⁻⁴¹ of itself, and a key that is at least 2⁻¹⁵ of it to
    /// within 2⁻²⁶; `t` from the local origin on (parallel) is known to within 2⁻⁴⁸ of the vertex' distance from
    /// there, and a key that is at least 2⁻²⁰ of that to within 2⁻²⁷. Rounding to `f32` adds 2⁻²⁴.
    #[inline(always)]
    fn project<S: Simd>(&self, simd: S, map: &CameraMap, [x, y, z]: [f64x8<S>; 3]) -> Projected<S> {
        let splat = |value: f64| f64x8::splat(simd, value);
        let offset = [x, y, z];
        let extent = x.abs() + y.abs() + z.abs();
        let depth = -along(simd, map.w, &offset);
        let behind = depth.simd_lt(extent * splat(-(-46f64).exp2()));
        let in_front = depth.simd_ge(extent * splat((-10f64).exp2())) & depth.simd_gt(splat(0.0));
        let trusted = mask64x8::splat(simd, self.trusted);
        match self.keys.projection {
            Projection::Perspective => {
                let onto_viewport = splat(map.distance) / depth;
                Projected {
                    right: along(simd, map.u, &offset),
                    up: along(simd, map.v, &offset),
                    depth,
                    onto_viewport,
                    key: onto_viewport - splat(self.keys.offset),
                    least_key: onto_viewport * splat((-15f64).exp2()),
                    behind,
                    safe: in_front & trusted,
                }
            }
            Projection::Parallel => {
                let [high, low] = map.local.parts();
                let x = x - splat(high.x) - splat(low.x);
                let y = y - splat(high.y) - splat(low.y);
                let z = z - splat(high.z) - splat(low.z);
                let relative = [x, y, z];
                let extent = x.abs() + y.abs() + z.abs();
                let close = extent.simd_le(splat(map.trusted_extent));
                Projected {
                    right: along(simd, map.u, &relative),
                    up: along(simd, map.v, &relative),
                    depth,
                    onto_viewport: splat(1.0),
                    key: splat(self.keys.offset) + along(simd, map.w, &relative),
                    least_key: extent * splat((-20f64).exp2()),
                    behind,
                    safe: in_front & close & trusted,
                }
            }
        }
    }

    /// Which of eight vertices are on the raster, and all flags.
    #[inline(always)]
    fn flags<S: Simd>(
        &self,
        simd: S,
        projected: &Projected<S>,
        [row, column]: [f64x8<S>; 2],
    ) -> (mask64x8<S>, f64x8<S>) {
        let splat = |value: f64| f64x8::splat(simd, value);
        let Projected { right, up, depth, key, least_key, behind, safe, .. } = *projected;
        let key_trusted = key.simd_ge(least_key)
            & key.simd_ge(splat(1.0 / LARGEST_KEY))
            & key.simd_le(splat(LARGEST_KEY));
        let side = f64::from(1 << (30 - self.fraction_bits));
        let [least, most] = [splat(-0.5 * side), splat(1.49 * side)];
        let is_within =
            column.simd_ge(least) & column.simd_lt(most) & (row.simd_ge(least) & row.simd_lt(most));
        let on_raster = safe & key_trusted & is_within;

        let [height, width] = self.size.map(f64::from);
        let one = splat(1.0);
        let mut flags = flag(simd, on_raster, ON_RASTER)
            + flag(simd, behind, BEHIND)
            + flag(simd, safe & column.simd_lt(-one), LEFT)
            + flag(simd, safe & column.simd_gt(splat(width)), RIGHT)
            + flag(simd, safe & row.simd_lt(-one), ABOVE)
            + flag(simd, safe & row.simd_gt(splat(height)), BELOW);
        if let Some(alignment) = &self.alignment {
            let down = alignment.is_aligned(simd, 0, [row, -up, depth]);
            let across = alignment.is_aligned(simd, 1, [column, right, depth]);
            flags += flag(simd, on_raster & across & down, ALIGNED);
        }
        (on_raster, flags)
    }
}

/// How far eight offsets go along an axis.
#[inline(always)]
fn along<S: Simd>(simd: S, axis: DVec3, [x, y, z]: &[f64x8<S>; 3]) -> f64x8<S> {
    let [of_x, of_y, of_z] = each!(part in [axis.x, axis.y, axis.z] => f64x8::splat(simd, part));
    *x * of_x + *y * of_y + *z * of_z
}

/// A flag where it holds, 0 elsewhere.
#[inline(always)]
fn flag<S: Simd>(simd: S, holds: mask64x8<S>, flag: i32) -> f64x8<S> {
    holds.select(f64x8::splat(simd, f64::from(flag)), f64x8::splat(simd, 0.0))
}

/// Eight vertices as the camera sees them.
#[derive(Clone, Copy)]
struct Projected<S: Simd> {
    /// The offset along `u` and `v`.
    right: f64x8<S>,
    up: f64x8<S>,
    /// The depth from the eye along the view.
    depth: f64x8<S>,
    /// The factor that brings `right` and `up` onto the viewport.
    onto_viewport: f64x8<S>,
    /// The depth key, and the least one that is trusted.
    key: f64x8<S>,
    least_key: f64x8<S>,
    /// Whether a vertex is certainly not in front of the eye.
    behind: mask64x8<S>,
    /// Whether its row and column can be trusted.
    safe: mask64x8<S>,
}

/// Eight vertices, all numbers still `f64`.
struct Placed<S: Simd> {
    row: f64x8<S>,
    column: f64x8<S>,
    key: f64x8<S>,
    flags: f64x8<S>,
}

/// What the eight corners of a box have in common.
pub(super) struct Corners {
    /// The least and the greatest.
    pub(super) rows: [i32; 2],
    pub(super) columns: [i32; 2],
    /// The largest key.
    pub(super) nearest: f32,
    /// The flags that all of them have.
    pub(super) flags: i32,
}

/// The least of eight numbers.
#[inline(always)]
fn least<S: Simd>(numbers: i32x8<S>) -> i32 {
    let (four, others) = numbers.split();
    let [a, b, c, d] = four.min(others).to_array();
    a.min(b).min(c.min(d))
}

/// The greatest of eight numbers.
#[inline(always)]
fn greatest<S: Simd>(numbers: i32x8<S>) -> i32 {
    let (four, others) = numbers.split();
    let [a, b, c, d] = four.max(others).to_array();
    a.max(b).max(c.max(d))
}

/// The greatest of eight keys, each of which is 0 or trusted, and so a number.
#[inline(always)]
fn greatest_key<S: Simd>(keys: f32x8<S>) -> f32 {
    let (four, others) = keys.split();
    let [a, b, c, d] = four.max(others).to_array();
    let greater = |a: f32, b: f32| if a > b { a } else { b };
    greater(greater(a, b), greater(c, d))
}

/// The bits that eight numbers have in common.
#[inline(always)]
fn common_bits<S: Simd>(numbers: i32x8<S>) -> i32 {
    let (four, others) = numbers.split();
    let [a, b, c, d] = (four & others).to_array();
    a & b & c & d
}

/// Rows of x, y and z of sixteen positions.
#[inline(always)]
fn rows(positions: &[Vec3; 16]) -> [[f32; 16]; 3] {
    let mut rows = [[0.0; 16]; 3];
    for (axis, row) in rows.iter_mut().enumerate() {
        for (along, position) in row.iter_mut().zip(positions) {
            *along = position.to_array()[axis];
        }
    }
    rows
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

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::levels;
    use bothways_common::{Camera, CameraDescription};

    #[test]
    fn corners_of_a_box_have_in_common_what_vertices_there_have() {
        let random = &mut fastrand::Rng::with_seed(3);
        let around = [DVec3::splat(-4.0), DVec3::splat(4.0)];
        let bounds: [DVec3; 8] = std::array::from_fn(|k| {
            DVec3::from_array(std::array::from_fn(|axis| around[k >> axis & 1][axis]))
        });
        let (mut on_raster, mut out_of_sight) = (0, 0);
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description = CameraDescription {
                // Of the boxes, some lie behind it.
                eye: Vec3::new(0.5, 1.0, 2.0),
                projection,
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).expect("it is a camera");
            let grid = camera.sample_grid(1);
            let map = CameraMap::new(&camera, &grid, camera.raster(1), &bounds);
            let keys = KeyScale::new(&map, &bounds, false);
            let raster = FixedPointRaster::new(&map, keys);
            for _ in 0..500 {
                let mut corner =
                    || Vec3::from_array(std::array::from_fn(|_| 8.0 * random.f32() - 4.0));
                let (a, b) = (corner(), corner());
                let (low, high) = (a.min(b), a.max(b).lerp(a.min(b), random.f32()));
                let corners: [Vec3; 8] = std::array::from_fn(|k| {
                    let side =
                        |axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
                    Vec3::new(side(0), side(1), side(2))
                });
                for level in levels() {
                    let mut vertices = [[0; 4]; 8];
                    raster.place(level, &map, &corners, &mut vertices);
                    let common =
                        dispatch!(level, simd => raster.place_corners(simd, &map, [low, high]));
                    let all = |part: usize| vertices.iter().map(move |vertex| vertex[part]);
                    let ends = |part| all(part).min().zip(all(part).max());
                    assert_eq!(Some(common.rows.into()), ends(0));
                    assert_eq!(Some(common.columns.into()), ends(1));
                    let keys = all(2).map(|key| f32::from_bits(key.cast_unsigned()));
                    assert_eq!(common.nearest, keys.fold(0.0, f32::max));
                    let flags = all(3).fold(-1, |common, flags| common & flags);
                    assert_eq!(common.flags, flags);
                    on_raster += usize::from(flags & ON_RASTER != 0);
                    out_of_sight += usize::from(flags & OUT_OF_SIGHT != 0);
                }
            }
        }
        assert!(on_raster > 50 && out_of_sight > 50, "{on_raster}, {out_of_sight}");
    }
}
