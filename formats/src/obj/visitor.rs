//! The visitor that the parser of OBJ files calls, and the corners that it passes.

use glam::{Vec2, Vec3};

/// Receives what the statements of a file define, in the order of the file.
pub(super) trait Visitor {
    /// A vertex.
    fn position(&mut self, position: Vec3);
    /// The colour of the vertex that was defined last, as it is written.
    fn color(&mut self, _color: Vec3) {}
    /// A texture coordinate.
    fn texture_coordinate(&mut self, _value: Vec2) {}
    /// A normal.
    fn normal(&mut self, _normal: Vec3) {}
    /// A face of at least three corners.
    fn polygon(&mut self, corners: &[Corner]);
    /// The material of the faces that follow; `None` ends the use of the material before it.
    fn material(&mut self, _name: Option<String>) {}
    /// A file that defines materials.
    fn material_library(&mut self, _name: &str) {}
}

/// One corner of a face: the indices of its vertex, texture coordinate and normal, counted from 0, or
/// [`NONE`](crate::attributes::NONE).
pub(super) type Corner = [u32; 3];
