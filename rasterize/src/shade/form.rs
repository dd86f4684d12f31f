//! The point of a primitive that is seen at a sample, to the digits of an `f64`.
//!
//! A stored `t` has 20 binary digits. From afar they are too few to tell the points of a surface apart. Spheres need their points; flat forms
//! do only for points of light, and where [functions](super::ways) do not give the ways to these.
//!
//! Functions here are `#[inline]`: where triangles are as small as samples, each sample sets up its own, and calls between
//! codegen units take a fifth of the time of shading.

use super::quotient::{Affine, Plane};
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdFloat, f64x8};
use bothways_common::look::bands::{Rays, Samples};
use bothways_common::look::lanes::{DVec3x8, each};
use bothways_common::{Primitive, Projection, View};
use glam::DVec3;

/// The points that are seen at eight samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct HitPoints<S: Simd> {
    /// Relative to the eye.
    pub(super) position: DVec3x8<S>,
    /// Relative to the centre of a sphere; for other primitives, relative to the eye.
    pub(super) from_center: DVec3x8<S>,
}

impl<S: Simd> HitPoints<S> {
    /// Points that are not needed.
    #[inline(always)]
    pub(super) fn nowhere(simd: S) -> Self {
        let zero = DVec3x8::splat(simd, DVec3::ZERO);
        HitPoints { position: zero, from_center: zero }
    }
}

/// A primitive as functions on the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Seen at `t = −above/along`.
    Flat(Plane),
    Sphere(Ball),
}

/// The ray crosses the plane through the centre that faces the camera at `depth`, at `across·u + up·v` from the
/// centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    center: DVec3,
    radius: f64,
    depth: f64,
    across: Affine,
    up: Affine,
    axes: [DVec3; 2],
}

impl Form {
    #[inline]
    pub(super) fn new(view: &View, primitive: &Primitive) -> Form {
        match *primitive {
            Primitive::Triangle([a, b, c]) => Form::flat(view, a, (b - a).cross(c - a)),
            Primitive::Plane { point, normal } => Form::flat(view, point, normal),
            Primitive::Sphere { center, radius } => {
                let (u, v) = (view.camera.u(), view.camera.v());
                let ahead = -center.dot(view.camera.w());
                // A perspective ray is there at t = depth, and t times as far from the axis as on the viewport.
                let (depth, scale) = match view.camera.projection() {
                    Projection::Perspective => {
                        let depth = ahead / view.camera.distance();
                        (depth, depth)
                    }
                    Projection::Parallel => (ahead, 1.0),
                };
                let across = Affine { at_center: -center.dot(u), across: scale, up: 0.0 };
                let up = Affine { at_center: -center.dot(v), across: 0.0, up: scale };
                Form::Sphere(Ball { center, radius, depth, across, up, axes: [u, v] })
            }
        }
    }

    #[inline]
    fn flat(view: &View, point: DVec3, normal: DVec3) -> Form {
        Form::Flat(Plane::new(view, point, normal))
    }

    /// The points that are seen at some samples. The stored `t` is taken where rounding leaves less: where a surface is
    /// seen almost edge-on, and where numbers are extreme.
    #[inline(always)]
    pub(super) fn hit_points<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        rays: &Rays<S>,
    ) -> HitPoints<S> {
        match self {
            Form::Flat(Plane { above, along }) => {
                let t = -above.lanes(simd, samples) / along.lanes(simd, samples);
                let t = samples.is_close(simd, t).select(t, samples.t);
                let position = rays.at(t);
                HitPoints { position, from_center: position }
            }
            Form::Sphere(ball) => {
                let Ball { center, radius, depth, across, up, axes } = ball;
                let [u, v] = each!(k in [0, 1] => DVec3x8::splat(simd, axes[k]));
                let (center, depth) = (DVec3x8::splat(simd, *center), f64x8::splat(simd, *depth));
                let beside = u * across.lanes(simd, samples) + v * up.lanes(simd, samples);
                let from = rays.origin - center;
                let on = farther(simd, beside, *radius, rays, [from.dot(from), samples.t - depth]);
                let t = depth + on;
                let is_close = samples.is_close(simd, t);
                let position = rays.at(is_close.select(t, samples.t));
                let from_center = beside + rays.direction * on;
                HitPoints { position, from_center: from_center.or(is_close, position - center) }
            }
        }
    }
}

/// How much farther along a ray than the point `beside` the centre the ray meets a sphere. The first root counts if the
/// ray begins outside, the second if it begins inside; `begins` is the squared distance of the ray's origin from the
/// centre. Where that is not clear, the root closer to `about` counts.
#[inline(always)]
fn farther<S: Simd>(
    simd: S,
    beside: DVec3x8<S>,
    radius: f64,
    rays: &Rays<S>,
    [begins, about]: [f64x8<S>; 2],
) -> f64x8<S> {
    let splat = |number: f64| f64x8::splat(simd, number);
    let direction = rays.direction;
    let (a, b) = (direction.dot(direction), beside.dot(direction));
    let (zero, square) = (splat(0.0), splat(radius * radius));
    let discriminant = b * b - a * (beside.dot(beside) - square);
    let root = discriminant.simd_gt(zero).select(discriminant, zero).sqrt();
    let is_clear = (begins - square).abs().simd_gt(splat(1e-12) * (begins + square));
    let outside = is_clear.select(begins - square, zero - (about * a + b));
    let root = outside.simd_gt(zero).select(-root, root);
    (root - b) / a
}
