//! The hierarchy as the walk reads it: nodes of eight boxes, leaves of eight triangles, all as structures
//! of arrays.

use bothways_common::Primitive;
use bothways_common::View;
use glam::Vec3;

/// Boxes in a node, and triangles in a leaf.
pub(super) const WIDTH: usize = 8;

/// Eight boxes, and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Low x, y, z and high x, y, z of each box: coordinates of the scene, or rounded outward.
    pub(super) bounds: [[f32; WIDTH]; 6],
    pub(super) children: [Child; WIDTH],
    /// Of a leaf, how many primitives it has, and behind how many begin those that are the same triangle
    /// as an earlier one: `16·all + different`.
    pub(super) counts: [u8; WIDTH],
    pub(super) used: u8,
    /// Whether there are only leaves in it.
    pub(super) bottom: bool,
}

/// A node or a leaf: its kind in two bits, its number in the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

/// What a child is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    Triangles,
    Spheres,
}

/// Up to eight triangles, as they are stored in the world: x, y, z of the first corners, of the second,
/// of the third. Unused ones repeat the first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Leaf {
    pub(super) corners: [[f32; WIDTH]; 9],
    pub(super) ids: [u32; WIDTH],
}

/// An axis-aligned box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Bounds {
    pub(super) const EMPTY: Bounds = Bounds { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    pub(super) fn with(self, other: &Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

impl Child {
    const BITS: u32 = 30;

    pub(super) fn new(kind: Kind, index: usize) -> Child {
        let index = u32::try_from(index).ok().filter(|index| index >> Self::BITS == 0);
        let index = index.expect("a scene with more nodes does not fit in memory");
        Child((kind as u32) << Self::BITS | index)
    }

    #[inline(always)]
    pub(super) fn kind(self) -> Kind {
        match self.0 >> Self::BITS {
            0 => Kind::Node,
            1 => Kind::Triangles,
            _ => Kind::Spheres,
        }
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 & ((1 << Self::BITS) - 1)) as usize
    }

    /// The child of a part of the hierarchy that was built by itself, once nodes and leaves precede it.
    pub(super) fn moved(self, nodes: usize, leaves: usize) -> Child {
        let by = if self.kind() == Kind::Node { nodes } else { leaves };
        Child::new(self.kind(), self.index() + by)
    }
}

impl Node {
    pub(super) fn empty() -> Node {
        Node {
            bounds: [[0.0; WIDTH]; 6],
            children: [Child(0); WIDTH],
            counts: [0; WIDTH],
            used: 0,
            bottom: true,
        }
    }

    pub(super) fn push(&mut self, bounds: &Bounds, child: Child) {
        let lane = usize::from(self.used);
        for axis in 0..3 {
            self.bounds[axis][lane] = bounds.low[axis];
            self.bounds[3 + axis][lane] = bounds.high[axis];
        }
        self.children[lane] = child;
        self.bottom &= child.kind() != Kind::Node;
        self.used += 1;
    }
}

impl Leaf {
    pub(super) fn corners(&self, lane: usize) -> [Vec3; 3] {
        std::array::from_fn(|corner| {
            Vec3::from_array(std::array::from_fn(|axis| self.corners[3 * corner + axis][lane]))
        })
    }

    /// One of its triangles relative to the eye.
    pub(super) fn primitive(&self, view: &View, lane: usize) -> Primitive {
        Primitive::Triangle(self.corners(lane).map(|corner| view.offset(corner)))
    }
}
