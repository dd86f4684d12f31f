//! Building the hierarchy: boxes around boxes around primitives, split where that is expected to be
//! cheapest.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IEEE Symposium on
//! Interactive Ray Tracing, 2007; eight boxes a node as in Wald, Benthin and Boulos, "Getting Rid of
//! Packets", same venue, 2008.

use super::tree::{Bounds, Child, Kind, Leaf, Node, WIDTH};
use bothways_common::predicate::are_same_corners;
use bothways_common::simd::{Level, best_level};
use bothways_common::{Mesh, Plane, Scene, Shape, Sphere, Triangle};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// Candidate splits along an axis, plus one.
const BINS: usize = 16;
/// Parts with fewer primitives are built by one thread.
const SERIAL: usize = 4096;
/// Bins of parts with more primitives are filled by all threads.
const LARGE: usize = 1 << 17;
/// From this depth on a part is halved by count, which bounds the depth of any hierarchy.
const DEEP: usize = 64;

/// What a moving camera would not repeat: the hierarchy over all bounded primitives.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub(super) nodes: Vec<Node>,
    /// Eight triangles each.
    pub(super) leaves: Vec<Leaf>,
    /// Where the walk begins: the triangles, and the spheres, as far as there are any.
    pub(super) roots: Vec<Child>,
    /// Around everything in the hierarchy.
    pub(super) bounds: Bounds,
    /// Planes, which no box bounds, and spheres too large for one.
    pub(super) unbounded: Vec<u32>,
    /// Spheres in boxes, and of each the extent that its box's margin was made for; see [`sphere`].
    pub(super) spheres: Vec<(u32, f32)>,
    /// The ids of the spheres of the hierarchy's leaves, eight each; unused ones repeat the first.
    pub(super) round: Vec<[u32; WIDTH]>,
    pub(super) primitives: u32,
    pub(super) level: Level,
    pub(super) side: usize,
}

/// A primitive while the hierarchy is built: its box, and in the fourth lane of the low corner the bits
/// of its id.
#[derive(Clone, Copy)]
struct Item {
    low: Vec4,
    high: Vec4,
}

impl Item {
    fn new(bounds: &Bounds, id: u32) -> Item {
        Item { low: bounds.low.extend(f32::from_bits(id)), high: bounds.high.extend(0.0) }
    }

    fn id(&self) -> u32 {
        self.low.w.to_bits()
    }

    /// The middle, taken in halves so that it is finite. Without the id: most are denormal numbers, and
    /// to multiply these takes a hundred times as long.
    #[inline(always)]
    fn middle(&self) -> Vec4 {
        0.5 * self.low.with_w(0.0) + 0.5 * self.high
    }
}

/// Boxes in which the fourth lane means nothing.
#[derive(Clone, Copy)]
struct Box4 {
    low: Vec4,
    high: Vec4,
}

impl Box4 {
    const EMPTY: Box4 = Box4 { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };

    #[inline(always)]
    fn with(self, low: Vec4, high: Vec4) -> Box4 {
        Box4 { low: self.low.min(low), high: self.high.max(high) }
    }

    fn bounds(&self) -> Bounds {
        Bounds { low: self.low.truncate(), high: self.high.truncate() }
    }

    /// Half of the surface area: proportional to the chance that a ray meets the box. In `f64`, where
    /// no finite box overflows.
    fn half_area(&self) -> f64 {
        let size = (self.high.as_dvec4() - self.low.as_dvec4()).max(glam::DVec4::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// Some consecutive items, the box around them and the box around their middles.
struct Part<'a> {
    items: &'a mut [Item],
    bounds: Box4,
    middles: Box4,
    /// The number of the first item among all.
    first: usize,
    depth: usize,
    /// Whether triangles that are the same as an earlier one were left out.
    distinct: bool,
}

pub(super) fn build(scene: &Scene, side: usize) -> Prepared {
    let mut collected = collect(scene);
    let mut arena = Arena::default();
    let mut roots = Vec::new();
    let mut bounds = Bounds::EMPTY;
    let kinds = [Kind::Triangles, Kind::Spheres];
    for (kind, items) in kinds.into_iter().zip([&mut collected.triangles, &mut collected.round]) {
        if items.is_empty() {
            continue;
        }
        let all = Part::new(items, 0, 0, false);
        bounds = bounds.with(&all.bounds.bounds());
        let mut tree = Arena::default();
        tree.grow_node(all, &Plot { kind, scene });
        roots.push(arena.append(tree));
    }
    let triangle_leaves = arena.leaves.iter().filter(|leaf| leaf.kind == Kind::Triangles).count();
    let (flat, round) = arena.leaves.split_at(triangle_leaves);
    let first =
        |leaf: &LeafRange| leaf.first as usize..(leaf.first + u32::from(leaf.count)) as usize;
    let leaves = flat
        .par_iter()
        .with_min_len(64)
        .map_init(
            || Corners::new(scene),
            |corners, leaf| fill(&collected.triangles[first(leaf)], corners),
        )
        .collect();
    let round = round.iter().map(|leaf| {
        let items = &collected.round[first(leaf)];
        std::array::from_fn(|lane| items.get(lane).unwrap_or(&items[0]).id())
    });
    // Spheres' leaves are counted from 0 again.
    let mut nodes = arena.nodes;
    let renumbered = |child: &mut Child| {
        if child.kind() == Kind::Spheres {
            *child = Child::new(Kind::Spheres, child.index() - triangle_leaves);
        }
    };
    if round.len() > 0 {
        nodes.iter_mut().flat_map(|node| &mut node.children).for_each(renumbered);
    }
    Prepared {
        leaves,
        round: round.collect(),
        nodes,
        roots,
        bounds,
        unbounded: collected.unbounded,
        spheres: collected.spheres,
        primitives: scene.primitive_count(),
        level: best_level(),
        side,
    }
}

/// The primitives of a scene, sorted by whether a box can bound them.
#[derive(Default)]
struct Collected {
    triangles: Vec<Item>,
    round: Vec<Item>,
    unbounded: Vec<u32>,
    spheres: Vec<(u32, f32)>,
}

fn collect(scene: &Scene) -> Collected {
    let mut all = Collected::default();
    all.triangles.reserve_exact(scene.primitive_count() as usize);
    for (index, object) in scene.objects().iter().enumerate() {
        let first_id = scene.first_id(index);
        match &object.shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                all.triangles.push(triangle(first_id, [*a, *b, *c]));
            }
            Shape::Mesh(mesh) => {
                let triangles = mesh.triangles().par_iter().zip(first_id..u32::MAX);
                all.triangles.par_extend(
                    triangles.map(|(corners, id)| triangle(id, mesh_corners(mesh, corners))),
                );
            }
            Shape::Sphere(ball) => match sphere(first_id, ball) {
                Some((item, extent)) => {
                    all.round.push(item);
                    all.spheres.push((first_id, extent));
                }
                None => all.unbounded.push(first_id),
            },
            Shape::Plane(Plane { .. }) => all.unbounded.push(first_id),
        }
    }
    all
}

fn mesh_corners(mesh: &Mesh, corners: &[u32; 3]) -> [Vec3; 3] {
    corners.map(|vertex| mesh.positions()[vertex as usize])
}

fn triangle(id: u32, [a, b, c]: [Vec3; 3]) -> Item {
    Item::new(&Bounds { low: a.min(b).min(c), high: a.max(b).max(c) }, id)
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
    // Below this, the margin itself would underflow.
    let representable = extent > (-100f32).exp2();
    (finite && representable).then(|| (Item::new(&bounds, id), extent))
}

/// Finds the corners of triangles, which mostly come in the order of the scene.
struct Corners<'a> {
    scene: &'a Scene,
    ids: std::ops::Range<u32>,
    shape: Option<&'a Shape>,
}

impl<'a> Corners<'a> {
    fn new(scene: &'a Scene) -> Self {
        Corners { scene, ids: 0..0, shape: None }
    }

    fn of(&mut self, id: u32) -> [Vec3; 3] {
        if !self.ids.contains(&id) {
            let (object, _) = self.scene.locate(id);
            let shape = &self.scene.objects()[object].shape;
            let first = self.scene.first_id(object);
            let count = u32::try_from(shape.primitive_count()).expect("ids are u32");
            (self.ids, self.shape) = (first..first + count, Some(shape));
        }
        match self.shape {
            Some(Shape::Mesh(mesh)) => {
                mesh_corners(mesh, &mesh.triangles()[(id - self.ids.start) as usize])
            }
            Some(Shape::Triangle(Triangle { a, b, c })) => [*a, *b, *c],
            _ => unreachable!("leaves of triangles hold triangles"),
        }
    }
}

/// The leaf of some triangles.
fn fill(items: &[Item], corners: &mut Corners) -> Leaf {
    let mut leaf = Leaf { corners: [[0.0; WIDTH]; 9], ids: [items[0].id(); WIDTH] };
    for lane in 0..WIDTH {
        let id = items.get(lane).unwrap_or(&items[0]).id();
        leaf.ids[lane] = id;
        for (corner, position) in corners.of(id).into_iter().enumerate() {
            for axis in 0..3 {
                leaf.corners[3 * corner + axis][lane] = position[axis];
            }
        }
    }
    leaf
}

/// Orders the triangles of a leaf so that those which are the same as one with a smaller id, and so never
/// seen, come last; tells how many others there are.
fn put_twins_last(items: &mut [Item], corners: &mut Corners) -> usize {
    let box_of = |item: &Item| (item.low.truncate(), item.high.truncate());
    items.sort_unstable_by_key(Item::id);
    let mut different = 0;
    for k in 0..items.len() {
        let is_twin = |other: &Item| box_of(other) == box_of(&items[k]);
        let twin = items[..different].iter().any(|other| {
            is_twin(other) && are_same_corners(&corners.of(other.id()), &corners.of(items[k].id()))
        });
        if !twin {
            items[different..=k].rotate_right(1);
            different += 1;
        }
    }
    different
}

/// The items of a leaf.
#[derive(Clone, Copy)]
struct LeafRange {
    first: u32,
    count: u8,
    kind: Kind,
}

/// Nodes and leaves of the hierarchy, or of a part of it, in depth-first order.
#[derive(Default)]
struct Arena {
    nodes: Vec<Node>,
    leaves: Vec<LeafRange>,
}

/// What all parts of one hierarchy share.
struct Plot<'a> {
    kind: Kind,
    scene: &'a Scene,
}

impl<'a> Part<'a> {
    fn new(items: &'a mut [Item], first: usize, depth: usize, distinct: bool) -> Self {
        let (mut bounds, mut middles) = (Box4::EMPTY, Box4::EMPTY);
        for item in &*items {
            bounds = bounds.with(item.low, item.high);
            let middle = item.middle();
            middles = middles.with(middle, middle);
        }
        Part { items, bounds, middles, first, depth, distinct }
    }
}

impl Arena {
    /// Builds a node over some primitives: splits the part with the largest box until there are eight.
    fn grow_node(&mut self, whole: Part, plot: &Plot) {
        let parallel = whole.items.len() >= SERIAL;
        let mut parts = vec![whole];
        while parts.len() < WIDTH {
            let divisible = parts.iter().enumerate().filter(|(_, part)| part.items.len() > WIDTH);
            let areas = divisible.map(|(index, part)| (index, part.bounds.half_area()));
            let Some((largest, _)) = areas.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
            let part = parts.remove(largest);
            parts.splice(largest..largest, split(part, plot).into_iter().flatten());
        }
        let node = self.nodes.len();
        self.nodes.push(Node::empty());
        if parallel {
            let grown: Vec<(Bounds, Arena, Child, u8)> =
                parts.into_par_iter().map(|part| Arena::grown(part, plot)).collect();
            for (bounds, arena, child, counts) in grown {
                let child = child.moved(self.nodes.len(), self.leaves.len());
                self.append(arena);
                self.attach(node, &bounds, child, counts);
            }
        } else {
            for part in parts {
                let bounds = part.bounds.bounds();
                let (child, counts) = self.grow(part, plot);
                self.attach(node, &bounds, child, counts);
            }
        }
    }

    fn attach(&mut self, node: usize, bounds: &Bounds, child: Child, counts: u8) {
        let node = &mut self.nodes[node];
        node.counts[usize::from(node.used)] = counts;
        node.push(bounds, child);
    }

    /// A part by itself.
    fn grown(part: Part, plot: &Plot) -> (Bounds, Arena, Child, u8) {
        let mut arena = Arena::default();
        let bounds = part.bounds.bounds();
        let (child, counts) = arena.grow(part, plot);
        (bounds, arena, child, counts)
    }

    /// Builds a leaf or a node.
    fn grow(&mut self, part: Part, plot: &Plot) -> (Child, u8) {
        if part.items.len() > WIDTH {
            let node = Child::new(Kind::Node, self.nodes.len());
            self.grow_node(part, plot);
            return (node, 0);
        }
        let different = match plot.kind {
            Kind::Triangles => put_twins_last(part.items, &mut Corners::new(plot.scene)),
            _ => part.items.len(),
        };
        let number = |count: usize| u8::try_from(count).expect("eight at most");
        let count = number(part.items.len());
        let leaf = Child::new(plot.kind, self.leaves.len());
        let first = u32::try_from(part.first).expect("ids are u32");
        self.leaves.push(LeafRange { first, count, kind: plot.kind });
        (leaf, 16 * count + number(different))
    }

    /// Takes in a part that was built beside this one, and says where it begins now.
    fn append(&mut self, part: Arena) -> Child {
        let (nodes, leaves) = (self.nodes.len(), self.leaves.len());
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            for child in &mut node.children[..usize::from(node.used)] {
                *child = child.moved(nodes, leaves);
            }
            node
        }));
        self.leaves.extend(part.leaves);
        Child::new(Kind::Node, nodes)
    }
}

/// Divides a part of more than eight primitives in two, or leaves out what is in it twice.
fn split<'a>(part: Part<'a>, plot: &Plot) -> [Option<Part<'a>>; 2] {
    let Part { items, middles, first, depth, distinct, .. } = part;
    let best = cheapest_plane(items, &middles).filter(|_| depth < DEEP);
    let Some(plane) = best else {
        if plot.kind == Kind::Triangles && !distinct {
            let count = leave_out_twins(items, plot);
            return [Some(Part::new(&mut items[..count], first, depth, true)), None];
        }
        // All in one place, or too deep: any half is as good as any other, if only it is whole leaves.
        let half = (items.len() / 2).next_multiple_of(WIDTH).min(items.len() - 1);
        let (left, right) = items.split_at_mut(half);
        let left = Part::new(left, first, depth + 1, distinct);
        return [Some(left), Some(Part::new(right, first + half, depth + 1, distinct))];
    };
    let (mut middle, mut end) = (0, items.len());
    let (mut left, mut right) = ([Box4::EMPTY; 2], [Box4::EMPTY; 2]);
    while middle < end {
        let item = items[middle];
        let place = item.middle();
        let goes_left = plane.grid.bins(place)[plane.axis] < plane.bin;
        let side = if goes_left { &mut left } else { &mut right };
        side[0] = side[0].with(item.low, item.high);
        side[1] = side[1].with(place, place);
        if goes_left {
            middle += 1;
        } else {
            end -= 1;
            items.swap(middle, end);
        }
    }
    let (left_items, right_items) = items.split_at_mut(middle);
    let part = |items, first, [bounds, middles]: [Box4; 2]| {
        Some(Part { items, bounds, middles, first, depth: depth + 1, distinct })
    };
    [part(left_items, first, left), part(right_items, first + middle, right)]
}

/// Brings triangles with the same corners together, keeps the first in the scene of each and tells how
/// many there are: the others are never seen.
fn leave_out_twins(items: &mut [Item], plot: &Plot) -> usize {
    let mut corners = Corners::new(plot.scene);
    let mut bits = |item: &Item| {
        // Adding 0 makes −0 and 0 one.
        let mut bits = corners.of(item.id()).map(|v| (v + 0.0).to_array().map(f32::to_bits));
        bits.sort_unstable();
        bits
    };
    items.sort_by_cached_key(|item| (bits(item), item.id()));
    let mut kept = 1;
    for k in 1..items.len() {
        if bits(&items[k]) != bits(&items[kept - 1]) {
            items[kept] = items[k];
            kept += 1;
        }
    }
    kept
}

/// How middles are sorted into bins.
#[derive(Clone, Copy)]
struct Grid {
    low: Vec4,
    scale: Vec4,
}

impl Grid {
    fn new(middles: &Box4) -> Grid {
        #[expect(clippy::cast_precision_loss, reason = "it is 16")]
        let bins = BINS as f32;
        // An extent that overflows, and one that is nothing, puts everything into the first bin.
        let scale = Vec4::splat(bins * 0.999) / (middles.high - middles.low);
        Grid {
            low: middles.low,
            scale: Vec4::select(scale.cmplt(Vec4::INFINITY), scale, Vec4::ZERO),
        }
    }

    #[inline(always)]
    fn bins(&self, middle: Vec4) -> [usize; 3] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "it is not negative, and the conversion saturates"
        )]
        let bin = |place: f32| (place as u32 as usize).min(BINS - 1);
        let place = (middle - self.low) * self.scale;
        [bin(place.x), bin(place.y), bin(place.z)]
    }
}

/// A split: primitives whose middle lies in a bin before this one, along one axis, go first.
#[derive(Clone, Copy)]
struct SplitPlane {
    grid: Grid,
    axis: usize,
    bin: usize,
    /// The sum over both parts of half their area times their number of leaves.
    cost: f64,
}

/// What lies in a bin.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    count: usize,
}

type Bins = [[Bin; BINS]; 3];

const NO_BINS: Bins = [[Bin { bounds: Box4::EMPTY, count: 0 }; BINS]; 3];

fn fill_bins(items: &[Item], grid: &Grid) -> Bins {
    if items.len() > LARGE {
        let shares = items.par_chunks(LARGE / 4).map(|share| fill_bins(share, grid));
        return shares.reduce(
            || NO_BINS,
            |mut all, share| {
                for (bin, more) in all.iter_mut().flatten().zip(share.as_flattened()) {
                    bin.count += more.count;
                    bin.bounds = bin.bounds.with(more.bounds.low, more.bounds.high);
                }
                all
            },
        );
    }
    let mut bins = NO_BINS;
    for item in items {
        let places = grid.bins(item.middle());
        for axis in 0..3 {
            let bin = &mut bins[axis][places[axis]];
            bin.count += 1;
            bin.bounds = bin.bounds.with(item.low, item.high);
        }
    }
    bins
}

/// The split that the surface area heuristic likes best; `None` if all middles are in one bin.
fn cheapest_plane(items: &[Item], middles: &Box4) -> Option<SplitPlane> {
    let grid = Grid::new(middles);
    let bins = fill_bins(items, &grid);
    let mut best: Option<SplitPlane> = None;
    for (axis, bins) in bins.iter().enumerate() {
        // From the right, the cost of what lies at or beyond each bin; then from the left.
        let mut beyond = [0.0; BINS];
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in (1..BINS).rev() {
            count += bins[k].count;
            bounds = bounds.with(bins[k].bounds.low, bins[k].bounds.high);
            beyond[k] = leaves(count) * bounds.half_area();
        }
        let (mut count, mut bounds) = (0, Box4::EMPTY);
        for k in 1..BINS {
            count += bins[k - 1].count;
            bounds = bounds.with(bins[k - 1].bounds.low, bins[k - 1].bounds.high);
            let cost = leaves(count) * bounds.half_area() + beyond[k];
            let useful = count > 0 && count < items.len();
            if useful && best.is_none_or(|best| cost < best.cost) {
                best = Some(SplitPlane { grid, axis, bin: k, cost });
            }
        }
    }
    best
}

/// How many leaves so many primitives fill.
#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
fn leaves(count: usize) -> f64 {
    count.div_ceil(WIDTH) as f64
}

#[cfg(test)]
mod tests;
