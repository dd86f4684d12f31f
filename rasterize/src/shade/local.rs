//! The normals of small triangles: what changes from sample to sample is small, so `f32` is enough, counted from a sample
//! beside the triangle.

use super::weights::{side_of, weights};
use bothways_common::engine::simd::{Simd, SimdBase, SimdNarrow, f32x8, f64x8};
use bothways_common::look::bands::{Anchor, LocalNormals, eight_columns};
use bothways_common::look::lanes::{Lanes, Real, each};
use bothways_common::{Projection, Raster, Sample, View};

/// The samples of a picture as rows and columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    /// From a row to the next, and from a column to the next.
    spacing: [f64; 2],
    /// The row and the column of the viewport's middle.
    middle: [f64; 2],
}

/// The normals of one triangle, or of eight: affine functions of the row and the column, counted from a sample beside the first
/// corner, the anchor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T> {
    /// Row and column of the anchor.
    anchor: [T; 2],
    /// The normal at the anchor, and its changes from there to the next column and to the next row. The interpolated normal
    /// of corners that are all alike has length 1 at the anchor.
    normals: [Lanes<T>; 3],
    /// Above 1, or not a number, where the triangle is not small.
    size: T,
}

/// How far normals may change on a triangle, from its first corner to the others, all changes added up.
const CHANGE: f64 = 1024.0;

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
    /// triangle below half or above twice of that. So normals that are [alike](are_alike) have a sum no shorter than
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
        let to_seen = side * scale;
        let coordinates = each!(at in [[at_a.x, at_b.x, at_c.x], [at_a.y, at_b.y, at_c.y], [at_a.z, at_b.z, at_c.z]] => {
            (of_a * at[0] + of_b * at[1] + of_c * at[2]) * to_seen
        });
        let vector = |of: [T; 3]| {
            let [x, y, z] = of;
            Lanes { x, y, z }
        };
        let normals = [
            vector(each!(k in [0, 1, 2] => coordinates[k].at(x, y))),
            vector(each!(k in [0, 1, 2] => coordinates[k].across * across)),
            vector(each!(k in [0, 1, 2] => coordinates[k].up * -down)),
        ];
        let slopes = each!(of in [coordinates[0], coordinates[1], coordinates[2], together] => {
            of.across.magnitude() * across + of.up.magnitude() * down
        });
        let slope = slopes[0] + slopes[1] + slopes[2];
        let size = depths
            + (slopes[3] * scale).magnitude() * 2.0
            + slope * (reach + 1.0) * (1.0 / CHANGE)
            + (row.magnitude() + column.magnitude()) * (1.0 / Anchor::FARTHEST);
        Local { anchor, normals, size }
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

/// Normals towards the viewer as an affine function of row and column, in `f32`, counted from a sample near the triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct AffineNormals {
    /// The normal at the anchor, and how it changes from a column to the next one, and from a row to the next one.
    numbers: [[f32; 3]; 3],
    anchor: Anchor,
}

// With its material, one line of the caches.
const _: () = assert!(size_of::<AffineNormals>() <= 48);

impl LocalNormals for AffineNormals {
    #[inline(always)]
    fn store<S: Simd>(&self, simd: S, first: Sample, [to_x, to_y, to_z]: [&mut [f32]; 3]) {
        let [rows, mut columns] = self.anchor.steps_to(first);
        let [at_anchor, across, down] = &self.numbers;
        let in_row = each!(k in [0, 1, 2] => at_anchor[k] + down[k] * rows);
        for at in (0..to_x.len()).step_by(8) {
            let places = eight_columns(simd, columns);
            columns += 8.0;
            let [x, y, z] = each!(k in [0, 1, 2] => {
                f32x8::splat(simd, in_row[k]) + f32x8::splat(simd, across[k]) * places
            });
            x.store_slice(&mut to_x[at..at + 8]);
            y.store_slice(&mut to_y[at..at + 8]);
            z.store_slice(&mut to_z[at..at + 8]);
        }
    }
}

impl Local<f64> {
    /// `None` where the triangle is not small.
    #[inline(always)]
    pub(super) fn normals(&self) -> Option<AffineNormals> {
        #[expect(clippy::cast_possible_truncation, reason = "see `Local::new`")]
        let number = |number: f64| number as f32;
        let [at_anchor, across, down] = self.normals;
        let numbers =
            each!(of in [at_anchor, across, down] => [number(of.x), number(of.y), number(of.z)]);
        let anchor = Anchor::new(self.anchor);
        (self.size <= 1.0).then_some(AffineNormals { numbers, anchor })
    }
}

impl<S: Simd> Local<f64x8<S>> {
    /// Gives the normals of the first triangles, so many, to `keep`; `None` for one that is not small.
    #[inline(always)]
    pub(super) fn each_of(&self, used: usize, mut keep: impl FnMut(usize, Option<AffineNormals>)) {
        let [at_anchor, across, down] = self.normals;
        // Two times eight numbers at a time become `f32`.
        let halves = [
            [at_anchor.x, at_anchor.y],
            [at_anchor.z, across.x],
            [across.y, across.z],
            [down.x, down.y],
            [down.z, down.z],
        ];
        let halves = each!(k in [0, 1, 2, 3, 4] => halves[k][0].narrow(halves[k][1]).to_array());
        let [rows, columns] = each!(k in [0, 1] => self.anchor[k].to_array());
        let sizes = self.size.to_array();
        for lane in 0..used {
            let at = lane & 7;
            let number = |k: usize| halves[k / 2][k % 2 * 8 + at];
            let numbers =
                each!(from in [0, 3, 6] => [number(from), number(from + 1), number(from + 2)]);
            let anchor = Anchor::new([rows[at], columns[at]]);
            keep(lane, (sizes[at] <= 1.0).then_some(AffineNormals { numbers, anchor }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{best_level, dispatch};
    use bothways_common::look::bands::are_alike;
    use bothways_common::{Camera, CameraDescription, Scene};
    use bothways_test_support::{Dice, assert_normals_of_a_row, normals_at_corners};
    use glam::{DVec3, Vec3};

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

    impl AffineNormals {
        /// The normal at a sample.
        fn at(&self, sample: Sample) -> Vec3 {
            let [rows, columns] = self.anchor.steps_to(sample);
            let [at_anchor, across, down] = self.numbers.map(Vec3::from);
            (at_anchor + down * rows) + across * columns
        }
    }

    #[test]
    fn normals_of_a_row_have_the_bits_of_each_alone() {
        let numbers = [[0.1, -0.7, 0.7], [0.011, 0.02, -0.031], [-0.017, 0.013, 0.07]];
        let normals = AffineNormals { numbers, anchor: Anchor::new([-3.0, 1000.0]) };
        assert_normals_of_a_row(&normals, |sample| normals.at(sample));
    }

    #[test]
    fn normals_of_small_triangles_are_those_of_f64() {
        let (mut small, mut large, mut worst) = (0, 0, 0.0_f64);
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
                let [corners, normals] = [corners, normals].map(|three| three.map(Lanes::from));
                let Some(local) = Local::new(&view, &grid, corners, normals).normals() else {
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
                        let parts = [0, 1, 2].map(|k| DVec3::from(normals[k]) * weights[k]);
                        let exact = (parts[0] + parts[1] + parts[2]) * side;
                        let found = local.at(Sample { row, column }).as_dvec3();
                        assert!(found.length() > 0.3, "{found}");
                        worst = worst.max(found.normalize().distance(exact.normalize()));
                    }
                }
            }
        }
        println!("{small} small, {large} large, off by {worst:e} at most");
        assert!(small > 5000 && large > 5000, "{small}, {large}");
        assert!(worst < 1e-4, "{worst:e}");
    }

    #[test]
    fn eight_triangles_have_the_bits_of_each_alone() {
        let camera = Camera::new(CameraDescription::default()).unwrap();
        let scene = Scene::new(Vec::new()).unwrap();
        let (view, grid) = (View::new(&scene, &camera), Grid::of(&camera.raster(1)));
        let mut dice = Dice(3);
        for _ in 0..200 {
            let triangles: [_; 8] = std::array::from_fn(|_| triangle(&mut dice));
            let alone = triangles.map(|[corners, normals]| {
                let [corners, normals] = [corners, normals].map(|three| three.map(Lanes::from));
                Local::new(&view, &grid, corners, normals).normals()
            });
            let mut together = Vec::new();
            dispatch!(best_level(), simd => {
                let lanes = |k: usize, corner: usize| {
                    Lanes::<f64x8<_>>::from_fn(simd, |lane| triangles[lane][k][corner])
                };
                let [corners, normals] = [0, 1].map(|k| [lanes(k, 0), lanes(k, 1), lanes(k, 2)]);
                let local = Local::new(&view, &grid, corners, normals);
                local.each_of(8, |_, normals| together.push(normals));
            });
            assert_eq!(format!("{alone:?}"), format!("{together:?}"));
        }
    }
}
