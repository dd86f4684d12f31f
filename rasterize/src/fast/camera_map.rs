//! The map from the world to the raster of samples, and how far rounding may move a point on it.

use super::local_origin::LocalOrigin;
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::roundoff::EPS53;
use bothways_common::raster::Region;
use bothways_common::{Camera, Projection, Raster, SampleGrid};
use glam::DVec3;
use std::ops::Range;

/// One camera's map: how viewport coordinates become rows and columns.
///
/// A sample's column is the real number `x·W/vw + (W − 1)/2`, integer at samples; rows likewise.
#[derive(Debug)]
pub(super) struct CameraMap<'a> {
    pub(super) camera: &'a Camera,
    pub(super) grid: &'a SampleGrid<'a>,
    pub(super) raster: Raster,
    pub(super) u: DVec3,
    pub(super) v: DVec3,
    pub(super) w: DVec3,
    /// `d`.
    pub(super) distance: f64,
    /// The largest `|x|·|u| + |y|·|v| (+ d·|w|)` of the picture, a coordinate each: bounds of the
    /// rays' origins (parallel) or directions (perspective).
    pub(super) reach: DVec3,
    /// Rows (negative: `y` goes up) and columns in a unit of the viewport.
    pub(super) scale: [f64; 2],
    /// The row and column of the viewport's middle.
    pub(super) middle: [f64; 2],
    /// How far a computed row or column of a trusted vertex may be off; see [`CameraMap::new`].
    pub(super) margin: [f64; 2],
    /// From where a parallel camera's offsets are computed.
    pub(super) local: LocalOrigin,
    /// How far from there, in the sum of its coordinates, a vertex of a parallel camera is trusted.
    pub(super) trusted_extent: f64,
}

/// A vertex on the raster.
#[derive(Clone, Copy, Debug)]
pub(super) struct MappedVertex {
    /// Its row and column, to within the margin. `None` if it is too near to the eye's plane, behind
    /// the eye of a perspective camera, or too far out for them to be trusted.
    pub(super) place: Option<[f64; 2]>,
    /// Whether it is certainly not in front of the eye.
    pub(super) behind: bool,
}

impl<'a> CameraMap<'a> {
    /// The map for a scene in a box, `bounds` its corners.
    ///
    /// # How the margin is derived
    ///
    /// Perspective. A visible point of a triangle lies in its corners' hull and on a ray, so its
    /// column lies between the corners' columns; what must be bounded is the error of a corner's
    /// computed column. With `s = ‖p‖₁`, `p·u` and `−p·w` carry at most `3.01ε₅₃·s` (frame
    /// components are at most 1), and a trusted vertex has `ζ = −p·w ≥ 2⁻¹⁰·s`. The quotient
    /// `d·(p·u)/ζ` is off by `d·2⁻⁴¹` plus `2⁻⁴¹` of itself, hence a column by `2⁻⁴¹·W·(d/vw + 1)` as
    /// long as it lies in the picture; if it lies outside, it stays outside. The rays that are meant
    /// are those of the stored frame: it is orthonormal to within `2⁻⁵⁰`, and `D` is rounded by
    /// `2⁻⁵¹` of `|x| + |y| + d`, which moves `x` by at most `2⁻⁴⁹·(vw + vh + d)·(1 + (vw + vh)/d)`.
    /// The margin takes `2⁻³⁶` and `2⁻⁴⁷`: more than 30 and 4 times that.
    ///
    /// Parallel. `p` is taken from the local origin, which lies on the middle ray, so that it is seen where it is;
    /// its coordinates carry two roundings (see [`LocalOrigin::relative`]) and `s` is the sum of these. `p·u` is
    /// off by `5.03ε₅₃·s`, frame and `O` by `2⁻⁴⁹·s`, and a trusted vertex has `s ≤ 2¹⁶·min(vw, vh)`, so a column is
    /// off by less than `2⁻³²·W`; the margin takes `2⁻³⁰`.
    ///
    /// Where the margin exceeds a quarter, no vertex is trusted, and primitives are drawn with the
    /// whole picture as their region.
    pub(super) fn new(
        camera: &'a Camera,
        grid: &'a SampleGrid<'a>,
        raster: Raster,
        bounds: &[DVec3; 8],
    ) -> Self {
        let [vw, vh] = camera.viewport();
        let d = camera.distance();
        let [rows, columns] = raster.size().map(f64::from);
        let across = 0.5 * vw * camera.u().abs() + 0.5 * vh * camera.v().abs();
        let margin = |extent: f64, count: f64| match camera.projection() {
            Projection::Perspective => {
                let frame = (vw + vh + d) * (1.0 + (vw + vh) / d) / extent;
                count * ((-36f64).exp2() * (1.0 + d / extent) + (-47f64).exp2() * frame)
            }
            Projection::Parallel => count * (-30f64).exp2(),
        };
        CameraMap {
            camera,
            grid,
            raster,
            u: camera.u(),
            v: camera.v(),
            w: camera.w(),
            distance: d,
            reach: match camera.projection() {
                Projection::Perspective => across + d * camera.w().abs(),
                Projection::Parallel => across,
            },
            scale: [-rows / vh, columns / vw],
            middle: raster.middle(),
            margin: [margin(vh, rows), margin(vw, columns)],
            local: LocalOrigin::new(camera, bounds),
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
        -self.local.t
    }

    /// The whole picture.
    pub(super) fn whole(&self) -> Region {
        Region { rows: 0..self.grid.height(), columns: 0..self.grid.width() }
    }

    /// Whether the margin is at most this part of a sample.
    pub(super) fn is_within(&self, part: f64) -> bool {
        self.margin[0].max(self.margin[1]) <= part
    }

    /// The vertex stage: an offset from the eye becomes a place on the raster.
    pub(super) fn vertex(&self, p: DVec3) -> MappedVertex {
        let (extent, depth) = (p.abs().element_sum(), -p.dot(self.w));
        // A computed depth carries 3.01ε₅₃·s, so that what is behind has a true one below −120ε₅₃·s. The depth
        // of a point of a triangle whose corners are all behind is then below −120ε₅₃·‖point‖₁; but a point
        // that a ray meets at t > 0 has one of at least the ray's origin, which is 0 for a perspective
        // camera and, by the frame's skew and its own rounding, at least −8ε₅₃·‖O‖₁ for a parallel one,
        // where ‖O‖₁ is at most twice ‖point‖₁.
        let behind = depth < -extent * (-46f64).exp2();
        let p = self.local.relative(p);
        let onto_viewport = match self.projection() {
            Projection::Perspective if depth >= extent * (-10f64).exp2() && depth > 0.0 => {
                Some(self.distance / depth)
            }
            Projection::Parallel if p.abs().element_sum() <= self.trusted_extent => Some(1.0),
            _ => None,
        };
        let trusted = onto_viewport.filter(|_| self.is_within(0.25));
        let place = trusted.map(|onto| self.place(p.dot(self.u) * onto, p.dot(self.v) * onto));
        MappedVertex { place, behind }
    }

    /// The column of a point of the viewport, a real number.
    #[inline(always)]
    pub(super) fn column(&self, x: f64) -> f64 {
        x * self.scale[1] + self.middle[1]
    }

    /// The row and column of a point of the viewport.
    pub(super) fn place(&self, x: f64, y: f64) -> [f64; 2] {
        [y * self.scale[0] + self.middle[0], self.column(x)]
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
                -2.0 * EPS53 * (1.0 + low[axis].abs())
            } else {
                margin[axis]
            };
            samples_between(low[axis] - margin, high[axis] + margin, count)
        };
        Region { rows: range(0, self.grid.height()), columns: range(1, self.grid.width()) }
    }
}

/// The integers from `low` to `high` that are indices below `count`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the conversion saturates: negative numbers and NaN become 0"
)]
#[inline(always)]
pub(super) fn samples_between(low: f64, high: f64, count: usize) -> Range<usize> {
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
