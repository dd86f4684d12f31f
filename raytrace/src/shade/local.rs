//! The normals of small triangles where rays hit them, and the ways from there to points of light: beside the ray through the first
//! corner, `f32` is enough.

use super::triangle::{Triangle, side_seen, steps_from_first};
use bothways_common::engine::simd::{Simd, SimdBase, SimdNarrow, f32x8, f64x8};
use bothways_common::look::bands::{
    Anchor, EightVectors, LocalLook, LocalVector, MOST_LIGHTS, eight_columns, local_vector,
};
use bothways_common::look::lanes::{Lanes, Real, each};
use bothways_common::{Projection, Raster, Sample, View};
use glam::DVec3;

/// Where rays hit a triangle, or each of eight, beside the ray through its first corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside<T> {
    corners: [Lanes<T>; 3],
    /// Row and column of the first corner on the raster; it is hardly ever a sample.
    corner: [T; 2],
    /// What [`Beside::new`] calls `q`, and the numerators of the weights of the second and the third corner: their changes from a
    /// column to the next one, and from a row to the next one.
    slopes: [[T; 2]; 3],
    /// How far the numerators of both weights change on the triangle.
    changes: [T; 2],
    /// The normal of the first corner, and what those of the others add to it.
    normals: [Lanes<T>; 3],
    /// Above 1, or not a number, where the triangle is not small.
    size: T,
}

/// How far normals may change on a triangle, from its first corner to the others, the changes of both weights added up.
const CHANGE: f64 = 128.0;
/// How far weights may change on a triangle where normals do not, so that no number in `f32` is infinite.
const STEEPEST: f64 = (1_u64 << 60) as f64;

impl<T: Real> Beside<T> {
    /// Triangles with these corners, relative to the eye, and these unit normals at them, which are alike; `steps` is the way on the
    /// viewport from a sample to the next one across, and to the next one down.
    ///
    /// A ray of direction `D = D₀ + δ` hits the plane through `a = t₀·D₀` with the normal `n` at `t = t₀ / (1 + q)`, where
    /// `q = n·δ / n·D₀`. So it hits the triangle beside `a` by `t·D − a = (t₀·δ − q·a) / (1 + q)`. The weight of a corner is the
    /// product of that with the gradient of the weight: an affine function of `δ`, 0 where `δ` is 0, over `1 + q`. Parallel rays
    /// have one direction `D₀` and begin beside each other by `δ`: they hit the triangle beside `a` by `δ − D₀·(n·δ / n·D₀)`, and
    /// their `q` is 0.
    ///
    /// A triangle is called small where the sum of all that is measured is at most 1: how much farther or nearer than the first
    /// corner the others are, in halves of its depth; how much `q` changes from sample to sample, times its reach, which is the
    /// samples from the first corner to the others and one more; how much the numerators of the weights change, times the reach and
    /// what their corners add to the normal, in [`CHANGE`]; how much they change times the reach, in [`STEEPEST`]; and how far the
    /// first corner is from the picture's middle, in [`Anchor::FARTHEST`]. What is infinite or not a number is not small; nor is a
    /// triangle that reaches behind the eye, as a corner there adds 2 at least. So `1 + q = t₀ / t` is at least ⅔ where a small one
    /// is seen. It may cover many samples, if its depth and its normals hardly change.
    ///
    /// # The error, rounding by rounding
    ///
    /// With `ε = 2⁻²⁴`: rows and columns from the corner are off by `2ε` of the reach at most. In a product with a slope, two
    /// roundings more make it `4ε`; the sum of two makes it `5ε` of their magnitudes. So `1 + q` is off by less than `5ε + 2ε`, a
    /// relative error of `10.5ε`. A weight is off by `5ε` of what its numerator may change, over ⅔, and by `10.5ε` for the
    /// denominator and `2ε` for reciprocal and product: less than `27ε` of that change, and both weights together bring an error of
    /// less than `27ε · 128` to a normal. Where the triangle is seen, weights are at most 1, and no sum is longer than 1; so the
    /// roundings of the three normals, of two products and of two sums bring less than `10ε`. All in all it is less than
    /// 2.1·10⁻⁴, of normals no shorter than 0.6. Mostly it is far less, for normals change by some tenths on a triangle. What is
    /// too small for a normal number of `f32` weighs nothing; nor do the roundings in `f64` before that, unless a triangle is an extreme
    /// sliver, or so far away that only the last digits tell its corners apart.
    #[inline(always)]
    pub(super) fn new(
        view: &View,
        raster: &Raster,
        steps: [DVec3; 2],
        corners: [Lanes<T>; 3],
        normals: [Lanes<T>; 3],
    ) -> Beside<T> {
        let Triangle { a, normal, growth } = Triangle::new(corners);
        let normals = steps_from_first(normals, side_seen(view, a, normal));
        let FirstRay { way, t, places: [at_a, at_b, at_c], depths, turns } =
            FirstRay::new(view, corners);
        let over_plane = t / normal.dot(way);
        let of_q = each!(axis in [0, 1] => normal.along(steps[axis]) * over_plane);
        let numerators = each!(growth in [growth[0], growth[1]] => {
            let along = growth.dot(way);
            each!(axis in [0, 1] => growth.along(steps[axis]) * t - of_q[axis] * along)
        });

        let ([down, across], [middle_row, middle_column]) = (raster.spacing(), raster.middle());
        let [per_row, per_column] = [-1.0 / down, 1.0 / across];
        let [x, y] = at_a;
        let [row, column] = [y * per_row, x * per_column];
        let reaches = each!(place in [at_b, at_c] => {
            (place[0] - x).magnitude() * per_column + (place[1] - y).magnitude() * -per_row
        });
        let reach = reaches[0] + reaches[1] + 1.0;
        let of_q = each!(axis in [0, 1] => of_q[axis] * turns);
        let [from_q, from_b, from_c] = each!(slopes in [of_q, numerators[0], numerators[1]] => {
            (slopes[0].magnitude() + slopes[1].magnitude()) * reach
        });
        let changes = [from_b, from_c];
        let size = depths
            + from_q
            + change(changes, normals) * (1.0 / CHANGE)
            + (from_b + from_c) * (1.0 / STEEPEST)
            + (row.magnitude() + column.magnitude()) * (1.0 / Anchor::FARTHEST);
        Beside {
            corners,
            corner: [row + middle_row, column + middle_column],
            slopes: [of_q, numerators[0], numerators[1]],
            changes,
            normals,
            size,
        }
    }

    /// The way to a point of light, which is relative to the eye: that of the first corner, and what those of the others add to it, in
    /// lengths of the first. With it comes its size, to be added to that of the triangle.
    ///
    /// The size is how far the other corners are from the first, in halves of its way, and how much the numerators of the weights change
    /// times that, in [`CHANGE`]. Lengths here are magnitudes of coordinates, added up. So ways from the triangle are no shorter than ½ and no
    /// longer than 1½, and their error is that of normals (see [`Beside::new`]): less than 2.1·10⁻⁴, or 7.5·10⁻⁴ of the shortest way,
    /// whose length in space is at least 0.28.
    #[inline(always)]
    fn way(&self, light: DVec3) -> ([Lanes<T>; 3], T) {
        let [a, b, c] = self.corners;
        let way = a.way_to(light);
        let nearness = way.size().reciprocal();
        let way = each!(of in [way, a - b, a - c] => of * nearness);
        let apart = (way[1].size() + way[2].size()) * 2.0;
        (way, apart + change(self.changes, way) * (1.0 / CHANGE))
    }
}

/// How much a vector changes with the weights that change so much; the vector of the first corner, and what the others add to it.
#[inline(always)]
fn change<T: Real>([of_b, of_c]: [T; 2], [_, to_b, to_c]: [Lanes<T>; 3]) -> T {
    of_b * to_b.size() + of_c * to_c.size()
}

/// The ray through the first corner of a triangle, or of each of eight.
struct FirstRay<T> {
    /// Its direction; the way from the eye to the corner where rays begin there.
    way: Lanes<T>,
    /// Where it hits the corner, in lengths of its direction; 1 for parallel rays.
    t: T,
    /// The three corners on the viewport.
    places: [[T; 2]; 3],
    /// How much farther or nearer the other corners are, in halves of the first one's depth, added up.
    depths: T,
    /// 1 if other rays have other directions, 0 if they are parallel.
    turns: f64,
}

impl<T: Real> FirstRay<T> {
    #[inline(always)]
    fn new(view: &View, [a, b, c]: [Lanes<T>; 3]) -> FirstRay<T> {
        let camera = view.camera;
        let (ahead, distance) = (-camera.w(), camera.distance());
        let places = each!(corner in [a, b, c] => {
            each!(axis in [camera.u(), camera.v()] => corner.along(axis))
        });
        let depth = a.along(ahead);
        match camera.projection() {
            Projection::Perspective => {
                let farther = each!(corner in [b, c] => (corner - a).along(ahead));
                let scales = each!(depth in [depth, depth + farther[0], depth + farther[1]] => {
                    depth.reciprocal() * distance
                });
                let apart = (farther[0].magnitude() + farther[1].magnitude()) * scales[0];
                FirstRay {
                    way: a,
                    t: depth * (1.0 / distance),
                    places: each!(k in [0, 1, 2] => {
                        [places[k][0] * scales[k], places[k][1] * scales[k]]
                    }),
                    // Before the eye, scales are positive.
                    depths: apart.magnitude() * (2.0 / distance),
                    turns: 1.0,
                }
            }
            Projection::Parallel => {
                let nothing = depth * 0.0;
                let [x, y, z] = each!(axis in [ahead.x, ahead.y, ahead.z] => nothing + axis);
                let way = Lanes { x, y, z };
                FirstRay { way, t: nothing + 1.0, places, depths: nothing, turns: 0.0 }
            }
        }
    }
}

/// Normals towards the viewer where rays hit a small triangle, and the ways to lights from there, in `f32`, counted from its first
/// corner: the vector of that corner, and what those of the others add to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LookAtHits {
    normals: LocalVector,
    /// The sample that is nearest to the first corner, and how many rows and columns the corner is beyond it.
    anchor: Anchor,
    beyond: [f32; 2],
    /// See [`Beside`].
    slopes: [[f32; 2]; 3],
}

impl LocalLook for LookAtHits {
    #[inline(always)]
    fn normals(&self) -> &LocalVector {
        &self.normals
    }

    #[inline(always)]
    fn factors<S: Simd>(&self, simd: S, first: Sample) -> [f32x8<S>; 2] {
        let splat = |number: f32| f32x8::splat(simd, number);
        let [rows, columns] = self.anchor.steps_to(first);
        let [beyond_row, beyond_column] = self.beyond;
        let rows = rows - beyond_row;
        let columns = eight_columns(simd, columns) - splat(beyond_column);
        let [q, of_b, of_c] = &self.slopes;
        let in_row = [1.0 + q[1] * rows, of_b[1] * rows, of_c[1] * rows];
        let [below, of_b, of_c] = each!(k in [0, 1, 2] => {
            splat(in_row[k]) + splat(self.slopes[k][0]) * columns
        });
        let reciprocal = splat(1.0) / below;
        [of_b * reciprocal, of_c * reciprocal]
    }
}

impl Beside<f64> {
    /// The look, for which the ways to lights are written down. `None` where the triangle is not small.
    #[inline(always)]
    pub(super) fn look(&self, lights: &[DVec3], ways: &mut [LocalVector]) -> Option<LookAtHits> {
        #[expect(clippy::cast_possible_truncation, reason = "see `Beside::new`")]
        let number = |number: f64| number as f32;
        let mut size = self.size;
        for (to, light) in ways.iter_mut().zip(lights) {
            let (way, of_way) = self.way(*light);
            *to = local_vector(way);
            size += of_way;
        }
        let nearest = self.corner.map(Real::rounded);
        (size <= 1.0).then(|| LookAtHits {
            normals: local_vector(self.normals),
            anchor: Anchor::new(nearest),
            beyond: each!(k in [0, 1] => number(self.corner[k] - nearest[k])),
            slopes: each!(k in [0, 1, 2] => self.slopes[k].map(number)),
        })
    }
}

impl<S: Simd> Beside<f64x8<S>> {
    /// Gives the looks of the first triangles, so many, and their ways to lights to `keep`; `None` for one that is not small.
    #[inline(always)]
    pub(super) fn each_of(
        &self,
        used: usize,
        lights: &[DVec3],
        mut keep: impl FnMut(usize, Option<LookAtHits>, &[LocalVector; MOST_LIGHTS]),
    ) {
        let mut of_one = [LocalVector::default(); MOST_LIGHTS];
        if lights.is_empty() {
            self.each_look(used, self.size, |lane, look| keep(lane, look, &of_one));
            return;
        }
        let (mut size, mut ways) = (self.size, [EightVectors::ZERO; MOST_LIGHTS]);
        for (to, light) in ways.iter_mut().zip(lights) {
            let (way, of_way) = self.way(*light);
            *to = EightVectors::new(way);
            size += of_way;
        }
        self.each_look(used, size, |lane, look| {
            for (to, ways) in of_one.iter_mut().zip(&ways).take(lights.len()) {
                *to = ways.of(lane);
            }
            keep(lane, look, &of_one);
        });
    }

    /// Gives the looks alone, of triangles of these sizes, which may include those of the ways.
    #[inline(always)]
    fn each_look(
        &self,
        used: usize,
        sizes: f64x8<S>,
        mut keep: impl FnMut(usize, Option<LookAtHits>),
    ) {
        let Beside { corner, slopes: [q, of_b, of_c], normals, .. } = *self;
        let nearest = each!(k in [0, 1] => corner[k].rounded());
        let beyond = each!(k in [0, 1] => corner[k] - nearest[k]);
        let normals = EightVectors::new(normals);
        // Two times eight numbers at a time become `f32`.
        let halves = [beyond, q, of_b, of_c];
        let halves = each!(k in [0, 1, 2, 3] => halves[k][0].narrow(halves[k][1]).to_array());
        let [rows, columns] = each!(k in [0, 1] => nearest[k].to_array());
        let sizes = sizes.to_array();
        for lane in 0..used {
            let at = lane & 7;
            let [beyond, q, of_b, of_c] =
                each!(k in [0, 1, 2, 3] => [halves[k][at], halves[k][8 + at]]);
            let look = LookAtHits {
                normals: normals.of(at),
                anchor: Anchor::new([rows[at], columns[at]]),
                beyond,
                slopes: [q, of_b, of_c],
            };
            keep(lane, (sizes[at] <= 1.0).then_some(look));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};
    use bothways_common::look::bands::are_alike;
    use bothways_common::{Camera, CameraDescription, Scene};
    use bothways_test_support::{
        Dice, assert_vectors_of_a_row, lights_of_a_triangle as lights, normals_at_corners,
    };
    use glam::Vec3;

    /// A triangle, and normals at its corners. The triangle is of any size and thickness, in the picture or beside it; some
    /// reach behind the eye.
    fn triangle(dice: &mut Dice) -> [[DVec3; 3]; 2] {
        let (depth, place) = (dice.power([0.0, 1.0]), dice.vector());
        let a = depth * DVec3::new(0.6 * place.x, 0.4 * place.y, -1.0);
        let (size, thickness) = (dice.power([-3.5, 0.7]), dice.power([-4.0, 0.0]));
        let b = a + size * dice.vector();
        let c = a + (b - a) * f64::from(dice.next()) + thickness * size * dice.vector();
        let change = dice.power([-3.0, 0.0]);
        [[a, b, c], normals_at_corners(dice, change)]
    }

    fn camera(projection: Projection) -> Camera {
        let image = [160, 100];
        Camera::new(CameraDescription { projection, image, ..CameraDescription::default() })
            .unwrap()
    }

    /// What such triangles are on the raster of a view.
    fn beside<T: Real>(view: &View, corners: [Lanes<T>; 3], normals: [Lanes<T>; 3]) -> Beside<T> {
        let raster = view.camera.raster(1);
        let [down, across] = raster.spacing();
        let steps = [view.camera.u() * across, view.camera.v() * -down];
        Beside::new(view, &raster, steps, corners, normals)
    }

    impl LookAtHits {
        /// A vector at a sample.
        fn at(&self, vector: &LocalVector, sample: Sample) -> Vec3 {
            let steps = self.anchor.steps_to(sample);
            let [rows, columns] = [0, 1].map(|k| steps[k] - self.beyond[k]);
            let [q, of_b, of_c] = self.slopes;
            let reciprocal = 1.0 / ((1.0 + q[1] * rows) + q[0] * columns);
            let [b, c] = [of_b, of_c].map(|slopes| slopes[1] * rows + slopes[0] * columns);
            let [at_a, to_b, to_c] = vector.map(Vec3::from);
            at_a + to_b * (b * reciprocal) + to_c * (c * reciprocal)
        }
    }

    /// The normal where the ray through a place of the viewport meets a triangle, and that point, if it does: by other formulas, in
    /// `f64`.
    fn exact(
        camera: &Camera,
        [x, y]: [f64; 2],
        [a, b, c]: [DVec3; 3],
        [at_a, at_b, at_c]: [DVec3; 3],
    ) -> Option<[DVec3; 2]> {
        let ray = camera.ray_through(x, y);
        let n = (b - a).cross(c - a);
        let t = n.dot(a - ray.origin) / n.dot(ray.direction);
        let hit = ray.origin + t * ray.direction;
        let of_b = n.dot((hit - a).cross(c - a)) / n.dot(n);
        let of_c = n.dot((b - a).cross(hit - a)) / n.dot(n);
        let meets = t > 0.0 && of_b >= 0.0 && of_c >= 0.0 && of_b + of_c <= 1.0;
        let normal = at_a + of_b * (at_b - at_a) + of_c * (at_c - at_a);
        let seen = if n.dot(ray.direction) > 0.0 { -normal } else { normal };
        meets.then_some([seen, hit])
    }

    /// Normals, and the ways to two lights: one that is near, and one that is anywhere.
    #[test]
    fn vectors_at_hits_of_small_triangles_are_those_of_f64() {
        let (mut small, mut large, mut samples, mut worst) = (0, 0, 0, [0.0_f64; 3]);
        for projection in [Projection::Perspective, Projection::Parallel] {
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera(projection));
            let view = View::new(&scene, &camera);
            let raster = camera.raster(1);
            let (x, y): (Vec<f64>, Vec<f64>) = (raster.x().collect(), raster.y().collect());
            let mut dice = Dice(projection as u64);
            for _ in 0..20_000 {
                let [corners, normals] = triangle(&mut dice);
                if !are_alike(normals) {
                    continue;
                }
                let lights = lights(&mut dice, corners);
                let [corners_of, normals_of] =
                    [corners, normals].map(|three| three.map(Lanes::from));
                let mut ways = [LocalVector::default(); 2];
                let beside = beside(&view, corners_of, normals_of);
                let Some(look) = beside.look(&lights, &mut ways) else {
                    large += 1;
                    continue;
                };
                small += 1;
                for (row, y) in y.iter().enumerate() {
                    for (column, x) in x.iter().enumerate() {
                        let exact = exact(&camera, [*x, *y], corners, normals);
                        let Some([normal, hit]) = exact else { continue };
                        samples += 1;
                        let exact = [normal, lights[0] - hit, lights[1] - hit];
                        for (k, vector) in [look.normals, ways[0], ways[1]].iter().enumerate() {
                            let found = look.at(vector, Sample { row, column }).as_dvec3();
                            let shortest = if k == 0 { 0.5 } else { 0.28 };
                            assert!(found.length() > shortest, "{found}");
                            let off = found.normalize().distance(exact[k].normalize());
                            worst[k] = worst[k].max(off);
                        }
                    }
                }
            }
        }
        println!("{small} small with {samples} samples, {large} large, off by {worst:?} at most");
        assert!(small > 5000 && large > 5000, "{small}, {large}");
        assert!(samples > 100_000, "{samples}");
        assert!(worst.into_iter().all(|worst| worst < 1e-5), "{worst:?}");
    }

    #[test]
    fn a_triangle_is_not_small_for_a_light_that_is_near_it() {
        let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera(Projection::Perspective));
        let view = View::new(&scene, &camera);
        let corners = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[x, y]| DVec3::new(x, y, -3.0));
        let [corners, normals] = [corners, [DVec3::Z; 3]].map(|three| three.map(Lanes::from));
        let local = beside(&view, corners, normals);
        let is_small = |distance| {
            let lights = [DVec3::new(0.0, 0.0, distance - 3.0)];
            local.look(&lights, &mut [LocalVector::default()]).is_some()
        };
        for distance in [1e30, 1e3, 1.0, 0.5] {
            assert!(is_small(distance), "{distance}");
        }
        for distance in [0.3, 0.01, 0.0] {
            assert!(!is_small(distance), "{distance}");
        }
    }

    #[test]
    fn vectors_of_a_row_have_the_bits_of_each_alone() {
        let normals = [[0.1, -0.7, 0.7], [0.011, 0.02, -0.031], [-0.017, 0.013, 0.07]];
        let look = LookAtHits {
            normals,
            anchor: Anchor::new([-3.0, 1000.0]),
            beyond: [0.31, -0.17],
            slopes: [[0.011, -0.02], [0.3, 0.17], [-0.41, 0.07]],
        };
        assert_vectors_of_a_row(&look, |sample| look.at(&normals, sample));
    }

    #[test]
    fn a_weight_that_f32_cannot_hold_is_left_to_f64() {
        let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera(Projection::Perspective));
        let view = View::new(&scene, &camera);
        for (size, is_small) in [(1e-3, true), (1e-9, true), (1e-41, false)] {
            let corner = |x: f64, y: f64| Lanes::from(DVec3::new(size * x, size * y, -1.0));
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)];
            // Normals that are equal do not change, however much the weights do.
            let look = beside(&view, corners, [Lanes::from(DVec3::Z); 3]).look(&[], &mut []);
            assert_eq!(look.is_some(), is_small, "{size:e}");
            let sample = Sample { row: 49, column: 79 };
            assert!(look.is_none_or(|look| look.at(&look.normals, sample).is_finite()), "{size:e}");
        }
    }

    #[test]
    fn eight_triangles_have_the_bits_of_each_alone() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera(projection));
            let view = View::new(&scene, &camera);
            let mut dice = Dice(3);
            let mut small = 0;
            for count in (0..200).map(|number| number % 3) {
                let triangles: [_; 8] = std::array::from_fn(|_| triangle(&mut dice));
                let lights = &lights(&mut dice, triangles[0][0])[..count];
                let alone = triangles.map(|[corners, normals]| {
                    let [corners, normals] = [corners, normals].map(|three| three.map(Lanes::from));
                    let mut ways = [LocalVector::default(); MOST_LIGHTS];
                    (beside(&view, corners, normals).look(lights, &mut ways), ways)
                });
                for (level, used) in levels().into_iter().zip([8, 3, 7, 1, 8].into_iter().cycle()) {
                    let mut together = Vec::new();
                    dispatch!(level, simd => {
                        let lanes = |k: usize, corner: usize| {
                            Lanes::<f64x8<_>>::from_fn(simd, |lane| triangles[lane][k][corner])
                        };
                        let [corners, normals] = [0, 1].map(|k| [lanes(k, 0), lanes(k, 1), lanes(k, 2)]);
                        let beside = beside(&view, corners, normals);
                        beside.each_of(used, lights, |_, look, ways| together.push((look, *ways)));
                    });
                    assert_eq!(format!("{:?}", &alone[..used]), format!("{together:?}"));
                }
                small += alone.iter().filter(|(look, _)| look.is_some()).count();
            }
            assert!(small > 300, "{small}");
        }
    }
}
