//! Edge functions in floating point, with a fill rule: what most of the rules are made of.

use super::draw::{Fragment, Fragments, Rasterizer};
use super::projection::{CameraMap, Vertex, covering};
use crate::real::Real;
use crate::samples::{SamplePoint, Samples, whole};
use bothways_common::{Projection, Region};

/// Which triangle owns a sample exactly on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fill {
    /// The triangle whose left or top edge it is.
    TopLeft,
    /// Both triangles.
    Inclusive,
    /// No triangle.
    Exclusive,
}

/// What the depth buffer holds.
#[derive(Clone, Copy, Debug)]
pub(super) enum DepthBuffer {
    /// `t`, in the arithmetic of the rule.
    Float,
    /// A whole number from 0 at the near depth to 2²⁴ − 1 at the far one.
    Fixed24 { near: f64, far: f64 },
}

/// A rasterizer with edge functions in `f32` or `f64`.
#[derive(Debug)]
pub(super) struct FloatEdges<'a, R> {
    pub(super) samples: Samples<'a>,
    pub(super) map: CameraMap<R>,
    pub(super) fill: Fill,
    pub(super) near: f64,
    pub(super) depth: DepthBuffer,
    /// Where samples lie in their cells, to the right and down alike.
    pub(super) place: R,
}

/// Nothing nearer than this part of the viewport's distance is drawn: a perspective projection needs some limit.
const NEAR: f64 = 1.0 / 4096.0;

/// The near depth of a camera, where a rule sets no other: a 4096th of the viewport's distance, and 0 for a parallel
/// camera.
pub(super) fn least_depth(samples: &Samples) -> f64 {
    match samples.camera().projection() {
        Projection::Perspective => NEAR * samples.camera().distance(),
        Projection::Parallel => 0.0,
    }
}

impl<'a, R: Real> FloatEdges<'a, R> {
    /// The rasterizer that does everything as it should, in its arithmetic.
    pub(super) fn new(samples: Samples<'a>, place: SamplePoint) -> FloatEdges<'a, R> {
        let [offset, _] = place.offset(0, 0);
        FloatEdges {
            samples,
            map: CameraMap::new(&samples),
            fill: Fill::TopLeft,
            near: least_depth(&samples),
            depth: DepthBuffer::Float,
            place: R::of(offset),
        }
    }
}

impl<R: Real> Rasterizer for FloatEdges<'_, R> {
    type Real = R;
    type Triangle = Triangle<R>;

    fn samples(&self) -> &Samples<'_> {
        &self.samples
    }

    fn map(&self) -> &CameraMap<R> {
        &self.map
    }

    fn near(&self) -> f64 {
        self.near
    }

    fn set_up(&self, corners: [Vertex; 3]) -> Option<Triangle<R>> {
        let mut corners = corners;
        let mut at = corners.map(|corner| self.map.raster(corner));
        if edge(at[0], at[1], at[2]) < R::ZERO {
            corners.swap(1, 2);
            at.swap(1, 2);
        }
        let area = edge(at[0], at[1], at[2]);
        if !(area > R::ZERO && area.double().is_finite()) {
            return None;
        }
        let linear = corners.map(|[.., depth]| self.map.linear_depth(depth));
        let (map, depth) = (self.map, self.depth);
        // The edge opposite to each corner, against whose edge function the corner is weighed.
        let owns = [(1, 2), (2, 0), (0, 1)].map(|(from, to)| self.fill.owns(at[from], at[to]));
        let window = linear.map(|linear| depth.window(&map, linear));
        Some(Triangle { at, owns, linear, window, area, map, depth, place: self.place })
    }

    fn key(&self, t: f64) -> f64 {
        let depth = match self.map.projection {
            Projection::Perspective => t * self.map.distance.double(),
            Projection::Parallel => t,
        };
        match self.depth {
            DepthBuffer::Float => t,
            DepthBuffer::Fixed24 { .. } => {
                let window = self.depth.window(&self.map, self.map.linear_depth(depth));
                stored_in_24_bits(f64::from(window))
            }
        }
    }
}

/// The edge function: positive where `p` is on the right of `a → b` as the raster shows it, `y` down. The formula of
/// textbooks: it subtracts `a` from both other points.
fn edge<R: Real>(a: [R; 2], b: [R; 2], p: [R; 2]) -> R {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl Fill {
    /// Whether the triangle on the positive side of an edge owns the samples on it.
    fn owns<R: Real>(self, a: [R; 2], b: [R; 2]) -> bool {
        match self {
            // Left edges go up, and top edges to the right: a sample that moves a little to the right, then down, comes
            // to lie within.
            Fill::TopLeft => b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]),
            Fill::Inclusive => true,
            Fill::Exclusive => false,
        }
    }
}

impl DepthBuffer {
    /// The depth at a vertex as it is interpolated: from 0 at the near depth to 1 at the far one.
    #[expect(clippy::cast_possible_truncation, reason = "a GPU's vertex has 32-bit coordinates")]
    fn window<R: Real>(self, map: &CameraMap<R>, linear: R) -> f32 {
        let DepthBuffer::Fixed24 { near, far } = self else { return 0.0 };
        let linear = linear.double();
        let window = match map.projection {
            Projection::Perspective => far / (far - near) * (1.0 - near * linear),
            Projection::Parallel => (linear - near) / (far - near),
        };
        window as f32
    }
}

/// A depth from 0 to 1 as a buffer of 24 bits stores it.
fn stored_in_24_bits(window: f64) -> f64 {
    const LARGEST: f64 = 16_777_215.0;
    (window.clamp(0.0, 1.0) * LARGEST).round()
}

/// A triangle on the raster, clockwise as it is seen.
#[derive(Debug)]
pub(super) struct Triangle<R> {
    at: [[R; 2]; 3],
    /// Whether the samples on the edge opposite to each corner belong to it.
    owns: [bool; 3],
    linear: [R; 3],
    window: [f32; 3],
    area: R,
    map: CameraMap<R>,
    depth: DepthBuffer,
    place: R,
}

impl<R: Real> Fragments for Triangle<R> {
    fn bounds(&self, picture: &Region) -> Region {
        let extent = |axis: usize| {
            let all = self.at.map(|at| at[axis].double());
            (all[0].min(all[1]).min(all[2]), all[0].max(all[1]).max(all[2]))
        };
        let ((left, right), (top, bottom)) = (extent(0), extent(1));
        Region {
            rows: covering(top, bottom, &picture.rows),
            columns: covering(left, right, &picture.columns),
        }
    }

    fn fragment(&self, row: usize, column: usize) -> Option<Fragment> {
        let p = [column, row].map(|index| R::of(whole(index)) + self.place);
        let [a, b, c] = self.at;
        let edges = [edge(b, c, p), edge(c, a, p), edge(a, b, p)];
        for (edge, owns) in edges.into_iter().zip(self.owns) {
            if edge < R::ZERO || (edge == R::ZERO && !owns) {
                return None;
            }
        }
        let weights = edges.map(|edge| edge / self.area);
        let [p, q, r] = [0, 1, 2].map(|k| weights[k] * self.linear[k]);
        let t = self.map.t(p + q + r).double();
        let key = match self.depth {
            DepthBuffer::Float => t,
            DepthBuffer::Fixed24 { .. } => {
                let [p, q, r] = [0, 1, 2].map(|k| f32::of(weights[k].double()) * self.window[k]);
                stored_in_24_bits(f64::from(p + q + r))
            }
        };
        (t > 0.0).then_some(Fragment { key, t })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_and_top_edges_own_their_samples() {
        // Clockwise as seen, y down: top edge to the right, right edge down, bottom to the left, left edge up.
        let [top_left, top_right] = [[0.0, 0.0], [2.0, 0.0]];
        let [bottom_right, bottom_left] = [[2.0, 2.0], [0.0, 2.0]];
        let owns = |a: [f64; 2], b| Fill::TopLeft.owns(a, b);
        assert!(owns(top_left, top_right) && owns(bottom_left, top_left));
        assert!(!owns(top_right, bottom_right) && !owns(bottom_right, bottom_left));
        assert!(edge(top_left, top_right, [1.0, 1.0]) > 0.0);
    }

    #[test]
    fn depths_have_24_bits() {
        assert_eq!(stored_in_24_bits(0.0), 0.0);
        assert_eq!(stored_in_24_bits(7.0), 16_777_215.0);
        assert_eq!(stored_in_24_bits(0.5), 8_388_608.0);
        assert_eq!(stored_in_24_bits(1e-9), 0.0);
    }
}
