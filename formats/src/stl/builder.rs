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
    /// The vertex at each place.
    vertices: HashMap<[u32; 3], u32>,
}

impl Builder {
    /// Adds a triangle; its corners are finite.
    pub(super) fn facet(&mut self, corners: [Vec3; 3]) -> Result<(), StlFault> {
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            *index = self.vertex(corner)?;
        }
        self.triangles.push(triangle);
        Ok(())
    }

    fn vertex(&mut self, position: Vec3) -> Result<u32, StlFault> {
        // −0 and 0 are the same place.
        let place = (position + Vec3::ZERO).to_array().map(f32::to_bits);
        let next = u32::try_from(self.positions.len()).ok().filter(|&next| next < u32::MAX);
        match self.vertices.get(&place) {
            Some(&known) => Ok(known),
            None => {
                let next = next.ok_or(StlFault::TooManyVertices)?;
                self.vertices.insert(place, next);
                self.positions.push(position);
                Ok(next)
            }
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    pub(super) fn finish(self) -> Mesh {
        Mesh::new(self.positions, self.triangles).expect("the reader has checked every number")
    }
}
