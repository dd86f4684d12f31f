//! From `f64` to `f32`: one strip of a triangle or plane that is set up in `f64`, ready to be drawn sixteen samples at
//! a time.

use super::edges::F64Setup;
use crate::fast::camera_map::CameraMap;
use crate::fast::depth::{KEY_ERROR, KeyScale, LARGEST_KEY};
use crate::fast::setup::FlatSetup;
use crate::fast::viewport_affine::ViewportAffine;
use bothways_common::Projection;
use bothways_common::engine::fault::{Fault, error_bound};
use bothways_common::engine::roundoff::EPS24;
use bothways_common::raster::{Region, Sample};
use glam::DVec3;

/// A bound of the roundings of evaluating an affine function in `f32`, as a fraction of [`RasterAffine::most`]: the
/// constant is rounded by itself and in two sums, what comes from columns also in a product, what comes from rows
/// in a product and one sum; at most four of `ε₂₄`, and a little for their products and for numbers too small to be
/// normal.
const EVALUATION: f64 = 4.1 * (EPS24 as f64);

/// An affine function of row and column, counted from an origin.
#[derive(Clone, Copy)]
struct RasterAffine {
    at_origin: f64,
    across: f64,
    down: f64,
    /// How far it may be from the true one at a sample.
    error: f64,
    /// The largest value of its parts together.
    most: f64,
}

/// The strip of the picture in which functions are wanted.
struct Strip<'a> {
    map: &'a CameraMap<'a>,
    origin: Sample,
    /// Rows and columns.
    size: [f64; 2],
}

impl<'a> Strip<'a> {
    fn new(map: &'a CameraMap<'a>, region: &Region) -> Self {
        let origin = Sample { row: region.rows.start, column: region.columns.start };
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let size = [region.rows.len() as f64, region.columns.len() as f64];
        Strip { map, origin, size }
    }

    /// A function on the viewport as one of row and column.
    ///
    /// `x` of a sample is within `10·2⁻⁵³·X` of where a column's width times their number leads from the origin's,
    /// `X` the largest of any sample: three roundings for each, and two for that width. The function at the origin
    /// is rounded three times, its slopes twice: less than 2⁻⁴⁸ of all parts in all.
    fn function(&self, function: ViewportAffine) -> RasterAffine {
        let ViewportAffine { at_center, across, up, error } = function;
        let Strip { map, origin, size } = self;
        let (xs, ys) = (map.grid.x(), map.grid.y());
        let at_origin = at_center + ys[origin.row] * up + xs[origin.column] * across;
        let furthest = |places: &[f64]| places.first().map_or(0.0, |place| place.abs());
        let parts = at_center.abs() + furthest(xs) * across.abs() + furthest(ys) * up.abs();
        let [down, across] = [up / map.scale[0], across / map.scale[1]];
        let most = at_origin.abs() + across.abs() * size[1] + down.abs() * size[0];
        RasterAffine { at_origin, across, down, error: error + (-48f64).exp2() * parts, most }
    }
}

impl RasterAffine {
    /// The function times a factor, rounded.
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
    fn rounded(&self, factor: f64) -> [f32; 3] {
        [self.at_origin, self.across, self.down].map(|number| (number * factor) as f32)
    }

    /// The least value in a strip of this size, but for the error.
    fn least(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[1]).min(0.0) + (self.down * size[0]).min(0.0)
    }

    fn largest(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[1]).max(0.0) + (self.down * size[0]).max(0.0)
    }
}

/// A strip of a triangle, with edge functions and key in `f32`; `None` if keys or edge functions would not be certain
/// enough, or if fragments may not be in front of the eye. The result depends on the triangle and the region alone.
///
/// Each edge function is divided by the largest value that it may have in the region: so one error suits all, and
/// nothing overflows.
pub(crate) fn narrow_triangle<F: Fault>(
    map: &CameraMap,
    keys: KeyScale,
    setup: &F64Setup,
    (id, corners): (u32, &[DVec3; 3]),
    region: &Region,
) -> Option<FlatSetup> {
    let strip = Strip::new(map, region);
    let edges = setup.edges.map(|edge| strip.function(edge));
    let factors = edges.map(|edge| 1.0 / edge.most);
    // The rounding of the division is part of the little.
    let error_of = |k: usize| EVALUATION + edges[k].error * factors[k];
    let error = error_of(0).max(error_of(1)).max(error_of(2));
    let key = key(&strip, keys, &setup.depth, Some(corners))?;
    let error = error_bound::<F>(error);
    // No value is larger than 1, so that a larger bound would decide nothing. Samples beside the region are given an
    // edge function of −∞, which is below every bound but an infinite one.
    if !(error < 1.0 && factors.iter().all(|factor| factor.is_normal())) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounded up thereafter")]
    let error = if error > 0.0 { (error as f32).next_up() } else { 0.0 };
    #[expect(clippy::cast_possible_truncation, reason = "±1")]
    let facing = setup.facing as f32;
    let rounded = |k: usize| edges[k].rounded(factors[k]);
    Some(FlatSetup {
        id,
        edges: [rounded(0), rounded(1), rounded(2)],
        error,
        key: key.rounded(1.0),
        origin: strip.origin,
        region: region.clone(),
        facing,
    })
}

/// A strip of a plane, which has no edges; `None` as for a triangle.
pub(crate) fn narrow_plane(
    map: &CameraMap,
    keys: KeyScale,
    depth: &ViewportAffine,
    id: u32,
    region: &Region,
) -> Option<FlatSetup> {
    let strip = Strip::new(map, region);
    Some(FlatSetup {
        id,
        edges: [[1.0, 0.0, 0.0]; 3],
        error: 0.0,
        key: key(&strip, keys, depth, None)?.rounded(1.0),
        origin: strip.origin,
        region: region.clone(),
        facing: 0.0,
    })
}

/// The key, if it is within [`KEY_ERROR`] of the true one at every sample that the primitive covers: a triangle with
/// these corners, or a plane.
fn key(
    strip: &Strip,
    keys: KeyScale,
    depth: &ViewportAffine,
    corners: Option<&[DVec3; 3]>,
) -> Option<RasterAffine> {
    let (map, offset) = (strip.map, keys.offset);
    let from_depth = match keys.projection {
        Projection::Perspective => -offset,
        Projection::Parallel => offset,
    };
    let ViewportAffine { at_center, across, up, error } = *depth;
    let key = strip.function(ViewportAffine {
        at_center: from_depth - at_center,
        across: -across,
        up: -up,
        error,
    });
    let error = key.error + (-48f64).exp2() * offset;

    let farthest = corners.and_then(|corners| key_of_farthest(map, keys, corners));
    let least = (key.least(strip.size) - error).max(farthest.unwrap_or(f64::NEG_INFINITY));
    let in_front = match keys.projection {
        Projection::Perspective => true,
        Projection::Parallel => {
            let from_eye = keys.from_eye - key.largest(strip.size);
            farthest.is_some() || from_eye > error + (-48f64).exp2() * keys.from_eye
        }
    };
    let all = error + EVALUATION * key.most;
    let is_certain = all <= 0.99 * f64::from(KEY_ERROR) * least;
    let in_range = least >= 1.0 / LARGEST_KEY && key.most <= LARGEST_KEY;
    (in_front && is_certain && in_range).then_some(key)
}

/// A lower bound of the key at the farthest corner of a triangle, if all corners are trusted: what is covered lies
/// between the corners, and its key between theirs.
fn key_of_farthest(map: &CameraMap, keys: KeyScale, corners: &[DVec3; 3]) -> Option<f64> {
    let most = |numbers: [f64; 3]| numbers[0].max(numbers[1]).max(numbers[2]);
    let depths = corners.map(|corner| -corner.dot(map.w));
    let extents = corners.map(|corner| corner.abs().element_sum());
    let trusted = depths.iter().zip(&extents).all(|(depth, extent)| {
        // As `CameraMap::new` says: then 1/t and t are certain within 2⁻⁴¹ of themselves.
        *depth >= extent * (-10f64).exp2() && *depth > 0.0
    });
    let offset = keys.offset;
    trusted.then(|| match keys.projection {
        Projection::Perspective => {
            let near = map.distance / most(depths);
            near - offset - (-40f64).exp2() * near
        }
        Projection::Parallel => {
            // Two roundings of a coordinate, three of the product and the frame's are less than 2⁻⁴⁸.
            let near = corners.map(|corner| map.local.relative(corner));
            let farthest = most(near.map(|corner| -corner.dot(map.w)));
            let extent = most(near.map(|corner| corner.abs().element_sum()));
            offset - farthest - (-46f64).exp2() * (extent + offset)
        }
    })
}
