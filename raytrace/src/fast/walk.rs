//! The walk of a tile's rays through the hierarchy, near boxes first.

use super::build::Prepared;
use super::draw::{self, Extent};
use super::rays::{Lens, LensKind, Rays};
use super::round;
use super::sieve::{self, Sieve};
use super::tile::Tile;
use super::tree::{Child, Kind, Node, WIDTH};
use bothways_common::fault::{Fault, Planted};
use bothways_common::observe::Watcher;
use bothways_common::simd::{Simd, SimdBase, SimdMask, f32x8, mask32x8, prefetch};
use bothways_common::{Primitive, View};

/// A node or leaf to enter yet.
#[derive(Clone, Copy, Debug)]
struct Open {
    /// None of its primitives is nearer than this `t`, in the scale of the map.
    near: f32,
    child: Child,
    counts: u8,
}

/// Walks tiles of one view through the hierarchy.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    pub(super) prepared: &'a Prepared,
    pub(super) rays: &'a Rays<'a>,
    pub(super) tile: Tile,
    /// What is tested without a box: planes, and spheres that no box can be trusted to hold, because
    /// they are huge or the eye is so far away (those are in boxes, too).
    unbounded: Vec<(u32, Primitive)>,
    stack: Vec<Open>,
    sieve: Sieve,
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
        Walker {
            prepared,
            rays,
            tile: Tile::new(rays),
            unbounded,
            stack: Vec::new(),
            sieve: Sieve::new(),
        }
    }

    /// Finds the first hits of a square of samples, of which so many rows and columns are in the
    /// picture.
    #[inline(always)]
    pub(super) fn walk<S: Simd, O: Watcher + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        kind: &LensKind,
        start: [usize; 2],
        size: [usize; 2],
        observer: &mut O,
    ) {
        let ([row, column], side) = (start, kind.side);
        let lens = self.rays.lens(kind, column, row);
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
        let root = |&child: &Child| Open { near: f32::NEG_INFINITY, child, counts: 0 };
        self.stack.extend(self.prepared.roots.iter().map(root));
        // That of the last triangles that were drawn.
        let mut extent = Extent::Many;
        let mut farthest = self.farthest(&lens);
        loop {
            let Some(Open { near, child, counts }) = self.stack.pop() else {
                if O::WATCHES || self.sieve.is_empty() {
                    break;
                }
                self.sift::<S, F>(simd, &lens, farthest, extent, true);
                continue;
            };
            if near > farthest {
                continue;
            }
            match child.kind() {
                Kind::Node => {
                    let tiny = extent == Extent::Tiny;
                    self.enter::<S, O, F>(simd, &lens, child.index(), farthest, tiny, observer);
                    continue;
                }
                Kind::Triangles => {
                    let [all, different] = [counts >> 4, counts & 15];
                    let used = if F::is(Planted::TiesToLast) { all } else { different };
                    let leaf = (child.index(), (1 << used) - 1);
                    // Who watches is told of every triangle.
                    let hurry = extent == Extent::Many || self.tile.is_nearly_full();
                    if O::WATCHES || (hurry && self.sieve.is_empty()) {
                        extent = self.draw_leaf::<S, O, F>(simd, &lens, leaf, farthest, observer);
                    } else {
                        let is_full = self.sieve.add(leaf);
                        if !(is_full || hurry) {
                            continue;
                        }
                        extent = self.sift::<S, F>(simd, &lens, farthest, extent, hurry);
                    }
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
            farthest = self.farthest(&lens);
        }
        if O::WATCHES
            && let Some(sample) = self.tile.sample(0)
        {
            observer.hit(sample, self.tile.seen());
        }
    }

    /// The `t` of boxes and corners beyond which nothing can be seen.
    #[inline(always)]
    fn farthest(&self, lens: &Lens) -> f32 {
        lens.kind.rough.farthest(self.rays.farthest(self.tile.far, &lens.kind.errors))
    }

    /// Draws those triangles of a leaf that may be seen; tells their extent, and supposes that they are large
    /// where there is none.
    #[inline(always)]
    fn draw_leaf<S: Simd, O: Watcher + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        lens: &Lens,
        (leaf, used): (usize, u64),
        farthest: f32,
        observer: &mut O,
    ) -> Extent {
        let leaf = &self.prepared.leaves[leaf];
        let passed = if O::WATCHES {
            used
        } else {
            sieve::pass(simd, lens, [leaf, leaf], farthest, false).to_bitmask() & used
        };
        if passed == 0 {
            return Extent::Many;
        }
        draw::draw::<S, O, F>(simd, self.rays, lens, (leaf, passed), &mut self.tile, observer)
    }

    /// Looks at the leaves that have waited longest, or all, and draws triangles, eight at a time; all of them
    /// if they are large, or `hurry` asks for it. Takes and tells the extent of those that were drawn last.
    #[inline(always)]
    fn sift<S: Simd, F: Fault>(
        &mut self,
        simd: S,
        lens: &Lens,
        farthest: f32,
        extent: Extent,
        hurry: bool,
    ) -> Extent {
        let tiny = extent == Extent::Tiny;
        self.sieve.sift(simd, &self.prepared.leaves, lens, farthest, tiny, hurry);
        let mut largest = None;
        loop {
            let count = self.sieve.count();
            let all = hurry || largest == Some(Extent::Many);
            if count == 0 || (count < WIDTH && !all) {
                break;
            }
            let eight = self.sieve.take_eight(simd);
            let of = (&eight, (1 << count.min(WIDTH)) - 1);
            let tile = &mut self.tile;
            let extent = draw::draw::<S, (), F>(simd, self.rays, lens, of, tile, &mut ());
            largest = largest.max(Some(extent));
        }
        largest.unwrap_or(extent.min(Extent::Few))
    }

    /// Tests the boxes of a node and opens those that a ray of the tile may meet, near ones last, so
    /// first; of leaves with `tiny` triangles any.
    ///
    /// A box is taken relative to the eye as vertices are, by one rounded subtraction. Rounding keeps
    /// order: in `f64`, what is computed from a box's corner is not less than what would be computed from any
    /// point of the box that is nowhere farther along the plane's normal, so only the error of points on rays
    /// counts, which [`Rays::lens_kind`] allows for, and that of `f32`, for which [`super::rough`] does.
    #[inline(always)]
    fn enter<S: Simd, O: Watcher + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        lens: &Lens,
        index: usize,
        farthest: f32,
        tiny: bool,
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
        let (near, met) = meet::<S, F>(simd, lens, node, farthest);
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
        // Where leaves wait for others anyway, sorting them costs more than it saves.
        let sorted = !(tiny && node.bottom);
        let base = if sorted { self.stack.len() } else { usize::MAX };
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
fn meet<S: Simd, F: Fault>(
    simd: S,
    Lens { kind, rough, .. }: &Lens,
    node: &Node,
    farthest: f32,
) -> (f32x8<S>, mask32x8<S>) {
    let kind = &kind.rough;
    let [ex, ey, ez] = kind.eye;
    let [lx, ly, lz, hx, hy, hz] = &node.bounds;
    let boxes = [
        [f32x8::load_array_ref(simd, lx) - ex, f32x8::load_array_ref(simd, hx) - ex],
        [f32x8::load_array_ref(simd, ly) - ey, f32x8::load_array_ref(simd, hy) - ey],
        [f32x8::load_array_ref(simd, lz) - ez, f32x8::load_array_ref(simd, hz) - ez],
    ];
    let [left, right, upper, lower] = &rough.sides;
    let across = left.reach(&boxes, true).min(right.reach(&boxes, true));
    let down = upper.reach(&boxes, true).min(lower.reach(&boxes, true));
    let (near, far) = (kind.t.reach(&boxes, false), kind.t.reach(&boxes, true));
    let room = if F::is(Planted::ShrunkBox) { 0.0 } else { kind.sides_error };
    let least_t = -kind.t_error;
    // NaN, from numbers that overflow, lets pass.
    let missed = across.min(down).simd_lt(f32x8::splat(simd, -room))
        | far.simd_lt(f32x8::splat(simd, least_t))
        | near.simd_gt(f32x8::splat(simd, farthest));
    (near, !missed)
}

/// A fault: boxes too small by the last place.
fn shrink(node: &Node) -> Node {
    let mut node = *node;
    node.bounds[..3].as_flattened_mut().iter_mut().for_each(|low| *low = low.next_up());
    node.bounds[3..].as_flattened_mut().iter_mut().for_each(|high| *high = high.next_down());
    node
}
