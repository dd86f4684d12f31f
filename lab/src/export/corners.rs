//! Triangles as most programs have them: one index for each corner.

use crate::common::Mesh;
use crate::common::glam::{DVec3, Vec2, Vec3};
use crate::common::scene::Attribute;
use std::collections::HashMap;
use std::ops::Range;

/// Triangles with one index for each corner, and all that a corner carries behind it.
pub(super) struct Corners {
    pub(super) indices: Vec<u32>,
    pub(super) positions: Vec<[f32; 3]>,
    /// Unit vectors, if all corners have one.
    pub(super) normals: Option<Vec<[f32; 3]>>,
    /// As the mesh has them, `v` upwards, if all corners have one.
    pub(super) coordinates: Option<Vec<[f32; 2]>>,
}

impl Corners {
    pub(super) fn of(mesh: &Mesh, triangles: &Range<usize>) -> Corners {
        let (normals, coordinates) = (mesh.normals(), mesh.texture_coordinates());
        let has_normals = triangles.clone().all(|at| normals.of(at).is_some());
        let has_coordinates = triangles.clone().all(|at| coordinates.of(at).is_some());
        let mut corners = Corners {
            indices: Vec::with_capacity(3 * triangles.len()),
            positions: Vec::new(),
            normals: has_normals.then(Vec::new),
            coordinates: has_coordinates.then(Vec::new),
        };
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        for triangle in triangles.clone() {
            for (corner, &vertex) in mesh.triangles()[triangle].iter().enumerate() {
                let normal = if has_normals { normals.corners[triangle][corner] } else { 0 };
                let coordinate =
                    if has_coordinates { coordinates.corners[triangle][corner] } else { 0 };
                let next = u32::try_from(corners.positions.len())
                    .expect("memory does not hold so many different corners");
                let index = *known.entry([vertex, normal, coordinate]).or_insert(next);
                corners.indices.push(index);
                if index != next {
                    continue;
                }
                corners.positions.push(mesh.positions()[vertex as usize].to_array());
                if let Some(kept) = &mut corners.normals {
                    let normal = normals.values[normal as usize].as_dvec3();
                    kept.push(normal.normalize_or(DVec3::Z).as_vec3().to_array());
                }
                if let Some(kept) = &mut corners.coordinates {
                    kept.push(coordinates.values[coordinate as usize].to_array());
                }
            }
        }
        corners
    }
    /// The same as a mesh.
    pub(super) fn mesh(self) -> Mesh {
        let triangles = self.indices.as_chunks().0.to_vec();
        let positions = self.positions.into_iter().map(Vec3::from_array).collect();
        let mut mesh = Mesh::new(positions, triangles.clone()).expect("they were in a mesh");
        if let Some(normals) = self.normals {
            let values = normals.into_iter().map(Vec3::from_array).collect();
            let normals = Attribute { values, corners: triangles.clone() };
            mesh = mesh.with_normals(normals).expect("every corner has one");
        }
        if let Some(coordinates) = self.coordinates {
            let values = coordinates.into_iter().map(Vec2::from_array).collect();
            let coordinates = Attribute { values, corners: triangles };
            mesh = mesh.with_texture_coordinates(coordinates).expect("every corner has one");
        }
        mesh
    }
}
