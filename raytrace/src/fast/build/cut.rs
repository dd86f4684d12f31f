//! Parts for one thread: split in two down to the leaves, and then cut into nodes so that these cost least.
//!
//! Splitting the largest box until a node is full would leave most nodes at the bottom with few
//! leaves. Which splits to make boxes of is found by dynamic programming instead, as in Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", High-Performance Graphics, 2017.

use super::super::tree::{Bounds, Child, Counts, Kind, Node, WIDTH};
use super::items::Corners;
use super::leaves::{Gathered, put_twins_last};
use super::{Arena, LeafRange, Part, Plot, Split, split};

/// A part that was split all the way down.
pub(super) struct Branches {
    all: Vec<Branch>,
}

/// A part of it.
struct Branch {
    bounds: Bounds,
    /// What its nodes cost at least, by the area of their boxes, if it is at most so many children of a node, from
    /// one on.
    costs: [f64; WIDTH],
    kind: BranchKind,
}

enum BranchKind {
    Leaf(LeafRange, Kind, Counts),
    /// The numbers of its two halves.
    Fork([usize; 2]),
}

impl Branches {
    pub(super) fn new(part: Part, plot: &Plot) -> Branches {
        let mut branches = Branches { all: Vec::new() };
        branches.divide(part, plot);
        branches
    }

    /// Splits a part until leaves are left; tells its number, which is the last.
    fn divide(&mut self, mut part: Part, plot: &Plot) -> usize {
        let (bounds, weight) = (part.bounds.bounds(), part.bounds.half_area());
        while part.items.len() > plot.most() {
            match split(part, plot) {
                Split::Halves([left, right]) => {
                    let halves = [self.divide(left, plot), self.divide(right, plot)];
                    let costs = self.costs(weight, halves);
                    return self.add(Branch { bounds, costs, kind: BranchKind::Fork(halves) });
                }
                Split::Distinct(distinct) => part = distinct,
            }
        }
        let count = part.items.len();
        let (kind, different) = if plot.round {
            (Kind::Spheres, count)
        } else {
            let corners = &mut Corners::new(plot.scene);
            let is_patch = Gathered::new(part.items, corners).is_some();
            let kind = if is_patch { Kind::Patch } else { Kind::Triangles };
            (kind, put_twins_last(part.items, corners))
        };
        let first = u32::try_from(part.first).expect("ids are u32");
        let leaf = LeafRange { first, count: u8::try_from(count).expect("sixteen at most") };
        let kind = BranchKind::Leaf(leaf, kind, Counts::new(count, different));
        self.add(Branch { bounds: part.bounds.bounds(), costs: [0.0; WIDTH], kind })
    }

    fn add(&mut self, branch: Branch) -> usize {
        self.all.push(branch);
        self.all.len() - 1
    }

    /// The costs of two halves together: as a node of such a weight, or as more children of another.
    fn costs(&self, weight: f64, halves: [usize; 2]) -> [f64; WIDTH] {
        let mut costs = [0.0; WIDTH];
        costs[0] = weight + self.cheapest_share(halves, WIDTH).1;
        for children in 2..=WIDTH {
            let shared = self.cheapest_share(halves, children).1;
            costs[children - 1] = shared.min(costs[children - 2]);
        }
        costs
    }

    /// How many of so many children the first of two halves gets if that is cheapest, and the cost.
    fn cheapest_share(&self, [left, right]: [usize; 2], children: usize) -> (usize, f64) {
        let (left, right) = (&self.all[left].costs, &self.all[right].costs);
        let mut best = (1, f64::INFINITY);
        for share in 1..children {
            let cost = left[share - 1] + right[children - share - 1];
            if cost < best.1 {
                best = (share, cost);
            }
        }
        best
    }

    /// Puts its nodes and leaves into an arena; tells which is the first.
    pub(super) fn place(&self, arena: &mut Arena) -> (Child, Counts) {
        self.place_branch(self.all.len() - 1, arena)
    }

    fn place_branch(&self, branch: usize, arena: &mut Arena) -> (Child, Counts) {
        let halves = match self.all[branch].kind {
            BranchKind::Leaf(leaf, kind, counts) => {
                let leaves = &mut arena.leaves[kind as usize];
                leaves.push(leaf);
                return (Child::new(kind, leaves.len() - 1), counts);
            }
            BranchKind::Fork(halves) => halves,
        };
        let index = arena.nodes.len();
        arena.nodes.push(Node::empty());
        let mut children = Vec::with_capacity(WIDTH);
        self.share(halves, WIDTH, &mut children);
        for branch in children {
            let (child, counts) = self.place_branch(branch, arena);
            arena.attach(index, &self.all[branch].bounds, child, counts);
        }
        (Child::new(Kind::Node, index), Counts::default())
    }

    /// Which branches two halves become as so many children of a node, or fewer; as many as cost no more.
    fn share(&self, halves: [usize; 2], children: usize, into: &mut Vec<usize>) {
        let (first, _) = self.cheapest_share(halves, children);
        for (half, most) in halves.into_iter().zip([first, children - first]) {
            let Branch { costs, kind, .. } = &self.all[half];
            let BranchKind::Fork(halves) = *kind else {
                into.push(half);
                continue;
            };
            let is_cheap =
                |children: &usize| self.cheapest_share(halves, *children).1 <= costs[most - 1];
            match (2..=most).rev().find(is_cheap) {
                Some(children) => self.share(halves, children, into),
                None => into.push(half),
            }
        }
    }
}
