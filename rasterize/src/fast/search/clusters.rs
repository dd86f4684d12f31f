//! Clusters of neighbouring triangles of a mesh. Most lie in one tile, which takes them as a whole and looks at each
//! triangle once, when it draws it.

use super::extent::Extent;
use super::tiling::Tiling;
use crate::fast::camera_map::CameraMap;
use crate::fast::setup::BOX_MARGIN;
use crate::fast::vertices::{FixedPointRaster, ON_RASTER, OUT_OF_SIGHT};
use bothways_common::engine::simd::{Simd, apart};
use bothways_common::{Mesh, Shape};
use glam::{Vec3, Vec3A};
use rayon::prelude::*;

/// How many triangles a cluster has at most, all of one mesh and in one batch.
pub(crate) const CLUSTER: u32 = 32;
/// A cluster that may lie in more tiles than this is taken apart: every tile would look at all of it.
const MOST_TILES: usize = 2;

/// Fixed-point units by which a cluster's box is wider than its corners; [`extent`] says why three more than a
/// triangle's box would do.
const MARGIN: i32 = BOX_MARGIN + 4;

/// A box around a cluster, its least and its greatest corner.
pub(crate) type Bounds = [Vec3; 2];

/// Some consecutive triangles of an object's [`Triangles`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cluster {
    /// The object, the index of the first triangle and how many there are.
    pub(crate) object: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
    /// Where they may be seen.
    pub(crate) extent: Extent,
}

/// Where a cluster may be seen.
#[derive(Debug)]
pub(crate) enum ClusterExtent {
    /// Nowhere.
    Nowhere,
    /// In few tiles.
    FewTiles(Cluster),
    /// In many tiles, or it is not known where.
    ManyTiles,
}

/// The triangles of one object in clusters; none if the object is not a mesh.
#[derive(Clone, Debug, Default)]
pub(crate) struct Clusters {
    bounds: Vec<Bounds>,
    /// The triangles in another order, if consecutive triangles of the mesh are not neighbours.
    sorted: Option<Sorted>,
}

#[derive(Clone, Debug)]
struct Sorted {
    /// The numbers of the triangles in the mesh.
    numbers: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// The mesh's vertices in the order in which these triangles first have them.
    positions: Vec<Vec3>,
}

/// Triangles in the order of their clusters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangles<'a> {
    pub(crate) corners: &'a [[u32; 3]],
    numbers: Option<&'a [u32]>,
}

impl<'a> Triangles<'a> {
    pub(crate) const NONE: Triangles<'static> = Triangles { corners: &[], numbers: None };

    /// All corners, and all numbers if they are not those of their places.
    pub(crate) fn parts(self) -> (&'a [[u32; 3]], Option<&'a [u32]>) {
        (self.corners, self.numbers)
    }

    /// The index of each triangle of the mesh, by its number; empty if indices are numbers.
    pub(crate) fn places(self) -> Vec<u32> {
        let numbers = self.numbers.unwrap_or(&[]);
        let mut places = vec![0; numbers.len()];
        for (index, number) in (0..).zip(numbers) {
            places[*number as usize] = index;
        }
        places
    }

    /// The number in the mesh of the triangle at this index.
    #[inline(always)]
    pub(crate) fn number(&self, index: u32) -> u32 {
        match self.numbers {
            None => index,
            Some(numbers) => numbers[index as usize],
        }
    }
}

impl Clusters {
    /// Clusters of neighbours.
    pub(crate) fn new(shape: &Shape) -> Clusters {
        match shape {
            Shape::Mesh(mesh) => Clusters::of_mesh(mesh),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) | Shape::Instances(_) => {
                Clusters::default()
            }
        }
    }

    /// Clusters of neighbours.
    pub(crate) fn of_mesh(mesh: &Mesh) -> Clusters {
        let (positions, triangles) = (mesh.positions(), mesh.triangles());
        let (bounds, is_coherent) = bounds(positions, triangles);
        if is_coherent {
            return Clusters { bounds, sorted: None };
        }
        let sorted = Sorted::new(positions, triangles);
        let (bounds, _) = self::bounds(&sorted.positions, &sorted.triangles);
        Clusters { bounds, sorted: Some(sorted) }
    }

    /// Boxes around the clusters, in their order.
    pub(crate) fn bounds(&self) -> &[Bounds] {
        &self.bounds
    }

    /// The object's triangles in the order of their clusters.
    pub(crate) fn triangles<'a>(&'a self, shape: &'a Shape) -> Triangles<'a> {
        match shape {
            Shape::Mesh(mesh) => self.triangles_of(mesh),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) | Shape::Instances(_) => {
                Triangles::NONE
            }
        }
    }

    /// The mesh's triangles in the order of their clusters.
    pub(crate) fn triangles_of<'a>(&'a self, mesh: &'a Mesh) -> Triangles<'a> {
        match &self.sorted {
            Some(Sorted { numbers, triangles, .. }) => {
                Triangles { corners: triangles, numbers: Some(numbers) }
            }
            None => Triangles { corners: mesh.triangles(), numbers: None },
        }
    }

    /// The vertices of a mesh in the order in which the vertex stage takes them.
    pub(crate) fn positions<'a>(&'a self, mesh: &'a Mesh) -> &'a [Vec3] {
        self.sorted.as_ref().map_or(mesh.positions(), |sorted| &sorted.positions)
    }
}

/// Boxes around clusters of consecutive triangles, and whether they are small: much smaller than boxes around
/// triangles from anywhere in the mesh.
fn bounds(positions: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<Bounds>, bool) {
    /// The sides of a cluster's box, as a multiple of those of its triangles' boxes: a row of 16 pairs has 9, a square
    /// of them 4.
    const MOST_SIDES: f64 = 16.0;
    let around = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| Vec3A::from(positions[vertex as usize]));
        [a.min(b).min(c), a.max(b).max(c)]
    };
    let sides = |[low, high]: [Vec3A; 2]| f64::from((high - low).element_sum());
    let around_cluster = |cluster: &[[u32; 3]]| {
        let (mut bounds, mut sum) = ([Vec3A::INFINITY, Vec3A::NEG_INFINITY], 0.0);
        for triangle in cluster.iter().map(around) {
            bounds = [bounds[0].min(triangle[0]), bounds[1].max(triangle[1])];
            sum += sides(triangle);
        }
        (bounds.map(Vec3::from), [sides(bounds), sum / cluster.len() as f64])
    };
    let all: Vec<(Bounds, [f64; 2])> =
        triangles.par_chunks(CLUSTER as usize).with_min_len(64).map(around_cluster).collect();
    let [clusters, single] =
        all.iter().fold([0.0; 2], |sum, (_, sides)| [sum[0] + sides[0], sum[1] + sides[1]]);
    (all.into_iter().map(|(bounds, _)| bounds).collect(), clusters <= MOST_SIDES * single)
}

impl Sorted {
    /// Sorts triangles into clusters by halving, again and again, along the longest side.
    fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Sorted {
        let center = |triangle: &[u32; 3]| {
            triangle.iter().map(|vertex| Vec3A::from(positions[*vertex as usize]) / 3.0).sum()
        };
        let count = u32::try_from(triangles.len()).expect("ids are u32");
        let mut all: Vec<(Vec3A, u32)> = triangles.par_iter().map(center).zip(0..count).collect();
        sort(&mut all);
        let numbers: Vec<u32> = all.into_iter().map(|(_, number)| number).collect();
        // Vertices come in this order, too: neighbours share lines of the cache.
        let mut renumbered = vec![u32::MAX; positions.len()];
        let mut order = Vec::with_capacity(positions.len());
        let mut renumber = |vertex: u32| {
            let number = &mut renumbered[vertex as usize];
            if *number == u32::MAX {
                *number = u32::try_from(order.len()).expect("vertices are u32");
                order.push(vertex);
            }
            *number
        };
        let sorted = numbers.iter().map(|number| triangles[*number as usize].map(&mut renumber));
        let triangles = sorted.collect();
        // Then the vertices of no triangle.
        (0..u32::try_from(positions.len()).expect("vertices are u32"))
            .for_each(|v| _ = renumber(v));
        let positions = order.iter().map(|vertex| positions[*vertex as usize]).collect();
        Sorted { numbers, triangles, positions }
    }
}

/// Sorts points so that those of every cluster are close together.
fn sort(points: &mut [(Vec3A, u32)]) {
    /// Fewer points than this are not worth a thread.
    const FEW: usize = 4096;
    let clusters = points.len().div_ceil(CLUSTER as usize);
    if clusters < 2 {
        return;
    }
    let include =
        |[low, high]: [Vec3A; 2], point: &(Vec3A, u32)| [low.min(point.0), high.max(point.0)];
    let [low, high] = points.iter().fold([Vec3A::INFINITY, Vec3A::NEG_INFINITY], include);
    let axis = (high - low).max_position();
    let middle = clusters / 2 * CLUSTER as usize;
    points
        .select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (left, right) = points.split_at_mut(middle);
    if left.len() < FEW {
        sort(left);
        sort(right);
    } else {
        rayon::join(|| sort(left), || sort(right));
    }
}

/// Where the content of a box may be seen.
pub(crate) enum Sight {
    /// Nowhere.
    Nowhere,
    /// It is not known where.
    Anywhere,
    Within(Extent),
}

/// Finds where a cluster may be seen, from the corners of its box.
#[inline(always)]
pub(crate) fn extent<S: Simd>(
    simd: S,
    (map, raster, tiling): (&CameraMap, &FixedPointRaster, &Tiling),
    bounds: &Bounds,
    [object, first, count]: [u32; 3],
) -> ClusterExtent {
    match sight(simd, (map, raster), bounds) {
        Sight::Nowhere => ClusterExtent::Nowhere,
        Sight::Within(extent) if tiling.tiles(extent.bounds).count() <= MOST_TILES => {
            ClusterExtent::FewTiles(Cluster { object, first, count, extent })
        }
        Sight::Within(_) | Sight::Anywhere => ClusterExtent::ManyTiles,
    }
}

/// Finds where the triangles in a box may be seen, from the corners of the box.
///
/// All points of a box in front of the eye are seen between the places of its corners. A corner's place is
/// off by at most a unit and a half, and so is a vertex's: with three units more than a triangle's own box
/// has, no triangle's box reaches over the cluster's.
///
/// It is compiled once for all loops that call it.
#[inline(never)]
pub(crate) fn sight<S: Simd>(
    simd: S,
    (map, raster): (&CameraMap, &FixedPointRaster),
    bounds: &Bounds,
) -> Sight {
    let corners = apart!(simd, raster.place_corners(simd, map, *bounds));
    if corners.flags & OUT_OF_SIGHT != 0 {
        return Sight::Nowhere;
    }
    if corners.flags & ON_RASTER == 0 {
        return Sight::Anywhere;
    }
    let bits = raster.fraction_bits;
    let samples = |[low, high]: [i32; 2], size: i32| {
        let first = ((low + (1 << bits) - 1 - MARGIN) >> bits).max(0);
        let last = ((high + MARGIN) >> bits).min(size - 1);
        let sample = |place: i32| u16::try_from(place).expect("a side has at most 65,536 samples");
        (first <= last).then(|| [sample(first), sample(last)])
    };
    let [height, width] = raster.size;
    let (Some(rows), Some(columns)) =
        (samples(corners.rows, height), samples(corners.columns, width))
    else {
        return Sight::Nowhere;
    };
    Sight::Within(Extent { bounds: [rows, columns], nearest: corners.nearest })
}
