//! The bounding regions of primitives: the samples that they may cover.

mod clip;

use super::camera_map::CameraMap;
use super::depth::{depth_plane, sign_in_front};
use super::viewport_affine::ViewportAffine;
use bothways_common::engine::fault::Fault;
use bothways_common::raster::Region;
use bothways_common::{Primitive, Projection};
use glam::DVec3;

/// The samples that any primitive may cover.
pub(super) fn region<F: Fault>(primitive: &Primitive, map: &CameraMap) -> Region {
    match primitive {
        Primitive::Triangle(corners) => triangle_region::<F>(map, corners),
        Primitive::Sphere { center, radius } => sphere_region::<F>(map, *center, *radius),
        Primitive::Plane { point, normal } => {
            plane_region(map, &depth_plane(map, *point, *normal, normal.abs()))
        }
    }
}

/// The samples that a triangle may cover; `corners` are its offsets from the eye.
fn triangle_region<F: Fault>(map: &CameraMap, corners: &[DVec3; 3]) -> Region {
    let vertices = corners.map(|corner| map.vertex(corner));
    if vertices.iter().all(|vertex| vertex.behind) {
        // All of it lies behind: with t > 0 no ray gets there.
        return Region { rows: 0..0, columns: 0..0 };
    }
    let [Some(a), Some(b), Some(c)] = vertices.map(|vertex| vertex.place) else {
        return match map.projection() {
            Projection::Perspective if map.is_within(0.0625) => clip::region(map, corners),
            _ => map.whole(),
        };
    };
    let both = |least: fn(f64, f64) -> f64| {
        [least(least(a[0], b[0]), c[0]), least(least(a[1], b[1]), c[1])]
    };
    map.region::<F>(both(f64::min), both(f64::max), map.margin)
}

/// The samples that a sphere may cover.
///
/// Perspective: in the plane of `u` and `w` its silhouette is the two tangents from the eye to a
/// circle around `(c_u, ζ)`, of slopes `(c_u·ζ ± r·√(c_u² + ζ² − r²))/(ζ² − r²)`. The slope is trusted if `ζ −
/// r ≥ 2⁻¹⁰·s` with `s = ‖c‖₁ + r`: then `ζ² − r²` carries `2⁻³⁹` of itself and is at least `2⁻²⁰·s²`,
/// the numerator carries `2⁻⁴⁸·s²`, and the slope is off by `2⁻²⁷` of `1 + |slope|`. The extra
/// margin takes `2⁻²⁴`.
fn sphere_region<F: Fault>(map: &CameraMap, center: DVec3, radius: f64) -> Region {
    let (s, depth) = (center.abs().element_sum() + radius, -center.dot(map.w));
    if depth + radius < -s * (-46f64).exp2() {
        return Region { rows: 0..0, columns: 0..0 };
    }
    let relative = map.local.relative(center);
    let along = [relative.dot(map.u), relative.dot(map.v)];
    match map.projection() {
        Projection::Perspective if depth - radius >= s * (-10f64).exp2() => {
            let (between, d) = ((depth - radius) * (depth + radius), map.distance);
            let slopes = along.map(|c| {
                let root = radius * (c * c + between).sqrt();
                [(c * depth - root) / between, (c * depth + root) / between]
            });
            let [[left, right], [bottom, top]] = slopes.map(|pair| pair.map(|slope| slope * d));
            let extra = |axis: usize| {
                let count = f64::from(map.raster.size()[axis]);
                (-24f64).exp2() * (d * map.scale[axis].abs() + count)
            };
            let margin = [map.margin[0] + extra(0), map.margin[1] + extra(1)];
            map.region::<F>(map.place(left, top), map.place(right, bottom), margin)
        }
        Projection::Parallel if relative.abs().element_sum() + radius <= map.trusted_extent => {
            let low = map.place(along[0] - radius, along[1] + radius);
            let high = map.place(along[0] + radius, along[1] - radius);
            map.region::<F>(low, high, map.margin)
        }
        _ => map.whole(),
    }
}

/// The samples beyond a plane's horizon, where its depth says that `t` may be positive.
fn plane_region(map: &CameraMap, depth: &ViewportAffine) -> Region {
    let (x, y) = (map.grid.x(), map.grid.y());
    let side = sign_in_front(map.projection());
    let widest = x.last().map_or(0.0, |x| x.abs()) * depth.across.abs();
    let highest = y.first().map_or(0.0, |y| y.abs()) * depth.up.abs();
    let eye = map.depth_of_eye();
    let least = eye - depth.error - (-50f64).exp2() * eye.abs();
    let may = |value: f64, rest: f64| {
        let most = side * value + rest;
        most >= least || most.is_nan()
    };
    let row = |row: &usize| may(depth.at_center + y[*row] * depth.up, widest);
    let column = |column: &usize| may(depth.at_center + x[*column] * depth.across, highest);
    // On a row the largest value over all columns is affine in the row, so those that pass are
    // consecutive.
    let span = |count: usize, passes: &dyn Fn(&usize) -> bool| {
        let first = (0..count).find(passes).unwrap_or(count);
        let end = (first..count).rev().find(passes).map_or(first, |last| last + 1);
        first..end
    };
    Region { rows: span(y.len(), &row), columns: span(x.len(), &column) }
}
