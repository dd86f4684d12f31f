//! The rays of one tile: their map, and the four sides between which they lie.

use super::box_culling::{self, BoxCulling};
use crate::fast::camera_map::{Axes, CameraMap, MapErrors, Reach, least};
use crate::fast::local_errors::{self, LocalErrors};
use crate::fast::straight_rays::StraightRays;
use crate::fast::world_affine::WorldAffine;
use bothways_common::Projection;
use glam::DVec3;

/// The rays of a square of samples.
#[derive(Clone, Debug)]
pub(crate) struct TileFrustum<'a> {
    pub(crate) template: &'a FrustumTemplate,
    /// The map: a row for `t`, one for columns, one for rows; and what is added.
    pub(crate) rows: [[f64; 3]; 3],
    pub(crate) shift: [f64; 3],
    /// The same by the coordinates of a point: what `x`, `y` and `z` bring to `t`, columns and rows, and what is added. The fourth
    /// numbers are 0.
    pub(crate) by_axis: [[f64; 4]; 4],
    /// The row and column of the tile's middle, and its `x` and `y` on the viewport.
    pub(crate) middle: [f64; 2],
    pub(crate) viewport: [f64; 2],
    /// The map's rows in `f32`.
    pub(crate) normals: [[f32; 3]; 3],
    /// The tile's sides: not negative, but for [`BoxCulling::sides_error`], where one of its rays meets a box.
    pub(crate) sides: [WorldAffine; 4],
}

/// What the frusta of all tiles of one size share.
#[derive(Clone, Debug)]
pub(crate) struct FrustumTemplate {
    pub(crate) parallel: bool,
    /// Samples along one side of a tile, and half of the way from the first to the last.
    pub(crate) side: usize,
    pub(crate) half: f64,
    pub(crate) eye: [f64; 3],
    /// The same rays as exact numbers, if none of their numbers is rounded.
    pub(crate) straight: Option<StraightRays>,
    axes: Axes,
    /// Of the raster: from a row and a column to the next, and those of its middle.
    pub(crate) spacing: [f64; 2],
    middle: [f64; 2],
    pub(crate) errors: MapErrors,
    /// What boxes need, and what vertices need.
    pub(crate) boxes: BoxCulling,
    pub(crate) local: LocalErrors,
}

impl FrustumTemplate {
    /// For tiles of `side` × `side` samples.
    pub(crate) fn new(map: &CameraMap, side: usize) -> FrustumTemplate {
        let camera = map.view.camera;
        let half = 0.5 * (count(side) - 1.0);
        let (axes, errors) = (map.axes(), map.errors(half));
        let sizes = FrustumSizes::new(map, &axes, half);
        FrustumTemplate {
            parallel: sizes.parallel,
            side,
            half,
            eye: camera.eye().as_dvec3().to_array(),
            straight: StraightRays::new(camera, &map.grid, &map.raster),
            spacing: map.raster.spacing(),
            middle: map.raster.middle(),
            boxes: sizes.box_culling(map, &axes, &errors),
            local: sizes.local_errors(&errors),
            axes,
            errors,
        }
    }

    /// A fault: nothing is known of where boxes, leaves and small triangles are seen.
    pub(crate) fn make_errors_infinite(&mut self) {
        self.boxes.t_error = f32::INFINITY;
        self.boxes.t_before = f32::NEG_INFINITY;
        self.boxes.least_t = f32::NEG_INFINITY;
        self.boxes.sides_error = f32::INFINITY;
        self.local = LocalErrors::UNKNOWN;
        self.errors.small = false;
    }

    /// The rays of the tile whose first sample this is. It may reach over the picture's end.
    #[inline(always)]
    pub(crate) fn frustum(&self, [row, column]: [usize; 2]) -> TileFrustum<'_> {
        let ([t, across, down], slopes) = (self.axes.rows, self.axes.slopes);
        let middle = [count(row) + self.half, count(column) + self.half];
        let from_middle = |axis: usize| self.spacing[axis] * (middle[axis] - self.middle[axis]);
        let (x, y) = (from_middle(1), -from_middle(0));
        let (across, down) = (across + x * slopes[1], down - y * slopes[0]);
        let wide = self.errors.wide;
        let (shift, side, offset) = if self.parallel {
            ([0.0, -x / self.spacing[1], y / self.spacing[0]], DVec3::ZERO, wide)
        } else {
            ([0.0; 3], wide * t, 0.0)
        };
        // About the origin of the boxes.
        let plane = |normal: DVec3, offset: f64| {
            WorldAffine::new(normal, normal.dot(self.boxes.from_eye) + offset)
        };
        let sides = [
            plane(side - across, offset - shift[1]),
            plane(side + across, offset + shift[1]),
            plane(side - down, offset - shift[2]),
            plane(side + down, offset + shift[2]),
        ];
        let normals = [t, across, down].map(|row| row.as_vec3().to_array());
        let rows = [t.to_array(), across.to_array(), down.to_array()];
        let along = |axis: usize| [t[axis], across[axis], down[axis], 0.0];
        let by_axis = [along(0), along(1), along(2), [shift[0], shift[1], shift[2], 0.0]];
        let viewport = [x, y];
        TileFrustum { template: self, rows, shift, by_axis, middle, viewport, normals, sides }
    }
}

impl TileFrustum<'_> {
    /// A row or column of the tile, counted from its middle.
    #[inline(always)]
    pub(crate) fn centered(&self, index: usize) -> f32 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "halves of small integers"
        )]
        let centered = (index as f64 - self.template.half) as f32;
        centered
    }
}

/// What bounds the values of the map, in all tiles.
struct FrustumSizes {
    parallel: bool,
    /// The coordinates of the row of `t`, and those of the rows of columns and rows.
    of_t: DVec3,
    of_place: DVec3,
    /// The largest coordinates on the viewport, and those times the number of samples there.
    places: f64,
}

impl FrustumSizes {
    fn new(map: &CameraMap, axes: &Axes, half: f64) -> FrustumSizes {
        let largest = map.largest(half);
        let [t, across, down] = axes.rows.map(DVec3::abs);
        let [of_row, of_column] = axes.slopes.map(|slope| largest * slope.abs());
        FrustumSizes {
            parallel: map.depth.projection == Projection::Parallel,
            of_t: t,
            of_place: (across + of_column).max(down + of_row),
            places: largest / least(map.raster.spacing()),
        }
    }

    fn box_culling(&self, map: &CameraMap, axes: &Axes, errors: &MapErrors) -> BoxCulling {
        let Reach { origin, from_origin, .. } = map.reach;
        let from_eye = origin.as_dvec3() - map.view.camera.eye().as_dvec3();
        let [of_t, of_column, of_row] = axes.rows.map(|row| row.dot(from_eye).abs());
        // From any tile's middle the origin's column, times `t` of a perspective camera, is not farther.
        let beyond_middle = if self.parallel { 0.0 } else { self.places * of_t };
        let place_of_origin = of_column.max(of_row);
        BoxCulling::new(
            origin,
            from_eye,
            axes.rows[0],
            &box_culling::BoxSizes {
                reach: errors.reach,
                near: from_origin,
                place_of_origin: place_of_origin + beyond_middle,
                t: self.of_t,
                place: self.of_place,
                offset: if self.parallel { self.places } else { 0.0 },
                wide: errors.wide,
                beside: if self.parallel { 0.0 } else { errors.wide },
            },
        )
    }

    /// The error of a column counts once, that of `t` as often as there are columns from the middle, at most three
    /// times `far`; for a vertex, once for the local projection's and half for the rows' errors of the offset from it.
    fn local_errors(&self, errors: &MapErrors) -> LocalErrors {
        let size_of_t = self.of_t.element_sum();
        let most_t = if self.parallel { 1.0 } else { errors.reach * size_of_t };
        let exact = 10.0 * errors.corner + 4.0 * errors.sample * errors.far * most_t;
        LocalErrors::new(&local_errors::MapSizes {
            reach: errors.reach,
            place: self.of_place.element_sum(),
            t: if self.parallel { 0.0 } else { size_of_t },
            wide: errors.wide,
            exact,
        })
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
fn count(samples: usize) -> f64 {
    samples as f64
}
