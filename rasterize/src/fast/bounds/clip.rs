//! The bounding region of a triangle that reaches to the eye's plane or behind it: the triangle is clipped, and the
//! corners of the rest are projected.
//!
//! Only the region comes from here. Which samples of it the triangle covers is decided by the triangle's own edge
//! functions, unclipped.

use crate::fast::camera_map::CameraMap;
use bothways_common::engine::fault::Sound;
use bothways_common::raster::Region;
use glam::{DVec3, DVec4};

/// The samples that a triangle may cover in the picture of a perspective camera whose frame and rays
/// are rounded by at most a sixteenth of a sample.
///
/// The triangle is cut by the four planes through the eye and the borders of the picture, each moved
/// outwards by one sample (Sutherland and Hodgman, "Reentrant Polygon Clipping", Communications of the
/// ACM 17, 1974), and the corners of the rest are projected.
///
/// # Why rounding loses no sample
///
/// A point is `(column·ζ, row·ζ, ζ)` here, `ζ` its depth; a plane's function is, for a point in sight, at
/// least `ζ > 0`. Let `L` be the largest such number of the corners, with rows and columns counted from
/// the picture's border. A corner's numbers carry a few roundings of `L`, less than 2⁻⁴⁶·L. The cut is
/// made where the function is `−τ`, `τ = 2⁻⁴⁰·L`; corners that it makes lie there to within 2⁻⁴⁵·L, so
/// it takes away only points at which the function is negative, out of sight. Corners move by at most
/// 2⁻⁴⁵·L; if in the end all have `ζ ≥ 2⁻²⁰·L` for `L` counted in samples, their columns and rows move by
/// less than a hundredth of a sample for up to 65,536. Otherwise the triangle passes so close to the
/// eye that the whole picture is its region.
pub(crate) fn region(map: &CameraMap, corners: &[DVec3; 3]) -> Region {
    let whole = map.whole();
    let [height, width] = map.raster.size().map(f64::from);
    // (column + 1)·ζ, (width − column)·ζ and so on: linear in the corner, 0 on the moved border.
    let distances = |corner: &DVec3| {
        let depth = -corner.dot(map.w);
        let row = corner.dot(map.v) * map.distance * map.scale[0];
        let column = corner.dot(map.u) * map.distance * map.scale[1];
        let (row, column) = (row + map.middle[0] * depth, column + map.middle[1] * depth);
        let borders =
            DVec4::new(column + depth, width * depth - column, row + depth, height * depth - row);
        Corner { borders, row, column, depth }
    };
    let mut polygon: Vec<Corner> = corners.iter().map(distances).collect();
    let largest = polygon.iter().map(|corner| corner.borders.abs().max_element());
    let largest = largest.fold(0.0, f64::max);
    let slack = (-40f64).exp2() * largest;
    for border in 0..4 {
        polygon = clipped(&polygon, |corner| corner.borders[border] + slack);
    }
    // Written so that NaN fails.
    let trusted = |corner: &Corner| corner.depth >= (-20f64).exp2() * largest;
    if !polygon.iter().all(trusted) {
        return whole;
    }
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for corner in &polygon {
        let place = [corner.row / corner.depth, corner.column / corner.depth];
        low = [low[0].min(place[0]), low[1].min(place[1])];
        high = [high[0].max(place[0]), high[1].max(place[1])];
    }
    // Nothing is left of a triangle out of sight: the box is empty, its ends crossed.
    if polygon.is_empty() {
        return Region { rows: 0..0, columns: 0..0 };
    }
    map.region::<Sound>(low, high, [0.125; 2])
}

/// A corner of the polygon, all numbers times its depth.
#[derive(Clone, Copy)]
struct Corner {
    borders: DVec4,
    row: f64,
    column: f64,
    depth: f64,
}

impl Corner {
    /// The point of the edge towards another corner, at this fraction of the way.
    fn towards(&self, other: &Corner, fraction: f64) -> Corner {
        let mix = |from: f64, to: f64| from + fraction * (to - from);
        Corner {
            borders: self.borders + fraction * (other.borders - self.borders),
            row: mix(self.row, other.row),
            column: mix(self.column, other.column),
            depth: mix(self.depth, other.depth),
        }
    }
}

/// The part of a convex polygon in which a linear function is not negative.
fn clipped(polygon: &[Corner], function: impl Fn(&Corner) -> f64) -> Vec<Corner> {
    let mut rest = Vec::with_capacity(polygon.len() + 1);
    for (k, corner) in polygon.iter().enumerate() {
        let next = &polygon[(k + 1) % polygon.len()];
        let (here, there) = (function(corner), function(next));
        if here >= 0.0 {
            rest.push(*corner);
        }
        if (here < 0.0) != (there < 0.0) {
            rest.push(corner.towards(next, here / (here - there)));
        }
    }
    rest
}
