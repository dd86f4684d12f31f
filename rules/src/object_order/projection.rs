//! From the world to the camera's axes, and on to the raster.

use crate::real::{Real, Vector, dot, minus, position, vector};
use crate::samples::{Samples, whole};
use bothways_common::Projection;
use glam::Vec3;

/// A vertex in the camera's axes: to the right, up, and the depth along the axis of view.
pub(super) type Vertex = [f64; 3];

/// The map of a camera, in the arithmetic of a rule.
#[derive(Clone, Copy, Debug)]
pub(super) struct CameraMap<R> {
    pub(super) eye: Vector<R>,
    /// Right, up and away.
    pub(super) axes: [Vector<R>; 3],
    pub(super) projection: Projection,
    /// The factors from `x/depth` and `y/depth` (of a parallel camera, from `x` and `y`) to −1…1 over the picture.
    pub(super) to_device: [R; 2],
    /// Half of the raster's size, along its `x` and its `y`.
    pub(super) half: [R; 2],
    /// The lecture's `d`.
    pub(super) distance: R,
}

impl<R: Real> CameraMap<R> {
    pub(super) fn new(samples: &Samples) -> CameraMap<R> {
        let camera = samples.camera();
        let reach = match camera.projection() {
            Projection::Perspective => 2.0 * camera.distance(),
            Projection::Parallel => 2.0,
        };
        let [rows, columns] = samples.size();
        CameraMap {
            eye: position(camera.eye()),
            axes: [camera.u(), camera.v(), -camera.w()].map(vector),
            projection: camera.projection(),
            to_device: camera.viewport().map(|side| R::of(reach / side)),
            half: [columns, rows].map(|count| R::of(0.5 * f64::from(count))),
            distance: R::of(camera.distance()),
        }
    }

    /// A position of the world in the camera's axes.
    pub(super) fn vertex(&self, world: Vec3) -> Vertex {
        let offset = minus(position(world), self.eye);
        self.axes.map(|axis| dot(axis, offset).double())
    }

    /// The `x` and `y` of a vertex on the raster, rightwards and downwards: pixel corners are whole numbers, the upper left
    /// corner of the picture is 0.
    pub(super) fn raster(&self, [x, y, depth]: Vertex) -> [R; 2] {
        let [x, y] = [x, -y].map(R::of);
        let [x, y] = [self.to_device[0] * x, self.to_device[1] * y];
        let [x, y] = match self.projection {
            Projection::Perspective => [x / R::of(depth), y / R::of(depth)],
            Projection::Parallel => [x, y],
        };
        [x * self.half[0] + self.half[0], y * self.half[1] + self.half[1]]
    }

    /// What is linear over the raster where the depth is not: its inverse for a perspective camera. The smaller this is,
    /// the farther for a perspective camera, the nearer for a parallel one.
    pub(super) fn linear_depth(&self, depth: f64) -> R {
        match self.projection {
            Projection::Perspective => R::of(1.0) / R::of(depth),
            Projection::Parallel => R::of(depth),
        }
    }

    /// `t` of a linear depth.
    pub(super) fn t(&self, linear: R) -> R {
        match self.projection {
            Projection::Perspective => R::of(1.0) / (linear * self.distance),
            Projection::Parallel => linear,
        }
    }
}

/// The samples whose rows or columns lie in an interval of the raster, and a few more, within the picture.
pub(super) fn covering(
    from: f64,
    to: f64,
    picture: &std::ops::Range<usize>,
) -> std::ops::Range<usize> {
    let (first, last) = (whole(picture.start), whole(picture.end));
    // A sample lies within its cell, so the cells that the interval touches are enough.
    let clamped = |at: f64| at.clamp(first, last);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
    let [start, end] = [clamped(from.floor() - 1.0) as usize, clamped(to.ceil() + 1.0) as usize];
    start..end.max(start)
}
