//! A primitive as every rule takes it.

use glam::Vec3;

/// One primitive, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    Triangle([Vec3; 3]),
    Sphere { center: Vec3, radius: f32 },
    Plane { point: Vec3, normal: Vec3 },
}
