//! One primitive as a camera sees it.

use glam::DVec3;

/// One primitive relative to the eye: the eye is the origin, the axes are the world's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// Its three corners.
    Triangle([DVec3; 3]),
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Positive.
        radius: f64,
    },
    /// An infinite plane.
    Plane {
        /// Any point of it.
        point: DVec3,
        /// Perpendicular to it, not of unit length.
        normal: DVec3,
    },
}

impl Primitive {
    /// What it is, in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Primitive::Triangle(_) => "triangle",
            Primitive::Sphere { .. } => "sphere",
            Primitive::Plane { .. } => "plane",
        }
    }

    /// Whether it is round: a sphere. Every other primitive is flat: it lies in one plane. Of primitives that a ray
    /// meets at the same `t`, flat ones are seen before round ones.
    #[inline]
    pub fn is_round(&self) -> bool {
        match self {
            Primitive::Sphere { .. } => true,
            Primitive::Triangle(_) | Primitive::Plane { .. } => false,
        }
    }
}

/// Whether two triangles have the same corners, in any order. Then every ray that meets one meets the other at the
/// same place.
pub fn are_same_corners<P: Copy + PartialEq>(first: &[P; 3], second: &[P; 3]) -> bool {
    let [a, b, c] = *first;
    first == second || [[b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]].contains(second)
}
