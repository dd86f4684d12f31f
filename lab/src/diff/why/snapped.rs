//! A triangle whose corners lie on a grid of the raster, as GPUs have it: from there on, all is exact in whole numbers.

use super::convention::{Edges, Vertices};
use super::outline::{Area, project_ahead};
use super::rays::ViewingRays;
use crate::common::exact::Side;
use crate::common::glam::DVec3;
use std::ops::Range;

/// A triangle on the grid, in half steps of it: so the middle of a pixel is a whole number of them where the grid has no point
/// there, too. Below [`FARTHEST`], products and sums of these numbers are below 2⁵³, and `f64` has them all.
#[derive(Clone, Copy, Debug)]
pub(super) struct SnappedTriangle {
    /// Positive within.
    edges: [Edge; 3],
    low: [f64; 2],
    high: [f64; 2],
    raster: Raster,
}

/// Corners farther from the upper left corner of the raster are left where they are: with 8 bits, that is 65,536 pixels. GPUs
/// clip there, each in its own way.
const FARTHEST: f64 = (1_u64 << 25) as f64;

/// What becomes of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) enum Snapped {
    /// It lies on the grid.
    Triangle(SnappedTriangle),
    /// It has no area there.
    Vanished,
    /// It reaches behind the eye, or far beyond the raster, so that it stays where it is.
    Unmoved,
}

/// Where the samples lie on the grid.
#[derive(Clone, Copy, Debug)]
struct Raster {
    /// Half steps of a pixel.
    pixel: f64,
    /// The place of the first sample, in half pixels from the corner of its pixel.
    first: [f64; 2],
}

impl Raster {
    fn new(rays: &ViewingRays, bits: u8) -> Raster {
        Raster { pixel: 2.0 * f64::from(bits).exp2(), first: rays.twice_offsets }
    }

    /// The place of the sample of a column, or of a row, along this axis.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
    fn sample(&self, axis: usize, index: usize) -> f64 {
        (2.0 * index as f64 + self.first[axis]) * (self.pixel / 2.0)
    }

    /// The samples of a range between two places, and up to one beside each end.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a number below 0 becomes 0, one above all integers the largest"
    )]
    fn samples(&self, axis: usize, [low, high]: [f64; 2], all: &Range<usize>) -> Range<usize> {
        let index = |place: f64| (place / self.pixel - self.first[axis] / 2.0).floor();
        let (begin, end) = (index(low) as usize, (index(high) + 2.0) as usize);
        begin.clamp(all.start, all.end)..end.clamp(all.start, all.end)
    }

    /// The nearest point of the grid.
    fn snap(&self, at: [f64; 2]) -> [f64; 2] {
        at.map(|coordinate| 2.0 * (coordinate * self.pixel / 2.0).round_ties_even())
    }
}

/// The edge function `right·x + down·y + constant` of grid points.
#[derive(Clone, Copy, Debug)]
struct Edge {
    right: f64,
    down: f64,
    constant: f64,
}

impl Edge {
    fn new(a: [f64; 2], b: [f64; 2]) -> Edge {
        let (right, down) = (a[1] - b[1], b[0] - a[0]);
        Edge { right, down, constant: -(right * a[0] + down * a[1]) }
    }

    fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.right * x + self.down * y + self.constant
    }

    /// The side of the triangle on which it lies.
    fn side(&self) -> Side {
        match (self.right, self.down) {
            (right, _) if right > 0.0 => Side::Left,
            (right, _) if right < 0.0 => Side::Right,
            (_, down) if down > 0.0 => Side::Top,
            _ => Side::Bottom,
        }
    }
}

impl Snapped {
    /// The triangle `abc` of a renderer that puts its corners there.
    pub(super) fn new(corners: &[DVec3; 3], rays: &ViewingRays, vertices: Vertices) -> Snapped {
        let Vertices::Rounded { bits } = vertices else { return Snapped::Unmoved };
        let raster = Raster::new(rays, bits);
        let mut grid = [[0.0; 2]; 3];
        for (corner, at) in corners.iter().zip(&mut grid) {
            let Some(place) = project_ahead(*corner, rays) else { return Snapped::Unmoved };
            *at = raster.snap(rays.on_raster(place));
            // A picture of one column or row does not tell how large a pixel is.
            if !at.iter().all(|coordinate| coordinate.abs() < FARTHEST) {
                return Snapped::Unmoved;
            }
        }
        let area = Edge::new(grid[0], grid[1]).at(grid[2]);
        if area == 0.0 {
            return Snapped::Vanished;
        }
        if area < 0.0 {
            grid.swap(1, 2);
        }
        let [a, b, c] = grid;
        let extreme = |choose: fn(f64, f64) -> f64| {
            [0, 1].map(|axis| choose(choose(a[axis], b[axis]), c[axis]))
        };
        Snapped::Triangle(SnappedTriangle {
            edges: [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)],
            low: extreme(f64::min),
            high: extreme(f64::max),
            raster,
        })
    }
}

impl SnappedTriangle {
    /// The pixels whose samples it may cover.
    pub(super) fn area(&self, rays: &ViewingRays) -> Area {
        let along = |axis: usize, count: usize| {
            self.raster.samples(axis, [self.low[axis], self.high[axis]], &(0..count))
        };
        Area { rows: along(1, rays.y.len()), columns: along(0, rays.x.len()) }
    }

    /// The columns of a row that it may cover.
    pub(super) fn columns(&self, row: usize, area: &Area) -> Range<usize> {
        let y = self.raster.sample(1, row);
        let [mut low, mut high] = [self.low[0], self.high[0]];
        for edge in &self.edges {
            let rest = edge.down * y + edge.constant;
            if edge.right > 0.0 {
                low = low.max(-rest / edge.right);
            } else if edge.right < 0.0 {
                high = high.min(-rest / edge.right);
            } else if rest < 0.0 {
                return 0..0;
            }
        }
        if low > high {
            // Rounding may exchange the two ends of what is as narrow as a point.
            std::mem::swap(&mut low, &mut high);
            if high - low > self.raster.pixel {
                return 0..0;
            }
        }
        self.raster.samples(0, [low, high], &area.columns)
    }

    /// Whether it covers the sample of a pixel, if these edges own theirs.
    pub(super) fn covers(&self, row: usize, column: usize, edges: Edges) -> bool {
        let sample = [self.raster.sample(0, column), self.raster.sample(1, row)];
        self.edges.iter().all(|edge| {
            let value = edge.at(sample);
            value > 0.0 || (value == 0.0 && edges.own(edge.side()))
        })
    }
}
