//! The map from the world to the raster, for all rays of a picture, and what rounding does to it.
//!
//! For the rays of a perspective camera a point is `p = t·D`, and `D` is affine in column and row. The
//! map takes `p` to `(t, t·δj, t·δi)`, with `δj` columns and `δi` rows from the middle of a tile, up to a
//! scale. For a parallel camera `p = O + t·D`, and the map takes it to `(t, δj, δi)`. In both cases a ray is
//! known by `(1, δj, δi)`; edge functions, depths and the sides of a tile are determinants and planes
//! in these coordinates. Determinants keep their signs, since the map keeps orientation.
//!
//! These three coordinates are in the order of the viewport, `x` before `y`, so that orientation is kept. Numbers of
//! the raster come in pairs of row and column.
//!
//! What is computed here is computed with rounding: [`MapErrors`] bounds what that does.

use super::depth::KeyScale;
use super::search::tree::Bounds;
use bothways_common::engine::roundoff::EPS53;
use bothways_common::{Projection, Raster, SampleGrid, View};
use glam::{DVec3, Vec3};

/// The rays of a picture.
#[derive(Clone, Debug)]
pub(super) struct CameraMap<'a> {
    pub(super) view: View<'a>,
    pub(super) grid: SampleGrid<'a>,
    pub(super) raster: Raster,
    pub(super) depth: KeyScale,
    pub(super) reach: Reach,
}

/// How far the boxes of the hierarchy reach, along any axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// No vertex has a larger coordinate relative to the eye.
    pub(super) from_eye: f64,
    /// A point of the world, the eye or one that is much nearer, and the largest coordinate relative to it.
    pub(super) origin: Vec3,
    pub(super) from_origin: f64,
}

/// The linear part of the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// For the middle of the picture: a row of the map for `t`, one for columns, one for rows.
    pub(super) rows: [DVec3; 3],
    /// What the row of rows and the row of columns gain with the coordinates on the viewport.
    pub(super) slopes: [DVec3; 2],
}

/// How far computed numbers may be from exact ones, for tiles of one size.
#[derive(Clone, Copy, Debug)]
pub(super) struct MapErrors {
    /// Half of a tile, from the first sample to the last, and what rounding may add: a point on one of a tile's rays
    /// is no more columns and rows from its middle, also when that is computed in `f64` from any corner of a box that
    /// is at least as far that way.
    pub(super) wide: f64,
    /// A computed coordinate of a vertex, after the map, in columns and rows at `t = 1`; that of `t`
    /// is smaller by `far`.
    pub(super) corner: f64,
    /// A sample's `(1, δj, δi)`, relative to the tile's half side `far`.
    pub(super) sample: f64,
    /// Half the tile's side, but at least 1.
    pub(super) far: f64,
    /// The `t` of a parallel camera, besides.
    pub(super) depth: f64,
    /// Computed `t` of a point and `t` of the ray there: relative for a perspective camera.
    pub(super) t: f64,
    /// The largest coordinate, relative to the eye, for which these errors hold.
    pub(super) reach: f64,
    /// Whether the bounds of projected triangles on the raster can be trusted.
    pub(super) small: bool,
}

impl Reach {
    /// How far these bounds reach, from an eye.
    pub(super) fn new(bounds: &Bounds, eye: Vec3) -> Reach {
        /// Another origin must be this many times as near as the eye.
        const WORTH: f64 = 8.0;
        let from = |point: Vec3| {
            let ends = [bounds.low, bounds.high];
            let [low, high] = ends.map(|end| end.as_dvec3() - point.as_dvec3());
            let reach = low.abs().max(high.abs()).max_element();
            if reach.is_finite() && reach > 0.0 { reach } else { 1.0 }
        };
        let middle = 0.5 * bounds.low + 0.5 * bounds.high;
        let (from_eye, from_middle) = (from(eye), from(middle));
        // Rounded up: the differences were rounded.
        let from_middle = from_middle * (1.0 + 2.0 * EPS53);
        if middle.is_finite() && WORTH * from_middle < from_eye {
            Reach { from_eye, origin: middle, from_origin: from_middle }
        } else {
            Reach { from_eye, origin: eye, from_origin: from_eye }
        }
    }
}

impl<'a> CameraMap<'a> {
    /// The rays of a view. `bounds` are those of the hierarchy.
    pub(super) fn new(view: &View<'a>, samples: u32, bounds: &Bounds) -> Self {
        let camera = view.camera;
        let raster = camera.raster(samples);
        let reach = Reach::new(bounds, camera.eye());
        // Numbers near 1 neither over- nor underflow in f32: a power of two brings them there.
        let scale = match camera.projection() {
            Projection::Perspective => (camera.distance() / reach.from_eye).log2().floor().exp2(),
            Projection::Parallel => 1.0 / least(raster.spacing()),
        };
        let depth = KeyScale { projection: camera.projection(), scale };
        CameraMap { view: *view, grid: camera.sample_grid(samples), raster, depth, reach }
    }

    /// The linear part of the map.
    pub(super) fn axes(&self) -> Axes {
        let camera = self.view.camera;
        let (u, v, w) = (camera.u(), camera.v(), camera.w());
        let (scale, spacing) = (self.depth.scale, self.raster.spacing());
        let [of_row, of_column] = spacing;
        match self.depth.projection {
            Projection::Perspective => {
                let d = camera.distance();
                let rows = [-w / d, u / of_column, -v / of_row].map(|axis| axis * scale);
                Axes { rows, slopes: spacing.map(|g| w * (scale / (d * g))) }
            }
            Projection::Parallel => {
                let rows = [-w * scale, u / of_column, -v / of_row];
                Axes { rows, slopes: [DVec3::ZERO; 2] }
            }
        }
    }

    /// `X + Y`, the largest coordinates on the viewport, those of a tile included that reaches over the picture's end.
    /// `half` is half of a tile's side.
    pub(super) fn largest(&self, half: f64) -> f64 {
        let [rows, columns] = self.raster.size().map(f64::from);
        let beyond = 0.5 + (half + 1.0) / columns.min(rows);
        let [vw, vh] = self.view.camera.viewport();
        (vw + vh) * beyond
    }

    /// The errors for tiles of which half a side is `half`.
    ///
    /// # The errors, rounding by rounding
    ///
    /// Frames are orthonormal to within `8·ε₅₃`. Write `X`, `Y` for the largest coordinates on
    /// the viewport, the tile's own included, `A` for the reach, `g` for the spacing of samples.
    ///
    /// *Perspective*, with `q = (d + X + Y)/d`. `D` is rounded by 3 in each coordinate of `X|u| + Y|v| +
    /// d|w|`, which is at most `d·q`. The row of `t` is `−w/d`: non-orthonormality brings `8·ε₅₃ + 8·ε₅₃·q`, `D`
    /// `3·√3·ε₅₃·q`, the row `√3·ε₅₃·q`: `24·ε₅₃·q` of 1. The row of columns is `u/g + x·(w/(d·g))`, two
    /// roundings of `u` and five of `(x/d)·w`, whose coordinates' sums are at most `√3` and `√3·(q − 1)`: less
    /// than `14·ε₅₃·q²d/g`; non-orthonormality `16·ε₅₃·q²d/g`, `D`
    /// `10.5·ε₅₃·q²d/g`, the coordinates of the sample and the middle `2·ε₅₃·qd/g`: `48·ε₅₃·q²d/g`.
    /// A vertex brings 3 roundings of `Σ|row|·A`, and the row its own: `4·ε₅₃·√3·A/d` for `t`,
    /// `4·ε₅₃·2√3·q·A/g` for columns.
    /// A side's normal is rounded by 2 more, and its product with a point on the ray by 4: with
    /// all that was said, `80·ε₅₃·q²d/g + 40·ε₅₃·q·h`.
    ///
    /// *Parallel*, with `Q = X + Y + 4A`, where `|t| ≤ 4A` for all that boxes hold. `O` is rounded by 2, `u/g`
    /// by 2, the shift by 2; with non-orthonormality `20·ε₅₃·Q/g` for a sample; a vertex brings `4·ε₅₃·(√3·A +
    /// 2X)/g`; a side 5 roundings more. The row of `t` is `−w/g`, alike.
    pub(super) fn errors(&self, half: f64) -> MapErrors {
        let g = least(self.raster.spacing());
        let largest = self.largest(half);
        let (a, far) = (self.reach.from_eye, half.max(1.0));
        match self.depth.projection {
            Projection::Perspective => {
                let d = self.view.camera.distance();
                let q = (d + largest) / d;
                let sample = (24.0 * q).max(48.0 * q * q * d / (g * far));
                let wide = half + 128.0 * EPS53 * (q * q * d / g + q * far);
                MapErrors {
                    wide,
                    corner: EPS53 * self.depth.scale * a * (16.0 * q / g).max(8.0 * far / d),
                    sample: EPS53 * sample,
                    far,
                    depth: 0.0,
                    t: 64.0 * EPS53 * q,
                    reach: a,
                    small: wide - half < 1.0 / 1024.0,
                }
            }
            Projection::Parallel => {
                let q = largest + 4.0 * a;
                let depth = 40.0 * EPS53 * q / g;
                let wide = half + 64.0 * EPS53 * (q / g + far);
                MapErrors {
                    wide,
                    corner: 8.0 * EPS53 * (a + largest) / g,
                    sample: 24.0 * EPS53 * q / (g * far),
                    far,
                    depth,
                    t: 2.0 * depth,
                    reach: a,
                    small: wide - half < 1.0 / 1024.0,
                }
            }
        }
    }
}

/// The smaller of two numbers.
pub(super) fn least([first, second]: [f64; 2]) -> f64 {
    first.min(second)
}
