//! Functions on the viewport: linear ones, and quotients of two, which is what a linear function on
//! a flat form looks like from the eye.
//!
//! Heckbert and Moreton, "Interpolation for Polygon Texture Mapping and Shading", 1991.

use bothways_common::{Projection, View};
use glam::{DVec2, DVec3};
use std::ops::{Add, Mul};

/// A function `at_center + x·across + y·up`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear {
    pub(super) at_center: f64,
    pub(super) across: f64,
    pub(super) up: f64,
}

impl Linear {
    /// `a · D`, where `D` is the direction of the viewing ray.
    pub(super) fn along_ray(view: &View, a: DVec3) -> Linear {
        let camera = view.camera;
        match camera.projection() {
            Projection::Perspective => Linear {
                at_center: -camera.distance() * a.dot(camera.w()),
                across: a.dot(camera.u()),
                up: a.dot(camera.v()),
            },
            Projection::Parallel => Linear { at_center: -a.dot(camera.w()), across: 0.0, up: 0.0 },
        }
    }

    /// `a · (O − p)`, where `O` is the origin of the viewing ray.
    pub(super) fn from_origin(view: &View, a: DVec3, p: DVec3) -> Linear {
        let at_center = -a.dot(p);
        match view.camera.projection() {
            Projection::Perspective => Linear { at_center, across: 0.0, up: 0.0 },
            Projection::Parallel => {
                Linear { at_center, across: a.dot(view.camera.u()), up: a.dot(view.camera.v()) }
            }
        }
    }

    /// Its value at a place of the viewport.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        self.at_center + x * self.across + y * self.up
    }

    /// The product with a function that is constant, or of a constant one with this.
    fn times(self, other: Linear) -> Linear {
        // One of the two is always constant: of O and D, one changes over the viewport.
        Linear {
            at_center: self.at_center * other.at_center,
            across: self.across * other.at_center + self.at_center * other.across,
            up: self.up * other.at_center + self.at_center * other.up,
        }
    }
}

impl Mul<f64> for Linear {
    type Output = Linear;

    fn mul(self, factor: f64) -> Linear {
        let Linear { at_center, across, up } = self;
        Linear { at_center: at_center * factor, across: across * factor, up: up * factor }
    }
}

impl Add for Linear {
    type Output = Linear;

    fn add(self, other: Linear) -> Linear {
        Linear {
            at_center: self.at_center + other.at_center,
            across: self.across + other.across,
            up: self.up + other.up,
        }
    }
}

/// Two quotients of linear functions with one denominator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quotient {
    numerators: [Linear; 2],
    denominator: Linear,
}

impl Quotient {
    /// What has these values at the corners of a triangle, whose weights these are.
    pub(super) fn interpolating(weights: [Linear; 3], values: [DVec2; 3]) -> Quotient {
        let [a, b, c] = weights;
        let numerator = |k: usize| a * values[0][k] + b * values[1][k] + c * values[2][k];
        Quotient { numerators: [numerator(0), numerator(1)], denominator: a + b + c }
    }

    /// The products of two vectors with the way from a point of a plane to what is seen of it.
    pub(super) fn on_plane(
        view: &View,
        point: DVec3,
        normal: DVec3,
        vectors: [DVec3; 2],
    ) -> Quotient {
        let along = Linear::along_ray(view, normal);
        let above = Linear::from_origin(view, normal, point);
        // What is seen is O + t·D with t = −n·(O − p) / n·D.
        let numerator = |a: DVec3| {
            let (start, direction) =
                (Linear::from_origin(view, a, point), Linear::along_ray(view, a));
            start.times(along) + above.times(direction) * -1.0
        };
        Quotient { numerators: vectors.map(numerator), denominator: along }
    }

    /// Both values at a place of the viewport, and their derivatives along `x` and along `y`.
    pub(super) fn at(&self, x: f64, y: f64) -> (DVec2, [DVec2; 2]) {
        let below = self.denominator.at(x, y);
        let value = self.numerators.map(|above| above.at(x, y) / below);
        let derivative = |slope: fn(&Linear) -> f64| {
            let [s, t] = [0, 1].map(|k| {
                (slope(&self.numerators[k]) - value[k] * slope(&self.denominator)) / below
            });
            DVec2::new(s, t)
        };
        (value.into(), [derivative(|line| line.across), derivative(|line| line.up)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::{Camera, CameraDescription, Scene};
    use glam::Vec3;

    fn camera(projection: Projection) -> Camera {
        let description = CameraDescription {
            projection,
            eye: Vec3::new(0.5, 1.0, 4.0),
            ..CameraDescription::default()
        };
        Camera::new(description).unwrap()
    }

    #[test]
    fn a_point_of_a_plane_is_where_its_ray_meets_it() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera(projection));
            let view = View::new(&scene, &camera);
            let (point, normal) = (DVec3::new(0.3, -1.0, -2.0), DVec3::new(0.5, 2.0, 1.5));
            let vectors = [DVec3::new(1.0, 0.5, 0.0), DVec3::new(-0.5, 0.25, 2.0)];
            let quotient = Quotient::on_plane(&view, point, normal, vectors);
            let expected = |x: f64, y: f64| {
                let ray = camera.ray_through(x, y);
                let t = normal.dot(point - ray.origin) / normal.dot(ray.direction);
                let way = ray.origin + t * ray.direction - point;
                DVec2::new(vectors[0].dot(way), vectors[1].dot(way))
            };
            let (x, y) = (0.2, -0.3);
            let (value, [along_x, along_y]) = quotient.at(x, y);
            assert!((value - expected(x, y)).length() < 1e-13, "{projection:?}");
            let (h, middle) = (1e-5, |a: DVec2, b: DVec2| (a - b) / 2e-5);
            let expected_x = middle(expected(x + h, y), expected(x - h, y));
            let expected_y = middle(expected(x, y + h), expected(x, y - h));
            assert!((along_x - expected_x).length() < 1e-7, "{along_x} {expected_x}");
            assert!((along_y - expected_y).length() < 1e-7, "{along_y} {expected_y}");
        }
    }

    #[test]
    fn halfway_in_the_picture_is_nearer_on_the_triangle() {
        // From depth 1 to depth 3: the middle of the picture shows a quarter of the way.
        let at = |place: f64| {
            let near = Linear { at_center: 1.0, across: -1.0, up: 0.0 } * 3.0;
            let far = Linear { at_center: 0.0, across: 1.0, up: 0.0 };
            let nothing = Linear { at_center: 0.0, across: 0.0, up: 0.0 };
            let values = [DVec2::ZERO, DVec2::X, DVec2::ZERO];
            Quotient::interpolating([near, far, nothing], values).at(place, 0.0).0.x
        };
        assert_eq!((at(0.0), at(0.5), at(1.0)), (0.0, 0.25, 1.0));
    }
}
