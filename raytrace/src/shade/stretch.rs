//! Where the rays along a [`Stretch`] of samples hit a plane or another flat form: counted from the hit of the first one, `f32` is
//! enough.

use bothways_common::engine::simd::{Simd, SimdBase, f32x16};
use bothways_common::look::bands::{MOST_LIGHTS, Points, Sixteen, Stretch};
use bothways_common::look::lanes::{Vec3x16, each};
use bothways_common::look::texture::TextureDifferences;
use bothways_common::{Projection, View};
use glam::{DVec2, DVec3, Vec3};

/// The hit of the first ray, and how those of the others differ.
///
/// The first ray, of direction `D`, hits the plane with the normal `n` at `t`. After `k` steps across, of `s` each, the direction is
/// `D + k·s`, and `n·D` is `1 + k·r` times as large, with `r = n·s / n·D`. So `t` is divided by that, and the hit moves by
/// `k·e / (1 + k·r)`, with `e = t·(s − r·D)`. Parallel rays move themselves: their hits move by `k·e`, with `e = s − r·D`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstHit {
    /// Relative to the eye.
    position: DVec3,
    direction: DVec3,
    /// From a ray to the next one: `s`, or 0 for parallel rays.
    turning: DVec3,
    /// `e`.
    change: DVec3,
    /// `n·turning / n·D`.
    turn: f64,
    /// `t`, or 1 for parallel rays: by what a step along the viewport is multiplied.
    scale: f64,
    /// `n·s° / n·D`, where `s°` is the step down.
    fall: f64,
}

impl FirstHit {
    /// `None` where `n·D` may change by more than half of itself along the stretch, or by more than an eighth of itself from a row to the next;
    /// and where more than nine of sixteen digits cancel: in how far the ray begins from the plane, or in how fast it comes nearer. (A triangle
    /// whose own normal has lost its digits is a sliver that is seen at hardly any sample.)
    #[inline(always)]
    pub(super) fn new(
        view: &View,
        [point, normal]: [DVec3; 2],
        [step, step_down]: [DVec3; 2],
        stretch: &Stretch,
    ) -> Option<Self> {
        /// The square of 10⁻⁹.
        const LEAST: f64 = 1e-18;
        let ray = view.camera.ray_through(stretch.x, stretch.y);
        let (nearer, above) = (normal.dot(ray.direction), normal.dot(point - ray.origin));
        let square = normal.length_squared();
        let is_certain = nearer * nearer > LEAST * square * ray.direction.length_squared()
            && above * above
                > LEAST * square * (point.length_squared() + ray.origin.length_squared());
        let (reciprocal, t) = (1.0 / nearer, above / nearer);
        let [rise, fall] = [step, step_down].map(|step| normal.dot(step) * reciprocal);
        let (turning, turn, scale, is_steady) = match view.camera.projection() {
            Projection::Perspective => {
                let is_steady = rise.abs() <= 0.5 / Stretch::LAST && fall.abs() <= 0.125;
                (step, rise, t, is_steady)
            }
            // All rays have one direction.
            Projection::Parallel => (DVec3::ZERO, 0.0, 1.0, true),
        };
        if !(is_certain && is_steady && t > 0.0) {
            return None;
        }
        Some(FirstHit {
            position: ray.origin + t * ray.direction,
            direction: ray.direction,
            turning,
            change: (step - ray.direction * rise) * scale,
            turn,
            scale,
            fall,
        })
    }
}

/// What is needed of the hits along a stretch.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HitsAlong {
    /// `r`.
    turn: f32,
    /// `e`.
    change: Vec3,
    /// The ways from the first hit to the points of light, and how many there are.
    ways: [Vec3; MOST_LIGHTS],
    lights: usize,
    texture: Option<TextureAlong>,
}

/// The texture coordinates of the hits along a stretch, and what their footprints are computed from.
#[derive(Clone, Copy, Debug)]
struct TextureAlong {
    at_first: [f64; 2],
    /// How the coordinates change by `e`.
    across: [f32; 2],
    /// How they change by a step down on the viewport, where `t` is that of the first ray.
    down: [f32; 2],
    /// What of that is taken back along the ray, and how that changes from a ray to the next.
    back: [[f32; 2]; 2],
}

#[expect(clippy::cast_possible_truncation, reason = "see `HitsAlong`")]
fn number(number: f64) -> f32 {
    number as f32
}

impl HitsAlong {
    /// Finds what is wanted along a stretch. Returns `false` where there are too many lights, or where the way to one may change by more than
    /// half of its length or is extremely long or short.
    ///
    /// # The error, rounding by rounding
    ///
    /// `1 + k·r` is between ½ and 1½. With `ε = 2⁻²⁴` it is off by `2ε` of at most ½ and by its own rounding, in all by less than `5ε` of
    /// itself, and `k / (1 + k·r)` by `7ε`. With the rounding of `e` and the product it is `9ε` of what a hit moves, so of at most half
    /// of the first way to a light. The rounding of that way makes it `5½ε` of it, so `11ε` of any way, and that of the difference `12ε`.
    #[inline(always)]
    pub(super) fn go_along(&mut self, hit: &FirstHit, lights: &[DVec3]) -> bool {
        if lights.len() > MOST_LIGHTS {
            return false;
        }
        (self.turn, self.change) = (number(hit.turn), hit.change.as_vec3());
        (self.lights, self.texture) = (lights.len(), None);
        let change = hit.change.abs();
        // No hit is farther from the first one.
        let farthest = (change.x + change.y + change.z) * (2.0 * Stretch::LAST);
        self.ways.iter_mut().zip(lights).all(|(to, light)| {
            let way = *light - hit.position;
            let length = way.abs().max_element();
            *to = way.as_vec3();
            2.0 * farthest <= length && Stretch::LENGTHS.contains(&length)
        })
    }

    /// Adds a texture, whose coordinates are given at a point and grow in two directions, by so much for each length.
    ///
    /// The next ray down would meet the plane `s°·t` beside this hit, but for what the step rises from the plane: as far as that, it goes
    /// back along the ray. The ray and its `t` are those of each sample.
    ///
    /// # The error, rounding by rounding
    ///
    /// A difference `δ` of coordinates is off by `9ε` of itself (see [`HitsAlong::go_along`]). As the footprint across is
    /// at least `f = g·e / (1 + k·r)²`, with a gradient `g`, and `k` at most 63, `δ` is at most `95f`: what a pattern makes of it
    /// ([`fraction_by_differences`]) is off by less than `14ε · 95f`, and by twice that of the footprint, `1.6·10⁻⁴`, where the sample
    /// meets a border.
    ///
    /// What is taken back is off by `3ε` of itself, and of `126` times its change. In perspective, that change is an eighth of what a step across
    /// changes, or less; parallel rays have none. With five more roundings, and those of `1 + k·r`, a footprint is off by less than
    /// `100ε` of its largest term, and so by `100ε / cos θ` of itself, where `θ` lies between the ray and the axis.
    ///
    /// [`fraction_by_differences`]: bothways_common::scene::material::Checker::fraction_by_differences
    #[inline(always)]
    pub(super) fn add_texture(
        &mut self,
        hit: &FirstHit,
        (at_point, gradients): (DVec2, [DVec3; 2]),
        point: DVec3,
        step_down: DVec3,
    ) {
        let FirstHit { position, direction, turning, change, scale, fall, .. } = *hit;
        let offset = position - point;
        let back = fall * scale;
        self.texture = Some(TextureAlong {
            at_first: each!(k in [0, 1] => at_point[k] + gradients[k].dot(offset)),
            across: each!(k in [0, 1] => number(gradients[k].dot(change))),
            down: each!(k in [0, 1] => number(gradients[k].dot(step_down) * scale)),
            back: each!(k in [0, 1] => {
                each!(way in [direction, turning] => number(gradients[k].dot(way) * back))
            }),
        });
    }

    /// Writes down the ways to the lights, and the texture if there is one, of some hits.
    #[inline(always)]
    pub(super) fn store<S: Simd>(&self, simd: S, samples: &Sixteen<S>, points: &mut Points<'_>) {
        let numbers = samples.numbers(simd);
        let [nearer, along] = self.places(simd, numbers);
        for light in 0..self.lights {
            points.set_to_light(light, self.way(simd, light, along));
        }
        let Some(texture) = &self.texture else { return };
        points.set_pattern(simd, &texture.at(simd, [numbers, nearer, along]));
    }

    /// `1 / (1 + k·r)` and `k / (1 + k·r)` of the rays with these numbers.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, numbers: f32x16<S>) -> [f32x16<S>; 2] {
        let one = f32x16::splat(simd, 1.0);
        let nearer = one / (numbers * f32x16::splat(simd, self.turn) + one);
        [nearer, numbers * nearer]
    }

    /// The ways to one of the lights, from `k / (1 + k·r)`.
    #[inline(always)]
    fn way<S: Simd>(&self, simd: S, light: usize, along: f32x16<S>) -> Vec3x16<S> {
        Vec3x16::splat(simd, self.ways[light]) - Vec3x16::splat(simd, self.change) * along
    }
}

impl TextureAlong {
    /// The coordinates of the rays with these numbers, from `1 / (1 + k·r)` and `k / (1 + k·r)`.
    #[inline(always)]
    fn at<S: Simd>(
        &self,
        simd: S,
        [numbers, nearer, along]: [f32x16<S>; 3],
    ) -> TextureDifferences<S> {
        let splat = |number: f32| f32x16::splat(simd, number);
        let square = nearer * nearer;
        TextureDifferences {
            from: self.at_first,
            differences: each!(k in [0, 1] => along * splat(self.across[k])),
            footprint: each!(k in [0, 1] => {
                let [back, change] = self.back[k];
                let back = (splat(back) + numbers * splat(change)) * nearer;
                let down = (splat(self.down[k]) - back) * nearer;
                splat(self.across[k].abs()) * square + down.abs()
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};
    use bothways_common::{Camera, CameraDescription, Ray, Scene};
    use bothways_test_support::Dice;

    /// Where a ray hits a plane, and how the hit moves with the steps on the viewport.
    fn hit(view: &View, ray: &Ray, [point, normal]: [DVec3; 2], steps: [DVec3; 2]) -> [DVec3; 3] {
        let nearer = normal.dot(ray.direction);
        let t = normal.dot(point - ray.origin) / nearer;
        let is_parallel = view.camera.projection() == Projection::Parallel;
        let [across, down] = steps.map(|step| {
            let on_plane = step - ray.direction * (normal.dot(step) / nearer);
            if is_parallel { on_plane } else { on_plane * t }
        });
        [ray.origin + t * ray.direction, across, down]
    }

    /// What [`HitsAlong`] gives sixteen samples, the same at every level of SIMD: the way to the first light, and the texture.
    fn at_all_levels(along: &HitsAlong, first: u8) -> [[f32; 16]; 7] {
        let all = levels().into_iter().map(|level| {
            dispatch!(level, simd => {
                let numbers = f32x16::from_fn(simd, |lane| f32::from(first) + lane as f32);
                let [nearer, along_row] = along.places(simd, numbers);
                let way = along.way(simd, 0, along_row);
                let texture = along.texture.as_ref().expect("it was added");
                let TextureDifferences { differences, footprint, .. } =
                    texture.at(simd, [numbers, nearer, along_row]);
                let [[across, up], [width, height]] = [differences, footprint];
                [way.x, way.y, way.z, across, up, width, height].map(SimdBase::to_array)
            })
        });
        let all: Vec<_> = all.collect();
        assert!(all.iter().all(|one| *one == all[0]));
        all[0]
    }

    /// Cameras whose viewports are 1 high, and 300, and these heights.
    fn cameras() -> impl Iterator<Item = (Camera, f64)> {
        let projections = [Projection::Perspective, Projection::Parallel].into_iter();
        projections.flat_map(|projection| {
            [1.0_f32, 300.0].map(|size| {
                let (viewport, distance) = ([4.0 / 3.0 * size, size], size);
                let camera =
                    CameraDescription { projection, viewport, distance, ..Default::default() };
                (Camera::new(camera).unwrap(), size.into())
            })
        })
    }

    /// A plane of any slope that a ray meets, near or far, with directions in which a texture grows, and a light near or far.
    fn something_seen(dice: &mut Dice, ray: &Ray) -> ([DVec3; 2], [DVec3; 2], DVec3) {
        let seen = ray.origin + ray.direction * dice.power([-1.0, 3.0]);
        let across = ray.direction.cross(dice.vector()).normalize();
        let tilt = (ray.direction + dice.power([-3.0, 1.0]) * dice.vector()).normalize();
        let normal = (tilt.cross(across) + 0.1 * dice.vector()) * dice.power([-3.0, 3.0]);
        let along = normal.cross(dice.vector()).normalize();
        let gradients = [along, along.cross(normal).normalize() * dice.power([-2.0, 2.0])];
        let point = seen + gradients[0] * dice.power([-2.0, 2.0]);
        let light = seen + dice.vector() * dice.power([-3.0, 3.0]);
        ([point, normal], gradients, light)
    }

    #[test]
    fn hits_along_a_stretch_are_within_their_bounds() {
        const EPSILON: f64 = 1.0 / (1 << 24) as f64;
        let (mut found, mut missing, mut worst) = (0, 0, [0.0_f64; 3]);
        for (number, (camera, size)) in (0..).zip(cameras()) {
            let scene = Scene::new(Vec::new()).unwrap();
            let view = View::new(&scene, &camera);
            let mut dice = Dice(number);
            for case in 0..20_000 {
                let place = dice.vector();
                let stretch = Stretch { x: 0.5 * size * place.x, y: 0.4 * size * place.y };
                let pixel = size * dice.power([-5.0, -2.0]);
                let steps = [camera.u() * pixel, camera.v() * -pixel];
                let ray = camera.ray_through(stretch.x, stretch.y);
                let ([point, normal], gradients, light) = something_seen(&mut dice, &ray);
                let at_point = DVec2::new(0.3, -7.0);
                let plane = [point, normal];
                let mut hits = HitsAlong::default();
                let Some(first_hit) = FirstHit::new(&view, plane, steps, &stretch)
                    .filter(|hit| hits.go_along(hit, &[light]))
                else {
                    missing += 1;
                    continue;
                };
                found += 1;
                hits.add_texture(&first_hit, (at_point, gradients), point, steps[1]);
                let at_first = hits.texture.as_ref().expect("it was added").at_first;
                let first = [0, 17, 48][case % 3];
                let [x, y, z, across, up, width, height] = at_all_levels(&hits, first);
                for lane in 0..16 {
                    let x_there = stretch.x + pixel * (f64::from(first) + lane as f64);
                    let ray = camera.ray_through(x_there, stretch.y);
                    let [here, moves @ ..] = hit(&view, &ray, plane, steps);
                    let way = Vec3::new(x[lane], y[lane], z[lane]).as_dvec3();
                    let expected = light - here;
                    worst[0] = worst[0].max(way.distance(expected) / expected.length());
                    for k in 0..2 {
                        let value = at_point[k] + gradients[k].dot(here - point);
                        let footprint: f64 =
                            moves.map(|way| gradients[k].dot(way).abs()).iter().sum();
                        let difference = f64::from([across, up][k][lane]);
                        let off = (at_first[k] + difference - value).abs() / footprint;
                        // What `f64` rounds in places that are large beside their footprint is no part of the bound.
                        let of_places =
                            1e-14 * (here.length() + point.length()) * gradients[k].length()
                                / footprint;
                        worst[1] = worst[1].max(off - of_places);
                        let of_footprint = f64::from([width, height][k][lane]) / footprint - 1.0;
                        worst[2] = worst[2].max(of_footprint.abs());
                    }
                }
            }
        }
        println!("{found} found, {missing} missing, off by {worst:?} at most");
        assert!(found > 10_000 && missing > 5_000, "{found}, {missing}");
        assert!(worst[0] < 12.0 * EPSILON && worst[1] < 9.0 * 95.0 * EPSILON, "{worst:?}");
        // The axis is seen in the picture, so that a ray has a cosine of 0.8 with it.
        assert!(worst[2] < 125.0 * EPSILON, "{worst:?}");
    }
}
