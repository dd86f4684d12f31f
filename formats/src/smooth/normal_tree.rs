//! The faces around one vertex, sorted by where their normals point, so that those within an angle of any
//! direction are summed without looking at each.

use super::facet::Facet;
use glam::DVec3;

/// A tree of boxes around unit normals; in each, the sum of what belongs to them.
#[derive(Debug)]
pub(super) struct NormalTree {
    /// Each followed by all of its first half, then all of its second.
    nodes: Vec<Node>,
    /// In the order of the nodes.
    facets: Vec<Facet>,
}

/// Some normals within a box.
#[derive(Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    sum: DVec3,
    /// Its facets.
    first: usize,
    end: usize,
    /// The node behind it and its halves.
    behind: usize,
}

/// Facets that are looked at one by one.
const FEW: usize = 8;

impl NormalTree {
    /// Those of facets with a normal.
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

    /// The sum of the weighted normals of all faces whose normals' product with this one is at least so
    /// large.
    ///
    /// Rounding keeps order: the computed product with a normal in a box lies between those computed with the
    /// box's sides. So a face counts here exactly if it does by itself.
    pub(super) fn sum(&self, normal: DVec3, least: f64) -> DVec3 {
        let mut sum = DVec3::ZERO;
        let mut index = 0;
        while let Some(node) = self.nodes.get(index) {
            let (low, high) = (normal * node.low, normal * node.high);
            let (most, least_of_all) = (low.max(high).element_sum(), low.min(high).element_sum());
            index = if least_of_all >= least {
                sum += node.sum;
                node.behind
            } else if most < least {
                node.behind
            } else {
                // Cut by the cap's border: its halves follow, or its facets are looked at.
                if node.behind == index + 1 {
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

/// Puts a box around the facets from `first` on, and halves it where its normals are farthest apart.
fn build(nodes: &mut Vec<Node>, facets: &mut [Facet], first: usize, end: usize) {
    let index = nodes.len();
    let here = &mut facets[first..end];
    let [mut low, mut high, mut sum] = [DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO];
    for Facet { normal, weighted, .. } in here.iter() {
        (low, high, sum) = (low.min(*normal), high.max(*normal), sum + *weighted);
    }
    nodes.push(Node { low, high, sum, first, end, behind: index + 1 });
    if end - first > FEW && low != high {
        let axis = (high - low).max_position();
        let middle = here.len() / 2;
        here.select_nth_unstable_by(middle, |a, b| a.normal[axis].total_cmp(&b.normal[axis]));
        build(nodes, facets, first, first + middle);
        build(nodes, facets, first + middle, end);
        nodes[index].behind = nodes.len();
    }
}
