//! Collapses binary trees into nodes of sixteen children, at the least cost. Large halves of a tree are built at the same time.
//!
//! If the build split the largest box until a node is full, most nodes at the bottom would have few leaves. Instead,
//! dynamic programming finds the best splits, as in Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs", High-Performance Graphics, 2017.

use super::arena::{Arena, LeafRange};
use super::leaves::{kind_of, put_duplicates_last};
use super::prim_ref::{CornerReader, PrimRef};
use super::split::{BuildContext, BuildRecord, Kind, Split, split};
use crate::fast::search::tree::{Bounds, LeafCounts, Node, NodeKind, NodeRef, WIDTH};

/// If each half of a tree has at least this many primitives, threads build both at the same time.
const IN_PARALLEL: usize = 512;

/// A record that is split in two repeatedly, down to the leaves. The root is the last node.
pub(super) struct BinaryTree {
    all: Vec<BinaryNode>,
    /// For each fork, the least cost (the areas of the boxes of the nodes under it) if the fork becomes at most 1, 2, … children
    /// of another node. A leaf costs nothing.
    costs: Vec<[f64; WIDTH]>,
}

/// A node of a binary tree.
struct BinaryNode {
    bounds: Bounds,
    kind: BinaryKind,
}

enum BinaryKind {
    Leaf(LeafRange, NodeKind, LeafCounts),
    Fork(Fork),
}

/// A node that is split.
#[derive(Clone, Copy)]
struct Fork {
    /// The indices of its two halves.
    halves: [usize; 2],
    /// The index of its costs.
    costs: usize,
}

impl BinaryTree {
    pub(super) fn new(record: BuildRecord<&mut [PrimRef]>, context: &BuildContext) -> BinaryTree {
        BinaryTree::with_halves_in_parallel(record, context, IN_PARALLEL)
    }

    /// A tree of which threads build two halves at the same time if each has at least so many primitives.
    fn with_halves_in_parallel(
        record: BuildRecord<&mut [PrimRef]>,
        context: &BuildContext,
        in_parallel: usize,
    ) -> BinaryTree {
        let mut tree = BinaryTree { all: Vec::new(), costs: Vec::new() };
        tree.divide(record, context, in_parallel);
        tree
    }

    /// Splits a record into leaves. Returns the index of its node, which is the last index.
    fn divide(
        &mut self,
        mut record: BuildRecord<&mut [PrimRef]>,
        context: &BuildContext,
        in_parallel: usize,
    ) -> usize {
        let (bounds, weight) = (record.bounds.bounds(), record.bounds.half_area());
        while record.prims.len() > context.most() {
            match split(record, context) {
                Split::Halves([left, right]) => {
                    let halves = if left.prims.len().min(right.prims.len()) < in_parallel {
                        [left, right].map(|half| self.divide(half, context, in_parallel))
                    } else {
                        let new = BinaryTree::with_halves_in_parallel;
                        let (left, right) = rayon::join(
                            || new(left, context, in_parallel),
                            || new(right, context, in_parallel),
                        );
                        [left, right].map(|half| self.append(half))
                    };
                    self.costs.push(self.costs_of(weight, halves));
                    let fork = Fork { halves, costs: self.costs.len() - 1 };
                    return self.add(BinaryNode { bounds, kind: BinaryKind::Fork(fork) });
                }
                Split::Distinct(distinct) => record = distinct,
            }
        }
        let count = record.prims.len();
        let (kind, distinct) = match context.kind {
            Kind::Spheres => (NodeKind::Spheres, count),
            Kind::Instances => (NodeKind::Instances, count),
            Kind::Triangles => {
                let corners = &mut CornerReader::new(context.source);
                let kind = kind_of(record.prims, corners, context.level);
                (kind, put_duplicates_last(record.prims, corners))
            }
        };
        let first = u32::try_from(record.first).expect("ids are u32");
        let leaf = LeafRange { first, count: u8::try_from(count).expect("sixteen at most") };
        let kind = BinaryKind::Leaf(leaf, kind, LeafCounts::new(count, distinct));
        self.add(BinaryNode { bounds: record.bounds.bounds(), kind })
    }

    /// Adds a tree that was built separately. Returns the index of its root.
    fn append(&mut self, mut tree: BinaryTree) -> usize {
        // The first is taken over as it is, without a copy.
        if self.all.is_empty() {
            *self = tree;
            return self.all.len() - 1;
        }
        let (nodes, costs) = (self.all.len(), self.costs.len());
        for node in &mut tree.all {
            if let BinaryKind::Fork(fork) = &mut node.kind {
                fork.halves = fork.halves.map(|half| nodes + half);
                fork.costs += costs;
            }
        }
        self.all.append(&mut tree.all);
        self.costs.append(&mut tree.costs);
        self.all.len() - 1
    }

    fn add(&mut self, node: BinaryNode) -> usize {
        self.all.push(node);
        self.all.len() - 1
    }

    /// The costs of two halves together: as one node of this weight, or as several children of another node.
    fn costs_of(&self, weight: f64, halves: [usize; 2]) -> [f64; WIDTH] {
        let mut costs = [0.0; WIDTH];
        costs[0] = weight + self.cheapest_division(halves, WIDTH).1;
        for children in 2..=WIDTH {
            let divided = self.cheapest_division(halves, children).1;
            costs[children - 1] = divided.min(costs[children - 2]);
        }
        costs
    }

    /// The cheapest division of `children` children between two halves: the number of children for the first half,
    /// and the cost.
    fn cheapest_division(&self, [left, right]: [usize; 2], children: usize) -> (usize, f64) {
        let costs = |half: usize| match self.all[half].kind {
            BinaryKind::Leaf(..) => None,
            BinaryKind::Fork(fork) => Some(&self.costs[fork.costs]),
        };
        // A leaf costs nothing as one child, and no node costs more if it may become more children: all others are the other
        // half's, or as few of them as cost the least.
        let (left, right) = match (costs(left), costs(right)) {
            (None, None) => return (1, 0.0),
            (None, Some(right)) => return (1, right[children - 2]),
            (Some(left), None) => {
                let cost = left[children - 2];
                return (1 + left.partition_point(|more| *more > cost), cost);
            }
            (Some(left), Some(right)) => (left, right),
        };
        let mut best = (1, f64::INFINITY);
        for first in 1..children {
            let cost = left[first - 1] + right[children - first - 1];
            if cost < best.1 {
                best = (first, cost);
            }
        }
        best
    }

    /// Adds the collapsed nodes and leaves of the tree to an arena. Returns the root.
    pub(super) fn collapse(&self, arena: &mut Arena) -> (NodeRef, LeafCounts) {
        self.place(self.all.len() - 1, arena)
    }

    fn place(&self, node: usize, arena: &mut Arena) -> (NodeRef, LeafCounts) {
        let halves = match self.all[node].kind {
            // The order of all instances is kept, and no leaves.
            BinaryKind::Leaf(leaf, kind @ NodeKind::Instances, counts) => {
                return (NodeRef::new(kind, leaf.first as usize), counts);
            }
            BinaryKind::Leaf(leaf, kind, counts) => {
                let leaves = &mut arena.leaves[kind as usize];
                leaves.push(leaf);
                return (NodeRef::new(kind, leaves.len() - 1), counts);
            }
            BinaryKind::Fork(Fork { halves, .. }) => halves,
        };
        let index = arena.nodes.len();
        arena.nodes.push(Node::empty());
        let mut children = Vec::with_capacity(WIDTH);
        self.choose(halves, WIDTH, &mut children);
        for node in children {
            let (child, counts) = self.place(node, arena);
            arena.attach(index, &self.all[node].bounds, child, counts);
        }
        (NodeRef::new(NodeKind::Node, index), LeafCounts::default())
    }

    /// Chooses the nodes that represent two halves as at most `children` children of a node; of equal costs, the
    /// choice with the most children.
    fn choose(&self, halves: [usize; 2], children: usize, into: &mut Vec<usize>) {
        let (first, _) = self.cheapest_division(halves, children);
        for (half, most) in halves.into_iter().zip([first, children - first]) {
            let BinaryKind::Fork(Fork { halves, costs }) = self.all[half].kind else {
                into.push(half);
                continue;
            };
            let is_cheap = |children: &usize| {
                self.cheapest_division(halves, *children).1 <= self.costs[costs][most - 1]
            };
            match (2..=most).rev().find(is_cheap) {
                Some(children) => self.choose(halves, children, into),
                None => into.push(half),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast::search::build::prim_ref::Source;
    use bothways_common::Scene;
    use bothways_common::engine::simd::best_level;
    use glam::Vec3;

    /// A tree of boxes, and its collapsed nodes and leaves.
    fn collapsed(mut prims: Vec<PrimRef>, in_parallel: usize) -> (BinaryTree, Arena) {
        let scene = Scene::new(vec![]).unwrap();
        let (kind, level) = (Kind::Spheres, best_level());
        let context =
            BuildContext { kind, source: Source::Scene(&scene), level, by_all_threads: false };
        let record = BuildRecord::new(&mut prims[..], 0, 0, false, level);
        let tree = BinaryTree::with_halves_in_parallel(record, &context, in_parallel);
        let mut arena = Arena::default();
        tree.collapse(&mut arena);
        (tree, arena)
    }

    #[test]
    fn halves_that_are_built_apart_are_put_together() {
        let mut random = fastrand::Rng::with_seed(19);
        let mut vector = |size: f32| Vec3::from_array([(); 3].map(|()| size * random.f32()));
        let of = |id: u32| {
            let low = vector(100.0);
            PrimRef::new(&Bounds { low, high: low + vector(3.0) }, id)
        };
        let prims: Vec<PrimRef> = (0..5000).map(of).collect();
        let shown = |arena: &Arena| {
            let leaves = arena.leaves.iter().flatten().map(|leaf| (leaf.first, leaf.count));
            format!("{:?} {:?}", arena.nodes, leaves.collect::<Vec<_>>())
        };
        let expected = shown(&collapsed(prims.clone(), usize::MAX).1);
        for in_parallel in [1, 20, 512] {
            let (tree, arena) = collapsed(prims.clone(), in_parallel);
            assert!(shown(&arena) == expected, "{in_parallel}");
            // The cost of the root is what all nodes cost.
            let root = tree.all.last().unwrap();
            let BinaryKind::Fork(fork) = root.kind else { panic!("there are many") };
            let area = |bounds: Bounds| PrimRef::new(&bounds, 0).0.half_area();
            let of_node = |node: &Node| -> f64 {
                let nodes = (0..usize::from(node.used))
                    .filter(|lane| node.children[*lane].kind() == NodeKind::Node);
                nodes.map(|lane| area(node.bounds_of(lane))).sum()
            };
            let of_all = area(root.bounds) + arena.nodes.iter().map(of_node).sum::<f64>();
            let cost = tree.costs[fork.costs][0];
            assert!((cost - of_all).abs() < 1e-9 * of_all, "{cost} and {of_all}");
        }
    }
}
