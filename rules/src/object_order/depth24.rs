//! `depth24`: a depth buffer of 24 bits, between a near and a far depth.
//!
//! As programs do that fit both to their scene: *far* is the largest depth of a vertex or sphere, *near* the smallest one
//! in front of the eye, but at least a ten thousandth of *far*. What lies outside, as parts of planes do, gets the nearest
//! depth within and is not cut away. A vertex has its depth in `f32`, from 0 to 1, and the depth of a sample is
//! interpolated in `f32`. Of equal depths the first primitive stays. Coverage is right, in `f64`.

use super::float_edges::{DepthBuffer, FloatEdges, least_depth};
use super::projection::CameraMap;
use crate::samples::{SamplePoint, Samples};
use bothways_common::{Shape, Triangle, View};

/// *Near* is at least this part of *far*.
const LEAST_RATIO: f64 = 1e-4;

pub(super) fn rule<'a>(samples: Samples<'a>, view: &View) -> FloatEdges<'a, f64> {
    let [near, far] = range(&samples, view);
    let depth = DepthBuffer::Fixed24 { near, far };
    FloatEdges { depth, ..FloatEdges::new(samples, SamplePoint::Middle) }
}

/// The near and the far depth.
fn range(samples: &Samples, view: &View) -> [f64; 2] {
    let map = CameraMap::<f64>::new(samples);
    let least = least_depth(samples).max(f64::MIN_POSITIVE);
    let (mut near, mut far) = (f64::INFINITY, least);
    let mut add = |depth: f64| {
        far = far.max(depth);
        if depth > least {
            near = near.min(depth);
        }
    };
    for object in view.scene.objects() {
        match &object.shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                [a, b, c].into_iter().for_each(|&corner| add(map.vertex(corner)[2]));
            }
            Shape::Mesh(mesh) => {
                mesh.positions().iter().for_each(|&position| add(map.vertex(position)[2]));
            }
            Shape::Instances(instances) => {
                let corners = (0..instances.primitive_count()).flat_map(|k| instances.corners(k));
                corners.for_each(|corner| add(map.vertex(corner)[2]));
            }
            Shape::Sphere(sphere) => {
                let depth = map.vertex(sphere.center)[2];
                [-1.0, 1.0]
                    .into_iter()
                    .for_each(|side| add(depth + side * f64::from(sphere.radius)));
            }
            Shape::Plane(plane) => add(map.vertex(plane.point)[2]),
        }
    }
    // A scene of one depth, or none, has room on both sides.
    let far = 1.01 * far;
    [near.clamp(LEAST_RATIO * far, 0.99 * far), far]
}
