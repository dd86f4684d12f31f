//! Where a camera sees points of the world, for lines that are drawn over its pictures.
//!
//! Rounded arithmetic: good for drawing, and never asked what covers what.

use crate::common::glam::{DVec3, Vec3};
use crate::common::{Camera, Primitive, Projection, View};

/// A camera's map from points relative to its eye to the raster.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projector<'a> {
    pub(crate) camera: &'a Camera,
}

impl Projector<'_> {
    /// The column and the row, in pixels from the top left of the image; `None` if the point is not before the eye.
    pub(crate) fn place(&self, point: DVec3) -> Option<[f64; 2]> {
        let camera = self.camera;
        let depth = -point.dot(camera.w());
        let scale = match camera.projection() {
            Projection::Parallel => 1.0,
            Projection::Perspective if depth > 0.0 => camera.distance() / depth,
            Projection::Perspective => return None,
        };
        let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
        let [x, y] = [camera.u(), camera.v()].map(|axis| scale * point.dot(axis));
        let place = [(x / vw + 0.5) * width, (0.5 - y / vh) * height];
        place.iter().all(|part| part.is_finite()).then_some(place)
    }

    /// The part of a segment before the eye, on the raster.
    pub(crate) fn segment(&self, from: DVec3, to: DVec3) -> Option<[[f64; 2]; 2]> {
        let depth = |point: DVec3| -point.dot(self.camera.w());
        let (mut from, mut to) = (from, to);
        if self.camera.projection() == Projection::Perspective {
            // Near enough to the eye that the rest is out of any picture.
            let near = 1e-6 * self.camera.distance().min(depth(from).abs().max(depth(to).abs()));
            if depth(from) < near && depth(to) < near {
                return None;
            }
            let crossing = |inside: DVec3, outside: DVec3| {
                let part = (depth(inside) - near) / (depth(inside) - depth(outside));
                inside + part * (outside - inside)
            };
            if depth(from) < near {
                from = crossing(to, from);
            } else if depth(to) < near {
                to = crossing(from, to);
            }
        }
        Some([self.place(from)?, self.place(to)?])
    }

    /// The corners of the part of a triangle before the eye, on the raster: none if there is no such part.
    pub(crate) fn polygon(&self, corners: &[DVec3; 3]) -> Vec<[f64; 2]> {
        // Far enough from the eye that the corners of what is left are not very far out of the picture.
        let near = match self.camera.projection() {
            Projection::Perspective => 1e-3 * self.camera.distance(),
            Projection::Parallel => f64::NEG_INFINITY,
        };
        let before = |point: DVec3| -point.dot(self.camera.w()) - near;
        let mut kept = Vec::new();
        for (place, &from) in corners.iter().enumerate() {
            let to = corners[(place + 1) % 3];
            let (here, there) = (before(from), before(to));
            if here >= 0.0 {
                kept.push(from);
            }
            if (here >= 0.0) != (there >= 0.0) {
                kept.push(from + here / (here - there) * (to - from));
            }
        }
        kept.into_iter().filter_map(|point| self.place(point)).collect()
    }

    /// The lines that bound a primitive on the raster: the edges of a triangle, the outline of a sphere, the horizon of
    /// a plane.
    pub(crate) fn outline(&self, primitive: &Primitive) -> Vec<Vec<[f64; 2]>> {
        match primitive {
            Primitive::Triangle([a, b, c]) => [(a, b), (b, c), (c, a)]
                .into_iter()
                .filter_map(|(from, to)| self.segment(*from, *to))
                .map(|segment| segment.to_vec())
                .collect(),
            Primitive::Sphere { center, radius } => {
                self.sphere(*center, *radius).into_iter().collect()
            }
            Primitive::Plane { normal, .. } => self.horizon(*normal).into_iter().collect(),
        }
    }

    /// The parts before the eye of the twelve edges of a box with these corners, on the raster.
    pub(crate) fn edges_of_box(&self, corners: &[DVec3; 8]) -> Vec<Vec<[f64; 2]>> {
        // An edge joins two corners whose numbers differ in one bit.
        (0..8_usize)
            .flat_map(|from| (0..3).map(move |axis| (from, from | 1 << axis)))
            .filter(|(from, to)| from != to)
            .filter_map(|(from, to)| self.segment(corners[from], corners[to]))
            .map(|edge| edge.to_vec())
            .collect()
    }

    /// The circle on which rays touch a sphere; none if the eye is within it.
    fn sphere(&self, center: DVec3, radius: f64) -> Option<Vec<[f64; 2]>> {
        const SIDES: u32 = 180;
        let (middle, radius, axis) = match self.camera.projection() {
            Projection::Parallel => (center, radius, self.camera.w()),
            Projection::Perspective => {
                let far = center.length();
                if far <= radius {
                    return None;
                }
                let cosine = radius / far;
                (
                    center * (1.0 - cosine * cosine),
                    radius * (1.0 - cosine * cosine).sqrt(),
                    center / far,
                )
            }
        };
        let across = axis.any_orthonormal_vector();
        let other = axis.cross(across);
        (0..=SIDES)
            .map(|side| {
                let angle = std::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
                self.place(middle + radius * (angle.cos() * across + angle.sin() * other))
            })
            .collect()
    }

    /// The directions along a plane: a line across the picture.
    fn horizon(&self, normal: DVec3) -> Option<Vec<[f64; 2]>> {
        let camera = self.camera;
        if camera.projection() == Projection::Parallel {
            return None;
        }
        let [a, b] = [normal.dot(camera.u()), normal.dot(camera.v())];
        let c = -camera.distance() * normal.dot(camera.w());
        let ([vw, vh], [width, height]) = (camera.viewport(), camera.image().map(f64::from));
        let square = a * a + b * b;
        if square == 0.0 {
            return None;
        }
        // The point of the line next to the middle, and far along it both ways.
        let (x, y) = (-a * c / square, -b * c / square);
        let far = 4.0 * (vw + vh + x.abs() + y.abs()) / square.sqrt();
        let place = |x: f64, y: f64| [(x / vw + 0.5) * width, (0.5 - y / vh) * height];
        Some(vec![place(x - far * b, y + far * a), place(x + far * b, y - far * a)])
    }
}

/// The corners of a box that is aligned with the axes of the world, relative to the eye: bit `k` of a corner's number
/// tells whether it lies at the low or at the high end of axis `k`.
pub(crate) fn corners_of_box(view: &View, bounds: [Vec3; 2]) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let axis = |axis: usize| bounds[corner >> axis & 1][axis];
        view.offset(Vec3::new(axis(0), axis(1), axis(2)))
    })
}
