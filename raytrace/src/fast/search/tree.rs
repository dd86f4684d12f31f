//! The hierarchy as the walk reads it, a wide BVH: nodes of sixteen boxes, leaves of up to sixteen triangles, all as
//! structures of arrays.

use glam::Vec3;

/// Boxes in a node.
pub(crate) const WIDTH: usize = 16;
/// Triangles in a leaf at most, and vertices of an indexed leaf.
pub(crate) const LEAF: usize = 16;
/// Spheres in a leaf at most.
pub(crate) const SPHERES: usize = 8;
/// Instances of meshes in a leaf at most. With half as many there are twice as many nodes, 13 bytes an instance.
pub(crate) const INSTANCES: usize = 8;

/// Sixteen boxes, and the node or leaf in each.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Low x, y, z and high x, y, z of each box: coordinates of the scene, or rounded outward.
    pub(crate) bounds: [[f32; WIDTH]; 6],
    pub(crate) children: [NodeRef; WIDTH],
    pub(crate) counts: [LeafCounts; WIDTH],
    pub(crate) used: u8,
    /// Whether all its children are leaves of triangles.
    pub(crate) only_triangles: bool,
}

/// Refers to a node, a leaf or an instance: its kind in three bits, its index in the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NodeRef(u32);

/// What a [`NodeRef`] refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NodeKind {
    IndexedLeaf,
    ScatteredLeaf,
    PlainLeaf,
    Spheres,
    Instances,
    Node,
    /// One instance of a mesh, by its number.
    Instance,
}

impl NodeKind {
    /// Whether it is a leaf of triangles.
    #[inline(always)]
    pub(crate) fn holds_triangles(self) -> bool {
        matches!(self, NodeKind::IndexedLeaf | NodeKind::ScatteredLeaf | NodeKind::PlainLeaf)
    }
}

/// How many kinds of leaves there are: all kinds before nodes.
pub(crate) const LEAF_KINDS: usize = NodeKind::Node as usize;

/// How many primitives a leaf has, and how many of them are distinct: duplicates of a triangle come behind these. Both
/// less one, in four bits each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LeafCounts(u8);

/// A leaf of triangles that share their vertices, as those of most meshes do. Unused lanes repeat the first triangle.
///
/// It takes four lines of the cache: a frame of a large mesh waits for its leaves.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct IndexedLeaf {
    /// x, y and z of the vertices, as they are stored in the world.
    pub(crate) vertices: [[f32; LEAF]; 3],
    /// For each triangle, the indices of its vertices `a`, `b` and `c` in the lowest bits, four bits each, and above them its id,
    /// [packed](super::packed_ids). The ids of a scattered leaf are 0 here.
    pub(crate) triangles: [u32; LEAF],
}

/// An indexed leaf of triangles whose ids lie too far from each other to be packed.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct ScatteredLeaf {
    pub(crate) indexed: IndexedLeaf,
    pub(crate) ids: [u32; LEAF],
}

/// A leaf of triangles with too many vertices for an indexed leaf. Unused lanes repeat the first triangle.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct PlainLeaf {
    /// x, y, z of the first corners, of the second, of the third.
    pub(crate) corners: [[f32; LEAF]; 9],
    pub(crate) ids: [u32; LEAF],
}

/// An axis-aligned box in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

impl Bounds {
    pub(crate) const EMPTY: Bounds = Bounds { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    /// The middle, computed from halves, so that it is finite.
    pub(crate) fn middle(&self) -> Vec3 {
        0.5 * self.low + 0.5 * self.high
    }

    pub(crate) fn union(self, other: &Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

impl NodeRef {
    const BITS: u32 = 29;

    pub(crate) fn new(kind: NodeKind, index: usize) -> NodeRef {
        let index = u32::try_from(index).ok().filter(|index| index >> Self::BITS == 0);
        let index = index.expect("a scene with more nodes does not fit in memory");
        NodeRef((kind as u32) << Self::BITS | index)
    }

    #[inline(always)]
    pub(crate) fn kind(self) -> NodeKind {
        match self.0 >> Self::BITS {
            0 => NodeKind::IndexedLeaf,
            1 => NodeKind::ScatteredLeaf,
            2 => NodeKind::PlainLeaf,
            3 => NodeKind::Spheres,
            4 => NodeKind::Instances,
            5 => NodeKind::Node,
            _ => NodeKind::Instance,
        }
    }

    #[inline(always)]
    pub(crate) fn index(self) -> usize {
        (self.0 & ((1 << Self::BITS) - 1)) as usize
    }

    /// The same reference in a hierarchy in which this many more nodes, and leaves of each kind, precede it.
    pub(crate) fn shifted(self, nodes: usize, leaves: [usize; LEAF_KINDS]) -> NodeRef {
        let kind = self.kind();
        let by = leaves.get(kind as usize).copied().unwrap_or(nodes);
        NodeRef::new(kind, self.index() + by)
    }
}

impl Node {
    pub(crate) fn empty() -> Node {
        Node {
            bounds: [[0.0; WIDTH]; 6],
            children: [NodeRef(0); WIDTH],
            counts: [LeafCounts::default(); WIDTH],
            used: 0,
            only_triangles: true,
        }
    }

    /// The box of one of its children.
    pub(crate) fn bounds_of(&self, lane: usize) -> Bounds {
        let side =
            |first: usize| Vec3::from_array([0, 1, 2].map(|axis| self.bounds[first + axis][lane]));
        Bounds { low: side(0), high: side(3) }
    }

    pub(crate) fn push(&mut self, bounds: &Bounds, child: NodeRef) {
        let lane = usize::from(self.used);
        for axis in 0..3 {
            self.bounds[axis][lane] = bounds.low[axis];
            self.bounds[3 + axis][lane] = bounds.high[axis];
        }
        self.children[lane] = child;
        self.only_triangles &= child.kind().holds_triangles();
        self.used += 1;
    }
}

impl LeafCounts {
    /// For `1 ≤ distinct ≤ all ≤ 16`.
    pub(crate) fn new(all: usize, distinct: usize) -> LeafCounts {
        let less_one = |count: usize| u8::try_from(count - 1).ok().filter(|less| *less < 16);
        let [all, distinct] =
            [all, distinct].map(|count| less_one(count).expect("sixteen at most"));
        LeafCounts(all << 4 | distinct)
    }

    #[inline(always)]
    pub(crate) fn all(self) -> usize {
        usize::from(self.0 >> 4) + 1
    }

    #[inline(always)]
    pub(crate) fn distinct(self) -> usize {
        usize::from(self.0 & 15) + 1
    }
}
