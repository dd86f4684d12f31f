//! Primitives that are seen and are to be set up: those of one object, one or eight triangles at once.

use super::surfaces::{EightTriangles, Wanted, is_plain};
use crate::engine::simd::{Simd, SimdBase, f64x8, prefetch_at};
use crate::look::lanes::{DVec3x8, Lanes, each};
use crate::scene::material::Material;
use crate::scene::mesh::Mesh;
use crate::scene::{Object, Scene, Shape};
use crate::view::View;
use std::ops::Range;

/// An object of which primitives are seen that are not set up yet.
pub(super) struct Found<'a> {
    pub(super) object: &'a Object,
    /// The ids of all its primitives.
    ids: Range<u64>,
    /// Its mesh, if it is one.
    mesh: Option<&'a Mesh>,
    wanted: Wanted<'a>,
    /// Whether nothing is wanted of what has the object's material but normals and ways to lights.
    is_plain: bool,
}

/// The coordinates of the corners of eight triangles, and of the normals there.
pub(super) type Corners = [[[f32; 8]; 3]; 6];

impl<'a> Found<'a> {
    /// The object that this primitive belongs to.
    pub(super) fn of(scene: &'a Scene, id: u64, wanted: Wanted<'a>) -> Found<'a> {
        let (number, _) = scene.locate(id);
        let object = &scene.objects()[number];
        let mesh = match &object.shape {
            Shape::Mesh(mesh) => Some(mesh),
            _ => None,
        };
        let is_plain = is_plain(wanted, object, &object.material);
        Found { object, ids: scene.ids_of(number), mesh, wanted, is_plain }
    }

    /// Whether a primitive belongs to the object.
    #[inline(always)]
    pub(super) fn has(&self, id: u64) -> bool {
        self.ids.contains(&id)
    }

    /// The number of a primitive among the object's own.
    #[inline(always)]
    pub(super) fn local(&self, id: u64) -> usize {
        usize::try_from(id - self.ids.start).expect("primitives of one object can be counted")
    }

    #[inline(always)]
    pub(super) fn material(&self, id: u64) -> &'a Material {
        self.object.material_of(self.local(id))
    }

    /// Asks the machine for the indices of a triangle of a mesh.
    #[inline(always)]
    pub(super) fn prefetch_indices(&self, id: u64) {
        if let Some(mesh) = self.mesh {
            let triangle = self.local(id);
            prefetch_at(mesh.triangles(), triangle);
            prefetch_at(&mesh.normals().corners, triangle);
        }
    }

    /// Asks the machine for the vertices and the normals of a triangle of a mesh, whose indices have been asked for.
    #[inline(always)]
    pub(super) fn prefetch_corners(&self, id: u64) {
        let Some(mesh) = self.mesh else { return };
        let (triangle, normals) = (self.local(id), mesh.normals());
        for &vertex in mesh.triangles().get(triangle).into_iter().flatten() {
            prefetch_at(mesh.positions(), vertex as usize);
        }
        for &normal in normals.corners.get(triangle).into_iter().flatten() {
            prefetch_at(&normals.values, normal as usize);
        }
    }

    /// Reads the corners and normals of up to eight triangles; the last one fills the lanes that are left. `false` if something else
    /// is wanted of one, or if it has no normals.
    #[inline(always)]
    pub(super) fn read(&self, ids: &[u64], corners: &mut Corners) -> bool {
        let Some(mesh) = self.mesh else { return false };
        let is_plain = |id: &u64| is_plain(self.wanted, self.object, self.material(*id));
        let are_plain =
            if mesh.materials().is_some() { ids.iter().all(is_plain) } else { self.is_plain };
        if !are_plain {
            return false;
        }
        let normals = mesh.normals();
        for lane in 0..8 {
            let triangle = self.local(ids[lane.min(ids.len() - 1)]);
            let Some(of_corners) = normals.corners.get(triangle) else { return false };
            let vertices = mesh.triangles()[triangle];
            for k in 0..3 {
                let position = mesh.positions()[vertices[k] as usize];
                let Some(normal) = normals.values.get(of_corners[k] as usize) else { return false };
                for axis in 0..3 {
                    corners[k][axis][lane] = position[axis];
                    corners[3 + k][axis][lane] = normal[axis];
                }
            }
        }
        true
    }
}

impl<S: Simd> EightTriangles<S> {
    /// The triangles with these corners and normals, of which so many are used.
    #[inline(always)]
    pub(super) fn new(simd: S, view: &View, corners: &Corners, used: usize) -> Self {
        let [a, b, c, at_a, at_b, at_c] = each!(k in [0, 1, 2, 3, 4, 5] => {
            let [x, y, z] = each!(axis in [0, 1, 2] => {
                f64x8::from_fn(simd, |lane| f64::from(corners[k][axis][lane]))
            });
            Lanes { x, y, z }
        });
        let eye = DVec3x8::splat(simd, view.camera.eye().as_dvec3());
        let corners = each!(corner in [a, b, c] => corner - eye);
        EightTriangles { corners, normals: [at_a, at_b, at_c], used }
    }
}
