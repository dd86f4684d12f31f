//! How far a sample lies from what decides it, in pixels: an edge, the outline of a sphere, a horizon, the line where two
//! primitives meet.

use super::outline::{Linear, PlaneDistance};
use super::rays::ViewingRays;
use crate::common::glam::DVec3;
use crate::common::{Judge, Primitive, Projection, Ray};

/// A sample, and the lengths of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleDistances<'a> {
    rays: &'a ViewingRays,
    pub(super) ray: Ray,
    /// The sample on the viewport.
    pub(super) x: f64,
    pub(super) y: f64,
    spacing: [f64; 2],
}

impl<'a> SampleDistances<'a> {
    /// Of the sample in the middle of a pixel.
    pub(super) fn new(rays: &'a ViewingRays, [i, j]: [usize; 2]) -> Self {
        SampleDistances {
            rays,
            ray: rays.ray(i, j),
            x: rays.x[j],
            y: rays.y[i],
            spacing: rays.spacing(),
        }
    }

    /// The distance to the line on which a function is zero.
    pub(super) fn to_zero(self, function: &Linear) -> f64 {
        function.at(self.x, self.y).abs() / slope_of(function, self.spacing)
    }

    /// The distance to the outline of a sphere, and the radius.
    pub(super) fn to_sphere(self, center: DVec3, radius: f64) -> (f64, f64) {
        // How far the ray passes from the middle, in radii: 1 on the outline.
        let passes = |ray: Ray| {
            let offset = center - ray.origin;
            let along = offset.dot(ray.direction) / ray.direction.length();
            (offset.length_squared() - along * along).max(0.0).sqrt() / radius
        };
        let slope = self.slope(passes);
        ((1.0 - passes(self.ray)).abs() / slope, 1.0 / slope)
    }

    /// The distance to the horizon of a plane; infinite for a parallel camera, which sees none.
    pub(super) fn to_horizon(self, point: DVec3, normal: DVec3) -> f64 {
        let along = PlaneDistance::of_plane(point, normal, normal.length(), self.rays).denominator;
        let pixels = self.to_zero(&along);
        if pixels.is_nan() { f64::INFINITY } else { pixels }
    }

    /// The distance to the line on which two primitives are equally far; infinite if one of them has no distance half a
    /// pixel away.
    pub(super) fn to_intersection(self, judge: &Judge, primitives: [&Primitive; 2]) -> f64 {
        let difference = |ray: Ray| {
            let [one, other] = primitives.map(|primitive| judge.distance(primitive, &ray));
            one - other
        };
        let pixels = difference(self.ray).abs() / self.slope(difference);
        if pixels.is_nan() { f64::INFINITY } else { pixels }
    }

    /// The change of a function of the ray from one pixel to the next, in the direction in which it changes most.
    fn slope(&self, function: impl Fn(Ray) -> f64) -> f64 {
        let [half_x, half_y] = self.spacing.map(|side| side / 2.0);
        let across =
            |dx: f64, dy: f64| function(self.beside(dx, dy)) - function(self.beside(-dx, -dy));
        across(half_x, 0.0).hypot(across(0.0, half_y))
    }

    /// The ray of a point beside the sample, on the viewport.
    fn beside(&self, dx: f64, dy: f64) -> Ray {
        let (Ray { origin, direction }, step) = (self.ray, dx * self.rays.u + dy * self.rays.v);
        match self.rays.projection {
            Projection::Perspective => Ray { origin, direction: direction + step },
            Projection::Parallel => Ray { origin: origin + step, direction },
        }
    }
}

/// The change of a function from one pixel to the next, in the direction in which it changes most.
pub(super) fn slope_of(function: &Linear, [column, row]: [f64; 2]) -> f64 {
    (function.along_x * column).hypot(function.along_y * row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, CameraDescription};
    use crate::diff::why::convention::Convention;
    use crate::diff::why::outline::TriangleOutline;

    /// A camera with pixels of 1/4 x 1/4 on the viewport, at distance 1.
    fn at(
        projection: Projection,
        pixel: [usize; 2],
        check: impl Fn(&ViewingRays, &SampleDistances),
    ) {
        let description = CameraDescription {
            projection,
            viewport: [2.0, 2.0],
            image: [8, 8],
            ..CameraDescription::default()
        };
        let camera = Camera::new(description).unwrap();
        let rays = ViewingRays::new(&camera, &Convention::default());
        check(&rays, &SampleDistances::new(&rays, pixel));
    }

    #[test]
    fn an_edge_half_a_pixel_away_is_half_a_pixel_away() {
        for (projection, z) in [(Projection::Perspective, 1.0), (Projection::Parallel, 3.0)] {
            at(projection, [4, 4], |rays, sample| {
                assert_eq!((sample.x, sample.y), (0.125, -0.125));
                // The upright edge at x = 0, in the plane of the viewport.
                let corners =
                    [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, -z));
                let outline = TriangleOutline::new(&corners, rays).unwrap();
                let pixels = outline.edges.map(|edge| sample.to_zero(&edge));
                assert!((pixels[2] - 0.5).abs() < 1e-12, "{pixels:?}");
            });
        }
    }

    #[test]
    fn the_outline_of_a_sphere_is_as_far_as_it_looks() {
        at(Projection::Parallel, [3, 7], |_, sample| {
            assert_eq!((sample.x, sample.y), (0.875, 0.125));
            let (pixels, radius) = sample.to_sphere(DVec3::new(0.0, 0.125, -5.0), 0.75);
            assert!(
                (pixels - 0.5).abs() < 1e-3 && (radius - 3.0).abs() < 1e-2,
                "{pixels} {radius}"
            );
        });
    }

    #[test]
    fn two_planes_meet_where_their_distances_are_equal() {
        at(Projection::Parallel, [4, 4], |_, sample| {
            let camera = Camera::new(CameraDescription {
                projection: Projection::Parallel,
                ..CameraDescription::default()
            });
            let plane = |slope: f64| Primitive::Plane {
                point: DVec3::new(0.0, 0.0, -4.0),
                normal: DVec3::new(slope, 0.0, 1.0),
            };
            let judge = Judge::new(&camera.unwrap());
            let pixels = sample.to_intersection(&judge, [&plane(0.5), &plane(-1.0)]);
            assert!((pixels - 0.5).abs() < 1e-9, "{pixels}");
            assert_eq!(sample.to_horizon(DVec3::NEG_Z, DVec3::Y), f64::INFINITY);
        });
    }
}
