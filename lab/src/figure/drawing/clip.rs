//! Clips polygons and lines to an upright rectangle, before any drawing library sees their coordinates.
//!
//! Polygons: Sutherland and Hodgman, "Reentrant Polygon Clipping", Communications of the ACM, 1974. Lines: Liang and
//! Barsky, "A New Concept and Method for Line Clipping", ACM Transactions on Graphics, 1984.

use super::canvas::CANVAS;

/// An upright rectangle on the canvas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    pub(super) const CANVAS: Rectangle = Rectangle { low: [0.0; 2], high: CANVAS };

    pub(super) fn new([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Rectangle {
        Rectangle { low: [x, y], high: [x + width, y + height] }
    }

    /// What two rectangles have in common.
    pub(super) fn within(&self, other: &Rectangle) -> Rectangle {
        Rectangle {
            low: [0, 1].map(|axis| self.low[axis].max(other.low[axis])),
            high: [0, 1].map(|axis| self.high[axis].min(other.high[axis])),
        }
    }

    pub(super) fn holds(&self, point: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] <= point[axis] && point[axis] <= self.high[axis])
    }

    pub(super) fn holds_disc(&self, [x, y]: [f64; 2], radius: f64) -> bool {
        self.holds([x - radius, y - radius]) && self.holds([x + radius, y + radius])
    }

    /// The part of a polygon within the rectangle. Points that are not finite are left out.
    pub(super) fn clipped(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut polygon: Vec<[f64; 2]> = points.iter().copied().filter(is_finite).collect();
        for axis in 0..2 {
            for (limit, side) in [(self.low[axis], 1.0), (self.high[axis], -1.0)] {
                let inside = |point: [f64; 2]| side * (point[axis] - limit);
                let before = std::mem::take(&mut polygon);
                for (k, &point) in before.iter().enumerate() {
                    let next = before[(k + 1) % before.len()];
                    let (here, there) = (inside(point), inside(next));
                    if here >= 0.0 {
                        polygon.push(point);
                    }
                    if (here >= 0.0) != (there >= 0.0) {
                        let mut crossing = between(point, next, here / (here - there));
                        crossing[axis] = limit;
                        polygon.push(crossing);
                    }
                }
            }
        }
        // Rounding may leave a point outside by its last bits.
        polygon
            .iter()
            .map(|point| {
                [0, 1].map(|axis| {
                    point[axis].clamp(self.low[axis], self.high[axis].max(self.low[axis]))
                })
            })
            .collect()
    }

    /// The parts of a line from point to point that lie within the rectangle.
    pub(super) fn parts(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
        for pair in points.windows(2) {
            let Some([from, to]) = self.segment(pair[0], pair[1]) else { continue };
            match parts.last_mut() {
                Some(part) if part.last() == Some(&from) => part.push(to),
                _ => parts.push(vec![from, to]),
            }
        }
        parts
    }

    /// The part of a segment within the rectangle.
    fn segment(&self, from: [f64; 2], to: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        if !is_finite(&from) || !is_finite(&to) {
            return None;
        }
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let along = to[axis] - from[axis];
            for (distance, along) in
                [(from[axis] - self.low[axis], -along), (self.high[axis] - from[axis], along)]
            {
                if along == 0.0 {
                    if distance < 0.0 {
                        return None;
                    }
                } else if along > 0.0 {
                    leave = leave.min(distance / along);
                } else {
                    enter = enter.max(distance / along);
                }
            }
        }
        if enter > leave || enter.is_nan() || leave.is_nan() {
            return None;
        }
        let at = |t: f64, end: [f64; 2], exactly: f64| {
            if t == exactly { end } else { between(from, to, t) }
        };
        let clamped = |point: [f64; 2]| {
            [0, 1]
                .map(|axis| point[axis].clamp(self.low[axis], self.high[axis].max(self.low[axis])))
        };
        Some([clamped(at(enter, from, 0.0)), clamped(at(leave, to, 1.0))])
    }
}

fn between(from: [f64; 2], to: [f64; 2], t: f64) -> [f64; 2] {
    [0, 1].map(|axis| from[axis] * (1.0 - t) + to[axis] * t)
}

/// Numbers so large that their differences overflow count as not finite.
fn is_finite(point: &[f64; 2]) -> bool {
    point.iter().all(|part| part.abs() < 1e150)
}
