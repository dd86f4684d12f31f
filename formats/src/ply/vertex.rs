//! A vertex of a file.

use glam::Vec3;

/// A vertex, with its normal if the file has normals, and its colour, as it is written, if it has colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    pub(super) color: Vec3,
}
