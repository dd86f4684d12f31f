//! Collapses binary trees into nodes of sixteen children, at the least cost. Each tree is built by one thread.
//!
//! If the build split the largest box until a node is full, most nodes at the bottom would have few leaves. Instead,
//! dynamic programming finds the best splits, as in Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs", High-Performance Graphics, 2017.

use super::arena::{Arena, LeafRange};
use super::leaves::{put_duplicates_last, share_vertices};
use super::prim_ref::{CornerReader, PrimRef};
use super::split::{BuildContext, BuildRecord, Kind, Split, split};
use crate::fast::search::tree::{Bounds, LeafCounts, Node, NodeKind, NodeRef, WIDTH};

/// A record that is split in two repeatedly, down to the leaves. The root is the last node.
pub(super) struct BinaryTree {
    all: Vec<BinaryNode>,
}

/// A node of a binary tree.
struct BinaryNode {
    bounds: Bounds,
    /// The least cost of the nodes under this node, by the area of their boxes, if this node becomes at most 1, 2, …
    /// children of another node.
    costs: [f64; WIDTH],
    kind: BinaryKind,
}

enum BinaryKind {
    Leaf(LeafRange, NodeKind, LeafCounts),
    /// The indices of the two halves of the node.
    Fork([usize; 2]),
}

impl BinaryNode {
    fn is_leaf(&self) -> bool {
        matches!(self.kind, BinaryKind::Leaf(..))
    }
}

impl BinaryTree {
    pub(super) fn new(record: BuildRecord<&mut [PrimRef]>, context: &BuildContext) -> BinaryTree {
        let mut tree = BinaryTree { all: Vec::new() };
        tree.divide(record, context);
        tree
    }

    /// Splits a record into leaves. Returns the index of its node, which is the last index.
    fn divide(&mut self, mut record: BuildRecord<&mut [PrimRef]>, context: &BuildContext) -> usize {
        let (bounds, weight) = (record.bounds.bounds(), record.bounds.half_area());
        while record.prims.len() > context.most() {
            match split(record, context) {
                Split::Halves([left, right]) => {
                    let halves = [self.divide(left, context), self.divide(right, context)];
                    let costs = self.costs(weight, halves);
                    return self.add(BinaryNode { bounds, costs, kind: BinaryKind::Fork(halves) });
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
                let is_indexed = share_vertices(record.prims, corners, context.level);
                let kind = if is_indexed { NodeKind::IndexedLeaf } else { NodeKind::PlainLeaf };
                (kind, put_duplicates_last(record.prims, corners))
            }
        };
        let first = u32::try_from(record.first).expect("ids are u32");
        let leaf = LeafRange { first, count: u8::try_from(count).expect("sixteen at most") };
        let kind = BinaryKind::Leaf(leaf, kind, LeafCounts::new(count, distinct));
        self.add(BinaryNode { bounds: record.bounds.bounds(), costs: [0.0; WIDTH], kind })
    }

    fn add(&mut self, node: BinaryNode) -> usize {
        self.all.push(node);
        self.all.len() - 1
    }

    /// The costs of two halves together: as one node of this weight, or as several children of another node.
    fn costs(&self, weight: f64, halves: [usize; 2]) -> [f64; WIDTH] {
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
        let [left, right] = [left, right].map(|half| &self.all[half]);
        // A leaf costs nothing as one child, and no node costs more if it may become more children: all others are the other
        // half's, or as few of them as cost the least.
        if left.is_leaf() {
            return (1, right.costs[children - 2]);
        }
        if right.is_leaf() {
            let cost = left.costs[children - 2];
            return (1 + left.costs.partition_point(|more| *more > cost), cost);
        }
        let (left, right) = (&left.costs, &right.costs);
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
            BinaryKind::Fork(halves) => halves,
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
            let BinaryNode { costs, kind, .. } = &self.all[half];
            let BinaryKind::Fork(halves) = *kind else {
                into.push(half);
                continue;
            };
            let is_cheap =
                |children: &usize| self.cheapest_division(halves, *children).1 <= costs[most - 1];
            match (2..=most).rev().find(is_cheap) {
                Some(children) => self.choose(halves, children, into),
                None => into.push(half),
            }
        }
    }
}
