//! The nodes of a hierarchy under construction, and the primitives of its leaves.

use crate::fast::search::tree::{Bounds, LEAF_KINDS, LeafCounts, Node, NodeKind, NodeRef};

/// Nodes and leaves of the hierarchy, or of a part of it, in depth-first order.
#[derive(Default)]
pub(super) struct Arena {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: [Vec<LeafRange>; LEAF_KINDS],
}

/// The primitives of a leaf.
#[derive(Clone, Copy)]
pub(super) struct LeafRange {
    pub(super) first: u32,
    pub(super) count: u8,
}

impl Arena {
    /// Attaches a child to a node.
    pub(super) fn attach(
        &mut self,
        node: usize,
        bounds: &Bounds,
        child: NodeRef,
        counts: LeafCounts,
    ) {
        let node = &mut self.nodes[node];
        node.counts[usize::from(node.used)] = counts;
        node.push(bounds, child);
    }

    /// A node for a hierarchy that is only a leaf: the root, with a node that holds it if it is one.
    pub(super) fn begun_with_node(
        &mut self,
        bounds: &Bounds,
        root: NodeRef,
        counts: LeafCounts,
    ) -> (NodeRef, LeafCounts) {
        if root.kind() == NodeKind::Node {
            return (root, counts);
        }
        let node = self.nodes.len();
        self.nodes.push(Node::empty());
        self.attach(node, bounds, root, counts);
        (NodeRef::new(NodeKind::Node, node), LeafCounts::default())
    }

    /// Appends a part that was built separately.
    pub(super) fn append(&mut self, part: Arena) {
        let part = part.shifted(self.nodes.len(), self.leaf_counts());
        self.nodes.extend(part.nodes);
        for (leaves, more) in self.leaves.iter_mut().zip(part.leaves) {
            leaves.extend(more);
        }
    }

    /// The same for a hierarchy in which this many more nodes, and leaves of each kind, precede it.
    pub(super) fn shifted(mut self, nodes: usize, leaves: [usize; LEAF_KINDS]) -> Arena {
        if nodes + leaves.iter().sum::<usize>() > 0 {
            for node in &mut self.nodes {
                for child in &mut node.children[..usize::from(node.used)] {
                    *child = child.shifted(nodes, leaves);
                }
            }
        }
        self
    }

    /// The number of leaves of each kind.
    pub(super) fn leaf_counts(&self) -> [usize; LEAF_KINDS] {
        self.leaves.each_ref().map(Vec::len)
    }
}
