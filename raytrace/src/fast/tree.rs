//! The hierarchy as the walk reads it: nodes of sixteen boxes, leaves of up to sixteen triangles, all as structures of
//! arrays.

use glam::Vec3;

/// Boxes in a node.
pub(super) const WIDTH: usize = 16;
/// Triangles in a leaf at most, and vertices of a patch.
pub(super) const LEAF: usize = 16;
/// Spheres in a leaf at most.
pub(super) const SPHERES: usize = 8;

/// Boxes, and what is in them.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// Low x, y, z and high x, y, z of each box: coordinates of the scene, or rounded outward.
    pub(super) bounds: [[f32; WIDTH]; 6],
    pub(super) children: [Child; WIDTH],
    pub(super) counts: [Counts; WIDTH],
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
    Patch,
    Triangles,
    Spheres,
    Node,
}

/// How many kinds of leaves there are: those before nodes.
pub(super) const LEAF_KINDS: usize = Kind::Node as usize;

/// How many primitives a leaf has, and behind how many begin those that are the same triangle as an earlier
/// one: both less one, in four bits each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts(u8);

/// A leaf of triangles that share their vertices, as those of most meshes do. Unused ones repeat the first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Patch {
    /// x, y and z of the vertices, as they are stored in the world.
    pub(super) vertices: [[f32; LEAF]; 3],
    /// Of each triangle the vertices `a`, `b`, `c`: at which byte of the rows they begin, four times their number.
    /// The last byte is 0.
    pub(super) corners: [[u8; 4]; LEAF],
    pub(super) ids: [u32; LEAF],
}

/// A leaf of triangles that have more vertices. Unused ones repeat the first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Triangles {
    /// x, y, z of the first corners, of the second, of the third.
    pub(super) corners: [[f32; LEAF]; 9],
    pub(super) ids: [u32; LEAF],
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
            0 => Kind::Patch,
            1 => Kind::Triangles,
            2 => Kind::Spheres,
            _ => Kind::Node,
        }
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 & ((1 << Self::BITS) - 1)) as usize
    }

    /// The child of a part of the hierarchy that was built by itself, once so many nodes and leaves of each kind
    /// precede it.
    pub(super) fn moved(self, nodes: usize, leaves: [usize; LEAF_KINDS]) -> Child {
        let kind = self.kind();
        let by = leaves.get(kind as usize).copied().unwrap_or(nodes);
        Child::new(kind, self.index() + by)
    }
}

impl Node {
    pub(super) fn empty() -> Node {
        Node {
            bounds: [[0.0; WIDTH]; 6],
            children: [Child(0); WIDTH],
            counts: [Counts::default(); WIDTH],
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

impl Counts {
    /// `1 ≤ different ≤ all ≤ 16`.
    pub(super) fn new(all: usize, different: usize) -> Counts {
        let less_one = |count: usize| u8::try_from(count - 1).ok().filter(|less| *less < 16);
        let [all, different] =
            [all, different].map(|count| less_one(count).expect("sixteen at most"));
        Counts(all << 4 | different)
    }

    #[inline(always)]
    pub(super) fn all(self) -> usize {
        usize::from(self.0 >> 4) + 1
    }

    #[inline(always)]
    pub(super) fn different(self) -> usize {
        usize::from(self.0 & 15) + 1
    }
}
