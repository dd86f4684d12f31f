//! The mesh that an OBJ file describes, built while the file is parsed: in one go, or in pieces.

use super::visitor::{Corner, Visitor};
use crate::attributes::{self, NONE, linear_colors, push_color};
use crate::polygon::{Fans, fan};
use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use glam::{Vec2, Vec3};

/// A mesh under construction.
#[derive(Default)]
pub(super) struct MeshBuilder {
    geometry: Geometry,
    materials: MeshMaterials,
    /// The material of the last `usemtl`, until a face uses it; `Some(None)` is a `usemtl` without a name.
    next_material: Option<Option<String>>,
}

/// What a piece of a file adds to a mesh. Indices are those of the whole file.
#[derive(Default)]
pub(super) struct Piece {
    geometry: Geometry,
    /// The last `usemtl` before a triangle of the piece, or behind its last one, with the triangle's number in the piece.
    materials: Vec<(usize, Option<String>)>,
    libraries: Vec<String>,
}

#[derive(Default)]
struct Geometry {
    positions: Vec<Vec3>,
    /// Those of fans: a face may name positions further down, so only the last line tells which must not be.
    triangles: Vec<[u32; 3]>,
    fans: Fans,
    texture_coordinates: Attribute<Vec2>,
    normals: Attribute<Vec3>,
    /// As they are written, up to the last vertex that has one.
    colors: Vec<Vec3>,
}

impl Visitor for MeshBuilder {
    fn position(&mut self, position: Vec3) {
        self.geometry.positions.push(position);
    }

    fn color(&mut self, color: Vec3) {
        self.geometry.color(color);
    }

    fn texture_coordinate(&mut self, value: Vec2) {
        self.geometry.texture_coordinates.values.push(value);
    }

    fn normal(&mut self, normal: Vec3) {
        self.geometry.normals.values.push(normal);
    }

    fn polygon(&mut self, corners: &[Corner]) {
        self.use_material(self.geometry.triangles.len());
        self.geometry.polygon(corners);
    }

    fn material(&mut self, name: Option<String>) {
        self.next_material = Some(name);
    }

    fn material_library(&mut self, name: &str) {
        self.materials.add_library(name);
    }
}

impl Visitor for Piece {
    fn position(&mut self, position: Vec3) {
        self.geometry.positions.push(position);
    }

    fn color(&mut self, color: Vec3) {
        self.geometry.color(color);
    }

    fn texture_coordinate(&mut self, value: Vec2) {
        self.geometry.texture_coordinates.values.push(value);
    }

    fn normal(&mut self, normal: Vec3) {
        self.geometry.normals.values.push(normal);
    }

    fn polygon(&mut self, corners: &[Corner]) {
        self.geometry.polygon(corners);
    }

    fn material(&mut self, name: Option<String>) {
        let triangle = self.geometry.triangles.len();
        match self.materials.last_mut() {
            Some(last) if last.0 == triangle => last.1 = name,
            _ => self.materials.push((triangle, name)),
        }
    }

    fn material_library(&mut self, name: &str) {
        self.libraries.push(name.to_owned());
    }
}

impl MeshBuilder {
    /// Tells whether there is anything to draw.
    pub(super) fn has_triangles(&self) -> bool {
        !self.geometry.triangles.is_empty()
    }

    /// Adds the next piece of the file.
    pub(super) fn append(&mut self, piece: Piece) {
        let first = self.geometry.triangles.len();
        for library in piece.libraries {
            self.materials.add_library(&library);
        }
        let count = piece.geometry.triangles.len();
        // The first triangle of the piece may be of the material that an earlier piece has named last.
        if count > 0 && piece.materials.first().is_none_or(|&(triangle, _)| triangle > 0) {
            self.use_material(first);
        }
        for (triangle, name) in piece.materials {
            self.next_material = Some(name);
            if triangle < count {
                self.use_material(first + triangle);
            }
        }
        self.geometry.append(piece.geometry);
    }

    /// Uses the material of the last `usemtl`, if no face has used it yet, from a triangle on.
    fn use_material(&mut self, triangle: usize) {
        if let Some(name) = self.next_material.take() {
            self.materials.use_from(triangle, name.as_deref());
        }
    }

    /// The mesh, after the whole file has been parsed and all indices have been checked.
    pub(super) fn finish(self) -> Mesh {
        let Geometry {
            positions,
            mut triangles,
            fans,
            mut texture_coordinates,
            mut normals,
            colors,
        } = self.geometry;
        let recuts = fans.recuts(&positions, &triangles);
        for corners in [&mut triangles, &mut texture_coordinates.corners, &mut normals.corners] {
            recuts.apply(corners);
        }
        let colors = linear_colors(colors);
        attributes::mesh(positions, triangles, normals, texture_coordinates, colors, self.materials)
    }
}

impl Geometry {
    fn color(&mut self, color: Vec3) {
        push_color(&mut self.colors, self.positions.len() - 1, color);
    }

    fn polygon(&mut self, corners: &[Corner]) {
        self.fans.add(self.triangles.len(), corners.len());
        fan(corners).for_each(|triangle| self.triangle(triangle));
    }

    fn triangle(&mut self, corners: [Corner; 3]) {
        let triangle = self.triangles.len();
        self.triangles.push(corners.map(|[vertex, _, _]| vertex));
        let texture_coordinates = corners.map(|[_, texture_coordinate, _]| texture_coordinate);
        store(&mut self.texture_coordinates.corners, triangle, texture_coordinates);
        store(&mut self.normals.corners, triangle, corners.map(|[_, _, normal]| normal));
    }

    fn append(&mut self, piece: Geometry) {
        let triangles = self.triangles.len();
        if !piece.colors.is_empty() {
            self.colors.resize(self.positions.len(), Vec3::ONE);
            self.colors.extend_from_slice(&piece.colors);
        }
        self.fans.append(&piece.fans, triangles);
        self.positions.extend_from_slice(&piece.positions);
        self.triangles.extend_from_slice(&piece.triangles);
        append(&mut self.texture_coordinates, &piece.texture_coordinates, triangles);
        append(&mut self.normals, &piece.normals, triangles);
    }
}

/// Appends what a piece has of an attribute, behind so many triangles.
fn append<T: Copy>(attribute: &mut Attribute<T>, piece: &Attribute<T>, triangles: usize) {
    attribute.values.extend_from_slice(&piece.values);
    if !piece.corners.is_empty() {
        attribute.corners.resize(triangles, [NONE; 3]);
        attribute.corners.extend_from_slice(&piece.corners);
    }
}

/// Stores the indices of a triangle's corners, if there are any. Triangles before it may have stored none.
fn store(indices: &mut Vec<[u32; 3]>, triangle: usize, corners: [u32; 3]) {
    if corners != [NONE; 3] {
        indices.resize(triangle, [NONE; 3]);
        indices.push(corners);
    }
}
