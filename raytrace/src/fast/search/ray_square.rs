//! Sixteen rays that are each walked alone, for an observer that only counts, and go through the hierarchy together.
//!
//! Each ray meets what it meets alone, in the same order, for its counts are those of a ray alone. That takes a box's nearest
//! `t` not to depend on the ray, so that all rays sort boxes alike. Boxes are tested for sixteen rays at once, where a ray
//! alone tests sixteen boxes, most of which it misses; what is in a leaf is tested and drawn ray by ray.

use super::box_culling::BoxCulling;
use super::tile_frustum::{FrustumTemplate, TileFrustum};
use super::tree::{NodeKind, WIDTH};
use super::walk::{StackEntry, Walker};
use crate::fast::prepared::Prepared;
use crate::fast::size_class::SizeClass;
use crate::fast::tile::RayHit;
use crate::fast::world_affine::WorldAffine;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x16};
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};

/// Samples along one side of a square of rays.
pub(crate) const SQUARE: usize = 4;
const RAYS: usize = SQUARE * SQUARE;

/// A square of rays, each walked alone.
#[derive(Debug)]
pub(crate) struct RaySquare<'a> {
    of_square: &'a FrustumTemplate,
    of_ray: &'a FrustumTemplate,
    rays: Vec<Ray<'a>>,
    /// The four sides of each ray as a tile of one.
    sides: [SideOfRays; 4],
    /// What each ray can see no farther than, in the scale of boxes.
    farthest: [f32; RAYS],
    /// The rays that last drew triangles over very few samples, one bit each.
    very_few: u64,
    stack: Vec<SquareEntry>,
}

/// One ray of a square.
#[derive(Debug)]
struct Ray<'a> {
    sample: Sample,
    frustum: TileFrustum<'a>,
    hit: RayHit,
    /// The size class of the triangles that were drawn last.
    class: SizeClass,
}

/// A node or leaf that some rays of a square are to enter, one bit for each.
#[derive(Debug)]
struct SquareEntry {
    entry: StackEntry,
    rays: u64,
}

/// One side of a tile of one for each ray: an affine function of the world. In each coordinate of its normal all rays have the
/// same sign, so the corner of a box at which it is largest is the same for all.
#[derive(Debug, Default)]
struct SideOfRays {
    normal: [[f32; RAYS]; 3],
    offset: [f32; RAYS],
    /// For each axis the side of a box that counts: the low one, or the high one.
    corner: [usize; 3],
}

/// Which rays of a square meet which boxes of a node.
struct SquareHits {
    /// One bit for each box that some ray may meet.
    some: u64,
    /// For each of these, one bit for each ray.
    rays: [u64; WIDTH],
    near: [f32; WIDTH],
    size: [f32; WIDTH],
}

impl<'a> RaySquare<'a> {
    /// No rays yet; the templates of squares, and of tiles of one ray.
    pub(crate) fn new([of_square, of_ray]: [&'a FrustumTemplate; 2]) -> RaySquare<'a> {
        RaySquare {
            of_square,
            of_ray,
            rays: Vec::with_capacity(RAYS),
            sides: Default::default(),
            farthest: [0.0; RAYS],
            very_few: 0,
            stack: Vec::new(),
        }
    }

    /// Takes the rays of some samples, at most four rows and columns. Returns whether they can be walked together: whether the
    /// normals of their sides have the same signs.
    fn take(&mut self, region: &Region) -> bool {
        self.rays.clear();
        for row in region.rows.clone() {
            self.rays.extend(region.columns.clone().map(|column| Ray {
                sample: Sample { row, column },
                frustum: self.of_ray.frustum([row, column]),
                hit: RayHit::NOTHING,
                class: SizeClass::Many,
            }));
        }
        self.very_few = 0;
        let rays = &self.rays;
        self.sides
            .iter_mut()
            .enumerate()
            .all(|(side, of_rays)| of_rays.take(rays.iter().map(|ray| &ray.frustum.sides[side])))
    }

    /// The rays that something with this `t` may still be the nearest for, one bit each.
    #[inline(always)]
    fn reaching<S: Simd>(&self, simd: S, near: f32) -> u64 {
        let farthest = f32x16::load_array_ref(simd, &self.farthest);
        (!f32x16::splat(simd, near).simd_gt(farthest)).to_bitmask()
    }

    /// Finds the boxes of a node that the rays may meet, each as [`BoxCulling::test`] finds them for the ray alone: by the same
    /// operations. Boxes that certainly all rays miss are not tested for each.
    #[inline(always)]
    fn test<C: Context>(
        &self,
        context: &C,
        square: &TileFrustum,
        prepared: &Prepared,
        index: usize,
    ) -> SquareHits {
        let (simd, node) = (context.simd(), &prepared.nodes[index]);
        let of_ray: &BoxCulling = &self.of_ray.boxes;
        let sides = (&square.sides, self.of_square.parallel);
        let some = self.of_square.boxes.not_missed_by_all(context, sides, of_ray, node);
        let (boxes, near, size) = of_ray.boxes_alone(simd, node);
        let error = f32x16::splat(simd, -of_ray.sides_error);
        let mut rays = [0; WIDTH];
        let mut untested = some;
        while untested != 0 {
            let lane = (untested.trailing_zeros() & 15) as usize;
            untested &= untested - 1;
            let [left, right, upper, lower] = &self.sides;
            let across = left.largest(simd, &boxes, lane).min(right.largest(simd, &boxes, lane));
            let down = upper.largest(simd, &boxes, lane).min(lower.largest(simd, &boxes, lane));
            rays[lane] = (!across.min(down).simd_lt(error)).to_bitmask();
        }
        SquareHits { some, rays, near, size }
    }
}

impl SideOfRays {
    /// Takes the sides of the rays. Returns whether the signs of their normals are the same.
    fn take<'b>(&mut self, sides: impl Iterator<Item = &'b WorldAffine> + Clone) -> bool {
        for (lane, side) in sides.cycle().take(RAYS).enumerate() {
            for (axis, coordinate) in side.normal.into_iter().enumerate() {
                self.normal[axis][lane] = coordinate;
            }
            self.offset[lane] = side.offset;
        }
        let is_positive = |coordinate: &f32| coordinate.is_sign_positive();
        self.corner = [0, 1, 2].map(|axis: usize| usize::from(is_positive(&self.normal[axis][0])));
        self.normal.iter().zip(self.corner).all(|(coordinates, corner)| {
            coordinates.iter().all(|coordinate| is_positive(coordinate) == (corner == 1))
        })
    }

    /// Its largest value in one of the boxes for each ray, as [`WorldAffine::extreme`] computes it.
    #[inline(always)]
    fn largest<S: Simd>(
        &self,
        simd: S,
        [x, y, z]: &[[[f32; WIDTH]; 2]; 3],
        lane: usize,
    ) -> f32x16<S> {
        let [nx, ny, nz] = &self.normal;
        let [of_x, of_y, of_z] = self.corner;
        f32x16::load_array_ref(simd, nx) * x[of_x & 1][lane]
            + f32x16::load_array_ref(simd, ny) * y[of_y & 1][lane]
            + f32x16::load_array_ref(simd, nz) * z[of_z & 1][lane]
            + f32x16::load_array_ref(simd, &self.offset)
    }
}

impl Walker<'_> {
    /// Walks the rays of some samples, at most four rows and columns, each alone, and counts what they meet. Returns whether it
    /// did: not all can be walked together.
    #[inline(always)]
    pub(crate) fn walk_square<C: Context>(
        &mut self,
        context: &mut C,
        square: &mut RaySquare,
        region: &Region,
    ) -> bool {
        // In which order a ray comes to the boxes of an instance's mesh is not the same for all.
        if !square.take(region) || !self.prepared.instance_order.is_empty() {
            return false;
        }
        for (lane, ray) in square.rays.iter_mut().enumerate() {
            let Sample { row, column } = ray.sample;
            self.begin(context, &ray.frustum, [row, column], [1, 1]);
            ray.hit = self.tile.hit_alone();
            square.farthest[lane] = self.farthest(&ray.frustum);
        }
        let frustum = square.of_square.frustum([region.rows.start, region.columns.start]);
        let all = (1 << square.rays.len()) - 1;
        square.stack.extend(self.stack.drain(..).map(|entry| SquareEntry { entry, rays: all }));
        while let Some(SquareEntry { entry, rays }) = square.stack.pop() {
            let rays = rays & square.reaching(context.simd(), entry.near);
            if rays == 0 {
                continue;
            }
            if matches!(entry.child.kind(), NodeKind::Node) {
                self.enter_together(context, square, &frustum, (entry.child.index(), rays));
            } else {
                self.draw_alone(context, square, &entry, rays);
            }
        }
        for ray in &square.rays {
            self.tile.resume([ray.sample.row, ray.sample.column], ray.hit);
            context.sink().hit(ray.sample, self.seen());
        }
        true
    }

    /// Tests the boxes of a node, and pushes those that some of these rays may meet, as a ray alone pushes them.
    #[inline(always)]
    fn enter_together<C: Context>(
        &mut self,
        context: &mut C,
        square: &mut RaySquare,
        frustum: &TileFrustum,
        (index, rays): (usize, u64),
    ) {
        let node = &self.prepared.nodes[index];
        if let Some(counts) = context.sink().counts() {
            counts.nodes += u64::from(node.used) * u64::from(rays.count_ones());
        }
        let hits = square.test(context, frustum, self.prepared, index);
        let unsorted = if node.only_triangles { rays & square.very_few } else { 0 };
        for (rays, sorted) in [(unsorted, false), (rays & !unsorted, true)] {
            if rays == 0 {
                continue;
            }
            let base = square.stack.len();
            let mut some = hits.some;
            while some != 0 {
                let lane = (some.trailing_zeros() & 15) as usize;
                some &= some - 1;
                let near = hits.near[lane];
                let rays = rays & hits.rays[lane] & square.reaching(context.simd(), near);
                if rays == 0 {
                    continue;
                }
                self.prefetch(node.children[lane]);
                let entry = StackEntry::new(node, lane, near, hits.size[lane]);
                let mut place = square.stack.len();
                while sorted && place > base && square.stack[place - 1].entry.near < near {
                    place -= 1;
                }
                square.stack.insert(place, SquareEntry { entry, rays });
            }
        }
    }

    /// Tests and draws what is in a leaf for each of these rays alone.
    #[inline(always)]
    fn draw_alone<C: Context>(
        &mut self,
        context: &mut C,
        square: &mut RaySquare,
        entry: &StackEntry,
        mut rays: u64,
    ) {
        while rays != 0 {
            let lane = (rays.trailing_zeros() & 15) as usize;
            rays &= rays - 1;
            let Ray { sample, frustum, hit, class } = &mut square.rays[lane];
            self.tile.resume([sample.row, sample.column], *hit);
            if matches!(entry.child.kind(), NodeKind::Spheres) {
                self.draw_spheres(context, frustum, entry);
            } else {
                self.add_leaf(context, frustum, entry, *class);
                *class = self.draw_candidates(context, frustum, *class, true);
                let very_few = u64::from(*class == SizeClass::VeryFew) << lane;
                square.very_few = square.very_few & !(1 << lane) | very_few;
            }
            *hit = self.tile.hit_alone();
            square.farthest[lane] = self.farthest(frustum);
        }
    }
}
