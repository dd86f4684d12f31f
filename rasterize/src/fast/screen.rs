//! Where primitives may appear on the raster of samples: the vertex stage and bounding regions.

use super::clip;
use super::depth::{DepthPlane, sign_in_front};
use super::waypoint::Waypoint;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::raster::Region;
use bothways_common::{Camera, Projection, SampleGrid};
use glam::DVec3;

/// One camera's raster: how viewport coordinates become rows and columns.
///
/// A sample's column is the real number `x·W/vw + (W − 1)/2`, integer at samples; rows likewise.
#[derive(Debug)]
pub(super) struct Screen<'a> {
    pub(super) camera: &'a Camera,
    pub(super) grid: &'a SampleGrid<'a>,
    pub(super) u: DVec3,
    pub(super) v: DVec3,
    pub(super) w: DVec3,
    /// `d`.
    pub(super) distance: f64,
    /// The largest `|x|·|u| + |y|·|v| (+ d·|w|)` of the picture, a coordinate each: bounds of the
    /// rays' origins (parallel) or directions (perspective).
    pub(super) reach: DVec3,
    /// Columns and rows a unit of the viewport.
    pub(super) scale: [f64; 2],
    /// The column and row of the viewport's middle.
    pub(super) middle: [f64; 2],
    /// How far a computed column or row of a trusted vertex may be off; see [`Screen::new`].
    pub(super) margin: [f64; 2],
    /// From where a parallel camera's offsets are computed.
    pub(super) waypoint: Waypoint,
    /// How far from there, in the sum of its coordinates, a vertex of a parallel camera is trusted.
    pub(super) trusted_extent: f64,
}

/// A vertex on the raster.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScreenVertex {
    /// Its column and row, to within the margin. `None` if it is too near to the eye's plane, behind
    /// the eye of a perspective camera, or too far out for them to be trusted.
    place: Option<[f64; 2]>,
    /// Whether it is certainly not in front of the eye.
    behind: bool,
}

impl<'a> Screen<'a> {
    /// # How the margin is derived
    ///
    /// Perspective. A visible point of a triangle lies in its corners' hull and on a ray, so its
    /// column lies between the corners' columns; what must be bounded is the error of a corner's
    /// computed column. With `s = ‖p‖₁`, `p·u` and `−p·w` carry at most `3.01u·s` (`u = 2⁻⁵³`; frame
    /// components are at most 1), and a trusted vertex has `ζ = −p·w ≥ 2⁻¹⁰·s`. The quotient
    /// `d·(p·u)/ζ` is off by `d·2⁻⁴¹` plus `2⁻⁴¹` of itself, hence a column by `2⁻⁴¹·W·(d/vw + 1)` as
    /// long as it lies in the picture; if it lies outside, it stays outside. The rays that are meant
    /// are those of the stored frame: it is orthonormal to within `2⁻⁵⁰`, and `D` is rounded by
    /// `2⁻⁵¹` of `|x| + |y| + d`, which moves `x` by at most `2⁻⁴⁹·(vw + vh + d)·(1 + (vw + vh)/d)`.
    /// The margin takes `2⁻³⁶` and `2⁻⁴⁷`: more than 30 and 4 times that.
    ///
    /// Parallel. `p` is taken from the waypoint, which lies on the middle ray, so that it is seen where it is;
    /// its coordinates carry two roundings (see [`Waypoint::relative`]) and `s` is the sum of these. `p·u` is off
    /// by `5.03u·s`, frame and `O` by `2⁻⁴⁹·s`, and a trusted vertex has `s ≤ 2¹⁶·min(vw, vh)`, so a column is off
    /// by less than `2⁻³²·W`; the margin takes `2⁻³⁰`.
    ///
    /// Where the margin exceeds a quarter, no vertex is trusted, and primitives are drawn with the
    /// whole picture as their region.
    pub(super) fn new(camera: &'a Camera, grid: &'a SampleGrid<'a>, bounds: &[DVec3; 8]) -> Self {
        let [vw, vh] = camera.viewport();
        let d = camera.distance();
        #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
        let size = [grid.width() as f64, grid.height() as f64];
        let across = 0.5 * vw * camera.u().abs() + 0.5 * vh * camera.v().abs();
        let margin = |extent: f64, count: f64| match camera.projection() {
            Projection::Perspective => {
                let frame = (vw + vh + d) * (1.0 + (vw + vh) / d) / extent;
                count * ((-36f64).exp2() * (1.0 + d / extent) + (-47f64).exp2() * frame)
            }
            Projection::Parallel => count * (-30f64).exp2(),
        };
        Screen {
            camera,
            grid,
            u: camera.u(),
            v: camera.v(),
            w: camera.w(),
            distance: d,
            reach: match camera.projection() {
                Projection::Perspective => across + d * camera.w().abs(),
                Projection::Parallel => across,
            },
            scale: [size[0] / vw, -size[1] / vh],
            middle: size.map(|count| 0.5 * (count - 1.0)),
            margin: [margin(vw, size[0]), margin(vh, size[1])],
            waypoint: Waypoint::new(camera, bounds),
            trusted_extent: 16f64.exp2() * vw.min(vh),
        }
    }

    /// Perspective or parallel.
    pub(super) fn projection(&self) -> Projection {
        self.camera.projection()
    }

    /// The depth of the eye: that of a parallel camera is less than what it sees has, that of a perspective camera is
    /// 0, on the other side of which infinity lies.
    pub(super) fn depth_of_eye(&self) -> f64 {
        -self.waypoint.t
    }

    /// The whole picture.
    pub(super) fn whole(&self) -> Region {
        Region { rows: 0..self.grid.height(), columns: 0..self.grid.width() }
    }

    /// The vertex stage: an offset from the eye becomes a place on the raster.
    pub(super) fn vertex(&self, p: DVec3) -> ScreenVertex {
        let (extent, depth) = (p.abs().element_sum(), -p.dot(self.w));
        // A computed depth carries 3.01u·s, so that what is behind has a true one below −120u·s. The depth
        // of a point of a triangle whose corners are all behind is then below −120u·‖point‖₁; but a point
        // that a ray meets at t > 0 has one of at least the ray's origin, which is 0 for a perspective
        // camera and, by the frame's skew and its own rounding, at least −8u·‖O‖₁ for a parallel one,
        // where ‖O‖₁ is at most twice ‖point‖₁.
        let behind = depth < -extent * (-46f64).exp2();
        let p = self.waypoint.relative(p);
        let onto_viewport = match self.projection() {
            Projection::Perspective if depth >= extent * (-10f64).exp2() && depth > 0.0 => {
                Some(self.distance / depth)
            }
            Projection::Parallel if p.abs().element_sum() <= self.trusted_extent => Some(1.0),
            _ => None,
        };
        let trusted = onto_viewport.filter(|_| self.margin[0].max(self.margin[1]) <= 0.25);
        let place = trusted.map(|onto| self.place(p.dot(self.u) * onto, p.dot(self.v) * onto));
        ScreenVertex { place, behind }
    }

    /// The samples that a triangle may cover; `corners` are its offsets from the eye.
    pub(super) fn triangle_region<F: Fault>(
        &self,
        vertices: &[ScreenVertex; 3],
        corners: impl FnOnce() -> [DVec3; 3],
    ) -> Region {
        if vertices.iter().all(|vertex| vertex.behind) {
            // All of it lies behind: with t > 0 no ray gets there.
            return Region { rows: 0..0, columns: 0..0 };
        }
        let [Some(a), Some(b), Some(c)] = vertices.map(|vertex| vertex.place) else {
            let sharp = self.margin[0].max(self.margin[1]) <= 0.0625;
            return match self.projection() {
                Projection::Perspective if sharp => clip::region(self, &corners()),
                _ => self.whole(),
            };
        };
        let both = |least: fn(f64, f64) -> f64| {
            [least(least(a[0], b[0]), c[0]), least(least(a[1], b[1]), c[1])]
        };
        self.region::<F>(both(f64::min), both(f64::max), self.margin)
    }

    /// The samples that a sphere may cover.
    ///
    /// Perspective: in the plane of `u` and `w` its silhouette is the two tangents from the eye to a
    /// circle around `(c_u, ζ)`, of slopes `(c_u·ζ ± r·√(c_u² + ζ² − r²))/(ζ² − r²)`. Trusted is `ζ − r
    /// ≥ 2⁻¹⁰·s` with `s = ‖c‖₁ + r`: then `ζ² − r²` carries `2⁻³⁹` of itself and is at least `2⁻²⁰·s²`,
    /// the numerator carries `2⁻⁴⁸·s²`, and the slope is off by `2⁻²⁷` of `1 + |slope|`. The extra
    /// margin takes `2⁻²⁴`.
    pub(super) fn sphere_region<F: Fault>(&self, center: DVec3, radius: f64) -> Region {
        let (s, depth) = (center.abs().element_sum() + radius, -center.dot(self.w));
        if depth + radius < -s * (-46f64).exp2() {
            return Region { rows: 0..0, columns: 0..0 };
        }
        let relative = self.waypoint.relative(center);
        let along = [relative.dot(self.u), relative.dot(self.v)];
        match self.projection() {
            Projection::Perspective if depth - radius >= s * (-10f64).exp2() => {
                let (between, d) = ((depth - radius) * (depth + radius), self.distance);
                let slopes = along.map(|c| {
                    let root = radius * (c * c + between).sqrt();
                    [(c * depth - root) / between, (c * depth + root) / between]
                });
                let [[left, right], [bottom, top]] = slopes.map(|pair| pair.map(|slope| slope * d));
                let extra = |axis: usize| {
                    #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
                    let count = [self.grid.width() as f64, self.grid.height() as f64][axis];
                    (-24f64).exp2() * (d * self.scale[axis].abs() + count)
                };
                let margin = [self.margin[0] + extra(0), self.margin[1] + extra(1)];
                self.region::<F>(self.place(left, top), self.place(right, bottom), margin)
            }
            Projection::Parallel
                if relative.abs().element_sum() + radius <= self.trusted_extent =>
            {
                let low = self.place(along[0] - radius, along[1] + radius);
                let high = self.place(along[0] + radius, along[1] - radius);
                self.region::<F>(low, high, self.margin)
            }
            _ => self.whole(),
        }
    }

    /// The samples beyond a plane's horizon, where its depth says that `t` may be positive.
    pub(super) fn plane_region(&self, depth: &DepthPlane) -> Region {
        let (x, y) = (self.grid.x(), self.grid.y());
        let side = sign_in_front(self.projection());
        let widest = x.last().map_or(0.0, |x| x.abs()) * depth.across.abs();
        let highest = y.first().map_or(0.0, |y| y.abs()) * depth.up.abs();
        let eye = self.depth_of_eye();
        let least = eye - depth.error - (-50f64).exp2() * eye.abs();
        let may = |value: f64, rest: f64| {
            let most = side * value + rest;
            most >= least || most.is_nan()
        };
        let row = |row: &usize| may(depth.at_centre + y[*row] * depth.up, widest);
        let column = |column: &usize| may(depth.at_centre + x[*column] * depth.across, highest);
        // On a row the largest value over all columns is affine in the row, so those that pass are
        // consecutive.
        let span = |count: usize, passes: &dyn Fn(&usize) -> bool| {
            let first = (0..count).find(passes).unwrap_or(count);
            let end = (first..count).rev().find(passes).map_or(first, |last| last + 1);
            first..end
        };
        Region { rows: span(y.len(), &row), columns: span(x.len(), &column) }
    }

    /// The column of a point of the viewport, a real number.
    pub(super) fn column(&self, x: f64) -> f64 {
        x * self.scale[0] + self.middle[0]
    }

    /// The column and row of a point of the viewport.
    fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [self.column(x), y * self.scale[1] + self.middle[1]]
    }

    /// The samples between two places, widened by a margin.
    pub(super) fn region<F: Fault>(
        &self,
        low: [f64; 2],
        high: [f64; 2],
        margin: [f64; 2],
    ) -> Region {
        let range = |axis: usize, count: usize| {
            let margin = if F::is(Planted::ShrunkBox) {
                -f64::EPSILON * (1.0 + low[axis].abs())
            } else {
                margin[axis]
            };
            samples_between(low[axis] - margin, high[axis] + margin, count)
        };
        Region { rows: range(1, self.grid.height()), columns: range(0, self.grid.width()) }
    }
}

/// The integers from `low` to `high` that are indices below `count`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates: negative numbers and NaN become 0"
)]
pub(super) fn samples_between(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let start = low.ceil() as usize;
    let end = if high < 0.0 { 0 } else { (high.floor() as usize).saturating_add(1).min(count) };
    start..end.max(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_between_includes_both_ends() {
        assert_eq!(samples_between(1.0, 3.0, 10), 1..4);
        assert_eq!(samples_between(1.1, 3.9, 10), 2..4);
        assert_eq!(samples_between(-5.0, -0.5, 10), 0..0);
        assert_eq!(samples_between(-5.0, 1e300, 10), 0..10);
        assert!(samples_between(12.0, 14.0, 10).is_empty());
        assert!(samples_between(2.3, 2.7, 10).is_empty());
    }
}
