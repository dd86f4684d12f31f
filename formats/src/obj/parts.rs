//! A mesh that grows while an OBJ file is read.

use super::{Corner, NONE, Sink};
use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use glam::{Vec2, Vec3};

/// All of a mesh, while it is read.
#[derive(Default)]
pub(super) struct Parts {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    texture_coordinates: Attribute<Vec2>,
    normals: Attribute<Vec3>,
    materials: MeshMaterials,
    /// What the last `usemtl` says, until a face uses it; `Some(None)` is no name.
    next_material: Option<Option<String>>,
}

impl Sink for Parts {
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
        carry(&mut self.texture_coordinates.corners, triangle, texture_coordinates);
        carry(&mut self.normals.corners, triangle, corners.map(|[_, _, normal]| normal));
    }

    fn material(&mut self, name: Option<String>) {
        self.next_material = Some(name);
    }

    fn material_library(&mut self, name: &str) {
        self.materials.add_library(name);
    }
}

impl Parts {
    pub(super) fn has_triangles(&self) -> bool {
        !self.triangles.is_empty()
    }

    /// The mesh, once all of it has been read and checked.
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

/// Notes what the corners of a triangle carry, if they do; earlier triangles may have been silent.
fn carry(list: &mut Vec<[u32; 3]>, triangle: usize, corners: [u32; 3]) {
    if corners != [NONE; 3] {
        list.resize(triangle, [NONE; 3]);
        list.push(corners);
    }
}

/// Gives an attribute an entry for each triangle; one that no corner names vanishes.
fn complete<T>(mut attribute: Attribute<T>, triangles: usize) -> Attribute<T> {
    if attribute.corners.is_empty() {
        attribute.values = Vec::new();
    } else {
        attribute.corners.resize(triangles, [NONE; 3]);
    }
    attribute
}
