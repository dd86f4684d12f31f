//! Vectors of space in SIMD lanes: of eight samples in `f64`, of sixteen in `f32`.

use crate::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, SimdNarrow, f32x16, f64x8, mask64x8,
};
use glam::{DVec3, Vec3};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The values of an expression for each of some others, as an array: `each!(k in [0, 1] => a[k] * b[k])`. With vectors,
/// an array's own `map` is slow: its function is compiled without the instructions of the level.
#[macro_export]
#[doc(hidden)]
macro_rules! each {
    ($name:ident in [$($value:expr),+ $(,)?] => $of:expr) => {
        [$({
            let $name = $value;
            $of
        }),+]
    };
}

pub use crate::each;

/// Three coordinates, each for several samples.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<T> {
    /// The first coordinate.
    pub x: T,
    /// The second coordinate.
    pub y: T,
    /// The third coordinate.
    pub z: T,
}

/// A number in `f64`, or one for each of eight triangles or samples. What is written for it has the same bits for one and for
/// eight.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Its magnitude.
    fn magnitude(self) -> Self;

    /// −1 where it is positive, 1 elsewhere.
    fn against(self) -> Self;

    /// 1 over it.
    fn reciprocal(self) -> Self;

    /// The nearest whole number; of two, the even one.
    fn rounded(self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn magnitude(self) -> f64 {
        self.abs()
    }

    #[inline(always)]
    fn against(self) -> f64 {
        if self > 0.0 { -1.0 } else { 1.0 }
    }

    #[inline(always)]
    fn reciprocal(self) -> f64 {
        1.0 / self
    }

    #[inline(always)]
    fn rounded(self) -> f64 {
        self.round_ties_even()
    }
}

impl<S: Simd> Real for f64x8<S> {
    #[inline(always)]
    fn magnitude(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn against(self) -> Self {
        let [zero, one, minus_one] =
            each!(number in [0.0, 1.0, -1.0] => f64x8::splat(self.simd, number));
        self.simd_gt(zero).select(minus_one, one)
    }

    #[inline(always)]
    fn reciprocal(self) -> Self {
        f64x8::splat(self.simd, 1.0) / self
    }

    #[inline(always)]
    fn rounded(self) -> Self {
        self.round_ties_even()
    }
}

/// A vector of space for each of eight samples.
pub type DVec3x8<S> = Lanes<f64x8<S>>;
/// A vector of space for each of sixteen samples.
pub type Vec3x16<S> = Lanes<f32x16<S>>;

impl<T: Add<Output = T>> Add for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Lanes { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<T: Sub<Output = T>> Sub for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Lanes { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

/// Each vector times its own factor.
impl<T: Copy + Mul<Output = T>> Mul<T> for Lanes<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Lanes { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Lanes<T> {
    /// The scalar product, from left to right.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// The cross product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Lanes {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}

impl From<DVec3> for Lanes<f64> {
    #[inline(always)]
    fn from(DVec3 { x, y, z }: DVec3) -> Self {
        Lanes { x, y, z }
    }
}

impl From<Lanes<f64>> for DVec3 {
    #[inline(always)]
    fn from(Lanes { x, y, z }: Lanes<f64>) -> Self {
        DVec3 { x, y, z }
    }
}

impl<T: Real> Lanes<T> {
    /// The scalar product with a vector that is the same for all.
    #[inline(always)]
    pub fn along(self, DVec3 { x, y, z }: DVec3) -> T {
        self.x * x + self.y * y + self.z * z
    }

    /// The way from each to a point that is the same for all.
    #[inline(always)]
    pub fn way_to(self, DVec3 { x, y, z }: DVec3) -> Self {
        Lanes { x: -self.x + x, y: -self.y + y, z: -self.z + z }
    }

    /// The magnitudes of the coordinates, added up.
    #[inline(always)]
    pub fn size(self) -> T {
        self.x.magnitude() + self.y.magnitude() + self.z.magnitude()
    }

    /// The cross product with a vector that is the same for all.
    #[inline(always)]
    pub fn cross_along(self, DVec3 { x, y, z }: DVec3) -> Self {
        Lanes { x: self.y * z - self.z * y, y: self.z * x - self.x * z, z: self.x * y - self.y * x }
    }
}

impl<S: Simd> DVec3x8<S> {
    /// The same vector for all samples.
    #[inline(always)]
    pub fn splat(simd: S, vector: DVec3) -> Self {
        let DVec3 { x, y, z } = vector;
        let [x, y, z] = each!(coordinate in [x, y, z] => f64x8::splat(simd, coordinate));
        Lanes { x, y, z }
    }

    /// A vector for each sample.
    #[inline(always)]
    pub fn from_fn(simd: S, of: impl Fn(usize) -> DVec3) -> Self {
        let vectors: [DVec3; 8] = std::array::from_fn(of);
        Lanes {
            x: f64x8::from_fn(simd, |lane| vectors[lane].x),
            y: f64x8::from_fn(simd, |lane| vectors[lane].y),
            z: f64x8::from_fn(simd, |lane| vectors[lane].z),
        }
    }

    /// The vector of one sample.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> DVec3 {
        DVec3::new(self.x[lane], self.y[lane], self.z[lane])
    }

    /// These where the mask is set, the others elsewhere.
    #[inline(always)]
    pub fn or(self, mask: mask64x8<S>, other: Self) -> Self {
        Lanes {
            x: mask.select(self.x, other.x),
            y: mask.select(self.y, other.y),
            z: mask.select(self.z, other.z),
        }
    }

    /// Against the directions where the mask is set.
    #[inline(always)]
    pub fn negated_where(self, mask: mask64x8<S>) -> Self {
        Lanes { x: -self.x, y: -self.y, z: -self.z }.or(mask, self)
    }

    /// The largest of the coordinates' magnitudes.
    #[inline(always)]
    pub fn max_magnitude(self) -> f64x8<S> {
        self.x.abs().max(self.y.abs()).max(self.z.abs())
    }

    /// Sixteen vectors of two times eight, each coordinate rounded to `f32`.
    #[inline(always)]
    pub fn narrow(self, high: Self) -> Vec3x16<S> {
        Lanes { x: self.x.narrow(high.x), y: self.y.narrow(high.y), z: self.z.narrow(high.z) }
    }
}

impl<S: Simd> Vec3x16<S> {
    /// The same vector for all samples.
    #[inline(always)]
    pub fn splat(simd: S, vector: Vec3) -> Self {
        let Vec3 { x, y, z } = vector;
        let [x, y, z] = each!(coordinate in [x, y, z] => f32x16::splat(simd, coordinate));
        Lanes { x, y, z }
    }

    /// Against the directions.
    #[inline(always)]
    pub fn negated(self) -> Self {
        Lanes { x: -self.x, y: -self.y, z: -self.z }
    }

    /// The vectors with length 1, also where the squares of their lengths are beyond all numbers, or too small to be told; zero where
    /// a length is 0, infinite or not a number.
    #[inline(always)]
    pub fn directions(self, simd: S) -> Self {
        /// 2¹²⁰ and 2⁻¹²⁰: a square between them has all its digits.
        const LARGE: f32 = f32::from_bits((127 + 120) << 23);
        const SMALL: f32 = 1.0 / LARGE;
        let [one, large, small] =
            each!(number in [1.0, LARGE, SMALL] => f32x16::splat(simd, number));
        let square = self.dot(self);
        let is_usual = square.simd_gt(small) & square.simd_lt(large);
        if is_usual.all_true() {
            return self * (one / square.sqrt());
        }
        // Powers of two change no digit.
        let size = self.x.abs().max(self.y.abs()).max(self.z.abs());
        let scale = is_usual.select(one, size.simd_gt(one).select(small, large));
        (self * scale).normalized(simd)
    }

    /// The vectors with length 1; zero where the square of a length is 0, infinite or not a number.
    #[inline(always)]
    pub fn normalized(self, simd: S) -> Self {
        let square = self.dot(self);
        let zero = f32x16::splat(simd, 0.0);
        let is_length = square.simd_gt(zero) & square.simd_lt(f32x16::splat(simd, f32::INFINITY));
        let factor = f32x16::splat(simd, 1.0) / square.sqrt();
        Lanes {
            x: is_length.select(self.x * factor, zero),
            y: is_length.select(self.y * factor, zero),
            z: is_length.select(self.z * factor, zero),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::simd::{dispatch, levels};

    #[test]
    fn vectors_of_any_length_have_directions() {
        let shape = Vec3::new(2.0, -3.0, 6.0);
        let lengths = [1e-44, 1e-40, 1e-30, 1e-19, 1e-18, 1e-17, 1.0, 1e17, 1e18, 1e19, 1e25, 5e37];
        let none = [Vec3::ZERO, Vec3::X * f32::INFINITY, Vec3::NAN];
        let vectors = lengths.map(|length| shape * length).into_iter().chain(none);
        let vectors: Vec<Vec3> = vectors.chain([shape]).collect();
        let directions = |level, of: &dyn Fn(usize) -> Vec3| -> [Vec3; 16] {
            dispatch!(level, simd => {
                let axis = |k: usize| f32x16::from_fn(simd, |lane| of(lane)[k]);
                let Lanes { x, y, z } =
                    Lanes { x: axis(0), y: axis(1), z: axis(2) }.directions(simd);
                std::array::from_fn(|lane| Vec3::new(x[lane], y[lane], z[lane]))
            })
        };
        for level in levels() {
            let together = directions(level, &|lane| vectors[lane]);
            for (vector, direction) in vectors.iter().zip(together) {
                // The least numbers have few digits, which are those of the vector itself.
                let expected = vector.as_dvec3().normalize_or_zero();
                let off = direction.as_dvec3().distance(expected);
                assert!(off < 1e-6, "{level:?} {vector}: {direction}, not {expected}");
                // Neighbours change no bit.
                assert_eq!(directions(level, &|_| *vector), [direction; 16]);
            }
        }
    }
}
