//! The rays of one tile as a linear map: from a point in the world to the ray through it.
//!
//! For the rays of a perspective camera a point is `p = t·D`, and `D` is affine in column and row. The
//! map takes `p` to `(t, t·δj, t·δi)`, with `δj` columns and `δi` rows from the tile's middle, up to a
//! scale. For a parallel camera `p = O + t·D`, and the map takes it to `(t, δj, δi)`. Both times a ray is
//! known by `(1, δj, δi)`; edge functions, depths and the sides of a tile are determinants and planes
//! in these coordinates. Determinants keep their signs, since the map keeps orientation.
//!
//! What is computed here is computed with rounding: [`Errors`] bounds what that does.

use bothways_common::{Camera, Projection, SampleGrid, View};
use glam::DVec3;

/// Half the distance from 1 to the next `f64`.
const V: f64 = f64::EPSILON / 2.0;

/// The rays of a picture.
#[derive(Clone, Debug)]
pub(super) struct Rays<'a> {
    pub(super) view: View<'a>,
    pub(super) grid: SampleGrid<'a>,
    pub(super) projection: Projection,
    eye: DVec3,
    size: [f64; 2],
    viewport: [f64; 2],
    spacing: [f64; 2],
    /// The first coordinate of the map is `t` times this.
    pub(super) scale: f64,
    /// No vertex has a larger coordinate relative to the eye.
    reach: f64,
}

/// The rays of a square of samples.
#[derive(Clone, Debug)]
pub(super) struct Lens {
    pub(super) parallel: bool,
    pub(super) eye: [f64; 3],
    /// The map: a row for `t`, one for columns, one for rows; and what is added.
    pub(super) rows: [[f64; 3]; 3],
    pub(super) shift: [f64; 3],
    /// Half the tile's side, in samples from its middle to the last sample.
    pub(super) half: f64,
    /// A point on a ray of the tile has `normal·p + offset ≥ 0`, also when computed in `f64` from any
    /// corner of a box that is at least as far along each component of the normal.
    pub(super) sides: [Side; 4],
    /// Such a point has a computed `t` that is at least this.
    pub(super) least_t: f64,
    pub(super) errors: Errors,
}

/// One side of a tile's rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) normal: [f64; 3],
    pub(super) offset: f64,
}

/// How far what is computed may be from what is meant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors {
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
    /// All this is for coordinates of at most so much, relative to the eye.
    pub(super) reach: f64,
    /// Whether the boxes of projected triangles can be trusted.
    pub(super) small: bool,
}

impl<'a> Rays<'a> {
    /// The rays of a view; `reach` bounds the coordinates of what boxes hold, relative to the eye.
    pub(super) fn new(view: &View<'a>, samples: u32, reach: f64) -> Self {
        let camera = view.camera;
        let grid = camera.sample_grid(samples);
        let size = [count(grid.width()), count(grid.height())];
        let viewport = camera.viewport();
        let spacing = [viewport[0] / size[0], viewport[1] / size[1]];
        // Numbers near 1 neither over- nor underflow in f32: a power of two brings them there.
        let scale = match camera.projection() {
            Projection::Perspective => (camera.distance() / reach).log2().floor().exp2(),
            Projection::Parallel => 1.0 / spacing[0].min(spacing[1]),
        };
        Rays {
            view: *view,
            grid,
            projection: camera.projection(),
            eye: camera.eye().as_dvec3(),
            size,
            viewport,
            spacing,
            scale,
            reach,
        }
    }

    pub(super) fn camera(&self) -> &Camera {
        self.view.camera
    }

    /// The rays of a square of `side` × `side` samples. It may reach over the picture's end.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `v = 2⁻⁵³`. Frames are orthonormal to within `8v`. Write `X`, `Y` for the largest coordinates on
    /// the viewport, the tile's own included, `A` for the reach, `g` for the spacing of samples.
    ///
    /// *Perspective*, with `q = (d + X + Y)/d`. `D` is rounded by 3 in each coordinate of `X|u| + Y|v| +
    /// d|w|`, which is at most `d·q`. The row of `t` is `−w/d`: non-orthonormality brings `8v + 8vq`, `D`
    /// `3·√3·vq`, the row `√3·vq`: `24vq` of 1. The row of columns is `(u + (x/d)·w)/g`, four roundings of
    /// coordinates whose sum is at most `√3·(1 + q)`: `14v·q²d/g`; non-orthonormality `16v·q²d/g`, `D`
    /// `10.5v·q²d/g`, the coordinates of the sample and the middle `2v·qd/g`: `48v·q²d/g`.
    /// A vertex brings 3 roundings of `Σ|row|·A`, and the row its own: `4v·√3·A/d` for `t`,
    /// `4v·2√3·q·A/g` for columns.
    /// A side's normal is rounded by 2 more, and its product with a point on the ray by 4: with
    /// all that was said, `80v·q²d/g + 40v·q·h`.
    ///
    /// *Parallel*, with `Q = X + Y + 4A`, where `|t| ≤ 4A` for all that boxes hold. `O` is rounded by 2, `u/g`
    /// by 2, the shift by 2; with non-orthonormality `20v·Q/g` for a sample; a vertex brings `4v·(√3·A +
    /// 2X)/g`; a side 5 roundings more. The row of `t` is `−w/g`, alike.
    #[inline(always)]
    pub(super) fn lens(&self, column: usize, row: usize, side: usize) -> Lens {
        let camera = self.view.camera;
        let (u, v, w) = (camera.u(), camera.v(), camera.w());
        let half = 0.5 * (count(side) - 1.0);
        let middle = |axis: usize, first: usize| {
            let numerator = 2.0 * (count(first) + half) + 1.0 - self.size[axis];
            self.viewport[axis] * numerator / (2.0 * self.size[axis])
        };
        let (x, y) = (middle(0, column), -middle(1, row));
        let [gx, gy] = self.spacing;
        let g = gx.min(gy);
        let beyond = 0.5 + (half + 1.0) / self.size[0].min(self.size[1]);
        let largest = (self.viewport[0] + self.viewport[1]) * beyond;
        let (a, far) = (self.reach, half.max(1.0));
        let scaled = |v: DVec3| (v * self.scale).to_array();
        match self.projection {
            Projection::Perspective => {
                let d = camera.distance();
                let q = (d + largest) / d;
                let rows = [
                    scaled(-w / d),
                    scaled((u + (x / d) * w) / gx),
                    scaled(-((v + (y / d) * w) / gy)),
                ];
                let wide = half + 128.0 * V * (q * q * d / g + q * far);
                let [t, across, down] = rows.map(DVec3::from_array);
                let side = |normal: DVec3| Side { normal: normal.to_array(), offset: 0.0 };
                let sample = (24.0 * q).max(48.0 * q * q * d / (g * far));
                Lens {
                    parallel: false,
                    eye: self.eye.to_array(),
                    rows,
                    shift: [0.0; 3],
                    half,
                    sides: [
                        side(wide * t - across),
                        side(wide * t + across),
                        side(wide * t - down),
                        side(wide * t + down),
                    ],
                    least_t: 0.0,
                    errors: Errors {
                        corner: V * self.scale * a * (16.0 * q / g).max(8.0 * far / d),
                        sample: V * sample,
                        far,
                        depth: 0.0,
                        t: 64.0 * V * q,
                        reach: a,
                        small: wide - half < 1.0 / 1024.0,
                    },
                }
            }
            Projection::Parallel => {
                let rows = [scaled(-w), (u / gx).to_array(), (-v / gy).to_array()];
                let shift = [0.0, -x / gx, y / gy];
                let q = largest + 4.0 * a;
                let wide = half + 64.0 * V * (q / g + far);
                let [_, across, down] = rows.map(DVec3::from_array);
                let side = |normal: DVec3, shift: f64| Side {
                    normal: normal.to_array(),
                    offset: wide + shift,
                };
                let depth = 40.0 * V * q / g;
                Lens {
                    parallel: true,
                    eye: self.eye.to_array(),
                    rows,
                    shift,
                    half,
                    sides: [
                        side(-across, -shift[1]),
                        side(across, shift[1]),
                        side(-down, -shift[2]),
                        side(down, shift[2]),
                    ],
                    least_t: -depth,
                    errors: Errors {
                        corner: 8.0 * V * (a + largest) / g,
                        sample: 24.0 * V * q / (g * far),
                        far,
                        depth,
                        t: 2.0 * depth,
                        reach: a,
                        small: wide - half < 1.0 / 1024.0,
                    },
                }
            }
        }
    }

    /// The key interval of an interval of `t`, widened to `f32`s.
    ///
    /// A key is larger for what is nearer: `1/t` (perspective) or `−t` (parallel), `t` in the map's
    /// scale. Four roundings in `f64` are far less than the last place of an `f32`, and one is the
    /// conversion's.
    pub(super) fn keys(&self, low: f64, high: f64) -> [f32; 2] {
        let [low, high] = [low * self.scale, high * self.scale];
        let [far, near] = match self.projection {
            Projection::Perspective if low > 0.0 => [1.0 / high, 1.0 / low],
            Projection::Perspective => [1.0 / high.max(0.0), f64::INFINITY],
            Projection::Parallel => [-high, -low],
        };
        #[expect(clippy::cast_possible_truncation, reason = "widened by more than that")]
        let [far, near] = [far as f32, near as f32];
        let (far, near) = (far.next_down().next_down(), near.next_up().next_up());
        // NaN must not look like an order.
        if far <= near { [far, near] } else { [f32::NEG_INFINITY, f32::INFINITY] }
    }

    /// The computed `t`, in the map's scale, beyond which everything is certainly farther than a key.
    pub(super) fn farthest(&self, key: f32, errors: &Errors) -> f64 {
        let key = f64::from(key);
        match self.projection {
            Projection::Perspective if key > 0.0 => (1.0 / key) * (1.0 + errors.t + 8.0 * V),
            Projection::Perspective => f64::INFINITY,
            Projection::Parallel => -key + errors.t,
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
fn count(samples: usize) -> f64 {
    samples as f64
}
