//! A tree of the normals around one vertex. It sums the normals within an angle of any direction without a visit to each.

use super::facet::Facet;
use glam::DVec3;

/// A tree of boxes around unit normals. Each node has the sum of the weighted normals in its box.
#[derive(Debug)]
pub(super) struct NormalTree {
    /// In depth-first order: each node, then its first half, then its second half.
    nodes: Vec<Node>,
    /// In the order of the nodes.
    facets: Vec<Facet>,
}

/// A box around some of the normals.
#[derive(Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    sum: DVec3,
    /// The facets are `first..end`.
    first: usize,
    end: usize,
    /// The index of the node that follows this node and both its halves.
    next: usize,
}

/// The most facets in a node without halves.
const FEW: usize = 8;

impl NormalTree {
    /// The tree of all facets that have a normal.
    pub(super) fn new(facets: &[Facet]) -> NormalTree {
        let mut facets: Vec<Facet> =
            facets.iter().copied().filter(|facet| facet.normal != DVec3::ZERO).collect();
        let mut nodes = Vec::new();
        let count = facets.len();
        if count > 0 {
            build(&mut nodes, &mut facets, 0, count);
        }
        NormalTree { nodes, facets }
    }

    /// The sum of the weighted normals of all facets whose normals have a dot product with `normal` of at least `least`.
    ///
    /// Rounding is monotonic: the computed dot product with a normal in a box lies between those computed from the sides
    /// of the box. So the facets in the sum are exactly those that a test of each facet would choose.
    pub(super) fn sum(&self, normal: DVec3, least: f64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            let (low, high) = (normal * node.low, normal * node.high);
            let (most, least_of_all) = (low.max(high).element_sum(), low.min(high).element_sum());
            index = if least_of_all >= least {
                sum += node.sum;
                node.next
            } else if most < least {
                node.next
            } else {
                // The box is partly inside: its halves follow, or its facets are tested one by one.
                if node.next == index + 1 {
                    let facets = &self.facets[node.first..node.end];
                    let gentle = facets.iter().filter(|other| normal.dot(other.normal) >= least);
                    sum += gentle.map(|other| other.weighted).sum::<DVec3>();
                }
                index + 1
            };
        }
        sum
    }
}

/// Adds a node for the facets `first..end`, and halves it along the axis on which its normals differ most.
fn build(nodes: &mut Vec<Node>, facets: &mut [Facet], first: usize, end: usize) {
    let index = nodes.len();
    let here = &mut facets[first..end];
    let [mut low, mut high, mut sum] = [DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO];
    for Facet { normal, weighted, .. } in here.iter() {
        (low, high, sum) = (low.min(*normal), high.max(*normal), sum + *weighted);
    }
    nodes.push(Node { low, high, sum, first, end, next: index + 1 });
    if end - first > FEW && low != high {
        let axis = (high - low).max_position();
        let middle = here.len() / 2;
        here.select_nth_unstable_by(middle, |a, b| a.normal[axis].total_cmp(&b.normal[axis]));
        build(nodes, facets, first, first + middle);
        build(nodes, facets, first + middle, end);
        nodes[index].next = nodes.len();
    }
}
