//! The weights of a triangle's corners, and the side of it that is seen.

use super::quotient::Affine;
use bothways_common::look::lanes::{Lanes, Real, each};
use bothways_common::{Projection, View};
use glam::DVec3;

/// 1 if a normal of a flat form through a point is towards the viewer, −1 if it is away.
#[inline(always)]
pub(super) fn side_seen(view: &View, point: DVec3, normal: DVec3) -> f64 {
    side_of(view, Lanes::from(point), Lanes::from(normal))
}

/// The same for one flat form or for eight.
#[inline(always)]
pub(super) fn side_of<T: Real>(view: &View, point: Lanes<T>, normal: Lanes<T>) -> T {
    match view.camera.projection() {
        // Every ray that meets the form goes to the same side of it.
        Projection::Perspective => normal.dot(point).against(),
        Projection::Parallel => normal.along(-view.camera.w()).against(),
    }
}

/// The perspective-correct weights of a triangle's corners: see [`weights`].
#[inline(always)]
pub(super) fn weights_of(view: &View, [a, b, c]: [DVec3; 3]) -> [Affine; 3] {
    let side = side_seen(view, a, (b - a).cross(c - a));
    weights(view, each!(corner in [a, b, c] => Lanes::from(corner)), side)
}

/// The perspective-correct weights of the corners of a triangle, or of eight, up to a common factor: each is the edge
/// function of the side opposite to its corner, positive inside of the triangle.
///
/// The function from `p` to `q` is computed from the difference `q − p`: seen from afar, `p × q` would be all rounding.
#[inline(always)]
pub(super) fn weights<T: Real>(view: &View, [a, b, c]: [Lanes<T>; 3], side: T) -> [Affine<T>; 3] {
    each!(edge in [[b, c], [c, a], [a, b]] => {
        let [p, q] = edge;
        edge_function(view, p, q) * -side
    })
}

/// The edge function from `p` to `q`, positive inside of a triangle that is seen from its back.
#[inline(always)]
fn edge_function<T: Real>(view: &View, p: Lanes<T>, q: Lanes<T>) -> Affine<T> {
    let (u, v, w) = (view.camera.u(), view.camera.v(), view.camera.w());
    let normal = p.cross(q - p);
    match view.camera.projection() {
        // Its product with the direction of the viewing ray.
        Projection::Perspective => Affine {
            at_center: normal.along(w) * -view.camera.distance(),
            across: normal.along(u),
            up: normal.along(v),
        },
        Projection::Parallel => {
            let slope = (p - q).cross_along(w);
            let [at_center, across, up] = [normal.along(w), slope.along(u), slope.along(v)];
            Affine { at_center: -at_center, across: -across, up: -up }
        }
    }
}
