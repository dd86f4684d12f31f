//! The walk of a tile's rays through the hierarchy, near boxes first.

use super::build::Prepared;
use super::draw::{self, Extent};
use super::rays::{Lens, LensKind, Rays, Reach};
use super::round;
use super::sieve::{EIGHT, Look, Sieve, Waiting};
use super::tile::Tile;
use super::tree::{Child, Counts, Kind, Node, WIDTH};
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{Simd, SimdBase, SimdMask, f32x16, mask32x16, prefetch};
use bothways_common::observe::EventSink;
use bothways_common::{Primitive, View};
use glam::Vec3;

/// A node or leaf to enter yet.
#[derive(Clone, Copy, Debug)]
struct Open {
    /// None of its primitives is nearer than this `t`, in the scale of the map.
    near: f32,
    /// The longest side of its box.
    size: f32,
    child: Child,
    counts: Counts,
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

/// How far what boxes hold reaches, along any axis.
pub(super) fn reach(prepared: &Prepared, view: &View) -> Reach {
    /// So many times as near as the eye must another origin be.
    const WORTH: f64 = 8.0;
    let from = |point: Vec3| {
        let ends = [prepared.bounds.low, prepared.bounds.high];
        let [low, high] = ends.map(|end| end.as_dvec3() - point.as_dvec3());
        let reach = low.abs().max(high.abs()).max_element();
        if reach.is_finite() && reach > 0.0 { reach } else { 1.0 }
    };
    let eye = view.camera.eye();
    let middle = 0.5 * prepared.bounds.low + 0.5 * prepared.bounds.high;
    let (from_eye, from_middle) = (from(eye), from(middle));
    // Rounded up: the differences were rounded.
    let from_middle = from_middle * (1.0 + f64::EPSILON);
    if middle.is_finite() && WORTH * from_middle < from_eye {
        Reach { from_eye, origin: middle, from_origin: from_middle }
    } else {
        Reach { from_eye, origin: eye, from_origin: from_eye }
    }
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
    pub(super) fn walk<S: Simd, O: EventSink + ?Sized, F: Fault>(
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
        if O::ENABLED
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
        let root = |&child: &Child| Open {
            near: f32::NEG_INFINITY,
            size: f32::INFINITY,
            child,
            counts: Counts::default(),
        };
        self.stack.extend(self.prepared.roots.iter().map(root));
        // That of the last triangles that were drawn.
        let mut extent = Extent::Many;
        let mut farthest = self.farthest(&lens);
        loop {
            let Some(Open { near, size, child, counts }) = self.stack.pop() else {
                if self.sieve.is_empty() {
                    break;
                }
                self.sift::<S, O, F>(simd, &lens, extent, true, observer);
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
                Kind::Patch | Kind::Triangles => {
                    let is_odd = F::is(Planted::TiesToLast);
                    let used = if is_odd { counts.all() } else { counts.different() };
                    if O::ENABLED {
                        self.tell_of_leaf(child, used, observer);
                    }
                    let hurry = O::ENABLED || extent == Extent::Many || self.tile.is_nearly_full();
                    let is_full = self.sieve.add(Waiting { leaf: child, used, near, size });
                    if !(is_full || hurry) {
                        continue;
                    }
                    extent = self.sift::<S, O, F>(simd, &lens, extent, hurry, observer);
                }
                Kind::Spheres => {
                    let count = counts.all();
                    for &id in &self.prepared.round[child.index()][..count] {
                        let ball = self.rays.view.primitive(id);
                        round::draw::<O, F>(self.rays, &lens, id, &ball, &mut self.tile, observer);
                    }
                    self.tile.renew(simd);
                }
            }
            farthest = self.farthest(&lens);
        }
        if O::ENABLED
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

    /// Looks at the leaves that have waited longest, or at all, and draws triangles, eight at a time; all of them
    /// if they are large, or `hurry` asks for it. Takes and tells the extent of those that were drawn last.
    #[inline(always)]
    fn sift<S: Simd, O: EventSink + ?Sized, F: Fault>(
        &mut self,
        simd: S,
        lens: &Lens,
        extent: Extent,
        hurry: bool,
        observer: &mut O,
    ) -> Extent {
        let look = match extent {
            // What depends on the triangles that came before does not belong to the ray.
            _ if O::ENABLED => Look::Edges,
            Extent::Tiny | Extent::Few => Look::Edges,
            Extent::Many => Look::Boxes,
        };
        self.sieve.sift(simd, self.prepared, lens, look, hurry);
        let mut largest = None;
        loop {
            let count = self.sieve.count();
            let all = hurry || largest == Some(Extent::Many);
            if count == 0 || (count < EIGHT && !all) {
                break;
            }
            let eight = self.sieve.take_eight(simd);
            let of = (&eight, (1 << count.min(EIGHT)) - 1);
            let extent = draw::draw::<S, O, F>(simd, self.rays, lens, of, &mut self.tile, observer);
            largest = largest.max(Some(extent));
        }
        largest.unwrap_or(extent)
    }

    /// Tells that a ray alone is tested against triangles of a leaf.
    fn tell_of_leaf<O: EventSink + ?Sized>(&self, leaf: Child, used: usize, observer: &mut O) {
        if let Some(counts) = observer.counts() {
            counts.tests += used as u64;
            return;
        }
        let Some(sample) = self.tile.sample(0) else { return };
        let ids = match leaf.kind() {
            Kind::Patch => &self.prepared.patches[leaf.index()].ids,
            _ => &self.prepared.triangles[leaf.index()].ids,
        };
        ids.iter().take(used).for_each(|id| observer.sample_tested(sample, *id));
    }

    /// Tests the boxes of a node and opens those that a ray of the tile may meet, near ones last, so
    /// first; of leaves with `tiny` triangles any.
    ///
    /// A side's function is largest, of a box, at one of its corners. The error of points on rays counts, which
    /// [`Rays::lens_kind`] allows for, and that of what is computed here, for which [`super::rough`] does.
    #[inline(always)]
    fn enter<S: Simd, O: EventSink + ?Sized, F: Fault>(
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
        let ([near, size], met) = meet::<S, F>(simd, lens, node, farthest);
        let used = (1_u64 << node.used) - 1;
        let mut met = met.to_bitmask() & used;
        if O::ENABLED
            && let Some(sample) = self.tile.sample(0)
        {
            let boxes = if let Some(counts) = observer.counts() {
                counts.nodes += u64::from(node.used);
                0
            } else {
                usize::from(node.used)
            };
            for lane in 0..boxes {
                let number = u32::try_from(index * WIDTH + lane).unwrap_or(u32::MAX);
                observer.node_opened(sample, number, met >> lane & 1 == 1);
            }
        }
        let (near, size) = (near.to_array(), size.to_array());
        // Where leaves wait for others anyway, sorting them costs more than it saves.
        let sorted = !(tiny && node.bottom);
        let base = self.stack.len();
        while met != 0 {
            let lane = (met.trailing_zeros() & 15) as usize;
            met &= met - 1;
            let child = node.children[lane];
            match child.kind() {
                Kind::Node => prefetch(&self.prepared.nodes[child.index()]),
                Kind::Patch => prefetch(&self.prepared.patches[child.index()]),
                Kind::Triangles => prefetch(&self.prepared.triangles[child.index()]),
                Kind::Spheres => {}
            }
            let open =
                Open { near: near[lane], size: size[lane], child, counts: node.counts[lane] };
            self.stack.push(open);
            let mut place = self.stack.len() - 1;
            while sorted && place > base && self.stack[place - 1].near < open.near {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = open;
        }
    }
}

/// The nearest `t` of each box, its longest side, and which boxes a ray of the tile may meet before `farthest`.
#[inline(always)]
fn meet<S: Simd, F: Fault>(
    simd: S,
    Lens { kind, sides, .. }: &Lens,
    node: &Node,
    farthest: f32,
) -> ([f32x16<S>; 2], mask32x16<S>) {
    let kind = &kind.rough;
    let [ox, oy, oz] = kind.origin;
    let [lx, ly, lz, hx, hy, hz] = &node.bounds;
    let boxes = [
        [f32x16::load_array_ref(simd, lx) - ox, f32x16::load_array_ref(simd, hx) - ox],
        [f32x16::load_array_ref(simd, ly) - oy, f32x16::load_array_ref(simd, hy) - oy],
        [f32x16::load_array_ref(simd, lz) - oz, f32x16::load_array_ref(simd, hz) - oz],
    ];
    let [left, right, upper, lower] = sides;
    let across = left.reach(&boxes, true).min(right.reach(&boxes, true));
    let down = upper.reach(&boxes, true).min(lower.reach(&boxes, true));
    let (near, far) = (kind.t.reach(&boxes, false), kind.t.reach(&boxes, true));
    let room = if F::is(Planted::ShrunkBox) { 0.0 } else { kind.sides_error };
    // NaN, from numbers that overflow, lets pass.
    let missed = across.min(down).simd_lt(f32x16::splat(simd, -room))
        | far.simd_lt(f32x16::splat(simd, kind.least_t))
        | near.simd_gt(f32x16::splat(simd, farthest));
    let width = f32x16::load_array_ref(simd, hx) - f32x16::load_array_ref(simd, lx);
    let height = f32x16::load_array_ref(simd, hy) - f32x16::load_array_ref(simd, ly);
    let depth = f32x16::load_array_ref(simd, hz) - f32x16::load_array_ref(simd, lz);
    ([near, width.max(height).max(depth)], !missed)
}

/// A fault: boxes too small by the last place.
fn shrink(node: &Node) -> Node {
    let mut node = *node;
    node.bounds[..3].as_flattened_mut().iter_mut().for_each(|low| *low = low.next_up());
    node.bounds[3..].as_flattened_mut().iter_mut().for_each(|high| *high = high.next_down());
    node
}
