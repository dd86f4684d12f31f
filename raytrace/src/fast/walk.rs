//! The walk of one ray through the hierarchy, near boxes first.

use super::build::{Bounds, Child, Form, Prepared};
use super::leaf::{self, Answer, Distance, Trust, UNIT_ROUNDOFF};
use bothways_common::fault::{Fault, Planted};
use bothways_common::observe::{Observer, Question, Sample};
use bothways_common::predicate::Memory;
use bothways_common::{Judge, Primitive, Ray, View};
use glam::DVec3;

/// What a ray meets first, as far as the walk has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) id: u32,
    primitive: Primitive,
    distance: Distance,
}

/// Walks rays of one view through the hierarchy.
#[derive(Debug)]
pub(super) struct Walker<'a> {
    prepared: &'a Prepared,
    view: &'a View<'a>,
    judge: Judge,
    memory: Memory,
    eye: DVec3,
    /// What is tested without a box: planes, and spheres that no box can be trusted to hold, because
    /// they are huge or the eye is so far away (those are in boxes, too).
    unbounded: Vec<(u32, Primitive)>,
    /// Nodes to enter yet, each with a `t` that none of its primitives is nearer than.
    open: Vec<(Child, f64)>,
}

/// A ray as boxes are tested against it.
struct BoxRay {
    origin: DVec3,
    inverse: DVec3,
    /// For each axis, whether the ray runs against it.
    backward: [bool; 3],
}

impl BoxRay {
    fn new(ray: &Ray) -> Self {
        let inverse = ray.direction.recip();
        BoxRay {
            origin: ray.origin,
            inverse,
            backward: inverse.to_array().map(f64::is_sign_negative),
        }
    }

    /// The `t` at which the ray enters a box, at most; `None` if it certainly misses it.
    ///
    /// The box is taken relative to the eye as vertices are, by one rounded subtraction, which keeps
    /// order: no vertex gets outside. Then a slab's `t = (side − O)·(1/D)` carries 3 roundings, so that
    /// a ray which meets the box in real numbers has `entry·(1 − 4u) ≤ exit·(1 + 4u)`. Where `D` is
    /// zero along an axis, a side that the origin lies on gives `0·∞`, NaN, which the comparisons
    /// below pass over.
    fn enter(&self, bounds: &Bounds, eye: DVec3) -> Option<f64> {
        const WIDER: f64 = 1.0 + 16.0 * UNIT_ROUNDOFF;
        const NARROWER: f64 = 1.0 - 8.0 * UNIT_ROUNDOFF;
        let (mut entry, mut exit) = (0.0, f64::INFINITY);
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            let (near, far) = if self.backward[axis] { (high, low) } else { (low, high) };
            let t =
                |side: f32| (f64::from(side) - eye[axis] - self.origin[axis]) * self.inverse[axis];
            let (near, far) = (t(near), t(far));
            if near > entry {
                entry = near;
            }
            if far < exit {
                exit = far;
            }
        }
        (entry <= exit * WIDER).then_some(entry * NARROWER)
    }
}

impl<'a> Walker<'a> {
    pub(super) fn new(prepared: &'a Prepared, view: &'a View<'a>) -> Self {
        let eye = view.camera.eye().as_dvec3();
        let room = |extent: f32| f64::from(extent) * 30f64.exp2();
        let spheres = prepared.spheres.iter();
        let loose = spheres.filter(|(_, extent)| eye.abs().max_element() > room(*extent));
        let ids = prepared.unbounded.iter().chain(loose.map(|(id, _)| id));
        let unbounded = ids.map(|&id| (id, view.primitive(id))).collect();
        let judge = view.judge();
        Walker {
            prepared,
            view,
            judge,
            memory: Memory::new(judge),
            eye,
            unbounded,
            open: Vec::new(),
        }
    }

    /// The first primitive along a ray.
    pub(super) fn first_hit<O: Observer, F: Fault>(
        &mut self,
        ray: &Ray,
        sample: Sample,
        observer: &mut O,
    ) -> Option<Hit> {
        observer.ray_begun(sample);
        let mut hit = None;
        for index in 0..self.unbounded.len() {
            let (id, primitive) = self.unbounded[index];
            self.test::<O, F>(ray, sample, id, primitive, &mut hit, observer);
        }
        let box_ray = BoxRay::new(ray);
        self.open.clear();
        if !self.prepared.nodes.is_empty() {
            self.open.push((Child::Node(0), 0.0));
        }
        while let Some((child, entry)) = self.open.pop() {
            if is_farther(entry, hit.as_ref()) {
                continue;
            }
            match child {
                Child::Node(node) => {
                    self.enter::<O, F>(node, &box_ray, sample, hit.as_ref(), observer);
                }
                Child::Leaf { first, count } => {
                    let leaves = first as usize..(first + count) as usize;
                    for leaf in &self.prepared.leaves[leaves] {
                        let primitive = self.primitive(&leaf.form);
                        self.test::<O, F>(ray, sample, leaf.id, primitive, &mut hit, observer);
                    }
                }
            }
        }
        observer.hit(sample, hit.as_ref().map(|hit| hit.id));
        hit
    }

    /// The distance of a hit.
    pub(super) fn t(&self, hit: &Hit, ray: &Ray) -> f64 {
        hit.distance.t().unwrap_or_else(|| self.judge.distance(&hit.primitive, ray))
    }

    /// Tests both boxes of a node and opens those that the ray meets, the nearer one last, so first.
    fn enter<O: Observer, F: Fault>(
        &mut self,
        index: u32,
        ray: &BoxRay,
        sample: Sample,
        hit: Option<&Hit>,
        observer: &mut O,
    ) {
        let forgotten = self.prepared.nodes.len() / 2;
        if F::is(Planted::ForgottenNode) && index as usize == forgotten {
            return;
        }
        let node = &self.prepared.nodes[index as usize];
        let entries = [0, 1].map(|child| {
            if let Child::Leaf { count: 0, .. } = node.children[child] {
                return None;
            }
            let bounds = shrunk::<F>(&node.bounds[child]);
            let entry = ray.enter(&bounds, self.eye).filter(|entry| !is_farther(*entry, hit));
            observer.node_opened(sample, 2 * index + [0, 1][child], entry.is_some());
            entry
        });
        let [first, second] = node.children;
        match entries {
            [Some(near), Some(far)] if near <= far => {
                self.open.extend([(second, far), (first, near)]);
            }
            [Some(far), Some(near)] => self.open.extend([(first, far), (second, near)]),
            [Some(entry), None] => self.open.push((first, entry)),
            [None, Some(entry)] => self.open.push((second, entry)),
            [None, None] => {}
        }
    }

    /// Tests a ray against a primitive and keeps the nearer of it and the hit so far.
    fn test<O: Observer, F: Fault>(
        &mut self,
        ray: &Ray,
        sample: Sample,
        id: u32,
        primitive: Primitive,
        hit: &mut Option<Hit>,
        observer: &mut O,
    ) {
        observer.sample_tested(sample, id);
        let trust = Trust { blind: F::is(Planted::ZeroErrorBound) };
        let (answer, signs) = leaf::primitive(ray, &primitive, trust);
        let distance = match answer {
            Answer::Hit(distance) | Answer::Open(distance) => distance,
            Answer::Miss => {
                observer.edge_signs(sample, id, signs);
                return;
            }
        };
        if let Answer::Hit(_) = answer {
            observer.edge_signs(sample, id, signs);
        } else if !self.judge_covers::<O, F>(ray, sample, id, &primitive, observer) {
            return;
        }
        observer.fragment(sample, id);
        if let Some(held) = hit {
            let nearer = if distance.high < held.distance.low {
                true
            } else if distance.low > held.distance.high {
                false
            } else {
                self.judge_nearer::<O, F>(ray, sample, (id, &primitive), held, observer)
            };
            observer.depth_test(sample, id, held.id, nearer);
            if !nearer {
                return;
            }
        }
        *hit = Some(Hit { id, primitive, distance });
    }

    /// Asks the judge whether a primitive covers a sample that rounding leaves open.
    #[cold]
    fn judge_covers<O: Observer, F: Fault>(
        &mut self,
        ray: &Ray,
        sample: Sample,
        id: u32,
        primitive: &Primitive,
        observer: &mut O,
    ) -> bool {
        if self.memory.is_edge_on(id, primitive) {
            return false;
        }
        observer.judged(sample, Question::Coverage);
        let coverage = self.judge.coverage(primitive, ray);
        if let Some(edges) = coverage.edges {
            observer.edge_signs(sample, id, edges.at_sample.map(Some));
        }
        coverage.covers && !F::is(Planted::StrictComparison)
    }

    /// Asks the judge whether a primitive is seen rather than the hit so far.
    #[cold]
    fn judge_nearer<O: Observer, F: Fault>(
        &mut self,
        ray: &Ray,
        sample: Sample,
        challenger: (u32, &Primitive),
        held: &Hit,
        observer: &mut O,
    ) -> bool {
        observer.judged(sample, Question::Nearest);
        if F::is(Planted::TiesToLast) {
            let order = self.memory.compare(challenger, (held.id, &held.primitive), ray);
            return order.decided.then(held.id.cmp(&challenger.0)).is_lt();
        }
        self.memory.nearer(challenger, (held.id, &held.primitive), ray)
    }

    /// A leaf's primitive relative to the eye.
    fn primitive(&self, form: &Form) -> Primitive {
        match *form {
            Form::Triangle(corners) => {
                Primitive::Triangle(corners.map(|corner| self.view.offset(corner)))
            }
            Form::Sphere(center, radius) => {
                Primitive::Sphere { center: self.view.offset(center), radius: f64::from(radius) }
            }
        }
    }
}

/// Whether nothing from this `t` on can be the first hit: only what is certainly farther is dropped,
/// since of equal distances another primitive may win.
fn is_farther(entry: f64, hit: Option<&Hit>) -> bool {
    hit.is_some_and(|hit| entry > hit.distance.high)
}

fn shrunk<F: Fault>(bounds: &Bounds) -> Bounds {
    if F::is(Planted::ShrunkBox) {
        let step = |v: glam::Vec3, next: fn(f32) -> f32| glam::Vec3::from(v.to_array().map(next));
        Bounds { low: step(bounds.low, f32::next_up), high: step(bounds.high, f32::next_down) }
    } else {
        *bounds
    }
}
