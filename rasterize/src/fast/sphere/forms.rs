//! A sphere's equation as functions on the raster, with the errors of their rounding.

use super::equation::begins_on;
use crate::fast::camera_map::CameraMap;
use crate::fast::depth::{KeyScale, LARGEST_KEY};
use crate::fast::high_precision::DoubleDouble;
use bothways_common::Projection;
use bothways_common::engine::fault::{Fault, error_bound};
use bothways_common::engine::roundoff::{EPS53, cross_permanent};
use bothways_common::raster::{Region, Sample};
use glam::DVec3;

/// Second-order terms, and the roundings of a bound itself.
const ROOM: f64 = 1.02;

/// A sphere, ready to be tested sixteen samples at a time.
///
/// With `p` and a vector `q = q₀ + ξ·u + η·v` that moves with the sample (`ξ` across and `η` up, from an origin), a
/// ray meets the sphere where a square root is added to `b = p·q`. *Perspective*: `p` is the centre `c`, `q` the ray's
/// direction, and `1/t = (b ± √d)/C` with `d = r²·|q|² − |p × q|²`, `C = c·c − r²`. *Parallel*: `p` is the ray's
/// direction, `q` its origin seen from the centre, and `−t = (b ± √d)/A` with `d = r²·|p|² − |p × q|²`, `A = p·p`. (The
/// discriminants are those of the equation, by Lagrange's identity.) So `b` is an affine function on the raster and `d`
/// a quadratic one; and from outside, the key that is stored is the sum of an affine function and of a root.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forms {
    pub(super) seen: SeenRoot,
    /// The sample from which rows and columns count.
    pub(super) origin: Sample,
    /// `η` from one row to the next (negative), and `ξ` from one column to the next.
    pub(super) spacing: [f64; 2],
    pub(super) square: QuadraticForm,
    pub(super) linear: LinearForm,
    /// No key of the sphere is larger, but for rounding.
    pub(super) nearest: f32,
}

/// Which root is seen, and what tells that it is certain.
#[derive(Clone, Copy, Debug)]
pub(super) enum SeenRoot {
    /// The near root of a sphere before the eye: the key is `linear + √square`.
    Near {
        /// How far `square` may be off.
        square_error: f64,
        /// How far the key may be off, but for what an error of `square` brings.
        key_error: f64,
        /// Where `linear` is less, the sphere is met behind the eye.
        behind: f64,
    },
    /// The far wall, from an eye inside of a sphere or on it: `square` is `A`, `linear` is `b`.
    Inside {
        /// `−C`, zero if the eye is on the sphere.
        depth: f64,
        /// `√d` above which everything is certain.
        least_root: f64,
    },
}

/// A quadratic function of `ξ` and `η`.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuadraticForm {
    /// Of 1, `η` and `η²`.
    pub(super) on_column: [f64; 3],
    /// Of `ξ` and `ξ·η`.
    pub(super) across: [f64; 2],
    /// Of `ξ²`.
    pub(super) curvature: f64,
}

/// An affine function of `ξ` and `η`.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearForm {
    /// Of 1 and `η`.
    pub(super) on_column: [f64; 2],
    /// Of `ξ`.
    pub(super) across: f64,
}

/// A vector that moves with the sample: `q₀`, and what it grows by for `ξ` and `η`.
#[derive(Clone, Copy)]
struct Moving([DVec3; 3]);

impl Moving {
    fn map(&self, change: impl Fn(DVec3) -> DVec3) -> Moving {
        Moving(self.0.map(change))
    }

    /// A bound of the vector's coordinates in a region.
    fn size(&self, [y, x]: [f64; 2]) -> DVec3 {
        let [origin, across, up] = self.0.map(DVec3::abs);
        origin + x * across + y * up
    }

    /// The vector's square. Each coefficient carries 3 roundings of its size.
    fn square(&self) -> QuadraticForm {
        let [q, u, v] = self.0;
        QuadraticForm {
            on_column: [q.dot(q), 2.0 * q.dot(v), v.dot(v)],
            across: [2.0 * q.dot(u), 2.0 * u.dot(v)],
            curvature: u.dot(u),
        }
    }

    /// Its product with a fixed vector. Each coefficient carries 3 roundings of its size.
    fn dot(&self, p: DVec3) -> LinearForm {
        let [q, u, v] = self.0;
        LinearForm { on_column: [p.dot(q), p.dot(v)], across: p.dot(u) }
    }
}

impl QuadraticForm {
    const ZERO: QuadraticForm =
        QuadraticForm { on_column: [0.0; 3], across: [0.0; 2], curvature: 0.0 };

    fn combine(&self, other: &QuadraticForm, with: impl Fn(f64, f64) -> f64) -> QuadraticForm {
        QuadraticForm {
            on_column: std::array::from_fn(|k| with(self.on_column[k], other.on_column[k])),
            across: std::array::from_fn(|k| with(self.across[k], other.across[k])),
            curvature: with(self.curvature, other.curvature),
        }
    }
}

/// A region of the raster: its middle, and how far its samples are from there.
struct RegionExtent {
    origin: Sample,
    spacing: [f64; 2],
    /// The largest `|η|` and `|ξ|`.
    most: [f64; 2],
}

impl RegionExtent {
    fn new(map: &CameraMap, Region { rows, columns }: &Region) -> RegionExtent {
        let origin =
            Sample { row: rows.start + rows.len() / 2, column: columns.start + columns.len() / 2 };
        let [down, across] = map.raster.spacing();
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let half = [rows.len(), columns.len()].map(|count| count.div_ceil(2) as f64);
        RegionExtent { origin, spacing: [-down, across], most: [half[0] * down, half[1] * across] }
    }
}

/// What a sphere's equation is made of.
struct Equation {
    /// `p`, the vector that all rays share.
    p: DVec3,
    /// `q`, and how far each of its coordinates may be off.
    q: Moving,
    q_error: DVec3,
    radius: f64,
}

impl Forms {
    /// The functions of a sphere on a region of the raster, the same for all tiles; `None` if rounding would leave too
    /// much open, or if the sphere reaches to the plane of a parallel camera's eye.
    ///
    /// # How far `q` is off, rounding by rounding
    ///
    /// `ξ` is the number of columns times their spacing, each product and spacing rounded once, `2·ε₅₃·|ξ|`; the two
    /// coordinates `x` that it stands for are rounded once each: 6 of `½·vw`; `η` likewise. A direction is the sum of
    /// three products, 3 roundings of `reach`, an origin that of two, 2; as the origin of all has as many of its own,
    /// `q` is off by `(6 + 2·3)·ε₅₃·reach`, or, parallel, `(6 + 2·2)·ε₅₃·reach` and what the centre brings: two
    /// roundings of itself (see [`LocalOrigin`](crate::fast::local_origin::LocalOrigin)), one of the difference.
    pub(super) fn new<F: Fault>(
        map: &CameraMap,
        keys: KeyScale,
        (center, radius): (DVec3, f64),
        region: &Region,
    ) -> Option<Forms> {
        let place = RegionExtent::new(map, region);
        let ray = map.grid.ray(place.origin.row, place.origin.column);
        let depth = -center.dot(map.w);
        let is_in_front = depth - radius >= (center.abs().element_sum() + radius) * (-10f64).exp2();
        // `u` and `v` are perpendicular to `w` to within 2⁻⁵⁰.
        let skew = (-46f64).exp2() * map.reach.element_sum();
        match map.projection() {
            Projection::Perspective => {
                let q = Moving([ray.direction, map.u, map.v]);
                let q_error = 12.5 * EPS53 * map.reach;
                let equation = Equation { p: center, q, q_error, radius };
                let nearest = if is_in_front {
                    (map.distance + skew) / (depth - radius)
                } else {
                    f64::INFINITY
                };
                let (c, relative) = outside(center, radius)?;
                if c > 0.0 {
                    let divisor = (c, relative);
                    equation.near::<F>(&place, divisor, -keys.offset, nearest, true)
                } else {
                    equation.inside::<F>(map, &place, -c).filter(|_| keys.offset == 0.0)
                }
            }
            Projection::Parallel if is_in_front => {
                let center = map.local.relative(center);
                let from_center = ray.origin - center;
                let q = Moving([from_center, map.u, map.v]);
                let of_center = from_center.abs() + 2.0 * center.abs();
                let q_error = EPS53 * (10.5 * map.reach + ROOM * of_center);
                let p = ray.direction;
                let equation = Equation { p, q, q_error, radius };
                let extent = center.abs().element_sum() + radius;
                let nearest = center.dot(map.w) + radius + (-46f64).exp2() * extent + skew;
                let divisor = (p.length_squared(), 4.0 * EPS53);
                equation.near::<F>(&place, divisor, keys.offset, nearest, false)
            }
            Projection::Parallel => None,
        }
    }
}

/// `C = c·c − r²` and a bound of its relative error, at most 2⁻⁴⁰: positive if the eye is outside of the sphere, zero
/// if it is exactly on it.
///
/// In `f64`, `c·c` carries 3 roundings, `r²` none (a radius has 24 bits), the difference one: 4 of `c·c + r²`. With
/// twice as many digits, that of `Equation::in_high_precision` holds, and one rounding more.
fn outside(center: DVec3, radius: f64) -> Option<(f64, f64)> {
    const ENOUGH: f64 = 1.0 / (1_u64 << 40) as f64;
    let (squares, r_squared) = (center.length_squared(), radius * radius);
    let size = squares + r_squared;
    let rounded = squares - r_squared;
    let relative = 5.0 * EPS53 * size / rounded.abs();
    if relative <= ENOUGH {
        return Some((rounded, relative));
    }
    let m = center.to_array().map(DoubleDouble::new);
    if begins_on(&m, radius) {
        return Some((0.0, 0.0));
    }
    let r = DoubleDouble::new(radius);
    let [x, y, z] = m.map(|coordinate| coordinate * coordinate);
    let c = (x + y + z - r * r).high;
    let relative = 24.0 * EPS53 * EPS53 * size / c.abs() + 2.0 * EPS53;
    // Below this, the squares may have underflowed.
    (relative <= ENOUGH && size > 1e-180).then_some((c, relative))
}

impl Equation {
    /// The functions of a sphere whose near root is seen: the key is `(b + √d)/divisor + offset`.
    ///
    /// # The errors, rounding by rounding
    ///
    /// With `s = |q₀| + |ξ|·|u| + |η|·|v|` in the region, and `e` how far `q` is off:
    ///
    /// *`p × q`.* A coordinate of `p × q₀`, `p × u` or `p × v` carries 2 roundings, so the moving vector `n` that they
    /// make is off by `f = |p| × (e + 2ε₅₃·s)`, a permanent. Let `N` be its size in the region.
    ///
    /// *`d`.* Each coefficient is the difference of `r²` (exact) times a sum of three products, and of another:
    /// 5 roundings. It is multiplied by `1/divisor²`, 2 more. A term passes 5 roundings of its evaluation. That is
    /// 12 of `D = r²·s·s + N·N` (parallel: `r²·p·p`); and what `q` and `n` are off brings `r²·(2s·e + e·e)` (parallel:
    /// nothing) and `2N·f + f·f`.
    ///
    /// *Key.* A coefficient of `b` carries 3 roundings, 2 from `1/divisor` and its product, one of the offset, and 3 of
    /// the evaluation: 9 of `B = |p|·s`, over the divisor, and 3 of the offset; `e` brings `|p|·e`. The root and the sum
    /// are rounded once each, roots being at most `√D`. The divisor's own error and rounding are relative to `(b +
    /// √d)/divisor`. If `d` is off by `δ`, a root is off by at most `δ/√d` (for `d > δ`): this depends on the
    /// sample.
    fn near<F: Fault>(
        &self,
        place: &RegionExtent,
        (divisor, relative): (f64, f64),
        offset: f64,
        nearest: f64,
        perspective: bool,
    ) -> Option<Forms> {
        let Equation { p, q, q_error, radius } = *self;
        let (factor, r_squared) = (1.0 / divisor, radius * radius);
        let normal = q.map(|vector| p.cross(vector));
        let size = q.size(place.most);
        let normal_size = normal.size(place.most);
        let normal_error = cross_permanent(p, q_error + 2.0 * EPS53 * size);
        let (own, own_size, own_error) = if perspective {
            let error = r_squared * (2.0 * size.dot(q_error) + q_error.length_squared());
            (q.square(), size.length_squared(), error)
        } else {
            let squared = p.length_squared();
            (QuadraticForm { on_column: [squared, 0.0, 0.0], ..QuadraticForm::ZERO }, squared, 0.0)
        };
        let all = r_squared * own_size + normal_size.length_squared();
        let squared_factor = factor * factor;
        let square = own
            .combine(&normal.square(), |own, normal| (r_squared * own - normal) * squared_factor);
        let of_normal = 2.0 * normal_size.dot(normal_error) + normal_error.length_squared();
        let square_error = ROOM * (12.0 * EPS53 * all + own_error + of_normal) * squared_factor;

        let mut linear = q.dot(p);
        linear.on_column = linear.on_column.map(|number| number * factor);
        linear.across *= factor;
        linear.on_column[0] += offset;
        let b_size = p.abs().dot(size);
        let (most, most_offset) = ((b_size + all.sqrt()) * factor, offset.abs());
        let key_error = ROOM
            * ((9.0 * EPS53 * b_size + p.abs().dot(q_error)) * factor
                + (3.0 * EPS53 + relative) * most
                + 4.0 * EPS53 * most_offset);
        // Far from overflow, also of squares. Written so that NaN fails.
        let in_range = most + most_offset <= LARGEST_KEY;
        if !in_range {
            return None;
        }
        // What is certain then is a key in range.
        let key_error = error_bound::<F>(key_error).max(1.0 / LARGEST_KEY);
        // A scene that is all in front of the eye has an offset.
        let behind = if perspective && offset == 0.0 { -key_error } else { f64::NEG_INFINITY };
        let square_error = error_bound::<F>(square_error + f64::MIN_POSITIVE);
        let seen = SeenRoot::Near { square_error, key_error, behind };
        Some(self.forms(place, seen, square, linear, upper(nearest, offset)))
    }

    /// The functions of a sphere that the eye of a perspective camera is inside of, or on; `depth` is `−C`.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `A = |q|²` carries 3 roundings of coefficients and 5 of evaluation, and what `q` is off: as `A` is at least
    /// nearly `d²`, that is a relative `α`, at most 2⁻³⁰ or nothing is drawn from here. `b` carries 3 and 3 of `|p|·s`,
    /// and `|p|·e`: a bound `β` when divided by `√d`. `−C` is off by 2⁻⁴⁰ of itself. All terms of `d = b² + A·(−C)` are
    /// positive, so the root is off by `2β + β² + α + 2⁻⁴⁰ + 5ε₅₃` of itself, and so is its sum with `|b|`, which is
    /// no less, by `3β + β² + α + …`. The key is `A` over that sum where `b > 0`, and the sum over `−C` elsewhere: off by
    /// `3β + β² + 2α + …` of itself. With `β` up to 2⁻²⁰ and the rounding to `f32`, that is less than 2⁻¹⁸.
    fn inside<F: Fault>(&self, map: &CameraMap, place: &RegionExtent, depth: f64) -> Option<Forms> {
        let Equation { p, q, q_error, .. } = *self;
        let size = q.size(place.most);
        let a_error = ROOM * (8.0 * EPS53 * size.length_squared() + 2.0 * size.dot(q_error));
        let least = 0.99 * map.distance * map.distance;
        let b_error = ROOM * p.abs().dot(6.0 * EPS53 * size + q_error);
        // Written so that NaN fails.
        let is_certain = a_error <= (-30f64).exp2() * least;
        if !(is_certain && size.length_squared() <= LARGEST_KEY && depth <= LARGEST_KEY) {
            return None;
        }
        let least_root = error_bound::<F>(b_error * 20f64.exp2() + f64::MIN_POSITIVE);
        let seen = SeenRoot::Inside { depth, least_root };
        Some(self.forms(place, seen, q.square(), q.dot(p), f32::INFINITY))
    }

    fn forms(
        &self,
        place: &RegionExtent,
        seen: SeenRoot,
        square: QuadraticForm,
        linear: LinearForm,
        nearest: f32,
    ) -> Forms {
        let RegionExtent { origin, spacing, .. } = *place;
        Forms { seen, origin, spacing, square, linear, nearest }
    }
}

/// A bound of all keys, rounded up: `depth` bounds `1/t` or `−t`, but for roundings of less than 2⁻³⁸ of itself. It is
/// not negative: where nothing is seen, nothing is nearer.
fn upper(depth: f64, offset: f64) -> f32 {
    let key = depth + offset + (-38f64).exp2() * (depth.abs() + offset.abs());
    #[expect(clippy::cast_possible_truncation, reason = "rounded up thereafter")]
    let rounded = key as f32;
    rounded.next_up().max(0.0)
}
