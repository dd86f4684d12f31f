//! A ray tracer that decides as it should, in `f64`: for the rules whose fault is elsewhere.
//!
//! Edges belong to one side: a ray that meets one exactly is moved a little to the right, then down.

use super::shape::Shape;
use super::trace::Tracer;
use crate::quadric;
use crate::samples::Samples;
use bothways_common::{Projection, Ray, View};
use glam::DVec3;

/// A ray tracer in `f64`, relative to the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double<'a> {
    view: &'a View<'a>,
    samples: Samples<'a>,
}

impl<'a> Double<'a> {
    pub(super) fn new(view: &'a View<'a>, samples: Samples<'a>) -> Double<'a> {
        Double { view, samples }
    }

    /// The sign of the edge function of `a → b`, never zero unless the triangle is seen edge-on.
    fn edge(&self, ray: &Ray, a: DVec3, b: DVec3) -> f64 {
        let camera = self.view.camera;
        let (from, to) = (a - ray.origin, b - ray.origin);
        let edge = from.cross(to).dot(ray.direction);
        if edge != 0.0 {
            return edge;
        }
        let moved = |step: DVec3| match camera.projection() {
            Projection::Perspective => from.cross(to).dot(step),
            Projection::Parallel => step.cross(a - b).dot(ray.direction),
        };
        let right = moved(camera.u());
        if right == 0.0 { moved(-camera.v()) } else { right }
    }

    fn triangle(&self, ray: &Ray, [a, b, c]: [DVec3; 3]) -> Option<f64> {
        let normal = (b - a).cross(c - a);
        let along = normal.dot(ray.direction);
        let edges = [self.edge(ray, a, b), self.edge(ray, b, c), self.edge(ray, c, a)];
        let one_sided =
            edges.iter().all(|&edge| edge > 0.0) || edges.iter().all(|&edge| edge < 0.0);
        (one_sided && along != 0.0).then(|| normal.dot(a - ray.origin) / along)
    }
}

impl Tracer for Double<'_> {
    type Ray = Ray;

    fn ray(&self, row: usize, column: usize) -> Ray {
        self.samples.ray(row, column)
    }

    fn hit(&self, ray: &Ray, shape: &Shape) -> Option<f64> {
        let is_seen = |t: &f64| *t > 0.0 && t.is_finite();
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let t = match *shape {
            Shape::Triangle(corners) => {
                self.triangle(ray, corners.map(|corner| self.view.offset(corner)))
            }
            Shape::Sphere { center, radius } => {
                let center = self.view.offset(center).to_array();
                quadric::sphere(origin, direction, center, f64::from(radius))?
                    .into_iter()
                    .find(is_seen)
            }
            Shape::Plane { point, normal } => {
                let point = self.view.offset(point).to_array();
                quadric::plane(origin, direction, point, normal.as_dvec3().to_array())
            }
        };
        t.filter(is_seen)
    }
}
