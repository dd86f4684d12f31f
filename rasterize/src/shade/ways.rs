//! The ways from a flat form to points of light: attributes that are interpolated like others.

use super::quotient::{Affine, Plane};
use super::stretch::VectorAlong;
use bothways_common::engine::simd::Simd;
use bothways_common::look::bands::{MOST_LIGHTS, Points, Samples, Sixteen, Stretch};
use bothways_common::look::lanes::{DVec3x8, Lanes, each};
use bothways_common::{Primitive, Projection, View};
use glam::DVec3;

/// The ways from a flat form to each point of light, times a positive number: only their directions count.
///
/// From the point `P` that is seen, `L − P` is a quotient of affine functions on the viewport ([`Plane::offset_along`]). The denominator is
/// the same for all coordinates, and has one sign wherever the form is seen. So the numerators alone give the direction, without a division.
#[derive(Clone, Debug)]
pub(super) struct WaysToLights(Box<[[Affine; 3]]>);

/// What is computed is at least this part of what it would be if nothing cancelled in it: so nine of sixteen digits may cancel, and its sign
/// is certain.
const LEAST: f64 = 1e-9;

impl WaysToLights {
    /// `None` for a sphere; for a form that is nearly a line, that is seen nearly edge-on, or that is far larger than its way from
    /// the eye, so that too many digits cancel; and if there are too many lights.
    #[inline]
    pub(super) fn new(view: &View, primitive: &Primitive, lights: &[DVec3]) -> Option<Self> {
        if lights.len() > MOST_LIGHTS {
            return None;
        }
        // The normal, and the squares of what its length would be if no digits had cancelled in it, and of the farthest point's way.
        let (point, normal, uncancelled, farthest) = match *primitive {
            Primitive::Triangle([a, b, c]) => {
                let (along_b, along_c) = (b - a, c - a);
                let uncancelled = along_b.length_squared() * along_c.length_squared();
                let [of_a, of_b, of_c] = [a, b, c].map(DVec3::length_squared);
                (a, along_b.cross(along_c), uncancelled, of_a.max(of_b).max(of_c))
            }
            Primitive::Plane { point, normal } => {
                (point, normal, normal.length_squared(), point.length_squared())
            }
            Primitive::Sphere { .. } => return None,
        };
        let plane = Plane::new(view, point, normal);
        let is_certain = |number: f64, square: f64| number * number >= LEAST * LEAST * square;
        // Perspective rays begin in one point and parallel ones go in one direction: so one of the two functions is constant, and its
        // sign is that of the denominator, wherever the form is seen.
        let (constant, square) = match view.camera.projection() {
            Projection::Perspective => (-plane.above.at_center, uncancelled * farthest),
            Projection::Parallel => (plane.along.at_center, uncancelled),
        };
        if !is_certain(constant, square) || uncancelled == 0.0 {
            return None;
        }
        let (mut ways, longest_ray) = (Vec::with_capacity(lights.len()), longest_ray(view));
        for light in lights {
            let coordinates = DVec3::AXES.map(|axis| plane.offset_along(view, axis, *light));
            let largest: f64 = coordinates.iter().map(|at| at.largest(view)).sum();
            let scale = -constant.signum() / largest;
            let square = uncancelled * (farthest + light.length_squared()) * longest_ray;
            if !(is_certain(largest, square) && scale.is_finite()) {
                return None;
            }
            ways.push(coordinates.map(|at| at * scale));
        }
        Some(WaysToLights(ways.into()))
    }

    /// Finds the ways along a stretch of samples that are `across` from each other. Returns whether none of them changes too much.
    #[inline(always)]
    pub(super) fn go_along(
        &self,
        stretch: &Stretch,
        across: f64,
        to: &mut [VectorAlong; MOST_LIGHTS],
    ) -> bool {
        self.0.iter().zip(to).all(|(way, to)| match VectorAlong::new(way, stretch, across) {
            Some(along) => {
                *to = along;
                true
            }
            None => false,
        })
    }

    /// Writes down the ways from some samples.
    #[inline(always)]
    pub(super) fn store<S: Simd>(
        &self,
        simd: S,
        along: Option<&[VectorAlong; MOST_LIGHTS]>,
        samples: &Sixteen<S>,
        points: &mut Points<'_>,
    ) {
        if let Some(all) = along {
            let numbers = samples.numbers(simd);
            for (number, way) in all.iter().enumerate().take(self.0.len()) {
                points.set_to_light(number, way.at(simd, numbers));
            }
            return;
        }
        for (number, way) in self.0.iter().enumerate() {
            let [low, high] =
                each!(half in [&samples.low, &samples.high] => way_from(simd, way, half));
            points.set_to_light(number, low.narrow(high));
        }
    }
}

/// No direction of a viewing ray has a larger squared length.
fn longest_ray(view: &View) -> f64 {
    let (camera, [width, height]) = (view.camera, view.camera.viewport());
    match camera.projection() {
        Projection::Perspective => {
            camera.distance().powi(2) + (width * width + height * height) * 0.25
        }
        Projection::Parallel => 1.0,
    }
}

#[inline(always)]
fn way_from<S: Simd>(simd: S, [x, y, z]: &[Affine; 3], samples: &Samples<S>) -> DVec3x8<S> {
    let [x, y, z] = each!(at in [x, y, z] => at.lanes(simd, samples));
    Lanes { x, y, z }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{SimdBase, dispatch, f64x8, levels};
    use bothways_common::{Camera, CameraDescription, Sample, Scene};
    use bothways_test_support::Dice;

    /// The ways at a place of the viewport, the same at all levels of SIMD.
    fn ways_at(ways: &WaysToLights, [x, y]: [f64; 2]) -> Vec<DVec3> {
        let all = levels().into_iter().map(|level| -> Vec<DVec3> {
            dispatch!(level, simd => {
                let [x, t] = [x, 0.0].map(|number| f64x8::splat(simd, number));
                let samples = Samples { first: Sample { row: 0, column: 0 }, x, y, t };
                ways.0.iter().map(|way| way_from(simd, way, &samples).lane(3)).collect()
            })
        });
        let all: Vec<Vec<DVec3>> = all.collect();
        assert!(all.iter().all(|ways| *ways == all[0]), "{all:?}");
        all[0].clone()
    }

    /// Points are chosen first, then planes and triangles through them, often seen almost edge-on, or far larger than the way to the point.
    #[test]
    fn ways_lead_from_what_is_seen_to_the_lights() {
        let (mut found, mut missing, mut worst) = (0, 0, 0.0_f64);
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = Camera::new(CameraDescription { projection, ..Default::default() });
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera.unwrap());
            let view = View::new(&scene, &camera);
            let mut dice = Dice(projection as u64);
            for _ in 0..20_000 {
                let place = dice.vector();
                let place = [0.5 * place.x, 0.4 * place.y];
                let ray = camera.ray_through(place[0], place[1]);
                let point = ray.origin + ray.direction * dice.power([-1.0, 2.0]);
                let tilt = dice.power([-12.0, 1.0]);
                let along = (ray.direction + tilt * dice.vector()).normalize();
                let beside = along.cross(dice.vector()).normalize();
                let [size, other] = [[-2.0, 5.0]; 2].map(|of| dice.power(of));
                let first = point - size * along - other * beside;
                let corners = [first, first + 3.0 * size * along, first + 3.0 * other * beside];
                let facing = along.cross(beside).dot(ray.direction.normalize()).abs();
                let normal = along.cross(beside) * dice.power([-3.0, 3.0]);
                let lights = [0; 2].map(|_| point + dice.power([-2.0, 4.0]) * dice.vector());
                for primitive in
                    [Primitive::Triangle(corners), Primitive::Plane { point: first, normal }]
                {
                    let Some(ways) = WaysToLights::new(&view, &primitive, &lights) else {
                        missing += 1;
                        let farthest = corners.map(DVec3::length).into_iter().fold(0.0, f64::max);
                        assert!(facing < 1e-6 * (1.0 + farthest), "{facing:e} {primitive:?}");
                        continue;
                    };
                    found += 1;
                    for (way, light) in ways_at(&ways, place).into_iter().zip(lights) {
                        let expected = light - point;
                        let lengths = [light, point, corners[0], corners[1], corners[2]];
                        let size =
                            lengths.map(DVec3::length).into_iter().sum::<f64>() / expected.length();
                        let off = way.normalize().distance(expected.normalize());
                        worst = worst.max(off / size);
                    }
                }
            }
        }
        println!("{found} found, {missing} missing, off by {worst:e} at most");
        assert!(found > 10_000 && missing > 1000, "{found}, {missing}");
        assert!(worst < 1e-6, "{worst:e}");
    }

    #[test]
    fn what_is_seen_edge_on_or_is_round_or_extreme_has_none() {
        let (scene, camera) = (Scene::new(Vec::new()).unwrap(), Camera::canonical(8, 8));
        let view = View::new(&scene, &camera);
        let triangle = |corners: [[f64; 3]; 3]| Primitive::Triangle(corners.map(DVec3::from));
        let ways = |primitive| WaysToLights::new(&view, &primitive, &[DVec3::Y]);
        let facing = [[0.0, 0.0, -2.0], [1.0, 0.0, -2.0], [0.0, 1.0, -2.0]];
        assert!(ways(triangle(facing)).is_some());
        let none = [
            triangle([[0.0, 0.0, -2.0], [1.0, 0.0, -2e9], [0.0, 1.0, -2e9]]),
            triangle([[0.0, 0.0, -2.0], [1.0, 0.0, -2.0], [1.0, 0.0, -3.0]]),
            triangle([[1.0; 3]; 3]),
            triangle(facing.map(|corner| corner.map(|number: f64| 1e300 * number))),
            Primitive::Plane { point: DVec3::X, normal: DVec3::Y },
            Primitive::Sphere { center: DVec3::NEG_Z, radius: 0.5 },
        ];
        for primitive in none {
            assert!(ways(primitive).is_none(), "{primitive:?}");
        }
        let of_many = |count| WaysToLights::new(&view, &triangle(facing), &vec![DVec3::Y; count]);
        assert!(of_many(MOST_LIGHTS).is_some() && of_many(MOST_LIGHTS + 1).is_none());
    }
}
