//! Culls boxes in `f32`: those that certainly miss a tile, and those that certainly lie behind its hits. Says how far
//! off that arithmetic may be.

use super::tree::{Node, WIDTH};
use crate::fast::world_affine::{LARGEST, WorldAffine, narrowed, upward};
use bothways_common::engine::context::Context;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::EPS24;
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x16, mask32x16};
use glam::{DVec3, Vec3};

/// What all tiles share to cull boxes. Errors are infinite if numbers might overflow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxCulling {
    /// The point of the world from which coordinates count: the eye, or a point near all boxes if the eye is far
    /// from them.
    pub(super) origin: [f32; 3],
    /// The same relative to the eye, and its `t`.
    pub(crate) from_eye: DVec3,
    pub(super) t_at_origin: f64,
    /// What is added to a computed `t`, so that it is not more than the exact one, but for the rounding of the sum.
    pub(crate) t_before: f32,
    /// `t` less that of the origin.
    pub(super) t: WorldAffine,
    /// The computed `t` of a point in front of the eye is not smaller.
    pub(crate) least_t: f32,
    /// How far computed values may be off: those of `t`, and those for sides.
    pub(crate) t_error: f32,
    pub(crate) sides_error: f32,
    /// The part of both errors that comes from `f64`.
    pub(super) t_exact: f64,
    pub(super) sides_exact: f64,
}

/// The low and the high sides of a node's boxes along each axis.
pub(super) type Sides<S> = [[f32x16<S>; 2]; 3];

/// The bounds of a map's values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxSizes {
    /// Coordinates of points relative to the eye, and to the origin.
    pub(crate) reach: f64,
    pub(crate) near: f64,
    /// Those of normals: that of `t`, and those of columns and rows.
    pub(crate) t: DVec3,
    pub(crate) place: DVec3,
    /// What is added to columns and rows, and those of the origin, counted from any tile's middle.
    pub(crate) offset: f64,
    pub(crate) place_of_origin: f64,
    /// Columns from the middle of the tile to a side; and `t` times how many lie between them, which is none
    /// of a parallel camera.
    pub(crate) wide: f64,
    pub(crate) beside: f64,
}

/// Which of a node's boxes a ray of the tile may meet, and what is known of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoxHits {
    /// One bit for each box.
    pub(crate) hit: u64,
    /// The nearest `t` of each, as computed.
    pub(crate) near: [f32; WIDTH],
    /// How far vertices in each are from each other at most, along any axis.
    pub(crate) size: [f32; WIDTH],
}

impl BoxCulling {
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
    /// besides, as [`CameraMap::errors`] says; 2⁻⁴⁴ is more than both.
    ///
    /// [`CameraMap::errors`]: crate::fast::camera_map::CameraMap::errors
    pub(crate) fn new(
        origin: Vec3,
        from_eye: DVec3,
        row_of_t: DVec3,
        sizes: &BoxSizes,
    ) -> BoxCulling {
        let BoxSizes { reach, near, t, place, offset, place_of_origin, wide, beside } = *sizes;
        let t_at_origin = row_of_t.dot(from_eye);
        let exact =
            |normal: DVec3, offset: f64| (-44f64).exp2() * (reach * normal.element_sum() + offset);
        let error = |normal: DVec3, offset: f64, at_origin: f64| {
            let size = near * normal.element_sum() + offset + at_origin;
            let in_f64 = exact(normal, offset);
            let floor = f64::from(f32::MIN_POSITIVE) * (1.0 + reach);
            let largest = size.max(reach).max(normal.max_element());
            if largest < LARGEST {
                upward(6.5 * f64::from(EPS24) * size + in_f64 + floor)
            } else {
                f32::INFINITY
            }
        };
        let side_at_origin = beside * t_at_origin.abs() + place_of_origin;
        let t_error = error(t, offset, 0.0);
        BoxCulling {
            origin: origin.to_array(),
            from_eye,
            t_at_origin,
            t_before: narrowed(t_at_origin - f64::from(t_error)).next_down(),
            t: WorldAffine::new(row_of_t, 0.0),
            least_t: narrowed(-t_at_origin - f64::from(t_error)).next_down(),
            t_error,
            sides_error: error(beside * t + place, wide + offset, side_at_origin),
            t_exact: exact(t, offset),
            sides_exact: exact(beside * t + place, wide + offset),
        }
    }

    /// The computed `t` beyond which everything is farther than this exact one.
    #[inline(always)]
    pub(crate) fn farthest(&self, t: f64) -> f32 {
        (upward(t - self.t_at_origin) + self.t_error).next_up()
    }

    /// The exact `t` that nothing with this computed one is nearer than, but for one rounding.
    #[inline(always)]
    pub(crate) fn nearest(&self, t: f32) -> f32 {
        t + self.t_before
    }

    /// Finds the boxes of a node that a ray of a tile with these sides may meet before `farthest`.
    ///
    /// The function of a side is largest, in a box, at one of its corners. The error of points on rays counts, which
    /// [`MapErrors::wide`](crate::fast::camera_map::MapErrors::wide) allows for, and that of what is computed here.
    #[inline(always)]
    pub(crate) fn test<C: Context>(
        &self,
        context: &C,
        sides: &[WorldAffine; 4],
        node: &Node,
        farthest: f32,
    ) -> BoxHits {
        let simd = context.simd();
        let boxes = self.boxes_of(simd, node);
        let [left, right, upper, lower] = sides;
        let across = left.extreme(&boxes, true).min(right.extreme(&boxes, true));
        let down = upper.extreme(&boxes, true).min(lower.extreme(&boxes, true));
        let (near, far) = (self.t.extreme(&boxes, false), self.t.extreme(&boxes, true));
        let room = if C::has(Planted::ShrunkBox) { 0.0 } else { self.sides_error };
        // NaN, from numbers that overflow, lets pass.
        let missed = across.min(down).simd_lt(f32x16::splat(simd, -room))
            | far.simd_lt(f32x16::splat(simd, self.least_t))
            | near.simd_gt(f32x16::splat(simd, farthest));
        BoxHits::new(node, missed, near, longest_side(simd, node))
    }

    /// The boxes of a node, one bit for each, that [`BoxCulling::test`] does not certainly drop for each ray of a tile that is
    /// tested alone, as a tile of one. `of_ray` is what these tiles of one share, `sides` are those of the whole tile.
    ///
    /// With `f` the exact function of one of the tile's sides, and `g` that of the same side of one of its rays, `f − g`
    /// is `t` (of a parallel camera: 1) times the columns or rows between the two sides. These are at least 0, because
    /// [`MapErrors::wide`] is half of a tile and the same rest for tiles of any size, but for the rounding of `wide`,
    /// which is far less than 2⁻⁴⁴ and so makes less than the error of a side. Where the box is in front of the eye,
    /// its `t` is at least 0, too. So if `e` and `r` are the errors of sides of the tile and of a ray, and the largest
    /// value of `f` in the box is computed to be below `−e − 3r`, the exact one is below `−3r`, that of `g` below `−2r`,
    /// and is computed to be below `−r`, where the test drops the box. What it computes of `t` does not depend on the
    /// ray.
    ///
    /// [`MapErrors::wide`]: crate::fast::camera_map::MapErrors::wide
    #[inline(always)]
    pub(crate) fn not_missed_by_all<C: Context>(
        &self,
        context: &C,
        (sides, parallel): (&[WorldAffine; 4], bool),
        of_ray: &BoxCulling,
        node: &Node,
    ) -> u64 {
        let simd = context.simd();
        let splat = |value: f32| f32x16::splat(simd, value);
        let boxes = self.boxes_of(simd, node);
        let [left, right, upper, lower] = sides;
        let across = left.extreme(&boxes, true).min(right.extreme(&boxes, true));
        let down = upper.extreme(&boxes, true).min(lower.extreme(&boxes, true));
        let room = (self.sides_error + (3.0 * of_ray.sides_error).next_up()).next_up();
        let beside = across.min(down).simd_lt(splat(-room));
        let in_front = if parallel {
            f32::NEG_INFINITY
        } else {
            upward(f64::from(self.t_error) - self.t_at_origin).next_up()
        };
        let (near, far) = (self.t.extreme(&boxes, false), self.t.extreme(&boxes, true));
        let beside = beside & near.simd_ge(splat(in_front));
        let missed = beside | far.simd_lt(splat(of_ray.least_t));
        (!missed).to_bitmask() & ((1 << node.used) - 1)
    }

    /// A node's boxes as [`BoxCulling::test`] finds them, whatever the ray: their sides, counted from the origin, the nearest `t`
    /// of each, and how far vertices in each are from each other at most.
    #[inline(always)]
    pub(super) fn boxes_alone<S: Simd>(
        &self,
        simd: S,
        node: &Node,
    ) -> ([[[f32; WIDTH]; 2]; 3], [f32; WIDTH], [f32; WIDTH]) {
        let boxes = self.boxes_of(simd, node);
        let near = self.t.extreme(&boxes, false).to_array();
        let [x, y, z] = boxes;
        let sides = [
            [x[0].to_array(), x[1].to_array()],
            [y[0].to_array(), y[1].to_array()],
            [z[0].to_array(), z[1].to_array()],
        ];
        (sides, near, longest_side(simd, node).to_array())
    }

    /// The sides of a node's boxes, counted from the origin.
    #[inline(always)]
    pub(super) fn boxes_of<S: Simd>(&self, simd: S, node: &Node) -> Sides<S> {
        let [ox, oy, oz] = self.origin;
        let [lx, ly, lz, hx, hy, hz] = &node.bounds;
        [
            [f32x16::load_array_ref(simd, lx) - ox, f32x16::load_array_ref(simd, hx) - ox],
            [f32x16::load_array_ref(simd, ly) - oy, f32x16::load_array_ref(simd, hy) - oy],
            [f32x16::load_array_ref(simd, lz) - oz, f32x16::load_array_ref(simd, hz) - oz],
        ]
    }
}

impl BoxHits {
    /// Those of a node's boxes that are not missed.
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        node: &Node,
        missed: mask32x16<S>,
        near: f32x16<S>,
        size: f32x16<S>,
    ) -> BoxHits {
        BoxHits {
            hit: (!missed).to_bitmask() & ((1 << node.used) - 1),
            near: near.to_array(),
            size: size.to_array(),
        }
    }
}

/// The longest side of each box.
#[inline(always)]
pub(super) fn longest_side<S: Simd>(simd: S, node: &Node) -> f32x16<S> {
    let [lx, ly, lz, hx, hy, hz] = &node.bounds;
    let width = f32x16::load_array_ref(simd, hx) - f32x16::load_array_ref(simd, lx);
    let height = f32x16::load_array_ref(simd, hy) - f32x16::load_array_ref(simd, ly);
    let depth = f32x16::load_array_ref(simd, hz) - f32x16::load_array_ref(simd, lz);
    width.max(height).max(depth)
}
