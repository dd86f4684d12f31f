//! Triangle meshes: positions that triangles share by index, and what the corners carry.

mod materials;

pub use materials::{MaterialSpan, MeshMaterials, NamedMaterial};

use super::material::Material;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Triangles over shared vertices.
///
/// Neighbours that name the same positions leave no gap and no overlap between them. Normals and
/// texture coordinates have indices of their own, so that a seam or a crease in them never tears
/// the surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    normals: Attribute<Vec3>,
    texture_coordinates: Attribute<Vec2>,
    /// For each vertex, or none at all.
    colors: Vec<Vec3>,
    /// Few meshes have materials, hence the box.
    materials: Option<Box<MeshMaterials>>,
}

/// What the corners of a mesh's triangles carry: values, and which of them belongs to which corner.
///
/// Both are empty where the mesh has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attribute<T> {
    /// The values.
    pub values: Vec<T>,
    /// For each triangle, the values at its corners; [`Attribute::NONE`] where a corner has none.
    pub corners: Vec<[u32; 3]>,
}

impl<T: Copy> Attribute<T> {
    /// The index that says that a corner carries no value.
    pub const NONE: u32 = u32::MAX;

    /// The values at a triangle's corners; `None` unless all three have one.
    pub fn of(&self, triangle: usize) -> Option<[T; 3]> {
        let corners = self.corners.get(triangle)?;
        let value = |corner: u32| self.values.get(corner as usize).copied();
        Some([value(corners[0])?, value(corners[1])?, value(corners[2])?])
    }
}

/// Why a mesh is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite: {position}")]
    NotFinite {
        /// The vertex, counted from 0.
        vertex: usize,
        /// Its position, as it was given.
        position: Vec3,
    },
    /// A triangle names a vertex, normal or texture coordinate that does not exist.
    #[error("triangle {triangle} names {what} {index}, but there are only {count}")]
    UnknownIndex {
        /// The triangle, counted from 0.
        triangle: usize,
        /// What it names.
        what: &'static str,
        /// Counted from 0.
        index: u32,
        /// How many exist.
        count: usize,
    },
    /// There is not one colour for each vertex.
    #[error("there are {colors} colours for {vertices} vertices")]
    ColorCount {
        /// How many colours there are.
        colors: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An attribute does not have one entry for each triangle.
    #[error("there are {corners} triangles of {what} for {triangles} triangles")]
    CornerCount {
        /// Which attribute.
        what: &'static str,
        /// How many entries it has.
        corners: usize,
        /// How many triangles there are.
        triangles: usize,
    },
}

impl Mesh {
    /// A mesh of positions and triangles alone.
    ///
    /// # Errors
    ///
    /// A position that is not finite, or an index without a vertex.
    ///
    /// ```
    /// use bothways_common::{Mesh, glam::Vec3};
    ///
    /// let mesh = Mesh::new(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(mesh.corners(0), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    /// # Ok::<(), bothways_common::MeshError>(())
    /// ```
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Mesh, MeshError> {
        let any_infinite = |positions: &[Vec3]| {
            positions.iter().fold(false, |any, position| any | !position.is_finite())
        };
        if let Some(vertex) = first(&positions, any_infinite, |p| !p.is_finite()) {
            return Err(MeshError::NotFinite { vertex, position: positions[vertex] });
        }
        check_indices("vertex", &triangles, positions.len(), None)?;
        Ok(Mesh { positions, triangles, ..Mesh::default() })
    }

    /// The same mesh with a normal at each corner; they need no unit length.
    ///
    /// # Errors
    ///
    /// An index without a value, or not one entry for each triangle.
    pub fn with_normals(mut self, normals: Attribute<Vec3>) -> Result<Mesh, MeshError> {
        self.check_attribute("normal", &normals)?;
        self.normals = normals;
        Ok(self)
    }

    /// The same mesh with texture coordinates at each corner.
    ///
    /// # Errors
    ///
    /// As for [`Mesh::with_normals`].
    pub fn with_texture_coordinates(mut self, values: Attribute<Vec2>) -> Result<Mesh, MeshError> {
        self.check_attribute("texture coordinate", &values)?;
        self.texture_coordinates = values;
        Ok(self)
    }

    /// The same mesh with a colour at each vertex, linear red, green and blue in 0 … 1, by which materials are multiplied;
    /// none at all takes them away.
    ///
    /// # Errors
    ///
    /// Not one colour for each vertex.
    pub fn with_colors(mut self, colors: Vec<Vec3>) -> Result<Mesh, MeshError> {
        let vertices = self.positions.len();
        if !colors.is_empty() && colors.len() != vertices {
            return Err(MeshError::ColorCount { colors: colors.len(), vertices });
        }
        self.colors = colors;
        Ok(self)
    }

    /// The same mesh, its triangles made of these; [`MeshMaterials::default`] takes them away.
    pub fn with_materials(self, materials: MeshMaterials) -> Mesh {
        let materials = (!materials.is_empty()).then(|| Box::new(materials));
        Mesh { materials, ..self }
    }

    /// Defines a material by its name: see [`MeshMaterials::define`].
    pub fn define_material(&mut self, name: &str, material: Material) {
        if let Some(materials) = &mut self.materials {
            materials.define(name, material);
        }
    }

    /// The same mesh in another place: `place` maps positions, `turn` maps normals.
    ///
    /// # Errors
    ///
    /// A position that is not finite once it is there.
    pub fn map(
        mut self,
        place: impl Fn(Vec3) -> Vec3,
        turn: impl Fn(Vec3) -> Vec3,
    ) -> Result<Mesh, MeshError> {
        for position in &mut self.positions {
            *position = place(*position);
        }
        for normal in &mut self.normals.values {
            *normal = turn(*normal);
        }
        let Mesh { positions, triangles, normals, texture_coordinates, colors, materials } = self;
        let moved = Mesh::new(positions, triangles)?;
        Ok(Mesh { normals, texture_coordinates, colors, materials, ..moved })
    }

    /// The same triangles with their corners in the opposite order: those seen counter-clockwise are then seen
    /// clockwise. Attributes stay with their corners.
    #[must_use]
    pub fn turned_inside_out(mut self) -> Mesh {
        let lists =
            [&mut self.triangles, &mut self.normals.corners, &mut self.texture_coordinates.corners];
        lists.into_iter().flatten().for_each(|[_, b, c]| std::mem::swap(b, c));
        self
    }

    /// The vertices' positions, in the world.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The least and the greatest corner of the box around all positions; `None` if there are none.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        let around =
            |[low, high]: [Vec3; 2], position: &Vec3| [low.min(*position), high.max(*position)];
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold([first; 2], around))
    }

    /// The triangles, each three indices of positions.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Normals at the corners.
    pub fn normals(&self) -> &Attribute<Vec3> {
        &self.normals
    }

    /// Texture coordinates at the corners.
    pub fn texture_coordinates(&self) -> &Attribute<Vec2> {
        &self.texture_coordinates
    }

    /// The colours of the vertices, linear red, green and blue; empty if they have none.
    pub fn colors(&self) -> &[Vec3] {
        &self.colors
    }

    /// The material of triangles without one, unless their object has one: white if vertices have colours, so that these are
    /// seen, otherwise the default.
    pub fn own_material(&self) -> Material {
        match self.colors[..] {
            [] => Material::default(),
            _ => Material { color: Vec3::ONE, ..Material::default() },
        }
    }

    /// Whether it says what it looks like: by colours or by materials.
    pub fn has_look(&self) -> bool {
        self.materials.is_some() || !self.colors.is_empty()
    }

    /// The materials of the triangles, if the mesh names any.
    pub fn materials(&self) -> Option<&MeshMaterials> {
        self.materials.as_deref()
    }

    /// The three corners of a triangle.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex as usize])
    }

    fn check_attribute<T: Copy>(
        &self,
        what: &'static str,
        attribute: &Attribute<T>,
    ) -> Result<(), MeshError> {
        let (corners, triangles) = (attribute.corners.len(), self.triangles.len());
        if corners != triangles && corners != 0 {
            return Err(MeshError::CornerCount { what, corners, triangles });
        }
        let none = Some(Attribute::<T>::NONE);
        check_indices(what, &attribute.corners, attribute.values.len(), none)
    }
}

/// The place of the first item that is wrong, if one is. `any` tells whether one of some items is; all threads ask it.
fn first<T: Sync>(
    items: &[T],
    any: impl Fn(&[T]) -> bool + Send + Sync,
    is_wrong: impl Fn(&T) -> bool,
) -> Option<usize> {
    const SOME: usize = 1 << 14;
    // Small meshes do not wake other threads.
    if items.len() <= SOME {
        return any(items).then(|| items.iter().position(&is_wrong)).flatten();
    }
    let part = items.par_chunks(SOME).position_first(any)?;
    let within = items[part * SOME..].iter().position(is_wrong);
    Some(part * SOME + within.expect("one of them is wrong"))
}

/// Makes sure that all indices but `none` are less than `count`.
fn check_indices(
    what: &'static str,
    triangles: &[[u32; 3]],
    count: usize,
    none: Option<u32>,
) -> Result<(), MeshError> {
    let is_unknown = |index: u32| index as usize >= count && Some(index) != none;
    // Without a branch for each index, which makes this several times as fast.
    let any_unknown = |triangles: &[[u32; 3]]| {
        triangles.as_flattened().iter().fold(false, |any, &index| any | is_unknown(index))
    };
    let wrong = first(triangles, any_unknown, |indices| indices.iter().copied().any(is_unknown));
    let Some(triangle) = wrong else { return Ok(()) };
    let index = triangles[triangle].into_iter().find(|&index| is_unknown(index));
    let index = index.expect("one of the three is unknown");
    Err(MeshError::UnknownIndex { triangle, what, index, count })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_without_a_vertex_is_refused() {
        let error = Mesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
        assert_eq!(error.to_string(), "triangle 1 names vertex 3, but there are only 3");
    }

    #[test]
    fn a_corner_may_lack_a_normal() {
        let mesh = Mesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [2, 1, 0]]).unwrap();
        let none = Attribute::<Vec3>::NONE;
        let normals = Attribute { values: vec![Vec3::X], corners: vec![[0, 0, 0], [0, none, 0]] };
        let mesh = mesh.with_normals(normals).unwrap();
        assert_eq!(mesh.normals().of(0), Some([Vec3::X; 3]));
        assert_eq!(mesh.normals().of(1), None);
    }
}
