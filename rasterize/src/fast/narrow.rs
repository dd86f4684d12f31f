//! From `f64` to `f32`: what lies in a small part of the picture of a triangle or plane that is set up in `f64`,
//! ready to be drawn sixteen samples at a time.

use super::depth::{DepthPlane, KEY_ERROR, KeyScale, LARGEST_KEY};
use super::edges::{Edge, TriangleSetup};
use super::screen::Screen;
use super::setup::Affine;
use bothways_common::Projection;
use bothways_common::engine::fault::{Fault, error_bound};
use bothways_common::raster::Region;
use bothways_common::raster::Sample;
use glam::DVec3;

/// Half the distance from 1 to the next `f32`.
const NARROW_ROUNDOFF: f64 = f32::EPSILON as f64 / 2.0;

/// What bounds the roundings of evaluating an affine function in `f32`, as a part of [`Function::most`]: the
/// constant is rounded by itself and in two sums, what comes from columns also in a product, what comes from rows
/// in a product and one sum; at most four of `u`, and a little for their products and for numbers too small to be
/// normal.
const EVALUATION: f64 = 4.1 * NARROW_ROUNDOFF;

/// An affine function of column and row, counted from an origin.
#[derive(Clone, Copy)]
struct Function {
    at_origin: f64,
    across: f64,
    down: f64,
    /// How far it may be from the true one at a sample.
    error: f64,
    /// The largest value of its parts together.
    most: f64,
}

/// The part of the picture in which functions are wanted.
struct Part<'a> {
    screen: &'a Screen<'a>,
    origin: Sample,
    /// Columns and rows.
    size: [f64; 2],
}

impl<'a> Part<'a> {
    fn new(screen: &'a Screen<'a>, region: &Region) -> Self {
        let origin = Sample { row: region.rows.start, column: region.columns.start };
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let size = [region.columns.len() as f64, region.rows.len() as f64];
        Part { screen, origin, size }
    }

    /// A function on the viewport as one of column and row.
    ///
    /// `x` of a sample is within `10·2⁻⁵³·X` of where a column's width times their number leads from the origin's,
    /// `X` the largest of any sample: three roundings for each, and two for that width. The function at the origin
    /// is rounded three times, its slopes twice: less than 2⁻⁴⁸ of all parts in all.
    fn function(&self, at_centre: f64, across: f64, up: f64, error: f64) -> Function {
        let Part { screen, origin, size } = self;
        let (xs, ys) = (screen.grid.x(), screen.grid.y());
        let at_origin = at_centre + ys[origin.row] * up + xs[origin.column] * across;
        let furthest = |places: &[f64]| places.first().map_or(0.0, |place| place.abs());
        let parts = at_centre.abs() + furthest(xs) * across.abs() + furthest(ys) * up.abs();
        let [across, down] = [across / screen.scale[0], up / screen.scale[1]];
        let most = at_origin.abs() + across.abs() * size[0] + down.abs() * size[1];
        Function { at_origin, across, down, error: error + (-48f64).exp2() * parts, most }
    }
}

impl Function {
    /// The function times a factor, rounded.
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
    fn rounded(&self, factor: f64) -> [f32; 3] {
        [self.at_origin, self.across, self.down].map(|number| (number * factor) as f32)
    }

    /// The least value in a part of the picture, but for the error.
    fn least(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[0]).min(0.0) + (self.down * size[1]).min(0.0)
    }

    fn largest(&self, size: [f64; 2]) -> f64 {
        self.at_origin + (self.across * size[0]).max(0.0) + (self.down * size[1]).max(0.0)
    }
}

/// A part of a triangle, with edge functions and key in `f32`; `None` if keys or edge functions would not be certain
/// enough, or fragments not to be in front of the eye. What comes of it depends on the triangle and the region alone.
///
/// Each edge function is divided by the largest value that it may have in the region: so one error suits all, and
/// nothing overflows.
pub(super) fn narrow<F: Fault>(
    screen: &Screen,
    keys: KeyScale,
    setup: &TriangleSetup,
    (id, corners): (u32, &[DVec3; 3]),
    region: &Region,
) -> Option<Affine> {
    let part = Part::new(screen, region);
    let edges = setup
        .edges
        .map(|Edge { at_centre, across, up, error }| part.function(at_centre, across, up, error));
    let factors = edges.map(|edge| 1.0 / edge.most);
    // The division's rounding is part of the little.
    let error_of = |k: usize| EVALUATION + edges[k].error * factors[k];
    let error = error_of(0).max(error_of(1)).max(error_of(2));
    let key = key(&part, keys, &setup.depth, Some(corners))?;
    let error = error_bound::<F>(error);
    // No value is larger than 1, so that such a bound would decide nothing. What lies beside the region is kept from
    // being drawn as outside by infinitely much, which is beyond any bound but an infinite one.
    if !(error < 1.0 && factors.iter().all(|factor| factor.is_normal())) {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounded up thereafter")]
    let error = if error > 0.0 { (error as f32).next_up() } else { 0.0 };
    #[expect(clippy::cast_possible_truncation, reason = "±1")]
    let facing = setup.facing as f32;
    let rounded = |k: usize| edges[k].rounded(factors[k]);
    Some(Affine {
        id,
        edges: [rounded(0), rounded(1), rounded(2)],
        error,
        key: key.rounded(1.0),
        origin: part.origin,
        region: region.clone(),
        facing,
    })
}

/// A part of a plane likewise, if all of it is certainly in front of the eye: it has no edges.
pub(super) fn narrow_plane(
    screen: &Screen,
    keys: KeyScale,
    depth: &DepthPlane,
    id: u32,
    region: &Region,
) -> Option<Affine> {
    let part = Part::new(screen, region);
    Some(Affine {
        id,
        edges: [[1.0, 0.0, 0.0]; 3],
        error: 0.0,
        key: key(&part, keys, depth, None)?.rounded(1.0),
        origin: part.origin,
        region: region.clone(),
        facing: 0.0,
    })
}

/// The key, if it is within [`KEY_ERROR`] of the true one at every sample that the primitive covers, a triangle of
/// these corners or a plane.
fn key(
    part: &Part,
    keys: KeyScale,
    depth: &DepthPlane,
    corners: Option<&[DVec3; 3]>,
) -> Option<Function> {
    let (screen, offset) = (part.screen, keys.offset);
    let from_depth = match keys.projection {
        Projection::Perspective => -offset,
        Projection::Parallel => offset,
    };
    let DepthPlane { at_centre, across, up, error } = *depth;
    let key = part.function(from_depth - at_centre, -across, -up, error);
    let error = key.error + (-48f64).exp2() * offset;

    // The key at the farthest corner, if that is trusted: what is covered lies between corners, and its key
    // between theirs.
    let corners = corners.map_or([DVec3::NAN; 3], |corners| *corners);
    let most = |numbers: [f64; 3]| numbers[0].max(numbers[1]).max(numbers[2]);
    let depths = corners.map(|corner| -corner.dot(screen.w));
    let extents = corners.map(|corner| corner.abs().element_sum());
    let trusted = depths.iter().zip(&extents).all(|(depth, extent)| {
        // As Screen::new says: then 1/t and t are certain within 2⁻⁴¹ of themselves.
        *depth >= extent * (-10f64).exp2() && *depth > 0.0
    });
    let least_of_corners = match keys.projection {
        _ if !trusted => f64::NEG_INFINITY,
        Projection::Perspective => {
            let near = screen.distance / most(depths);
            near - offset - (-40f64).exp2() * near
        }
        Projection::Parallel => {
            // Two roundings of a coordinate, three of the product and the frame's are less than 2⁻⁴⁸.
            let near = corners.map(|corner| screen.waypoint.relative(corner));
            let farthest = most(near.map(|corner| -corner.dot(screen.w)));
            let extent = most(near.map(|corner| corner.abs().element_sum()));
            offset - farthest - (-46f64).exp2() * (extent + offset)
        }
    };
    let least = (key.least(part.size) - error).max(least_of_corners);
    let in_front = match keys.projection {
        Projection::Perspective => true,
        Projection::Parallel => {
            let from_eye = keys.from_eye - key.largest(part.size);
            trusted || from_eye > error + (-48f64).exp2() * keys.from_eye
        }
    };
    let all = error + EVALUATION * key.most;
    let is_certain = all <= 0.99 * f64::from(KEY_ERROR) * least;
    let in_range = least >= 1.0 / LARGEST_KEY && key.most <= LARGEST_KEY;
    (in_front && is_certain && in_range).then_some(key)
}
