//! The mesh that an OBJ file describes, built while the file is parsed.

use super::visitor::{Corner, NONE, Visitor};
use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use glam::{Vec2, Vec3};

/// A mesh under construction.
#[derive(Default)]
pub(super) struct MeshBuilder {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    texture_coordinates: Attribute<Vec2>,
    normals: Attribute<Vec3>,
    materials: MeshMaterials,
    /// The material of the last `usemtl`, until a face uses it; `Some(None)` is a `usemtl` without a name.
    next_material: Option<Option<String>>,
}

impl Visitor for MeshBuilder {
    fn position(&mut self, position: Vec3) {
        self.positions.push(position);
    }

    fn texture_coordinate(&mut self, value: Vec2) {
        self.texture_coordinates.values.push(value);
    }

    fn normal(&mut self, normal: Vec3) {
        self.normals.values.push(normal);
    }

    fn triangle(&mut self, corners: [Corner; 3]) {
        let triangle = self.triangles.len();
        if let Some(name) = self.next_material.take() {
            self.materials.use_from(triangle, name.as_deref());
        }
        self.triangles.push(corners.map(|[vertex, _, _]| vertex));
        let texture_coordinates = corners.map(|[_, texture_coordinate, _]| texture_coordinate);
        store(&mut self.texture_coordinates.corners, triangle, texture_coordinates);
        store(&mut self.normals.corners, triangle, corners.map(|[_, _, normal]| normal));
    }

    fn material(&mut self, name: Option<String>) {
        self.next_material = Some(name);
    }

    fn material_library(&mut self, name: &str) {
        self.materials.add_library(name);
    }
}

impl MeshBuilder {
    /// Tells whether there is anything to draw.
    pub(super) fn has_triangles(&self) -> bool {
        !self.triangles.is_empty()
    }

    /// The mesh, after the whole file has been parsed and all indices have been checked.
    pub(super) fn finish(self) -> Mesh {
        let triangles = self.triangles.len();
        let normals = complete(self.normals, triangles);
        let texture_coordinates = complete(self.texture_coordinates, triangles);
        Mesh::new(self.positions, self.triangles)
            .and_then(|mesh| mesh.with_normals(normals))
            .and_then(|mesh| mesh.with_texture_coordinates(texture_coordinates))
            .expect("the reader has checked every number and every index")
            .with_materials(self.materials)
    }
}

/// Stores the indices of a triangle's corners, if there are any. Triangles before it may have stored none.
fn store(indices: &mut Vec<[u32; 3]>, triangle: usize, corners: [u32; 3]) {
    if corners != [NONE; 3] {
        indices.resize(triangle, [NONE; 3]);
        indices.push(corners);
    }
}

/// Gives an attribute an entry for each triangle, or removes its values if no corner has an index.
fn complete<T>(mut attribute: Attribute<T>, triangles: usize) -> Attribute<T> {
    if attribute.corners.is_empty() {
        attribute.values = Vec::new();
    } else {
        attribute.corners.resize(triangles, [NONE; 3]);
    }
    attribute
}
