//! A builder for the set's scenes: in pixels where pixels are the point of the scene, otherwise in the world.

use super::vector::{Group, Vector};
use crate::common::glam::Vec3;
use crate::common::{CameraDescription, Mesh, Orientation, Projection};

/// The distance `d` of all straight cameras. Their viewport is as large as the image in pixels, so that at this depth
/// one unit of the world is one pixel.
pub(super) const DISTANCE: f32 = 16.0;

/// A scene under construction.
#[derive(Debug)]
pub(super) struct Sketch {
    name: &'static str,
    group: Group,
    point: &'static str,
    camera: CameraDescription,
    corners: Vec<Vec3>,
}

/// An empty scene of 8 × 8 pixels, seen in perspective.
pub(super) fn sketch(group: Group, name: &'static str, point: &'static str) -> Sketch {
    let camera = CameraDescription { distance: DISTANCE, ..CameraDescription::default() };
    Sketch { name, group, point, camera, corners: Vec::new() }.size(8, 8)
}

impl Sketch {
    /// Sets the size in pixels. The call comes before the first triangle, because pixels depend on the size.
    pub(super) fn size(mut self, height: u16, width: u16) -> Sketch {
        assert!(self.corners.is_empty(), "{}: the size comes first", self.name);
        self.camera.image = [width.into(), height.into()];
        self.camera.viewport = [width.into(), height.into()];
        self
    }

    /// Makes the viewing rays parallel.
    pub(super) fn parallel(mut self) -> Sketch {
        assert!(self.corners.is_empty(), "{}: the projection comes first", self.name);
        self.camera.projection = Projection::Parallel;
        self
    }

    /// Sets a viewport with pixels that are not square.
    pub(super) fn viewport(mut self, viewport: [f32; 2]) -> Sketch {
        self.camera.viewport = viewport;
        self
    }

    /// Sets any eye; the axes stay those of the world.
    pub(super) fn standing(mut self, eye: [f32; 3]) -> Sketch {
        self.camera.eye = eye.into();
        self
    }

    /// Sets another `up` for a camera that looks at a point.
    pub(super) fn holding(mut self, up: [f32; 3]) -> Sketch {
        let Orientation::LookAt { target, .. } = self.camera.orientation else {
            panic!("{}: up is for a camera that looks at a point", self.name)
        };
        self.camera.orientation = Orientation::LookAt { target, up: up.into() };
        self
    }

    /// Sets another distance of the viewport; for triangles of the world.
    pub(super) fn at_distance(mut self, distance: f32) -> Sketch {
        self.camera.distance = distance;
        self
    }

    /// Sets any eye and any target.
    pub(super) fn looking(mut self, eye: [f32; 3], target: [f32; 3]) -> Sketch {
        self.camera.eye = eye.into();
        self.camera.orientation = Orientation::LookAt { target: target.into(), up: Vec3::Y };
        self
    }

    /// Adds a triangle at the depth where one unit is one pixel; corners are `[x, y]` in pixels, right and down, the
    /// middle of the first pixel at `[0.5, 0.5]`.
    pub(super) fn flat(self, corners: [[f32; 2]; 3]) -> Sketch {
        self.pixels(corners.map(|[x, y]| [x, y, DISTANCE]))
    }

    /// Adds a triangle with the corners `[x, y, depth]`: `x` and `y` in pixels, `depth` in units of the world.
    pub(super) fn pixels(mut self, corners: [[f32; 3]; 3]) -> Sketch {
        let corners = corners.map(|corner| self.in_world(corner));
        self.corners.extend(corners);
        self
    }

    /// Adds a triangle in the world.
    pub(super) fn world(mut self, corners: [[f32; 3]; 3]) -> Sketch {
        self.corners.extend(corners.map(Vec3::from_array));
        self
    }

    /// Adds two triangles: a convex quadrilateral, divided from its first corner to its third.
    pub(super) fn flat_quad(self, [a, b, c, d]: [[f32; 2]; 4]) -> Sketch {
        self.flat([a, b, c]).flat([a, c, d])
    }

    /// Adds two triangles of the world: a quadrilateral, divided in the same way.
    pub(super) fn world_quad(self, [a, b, c, d]: [[f32; 3]; 4]) -> Sketch {
        self.world([a, b, c]).world([a, c, d])
    }

    /// Scales all triangles so far about the eye; the picture stays the same.
    pub(super) fn scaled(mut self, factor: f32) -> Sketch {
        self.corners.iter_mut().for_each(|corner| *corner *= factor);
        self
    }

    /// The finished scene; corners in the same place become one vertex.
    pub(super) fn done(self) -> Vector {
        let Sketch { name, group, point, camera, corners } = self;
        let mut positions: Vec<Vec3> = Vec::new();
        let mut indices = Vec::new();
        for corner in corners {
            let known = positions.iter().position(|&position| position == corner);
            let index = known.unwrap_or(positions.len());
            if known.is_none() {
                positions.push(corner);
            }
            indices.push(u32::try_from(index).expect("the scenes are small"));
        }
        let triangles = indices.chunks_exact(3).map(|corners| [corners[0], corners[1], corners[2]]);
        let mesh = Mesh::new(positions, triangles.collect()).expect("the numbers are finite");
        Vector { name, group, point, mesh, camera }
    }

    fn in_world(&self, [x, y, depth]: [f32; 3]) -> Vec3 {
        let [width, height] = self.camera.viewport.map(f64::from);
        let scale = match self.camera.projection {
            Projection::Perspective => f64::from(depth) / f64::from(DISTANCE),
            Projection::Parallel => 1.0,
        };
        let across = (f64::from(x) - width / 2.0) * scale;
        let up = (height / 2.0 - f64::from(y)) * scale;
        Vec3::new(self.exact(across), self.exact(up), -depth)
    }

    /// A number as `f32`. Rounding is an error, because it would change the scene.
    fn exact(&self, number: f64) -> f32 {
        #[expect(clippy::cast_possible_truncation, reason = "nothing is lost, and that is checked")]
        let stored = number as f32;
        assert_eq!(f64::from(stored), number, "{}: a corner has too many bits", self.name);
        stored
    }
}
