//! What readers of all formats need to give a mesh its attributes.

use bothways_common::look::color::{linear_from_encoded, linear_from_srgb};
use bothways_common::scene::{Attribute, Mesh, MeshMaterials};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

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
    colors: Vec<Vec3>,
    materials: MeshMaterials,
) -> Mesh {
    let (count, vertices) = (triangles.len(), positions.len());
    let colors = filled_up(colors, vertices);
    Mesh::new(positions, triangles)
        .and_then(|mesh| mesh.with_normals(complete(normals, count)))
        .and_then(|mesh| mesh.with_texture_coordinates(complete(texture_coordinates, count)))
        .and_then(|mesh| mesh.with_colors(colors))
        .expect("the reader has checked every number and every index")
        .with_materials(materials)
}

/// Gives the last vertices a colour, too, if any has one: white.
fn filled_up(mut colors: Vec<Vec3>, vertices: usize) -> Vec<Vec3> {
    if !colors.is_empty() {
        colors.resize(vertices, Vec3::ONE);
    }
    colors
}

/// Adds the colour of a vertex. Vertices before it that have none are white.
#[inline]
pub(crate) fn push_color(colors: &mut Vec<Vec3>, vertex: usize, color: Vec3) {
    colors.resize(vertex, Vec3::ONE);
    colors.push(color);
}

/// Colours in linear light, from those that a program has written as it shows them: as sRGB, from 0 to 1. Values outside are
/// clamped, and what is no number is 0.
pub(crate) fn linear_colors(mut encoded: Vec<Vec3>) -> Vec<Vec3> {
    let table: Vec<f32> = (0..=255).map(linear_from_srgb).collect();
    let linear = |value: f32| {
        let value = if value > 0.0 { value.min(1.0) } else { 0.0 };
        // Most values are bytes.
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let byte = (value * 255.0).round() as u8;
        if f32::from(byte) / 255.0 == value {
            table[usize::from(byte)]
        } else {
            linear_from_encoded(value)
        }
    };
    encoded.par_iter_mut().for_each(|color| *color = color.map(linear));
    encoded
}

/// Gives an attribute an entry for each triangle, or removes its values if no corner has an index.
fn complete<T>(mut attribute: Attribute<T>, triangles: usize) -> Attribute<T> {
    if attribute.corners.as_flattened().iter().all(|&index| index == NONE) {
        return Attribute { values: Vec::new(), corners: Vec::new() };
    }
    attribute.corners.resize(triangles, [NONE; 3]);
    attribute
}
