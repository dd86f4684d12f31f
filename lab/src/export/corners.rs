//! Triangles as most programs have them: one index for each corner.

use super::pieces::Piece;
use crate::common::Mesh;
use crate::common::glam::{DVec3, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// Triangles with one index for each corner, and all that a corner carries behind it.
pub(super) struct Corners {
    pub(super) indices: Vec<u32>,
    pub(super) positions: Vec<[f32; 3]>,
    /// Unit vectors, if all corners have one.
    pub(super) normals: Option<Vec<[f32; 3]>>,
    /// In pictures, `v` upwards, if the material has a texture and all corners have one.
    pub(super) coordinates: Option<Vec<[f32; 2]>>,
    /// Linear red, green and blue, if the mesh has colours.
    pub(super) colors: Option<Vec<[f32; 3]>>,
}

impl Corners {
    pub(super) fn of(piece: &Piece, mesh: &Mesh, triangles: &Range<usize>) -> Corners {
        let (normals, coordinates) = (mesh.normals(), mesh.texture_coordinates());
        let has_normals = triangles.clone().all(|at| normals.of(at).is_some());
        // Without a picture they would say nothing, and part the vertices along their seams.
        let has_coordinates =
            piece.has_picture() && triangles.clone().all(|at| coordinates.of(at).is_some());
        let tiles = piece.material.texture.as_ref().map_or([1.0; 2], |one| one.sampler.tiles);
        let mut corners = Corners {
            indices: Vec::with_capacity(3 * triangles.len()),
            positions: Vec::new(),
            normals: has_normals.then(Vec::new),
            coordinates: has_coordinates.then(Vec::new),
            colors: (!mesh.colors().is_empty()).then(Vec::new),
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
                    let [u, v] = coordinates.values[coordinate as usize].to_array();
                    kept.push([u * tiles[0], v * tiles[1]]);
                }
                if let Some(kept) = &mut corners.colors {
                    kept.push(mesh.colors()[vertex as usize].to_array());
                }
            }
        }
        corners
    }

    /// Multiplies the colours of the vertices by one, where the program cannot.
    pub(super) fn multiply_colors(&mut self, color: Vec3) {
        for vertex in self.colors.iter_mut().flatten() {
            *vertex = (color * Vec3::from_array(*vertex)).to_array();
        }
    }
}
