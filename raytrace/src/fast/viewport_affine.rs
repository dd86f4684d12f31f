//! Affine functions of the viewport, with a bound of their error: edge functions and depth keys of flat primitives are
//! affine in the coordinates `(x, y)` at which a ray passes the viewport.

use super::answer::Trust;
use super::high_precision::DoubleDouble;
use super::search::tile_frustum::TileFrustum;
use bothways_common::engine::roundoff::EPS53;
use bothways_common::{Camera, Projection};
use glam::DVec3;

/// `at_center + x·across + y·up`, which is off by at most `error[0] + |x|·error[1] + |y|·error[2]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewportAffine {
    pub(super) at_center: f64,
    pub(super) across: f64,
    pub(super) up: f64,
    pub(super) error: [f64; 3],
}

/// What a function's extremes in a tile are rounded by, as a fraction of its parts: see [`ViewportAffine::on`].
pub(super) const ROUNDINGS: f64 = 6.0 * EPS53;

/// Where the samples of a tile lie on the viewport.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileViewport {
    /// `x` and `y` of the tile's middle, and the largest of its samples.
    pub(super) middle: [f64; 2],
    pub(super) most: [f64; 2],
    /// From a column to the next to the right, and from a row to the next below.
    pub(super) step: [f64; 2],
    /// Half of the way from the first row to the last.
    pub(super) half: f64,
}

/// An affine function of the rows and columns of a tile, counted from its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileAffine {
    pub(super) at_middle: f64,
    pub(super) across: f64,
    pub(super) down: f64,
    /// It is off by at most so much at any sample; so are sums of the other numbers.
    pub(super) error: f64,
    /// At most how far from its value at the middle it is at a sample.
    pub(super) spread: f64,
}

/// An affine function of a ray's direction, for a perspective camera, or of its origin: `normal·P + constant`.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayAffine {
    pub(super) normal: [DoubleDouble; 3],
    pub(super) constant: DoubleDouble,
}

impl ViewportAffine {
    /// 1 everywhere.
    pub(super) const ONE: ViewportAffine =
        ViewportAffine { at_center: 1.0, across: 0.0, up: 0.0, error: [0.0; 3] };

    /// An affine function of the rays of a camera.
    ///
    /// # The error, rounding by rounding
    ///
    /// `P = x·u + y·v + o`, with `o = −d·w` of a perspective camera and 0 of a parallel one. Each of the three terms counts
    /// for itself, with `S` the sum of the products of the absolute coordinates of the normal and of `u` (or `v`, or `o`).
    ///
    /// `P` itself was rounded 3 times. The normal's leading halves are taken for it, which brings one rounding more
    /// than its own error; a coordinate of `o` is a product of one, an inner product brings 3, and the constant's
    /// leading half and the sum with it one each: less than 10 of `S`, and of the constant.
    ///
    /// Where the function is evaluated about the middle of a tile, as [`TileViewport`] does, `x` of a sample is within
    /// four roundings of where the middle and so many columns lead: the spacing of columns is rounded once, its
    /// product with the middle's column once, its product with columns from there brings the spacing's, and `x`
    /// itself was rounded. The function at the middle is rounded 4 times, a slope once. That is less than 9 of all terms,
    /// which the products with `S` bound. Together 19 of each, and one for the roundings of the bound.
    pub(super) fn of_rays(camera: &Camera, function: &RayAffine) -> ViewportAffine {
        let RayAffine { normal, constant } = function;
        let leading = DVec3::from(normal.map(|number| number.high));
        let inexact = DVec3::from(normal.map(|number| number.error));
        let from_center = match camera.projection() {
            Projection::Perspective => -camera.distance() * camera.w(),
            Projection::Parallel => DVec3::ZERO,
        };
        let error = |axis: DVec3| {
            let size = axis.abs();
            20.0 * EPS53 * leading.abs().dot(size) + 1.01 * inexact.dot(size)
        };
        let of_constant = 20.0 * EPS53 * constant.high.abs() + 1.01 * constant.error;
        ViewportAffine {
            at_center: leading.dot(from_center) + constant.high,
            across: leading.dot(camera.u()),
            up: leading.dot(camera.v()),
            error: [error(from_center) + of_constant, error(camera.u()), error(camera.v())],
        }
    }

    /// The function times a factor of which the relative error is known.
    ///
    /// The product brings one rounding, and what the factor is off by counts for what the function may be, too; that is
    /// less than 1.1 times as much as for the computed one, where the relative error is less than a sixteenth.
    pub(super) fn times(&self, factor: f64, relative: f64) -> ViewportAffine {
        let ViewportAffine { at_center, across, up, error } = *self;
        let size = factor.abs();
        let relative = 1.1 * relative + 3.0 * EPS53;
        let error_of = |value: f64, error: f64| size * (1.1 * error + relative * value.abs());
        ViewportAffine {
            at_center: at_center * factor,
            across: across * factor,
            up: up * factor,
            error: [
                error_of(at_center, error[0]),
                error_of(across, error[1]),
                error_of(up, error[2]),
            ],
        }
    }

    /// The function on a tile.
    ///
    /// Its spread is rounded three times, and sums of it and the function at the middle twice: less than 6 roundings of
    /// both.
    pub(super) fn on(&self, tile: &TileViewport) -> TileAffine {
        let ViewportAffine { at_center, across, up, error } = self;
        let ([x, y], [most_x, most_y], [step_x, step_y]) = (tile.middle, tile.most, tile.step);
        let at_middle = at_center + across * x + up * y;
        let (across, down) = (across * step_x, up * step_y);
        let spread = tile.half * (across.abs() + down.abs());
        let error = error[0] + error[1] * most_x + error[2] * most_y;
        let error = error + ROUNDINGS * (at_middle.abs() + spread);
        TileAffine { at_middle, across, down, error, spread }
    }
}

impl TileViewport {
    pub(super) fn new(frustum: &TileFrustum) -> TileViewport {
        let (middle, half) = (frustum.viewport, frustum.template.half);
        let [of_row, of_column] = frustum.template.spacing;
        TileViewport {
            middle,
            most: [middle[0].abs() + half * of_column, middle[1].abs() + half * of_row],
            step: [of_column, -of_row],
            half,
        }
    }
}

impl TileAffine {
    /// The largest size of the function's parts together.
    pub(super) fn most(&self) -> f64 {
        self.at_middle.abs() + self.spread
    }

    /// No value is greater.
    pub(super) fn greatest(&self, trust: Trust) -> f64 {
        self.at_middle + self.spread + trust.of(self.error)
    }

    /// No value is less.
    pub(super) fn least(&self, trust: Trust) -> f64 {
        self.at_middle - self.spread - trust.of(self.error)
    }
}
