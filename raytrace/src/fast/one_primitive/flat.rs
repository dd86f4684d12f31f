//! A triangle or plane alone, set up with twice as many digits: edge functions and key as affine functions of the
//! viewport. So it is drawn sixteen samples at a time, however near it is to being edge-on.

use crate::fast::camera_map::CameraMap;
use crate::fast::high_precision::DoubleDouble;
use crate::fast::viewport_affine::{RayAffine, ViewportAffine};
use bothways_common::engine::roundoff::EPS53;
use bothways_common::{Camera, Primitive, Projection};
use glam::DVec3;
use std::collections::HashMap;

/// Edge functions and key of a flat primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlatFunctions {
    /// All positive where the line of the ray passes inside; of a perspective camera, in front of the eye.
    pub(crate) edges: [ViewportAffine; 3],
    /// Larger for what is nearer, as [`KeyScale`](crate::fast::depth::KeyScale) says.
    pub(crate) key: ViewportAffine,
}

impl FlatFunctions {
    /// Those of a primitive; `None` if the sign of its facing is not certain: nearly always it is zero then, and the
    /// primitive covers nothing.
    ///
    /// The ray crosses the plane at `t = p/q` with `p = n·(a − O)` and `q = n·D`. Of a perspective camera, `p` is the
    /// same for all rays, and `1/t = n·D/p`; of a parallel one, `q` is, and `−t = (n·O − n·a)/q`. That number is
    /// the facing of a triangle, by whose sign edge functions are positive inside.
    pub(crate) fn new(map: &CameraMap, primitive: &Primitive) -> Option<FlatFunctions> {
        let camera = map.view.camera;
        let flat = match primitive {
            Primitive::Triangle(corners) => Flat::of_triangle(camera, corners),
            Primitive::Plane { point, normal } => Flat::of_plane(camera, *point, *normal),
            Primitive::Sphere { .. } => return None,
        };
        let Flat { facing, normal, height, edges } = flat;
        // The facing is off by its own error and its lesser half.
        let relative = facing.error / facing.high.abs() + EPS53;
        let is_certain = relative < 1.0 / 16.0;
        if !is_certain {
            return None;
        }
        let scale = map.depth.scale;
        let (constant, factor) = match camera.projection() {
            Projection::Perspective => (DoubleDouble::ZERO, 1.0 / (facing.high * scale)),
            Projection::Parallel => (-height, scale / facing.high),
        };
        let key = ViewportAffine::of_rays(camera, &RayAffine { normal, constant });
        let sign = facing.high.signum();
        let edges = match (edges, camera.projection()) {
            (Some(edges), _) => {
                edges.map(|edge| ViewportAffine::of_rays(camera, &edge).times(sign, 0.0))
            }
            // In front of the eye `n·D` has the sign of `p`.
            (None, Projection::Perspective) => [key.times(sign, 0.0); 3],
            (None, Projection::Parallel) => [ViewportAffine::ONE; 3],
        };
        // Two roundings of the factor, and those of its bound.
        Some(FlatFunctions { edges, key: key.times(factor, relative + 4.0 * EPS53) })
    }
}

/// The functions of the triangles that were set up last.
#[derive(Debug, Default)]
pub(crate) struct FlatCache {
    functions: HashMap<u32, Option<FlatFunctions>>,
}

impl FlatCache {
    /// It holds this many triangles, some megabytes, and is emptied when it is full.
    const MOST: usize = 1 << 14;

    /// Forgets all triangles: from here on, a name may mean another one.
    pub(crate) fn forget(&mut self) {
        self.functions.clear();
    }

    /// The functions of a triangle with a name, which must always mean the same one.
    pub(crate) fn get(
        &mut self,
        id: u32,
        new: impl FnOnce() -> Option<FlatFunctions>,
    ) -> Option<&FlatFunctions> {
        if self.functions.len() >= Self::MOST {
            self.functions.clear();
        }
        self.functions.entry(id).or_insert_with(new).as_ref()
    }
}

/// What is the same for all rays.
struct Flat {
    /// `p` of a perspective camera, `q` of a parallel one.
    facing: DoubleDouble,
    normal: [DoubleDouble; 3],
    /// `n·a`.
    height: DoubleDouble,
    /// The edge functions of a triangle, which have the sign of the facing inside.
    edges: Option<[RayAffine; 3]>,
}

impl Flat {
    /// `E_ab = det(a − O, b − O, D)` is `(a × b)·D` of a perspective camera, where `O = 0`, and of a parallel one
    /// `((a − b) × D)·O + (a × b)·D`. `n = a × b + b × c + c × a`, and `n·a = (a × b)·c`.
    ///
    /// Corners are exact, so what of their products nearly cancels keeps its digits.
    fn of_triangle(camera: &Camera, corners: &[DVec3; 3]) -> Flat {
        let [a, b, c] = *corners;
        let pairs = [(a, b), (b, c), (c, a)];
        let crosses = pairs.map(|(p, q)| cross([(p, q)]));
        let normal = cross(pairs);
        let height = dot(&crosses[0], c);
        let forward = -camera.w();
        let (facing, edges) = match camera.projection() {
            Projection::Perspective => {
                let edges =
                    crosses.map(|normal| RayAffine { normal, constant: DoubleDouble::ZERO });
                (height, edges)
            }
            Projection::Parallel => {
                let edge = |k: usize| {
                    let (p, q) = pairs[k];
                    let normal = cross([(p, forward), (-q, forward)]);
                    RayAffine { normal, constant: dot(&crosses[k], forward) }
                };
                (dot(&normal, forward), [edge(0), edge(1), edge(2)])
            }
        };
        Flat { facing, normal, height, edges: Some(edges) }
    }

    fn of_plane(camera: &Camera, point: DVec3, normal: DVec3) -> Flat {
        let normal = normal.to_array().map(DoubleDouble::exact);
        let height = dot(&normal, point);
        let facing = match camera.projection() {
            Projection::Perspective => height,
            Projection::Parallel => dot(&normal, -camera.w()),
        };
        Flat { facing, normal, height, edges: None }
    }
}

/// The sum of cross products.
fn cross<const N: usize>(pairs: [(DVec3, DVec3); N]) -> [DoubleDouble; 3] {
    std::array::from_fn(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let products =
            pairs.into_iter().flat_map(|(p, q)| [(p[next], q[last]), (-p[last], q[next])]);
        DoubleDouble::sum_of_products(products)
    })
}

/// The inner product of a vector that may be off, and an exact one.
fn dot(p: &[DoubleDouble; 3], q: DVec3) -> DoubleDouble {
    let products = [0, 1, 2].into_iter().flat_map(|k| [(p[k].high, q[k]), (p[k].low, q[k])]);
    let carried: f64 = (0..3).map(|k| p[k].error * q[k].abs()).sum();
    let mut sum = DoubleDouble::sum_of_products(products);
    sum.error += 1.01 * carried;
    sum
}
