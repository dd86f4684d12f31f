//! What readers of all formats need to give a mesh its attributes.

use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use glam::{Vec2, Vec3};

/// The index of a corner without a value: [`Attribute::NONE`], which is the same number for values of every type.
pub(crate) const NONE: u32 = Attribute::<()>::NONE;

/// The mesh of what a reader has found. An attribute may lack entries for the last triangles, and the values of one that no
/// corner names are dropped.
///
/// # Panics
///
/// If a position is not finite or an index names nothing: the reader has checked them.
pub(crate) fn mesh(
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    materials: MeshMaterials,
) -> Mesh {
    let count = triangles.len();
    Mesh::new(positions, triangles)
        .and_then(|mesh| mesh.with_normals(complete(normals, count)))
        .and_then(|mesh| mesh.with_texture_coordinates(complete(texture_coordinates, count)))
        .expect("the reader has checked every number and every index")
        .with_materials(materials)
}

/// Gives an attribute an entry for each triangle, or removes its values if no corner has an index.
fn complete<T>(mut attribute: Attribute<T>, triangles: usize) -> Attribute<T> {
    if attribute.corners.as_flattened().iter().all(|&index| index == NONE) {
        return Attribute { values: Vec::new(), corners: Vec::new() };
    }
    attribute.corners.resize(triangles, [NONE; 3]);
    attribute
}
