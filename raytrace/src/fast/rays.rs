//! The rays of one tile as a linear map: from a point in the world to the ray through it.
//!
//! For the rays of a perspective camera a point is `p = t·D`, and `D` is affine in column and row. The
//! map takes `p` to `(t, t·δj, t·δi)`, with `δj` columns and `δi` rows from the tile's middle, up to a
//! scale. For a parallel camera `p = O + t·D`, and the map takes it to `(t, δj, δi)`. Both times a ray is
//! known by `(1, δj, δi)`; edge functions, depths and the sides of a tile are determinants and planes
//! in these coordinates. Determinants keep their signs, since the map keeps orientation.
//!
//! What is computed here is computed with rounding: [`Errors`] bounds what that does.

use super::aligned::Straight;
use super::anchor;
use super::rough::{self, Plane};
use bothways_common::{Camera, Projection, SampleGrid, View};
use glam::{DVec3, Vec3};

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
    reach: Reach,
}

/// How far what boxes hold reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// No vertex has a larger coordinate relative to the eye.
    pub(super) from_eye: f64,
    /// A point of the world, the eye or one that is much nearer, and the largest coordinate relative to it.
    pub(super) origin: Vec3,
    pub(super) from_origin: f64,
}

/// The rays of a square of samples.
#[derive(Clone, Debug)]
pub(super) struct Lens<'a> {
    pub(super) kind: &'a LensKind,
    /// The map: a row for `t`, one for columns, one for rows; and what is added.
    pub(super) rows: [[f64; 3]; 3],
    pub(super) shift: [f64; 3],
    /// The column and row of the tile's middle.
    pub(super) middle: [f64; 2],
    /// The map's rows in `f32`.
    pub(super) normals: [[f32; 3]; 3],
    /// The tile's sides: not negative, but for [`rough::Kind::sides_error`], where one of its rays meets a box.
    pub(super) sides: [Plane; 4],
}

/// What the lenses of all tiles of one size have in common.
#[derive(Clone, Debug)]
pub(super) struct LensKind {
    pub(super) parallel: bool,
    /// Samples along one side of a tile, and half of the way from the first to the last.
    pub(super) side: usize,
    pub(super) half: f64,
    /// That half and what rounding may add: a point on one of a tile's rays is no more columns and rows
    /// from its middle, also when that is computed in `f64` from any corner of a box that is at least as
    /// far that way.
    wide: f64,
    pub(super) eye: [f64; 3],
    /// The same rays without rounding, where there is none.
    pub(super) straight: Option<Straight>,
    /// The map's rows for the middle of the picture, and what those of columns and rows gain with the
    /// coordinates on the viewport.
    axes: [DVec3; 3],
    slopes: [DVec3; 2],
    pub(super) errors: Errors,
    /// What boxes need, and what vertices need.
    pub(super) rough: rough::Kind,
    pub(super) places: anchor::Errors,
}

impl LensKind {
    /// A fault: nothing is known of where boxes, leaves and small triangles are seen.
    pub(super) fn distrust(&mut self) {
        self.rough.t_error = f32::INFINITY;
        self.rough.least_t = f32::NEG_INFINITY;
        self.rough.sides_error = f32::INFINITY;
        self.places = anchor::Errors::UNKNOWN;
        self.errors.small = false;
    }
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
    /// The rays of a view; `reach` bounds the coordinates of what boxes hold.
    pub(super) fn new(view: &View<'a>, samples: u32, reach: Reach) -> Self {
        let camera = view.camera;
        let grid = camera.sample_grid(samples);
        let size = [count(grid.width()), count(grid.height())];
        let viewport = camera.viewport();
        let spacing = [viewport[0] / size[0], viewport[1] / size[1]];
        // Numbers near 1 neither over- nor underflow in f32: a power of two brings them there.
        let scale = match camera.projection() {
            Projection::Perspective => (camera.distance() / reach.from_eye).log2().floor().exp2(),
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

    /// What all squares of `side` × `side` samples share.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `v = 2⁻⁵³`. Frames are orthonormal to within `8v`. Write `X`, `Y` for the largest coordinates on
    /// the viewport, the tile's own included, `A` for the reach, `g` for the spacing of samples.
    ///
    /// *Perspective*, with `q = (d + X + Y)/d`. `D` is rounded by 3 in each coordinate of `X|u| + Y|v| +
    /// d|w|`, which is at most `d·q`. The row of `t` is `−w/d`: non-orthonormality brings `8v + 8vq`, `D`
    /// `3·√3·vq`, the row `√3·vq`: `24vq` of 1. The row of columns is `u/g + x·(w/(d·g))`, two
    /// roundings of `u` and five of `(x/d)·w`, whose coordinates' sums are at most `√3` and `√3·(q − 1)`: less
    /// than `14v·q²d/g`; non-orthonormality `16v·q²d/g`, `D`
    /// `10.5v·q²d/g`, the coordinates of the sample and the middle `2v·qd/g`: `48v·q²d/g`.
    /// A vertex brings 3 roundings of `Σ|row|·A`, and the row its own: `4v·√3·A/d` for `t`,
    /// `4v·2√3·q·A/g` for columns.
    /// A side's normal is rounded by 2 more, and its product with a point on the ray by 4: with
    /// all that was said, `80v·q²d/g + 40v·q·h`.
    ///
    /// *Parallel*, with `Q = X + Y + 4A`, where `|t| ≤ 4A` for all that boxes hold. `O` is rounded by 2, `u/g`
    /// by 2, the shift by 2; with non-orthonormality `20v·Q/g` for a sample; a vertex brings `4v·(√3·A +
    /// 2X)/g`; a side 5 roundings more. The row of `t` is `−w/g`, alike.
    pub(super) fn lens_kind(&self, side: usize) -> LensKind {
        let camera = self.view.camera;
        let (u, v, w) = (camera.u(), camera.v(), camera.w());
        let half = 0.5 * (count(side) - 1.0);
        let [gx, gy] = self.spacing;
        let g = gx.min(gy);
        // The last tile may reach over the picture's end.
        let beyond = 0.5 + (half + 1.0) / self.size[0].min(self.size[1]);
        let largest = (self.viewport[0] + self.viewport[1]) * beyond;
        let (a, far) = (self.reach.from_eye, half.max(1.0));
        let (errors, wide, axes, slopes);
        match self.projection {
            Projection::Perspective => {
                let d = camera.distance();
                let q = (d + largest) / d;
                let sample = (24.0 * q).max(48.0 * q * q * d / (g * far));
                wide = half + 128.0 * V * (q * q * d / g + q * far);
                errors = Errors {
                    corner: V * self.scale * a * (16.0 * q / g).max(8.0 * far / d),
                    sample: V * sample,
                    far,
                    depth: 0.0,
                    t: 64.0 * V * q,
                    reach: a,
                    small: wide - half < 1.0 / 1024.0,
                };
                axes = [-w / d, u / gx, -v / gy].map(|axis| axis * self.scale);
                slopes = [gx, gy].map(|g| w * (self.scale / (d * g)));
            }
            Projection::Parallel => {
                let q = largest + 4.0 * a;
                let depth = 40.0 * V * q / g;
                wide = half + 64.0 * V * (q / g + far);
                errors = Errors {
                    corner: 8.0 * V * (a + largest) / g,
                    sample: 24.0 * V * q / (g * far),
                    far,
                    depth,
                    t: 2.0 * depth,
                    reach: a,
                    small: wide - half < 1.0 / 1024.0,
                };
                axes = [-w * self.scale, u / gx, -v / gy];
                slopes = [DVec3::ZERO; 2];
            }
        }
        let parallel = self.projection == Projection::Parallel;
        let of = |k: usize| axes[k].abs() + largest * slopes[k - 1].abs();
        let size_of_t = axes[0].abs();
        let Reach { origin, from_origin, .. } = self.reach;
        let from_eye = origin.as_dvec3() - self.eye;
        // From any tile's middle the origin's column, times `t` of a perspective camera, is not farther.
        let beyond_middle = if parallel { 0.0 } else { largest / g * axes[0].dot(from_eye).abs() };
        let place_of_origin = axes[1].dot(from_eye).abs().max(axes[2].dot(from_eye).abs());
        let rough = rough::Kind::new(
            origin,
            from_eye,
            axes[0],
            &rough::Sizes {
                reach: a,
                near: from_origin,
                place_of_origin: place_of_origin + beyond_middle,
                t: size_of_t,
                place: of(1).max(of(2)),
                offset: if parallel { largest / g } else { 0.0 },
                wide,
                beside: if parallel { 0.0 } else { wide },
            },
        );
        // That of a column counts once, that of `t` as often as there are columns from the middle, at most three times
        // `far`; for a vertex, once for the anchor and half for the rows' errors of the offset from it.
        let most_t = if parallel { 1.0 } else { a * size_of_t.element_sum() };
        let exact = 10.0 * errors.corner + 4.0 * errors.sample * far * most_t;
        let places = anchor::Errors::new(&anchor::Sizes {
            reach: a,
            place: of(1).max(of(2)).element_sum(),
            t: if parallel { 0.0 } else { size_of_t.element_sum() },
            wide,
            exact,
        });
        let eye = self.eye.to_array();
        let straight = Straight::new(camera, &self.grid);
        LensKind { parallel, side, half, wide, eye, straight, axes, slopes, errors, rough, places }
    }

    /// The rays of a square of samples. It may reach over the picture's end.
    #[inline(always)]
    pub(super) fn lens<'k>(&self, kind: &'k LensKind, column: usize, row: usize) -> Lens<'k> {
        let [t, across, down] = kind.axes;
        let middle = |axis: usize, first: usize| {
            let numerator = 2.0 * (count(first) + kind.half) + 1.0 - self.size[axis];
            self.spacing[axis] * (0.5 * numerator)
        };
        let (x, y) = (middle(0, column), -middle(1, row));
        let (across, down) = (across + x * kind.slopes[0], down - y * kind.slopes[1]);
        let (shift, side, offset) = if kind.parallel {
            ([0.0, -x / self.spacing[0], y / self.spacing[1]], DVec3::ZERO, kind.wide)
        } else {
            ([0.0; 3], kind.wide * t, 0.0)
        };
        // About the origin of `rough`.
        let plane = |normal: DVec3, offset: f64| {
            Plane::new(normal, normal.dot(kind.rough.from_eye) + offset)
        };
        let sides = [
            plane(side - across, offset - shift[1]),
            plane(side + across, offset + shift[1]),
            plane(side - down, offset - shift[2]),
            plane(side + down, offset + shift[2]),
        ];
        let normals = [t, across, down].map(|row| row.as_vec3().to_array());
        let rows = [t.to_array(), across.to_array(), down.to_array()];
        let middle = [count(column) + kind.half, count(row) + kind.half];
        Lens { kind, rows, shift, middle, normals, sides }
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
