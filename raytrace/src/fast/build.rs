//! Building the hierarchy: boxes around boxes around primitives, split where that is expected to be
//! cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007; sixteen boxes a node as in Wald, Benthin and Boulos, "Getting Rid of
//! Packets", same venue, 2008.

mod cut;
mod items;
mod leaves;
mod planes;

use super::tree::{
    Bounds, Child, Counts, Kind, LEAF, LEAF_KINDS, Node, Patch, SPHERES, Triangles, WIDTH,
};
use bothways_common::Scene;
use bothways_common::engine::simd::{Level, best_level};
use cut::Branches;
use items::{Box4, Corners, Item, collect};
use planes::cheapest_plane;
use rayon::prelude::*;

/// Parts with fewer primitives are built by one thread.
const SERIAL: usize = 4096;
/// From this depth on a part is halved by count, which bounds the depth of any hierarchy.
const DEEP: usize = 64;

/// What a moving camera would not repeat: the hierarchy over all bounded primitives.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) nodes: Vec<Node>,
    pub(super) patches: Vec<Patch>,
    pub(super) triangles: Vec<Triangles>,
    /// Where the walk begins: the triangles, and the spheres, as far as there are any.
    pub(super) roots: Vec<Child>,
    /// Around everything in the hierarchy.
    pub(super) bounds: Bounds,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and of each the extent that its box's margin was made for; see [`items::sphere`].
    pub(super) spheres: Vec<(u32, f32)>,
    /// The ids of the spheres of the hierarchy's leaves; unused ones repeat the first.
    pub(super) round: Vec<[u32; SPHERES]>,
    pub(super) primitives: u32,
    pub(super) level: Level,
    pub(super) side: usize,
}

/// Some consecutive items, the box around them and the box around their middles.
struct Part<'a> {
    items: &'a mut [Item],
    bounds: Box4,
    middles: Box4,
    /// The number of the first item among all.
    first: usize,
    depth: usize,
    /// Whether triangles that are the same as an earlier one were left out.
    distinct: bool,
}

pub(super) fn build(scene: &Scene, side: usize) -> Prepared {
    let mut collected = collect(scene);
    let mut arena = Arena::default();
    let mut roots = Vec::new();
    let mut bounds = Bounds::EMPTY;
    let parts = [(false, &mut collected.triangles), (true, &mut collected.round)];
    for (round, items) in parts {
        if items.is_empty() {
            continue;
        }
        let all = Part::new(items, 0, 0, false);
        let root = all.bounds.bounds();
        bounds = bounds.with(&root);
        let (mut tree, child, counts) = Arena::grown(all, &Plot { round, scene });
        // Few primitives are a leaf; the walk begins at a node.
        if child.kind() != Kind::Node {
            tree.nodes.push(Node::empty());
            tree.attach(0, &root, child, counts);
        }
        roots.push(arena.append(tree));
    }
    let [patches, triangles, round] = &arena.leaves;
    let (flat, balls) = (&collected.triangles, &collected.round);
    Prepared {
        patches: filled(scene, flat, patches, leaves::patch),
        triangles: filled(scene, flat, triangles, leaves::triangles),
        round: filled(scene, balls, round, |items, _| {
            std::array::from_fn(|lane| items.get(lane).unwrap_or(&items[0]).id())
        }),
        nodes: arena.nodes,
        roots,
        bounds,
        unbounded: collected.unbounded,
        spheres: collected.spheres,
        primitives: scene.primitive_count(),
        level: best_level(),
        side,
    }
}

/// Leaves of one kind.
fn filled<L: Send>(
    scene: &Scene,
    items: &[Item],
    ranges: &[LeafRange],
    leaf: impl Fn(&[Item], &mut Corners) -> L + Sync,
) -> Vec<L> {
    let ranges = ranges.par_iter().with_min_len(64);
    let of = |range: &LeafRange| &items[range.first as usize..][..usize::from(range.count)];
    ranges.map_init(|| Corners::new(scene), |corners, range| leaf(of(range), corners)).collect()
}

/// The items of a leaf.
#[derive(Clone, Copy)]
struct LeafRange {
    first: u32,
    count: u8,
}

/// Nodes and leaves of the hierarchy, or of a part of it, in depth-first order.
#[derive(Default)]
struct Arena {
    nodes: Vec<Node>,
    leaves: [Vec<LeafRange>; LEAF_KINDS],
}

/// What all parts of one hierarchy share.
struct Plot<'a> {
    /// Whether it is that of the spheres.
    round: bool,
    scene: &'a Scene,
}

impl Plot<'_> {
    /// How many primitives a leaf has at most.
    fn most(&self) -> usize {
        if self.round { SPHERES } else { LEAF }
    }
}

impl<'a> Part<'a> {
    fn new(items: &'a mut [Item], first: usize, depth: usize, distinct: bool) -> Self {
        let (mut bounds, mut middles) = (Box4::EMPTY, Box4::EMPTY);
        for item in &*items {
            bounds = bounds.with(item.low, item.high);
            let middle = item.middle();
            middles = middles.with(middle, middle);
        }
        Part { items, bounds, middles, first, depth, distinct }
    }
}

impl Arena {
    /// Builds the hierarchy of a part, from its first node on. If there are many primitives, splits the part with
    /// the largest box until a node is full.
    fn grown(whole: Part, plot: &Plot) -> (Arena, Child, Counts) {
        let mut arena = Arena::default();
        if whole.items.len() < SERIAL {
            let (child, counts) = Branches::new(whole, plot).place(&mut arena);
            return (arena, child, counts);
        }
        let mut parts = vec![whole];
        while parts.len() < WIDTH {
            let divisible =
                parts.iter().enumerate().filter(|(_, part)| part.items.len() > plot.most());
            let areas = divisible.map(|(index, part)| (index, part.bounds.half_area()));
            let Some((largest, _)) = areas.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            match split(parts.remove(largest), plot) {
                Split::Halves(halves) => _ = parts.splice(largest..largest, halves),
                Split::Distinct(part) => parts.insert(largest, part),
            }
        }
        arena.nodes.push(Node::empty());
        let bounds: Vec<Bounds> = parts.iter().map(|part| part.bounds.bounds()).collect();
        let grown: Vec<(Arena, Child, Counts)> =
            parts.into_par_iter().map(|part| Arena::grown(part, plot)).collect();
        for ((part, child, counts), bounds) in grown.into_iter().zip(bounds) {
            let child = child.moved(arena.nodes.len(), arena.leaf_counts());
            arena.append(part);
            arena.attach(0, &bounds, child, counts);
        }
        (arena, Child::new(Kind::Node, 0), Counts::default())
    }

    fn attach(&mut self, node: usize, bounds: &Bounds, child: Child, counts: Counts) {
        let node = &mut self.nodes[node];
        node.counts[usize::from(node.used)] = counts;
        node.push(bounds, child);
    }

    /// Takes in a part that was built beside this one, and says where it begins now.
    fn append(&mut self, part: Arena) -> Child {
        let (nodes, leaves) = (self.nodes.len(), self.leaf_counts());
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            for child in &mut node.children[..usize::from(node.used)] {
                *child = child.moved(nodes, leaves);
            }
            node
        }));
        for (leaves, more) in self.leaves.iter_mut().zip(part.leaves) {
            leaves.extend(more);
        }
        Child::new(Kind::Node, nodes)
    }

    fn leaf_counts(&self) -> [usize; LEAF_KINDS] {
        self.leaves.each_ref().map(Vec::len)
    }
}

/// A part of more primitives than a leaf holds, divided in two, or without those that were in it twice.
enum Split<'a> {
    Halves([Part<'a>; 2]),
    Distinct(Part<'a>),
}

fn split<'a>(part: Part<'a>, plot: &Plot) -> Split<'a> {
    let Part { items, middles, first, depth, distinct, .. } = part;
    let best = cheapest_plane(items, &middles, plot.most()).filter(|_| depth < DEEP);
    let Some(plane) = best else {
        if !plot.round && !distinct {
            let count = leave_out_twins(items, plot);
            return Split::Distinct(Part::new(&mut items[..count], first, depth, true));
        }
        // All in one place, or too deep: any half is as good as any other, if only it is whole leaves.
        let half = (items.len() / 2).next_multiple_of(plot.most()).min(items.len() - 1);
        let (left, right) = items.split_at_mut(half);
        let left = Part::new(left, first, depth + 1, distinct);
        return Split::Halves([left, Part::new(right, first + half, depth + 1, distinct)]);
    };
    let (mut middle, mut end) = (0, items.len());
    let (mut left, mut right) = ([Box4::EMPTY; 2], [Box4::EMPTY; 2]);
    while middle < end {
        let item = items[middle];
        let place = item.middle();
        let goes_left = plane.grid.bins(place)[plane.axis] < plane.bin;
        let side = if goes_left { &mut left } else { &mut right };
        side[0] = side[0].with(item.low, item.high);
        side[1] = side[1].with(place, place);
        if goes_left {
            middle += 1;
        } else {
            end -= 1;
            items.swap(middle, end);
        }
    }
    let (left_items, right_items) = items.split_at_mut(middle);
    let part = |items, first, [bounds, middles]: [Box4; 2]| Part {
        items,
        bounds,
        middles,
        first,
        depth: depth + 1,
        distinct,
    };
    Split::Halves([part(left_items, first, left), part(right_items, first + middle, right)])
}

/// Brings triangles with the same corners together, keeps the first in the scene of each and tells how
/// many there are: the others are never seen.
fn leave_out_twins(items: &mut [Item], plot: &Plot) -> usize {
    let mut corners = Corners::new(plot.scene);
    let mut bits = |item: &Item| {
        // Adding 0 makes −0 and 0 one.
        let mut bits = corners.of(item.id()).map(|v| (v + 0.0).to_array().map(f32::to_bits));
        bits.sort_unstable();
        bits
    };
    items.sort_by_cached_key(|item| (bits(item), item.id()));
    let mut kept = 1;
    for k in 1..items.len() {
        if bits(&items[k]) != bits(&items[kept - 1]) {
            items[kept] = items[k];
            kept += 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests;
