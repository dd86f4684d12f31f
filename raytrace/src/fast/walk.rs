//! The walk of a tile's rays through the hierarchy, near boxes first.

use super::build::Prepared;
use super::draw;
use super::rays::{Lens, Rays, Side};
use super::round;
use super::tile::Tile;
use super::tree::{Child, Kind, Node, WIDTH};
use bothways_common::fault::{Fault, Planted};
use bothways_common::observe::Observer;
use bothways_common::simd::{
    Simd, SimdBase, SimdMask, SimdWiden, f32x16, f64x8, mask64x8, prefetch,
};
use bothways_common::{Primitive, View};

/// A node or leaf to enter yet.
#[derive(Clone, Copy, Debug)]
struct Open {
    /// None of its primitives is nearer than this `t`, in the scale of the map.
    near: f64,
    child: Child,
    counts: u8,
}

/// Walks tiles of one view through the hierarchy.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    prepared: &'a Prepared,
    rays: &'a Rays<'a>,
    pub(super) tile: Tile,
    /// What is tested without a box: planes, and spheres that no box can be trusted to hold, because
    /// they are huge or the eye is so far away (those are in boxes, too).
    unbounded: Vec<(u32, Primitive)>,
    stack: Vec<Open>,
}

/// How far what boxes hold reaches from the eye, along any axis.
pub(super) fn reach(prepared: &Prepared, view: &View) -> f64 {
    let eye = view.camera.eye().as_dvec3();
    let [low, high] = [prepared.bounds.low, prepared.bounds.high].map(|v| v.as_dvec3() - eye);
    let reach = low.abs().max(high.abs()).max_element();
    if reach.is_finite() && reach > 0.0 { reach } else { 1.0 }
}

impl<'a> Walker<'a> {
    pub(super) fn new(prepared: &'a Prepared, rays: &'a Rays<'a>) -> Self {
        let eye = rays.camera().eye().as_dvec3();
        let room = |extent: f32| f64::from(extent) * 30f64.exp2();
        let spheres = prepared.spheres.iter();
        let loose = spheres.filter(|(_, extent)| eye.abs().max_element() > room(*extent));
        let ids = prepared.unbounded.iter().chain(loose.map(|(id, _)| id));
        let unbounded = ids.map(|&id| (id, rays.view.primitive(id))).collect();
        Walker { prepared, rays, tile: Tile::new(rays), unbounded, stack: Vec::new() }
    }

    /// Finds the first hits of a square of samples, of which so many rows and columns are in the
    /// picture.
    #[inline(always)]
    pub(super) fn walk<S: Simd, O: Observer, F: Fault>(
        &mut self,
        simd: S,
        start: [usize; 2],
        size: [usize; 2],
        side: usize,
        observer: &mut O,
    ) {
        let [row, column] = start;
        let lens = self.rays.lens(column, row, side);
        self.tile.begin(start, size, side);
        if O::WATCHES
            && let Some(sample) = self.tile.sample(0)
        {
            observer.ray_begun(sample);
        }
        for (id, primitive) in &self.unbounded {
            round::draw::<O, F>(self.rays, &lens, *id, primitive, &mut self.tile, observer);
        }
        if !self.unbounded.is_empty() {
            self.tile.renew(simd);
        }
        self.stack.clear();
        let root = |&child: &Child| Open { near: f64::NEG_INFINITY, child, counts: 0 };
        self.stack.extend(self.prepared.roots.iter().map(root));
        let mut farthest = self.rays.farthest(self.tile.far, &lens.errors);
        while let Some(Open { near, child, counts }) = self.stack.pop() {
            if near > farthest {
                continue;
            }
            match child.kind() {
                Kind::Node => {
                    self.enter::<S, O, F>(simd, &lens, child.index(), farthest, observer);
                    continue;
                }
                Kind::Triangles => {
                    let leaf = &self.prepared.leaves[child.index()];
                    let [all, different] = [counts >> 4, counts & 15].map(usize::from);
                    let used = if F::is(Planted::TiesToLast) { all } else { different };
                    let of = (leaf, used);
                    draw::draw::<S, O, F>(simd, self.rays, &lens, of, &mut self.tile, observer);
                }
                Kind::Spheres => {
                    let count = usize::from(counts >> 4);
                    for &id in &self.prepared.round[child.index()][..count] {
                        let ball = self.rays.view.primitive(id);
                        round::draw::<O, F>(self.rays, &lens, id, &ball, &mut self.tile, observer);
                    }
                    self.tile.renew(simd);
                }
            }
            farthest = self.rays.farthest(self.tile.far, &lens.errors);
        }
        if O::WATCHES
            && let Some(sample) = self.tile.sample(0)
        {
            observer.hit(sample, self.tile.seen());
        }
    }

    /// Tests the boxes of a node and opens those that a ray of the tile may meet, near ones last, so
    /// first.
    ///
    /// A box is taken relative to the eye as vertices are, by one rounded subtraction. Rounding keeps
    /// order: what is computed from a box's corner is not less than what would be computed from any point
    /// of the box that is nowhere farther along the plane's normal, so only the error of points on rays
    /// counts, which [`Rays::lens`] allows for.
    #[inline(always)]
    fn enter<S: Simd, O: Observer, F: Fault>(
        &mut self,
        simd: S,
        lens: &Lens,
        index: usize,
        farthest: f64,
        observer: &mut O,
    ) {
        if F::is(Planted::ForgottenNode) && index == self.prepared.nodes.len() / 2 {
            return;
        }
        let shrunk;
        let mut node = &self.prepared.nodes[index];
        if F::is(Planted::ShrunkBox) {
            shrunk = shrink(node);
            node = &shrunk;
        }
        let (near, met) = meet(simd, lens, node, farthest);
        let used = (1_u64 << node.used) - 1;
        let mut met = met.to_bitmask() & used;
        if O::WATCHES
            && let Some(sample) = self.tile.sample(0)
        {
            for lane in 0..usize::from(node.used) {
                let number = u32::try_from(index * WIDTH + lane).unwrap_or(u32::MAX);
                observer.node_opened(sample, number, met >> lane & 1 == 1);
            }
        }
        let near = near.to_array();
        let base = self.stack.len();
        while met != 0 {
            let lane = (met.trailing_zeros() & 7) as usize;
            met &= met - 1;
            let child = node.children[lane];
            match child.kind() {
                Kind::Node => prefetch(&self.prepared.nodes[child.index()]),
                Kind::Triangles => prefetch(&self.prepared.leaves[child.index()]),
                Kind::Spheres => {}
            }
            let open = Open { near: near[lane], child, counts: node.counts[lane] };
            self.stack.push(open);
            let mut place = self.stack.len() - 1;
            while place > base && self.stack[place - 1].near < open.near {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = open;
        }
    }
}

/// The nearest `t` of each box, and which boxes a ray of the tile may meet before `farthest`.
#[inline(always)]
fn meet<S: Simd>(simd: S, lens: &Lens, node: &Node, farthest: f64) -> (f64x8<S>, mask64x8<S>) {
    let corners = corners(simd, lens, node);
    let [left, right, upper, lower] = &lens.sides;
    let across = along(simd, &corners, left, true).min(along(simd, &corners, right, true));
    let down = along(simd, &corners, upper, true).min(along(simd, &corners, lower, true));
    let t = Side { normal: lens.rows[0], offset: lens.shift[0] };
    let near = along(simd, &corners, &t, false);
    let far = along(simd, &corners, &t, true);
    let met = across.min(down).simd_ge(f64x8::splat(simd, 0.0))
        & far.simd_ge(f64x8::splat(simd, lens.least_t))
        & near.simd_le(f64x8::splat(simd, farthest));
    (near, met)
}

/// Low and high sides of the boxes relative to the eye, along each axis.
#[inline(always)]
fn corners<S: Simd>(simd: S, lens: &Lens, node: &Node) -> [[f64x8<S>; 2]; 3] {
    let rows = node.bounds.as_flattened();
    let (lx, ly) = f32x16::from_slice(simd, &rows[..16]).widen();
    let (lz, hx) = f32x16::from_slice(simd, &rows[16..32]).widen();
    let (hy, hz) = f32x16::from_slice(simd, &rows[32..48]).widen();
    let [x, y, z] = lens.eye;
    [[lx - x, hx - x], [ly - y, hy - y], [lz - z, hz - z]]
}

/// How far along a plane's normal boxes reach: their farthest corners, or the least far.
#[inline(always)]
fn along<S: Simd>(
    simd: S,
    corners: &[[f64x8<S>; 2]; 3],
    Side { normal: [nx, ny, nz], offset }: &Side,
    far: bool,
) -> f64x8<S> {
    let [x, y, z] = corners;
    let x = x[usize::from((*nx >= 0.0) == far)];
    let y = y[usize::from((*ny >= 0.0) == far)];
    let z = z[usize::from((*nz >= 0.0) == far)];
    f64x8::splat(simd, *offset) + x * *nx + y * *ny + z * *nz
}

/// A fault: boxes too small by the last place.
fn shrink(node: &Node) -> Node {
    let mut node = *node;
    node.bounds[..3].as_flattened_mut().iter_mut().for_each(|low| *low = low.next_up());
    node.bounds[3..].as_flattened_mut().iter_mut().for_each(|high| *high = high.next_down());
    node
}
