//! The mesh that an STL file describes: corners at the same place become one vertex.

use super::error::StlFault;
use bothways_common::scene::Mesh;
use glam::Vec3;
use std::collections::HashMap;

/// A mesh under construction.
#[derive(Default)]
pub(super) struct Builder {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    places: Places,
}

impl Builder {
    /// Adds a triangle; its corners are finite.
    pub(super) fn facet(&mut self, corners: [Vec3; 3]) -> Result<(), StlFault> {
        let triangle = self.places.triangle(corners, |position| self.positions.push(position))?;
        self.triangles.push(triangle);
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    pub(super) fn finish(self) -> Mesh {
        Mesh::new(self.positions, self.triangles).expect("the reader has checked every number")
    }
}

/// The vertex at each place, numbered in the order in which they come first.
#[derive(Debug, Default)]
pub(super) struct Places(HashMap<[u32; 3], u32>);

impl Places {
    /// The vertices at these corners; visits those that are new.
    pub(super) fn triangle(
        &mut self,
        corners: [Vec3; 3],
        mut new: impl FnMut(Vec3),
    ) -> Result<[u32; 3], StlFault> {
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            *index = self.vertex(corner, &mut new)?;
        }
        Ok(triangle)
    }

    /// The vertices at these corners, which are all known unless the file has changed.
    pub(super) fn known(&self, corners: [Vec3; 3]) -> Result<[u32; 3], StlFault> {
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            *index = *self.0.get(&place(corner)).ok_or(StlFault::Changed)?;
        }
        Ok(triangle)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn vertex(&mut self, position: Vec3, new: &mut impl FnMut(Vec3)) -> Result<u32, StlFault> {
        let place = place(position);
        if let Some(&known) = self.0.get(&place) {
            return Ok(known);
        }
        let next = u32::try_from(self.0.len()).ok().filter(|&next| next < u32::MAX);
        let next = next.ok_or(StlFault::TooManyVertices)?;
        self.0.insert(place, next);
        new(position);
        Ok(next)
    }
}

/// −0 and 0 are the same place.
fn place(position: Vec3) -> [u32; 3] {
    (position + Vec3::ZERO).to_array().map(f32::to_bits)
}
