//! The triangles that bins and clusters list, looked up one after another.

use super::clusters::Triangles;
use crate::fast::geometry::Geometry;
use crate::fast::vertices::Vertex;
use bothways_common::engine::simd::prefetch;
use std::ops::Range;

/// Finds triangles by their slots, which mostly come in ascending order.
pub(crate) struct Finder<'a> {
    geometry: &'a Geometry<'a>,
    /// The names of the current object's primitives.
    names: Range<u32>,
    /// Its triangles; none if it is not a mesh.
    triangles: Triangles<'a>,
    /// Its vertices, and those of the objects behind it.
    vertices: &'a [Vertex],
}

impl<'a> Finder<'a> {
    pub(crate) fn new(geometry: &'a Geometry<'a>) -> Self {
        Finder { geometry, names: 0..0, triangles: Triangles::NONE, vertices: &[] }
    }

    /// The name of an object's first primitive, its triangles and vertices.
    pub(crate) fn object(&mut self, object: u32) -> (u32, Triangles<'a>, &'a [Vertex]) {
        let object = object as usize;
        let Geometry { view, clusters, vertices, first_vertices, .. } = self.geometry;
        let first_name = view.scene.first_name(object);
        let triangles = clusters[object].triangles(&view.scene.objects()[object].shape);
        (first_name, triangles, &vertices[first_vertices[object]..])
    }

    /// The name and the vertices of a triangle.
    #[inline(always)]
    pub(crate) fn triangle(&mut self, slot: u32) -> (u32, [Vertex; 3]) {
        self.find_object(slot);
        let own = slot - self.names.start;
        let name = self.names.start + self.triangles.number(own);
        let triangle = self.triangles.corners.get(own as usize).copied().unwrap_or([0, 1, 2]);
        (name, triangle.map(|vertex| self.vertices[vertex as usize]))
    }

    /// The name of any primitive.
    pub(crate) fn name(&mut self, slot: u32) -> u32 {
        self.find_object(slot);
        self.names.start + self.triangles.number(slot - self.names.start)
    }

    /// Prepares for the sixteen triangles from `next` on, and a little for the sixteen behind them.
    #[inline(always)]
    pub(crate) fn look_ahead(&self, slots: &[u32], next: usize) {
        let corners = self.triangles.corners;
        let triangle = |slot: u32| corners.get(slot.wrapping_sub(self.names.start) as usize);
        let from = |start: usize| slots.get(start..).unwrap_or_default().iter().take(16);
        for &slot in from(next + 16) {
            triangle(slot).into_iter().for_each(prefetch);
        }
        for &slot in from(next) {
            for vertex in triangle(slot).into_iter().flatten() {
                prefetch(&self.vertices[*vertex as usize]);
            }
        }
    }

    #[inline(always)]
    fn find_object(&mut self, slot: u32) {
        if !self.names.contains(&slot) {
            self.find_other_object(slot);
        }
    }

    #[cold]
    fn find_other_object(&mut self, slot: u32) {
        let scene = self.geometry.view.scene;
        let (object, _) = scene.locate_name(slot);
        let number = |count: usize| u32::try_from(count).expect("ids are u32");
        let count = number(scene.objects()[object].shape.primitive_count());
        let (first, triangles, vertices) = self.object(number(object));
        (self.names, self.triangles, self.vertices) = (first..first + count, triangles, vertices);
    }
}
