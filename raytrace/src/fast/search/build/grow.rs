//! Grows a hierarchy from a record: all threads split the record from the top, and each thread collapses its own
//! part.

use super::arena::Arena;
use super::collapse::BinaryTree;
use super::split::{BuildContext, BuildRecord, Split, split};
use crate::fast::search::tree::{Bounds, LeafCounts, Node, NodeKind, NodeRef, WIDTH};
use rayon::prelude::*;

/// One thread builds a record with fewer primitives than this.
const SERIAL: usize = 4096;

/// Builds the hierarchy of a record, beginning with its first node. If there are many primitives, this function
/// splits the record with the largest box until a node is full.
pub(super) fn grow(whole: BuildRecord, context: &BuildContext) -> (Arena, NodeRef, LeafCounts) {
    let mut arena = Arena::default();
    if whole.prims.len() < SERIAL {
        let (child, counts) = BinaryTree::new(whole, context).collapse(&mut arena);
        return (arena, child, counts);
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
    arena.nodes.push(Node::empty());
    let bounds: Vec<Bounds> = records.iter().map(|record| record.bounds.bounds()).collect();
    let grown: Vec<(Arena, NodeRef, LeafCounts)> =
        records.into_par_iter().map(|record| grow(record, context)).collect();
    for ((part, child, counts), bounds) in grown.into_iter().zip(bounds) {
        let child = child.shifted(arena.nodes.len(), arena.leaf_counts());
        arena.append(part);
        arena.attach(0, &bounds, child, counts);
    }
    (arena, NodeRef::new(NodeKind::Node, 0), LeafCounts::default())
}
