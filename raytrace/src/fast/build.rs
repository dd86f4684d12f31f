//! The hierarchy: boxes around boxes around primitives, split where that is expected to be cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007.

use bothways_common::{Plane, Scene, Shape, Sphere, Triangle};
use glam::{DVec3, Vec3};

/// At most this many primitives in a leaf.
const LEAF: usize = 4;
/// Candidate splits along an axis, plus one.
const BINS: usize = 16;
/// Parts with fewer primitives are built by one thread.
const SERIAL: usize = 8192;
/// From this depth on a part is halved by count, which bounds the depth of any hierarchy.
const DEEP: usize = 48;

/// What a moving camera would not repeat: the hierarchy over all bounded primitives.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) nodes: Vec<Node>,
    /// The primitives of the leaves.
    pub(super) leaves: Vec<Leaf>,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and of each the extent that its box's margin was made for; see [`sphere`].
    pub(super) spheres: Vec<(u32, f32)>,
    pub(super) primitives: u32,
}

/// An inner node: two children, each with its box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) bounds: [Bounds; 2],
    pub(super) children: [Child; 2],
}

/// What a box contains.
#[derive(Clone, Copy, Debug)]
pub(super) enum Child {
    Node(u32),
    /// Some consecutive leaf primitives.
    Leaf {
        first: u32,
        count: u32,
    },
}

/// A primitive where the walk needs it, as it is stored in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub(super) id: u32,
    pub(super) form: Form,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    Triangle([Vec3; 3]),
    Sphere(Vec3, f32),
}

/// An axis-aligned box in the world. Its corners are coordinates of the scene or rounded outward.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

/// A primitive while the hierarchy is built.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    leaf: Leaf,
}

impl Bounds {
    const EMPTY: Bounds = Bounds { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn with(self, other: &Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The middle, taken in halves so that it is finite.
    fn middle(&self) -> Vec3 {
        0.5 * self.low + 0.5 * self.high
    }

    /// Half of the surface area: proportional to the chance that a ray meets the box. In `f64`,
    /// where no finite box overflows.
    fn half_area(&self) -> f64 {
        let size = (self.high.as_dvec3() - self.low.as_dvec3()).max(DVec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

pub(super) fn build(scene: &Scene) -> Prepared {
    let Collected { mut items, unbounded, spheres } = collect(scene);
    let mut arena = Arena::default();
    if !items.is_empty() {
        let bounds = around(&items);
        // The walk begins at a node: a lone leaf gets one, its other child empty.
        if let root @ Child::Leaf { .. } = arena.grow(&mut items, &bounds, 0) {
            let children = [root, Child::Leaf { first: 0, count: 0 }];
            arena.nodes.push(Node { bounds: [bounds, Bounds::EMPTY], children });
        }
    }
    let Arena { nodes, leaves } = arena;
    Prepared { nodes, leaves, unbounded, spheres, primitives: scene.primitive_count() }
}

/// The primitives of a scene, sorted by whether a box can bound them.
#[derive(Default)]
struct Collected {
    items: Vec<Item>,
    unbounded: Vec<u32>,
    spheres: Vec<(u32, f32)>,
}

fn collect(scene: &Scene) -> Collected {
    let mut all = Collected::default();
    all.items.reserve_exact(scene.primitive_count() as usize);
    for (index, object) in scene.objects().iter().enumerate() {
        let first_id = scene.first_id(index);
        match &object.shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                all.items.push(triangle(first_id, [*a, *b, *c]));
            }
            Shape::Mesh(mesh) => {
                let corners = (0..mesh.triangles().len()).map(|local| mesh.corners(local));
                let triangles = (first_id..).zip(corners);
                all.items.extend(triangles.map(|(id, corners)| triangle(id, corners)));
            }
            Shape::Sphere(ball) => match sphere(first_id, ball) {
                Some((item, extent)) => {
                    all.items.push(item);
                    all.spheres.push((first_id, extent));
                }
                None => all.unbounded.push(first_id),
            },
            Shape::Plane(Plane { .. }) => all.unbounded.push(first_id),
        }
    }
    all
}

fn triangle(id: u32, corners: [Vec3; 3]) -> Item {
    let [a, b, c] = corners;
    let bounds = Bounds { low: a.min(b).min(c), high: a.max(b).max(c) };
    Item { bounds, leaf: Leaf { id, form: Form::Triangle(corners) } }
}

/// A sphere in its box, and its extent `e = max|center| + radius`; `None` if a corner of the box is
/// not finite.
///
/// A sphere is judged by its rounded offset from the eye, and so is each side of its box: a vertex is
/// a side's coordinate or lies within, and stays within, but `center ± radius` was never stored. The
/// box is therefore wider by 2⁻¹⁸·e. That is more than all roundings of the offsets (and of the box
/// itself) as long as the eye is nearer to the origin than 2³⁰·e: two of at most 2⁻²³·e each, and 2⁻²¹·e.
/// The walk tests spheres without their boxes, too, when the eye is farther.
fn sphere(id: u32, &Sphere { center, radius }: &Sphere) -> Option<(Item, f32)> {
    let extent = center.abs().max_element() + radius;
    let half = Vec3::splat(radius + (-18f32).exp2() * extent);
    let bounds = Bounds { low: center - half, high: center + half };
    let finite = bounds.low.is_finite() && bounds.high.is_finite();
    let leaf = Leaf { id, form: Form::Sphere(center, radius) };
    // Below this, the margin itself would underflow.
    let representable = extent > (-100f32).exp2();
    (finite && representable).then_some((Item { bounds, leaf }, extent))
}

fn around(items: &[Item]) -> Bounds {
    items.iter().fold(Bounds::EMPTY, |bounds, item| bounds.with(&item.bounds))
}

/// Nodes and leaves of the hierarchy, or of a part of it, in depth-first order.
#[derive(Default)]
struct Arena {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

impl Arena {
    /// Builds the hierarchy over some primitives and says where it begins.
    fn grow(&mut self, items: &mut [Item], bounds: &Bounds, depth: usize) -> Child {
        let Some(middle) = split(items, bounds, depth) else {
            let child = Child::Leaf { first: index(self.leaves.len()), count: index(items.len()) };
            self.leaves.extend(items.iter().map(|item| item.leaf));
            return child;
        };
        let parallel = items.len() >= SERIAL;
        let (left, right) = items.split_at_mut(middle);
        let bounds = [around(left), around(right)];
        let node = self.nodes.len();
        // The children are known once they are built; until then the node names itself.
        self.nodes.push(Node { bounds, children: [Child::Node(index(node)); 2] });
        let children = if parallel {
            let mut beside = Arena::default();
            let (left, right) = rayon::join(
                || self.grow(left, &bounds[0], depth + 1),
                || beside.grow(right, &bounds[1], depth + 1),
            );
            [left, self.append(beside, right)]
        } else {
            [self.grow(left, &bounds[0], depth + 1), self.grow(right, &bounds[1], depth + 1)]
        };
        self.nodes[node].children = children;
        Child::Node(index(node))
    }

    /// Takes in a part that was built beside this one, and says where it begins now.
    fn append(&mut self, part: Arena, root: Child) -> Child {
        let (nodes, leaves) = (index(self.nodes.len()), index(self.leaves.len()));
        let moved = |child: Child| match child {
            Child::Node(node) => Child::Node(node + nodes),
            Child::Leaf { first, count } => Child::Leaf { first: first + leaves, count },
        };
        let moved_node = |node: Node| Node { children: node.children.map(moved), ..node };
        self.nodes.extend(part.nodes.into_iter().map(moved_node));
        self.leaves.extend(part.leaves);
        moved(root)
    }
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("there are no more nodes and leaves than ids")
}

/// Orders primitives into two parts and gives the number in the first; `None` for a leaf.
fn split(items: &mut [Item], bounds: &Bounds, depth: usize) -> Option<usize> {
    if items.len() < 2 {
        return None;
    }
    let middles = items.iter().fold(Bounds::EMPTY, |bounds, item| {
        let middle = item.bounds.middle();
        bounds.with(&Bounds { low: middle, high: middle })
    });
    let best = cheapest_plane(items, &middles).filter(|_| depth < DEEP);
    // One primitive costs one; a node with its two boxes about as much.
    let leaf_cost = as_real(items.len());
    let area = bounds.half_area();
    let cost = best.map_or(f64::INFINITY, |plane| 1.0 + plane.cost / area.max(f64::MIN_POSITIVE));
    if items.len() <= LEAF && leaf_cost <= cost {
        return None;
    }
    let Some(plane) = best else {
        // All in one place, or too deep: any half is as good as any other.
        return Some(items.len() / 2);
    };
    let mut first = 0;
    for k in 0..items.len() {
        if plane.bin_of(&items[k], &middles) < plane.bin {
            items.swap(first, k);
            first += 1;
        }
    }
    Some(first)
}

/// A split: primitives whose middle lies in a bin before this one, along one axis, go first.
#[derive(Clone, Copy)]
struct SplitPlane {
    axis: usize,
    bin: usize,
    /// The sum over both parts of half their area times their number of primitives.
    cost: f64,
}

impl SplitPlane {
    fn bin_of(&self, item: &Item, middles: &Bounds) -> usize {
        bin(item.bounds.middle()[self.axis], middles, self.axis)
    }
}

/// The split that the surface area heuristic likes best; `None` if all middles are in one place.
fn cheapest_plane(items: &[Item], middles: &Bounds) -> Option<SplitPlane> {
    let mut best: Option<SplitPlane> = None;
    for axis in (0..3).filter(|&axis| middles.low[axis] < middles.high[axis]) {
        let mut bins = [(0_usize, Bounds::EMPTY); BINS];
        for item in items {
            let (count, bounds) = &mut bins[bin(item.bounds.middle()[axis], middles, axis)];
            *count += 1;
            *bounds = bounds.with(&item.bounds);
        }
        // From the right, the cost of what lies at or beyond each bin; then from the left.
        let mut beyond = [0.0; BINS];
        let (mut count, mut bounds) = (0, Bounds::EMPTY);
        for k in (1..BINS).rev() {
            count += bins[k].0;
            bounds = bounds.with(&bins[k].1);
            beyond[k] = as_real(count) * bounds.half_area();
        }
        let (mut count, mut bounds) = (0, Bounds::EMPTY);
        for k in 1..BINS {
            count += bins[k - 1].0;
            bounds = bounds.with(&bins[k - 1].1);
            let cost = as_real(count) * bounds.half_area() + beyond[k];
            let useful = count > 0 && count < items.len();
            if useful && best.is_none_or(|best| cost < best.cost) {
                best = Some(SplitPlane { axis, bin: k, cost });
            }
        }
    }
    best
}

/// The bin of a middle along an axis along which middles differ.
fn bin(middle: f32, middles: &Bounds, axis: usize) -> usize {
    let (low, high) = (f64::from(middles.low[axis]), f64::from(middles.high[axis]));
    let part = (f64::from(middle) - low) / (high - low);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 1, and the conversion saturates"
    )]
    let bin = (part * as_real(BINS)) as usize;
    bin.min(BINS - 1)
}

#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
fn as_real(count: usize) -> f64 {
    count as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::{Mesh, Object};

    fn mesh(positions: Vec<Vec3>) -> Scene {
        let count = u32::try_from(positions.len()).unwrap();
        let triangles = (0..count / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let object: Object = Shape::Mesh(Mesh::new(positions, triangles).unwrap()).into();
        Scene::new(vec![object]).unwrap()
    }

    /// The depth of the hierarchy and the ids in it; checks that boxes hold what is under them.
    fn inspect(prepared: &Prepared) -> (usize, Vec<u32>) {
        let (mut deepest, mut ids) = (0, Vec::new());
        let mut open = vec![(Child::Node(0), Bounds::EMPTY.with(&prepared.nodes[0].bounds[0]), 0)];
        open[0].1 = open[0].1.with(&prepared.nodes[0].bounds[1]);
        while let Some((child, bounds, depth)) = open.pop() {
            deepest = deepest.max(depth);
            let holds = |inner: &Bounds| {
                inner.low.cmpge(bounds.low).all() && inner.high.cmple(bounds.high).all()
            };
            match child {
                Child::Node(node) => {
                    let Node { bounds, children } = &prepared.nodes[node as usize];
                    for (child, bounds) in children.iter().zip(bounds) {
                        assert!(holds(bounds) || bounds.low.x > bounds.high.x);
                        open.push((*child, *bounds, depth + 1));
                    }
                }
                Child::Leaf { first, count } => {
                    for leaf in &prepared.leaves[first as usize..(first + count) as usize] {
                        let Form::Triangle(corners) = leaf.form else { panic!("only triangles") };
                        assert!(holds(&triangle(0, corners).bounds));
                        ids.push(leaf.id);
                    }
                }
            }
        }
        ids.sort_unstable();
        (deepest, ids)
    }

    #[test]
    fn every_primitive_is_in_one_leaf() {
        let corner =
            |k: u32| Vec3::new((k * 37 % 101) as f32, (k * 53 % 97) as f32, (k % 89) as f32);
        let scene = mesh((0..3000 * 3).map(corner).collect());
        let (depth, ids) = inspect(&build(&scene));
        assert_eq!(ids, (0..3000).collect::<Vec<_>>());
        assert!(depth < 30, "{depth}");
    }

    #[test]
    fn coincident_triangles_are_halved() {
        let scene = mesh([Vec3::ZERO, Vec3::X, Vec3::Y].repeat(100_000));
        let (depth, ids) = inspect(&build(&scene));
        assert_eq!(ids.len(), 100_000);
        assert!(depth <= 17, "{depth}");
    }

    #[test]
    fn triangles_ever_smaller_do_not_nest_without_end() {
        let corner =
            |k: usize| Vec3::splat((-(k as f32)).exp2()) * [Vec3::X, Vec3::Y, Vec3::Z][k % 3];
        let scene = mesh((0..3 * 140).map(|k| corner(k / 3 + k % 3)).collect());
        let (depth, ids) = inspect(&build(&scene));
        assert_eq!(ids.len(), 140);
        assert!(depth <= DEEP + 8, "{depth}");
    }

    #[test]
    fn a_scene_may_have_nothing_to_bound() {
        let plane = Shape::Plane(Plane { point: Vec3::ZERO, normal: Vec3::Y });
        let huge = Shape::Sphere(Sphere { center: Vec3::splat(3e38), radius: 3e38 });
        let prepared = build(&Scene::new(vec![plane.into(), huge.into()]).unwrap());
        assert!(prepared.nodes.is_empty());
        assert_eq!(prepared.unbounded, [0, 1]);
        assert!(build(&Scene::new(vec![]).unwrap()).unbounded.is_empty());
    }
}
