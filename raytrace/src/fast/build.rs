//! Building the hierarchy: boxes around boxes around primitives, split where that is expected to be
//! cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007; eight boxes a node as in Wald, Benthin and Boulos, "Getting Rid of
//! Packets", same venue, 2008.

mod cut;
mod items;
mod planes;

use super::tree::{Bounds, Child, Kind, Leaf, Node, WIDTH};
use bothways_common::Scene;
use bothways_common::predicate::are_same_corners;
use bothways_common::simd::{Level, best_level};
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
    /// Eight triangles each.
    pub(super) leaves: Vec<Leaf>,
    /// Where the walk begins: the triangles, and the spheres, as far as there are any.
    pub(super) roots: Vec<Child>,
    /// Around everything in the hierarchy.
    pub(super) bounds: Bounds,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and of each the extent that its box's margin was made for; see [`items::sphere`].
    pub(super) spheres: Vec<(u32, f32)>,
    /// The ids of the spheres of the hierarchy's leaves, eight each; unused ones repeat the first.
    pub(super) round: Vec<[u32; WIDTH]>,
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
    let kinds = [Kind::Triangles, Kind::Spheres];
    for (kind, items) in kinds.into_iter().zip([&mut collected.triangles, &mut collected.round]) {
        if items.is_empty() {
            continue;
        }
        let all = Part::new(items, 0, 0, false);
        let root = all.bounds.bounds();
        bounds = bounds.with(&root);
        let (mut tree, child, counts) = Arena::grown(all, &Plot { kind, scene });
        // Few primitives are a leaf; the walk begins at a node.
        if child.kind() != Kind::Node {
            tree.nodes.push(Node::empty());
            tree.attach(0, &root, child, counts);
        }
        roots.push(arena.append(tree));
    }
    let triangle_leaves = arena.leaves.iter().filter(|leaf| leaf.kind == Kind::Triangles).count();
    let (flat, round) = arena.leaves.split_at(triangle_leaves);
    let first =
        |leaf: &LeafRange| leaf.first as usize..(leaf.first + u32::from(leaf.count)) as usize;
    let leaves = flat
        .par_iter()
        .with_min_len(64)
        .map_init(
            || Corners::new(scene),
            |corners, leaf| fill(&collected.triangles[first(leaf)], corners),
        )
        .collect();
    let round = round.iter().map(|leaf| {
        let items = &collected.round[first(leaf)];
        std::array::from_fn(|lane| items.get(lane).unwrap_or(&items[0]).id())
    });
    // Spheres' leaves are counted from 0 again.
    let mut nodes = arena.nodes;
    let renumbered = |child: &mut Child| {
        if child.kind() == Kind::Spheres {
            *child = Child::new(Kind::Spheres, child.index() - triangle_leaves);
        }
    };
    if round.len() > 0 {
        nodes.iter_mut().flat_map(|node| &mut node.children).for_each(renumbered);
    }
    Prepared {
        leaves,
        round: round.collect(),
        nodes,
        roots,
        bounds,
        unbounded: collected.unbounded,
        spheres: collected.spheres,
        primitives: scene.primitive_count(),
        level: best_level(),
        side,
    }
}

/// The leaf of some triangles.
fn fill(items: &[Item], corners: &mut Corners) -> Leaf {
    let mut leaf = Leaf { corners: [[0.0; WIDTH]; 9], ids: [items[0].id(); WIDTH] };
    for lane in 0..WIDTH {
        let id = items.get(lane).unwrap_or(&items[0]).id();
        leaf.ids[lane] = id;
        for (corner, position) in corners.of(id).into_iter().enumerate() {
            for axis in 0..3 {
                leaf.corners[3 * corner + axis][lane] = position[axis];
            }
        }
    }
    leaf
}

/// Orders the triangles of a leaf so that those which are the same as one with a smaller id, and so never
/// seen, come last; tells how many others there are.
fn put_twins_last(items: &mut [Item], corners: &mut Corners) -> usize {
    let box_of = |item: &Item| (item.low.truncate(), item.high.truncate());
    items.sort_unstable_by_key(Item::id);
    let mut different = 0;
    for k in 0..items.len() {
        let is_twin = |other: &Item| box_of(other) == box_of(&items[k]);
        let twin = items[..different].iter().any(|other| {
            is_twin(other) && are_same_corners(&corners.of(other.id()), &corners.of(items[k].id()))
        });
        if !twin {
            items[different..=k].rotate_right(1);
            different += 1;
        }
    }
    different
}

/// The items of a leaf.
#[derive(Clone, Copy)]
struct LeafRange {
    first: u32,
    count: u8,
    kind: Kind,
}

/// Nodes and leaves of the hierarchy, or of a part of it, in depth-first order.
#[derive(Default)]
struct Arena {
    nodes: Vec<Node>,
    leaves: Vec<LeafRange>,
}

/// What all parts of one hierarchy share.
struct Plot<'a> {
    kind: Kind,
    scene: &'a Scene,
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
    /// the largest box until there are eight.
    fn grown(whole: Part, plot: &Plot) -> (Arena, Child, u8) {
        let mut arena = Arena::default();
        if whole.items.len() < SERIAL {
            let (child, counts) = Branches::new(whole, plot).place(&mut arena);
            return (arena, child, counts);
        }
        let mut parts = vec![whole];
        while parts.len() < WIDTH {
            let divisible = parts.iter().enumerate().filter(|(_, part)| part.items.len() > WIDTH);
            let areas = divisible.map(|(index, part)| (index, part.bounds.half_area()));
            let Some((largest, _)) = areas.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            match split(parts.remove(largest), plot) {
                Split::Halves(halves) => _ = parts.splice(largest..largest, halves),
                Split::Distinct(part) => parts.insert(largest, part),
            }
        }
        arena.nodes.push(Node::empty());
        let bounds: Vec<Bounds> = parts.iter().map(|part| part.bounds.bounds()).collect();
        let grown: Vec<(Arena, Child, u8)> =
            parts.into_par_iter().map(|part| Arena::grown(part, plot)).collect();
        for ((part, child, counts), bounds) in grown.into_iter().zip(bounds) {
            let child = child.moved(arena.nodes.len(), arena.leaves.len());
            arena.append(part);
            arena.attach(0, &bounds, child, counts);
        }
        (arena, Child::new(Kind::Node, 0), 0)
    }

    fn attach(&mut self, node: usize, bounds: &Bounds, child: Child, counts: u8) {
        let node = &mut self.nodes[node];
        node.counts[usize::from(node.used)] = counts;
        node.push(bounds, child);
    }

    /// Takes in a part that was built beside this one, and says where it begins now.
    fn append(&mut self, part: Arena) -> Child {
        let (nodes, leaves) = (self.nodes.len(), self.leaves.len());
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            for child in &mut node.children[..usize::from(node.used)] {
                *child = child.moved(nodes, leaves);
            }
            node
        }));
        self.leaves.extend(part.leaves);
        Child::new(Kind::Node, nodes)
    }
}

/// A part of more than eight primitives, divided in two, or without those that were in it twice.
enum Split<'a> {
    Halves([Part<'a>; 2]),
    Distinct(Part<'a>),
}

fn split<'a>(part: Part<'a>, plot: &Plot) -> Split<'a> {
    let Part { items, middles, first, depth, distinct, .. } = part;
    let best = cheapest_plane(items, &middles).filter(|_| depth < DEEP);
    let Some(plane) = best else {
        if plot.kind == Kind::Triangles && !distinct {
            let count = leave_out_twins(items, plot);
            return Split::Distinct(Part::new(&mut items[..count], first, depth, true));
        }
        // All in one place, or too deep: any half is as good as any other, if only it is whole leaves.
        let half = (items.len() / 2).next_multiple_of(WIDTH).min(items.len() - 1);
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
