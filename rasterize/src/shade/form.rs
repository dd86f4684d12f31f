//! The point of a primitive that is seen at a sample, to the digits of an `f64`.
//!
//! A stored `t` has 20 binary digits. From afar they are too few to tell the points of a surface apart.
//!
//! Functions here are `#[inline]`: where triangles are as small as samples, each sample sets up its own, and calls between
//! codegen units take a fifth of the time of shading.

use super::quotient::Affine;
use bothways_common::{Primitive, Projection, Ray, View};
use glam::DVec3;

/// The point that is seen at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct HitPoint {
    /// Relative to the eye.
    pub(super) position: DVec3,
    /// Relative to the centre of a sphere; for other primitives, relative to the eye.
    pub(super) from_center: DVec3,
}

/// A primitive as functions on the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// Seen at `t = −above/along`.
    Flat { above: Affine, along: Affine },
    /// The ray crosses the plane through the centre that faces the camera at `depth`, at `across·u + up·v` from the
    /// centre.
    Sphere { center: DVec3, radius: f64, depth: f64, across: Affine, up: Affine, axes: [DVec3; 2] },
}

/// How far a stored `t` may be from the true one, as a fraction of it.
const STORED: f64 = 2e-5;

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
                Form::Sphere { center, radius, depth, across, up, axes: [u, v] }
            }
        }
    }

    #[inline]
    fn flat(view: &View, point: DVec3, normal: DVec3) -> Form {
        Form::Flat {
            above: Affine::from_origin(view, normal, point),
            along: Affine::along_ray(view, normal),
        }
    }

    /// The point that is seen at a place of the viewport, for which the `t` of `stored` is stored. The stored one is
    /// taken where rounding leaves less: where a surface is seen almost edge-on, and where numbers are extreme.
    #[inline]
    pub(super) fn hit_point(&self, [x, y]: [f64; 2], ray: &Ray, stored: f64) -> HitPoint {
        let is_close = |t: f64| (t - stored).abs() <= STORED * stored;
        let at = |t: f64| ray.origin + t * ray.direction;
        match self {
            Form::Flat { above, along } => {
                let t = -above.at(x, y) / along.at(x, y);
                let position = at(if is_close(t) { t } else { stored });
                HitPoint { position, from_center: position }
            }
            Form::Sphere { center, radius, depth, across, up, axes: [u, v] } => {
                let beside = across.at(x, y) * *u + up.at(x, y) * *v;
                let on = farther(
                    beside,
                    *radius,
                    ray,
                    [center.distance_squared(ray.origin), stored - depth],
                );
                let t = depth + on;
                if is_close(t) {
                    let from_center = beside + on * ray.direction;
                    return HitPoint { position: at(t), from_center };
                }
                HitPoint { position: at(stored), from_center: at(stored) - *center }
            }
        }
    }
}

/// How much farther along a ray than the point `beside` the centre the ray meets a sphere. The first root counts if the
/// ray begins outside, the second if it begins inside; `begins` is the squared distance of the ray's origin from the
/// centre. Where that is not clear, the root closer to `about` counts.
fn farther(beside: DVec3, radius: f64, ray: &Ray, [begins, about]: [f64; 2]) -> f64 {
    let (a, b) = (ray.direction.length_squared(), beside.dot(ray.direction));
    let square = radius * radius;
    let root = (b * b - a * (beside.length_squared() - square)).max(0.0).sqrt();
    let is_clear = (begins - square).abs() > 1e-12 * (begins + square);
    let first = if is_clear { begins > square } else { about * a + b < 0.0 };
    let root = if first { -root } else { root };
    (root - b) / a
}
