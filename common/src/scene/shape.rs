//! The form of an object, in the world.

use super::mesh::Mesh;
use glam::Vec3;

/// One triangle, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// First corner.
    pub a: Vec3,
    /// Second corner.
    pub b: Vec3,
    /// Third corner.
    pub c: Vec3,
}

/// One sphere, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its middle.
    pub center: Vec3,
    /// Positive.
    pub radius: f32,
}

/// One infinite plane, in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of it.
    pub point: Vec3,
    /// Perpendicular to it; its length does not matter.
    pub normal: Vec3,
}

/// The form of one object.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One primitive.
    Triangle(Triangle),
    /// One primitive.
    Sphere(Sphere),
    /// One primitive.
    Plane(Plane),
    /// One primitive a triangle.
    Mesh(Mesh),
}

impl Shape {
    /// How many primitive ids this shape takes.
    pub fn primitive_count(&self) -> usize {
        match self {
            Shape::Mesh(mesh) => mesh.triangles().len(),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => 1,
        }
    }
}
