//! What the triangles of a mesh are made of, where its file says so.

use crate::scene::material::Material;
use std::collections::{BTreeMap, BTreeSet};

/// Materials by name, and which of them each triangle has.
///
/// Triangles in a row mostly share a material, so what is kept is where each begins: nothing at all
/// for a mesh without materials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshMaterials {
    libraries: Vec<String>,
    /// The same, to be found among very many.
    known_libraries: BTreeSet<String>,
    named: Vec<NamedMaterial>,
    /// The place of each name in `named`.
    places: BTreeMap<String, u32>,
    spans: Vec<MaterialSpan>,
}

/// A material that a mesh calls by a name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Its name.
    pub name: String,
    /// The material itself; `None` until [`MeshMaterials::define`] gives it.
    pub material: Option<Material>,
}

/// From a triangle on, up to where the next span begins, one material or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialSpan {
    /// The first triangle.
    pub first: usize,
    /// The material's place among [`MeshMaterials::named`]; `None` is the object's own material.
    pub material: Option<u32>,
}

impl MeshMaterials {
    /// Adds a file that defines materials, under the name that the mesh's file gives it, unless it is there already.
    pub fn add_library(&mut self, name: &str) {
        if !self.known_libraries.contains(name) {
            self.known_libraries.insert(name.to_owned());
            self.libraries.push(name.to_owned());
        }
    }

    /// From this triangle on, the triangles are of this material; `None` is the object's own.
    ///
    /// # Panics
    ///
    /// If a material is used from a later triangle on already.
    pub fn use_from(&mut self, first: usize, name: Option<&str>) {
        let last = self.spans.last();
        assert!(last.is_none_or(|last| last.first <= first), "spans come in the triangles' order");
        if last.is_some_and(|last| last.first == first) {
            self.spans.pop();
        }
        let material = name.map(|name| self.place_of(name));
        // Before the first span, the object's own is used.
        if self.spans.last().and_then(|last| last.material) != material {
            self.spans.push(MaterialSpan { first, material });
        }
    }

    /// Defines a material, if the mesh uses one of this name and it is not defined yet.
    pub fn define(&mut self, name: &str, material: Material) {
        if let Some(&place) = self.places.get(name) {
            self.named[place as usize].material.get_or_insert(material);
        }
    }

    /// Whether there are neither material files nor materials.
    pub fn is_empty(&self) -> bool {
        self.libraries.is_empty() && self.spans.is_empty()
    }

    /// The files that define the materials, as the mesh's file names them.
    pub fn libraries(&self) -> &[String] {
        &self.libraries
    }

    /// The materials, in the order in which they are used first.
    pub fn named(&self) -> &[NamedMaterial] {
        &self.named
    }

    /// Where each material begins, by ascending triangles.
    pub fn spans(&self) -> &[MaterialSpan] {
        &self.spans
    }

    /// The material of a triangle, if it has one that is known.
    pub fn of(&self, triangle: usize) -> Option<&Material> {
        let begun = self.spans.partition_point(|span| span.first <= triangle);
        let span = self.spans[..begun].last()?;
        self.named[span.material? as usize].material.as_ref()
    }

    fn place_of(&mut self, name: &str) -> u32 {
        if let Some(&place) = self.places.get(name) {
            return place;
        }
        let place = u32::try_from(self.named.len()).expect("there are fewer names than triangles");
        self.named.push(NamedMaterial { name: name.to_owned(), material: None });
        self.places.insert(name.to_owned(), place);
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn each_triangle_has_the_material_named_last_before_it() {
        let mut materials = MeshMaterials::default();
        for (first, name) in [(2, "red"), (3, "red"), (4, "blue"), (4, "green"), (6, "red")] {
            materials.use_from(first, Some(name));
        }
        materials.use_from(7, None);
        assert_eq!(materials.spans().len(), 4, "no span says what the one before says");
        let red = Material { color: Vec3::X, ..Material::default() };
        materials.define("red", red.clone());
        materials.define("red", Material::default());
        materials.define("unheard-of", red.clone());
        let of: Vec<bool> = (0..9).map(|triangle| materials.of(triangle) == Some(&red)).collect();
        assert_eq!(of, [false, false, true, true, false, false, true, false, false]);
    }
}
