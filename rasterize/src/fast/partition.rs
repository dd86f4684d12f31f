//! How scene and picture are divided, as something to look at: clusters of triangles, tiles of samples.

use super::prepared::Prepared;
use super::search::clusters::CLUSTER;
use super::search::instances::placed_box;
use bothways_common::glam::Vec3;
use bothways_common::{Scene, Shape};

/// A cluster of neighbouring triangles of a mesh, or an instance of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClusterBox {
    /// The object, counted from 0.
    pub object: usize,
    /// Its least corner, in the world.
    pub low: Vec3,
    /// Its greatest corner, in the world.
    pub high: Vec3,
    /// How many triangles it has.
    pub triangles: usize,
}

impl Prepared {
    /// The clusters of all meshes of the scene that this was prepared for; of instances, the box of each as a whole.
    pub fn cluster_boxes(&self, scene: &Scene) -> Vec<ClusterBox> {
        let mut boxes = Vec::new();
        for (object, (clusters, described)) in self.clusters.iter().zip(scene.objects()).enumerate()
        {
            if let Shape::Instances(instances) = &described.shape {
                let triangles = instances.mesh().triangles().len();
                let Some(bounds) = instances.mesh().bounds() else { continue };
                boxes.extend(instances.placements().iter().map(|placement| {
                    let [low, high] = placed_box(placement, &bounds);
                    ClusterBox { object, low, high, triangles }
                }));
                continue;
            }
            let mut left = described.shape.primitive_count();
            for [low, high] in clusters.bounds() {
                let triangles = left.min(CLUSTER as usize);
                boxes.push(ClusterBox { object, low: *low, high: *high, triangles });
                left -= triangles;
            }
        }
        boxes
    }

    /// The rows and columns of a tile, in samples.
    pub fn tile(&self) -> [usize; 2] {
        self.tile.map(|bits| 1 << bits)
    }
}
