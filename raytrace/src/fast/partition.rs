//! How the scene is divided, as something to look at: the boxes of the hierarchy and their levels.

use super::prepared::Prepared;
use super::search::tree::{Bounds, LeafCounts, NodeKind, NodeRef, WIDTH};
use bothways_common::glam::Vec3;

/// A box of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HierarchyBox {
    /// The number that [`Events::node_opened`](bothways_common::observe::Events::node_opened) calls it.
    pub number: u32,
    /// How many boxes of the hierarchy it lies in.
    pub level: usize,
    /// Its least corner, in the world.
    pub low: Vec3,
    /// Its greatest corner, in the world.
    pub high: Vec3,
    /// The primitives of a leaf, those of whole instances included; `None` if there are boxes in this one.
    pub primitives: Option<usize>,
}

impl Prepared {
    /// All boxes, level by level: each behind the one that it lies in. Planes have no box, and the box around everything
    /// is not one of them.
    pub fn boxes(&self) -> Vec<HierarchyBox> {
        let mut boxes = Vec::new();
        let mut level: Vec<NodeRef> = self.roots.clone();
        let mut depth = 0;
        while !level.is_empty() {
            let mut next = Vec::new();
            for node in level {
                self.boxes_of(node, depth, &mut boxes, &mut next);
            }
            (level, depth) = (next, depth + 1);
        }
        boxes
    }

    fn boxes_of(
        &self,
        node: NodeRef,
        level: usize,
        boxes: &mut Vec<HierarchyBox>,
        next: &mut Vec<NodeRef>,
    ) {
        let index = node.index();
        let node = &self.nodes[index];
        for lane in 0..usize::from(node.used) {
            let Bounds { low, high } = node.bounds_of(lane);
            let child = node.children[lane];
            let is_leaf = child.kind() != NodeKind::Node;
            boxes.push(HierarchyBox {
                number: u32::try_from(index * WIDTH + lane).unwrap_or(u32::MAX),
                level,
                low,
                high,
                primitives: is_leaf.then(|| self.primitives_of(child, node.counts[lane])),
            });
            if !is_leaf {
                next.push(child);
            }
        }
    }

    fn primitives_of(&self, leaf: NodeRef, counts: LeafCounts) -> usize {
        if leaf.kind() != NodeKind::Instances {
            return counts.all();
        }
        let triangles = |number: &u32| {
            let after = self.instanced.partition_point(|one| one.first_number <= *number);
            self.instanced[after - 1].triangles as usize
        };
        self.instance_order[leaf.index()..][..counts.all()].iter().map(triangles).sum()
    }
}

#[cfg(test)]
mod tests {
    use crate::fast::prepare;
    use bothways_common::glam::Vec3;
    use bothways_common::{Mesh, Scene, Shape, Sphere};

    #[test]
    fn the_leaves_hold_every_bounded_primitive_once() {
        let positions: Vec<Vec3> = (0..1500_u16)
            .map(|k| Vec3::new(f32::from(k % 37), f32::from(k % 23), f32::from(k % 7)))
            .collect();
        let triangles: Vec<[u32; 3]> = (0..500).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let mesh = Mesh::new(positions, triangles).expect("it is a mesh");
        let ball = Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
        let scene = Scene::new(vec![Shape::Mesh(mesh).into(), ball.into()]).expect("it is a scene");
        let boxes = prepare(&scene).boxes();
        assert_eq!(boxes.iter().filter_map(|one| one.primitives).sum::<usize>(), 501);
        assert!(boxes.iter().any(|one| one.level > 0));
        assert!(boxes.is_sorted_by_key(|one| one.level));
        let mut numbers: Vec<u32> = boxes.iter().map(|one| one.number).collect();
        numbers.sort_unstable();
        numbers.dedup();
        assert_eq!(numbers.len(), boxes.len());
    }
}
