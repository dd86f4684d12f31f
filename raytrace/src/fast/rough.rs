//! The sides of a tile and `t` in `f32`, and how far off they may be. They say which boxes certainly miss the tile or
//! lie behind its hits.

use bothways_common::simd::{Simd, f32x16};
use glam::DVec3;
use std::ops::{Add, Mul};

/// Half of 2⁻²³.
pub(super) const U: f64 = f32::EPSILON as f64 / 2.0;
/// Of numbers beyond, sums may overflow.
pub(super) const LARGEST: f64 = 1e38;

/// What all tiles have in common. Errors are infinite if numbers might overflow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kind {
    pub(super) eye: [f32; 3],
    pub(super) t: Plane,
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
    /// Coordinates of points relative to the eye.
    pub(super) reach: f64,
    /// Those of normals: that of `t`, and those of columns and rows.
    pub(super) t: DVec3,
    pub(super) place: DVec3,
    /// What is added to columns and rows.
    pub(super) offset: f64,
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
    /// A coordinate relative to the eye carries one rounding, a normal's coordinate one, their product one,
    /// their sum two, the offset one and its sum one: with `A` the reach, at most five of `A·Σ|n|` before the
    /// offset is added, one of that and the offset then, and one of the offset. 6.5 is more than that, than
    /// what of these products is of second order, and than all roundings in `f64`, which are 2⁻²⁶ times as
    /// large (those of a parallel `t`, too, thanks to the offset that it does not have). What underflows is
    /// less than the smallest normal number, times the reach where it is a normal's coordinate.
    pub(super) fn new(eye: DVec3, row_of_t: DVec3, sizes: &Sizes) -> Kind {
        let Sizes { reach, t, place, offset, wide, beside } = *sizes;
        let error = |normal: DVec3, offset: f64| {
            let size = reach * normal.element_sum() + offset;
            let floor = f64::from(f32::MIN_POSITIVE) * (1.0 + reach);
            let largest = size.max(reach).max(normal.max_element());
            if largest < LARGEST { upward(6.5 * U * size + floor) } else { f32::INFINITY }
        };
        Kind {
            eye: eye.as_vec3().to_array(),
            t: Plane::new(row_of_t, 0.0),
            t_error: error(t, offset),
            sides_error: error(beside * t + place, wide + offset),
        }
    }

    /// The computed `t` beyond which everything is farther than this exact one.
    #[inline(always)]
    pub(super) fn farthest(&self, t: f64) -> f32 {
        (upward(t) + self.t_error).next_up()
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

    /// Its largest values in boxes, of which low and high sides are given relative to the eye; or its
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
