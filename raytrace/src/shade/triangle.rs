//! A triangle as rays hit it: its plane, and the weights of its corners.

use bothways_common::look::lanes::{Lanes, Real, each};
use bothways_common::{Projection, View};

/// A triangle, or one for each of eight: in `T` a number or eight.
#[derive(Clone, Copy)]
pub(super) struct Triangle<T = f64> {
    /// The first corner.
    pub(super) a: Lanes<T>,
    /// The cross product of two sides.
    pub(super) normal: Lanes<T>,
    /// The directions in which the weights of the second and the third corner grow, and how fast.
    pub(super) growth: [Lanes<T>; 2],
}

impl<T: Real> Triangle<T> {
    #[inline(always)]
    pub(super) fn new([a, b, c]: [Lanes<T>; 3]) -> Self {
        let normal = (b - a).cross(c - a);
        let square = normal.dot(normal);
        let dual = Lanes { x: normal.x / square, y: normal.y / square, z: normal.z / square };
        Triangle { a, normal, growth: [dual.cross(a - c), dual.cross(b - a)] }
    }
}

/// 1 if a normal of a flat form through a point is towards the viewer, −1 if it is away; of one form or of eight. The surface
/// decides which side is seen, not its smooth normals; every ray that hits it comes to the same side.
#[inline(always)]
pub(super) fn side_seen<T: Real>(view: &View, point: Lanes<T>, normal: Lanes<T>) -> T {
    match view.camera.projection() {
        Projection::Perspective => normal.dot(point).against(),
        Projection::Parallel => normal.along(-view.camera.w()).against(),
    }
}

/// The normal of the first corner of a triangle, or of eight, and what those of the others add to it, towards the viewer.
#[inline(always)]
pub(super) fn steps_from_first<T: Real>([a, b, c]: [Lanes<T>; 3], side: T) -> [Lanes<T>; 3] {
    each!(step in [a, b - a, c - a] => step * side)
}
