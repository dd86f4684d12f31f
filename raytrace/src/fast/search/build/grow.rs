//! Grows a hierarchy from a record: all threads split a large record from the top, until its parts are small enough to become
//! binary trees, which are collapsed.

use super::arena::Arena;
use super::collapse::BinaryTree;
use super::primitives::Primitives;
use super::split::{BuildContext, BuildRecord, Split, split};
use crate::fast::search::tree::{Bounds, LeafCounts, Node, NodeKind, NodeRef, WIDTH};
use rayon::prelude::*;

/// A record of fewer primitives becomes one binary tree, whose large halves threads build at the same time.
const TOO_MANY_FOR_TREE: usize = 16384;

/// Builds the hierarchy of a record, beginning with its first node, behind what is in an arena. If there are many
/// primitives, this function splits the record with the largest box until a node is full.
pub(super) fn grow<P: Primitives>(
    whole: BuildRecord<P>,
    context: &BuildContext,
    arena: &mut Arena,
) -> (NodeRef, LeafCounts) {
    let count = whole.prims.len();
    if count < P::AT_HAND {
        return whole.at_hand(|whole| grow(whole, context, arena));
    }
    if count < TOO_MANY_FOR_TREE {
        let alone = &BuildContext { by_all_threads: false, ..*context };
        return whole.at_hand(|whole| BinaryTree::new(whole, alone).collapse(arena));
    }
    let mut records = vec![whole];
    while records.len() < WIDTH {
        let divisible =
            records.iter().enumerate().filter(|(_, record)| record.prims.len() > context.most());
        let areas = divisible.map(|(index, record)| (index, record.bounds.half_area()));
        let Some((largest, _)) = areas.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        match split(records.remove(largest), context) {
            Split::Halves(halves) => _ = records.splice(largest..largest, halves),
            Split::Distinct(record) => records.insert(largest, record),
        }
    }
    let node = arena.nodes.len();
    arena.nodes.push(Node::empty());
    let (mut done, mut records) = (0, records.into_iter());
    while records.len() > 0 {
        let together: Vec<BuildRecord<P>> = records.by_ref().take(P::TOGETHER).collect();
        done += together.iter().map(|record| record.prims.len()).sum::<usize>();
        let bounds: Vec<Bounds> = together.iter().map(|record| record.bounds.bounds()).collect();
        let grown = together.into_par_iter().map(|record| {
            let mut part = Arena::default();
            let (child, counts) = grow(record, context, &mut part);
            (part, child, counts)
        });
        let grown: Vec<(Arena, NodeRef, LeafCounts)> = grown.collect();
        for ((part, child, counts), bounds) in grown.into_iter().zip(bounds) {
            let child = child.shifted(arena.nodes.len(), arena.leaf_counts());
            arena.append(part);
            arena.attach(node, &bounds, child, counts);
        }
        // The others will need about as many nodes. If the list grew by doubling, half of it might stay empty.
        let more = (arena.nodes.len() - node) * count.saturating_sub(done) / done.max(1);
        arena.nodes.reserve_exact(more + more / 16);
    }
    (NodeRef::new(NodeKind::Node, node), LeafCounts::default())
}
