//! The shape of an object, in the world.

use super::instances::Instances;
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
    /// Its radius, in lengths of the world; positive.
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

/// The shape of one object, in the world.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A triangle: one primitive.
    Triangle(Triangle),
    /// A sphere: one primitive.
    Sphere(Sphere),
    /// An infinite plane: one primitive.
    Plane(Plane),
    /// A triangle mesh: one primitive for each of its triangles.
    Mesh(Mesh),
    /// A triangle mesh in many places: one primitive for each of its triangles in each of them.
    Instances(Instances),
}

impl Shape {
    /// The mesh that it shows, once or many times.
    #[inline]
    pub fn mesh(&self) -> Option<&Mesh> {
        match self {
            Shape::Mesh(mesh) => Some(mesh),
            Shape::Instances(instances) => Some(instances.mesh()),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => None,
        }
    }

    /// How many primitive ids this shape takes.
    pub fn primitive_count(&self) -> usize {
        match self {
            Shape::Mesh(mesh) => mesh.triangles().len(),
            Shape::Instances(instances) => instances.primitive_count(),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => 1,
        }
    }
}

impl From<Triangle> for Shape {
    fn from(triangle: Triangle) -> Self {
        Shape::Triangle(triangle)
    }
}

impl From<Sphere> for Shape {
    fn from(sphere: Sphere) -> Self {
        Shape::Sphere(sphere)
    }
}

impl From<Plane> for Shape {
    fn from(plane: Plane) -> Self {
        Shape::Plane(plane)
    }
}

impl From<Mesh> for Shape {
    fn from(mesh: Mesh) -> Self {
        Shape::Mesh(mesh)
    }
}

impl From<Instances> for Shape {
    fn from(instances: Instances) -> Self {
        Shape::Instances(instances)
    }
}
