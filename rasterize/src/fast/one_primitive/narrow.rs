//! From `f64` to `f32`: strips of a triangle or plane that is set up in `f64`, ready to be drawn sixteen samples at a time.

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

/// A function on the viewport, and its slopes from column to column and from row to row.
#[derive(Clone, Copy)]
struct Slopes {
    function: ViewportAffine,
    across: f64,
    down: f64,
    /// How far the function of row and column may be from the true one at a sample.
    error: f64,
}

/// The strip of the picture in which functions are wanted.
struct Strip {
    origin: Sample,
    /// The places of its row and its column on the viewport.
    place: [f64; 2],
    /// Rows and columns.
    size: [f64; 2],
}

impl Strip {
    #[inline(always)]
    fn new(map: &CameraMap, region: &Region) -> Self {
        let origin = Sample { row: region.rows.start, column: region.columns.start };
        let place = [map.grid.y()[origin.row], map.grid.x()[origin.column]];
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let size = [region.rows.len() as f64, region.columns.len() as f64];
        Strip { origin, place, size }
    }
}

impl Slopes {
    /// `x` of a sample is within `10·2⁻⁵³·X` of where a column's width times their number leads from the origin's,
    /// `X` the largest of any sample: three roundings for each, and two for that width. The function at the origin
    /// is rounded three times, its slopes twice: less than 2⁻⁴⁸ of all parts in all.
    #[inline(always)]
    fn new(map: &CameraMap, function: ViewportAffine) -> Slopes {
        let ViewportAffine { at_center, across, up, error } = function;
        let [furthest_x, furthest_y] = [map.grid.x(), map.grid.y()]
            .map(|places| places.first().map_or(0.0, |place| place.abs()));
        let parts = at_center.abs() + furthest_x * across.abs() + furthest_y * up.abs();
        let [down, across] = [up / map.scale[0], across / map.scale[1]];
        Slopes { function, across, down, error: error + (-48f64).exp2() * parts }
    }

    /// The function of row and column, counted from the strip's origin.
    #[inline(always)]
    fn counted_from_origin(&self, strip: &Strip) -> RasterAffine {
        let Slopes { function: ViewportAffine { at_center, across, up, .. }, .. } = *self;
        let at_origin = at_center + strip.place[0] * up + strip.place[1] * across;
        let Slopes { across, down, error, .. } = *self;
        let most = at_origin.abs() + across.abs() * strip.size[1] + down.abs() * strip.size[0];
        RasterAffine { at_origin, across, down, error, most }
    }
}

impl RasterAffine {
    /// The function times a factor, rounded.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
    fn rounded(&self, factor: f64) -> [f32; 3] {
        [self.at_origin, self.across, self.down].map(|number| (number * factor) as f32)
    }

    /// The least value in a strip of this size, but for the error.
    #[inline(always)]
    fn least(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[1]).min(0.0) + (self.down * size[0]).min(0.0)
    }

    #[inline(always)]
    fn largest(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[1]).max(0.0) + (self.down * size[0]).max(0.0)
    }
}

/// A triangle or plane that is set up in `f64`, to be narrowed strip by strip. What all strips have in common is computed
/// once.
pub(crate) struct Narrowing<'a> {
    map: &'a CameraMap<'a>,
    keys: KeyScale,
    id: u32,
    /// A plane has none.
    edges: Option<[Slopes; 3]>,
    facing: f64,
    key: Slopes,
    /// A lower bound of the key of what is covered, if one is known.
    farthest: Option<f64>,
}

impl<'a> Narrowing<'a> {
    #[inline(always)]
    pub(crate) fn of_triangle(
        map: &'a CameraMap,
        keys: KeyScale,
        setup: &F64Setup,
        (id, corners): (u32, &[DVec3; 3]),
    ) -> Self {
        let [ab, bc, ca] = setup.edges;
        let edges = [Slopes::new(map, ab), Slopes::new(map, bc), Slopes::new(map, ca)];
        Narrowing {
            map,
            keys,
            id,
            edges: Some(edges),
            facing: setup.facing,
            key: key(map, keys, &setup.depth),
            farthest: key_of_farthest(map, keys, corners),
        }
    }

    #[inline(always)]
    pub(crate) fn of_plane(
        map: &'a CameraMap,
        keys: KeyScale,
        depth: &ViewportAffine,
        id: u32,
    ) -> Self {
        let key = key(map, keys, depth);
        Narrowing { map, keys, id, edges: None, facing: 0.0, key, farthest: None }
    }

    /// A strip, with edge functions and key in `f32`; `None` if keys or edge functions would not be certain enough, or if
    /// fragments may not be in front of the eye. The result depends on the primitive and the region alone.
    #[inline(always)]
    pub(crate) fn strip<F: Fault>(&self, region: &Region) -> Option<FlatSetup> {
        let strip = Strip::new(self.map, region);
        let key = self.key(&strip)?;
        let (edges, error) = match &self.edges {
            Some(edges) => narrow_edges::<F>(edges, &strip)?,
            None => ([[1.0, 0.0, 0.0]; 3], 0.0),
        };
        #[expect(clippy::cast_possible_truncation, reason = "±1 or 0")]
        let facing = self.facing as f32;
        Some(FlatSetup {
            id: self.id,
            edges,
            error,
            key: key.rounded(1.0),
            origin: strip.origin,
            region: region.clone(),
            facing,
        })
    }

    /// The key, if it is within [`KEY_ERROR`] of the true one at every sample of the strip that the primitive covers.
    #[inline(always)]
    fn key(&self, strip: &Strip) -> Option<RasterAffine> {
        let Narrowing { keys, farthest, .. } = self;
        let key = self.key.counted_from_origin(strip);
        let error = key.error + (-48f64).exp2() * keys.offset;
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
}

/// The edge functions of a strip, and their error. Each is divided by the largest value that it may have in the strip: so one
/// error suits all, and nothing overflows.
#[inline(always)]
fn narrow_edges<F: Fault>(edges: &[Slopes; 3], strip: &Strip) -> Option<([[f32; 3]; 3], f32)> {
    let [a, b, c] = [
        edges[0].counted_from_origin(strip),
        edges[1].counted_from_origin(strip),
        edges[2].counted_from_origin(strip),
    ];
    let factors = [1.0 / a.most, 1.0 / b.most, 1.0 / c.most];
    // The rounding of the division is part of the little.
    let error = (EVALUATION + a.error * factors[0])
        .max(EVALUATION + b.error * factors[1])
        .max(EVALUATION + c.error * factors[2]);
    let error = error_bound::<F>(error);
    // No value is larger than 1, so that a larger bound would decide nothing. Samples beside the region are given an
    // edge function of −∞, which is below every bound but an infinite one.
    if !(error < 1.0 && factors.iter().all(|factor| factor.is_normal())) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounded up thereafter")]
    let error = if error > 0.0 { (error as f32).next_up() } else { 0.0 };
    Some(([a.rounded(factors[0]), b.rounded(factors[1]), c.rounded(factors[2])], error))
}

/// The key of a depth.
#[inline(always)]
fn key(map: &CameraMap, keys: KeyScale, depth: &ViewportAffine) -> Slopes {
    let from_depth = match keys.projection {
        Projection::Perspective => -keys.offset,
        Projection::Parallel => keys.offset,
    };
    let ViewportAffine { at_center, across, up, error } = *depth;
    let at_center = from_depth - at_center;
    Slopes::new(map, ViewportAffine { at_center, across: -across, up: -up, error })
}

/// A lower bound of the key at the farthest corner of a triangle, if all corners are trusted: what is covered lies
/// between the corners, and its key between theirs.
#[inline(always)]
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
