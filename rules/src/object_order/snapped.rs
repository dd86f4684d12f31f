//! `snapped:B`: vertices rounded to 1/2^B pixel, then integer edge functions with the top-left rule, as GPUs do.
//!
//! Positions are computed in `f32` in the order in which Mesa's llvmpipe computes them, so that it rounds the same numbers:
//! dot products from their last term, the inverse of the depth, and a fused multiply-add to the raster, whose `y` counts
//! from below as in OpenGL. From the rounding on, coverage is exact: shared vertices round alike, so shared edges leave
//! no gap. Depths are linear over the raster, in `f32`, from the vertices as they were before the rounding. Spheres and
//! planes, which have no vertices, are solved in `f32`.
//!
//! 8 bits are what desktop hardware has; Vulkan asks for at least 4 (`subPixelPrecisionBits`).

use super::draw::{Fragment, Fragments, Rasterizer};
use super::float_edges::least_depth;
use super::projection::{CameraMap, Vertex, covering};
use crate::real::{minus, position};
use crate::samples::{Samples, whole};
use bothways_common::{Projection, Region};
use glam::Vec3;

/// A rasterizer that snaps.
#[derive(Debug)]
pub(super) struct Snapped<'a> {
    samples: Samples<'a>,
    map: CameraMap<f32>,
    bits: u8,
}

pub(super) fn rule(samples: Samples<'_>, bits: u8) -> Snapped<'_> {
    Snapped { samples, map: CameraMap::new(&samples), bits }
}

impl Snapped<'_> {
    /// The place of a vertex on the raster in `f32`: to the right of its left side, and up from its lower side.
    #[expect(clippy::cast_possible_truncation, reason = "the rule is to round to f32")]
    fn raster(&self, [x, y, depth]: Vertex) -> [f32; 2] {
        let inverse = match self.map.projection {
            Projection::Perspective => 1.0 / depth as f32,
            Projection::Parallel => 1.0,
        };
        [0, 1].map(|axis| {
            let device = [x, y][axis] as f32 * self.map.to_device[axis] * inverse;
            device.mul_add(self.map.half[axis], self.map.half[axis])
        })
    }

    /// The nearest point of the grid, in half steps of it, from the upper left corner: the middle of a pixel is a whole
    /// number of half steps even where the grid has no point there.
    #[expect(clippy::cast_possible_truncation, reason = "the guard band bounds it")]
    fn snapped(&self, at: [f32; 2]) -> [i64; 2] {
        let steps = f32::from(self.bits).exp2();
        let [x, y] = at.map(|coordinate| 2 * (coordinate * steps).round_ties_even() as i64);
        let [height, _] = self.samples.size();
        [x, (i64::from(height) << (self.bits + 1)) - y]
    }
}

impl Rasterizer for Snapped<'_> {
    type Real = f32;
    type Triangle = Triangle;

    fn samples(&self) -> &Samples<'_> {
        &self.samples
    }

    fn map(&self) -> &CameraMap<f32> {
        &self.map
    }

    fn near(&self) -> f64 {
        least_depth(&self.samples)
    }

    fn key(&self, t: f64) -> f64 {
        let linear = match self.map.projection {
            Projection::Perspective => 1.0 / (t * f64::from(self.map.distance)),
            Projection::Parallel => t,
        };
        key(self.map.projection, linear)
    }

    fn vertex(&self, world: Vec3) -> Vertex {
        let [x, y, z] = minus(position(world), self.map.eye);
        self.map.axes.map(|[a, b, c]: [f32; 3]| f64::from(a * x + (b * y + c * z)))
    }

    fn set_up(&self, corners: [Vertex; 3]) -> Option<Triangle> {
        let at = corners.map(|corner| self.raster(corner));
        if !at.iter().flatten().all(|coordinate| coordinate.is_finite()) {
            return None;
        }
        let mut grid = at.map(|at| self.snapped(at));
        let area = edge(grid[0], grid[1]).at(grid[2]);
        if area == 0 {
            return None;
        }
        if area < 0 {
            grid.swap(1, 2);
        }
        let [a, b, c] = grid;
        let depth = DepthPlane::new(at, corners.map(|[.., depth]| self.map.linear_depth(depth)));
        let edges = [edge(a, b), edge(b, c), edge(c, a)];
        Some(Triangle { grid, edges, depth, bits: self.bits, map: self.map })
    }
}

/// A triangle on the grid.
#[derive(Debug)]
pub(super) struct Triangle {
    grid: [[i64; 2]; 3],
    edges: [Edge; 3],
    depth: DepthPlane,
    bits: u8,
    map: CameraMap<f32>,
}

/// The edge function `right·x + down·y + constant` of grid points; positive within.
#[derive(Clone, Copy, Debug)]
struct Edge {
    right: i64,
    down: i64,
    constant: i128,
}

fn edge(a: [i64; 2], b: [i64; 2]) -> Edge {
    let (right, down) = (a[1] - b[1], b[0] - a[0]);
    let constant = -(i128::from(right) * i128::from(a[0]) + i128::from(down) * i128::from(a[1]));
    Edge { right, down, constant }
}

impl Edge {
    fn at(self, [x, y]: [i64; 2]) -> i128 {
        i128::from(self.right) * i128::from(x)
            + i128::from(self.down) * i128::from(y)
            + self.constant
    }

    /// Whether it is a left or a top edge, which own the samples on them.
    fn owns(self) -> bool {
        self.right > 0 || (self.right == 0 && self.down > 0)
    }
}

/// What the depth buffer holds: the linear depth, the nearer the smaller. (`t`, its inverse, would be rounded again.)
fn key(projection: Projection, linear: f64) -> f64 {
    match projection {
        Projection::Perspective => -linear,
        Projection::Parallel => linear,
    }
}

/// The linear depth as a function of the raster, in `f32`.
#[derive(Clone, Copy, Debug)]
struct DepthPlane {
    from: [f32; 2],
    start: f32,
    right: f32,
    up: f32,
}

impl DepthPlane {
    fn new(at: [[f32; 2]; 3], linear: [f32; 3]) -> DepthPlane {
        let [a, b, c] = at;
        let ([bx, by], [cx, cy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let inverse = 1.0 / (bx * cy - by * cx);
        let (to_b, to_c) = (linear[1] - linear[0], linear[2] - linear[0]);
        let right = (to_b * cy - to_c * by) * inverse;
        let up = (to_c * bx - to_b * cx) * inverse;
        DepthPlane { from: a, start: linear[0], right, up }
    }

    fn at(self, [x, y]: [f32; 2]) -> f32 {
        self.start + self.right * (x - self.from[0]) + self.up * (y - self.from[1])
    }
}

impl Fragments for Triangle {
    fn bounds(&self, picture: &Region) -> Region {
        let scale = f64::from(self.bits + 1).exp2();
        let extent = |axis: usize| {
            #[expect(clippy::cast_precision_loss, reason = "the bounds are wider by a sample")]
            let all = self.grid.map(|at| at[axis] as f64 / scale);
            (all[0].min(all[1]).min(all[2]), all[0].max(all[1]).max(all[2]))
        };
        let ((left, right), (top, bottom)) = (extent(0), extent(1));
        Region {
            rows: covering(top, bottom, &picture.rows),
            columns: covering(left, right, &picture.columns),
        }
    }

    fn fragment(&self, row: usize, column: usize) -> Option<Fragment> {
        // The middle of a pixel, in half steps.
        #[expect(clippy::cast_possible_wrap, reason = "rows and columns are below 2^16")]
        let middle = [column, row].map(|index| (2 * index as i64 + 1) << self.bits);
        for edge in self.edges {
            let value = edge.at(middle);
            if value < 0 || (value == 0 && !edge.owns()) {
                return None;
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "rows and columns are below 2^16")]
        let [x, y] = [column, row].map(|index| whole(index) as f32 + 0.5);
        let height = 2.0 * self.map.half[1];
        let linear = self.depth.at([x, height - y]);
        let t = f64::from(self.map.t(linear));
        if t > 0.0 {
            return Some(Fragment { key: key(self.map.projection, f64::from(linear)), t });
        }
        // The depth of a needle, extrapolated to a sample beside it, may lie behind the eye: such a sample is the
        // farthest.
        Some(Fragment { key: f64::MAX, t: f64::MAX })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::SamplePoint;
    use bothways_common::Camera;

    #[test]
    fn vertices_move_to_the_grid() {
        let camera = Camera::canonical(4, 4);
        let at = |bits| {
            let rule = rule(Samples::new(&camera, 1, SamplePoint::Middle), bits);
            rule.snapped([1.3, 2.5])
        };
        // In half steps: 1.3 pixels are 1 pixel, 3/2 pixels or 333/256 pixels from the left; 2.5 from below goes to the even 2,
        // which is 2 from above, or stays.
        assert_eq!(at(0), [2, 4]);
        assert_eq!(at(1), [6, 6]);
        assert_eq!(at(8), [2 * 333, 2 * 384]);
    }

    #[test]
    fn a_square_of_two_triangles_covers_each_sample_once() {
        let camera = Camera::canonical(4, 4);
        for bits in [0, 1, 8, 16] {
            let rule = rule(Samples::new(&camera, 1, SamplePoint::Middle), bits);
            // At depth 1 the picture is 1 x 1.
            let [a, b, c, d] = [[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]]
                .map(|[x, y]: [f64; 2]| [x, y, 1.0]);
            let square = [[a, b, c], [a, c, d]].map(|corners| rule.set_up(corners).unwrap());
            for (row, column) in (0..4).flat_map(|row| (0..4).map(move |column| (row, column))) {
                let owners =
                    square.iter().filter(|half| half.fragment(row, column).is_some()).count();
                assert_eq!(owners, 1, "{bits} bits: {row}, {column}");
            }
        }
    }
}
