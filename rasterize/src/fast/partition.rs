//! How scene and picture are divided, as something to look at: clusters of triangles, tiles of samples.

use super::prepared::Prepared;
use super::search::clusters::CLUSTER;
use super::search::instances::placed_box;
use bothways_common::glam::Vec3;
use bothways_common::{Scene, Shape};
use std::collections::HashMap;

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

    /// Which cluster each of these primitives of the scene belongs to: its place in what [`Prepared::cluster_boxes`]
    /// gives. `None` for a triangle, a sphere or a plane of its own.
    ///
    /// # Panics
    ///
    /// If there is no such primitive.
    pub fn clusters_of(&self, scene: &Scene, primitives: &[u64]) -> Vec<Option<usize>> {
        let mut firsts = Vec::with_capacity(self.clusters.len());
        let mut before = 0;
        for (clusters, object) in self.clusters.iter().zip(scene.objects()) {
            firsts.push(before);
            before += match &object.shape {
                Shape::Instances(instances) if instances.mesh().bounds().is_none() => 0,
                Shape::Instances(instances) => instances.placements().len(),
                _ => clusters.bounds().len(),
            };
        }
        // Where the triangles of a mesh stand in the order of their clusters.
        let mut places: HashMap<usize, Vec<u32>> = HashMap::new();
        let mut cluster_of = |id: u64| {
            let (object, number) = scene.locate(id);
            let shape = &scene.objects()[object].shape;
            let within = match shape {
                Shape::Instances(instances) => instances.locate(number).0,
                Shape::Mesh(mesh) => {
                    let order = self.clusters[object].triangles_of(mesh);
                    let places = places.entry(object).or_insert_with(|| order.places());
                    places.get(number).map_or(number, |place| *place as usize) / CLUSTER as usize
                }
                Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => return None,
            };
            Some(firsts[object] + within)
        };
        primitives.iter().map(|id| cluster_of(*id)).collect()
    }

    /// The rows and columns of a tile, in samples.
    pub fn tile(&self) -> [usize; 2] {
        self.tile.map(|bits| 1 << bits)
    }
}

#[cfg(test)]
mod tests {
    use crate::fast::prepare;
    use bothways_common::glam::Vec3;
    use bothways_common::{Instances, Mesh, Placement, Scene, Shape, Sphere};

    /// A strip of triangles; `step` is from one triangle of the file to the next in the strip.
    fn strip(count: u16, step: u32) -> Mesh {
        let positions: Vec<Vec3> =
            (0..count + 2).map(|k| Vec3::new(f32::from(k), f32::from(k % 2), -3.0)).collect();
        let count = u32::from(count);
        let triangles = (0..count).map(|k| k * step % count).map(|k| [k, k + 1, k + 2]).collect();
        Mesh::new(positions, triangles).expect("it is a mesh")
    }

    #[test]
    fn a_cluster_holds_the_triangles_that_are_said_to_be_its_own() {
        let ball = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
        let two = Instances::new(strip(40, 1), vec![Placement::IDENTITY; 2]).unwrap();
        let none = Instances::new(Mesh::default(), vec![Placement::IDENTITY]).unwrap();
        let shapes = [
            Shape::Mesh(strip(100, 1)),
            ball,
            Shape::Instances(none),
            Shape::Instances(two),
            Shape::Mesh(strip(1009, 353)),
        ];
        let scene = Scene::new(shapes.map(Into::into).into()).expect("it is a scene");
        let prepared = prepare(&scene);
        let boxes = prepared.cluster_boxes(&scene);
        let ids: Vec<u64> = (0..scene.primitive_count()).collect();
        let clusters = prepared.clusters_of(&scene, &ids);
        assert_eq!(clusters[100], None, "a sphere is in no cluster");
        let mut triangles = vec![0; boxes.len()];
        for (id, cluster) in ids.iter().zip(clusters) {
            let (object, number) = scene.locate(*id);
            let corners = match &scene.objects()[object].shape {
                Shape::Mesh(mesh) => mesh.corners(number),
                Shape::Instances(instances) => instances.corners(number),
                _ => continue,
            };
            let cluster = cluster.expect("a triangle of a mesh is in a cluster");
            triangles[cluster] += 1;
            let within = &boxes[cluster];
            assert_eq!(within.object, object);
            for corner in corners {
                assert!(corner.cmpge(within.low).all() && corner.cmple(within.high).all());
            }
        }
        assert_eq!(triangles, boxes.iter().map(|one| one.triangles).collect::<Vec<_>>());
    }
}
