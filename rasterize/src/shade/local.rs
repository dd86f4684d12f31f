//! The normals of small triangles, and their ways to points of light: what changes from sample to sample is small, so `f32` is
//! enough, counted from a sample beside the triangle.

use super::quotient::Affine;
use super::weights::{side_of, weights};
use bothways_common::engine::simd::{Simd, SimdBase, f32x8, f64x8};
use bothways_common::look::bands::{
    Anchor, EightVectors, LocalLook, LocalVector, MOST_LIGHTS, eight_columns, local_vector,
};
use bothways_common::look::lanes::{Lanes, Real, each};
use bothways_common::{Projection, Raster, Sample, View};
use glam::DVec3;

/// The samples of a picture as rows and columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// From a row to the next, and from a column to the next.
    spacing: [f64; 2],
    /// The row and the column of the viewport's middle.
    middle: [f64; 2],
}

/// What is interpolated on one triangle, or on eight: affine functions of the row and the column, counted from a sample beside the
/// first corner, the anchor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T> {
    corners: [Lanes<T>; 3],
    interpolation: Interpolation<T>,
    /// The sum of all weights is 1 at the anchor after it is multiplied by this.
    scale: T,
    /// Row and column of the anchor.
    anchor: [T; 2],
    /// No fewer than the rows and columns from the anchor to the corners, added up.
    reach: T,
    /// The interpolated normal of corners that are all alike has length 1 at the anchor.
    normals: [Lanes<T>; 3],
    /// Above 1, or not a number, where the triangle is not small.
    size: T,
}

/// How vectors at the corners of a triangle, or of eight, are interpolated beside an anchor.
#[derive(Clone, Copy, Debug)]
struct Interpolation<T> {
    weights: [Affine<T>; 3],
    /// The anchor on the viewport.
    anchor: [T; 2],
    /// From a row to the next, and from a column to the next.
    spacing: [f64; 2],
}

/// How far normals may change on a triangle, from its first corner to the others, all changes added up.
const CHANGE: f64 = 1024.0;
/// How far ways to a light may change, in the length of the first corner's.
const CHANGE_OF_WAYS: f64 = 256.0;

impl Grid {
    pub(super) fn of(raster: &Raster) -> Grid {
        Grid { spacing: raster.spacing(), middle: raster.middle() }
    }

    /// The way from a sample to the next one down, along `y`, and to the next one across, along `x`.
    #[inline(always)]
    pub(super) fn step(&self) -> [f64; 2] {
        let [down, across] = self.spacing;
        [-down, across]
    }
}

impl<T: Real> Local<T> {
    /// The interpolated normals of triangles with these corners, relative to the eye, and these unit normals at them.
    ///
    /// A triangle is small where the sum of all that is measured is at most 1: how much farther or nearer than the first corner the
    /// others are, in halves of its depth; how much the sum of weights changes from sample to sample, in halves of what it is at the
    /// anchor; how much the normals change from sample to sample, times the samples from corner to corner, in [`CHANGE`];
    /// and how far the anchor is, in [`Anchor::FARTHEST`]. What is infinite or not a number is not small; nor is a triangle that reaches behind
    /// the eye, as a corner there measures 2 at least.
    ///
    /// Then the sum of the weights is positive at the anchor, which is half a sample beside the corner at most, and nowhere on the
    /// triangle below half or above twice of that. So normals that are [alike](bothways_common::look::bands::are_alike) have a sum no shorter than
    /// 0.3 and no longer than 2.
    ///
    /// # The error, rounding by rounding
    ///
    /// `N = (A + r·D) + c·C`, with the normal `A` at the anchor, `r` rows and `c` columns from there, and the changes `D` and `C` from row to
    /// row and from column to column. With `ε = 2⁻²⁴`, rounding `A` to `f32` adds `ε|A|`; that of `D` and its product `2ε|rD|`; the first
    /// sum `ε|A + rD|`; that of `C` and its product `2ε|cC|`; the second sum `ε|N|`. As `|A| ≤ |N| + |rD| + |cC|` and
    /// `|A + rD| ≤ |N| + |cC|`, all this is at most `ε(3|N| + 3|rD| + 4|cC|)`, and with `|rD| + |cC| ≤ 1024`, all coordinates
    /// together, less than 2.5·10⁻⁴: a thousandth of the shortest sum. Mostly it is far less, for normals change by some tenths on a
    /// triangle. The roundings in `f64` before that weigh nothing, unless a triangle is an extreme sliver.
    #[inline(always)]
    pub(super) fn new(
        view: &View,
        grid: &Grid,
        [a, b, c]: [Lanes<T>; 3],
        [at_a, at_b, at_c]: [Lanes<T>; 3],
    ) -> Local<T> {
        let ([down, across], [middle_row, middle_column]) = (grid.spacing, grid.middle);
        let OnViewport { place: [x, y], depths, reach } = OnViewport::new(view, grid, [a, b, c]);
        let anchor = [
            (y * (-1.0 / down) + middle_row).rounded(),
            (x * (1.0 / across) + middle_column).rounded(),
        ];
        let [row, column] = [anchor[0] + -middle_row, anchor[1] + -middle_column];
        let [x, y] = [column * across, row * -down];

        // The surface, not its smooth look, says which side is seen.
        let side = side_of(view, a, (b - a).cross(c - a));
        let [of_a, of_b, of_c] = weights(view, [a, b, c], side);
        let together = of_a + of_b + of_c;
        let scale = together.at(x, y).reciprocal();
        let interpolation =
            Interpolation { weights: [of_a, of_b, of_c], anchor: [x, y], spacing: grid.spacing };
        let (normals, change) = interpolation.of([at_a, at_b, at_c], side * scale);
        let reach = reach + 1.0;
        let size = depths
            + (interpolation.change(together) * scale).magnitude() * 2.0
            + change * reach * (1.0 / CHANGE)
            + (row.magnitude() + column.magnitude()) * (1.0 / Anchor::FARTHEST);
        Local { corners: [a, b, c], interpolation, scale, anchor, reach, normals, size }
    }

    /// The way to a point of light, which is relative to the eye: interpolated like a normal, from the corners' ways. With it comes
    /// its size, to be added to that of the triangle.
    ///
    /// The size is how much longer or shorter than the first corner's way the others may be, in halves of its length, and how much the
    /// way changes from sample to sample, times the samples from corner to corner, in [`CHANGE_OF_WAYS`]. Lengths here are magnitudes of
    /// coordinates, added up. So in lengths of the first corner's, ways from the triangle are no shorter than ½, and, as the sum of the
    /// weights is no smaller than ½ and no larger than 2, what is interpolated is no shorter than ¼ and no longer than 3.
    ///
    /// The error is that of normals (see [`Local::new`]): at most `ε(3|N| + 3|rD| + 4|cC|)`, with `|rD| + |cC| ≤ 256` no more than
    /// `ε(3·3 + 4·256)`, which is less than 6.2·10⁻⁵, all coordinates together, or 4.5·10⁻⁴ of the shortest way, whose length in space is at
    /// least 0.14.
    #[inline(always)]
    fn way(&self, light: DVec3) -> ([Lanes<T>; 3], T) {
        let [a, b, c] = self.corners;
        let ways = each!(corner in [a, b, c] => corner.way_to(light));
        let nearness = ways[0].size().reciprocal();
        let (vectors, change) = self.interpolation.of(ways, self.scale * nearness);
        let apart = ((b - a).size() + (c - a).size()) * nearness * 2.0;
        (vectors, apart + change * self.reach * (1.0 / CHANGE_OF_WAYS))
    }
}

impl<T: Real> Interpolation<T> {
    /// The interpolated vector at the anchor, and its changes from there to the next row and to the next column, all times a factor; and
    /// the sum of the changes of all coordinates.
    #[inline(always)]
    fn of(&self, [a, b, c]: [Lanes<T>; 3], factor: T) -> ([Lanes<T>; 3], T) {
        let ([of_a, of_b, of_c], [down, across], [x, y]) =
            (self.weights, self.spacing, self.anchor);
        let coordinates = each!(at in [[a.x, b.x, c.x], [a.y, b.y, c.y], [a.z, b.z, c.z]] => {
            (of_a * at[0] + of_b * at[1] + of_c * at[2]) * factor
        });
        let vector = |of: [T; 3]| {
            let [x, y, z] = of;
            Lanes { x, y, z }
        };
        let vectors = [
            vector(each!(k in [0, 1, 2] => coordinates[k].at(x, y))),
            vector(each!(k in [0, 1, 2] => coordinates[k].up * -down)),
            vector(each!(k in [0, 1, 2] => coordinates[k].across * across)),
        ];
        let changes = each!(k in [0, 1, 2] => self.change(coordinates[k]));
        (vectors, changes[0] + changes[1] + changes[2])
    }

    /// How much a function changes from a column to the next and from a row to the next, both added up.
    #[inline(always)]
    fn change(&self, of: Affine<T>) -> T {
        let [down, across] = self.spacing;
        of.across.magnitude() * across + of.up.magnitude() * down
    }
}

/// Where triangles are seen.
struct OnViewport<T> {
    /// The first corner on the viewport.
    place: [T; 2],
    /// How much farther or nearer the other corners are, in halves of the first one's depth, added up.
    depths: T,
    /// No fewer than the rows and columns from there to the other corners, added up, if their depth is at least half of
    /// that of the first one.
    reach: T,
}

impl<T: Real> OnViewport<T> {
    #[inline(always)]
    fn new(view: &View, grid: &Grid, [a, b, c]: [Lanes<T>; 3]) -> OnViewport<T> {
        let camera = view.camera;
        let [down, across] = grid.spacing;
        let ahead = -camera.w();
        let [x, y, depth] = each!(axis in [camera.u(), camera.v(), ahead] => a.along(axis));
        let edges = each!(corner in [b, c] => {
            let edge = corner - a;
            each!(axis in [camera.u(), camera.v(), ahead] => edge.along(axis))
        });
        match camera.projection() {
            Projection::Perspective => {
                let nearness = depth.reciprocal();
                let scale = nearness * camera.distance();
                let [x, y] = [x * scale, y * scale];
                // A corner of half the depth is twice as far away as one of the same depth.
                let to = each!(edge in [edges[0], edges[1]] => {
                    let [along_u, along_v, farther] = edge;
                    let farther = farther * nearness;
                    let columns = (along_u * scale - x * farther).magnitude() * (2.0 / across);
                    let rows = (along_v * scale - y * farther).magnitude() * (2.0 / down);
                    (farther.magnitude() * 2.0, columns + rows)
                });
                OnViewport { place: [x, y], depths: to[0].0 + to[1].0, reach: to[0].1 + to[1].1 }
            }
            Projection::Parallel => {
                let to = each!(edge in [edges[0], edges[1]] => {
                    edge[0].magnitude() * (1.0 / across) + edge[1].magnitude() * (1.0 / down)
                });
                // Depths make no difference to where anything is seen.
                OnViewport { place: [x, y], depths: to[0] * 0.0, reach: to[0] + to[1] }
            }
        }
    }
}

/// Normals towards the viewer and ways to lights as affine functions of row and column, in `f32`, counted from a sample near the
/// triangle: a vector at the anchor, and how it changes from a row to the next one, and from a column to the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct AffineLook {
    normals: LocalVector,
    anchor: Anchor,
}

// With its material and the place of its ways, one line of the caches.
const _: () = assert!(size_of::<AffineLook>() <= 48);

impl LocalLook for AffineLook {
    #[inline(always)]
    fn normals(&self) -> &LocalVector {
        &self.normals
    }

    #[inline(always)]
    fn factors<S: Simd>(&self, simd: S, first: Sample) -> [f32x8<S>; 2] {
        let [rows, columns] = self.anchor.steps_to(first);
        [f32x8::splat(simd, rows), eight_columns(simd, columns)]
    }
}

impl Local<f64> {
    /// Its look, for which the ways to lights are written down. `None` where the triangle is not small.
    #[inline(always)]
    pub(super) fn look(&self, lights: &[DVec3], ways: &mut [LocalVector]) -> Option<AffineLook> {
        let mut size = self.size;
        for (to, light) in ways.iter_mut().zip(lights) {
            let (way, of_way) = self.way(*light);
            *to = local_vector(way);
            size += of_way;
        }
        let (normals, anchor) = (local_vector(self.normals), Anchor::new(self.anchor));
        (size <= 1.0).then_some(AffineLook { normals, anchor })
    }
}

impl<S: Simd> Local<f64x8<S>> {
    /// Gives the looks of the first triangles, so many, and their ways to lights to `keep`; `None` for one that is not small.
    #[inline(always)]
    pub(super) fn each_of(
        &self,
        used: usize,
        lights: &[DVec3],
        mut keep: impl FnMut(usize, Option<AffineLook>, &[LocalVector; MOST_LIGHTS]),
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
        mut keep: impl FnMut(usize, Option<AffineLook>),
    ) {
        let normals = EightVectors::new(self.normals);
        let [rows, columns] = each!(k in [0, 1] => self.anchor[k].to_array());
        let sizes = sizes.to_array();
        for lane in 0..used {
            let at = lane & 7;
            let anchor = Anchor::new([rows[at], columns[at]]);
            let look = AffineLook { normals: normals.of(at), anchor };
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

    /// A point before the eye, in the picture or beside it.
    fn place(dice: &mut Dice, depth: f64) -> DVec3 {
        let place = dice.vector();
        depth * DVec3::new(0.3 * place.x, 0.2 * place.y, -1.0)
    }

    /// A triangle, and normals at its corners. It is of any size and often thin, or has corners of very different depths, or
    /// is seen almost edge-on, or a part of it is behind the eye.
    fn triangle(dice: &mut Dice) -> [[DVec3; 3]; 2] {
        let near = 3.0 + f64::from(dice.next());
        let a = place(dice, near);
        let [size, width, depth] = [[-3.5, 0.5], [-6.0, 0.0], [-0.5, 1.5]].map(|of| dice.power(of));
        let (kind, part) = (dice.next(), f64::from(dice.next()));
        let beside = size * dice.vector();
        let c = if kind < -0.5 {
            a + beside * part + width * size * dice.vector()
        } else if kind < 0.0 {
            place(dice, depth)
        } else if kind < 0.5 {
            a * (1.0 + 0.2 * part) + 0.1 * width * dice.vector()
        } else {
            -depth * dice.vector()
        };
        let b = if (-0.5..0.0).contains(&kind) { place(dice, depth) } else { a + beside };
        let change = dice.power([-3.0, 0.0]);
        [[a, b, c], normals_at_corners(dice, change)]
    }

    impl AffineLook {
        /// A vector at a sample.
        fn at(&self, vector: &LocalVector, sample: Sample) -> Vec3 {
            let [rows, columns] = self.anchor.steps_to(sample);
            let [at_anchor, down, across] = vector.map(Vec3::from);
            (at_anchor + down * rows) + across * columns
        }
    }

    #[test]
    fn vectors_of_a_row_have_the_bits_of_each_alone() {
        let normals = [[0.1, -0.7, 0.7], [0.011, 0.02, -0.031], [-0.017, 0.013, 0.07]];
        let look = AffineLook { normals, anchor: Anchor::new([-3.0, 1000.0]) };
        assert_vectors_of_a_row(&look, |sample| look.at(&normals, sample));
    }

    /// Normals, and the ways to two lights: one that is near, and one that is anywhere.
    #[test]
    fn vectors_of_small_triangles_are_those_of_f64() {
        let (mut small, mut large, mut worst) = (0, 0, [0.0_f64; 3]);
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = Camera::new(CameraDescription {
                projection,
                image: [160, 100],
                ..CameraDescription::default()
            });
            let (scene, camera) = (Scene::new(Vec::new()).unwrap(), camera.unwrap());
            let (view, raster) = (View::new(&scene, &camera), camera.raster(1));
            let grid = Grid::of(&raster);
            let (x, y): (Vec<f64>, Vec<f64>) = (raster.x().collect(), raster.y().collect());
            let mut dice = Dice(projection as u64);
            for _ in 0..20_000 {
                let [corners, normals] = triangle(&mut dice);
                if !are_alike(normals) {
                    continue;
                }
                let lights = lights(&mut dice, corners);
                let [corners, normals] = [corners, normals].map(|three| three.map(Lanes::from));
                let mut ways = [LocalVector::default(); 2];
                let look = Local::new(&view, &grid, corners, normals).look(&lights, &mut ways);
                let Some(look) = look else {
                    large += 1;
                    continue;
                };
                small += 1;
                let [a, b, c] = corners;
                let side = side_of(&view, a, (b - a).cross(c - a));
                let weights = weights(&view, corners, side);
                for (row, y) in y.iter().enumerate() {
                    for (column, x) in x.iter().enumerate() {
                        let weights = weights.map(|weight| weight.at(*x, *y));
                        if weights.iter().any(|weight| *weight < 0.0) {
                            continue;
                        }
                        let sum = |of: [DVec3; 3]| {
                            of[0] * weights[0] + of[1] * weights[1] + of[2] * weights[2]
                        };
                        let exact = [
                            sum(normals.map(DVec3::from)) * side,
                            sum(corners.map(|corner| lights[0] - DVec3::from(corner))),
                            sum(corners.map(|corner| lights[1] - DVec3::from(corner))),
                        ];
                        for (k, vector) in [look.normals, ways[0], ways[1]].iter().enumerate() {
                            let found = look.at(vector, Sample { row, column }).as_dvec3();
                            let shortest = if k == 0 { 0.3 } else { 0.14 };
                            assert!(found.length() > shortest, "{found}");
                            let off = found.normalize().distance(exact[k].normalize());
                            worst[k] = worst[k].max(off);
                        }
                    }
                }
            }
        }
        println!("{small} small, {large} large, off by {worst:?} at most");
        assert!(small > 5000 && large > 5000, "{small}, {large}");
        assert!(worst.into_iter().all(|worst| worst < 1e-5), "{worst:?}");
    }

    #[test]
    fn a_triangle_is_not_small_for_a_light_that_is_near_it() {
        let camera = Camera::new(CameraDescription::default()).unwrap();
        let scene = Scene::new(Vec::new()).unwrap();
        let (view, grid) = (View::new(&scene, &camera), Grid::of(&camera.raster(1)));
        let corners = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(|[x, y]| DVec3::new(x, y, -3.0));
        let [corners, normals] = [corners, [DVec3::Z; 3]].map(|three| three.map(Lanes::from));
        let local = Local::new(&view, &grid, corners, normals);
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
    fn eight_triangles_have_the_bits_of_each_alone() {
        let camera = Camera::new(CameraDescription::default()).unwrap();
        let scene = Scene::new(Vec::new()).unwrap();
        let (view, grid) = (View::new(&scene, &camera), Grid::of(&camera.raster(1)));
        let mut dice = Dice(3);
        let mut small = 0;
        for count in (0..200).map(|number| number % 3) {
            let triangles: [_; 8] = std::array::from_fn(|_| triangle(&mut dice));
            let lights = &lights(&mut dice, triangles[0][0])[..count];
            let alone = triangles.map(|[corners, normals]| {
                let [corners, normals] = [corners, normals].map(|three| three.map(Lanes::from));
                let mut ways = [LocalVector::default(); MOST_LIGHTS];
                (Local::new(&view, &grid, corners, normals).look(lights, &mut ways), ways)
            });
            for (level, used) in levels().into_iter().zip([8, 3, 7, 1, 8].into_iter().cycle()) {
                let mut together = Vec::new();
                dispatch!(level, simd => {
                    let lanes = |k: usize, corner: usize| {
                        Lanes::<f64x8<_>>::from_fn(simd, |lane| triangles[lane][k][corner])
                    };
                    let [corners, normals] = [0, 1].map(|k| [lanes(k, 0), lanes(k, 1), lanes(k, 2)]);
                    let local = Local::new(&view, &grid, corners, normals);
                    local.each_of(used, lights, |_, look, ways| together.push((look, *ways)));
                });
                assert_eq!(format!("{:?}", &alone[..used]), format!("{together:?}"));
            }
            small += alone.iter().filter(|(look, _)| look.is_some()).count();
        }
        assert!(small > 200, "{small}");
    }
}
