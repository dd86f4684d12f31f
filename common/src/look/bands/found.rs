//! Primitives that are seen and are to be set up: one, or eight triangles at once.

use super::surfaces::{EightTriangles, Wanted, needs_normals_alone};
use crate::engine::simd::{Simd, SimdBase, f64x8, prefetch_at};
use crate::look::lanes::{DVec3x8, Lanes, each};
use crate::scene::material::Material;
use crate::scene::mesh::Attribute;
use crate::scene::{Object, Shape};
use crate::view::View;
use glam::Vec3;

/// A primitive that is seen, and not set up yet.
#[derive(Clone, Copy)]
pub(super) struct Found<'a> {
    pub(super) id: u64,
    pub(super) object: &'a Object,
    /// Its number among the object's primitives.
    pub(super) local: usize,
    pub(super) material: &'a Material,
}

/// Up to eight triangles of meshes; the first fills the lanes that are left.
pub(super) struct FoundEight<'a> {
    pub(super) found: [Found<'a>; 8],
    /// The vertices of each, and which normals its corners have.
    indices: [([u32; 3], [u32; 3]); 8],
    used: usize,
}

impl Found<'_> {
    /// The vertices of a triangle of a mesh, and which normals its corners have; `None` if there are none, or if
    /// something else is wanted.
    #[inline(always)]
    fn indices(&self, wanted: Wanted) -> Option<([u32; 3], [u32; 3])> {
        let Shape::Mesh(mesh) = &self.object.shape else { return None };
        let is_plain = needs_normals_alone(wanted, self.object, self.material);
        let normals = mesh.normals().corners.get(self.local).filter(|_| is_plain)?;
        // All corners have one.
        let have = |corner: &u32| *corner != Attribute::<Vec3>::NONE;
        normals.iter().all(have).then(|| (mesh.triangles()[self.local], *normals))
    }

    /// Asks the machine for the indices of a triangle of a mesh.
    #[inline(always)]
    pub(super) fn prefetch_indices(&self) {
        if let Shape::Mesh(mesh) = &self.object.shape {
            prefetch_at(mesh.triangles(), self.local);
            prefetch_at(&mesh.normals().corners, self.local);
        }
    }

    /// Asks the machine for the vertices and the normals of a triangle of a mesh.
    #[inline(always)]
    pub(super) fn prefetch_corners(&self) {
        let Shape::Mesh(mesh) = &self.object.shape else { return };
        let [positions, normals] = [mesh.positions(), &mesh.normals().values];
        for &vertex in mesh.triangles().get(self.local).into_iter().flatten() {
            prefetch_at(positions, vertex as usize);
        }
        for &normal in mesh.normals().corners.get(self.local).into_iter().flatten() {
            prefetch_at(normals, normal as usize);
        }
    }
}

impl<'a> FoundEight<'a> {
    /// Eight times the same one, for so many that are to take its place.
    #[inline(always)]
    pub(super) fn all(found: Found<'a>, used: usize) -> FoundEight<'a> {
        FoundEight { found: [found; 8], indices: [([0; 3], [0; 3]); 8], used }
    }

    /// Whether of all nothing is wanted but interpolated normals.
    #[inline(always)]
    pub(super) fn have_normals_alone(&mut self, wanted: Wanted) -> bool {
        for (found, indices) in self.found.iter().zip(&mut self.indices) {
            let Some(known) = found.indices(wanted) else { return false };
            *indices = known;
        }
        true
    }

    /// The corners and normals: those of all eight are fetched at once.
    #[inline(always)]
    pub(super) fn triangles<S: Simd>(&self, simd: S, view: &View) -> EightTriangles<S> {
        let mut coordinates = [[[0.0; 8]; 3]; 6];
        for (lane, (found, indices)) in self.found.iter().zip(self.indices).enumerate() {
            let Shape::Mesh(mesh) = &found.object.shape else { continue };
            let (vertices, normals) = indices;
            let positions = vertices.map(|vertex| mesh.positions()[vertex as usize]);
            let normals = normals.map(|normal| mesh.normals().values[normal as usize]);
            for (k, vector) in positions.into_iter().chain(normals).enumerate() {
                for (axis, coordinate) in vector.to_array().into_iter().enumerate() {
                    coordinates[k][axis][lane] = f64::from(coordinate);
                }
            }
        }
        let [a, b, c, at_a, at_b, at_c] = each!(k in [0, 1, 2, 3, 4, 5] => {
            let [x, y, z] =
                each!(axis in [0, 1, 2] => f64x8::load_array_ref(simd, &coordinates[k][axis]));
            Lanes { x, y, z }
        });
        let eye = DVec3x8::splat(simd, view.camera.eye().as_dvec3());
        let corners = each!(corner in [a, b, c] => corner - eye);
        EightTriangles { corners, normals: [at_a, at_b, at_c], used: self.used }
    }
}
