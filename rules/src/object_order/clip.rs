//! Clipping against the near plane, and against a guard band around the picture.
//!
//! Sutherland and Hodgman, "Reentrant Polygon Clipping", Communications of the ACM, 1974; in the camera's axes, in `f64`.
//! A triangle that crosses no plane passes unchanged, as on a GPU: its coordinates are not rounded again.

use super::projection::Vertex;
use bothways_common::Projection;

/// A half-space `n·p + k ≥ 0` of the camera's axes.
#[derive(Clone, Copy, Debug)]
struct Side {
    normal: [f64; 3],
    offset: f64,
}

/// The half-spaces that triangles are clipped against.
#[derive(Clone, Debug)]
pub(super) struct Clip {
    sides: [Side; 5],
}

/// How far from the middle of the picture a vertex may lie, in samples: as far as the guard bands of GPUs reach.
const GUARD: f64 = 32_768.0;

impl Clip {
    /// The half-spaces for a near depth. `to_device` and `half` are those of the camera's map.
    pub(super) fn new(
        near: f64,
        projection: Projection,
        to_device: [f64; 2],
        half: [f64; 2],
    ) -> Clip {
        let bounded = |axis: usize, sign: f64| {
            let most = (GUARD / half[axis]).max(2.0);
            let mut normal = [0.0; 3];
            normal[axis] = sign * to_device[axis];
            match projection {
                Projection::Perspective => {
                    normal[2] = most;
                    Side { normal, offset: 0.0 }
                }
                Projection::Parallel => Side { normal, offset: most },
            }
        };
        let near = Side { normal: [0.0, 0.0, 1.0], offset: -near };
        let sides = [near, bounded(0, 1.0), bounded(0, -1.0), bounded(1, 1.0), bounded(1, -1.0)];
        Clip { sides }
    }

    /// Puts the part of a triangle that lies within all half-spaces into `polygon`: convex, in the triangle's sense of
    /// turning, perhaps empty.
    pub(super) fn clip(&self, triangle: [Vertex; 3], polygon: &mut Vec<Vertex>) {
        polygon.clear();
        polygon.extend(triangle);
        for side in &self.sides {
            if polygon.iter().any(|&vertex| !side.holds(vertex)) {
                side.clip(polygon);
            }
        }
    }
}

impl Side {
    fn above(&self, [x, y, depth]: Vertex) -> f64 {
        let [a, b, c] = self.normal;
        a * x + b * y + c * depth + self.offset
    }

    fn holds(&self, vertex: Vertex) -> bool {
        self.above(vertex) >= 0.0
    }

    fn clip(&self, polygon: &mut Vec<Vertex>) {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (index, &vertex) in polygon.iter().enumerate() {
            let next = polygon[(index + 1) % polygon.len()];
            if self.holds(vertex) {
                kept.push(vertex);
            }
            if self.holds(vertex) != self.holds(next) {
                // From the inner to the outer vertex, so that both triangles of an edge get the same point.
                let (inner, outer) =
                    if self.holds(vertex) { (vertex, next) } else { (next, vertex) };
                let (within, without) = (self.above(inner), -self.above(outer));
                let part = within / (within + without);
                kept.push(std::array::from_fn(|k| inner[k] + part * (outer[k] - inner[k])));
            }
        }
        *polygon = kept;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clipped(triangle: [Vertex; 3]) -> Vec<Vertex> {
        let clip = Clip::new(1.0, Projection::Perspective, [2.0; 2], [16_384.0; 2]);
        let mut polygon = Vec::new();
        clip.clip(triangle, &mut polygon);
        polygon
    }

    #[test]
    fn what_is_near_is_cut_off() {
        let whole = [[0.0, 0.0, 2.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        assert_eq!(clipped(whole), whole);
        assert_eq!(clipped(whole.map(|[x, y, _]| [x, y, 0.5])), [[0.0; 3]; 0]);
        let one_near = [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0]];
        let four = [[0.5, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 2.0], [0.0, 0.5, 1.0]];
        assert_eq!(clipped(one_near), four);
        let two_near = [[0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(clipped(two_near), [[0.0, 0.0, 2.0], [0.5, 0.0, 1.0], [0.0, 0.5, 1.0]]);
    }

    #[test]
    fn no_vertex_lies_beyond_the_guard_band() {
        let far_out = [[0.0, 0.0, 2.0], [1e9, 0.0, 2.0], [0.0, -1e30, 2.0]];
        for [x, y, depth] in clipped(far_out) {
            assert!((2.0 * x).abs() <= 2.001 * depth && (2.0 * y).abs() <= 2.001 * depth);
        }
    }
}
