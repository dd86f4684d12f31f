//! The sides of a tile and `t` in `f32`, and how far off they may be. They say which boxes certainly miss the tile or
//! lie behind its hits.

use bothways_common::engine::simd::{Simd, f32x16};
use glam::{DVec3, Vec3};
use std::ops::{Add, Mul};

/// Half of 2⁻²³.
pub(super) const U: f64 = f32::EPSILON as f64 / 2.0;
/// Of numbers beyond, sums may overflow.
pub(super) const LARGEST: f64 = 1e38;

/// What all tiles have in common. Errors are infinite if numbers might overflow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    /// The point of the world from which coordinates count: the eye, or one near all boxes if the eye is far
    /// from them.
    pub(super) origin: [f32; 3],
    /// The same from the eye, and its `t`.
    pub(super) from_eye: DVec3,
    t_at_origin: f64,
    /// `t` less that of the origin.
    pub(super) t: Plane,
    /// What lies in front of the eye has no smaller one, as computed.
    pub(super) least_t: f32,
    /// How far computed values may be off: those of `t`, and those for sides.
    pub(super) t_error: f32,
    pub(super) sides_error: f32,
}

/// An affine function in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) normal: [f32; 3],
    pub(super) offset: f32,
}

/// What bounds the values of a map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Coordinates of points relative to the eye, and to the origin.
    pub(super) reach: f64,
    pub(super) near: f64,
    /// Those of normals: that of `t`, and those of columns and rows.
    pub(super) t: DVec3,
    pub(super) place: DVec3,
    /// What is added to columns and rows, and those of the origin, counted from any tile's middle.
    pub(super) offset: f64,
    pub(super) place_of_origin: f64,
    /// Columns from the middle of the tile to a side; and `t` times how many lie between them, which is none
    /// of a parallel camera.
    pub(super) wide: f64,
    pub(super) beside: f64,
}

impl Kind {
    /// For a map of certain sizes.
    ///
    /// # The errors, rounding by rounding
    ///
    /// A coordinate relative to the origin carries one rounding, a normal's coordinate one, their product one,
    /// their sum two, the offset one and its sum one: with `B` the largest such coordinate, at most five of
    /// `B·Σ|n|` before the offset is added, one of that and the offset then, and one of the offset, which for
    /// the sides holds their values at the origin. 6.5 is more than that and than what of these products is of
    /// second order. What underflows is less than the smallest normal number, times the reach where it is a
    /// normal's coordinate.
    ///
    /// In `f64`, with `A` the reach from the eye: a vertex relative to the eye is rounded once, the origin, too;
    /// its product with a normal, which carries up to 3 roundings, brings 3 and the offset's sum one: less
    /// than 2⁻⁵⁰ of `A·Σ|n|` and of the offset in all. The `t` of a parallel ray is off by less than 2⁻⁴⁵ of them
    /// besides, as [`super::rays`] says; 2⁻⁴⁴ is more than both.
    pub(super) fn new(origin: Vec3, from_eye: DVec3, row_of_t: DVec3, sizes: &Sizes) -> Kind {
        let Sizes { reach, near, t, place, offset, place_of_origin, wide, beside } = *sizes;
        let t_at_origin = row_of_t.dot(from_eye);
        let error = |normal: DVec3, offset: f64, at_origin: f64| {
            let size = near * normal.element_sum() + offset + at_origin;
            let in_f64 = (-44f64).exp2() * (reach * normal.element_sum() + offset);
            let floor = f64::from(f32::MIN_POSITIVE) * (1.0 + reach);
            let largest = size.max(reach).max(normal.max_element());
            if largest < LARGEST { upward(6.5 * U * size + in_f64 + floor) } else { f32::INFINITY }
        };
        let side_at_origin = beside * t_at_origin.abs() + place_of_origin;
        let t_error = error(t, offset, 0.0);
        Kind {
            origin: origin.to_array(),
            from_eye,
            t_at_origin,
            t: Plane::new(row_of_t, 0.0),
            least_t: narrowed(-t_at_origin - f64::from(t_error)).next_down(),
            t_error,
            sides_error: error(beside * t + place, wide + offset, side_at_origin),
        }
    }

    /// The computed `t` beyond which everything is farther than this exact one.
    #[inline(always)]
    pub(super) fn farthest(&self, t: f64) -> f32 {
        (upward(t - self.t_at_origin) + self.t_error).next_up()
    }

    /// The exact `t` that nothing with this computed one is nearer than.
    #[inline(always)]
    pub(super) fn nearest(&self, t: f32) -> f32 {
        narrowed(f64::from(t) + (self.t_at_origin - f64::from(self.t_error))).next_down()
    }
}

impl Plane {
    #[inline(always)]
    pub(super) fn new(normal: DVec3, offset: f64) -> Plane {
        Plane { normal: normal.as_vec3().to_array(), offset: narrowed(offset) }
    }

    /// Its value at points, relative to where its offset is its value.
    #[inline(always)]
    pub(super) fn at<V>(&self, [x, y, z]: [V; 3]) -> V
    where
        V: Add<Output = V> + Add<f32, Output = V> + Mul<f32, Output = V>,
    {
        let [nx, ny, nz] = self.normal;
        x * nx + y * ny + z * nz + self.offset
    }

    /// Its largest values in boxes, of which low and high sides are given relative to the origin; or its
    /// least ones.
    #[inline(always)]
    pub(super) fn reach<S: Simd>(
        &self,
        [x, y, z]: &[[f32x16<S>; 2]; 3],
        largest: bool,
    ) -> f32x16<S> {
        let [nx, ny, nz] = self.normal;
        // Where a coordinate does not grow along the normal, the other side is farther.
        let side = |n: f32| usize::from(n.is_sign_positive() == largest);
        self.at([x[side(nx)], y[side(ny)], z[side(nz)]])
    }
}

/// In `f32`, not less.
#[inline(always)]
pub(super) fn upward(value: f64) -> f32 {
    narrowed(value).next_up()
}

#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
pub(super) fn narrowed(value: f64) -> f32 {
    value as f32
}
