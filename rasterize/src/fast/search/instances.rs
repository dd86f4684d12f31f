//! Meshes that instances share, in clusters with vertices of their own; and where an instance of one may be seen.
//!
//! No vertex of an instance is kept: where a cluster of it may be seen in a tile, its vertices are placed in the world
//! and on the raster there, some dozens at a time.

use super::clusters::{Bounds, CLUSTER, Clusters};
use super::extent::Extent;
use crate::fast::camera_map::CameraMap;
use crate::fast::vertices::{FixedPointRaster, Vertex};
use bothways_common::engine::simd::{Simd, apart};
use bothways_common::look::lanes::each;
use bothways_common::{Mesh, Placement, Scene, Shape};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Vertices of a cluster at most: three for each triangle.
const MOST_VERTICES: usize = 3 * CLUSTER as usize;

/// The vertices of one cluster of one instance.
pub(crate) type PlacedVertices = [Vertex; MOST_VERTICES];

/// One instance that may be seen in a tile.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instance {
    pub(crate) object: u32,
    /// Its number in the object.
    pub(crate) number: u32,
    pub(crate) extent: Extent,
}

/// A mesh that instances share, in clusters of neighbouring triangles.
#[derive(Clone, Debug)]
pub(crate) struct SharedMesh {
    pub(crate) clusters: Vec<SharedCluster>,
    /// A box around all of it, in its own coordinates.
    pub(crate) bounds: Bounds,
    /// The vertices of the clusters: rows of x, y and z of sixteen each.
    positions: Vec<[[f32; 16]; 3]>,
    /// For each triangle, in the order of the clusters, which of its cluster's vertices are its corners.
    corners: Vec<[u8; 3]>,
    /// Its number in the mesh, unless that is its place here.
    numbers: Option<Vec<u32>>,
}

/// Some consecutive triangles of a [`SharedMesh`].
#[derive(Clone, Debug)]
pub(crate) struct SharedCluster {
    pub(crate) bounds: Bounds,
    blocks: Range<u32>,
    triangles: Range<u32>,
}

impl SharedMesh {
    fn new(mesh: &Mesh) -> SharedMesh {
        let clusters = Clusters::of_mesh(mesh);
        let (triangles, numbers) = clusters.triangles_of(mesh).parts();
        let positions = clusters.positions(mesh);
        let mut shared = SharedMesh {
            clusters: Vec::with_capacity(clusters.bounds().len()),
            bounds: mesh.bounds().unwrap_or_default(),
            positions: Vec::new(),
            corners: Vec::with_capacity(triangles.len()),
            numbers: numbers.map(<[u32]>::to_vec),
        };
        for (bounds, triangles) in clusters.bounds().iter().zip(triangles.chunks(CLUSTER as usize))
        {
            shared.add(*bounds, triangles, positions);
        }
        shared
    }

    fn add(&mut self, bounds: Bounds, triangles: &[[u32; 3]], positions: &[Vec3]) {
        let mut vertices: Vec<u32> = Vec::with_capacity(MOST_VERTICES);
        let mut number = |vertex: u32| {
            let place = vertices.iter().position(|known| *known == vertex);
            let place = place.unwrap_or_else(|| {
                vertices.push(vertex);
                vertices.len() - 1
            });
            u8::try_from(place).expect("a cluster has at most 96 vertices")
        };
        let index = |length: usize| u32::try_from(length).expect("ids are u32");
        let first = index(self.corners.len());
        self.corners.extend(triangles.iter().map(|corners| corners.map(&mut number)));
        let first_block = index(self.positions.len());
        for sixteen in vertices.chunks(16) {
            // Lanes behind the last vertex repeat the first.
            let vertex =
                |lane: usize| positions[*sixteen.get(lane).unwrap_or(&sixteen[0]) as usize];
            let row = |axis: usize| std::array::from_fn(|lane| vertex(lane)[axis]);
            self.positions.push([row(0), row(1), row(2)]);
        }
        let blocks = first_block..index(self.positions.len());
        self.clusters.push(SharedCluster {
            bounds,
            blocks,
            triangles: first..index(self.corners.len()),
        });
    }

    /// How many triangles an instance has.
    pub(crate) fn triangle_count(&self) -> u32 {
        u32::try_from(self.corners.len()).expect("ids are u32")
    }

    /// Places the vertices of a cluster of one instance. It is compiled once for all loops that call it.
    #[inline(never)]
    pub(crate) fn place<S: Simd>(
        &self,
        simd: S,
        onto: (&CameraMap, &FixedPointRaster),
        placement: &Placement,
        cluster: &SharedCluster,
        vertices: &mut PlacedVertices,
    ) {
        apart!(simd, self.place_blocks(simd, onto, placement, cluster, vertices));
    }

    /// What [`SharedMesh::place`] does.
    #[inline(always)]
    fn place_blocks<S: Simd>(
        &self,
        simd: S,
        (map, raster): (&CameraMap, &FixedPointRaster),
        placement: &Placement,
        cluster: &SharedCluster,
        vertices: &mut PlacedVertices,
    ) {
        let blocks = &self.positions[cluster.blocks.start as usize..cluster.blocks.end as usize];
        for (block, vertices) in blocks.iter().zip(vertices.chunks_exact_mut(16)) {
            raster.place_sixteen(simd, map, &placement.sixteen_positions(simd, block), vertices);
        }
    }
}

impl SharedCluster {
    /// How many triangles it has.
    pub(crate) fn count(&self) -> u32 {
        self.triangles.end - self.triangles.start
    }

    /// The number in the mesh of the triangle at this place of the cluster, and its corners among the cluster's vertices.
    #[inline(always)]
    pub(crate) fn triangle(
        &self,
        mesh: &SharedMesh,
        place: u32,
        vertices: &PlacedVertices,
    ) -> (u32, [Vertex; 3]) {
        let index = self.triangles.start + place;
        let number = mesh.numbers.as_ref().map_or(index, |numbers| numbers[index as usize]);
        (number, mesh.corners[index as usize].map(|vertex| vertices[usize::from(vertex)]))
    }
}

/// For every object the mesh that its instances share, if it has some. Objects with the same mesh share it here, too.
pub(crate) fn shared_meshes(scene: &Scene) -> Vec<Option<Arc<SharedMesh>>> {
    let instances = || {
        scene.objects().iter().map(|object| match &object.shape {
            Shape::Instances(instances) => Some(instances.shared_mesh()),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) | Shape::Mesh(_) => None,
        })
    };
    let address = |mesh: &Arc<Mesh>| Arc::as_ptr(mesh).addr();
    let (mut places, mut distinct) = (HashMap::new(), Vec::new());
    for mesh in instances().flatten() {
        places.entry(address(mesh)).or_insert_with(|| {
            distinct.push(mesh);
            distinct.len() - 1
        });
    }
    let shared: Vec<Arc<SharedMesh>> =
        distinct.into_par_iter().map(|mesh| Arc::new(SharedMesh::new(mesh))).collect();
    instances().map(|mesh| Some(shared[places[&address(mesh?)]].clone())).collect()
}

/// A box in the world around an instance of what lies in a box of the mesh.
///
/// Of each coordinate of the mesh, the least and the greatest product with a number of the map are at the two sides of the box.
/// [`Placement::position`] is monotonic, its rounding included: sums of the least products and of the greatest, rounded as it
/// rounds them, are those of two corners of the box, and no vertex in it is put beyond them. Image order has [`Placement::bounds`]
/// for that; neither order relies on what hides primitives in the other.
#[inline(always)]
pub(crate) fn placed_box(placement: &Placement, [low, high]: &Bounds) -> Bounds {
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let [x, y, z] = placement.rows();
    let [x, y, z] = each!(row in [x, y, z] => {
        let [m0, m1, m2, m3] = each!(k in [0, 1, 2, 3] => f64::from(row[k]));
        let factors = DVec3::new(m0, m1, m2);
        let ends = [factors * low, factors * high];
        each!(parts in [ends[0].min(ends[1]), ends[0].max(ends[1])] => {
            #[expect(clippy::cast_possible_truncation, reason = "this is the one rounding")]
            let end = (parts.x + parts.y + parts.z + m3) as f32;
            end
        })
    });
    each!(end in [0, 1] => Vec3::new(x[end], y[end], z[end]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_placed_box_ends_where_its_outermost_corners_are_placed() {
        let random = &mut fastrand::Rng::with_seed(11);
        for _ in 0..2000 {
            let mut number = || {
                let scale = [0.0, 1e-6, 0.3, 1.0, 5e5][random.usize(0..5)];
                (random.f32() - 0.5) * scale
            };
            let rows = std::array::from_fn(|_| std::array::from_fn(|_| number()));
            let placement = Placement::from_rows(rows);
            let [a, b]: [Vec3; 2] =
                std::array::from_fn(|_| Vec3::new(number(), number(), number()));
            let (low, high) = (a.min(b), a.max(b));
            let corners: [Vec3; 8] = std::array::from_fn(|k| {
                let side = |axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
                placement.position(Vec3::new(side(0), side(1), side(2)))
            });
            let least = corners.into_iter().reduce(Vec3::min).expect("there are eight");
            let most = corners.into_iter().reduce(Vec3::max).expect("there are eight");
            assert_eq!(placed_box(&placement, &[low, high]), [least, most]);
        }
    }

    #[test]
    fn a_placed_box_is_summed_up_in_the_order_of_a_position() {
        // Of 10³⁸ − 10³⁸ + z + ¼, nothing is left of what is added before the second term.
        let row = [1e19, -1e19, 1.0, 0.25];
        let placement = Placement::from_rows([row; 3]);
        let bounds = [Vec3::new(1e19, 1e19, 1.0), Vec3::new(1e19, 1e19, 2.0)];
        assert_eq!(bounds.map(|corner| placement.position(corner).x), [1.25, 2.25]);
        assert_eq!(placed_box(&placement, &bounds), [Vec3::splat(1.25), Vec3::splat(2.25)]);
    }
}
