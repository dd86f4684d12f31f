//! Affine functions of the world in `f32`, and the roundings from `f64` to it.

use bothways_common::engine::simd::{Simd, f32x16};
use glam::DVec3;
use std::ops::{Add, Mul};

/// Sums of numbers beyond this may overflow.
pub(super) const LARGEST: f64 = 1e38;

/// An affine function of the world: `normal·p + offset`, with `p` counted from some origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct WorldAffine {
    pub(super) normal: [f32; 3],
    pub(super) offset: f32,
}

impl WorldAffine {
    #[inline(always)]
    pub(super) fn new(normal: DVec3, offset: f64) -> WorldAffine {
        WorldAffine { normal: normal.as_vec3().to_array(), offset: narrowed(offset) }
    }

    /// Its value at points, counted from the origin.
    #[inline(always)]
    pub(super) fn at<V>(&self, [x, y, z]: [V; 3]) -> V
    where
        V: Add<Output = V> + Add<f32, Output = V> + Mul<f32, Output = V>,
    {
        let [nx, ny, nz] = self.normal;
        x * nx + y * ny + z * nz + self.offset
    }

    /// Its largest values in boxes, or its least ones; a box is given by its low and its high side along each axis,
    /// counted from the origin.
    #[inline(always)]
    pub(super) fn extreme<S: Simd>(
        &self,
        [x, y, z]: &[[f32x16<S>; 2]; 3],
        largest: bool,
    ) -> f32x16<S> {
        let [nx, ny, nz] = self.normal;
        // Where a coordinate does not grow along the normal, the other side is the extreme.
        let side = |n: f32| usize::from(n.is_sign_positive() == largest);
        self.at([x[side(nx)], y[side(ny)], z[side(nz)]])
    }
}

/// In `f32`, not less.
#[inline(always)]
pub(super) fn upward(value: f64) -> f32 {
    narrowed(value).next_up()
}

/// In `f32`, rounded once.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
pub(super) fn narrowed(value: f64) -> f32 {
    value as f32
}
