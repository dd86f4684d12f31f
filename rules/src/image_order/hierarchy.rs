//! A hierarchy of boxes: median splits along the longest side, and a margin for the rounding of every rule.

use super::shape::Shape;
use bothways_common::{Ray, Scene, Shape as Form, Triangle};
use glam::{DVec3, Vec3};

/// A scene's primitives in boxes, and those that have no box.
#[derive(Debug)]
pub(super) struct Hierarchy {
    nodes: Vec<Node>,
    items: Vec<Item>,
    /// Planes.
    endless: Vec<Item>,
}

#[derive(Clone, Copy, Debug)]
struct Item {
    id: u32,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// The items of a leaf. An inner node has none, and its first child follows it.
    items: [u32; 2],
    second: u32,
}

/// The most items of a leaf.
const LEAF: usize = 4;
/// Boxes grow by this part of their largest coordinate and of the eye's: 64 roundings of an `f32`, more than any of the
/// tests makes.
const MARGIN: f64 = 64.0 * (f32::EPSILON as f64);

impl Hierarchy {
    pub(super) fn new(scene: &Scene) -> Hierarchy {
        let (mut items, mut endless) = (Vec::new(), Vec::new());
        assert!(!scene.has_wide_ids(), "rules draw narrow ids alone");
        let mut id = 0;
        let mut add = |shape: Shape| {
            let item = Item { id, shape };
            if let Shape::Plane { .. } = shape {
                endless.push(item)
            } else {
                items.push(item)
            }
            id += 1;
        };
        for object in scene.objects() {
            match &object.shape {
                Form::Triangle(Triangle { a, b, c }) => add(Shape::Triangle([*a, *b, *c])),
                Form::Sphere(sphere) => {
                    add(Shape::Sphere { center: sphere.center, radius: sphere.radius });
                }
                Form::Plane(plane) => {
                    add(Shape::Plane { point: plane.point, normal: plane.normal })
                }
                Form::Mesh(mesh) => {
                    (0..mesh.triangles().len())
                        .for_each(|local| add(Shape::Triangle(mesh.corners(local))));
                }
                Form::Instances(instances) => {
                    (0..instances.primitive_count())
                        .for_each(|local| add(Shape::Triangle(instances.corners(local))));
                }
            }
        }
        let mut hierarchy = Hierarchy { nodes: Vec::new(), items, endless };
        let count = hierarchy.items.len();
        if count > 0 {
            hierarchy.split(0, count);
        }
        hierarchy
    }

    /// Adds the node of these items, and its children behind it.
    fn split(&mut self, first: usize, end: usize) {
        let items = &mut self.items[first..end];
        let boxes = items.iter().map(Item::bounds);
        let (low, high) = boxes.reduce(joined).expect("a node has items");
        let index = self.nodes.len();
        #[expect(clippy::cast_possible_truncation, reason = "primitives have ids of 32 bits")]
        let range = [first as u32, end as u32];
        let is_leaf = items.len() <= LEAF;
        let range = if is_leaf { range } else { [0; 2] };
        self.nodes.push(Node { low, high, items: range, second: 0 });
        if is_leaf {
            return;
        }
        let axis = longest(items);
        let middle = items.len() / 2;
        items.select_nth_unstable_by(middle, |one, other| {
            one.middle()[axis].total_cmp(&other.middle()[axis]).then(one.id.cmp(&other.id))
        });
        self.split(first, first + middle);
        #[expect(clippy::cast_possible_truncation, reason = "fewer nodes than primitives")]
        let second = self.nodes.len() as u32;
        self.nodes[index].second = second;
        self.split(first + middle, end);
    }

    /// Finds the nearest hit of a ray; of equal ones, the smallest id. `path` is the ray relative to the eye.
    pub(super) fn walk(
        &self,
        path: &Ray,
        eye: Vec3,
        nearest: &mut (f64, u32),
        hit: impl Fn(&Shape) -> Option<f64>,
    ) {
        let try_items = |items: &[Item], nearest: &mut (f64, u32)| {
            for item in items {
                if let Some(t) = hit(&item.shape)
                    && (t, item.id) < *nearest
                {
                    *nearest = (t, item.id);
                }
            }
        };
        try_items(&self.endless, nearest);
        if self.nodes.is_empty() {
            return;
        }
        let line = Line::new(path, eye);
        let mut open = vec![(0_usize, 0.0)];
        while let Some((index, enters)) = open.pop() {
            if enters > nearest.0 {
                continue;
            }
            let node = &self.nodes[index];
            if node.second == 0 {
                try_items(&self.items[node.items[0] as usize..node.items[1] as usize], nearest);
                continue;
            }
            let children = [index + 1, node.second as usize]
                .map(|child| line.enters(&self.nodes[child]).map(|enters| (child, enters)));
            match children {
                [Some(one), Some(other)] if one.1 <= other.1 => open.extend([other, one]),
                [one, other] => open.extend([one, other].into_iter().flatten()),
            }
        }
    }
}

impl Item {
    fn bounds(&self) -> (Vec3, Vec3) {
        match self.shape {
            Shape::Triangle([a, b, c]) => (a.min(b).min(c), a.max(b).max(c)),
            Shape::Sphere { center, radius } => (center - radius, center + radius),
            Shape::Plane { .. } => unreachable!("planes are in no box"),
        }
    }

    fn middle(&self) -> Vec3 {
        let (low, high) = self.bounds();
        0.5 * low + 0.5 * high
    }
}

fn joined((low, high): (Vec3, Vec3), (lower, higher): (Vec3, Vec3)) -> (Vec3, Vec3) {
    (low.min(lower), high.max(higher))
}

/// The axis along which the middles of items lie farthest apart.
fn longest(items: &[Item]) -> usize {
    let middles = items.iter().map(Item::middle);
    let (low, high) =
        middles.map(|middle| (middle, middle)).reduce(joined).expect("a node has items");
    (high - low).max_position()
}

/// A ray in the world, in `f64`, ready to meet boxes.
struct Line {
    origin: DVec3,
    inverse: DVec3,
    eye: f64,
}

impl Line {
    fn new(path: &Ray, eye: Vec3) -> Line {
        let eye = eye.as_dvec3();
        let origin = eye + path.origin;
        Line { origin, inverse: path.direction.recip(), eye: origin.abs().max_element() }
    }

    /// The `t` from which on the ray lies in a box with its margin, if it meets it; not farther than any hit in it.
    fn enters(&self, node: &Node) -> Option<f64> {
        let (low, high) = (node.low.as_dvec3(), node.high.as_dvec3());
        let largest = low.abs().max(high.abs()).max_element() + self.eye;
        let margin = DVec3::splat(MARGIN * largest);
        let one = (low - margin - self.origin) * self.inverse;
        let other = (high + margin - self.origin) * self.inverse;
        // A ray within a side's plane divides zero by zero; glam's min and max may keep that, f64's do not.
        let (mut from, mut to) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            from = from.max(one[axis].min(other[axis]));
            to = to.min(one[axis].max(other[axis]));
        }
        // Rounded hits may lie a little before the box.
        (from <= to).then_some(from * (1.0 - MARGIN))
    }
}
