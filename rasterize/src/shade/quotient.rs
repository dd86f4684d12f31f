//! Functions on the viewport: affine ones, and quotients of two. Seen from the eye, an affine function on a flat form
//! is such a quotient.
//!
//! Heckbert and Moreton, "Interpolation for Polygon Texture Mapping and Shading", 1991.
//!
//! Functions here are `#[inline(always)]`: where triangles are as small as samples, each sample sets up its own, and calls between
//! codegen units take a fifth of the time of shading.

use bothways_common::engine::simd::{Simd, SimdBase, f64x8};
use bothways_common::look::bands::Samples;
use bothways_common::look::lanes::{DVec3x8, Lanes, Real, each};
use bothways_common::{Projection, View};
use glam::{DVec2, DVec3, Vec3};
use std::ops::{Add, Mul};

/// A function `at_center + x·across + y·up`, or one for each of eight triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Affine<T = f64> {
    pub(super) at_center: T,
    pub(super) across: T,
    pub(super) up: T,
}

impl Affine {
    /// `a · D`, where `D` is the direction of the viewing ray.
    #[inline(always)]
    pub(super) fn along_ray(view: &View, a: DVec3) -> Affine {
        let camera = view.camera;
        match camera.projection() {
            Projection::Perspective => Affine {
                at_center: -camera.distance() * a.dot(camera.w()),
                across: a.dot(camera.u()),
                up: a.dot(camera.v()),
            },
            Projection::Parallel => Affine { at_center: -a.dot(camera.w()), across: 0.0, up: 0.0 },
        }
    }

    /// `a · (O − p)`, where `O` is the origin of the viewing ray.
    #[inline(always)]
    pub(super) fn from_origin(view: &View, a: DVec3, p: DVec3) -> Affine {
        let at_center = -a.dot(p);
        match view.camera.projection() {
            Projection::Perspective => Affine { at_center, across: 0.0, up: 0.0 },
            Projection::Parallel => {
                Affine { at_center, across: a.dot(view.camera.u()), up: a.dot(view.camera.v()) }
            }
        }
    }

    /// Its values at some samples.
    #[inline(always)]
    pub(super) fn lanes<S: Simd>(&self, simd: S, samples: &Samples<S>) -> f64x8<S> {
        self.at_places(simd, samples.x, samples.y)
    }

    /// The part of its values that is the same in a row.
    #[inline(always)]
    fn in_row(&self, y: f64) -> f64 {
        self.at_center + y * self.up
    }

    /// Its values at some places of a row of the viewport.
    #[inline(always)]
    fn at_places<S: Simd>(&self, simd: S, x: f64x8<S>, y: f64) -> f64x8<S> {
        f64x8::splat(simd, self.in_row(y)) + x * f64x8::splat(simd, self.across)
    }

    /// No value on the viewport has a larger magnitude.
    pub(super) fn largest(&self, view: &View) -> f64 {
        let [width, height] = view.camera.viewport();
        self.at_center.abs() + (self.across.abs() * width + self.up.abs() * height) * 0.5
    }

    /// The product of two functions, one of which is constant.
    #[inline(always)]
    fn times(self, other: Affine) -> Affine {
        // One of the two is always constant: either O or D changes over the viewport.
        Affine {
            at_center: self.at_center * other.at_center,
            across: self.across * other.at_center + self.at_center * other.across,
            up: self.up * other.at_center + self.at_center * other.up,
        }
    }
}

impl<T: Real> Affine<T> {
    /// Its value at a place of the viewport.
    #[inline(always)]
    pub(super) fn at(&self, x: T, y: T) -> T {
        (self.at_center + y * self.up) + x * self.across
    }
}

impl<T: Real> Mul<T> for Affine<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        let Affine { at_center, across, up } = self;
        Affine { at_center: at_center * factor, across: across * factor, up: up * factor }
    }
}

impl<T: Real> Add for Affine<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Affine {
            at_center: self.at_center + other.at_center,
            across: self.across + other.across,
            up: self.up + other.up,
        }
    }
}

/// A plane through a point `p` with a normal `n`, as functions on the viewport: the viewing ray meets it at `t = −above/along`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// `n · (O − p)`.
    pub(super) above: Affine,
    /// `n · D`.
    pub(super) along: Affine,
}

impl Plane {
    #[inline(always)]
    pub(super) fn new(view: &View, point: DVec3, normal: DVec3) -> Plane {
        let above = Affine::from_origin(view, normal, point);
        Plane { above, along: Affine::along_ray(view, normal) }
    }

    /// `a · (P − from)` times `along`, where `P` is the point that is seen, `O − D·above/along`: an affine function, as no division
    /// is left.
    #[inline(always)]
    pub(super) fn offset_along(&self, view: &View, a: DVec3, from: DVec3) -> Affine {
        let (start, direction) = (Affine::from_origin(view, a, from), Affine::along_ray(view, a));
        start.times(self.along) + self.above.times(direction) * -1.0
    }
}

/// Two quotients of affine functions with one denominator.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quotient {
    pub(super) numerators: [Affine; 2],
    pub(super) denominator: Affine,
}

impl Quotient {
    /// The functions that have these values at the corners of a triangle with these weights.
    #[inline(always)]
    pub(super) fn interpolating(weights: [Affine; 3], values: [DVec2; 3]) -> Quotient {
        let [a, b, c] = weights;
        let numerator = |k: usize| a * values[0][k] + b * values[1][k] + c * values[2][k];
        Quotient { numerators: [numerator(0), numerator(1)], denominator: a + b + c }
    }

    /// The products of two vectors with the offset of the point that is seen from a given point of the plane.
    #[inline(always)]
    pub(super) fn on_plane(
        view: &View,
        point: DVec3,
        normal: DVec3,
        vectors: [DVec3; 2],
    ) -> Quotient {
        let plane = Plane::new(view, point, normal);
        let numerators = vectors.map(|a| plane.offset_along(view, a, point));
        Quotient { numerators, denominator: plane.along }
    }

    /// Both values at some places of a row of the viewport, and how far each changes by a step down or across, added up.
    ///
    /// The derivative of `n/d` along `x` is `(n' d − n d') / d²`; what is above is the same in the whole row. Along `y`, it is an affine
    /// function of `x`.
    #[inline(always)]
    pub(super) fn with_footprint<S: Simd>(
        &self,
        simd: S,
        x: f64x8<S>,
        y: f64,
        [down, across]: [f64; 2],
    ) -> ([f64x8<S>; 2], [f64x8<S>; 2]) {
        let splat = |number: f64| f64x8::splat(simd, number);
        let denominator = &self.denominator;
        let reciprocal = splat(1.0) / denominator.at_places(simd, x, y);
        let square = reciprocal * reciprocal;
        let of_both = each!(k in [0, 1] => {
            let numerator = &self.numerators[k];
            let [above, below] = each!(of in [numerator, denominator] => of.in_row(y));
            let along_x = (numerator.across * below - denominator.across * above) * across;
            let along_y = (numerator.up * below - denominator.up * above) * down;
            let slope = (numerator.up * denominator.across - denominator.up * numerator.across) * down;
            let changes = splat(along_x.abs()) + (splat(along_y) + x * splat(slope)).abs();
            (numerator.at_places(simd, x, y) * reciprocal, changes * square)
        });
        let [(across, width), (up, height)] = of_both;
        ([across, up], [width, height])
    }

    /// How far both values move from each sample to the next one across, and to the next one down: the differences between
    /// the two samples of a pair, of which the first is in an even column, and in an even row. So graphics hardware finds
    /// them, which shades squares of 2 × 2 samples together: both samples of a pair get the same difference.
    ///
    /// The other sample need not see the form; the functions go on beyond it.
    #[inline(always)]
    pub(super) fn differences<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        step: [f64; 2],
    ) -> [[f64x8<S>; 2]; 2] {
        let [odd_row, odd_column] = [samples.first.row, samples.first.column].map(|k| k % 2 == 1);
        // The way to the other sample of a pair, in steps.
        let way = |is_odd: bool| if is_odd { -1.0 } else { 1.0 };
        let along_row = f64x8::from_fn(simd, |lane| way(odd_column ^ (lane % 2 == 1)));
        let along_column = way(odd_row);
        let [down, across] = step;
        let here = self.at(simd, samples.x, samples.y);
        let aside = self.at(simd, samples.x + along_row * f64x8::splat(simd, across), samples.y);
        let below = self.at(simd, samples.x, samples.y + along_column * down);
        [
            each!(k in [0, 1] => (aside[k] - here[k]) * along_row),
            each!(k in [0, 1] => (below[k] - here[k]) * f64x8::splat(simd, along_column)),
        ]
    }

    /// Both values at some places.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, x: f64x8<S>, y: f64) -> [f64x8<S>; 2] {
        let below = self.denominator.at_places(simd, x, y);
        each!(k in [0, 1] => self.numerators[k].at_places(simd, x, y) / below)
    }

    /// The derivatives along `x` and along `y` at one place.
    #[inline(always)]
    pub(super) fn changes(&self, x: f64, y: f64) -> [DVec2; 2] {
        let below = self.denominator.at(x, y);
        let value = self.numerators.map(|above| above.at(x, y) / below);
        let derivative = |slope: fn(&Affine) -> f64| {
            DVec2::from([0, 1].map(|k| {
                (slope(&self.numerators[k]) - value[k] * slope(&self.denominator)) / below
            }))
        };
        [derivative(|line| line.across), derivative(|line| line.up)]
    }
}

/// Colours as quotients of affine functions, one denominator for all.
#[derive(Clone, Copy, Debug)]
pub(super) struct Colors {
    numerators: [Affine; 3],
    denominator: Affine,
}

impl Colors {
    /// The functions that have these values at the corners of a triangle with these weights.
    pub(super) fn interpolating([a, b, c]: [Affine; 3], values: [Vec3; 3]) -> Colors {
        let [of_a, of_b, of_c] = values.map(|value| value.as_dvec3());
        let numerator = |k: usize| a * of_a[k] + b * of_b[k] + c * of_c[k];
        Colors { numerators: [numerator(0), numerator(1), numerator(2)], denominator: a + b + c }
    }

    /// The colours at some samples.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, samples: &Samples<S>) -> DVec3x8<S> {
        let below = self.denominator.lanes(simd, samples);
        let [x, y, z] = each!(k in [0, 1, 2] => self.numerators[k].lanes(simd, samples) / below);
        Lanes { x, y, z }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{best_level, dispatch};
    use bothways_common::{Camera, CameraDescription, Scene};
    use glam::Vec3;

    /// The values at one place, and the derivatives along `x` and along `y`.
    fn at(quotient: &Quotient, x: f64, y: f64) -> (DVec2, [DVec2; 2]) {
        dispatch!(best_level(), simd => {
            let x_lanes = f64x8::splat(simd, x);
            let of_lane = |pair: [f64x8<_>; 2]| DVec2::from(pair.map(|lanes| lanes[5]));
            // The footprints of steps that go only across, only down, and both ways.
            let [(value, across), (_, down), (_, both)] = [[0.0, 1.0], [1.0, 0.0], [-2.0, 3.0]]
                .map(|step| quotient.with_footprint(simd, x_lanes, y, step))
                .map(|(value, footprint)| (of_lane(value), of_lane(footprint)));
            let changes = quotient.changes(x, y);
            let [along_x, along_y] = changes.map(DVec2::abs);
            assert!((across - along_x).length() < 1e-13 * along_x.length().max(1.0), "{across}");
            assert!((down - along_y).length() < 1e-13 * along_y.length().max(1.0), "{down}");
            let sum = 3.0 * along_x + 2.0 * along_y;
            assert!((both - sum).length() < 1e-13 * sum.length().max(1.0), "{both} {sum}");
            (value, changes)
        })
    }

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
            let (value, [along_x, along_y]) = at(&quotient, x, y);
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
            let near = Affine { at_center: 1.0, across: -1.0, up: 0.0 } * 3.0;
            let far = Affine { at_center: 0.0, across: 1.0, up: 0.0 };
            let nothing = Affine { at_center: 0.0, across: 0.0, up: 0.0 };
            let values = [DVec2::ZERO, DVec2::X, DVec2::ZERO];
            at(&Quotient::interpolating([near, far, nothing], values), place, 0.0).0.x
        };
        assert_eq!((at(0.0), at(0.5), at(1.0)), (0.0, 0.25, 1.0));
    }
}
