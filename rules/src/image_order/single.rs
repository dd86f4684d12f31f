//! Rays in `f32`, in the world: what the rules have in common whose intersection tests round.

use super::shape::Shape;
use super::trace::Tracer;
use crate::quadric;
use crate::real::{Vector, plus, position, scaled, vector};
use crate::samples::Samples;
use bothways_common::Projection;

/// A ray in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) origin: Vector<f32>,
    pub(super) direction: Vector<f32>,
}

/// A test of a triangle: `t`, if the ray hits it.
pub(super) type Test = fn(&Ray, [Vector<f32>; 3]) -> Option<f32>;

/// A ray tracer in `f32`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Single<'a> {
    samples: &'a Samples<'a>,
    eye: Vector<f32>,
    axes: [Vector<f32>; 3],
    distance: f32,
    test: Test,
}

impl<'a> Single<'a> {
    pub(super) fn new(samples: &'a Samples<'a>, test: Test) -> Single<'a> {
        let camera = samples.camera();
        let axes = [camera.u(), camera.v(), camera.w()].map(vector);
        let (eye, distance) = (position(camera.eye()), camera.description().distance);
        Single { samples, eye, axes, distance, test }
    }
}

impl Tracer for Single<'_> {
    type Ray = Ray;

    /// The lecture's formula in `f32`: `x·u + y·v − d·w`.
    #[expect(clippy::cast_possible_truncation, reason = "the rule is to round to f32")]
    fn ray(&self, row: usize, column: usize) -> Ray {
        let [x, y] = self.samples.on_viewport(row, column).map(|coordinate| coordinate as f32);
        let [u, v, w] = self.axes;
        let across = plus(scaled(x, u), scaled(y, v));
        match self.samples.camera().projection() {
            Projection::Perspective => {
                Ray { origin: self.eye, direction: plus(across, scaled(-self.distance, w)) }
            }
            Projection::Parallel => {
                Ray { origin: plus(self.eye, across), direction: scaled(-1.0, w) }
            }
        }
    }

    fn hit(&self, ray: &Ray, shape: &Shape) -> Option<f64> {
        let is_seen = |t: &f32| *t > 0.0 && t.is_finite();
        let t = match *shape {
            Shape::Triangle(corners) => (self.test)(ray, corners.map(position)),
            Shape::Sphere { center, radius } => {
                quadric::sphere(ray.origin, ray.direction, position(center), radius)?
                    .into_iter()
                    .find(is_seen)
            }
            Shape::Plane { point, normal } => {
                quadric::plane(ray.origin, ray.direction, position(point), position(normal))
            }
        };
        t.filter(is_seen).map(f64::from)
    }
}
