//! The walk of a tile's rays through the hierarchy, near boxes first.

use super::box_culling::BoxHits;
use super::candidates::{CandidateQueue, EIGHT, WaitingLeaf};
use super::instance_frustum::{BoxPlaces, InstanceFrustum};
use super::leaf::ids_of;
use super::leaf_tests::Test;
use super::tile_frustum::{FrustumTemplate, TileFrustum};
use super::tile_place::TilePlace;
use super::tree::{INSTANCES, LeafCounts, Node, NodeKind, NodeRef, WIDTH};
use crate::fast::camera_map::CameraMap;
use crate::fast::fragments::Fragments;
use crate::fast::one_primitive::unbounded::Unbounded;
use crate::fast::prepared::{OneInstance, Prepared};
use crate::fast::size_class::SizeClass;
use crate::fast::tile::TileBuffer;
use crate::fast::{draw, one_primitive};
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::{Fault, Planted};
use bothways_common::engine::simd::{SimdBase, apart, prefetch};
use bothways_common::observe::Events;

/// A node or leaf that is to be entered.
#[derive(Clone, Copy, Debug)]
pub(super) struct StackEntry {
    /// None of its primitives is nearer than this `t`, in the scale of the map.
    pub(super) near: f32,
    /// The longest side of its box.
    size: f32,
    pub(super) child: NodeRef,
    counts: LeafCounts,
    /// Where in the tile it may be seen, and the largest depth key that it may have there; known of boxes in instances.
    place: TilePlace,
    key: f32,
}

impl StackEntry {
    /// A child of a node, of whose place in the tile nothing is known.
    #[inline(always)]
    pub(super) fn new(node: &Node, lane: usize, near: f32, size: f32) -> StackEntry {
        let (child, counts) = (node.children[lane], node.counts[lane]);
        StackEntry { near, size, child, counts, place: TilePlace::ALL, key: f32::INFINITY }
    }
}

/// Walks tiles of one view through the hierarchy.
#[derive(Debug)]
pub(crate) struct Walker<'a> {
    pub(crate) prepared: &'a Prepared,
    pub(crate) map: &'a CameraMap<'a>,
    pub(crate) tile: TileBuffer,
    unbounded: &'a Unbounded,
    pub(super) stack: Vec<StackEntry>,
    queue: CandidateQueue,
    fragments: Fragments,
    /// The instance whose mesh is walked last, whether that walk goes on, and how long the stack was before: what lies
    /// above belongs to the instance. Outside of instances, 0.
    instance: Option<InstanceFrustum<'a>>,
    is_inside: bool,
    base: usize,
}

impl<'a> Walker<'a> {
    pub(crate) fn new(
        prepared: &'a Prepared,
        map: &'a CameraMap<'a>,
        unbounded: &'a Unbounded,
    ) -> Self {
        Walker {
            prepared,
            map,
            tile: TileBuffer::new(&map.view),
            unbounded,
            stack: Vec::new(),
            queue: CandidateQueue::new(),
            fragments: Fragments::new(),
            instance: None,
            is_inside: false,
            base: 0,
        }
    }

    /// Finds the first hits of the rays of a tile. The tile begins at the row and column `start`; `size` is how many
    /// of its rows and columns lie in the picture.
    #[inline(always)]
    pub(crate) fn walk<C: Context>(
        &mut self,
        context: &mut C,
        template: &FrustumTemplate,
        start: [usize; 2],
        size: [usize; 2],
    ) {
        let frustum = template.frustum(start);
        self.begin(context, &frustum, start, size);
        // The size class of the triangles that were drawn last.
        let mut class = SizeClass::Many;
        let mut farthest = self.farthest(&frustum);
        loop {
            if self.stack.len() == self.base {
                if self.is_inside {
                    (self.is_inside, self.base) = (false, 0);
                    continue;
                }
                if self.queue.is_empty() {
                    break;
                }
                self.draw_candidates(context, &frustum, class, true);
                continue;
            }
            let Some(entry) = self.stack.pop() else { break };
            if entry.near > farthest || !C::WATCHED && self.is_hidden(context, &entry) {
                continue;
            }
            match entry.child.kind() {
                NodeKind::Node => {
                    let index = entry.child.index();
                    let drawn = self.enter(context, &frustum, index, farthest, class);
                    let Some(drawn) = drawn else { continue };
                    class = drawn;
                }
                NodeKind::IndexedLeaf | NodeKind::ScatteredLeaf | NodeKind::PlainLeaf => {
                    // What is seen of a near instance hides the far ones.
                    let flush = C::WATCHED
                        || class == SizeClass::Many
                        || self.is_inside
                        || self.tile.is_nearly_full();
                    let is_ready = self.add_leaf(context, &frustum, &entry, class);
                    if !(is_ready || flush) || self.queue.is_empty() {
                        continue;
                    }
                    class = self.draw_candidates(context, &frustum, class, flush);
                }
                NodeKind::Spheres => self.draw_spheres(context, &frustum, &entry),
                NodeKind::Instances => {
                    self.push_instances(&frustum, &entry);
                    continue;
                }
                NodeKind::Instance => {
                    // Of instances nothing waits. What waits of others may hide them, and has names.
                    if self.queue.is_empty() {
                        self.enter_instance(&frustum, &entry, farthest);
                        continue;
                    }
                    self.stack.push(entry);
                    self.draw_candidates(context, &frustum, class, true);
                }
            }
            farthest = self.farthest(&frustum);
        }
        debug_assert!(self.queue.fragments.is_empty(), "fragments are lost");
        if C::WATCHED
            && let Some(sample) = self.tile.sample(0)
        {
            context.sink().hit(sample, self.seen());
        }
    }

    /// The id of what is seen at the only sample of a tile.
    pub(crate) fn seen(&self) -> Option<u64> {
        let name = self.tile.seen()?;
        Some(self.tile.names.id(name))
    }

    /// How many boxes each ray of a tile tests when it is walked alone, if every ray certainly misses all of them.
    #[inline(always)]
    pub(crate) fn boxes_all_missed<C: Context>(
        &self,
        context: &C,
        frustum: &TileFrustum,
        of_ray: &FrustumTemplate,
    ) -> Option<u64> {
        let is_node = |root: &NodeRef| matches!(root.kind(), NodeKind::Node);
        if !self.unbounded.primitives.is_empty() || !self.prepared.roots.iter().all(is_node) {
            return None;
        }
        let template = frustum.template;
        let rays = (&frustum.sides, template.parallel);
        let nodes = self.prepared.roots.iter().map(|root| &self.prepared.nodes[root.index()]);
        let mut boxes = 0;
        for node in nodes {
            if template.boxes.not_missed_by_all(context, rays, &of_ray.boxes, node) != 0 {
                return None;
            }
            boxes += u64::from(node.used);
        }
        Some(boxes)
    }

    /// Starts a tile: tests what no box bounds, and puts the roots on the stack.
    #[inline(always)]
    pub(super) fn begin<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        start: [usize; 2],
        size: [usize; 2],
    ) {
        self.tile.begin(start, size, frustum.template.side);
        if C::WATCHED
            && let Some(sample) = self.tile.sample(0)
        {
            context.sink().ray_begun(sample);
        }
        if !self.unbounded.primitives.is_empty() {
            let (map, unbounded, tile) = (self.map, self.unbounded, &mut self.tile);
            let simd = context.simd();
            apart!(simd, one_primitive::draw_unbounded(context, map, frustum, unbounded, tile));
        }
        self.stack.clear();
        (self.is_inside, self.base) = (false, 0);
        let root = |&child: &NodeRef| StackEntry {
            near: f32::NEG_INFINITY,
            size: f32::INFINITY,
            child,
            counts: LeafCounts::default(),
            place: TilePlace::ALL,
            key: f32::INFINITY,
        };
        self.stack.extend(self.prepared.roots.iter().map(root));
    }

    /// The `t` of boxes and corners beyond which nothing can be seen.
    #[inline(always)]
    pub(super) fn farthest(&self, frustum: &TileFrustum) -> f32 {
        let template = frustum.template;
        template.boxes.farthest(self.map.depth.farthest(self.tile.far, template.errors.t))
    }

    /// Whether something nearer is seen at all samples at which a box may be seen. Where many instances lie behind one
    /// another, the farthest hit of all the tile hides few of them: there are gaps between them.
    #[inline(always)]
    fn is_hidden<C: Context>(&self, context: &C, entry: &StackEntry) -> bool {
        entry.place != TilePlace::ALL
            && self.tile.hides(context.simd(), entry.place.ends(), entry.key)
    }

    /// Adds a leaf of triangles to the queue; of a leaf of an instance, those of its triangles that pass its test. Returns
    /// whether the queue is full.
    #[inline(always)]
    pub(super) fn add_leaf<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        entry: &StackEntry,
        class: SizeClass,
    ) -> bool {
        let StackEntry { near, size, child, counts, .. } = *entry;
        let with_duplicates = C::has(Planted::TiesToLast);
        let used = if with_duplicates { counts.all() } else { counts.distinct() };
        self.tile.executed.leaves_opened += 1;
        self.tile.executed.triangles += used as u64;
        if C::WATCHED {
            self.emit_tests(context, child, used);
        }
        // Both ways make it, as one that is taken by reference would go through memory before it waits.
        let Some(instance) = self.instance.as_ref().filter(|_| self.is_inside) else {
            return self.queue.add(WaitingLeaf { leaf: child, used, near, size });
        };
        let leaf = WaitingLeaf { leaf: child, used, near, size };
        let (prepared, rays) = (self.prepared, (frustum, instance));
        // Its fragments would wait until other leaves are tested.
        let test = test_of::<C>(class, frustum).without_fragments();
        self.queue.test_placed(context.simd(), prepared, rays, &leaf, test);
        false
    }

    /// The instance whose mesh is walked now.
    #[inline(always)]
    fn inside(&self) -> Option<&InstanceFrustum<'a>> {
        self.instance.as_ref().filter(|_| self.is_inside)
    }

    /// Pushes the instances of a leaf, those with nearer middles last.
    fn push_instances(&mut self, frustum: &TileFrustum, entry: &StackEntry) {
        let (prepared, view) = (self.prepared, &self.map.view);
        let count = entry.counts.all();
        let mut instances = [(0.0, 0); INSTANCES];
        for (to, &number) in
            instances.iter_mut().zip(&prepared.instance_order[entry.child.index()..][..count])
        {
            let instance = prepared.instance(view.scene, number);
            let middle = instance.placement.position(instance.mesh.bounds.middle());
            *to = (view.offset(middle).dot(frustum.rows[0].into()), number);
        }
        instances[..count].sort_by(|a, b| b.0.total_cmp(&a.0));
        self.stack.extend(instances[..count].iter().map(|&(_, number)| StackEntry {
            child: NodeRef::new(NodeKind::Instance, number as usize),
            ..*entry
        }));
    }

    /// Begins the walk through the mesh of an instance, unless its box misses the tile or lies behind its hits.
    ///
    /// It stays out of the loop of the walk, which other scenes go through without it.
    #[inline(never)]
    fn enter_instance(&mut self, frustum: &TileFrustum, entry: &StackEntry, farthest: f32) {
        let number = u32::try_from(entry.child.index()).expect("it has 29 bits");
        let OneInstance { mesh, placement, first_id, triangles } =
            self.prepared.instance(self.map.view.scene, number);
        if self.tile.names.are_used_up() {
            self.tile.give_names_anew();
        }
        self.tile.executed.boxes_tested += 1;
        let instance = InstanceFrustum::new(frustum, placement, &mesh.bounds);
        let Some(mut instance) = instance else { return };
        // What is hit there may hide it long before the whole tile is full.
        let template = frustum.template;
        let there = self.map.depth.farthest(self.tile.far_in(instance.seen), template.errors.t);
        if instance.near > farthest.min(template.boxes.farthest(there)) {
            return;
        }
        instance.place.first_name = self.tile.names.of_instance(first_id, triangles);
        (self.is_inside, self.base) = (true, self.stack.len());
        self.stack.push(StackEntry {
            near: entry.near.max(instance.near),
            size: entry.size.min(instance.size),
            child: mesh.root,
            counts: mesh.counts,
            place: TilePlace::ALL,
            key: f32::INFINITY,
        });
        self.instance = Some(instance);
    }

    /// Tests the spheres of a leaf.
    #[inline(always)]
    pub(super) fn draw_spheres<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        entry: &StackEntry,
    ) {
        let (count, map) = (entry.counts.all(), self.map);
        for &id in &self.prepared.sphere_leaves[entry.child.index()][..count] {
            let sphere = &map.view.named(id);
            one_primitive::draw_round(context, map, frustum, (id, sphere), &mut self.tile);
        }
    }

    /// Tests the leaves that have waited longest, and draws triangles, eight at a time; all leaves and triangles if
    /// `flush` asks for it, and all triangles if they are large. Takes and returns the size class of those that were
    /// drawn last.
    #[inline(always)]
    pub(super) fn draw_candidates<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        class: SizeClass,
        flush: bool,
    ) -> SizeClass {
        apart!(context.simd(), self.test_and_draw(context, frustum, class, flush))
    }

    /// What [`Walker::draw_candidates`] does.
    #[inline(always)]
    fn test_and_draw<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        class: SizeClass,
        flush: bool,
    ) -> SizeClass {
        let test = test_of::<C>(class, frustum);
        self.queue.test_leaves(context.simd(), self.prepared, frustum, test, flush);
        self.queue.fragments.test_depth(context, self.map, &mut self.tile);
        let mut largest = None;
        loop {
            let count = self.queue.count();
            let all = flush || largest == Some(SizeClass::Many);
            if count == 0 || (count < EIGHT && !all) {
                break;
            }
            let (eight, used) = (self.queue.take_eight(context.simd()), count.min(EIGHT));
            self.tile.executed.set_ups += used as u64;
            let of = (&eight, (1 << used) - 1);
            let onto = (&mut self.fragments, &mut self.tile);
            let class = draw::draw(context, self.map, frustum, of, onto);
            largest = largest.max(Some(class));
        }
        largest.unwrap_or(class)
    }

    /// Emits the tests of a ray alone against the triangles of a leaf.
    #[inline(always)]
    fn emit_tests(&self, context: &mut impl Context, leaf: NodeRef, used: usize) {
        let ids = ids_of(context.simd(), self.prepared, leaf).to_array();
        let sink = context.sink();
        if let Some(counts) = sink.counts() {
            counts.tests += used as u64;
            return;
        }
        let Some(sample) = self.tile.sample(0) else { return };
        let first_name = self.inside().map_or(0, |instance| instance.place.first_name);
        let id = |name: u32| self.tile.names.id(first_name + name);
        ids.iter().take(used).for_each(|name| sink.sample_tested(sample, id(*name)));
    }

    /// Tests the boxes of a node and pushes those that a ray of the tile may meet: near ones last, so that they come
    /// first; leaves with triangles over very few samples in any order. Of a whole tile that is far from full, and outside of
    /// instances, such leaves are opened at once; if triangles were drawn meanwhile, this returns the size class of the last ones.
    #[inline(always)]
    fn enter<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        index: usize,
        farthest: f32,
        class: SizeClass,
    ) -> Option<SizeClass> {
        if C::has(Planted::ForgottenNode) && index == self.prepared.nodes.len() / 2 {
            return None;
        }
        let shrunk;
        let mut node = &self.prepared.nodes[index];
        if C::has(Planted::ShrunkBox) {
            shrunk = shrink(node);
            node = &shrunk;
        }
        self.tile.executed.nodes_opened += 1;
        self.tile.executed.boxes_tested += u64::from(node.used);
        let (boxes, places) = match self.inside() {
            Some(instance) => apart!(context.simd(), instance.test(context, node, farthest)),
            None => {
                let boxes = &frustum.template.boxes;
                let hits = boxes.test(context, &frustum.sides, node, farthest);
                (hits, BoxPlaces::ANYWHERE)
            }
        };
        if C::WATCHED {
            self.emit_boxes(context, index, node, boxes.hit);
        }
        // Where leaves wait for others anyway, sorting them costs more than it saves.
        let sorted = !(class == SizeClass::VeryFew && node.only_triangles);
        if !(sorted || C::WATCHED || self.is_inside || self.tile.is_nearly_full()) {
            return self.open_leaves(context, frustum, (node, &boxes), class);
        }
        let base = self.stack.len();
        let mut hit = boxes.hit;
        while hit != 0 {
            let lane = (hit.trailing_zeros() & 15) as usize;
            hit &= hit - 1;
            self.prefetch(node.children[lane]);
            let (place, key) = (TilePlace::from_whole_number(places.place[lane]), places.key[lane]);
            let entry = StackEntry {
                place,
                key,
                ..StackEntry::new(node, lane, boxes.near[lane], boxes.size[lane])
            };
            self.stack.push(entry);
            let mut place = self.stack.len() - 1;
            while sorted && place > base && self.stack[place - 1].near < entry.near {
                self.stack[place] = self.stack[place - 1];
                place -= 1;
            }
            self.stack[place] = entry;
        }
        None
    }

    /// Adds the leaves of triangles that are hit to the queue, and draws triangles whenever it is full. Returns the size class of those
    /// that were drawn last, if any were.
    #[inline(always)]
    fn open_leaves<C: Context>(
        &mut self,
        context: &mut C,
        frustum: &TileFrustum,
        (node, boxes): (&Node, &BoxHits),
        class: SizeClass,
    ) -> Option<SizeClass> {
        let mut drawn = None;
        let mut hit = boxes.hit;
        while hit != 0 {
            let lane = (hit.trailing_zeros() & 15) as usize;
            hit &= hit - 1;
            self.prefetch(node.children[lane]);
            let entry = StackEntry::new(node, lane, boxes.near[lane], boxes.size[lane]);
            if self.add_leaf(context, frustum, &entry, class) {
                let class = drawn.unwrap_or(class);
                drawn = Some(self.draw_candidates(context, frustum, class, false));
            }
        }
        drawn
    }

    /// Asks for a node or leaf that is entered soon.
    #[inline(always)]
    pub(super) fn prefetch(&self, child: NodeRef) {
        match child.kind() {
            NodeKind::Node => prefetch(&self.prepared.nodes[child.index()]),
            NodeKind::IndexedLeaf => prefetch(&self.prepared.indexed_leaves[child.index()]),
            NodeKind::ScatteredLeaf => prefetch(&self.prepared.scattered_leaves[child.index()]),
            NodeKind::PlainLeaf => prefetch(&self.prepared.plain_leaves[child.index()]),
            NodeKind::Spheres | NodeKind::Instances | NodeKind::Instance => {}
        }
    }

    /// Emits which boxes of a node the only ray of a tile meets.
    #[inline(always)]
    fn emit_boxes(&self, context: &mut impl ScalarContext, index: usize, node: &Node, hit: u64) {
        let Some(sample) = self.tile.sample(0) else { return };
        let sink = context.sink();
        if let Some(counts) = sink.counts() {
            counts.nodes += u64::from(node.used);
            return;
        }
        for lane in 0..usize::from(node.used) {
            let number = u32::try_from(index * WIDTH + lane).unwrap_or(u32::MAX);
            sink.node_opened(sample, number, hit >> lane & 1 == 1);
        }
    }
}

/// How to test triangles after some of this class were drawn.
#[inline(always)]
fn test_of<C: ScalarContext>(class: SizeClass, frustum: &TileFrustum) -> Test {
    match class {
        // The events of a ray must not depend on the triangles that came before.
        _ if C::WATCHED => Test::Edges,
        // Faults are planted in what sets triangles up.
        SizeClass::VeryFew if C::Fault::SOUND && !frustum.template.parallel => Test::Fragments,
        SizeClass::VeryFew | SizeClass::Few => Test::Edges,
        SizeClass::Many => Test::Bounds,
    }
}

/// A fault: boxes too small by the last place.
fn shrink(node: &Node) -> Node {
    let mut node = *node;
    node.bounds[..3].as_flattened_mut().iter_mut().for_each(|low| *low = low.next_up());
    node.bounds[3..].as_flattened_mut().iter_mut().for_each(|high| *high = high.next_down());
    node
}
