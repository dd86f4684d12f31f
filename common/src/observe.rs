//! The events of the loops, and the observers that receive them. Counts, heat maps, films and lessons are all made from these.
//!
//! There are two sorts of counts. [`Work`] counts events: the work of the algorithm, for each primitive or ray alone.
//! [`Executed`] is what the loops of a fast renderer executed for a frame, tile by tile.

pub mod budget;
mod executed;

pub use executed::Executed;

use crate::exact::Sign;
use crate::raster::{Region, Sample};

/// What the fast arithmetic of a renderer left open.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Question {
    /// Does the primitive cover the sample?
    Coverage,
    /// Which of two primitives is nearer?
    Nearest,
}

/// The events of a renderer's loops. All methods do nothing unless overridden.
///
/// In object order they are: `primitive_begun`, then for each of its samples `sample_tested`, `edge_signs`, `fragment`,
/// `depth_test`. In image order they are: `ray_begun`, then `node_opened`, `sample_tested`, `edge_signs`, `fragment`,
/// `depth_test`, and at the end of the ray `hit`. An observer that only counts gets sums instead: see
/// [`Events::counts`].
pub trait Events {
    /// The counts of an observer that only counts. Renderers may add the events of many samples to them at once.
    fn counts(&mut self) -> Option<&mut Work> {
        None
    }

    /// Whether the observer needs no more events. A renderer then finishes the picture without sending any.
    fn has_enough(&mut self) -> bool {
        false
    }

    /// Object order begins a primitive, which affects no sample outside of the region. In a scene of wide ids, it does not
    /// begin those of instances that certainly cover no sample of the picture.
    fn primitive_begun(&mut self, _primitive: u64, _region: &Region) {}

    /// Image order begins the ray of a sample.
    fn ray_begun(&mut self, _sample: Sample) {}

    /// Image order tests the box of a node of its hierarchy, and enters it or not.
    fn node_opened(&mut self, _sample: Sample, _node: u32, _entered: bool) {}

    /// One primitive is tested against one sample: the step at the heart of both loops.
    fn sample_tested(&mut self, _sample: Sample, _primitive: u64) {}

    /// The signs of a triangle's edge functions `E_ab`, `E_bc`, `E_ca` at a sample; zero is a tie.
    /// `None` stands for a sign that was not needed, because another one had decided. A triangle that is culled by
    /// where its corners are seen has no such event.
    fn edge_signs(&mut self, _sample: Sample, _primitive: u64, _signs: [Option<Sign>; 3]) {}

    /// The primitive covers the sample.
    fn fragment(&mut self, _sample: Sample, _primitive: u64) {}

    /// A fragment meets an earlier one at its sample, and replaces it or not.
    fn depth_test(&mut self, _sample: Sample, _incoming: u64, _stored: u64, _replaced: bool) {}

    /// The first primitive along a ray is known.
    fn hit(&mut self, _sample: Sample, _primitive: Option<u64>) {}

    /// A decision that the fast arithmetic left open goes to the exact judge.
    fn judged(&mut self, _sample: Sample, _question: Question) {}
}

/// Receives the events of a renderer's loops.
///
/// `()` receives nothing, and costs nothing. A picture is rendered in parts by several threads; each part gets an
/// observer by [`Observer::fork`], and they come back through [`Observer::join`] in an order that does not depend
/// on the threads.
pub trait Observer: Events + Send + Sync + Sized {
    /// Whether the observer makes use of events. If not, renderers do not send any.
    const WATCHES: bool = true;

    /// The observer as an event sink, if it watches.
    fn sink(&mut self) -> Option<&mut dyn Events> {
        if Self::WATCHES { Some(self) } else { None }
    }

    /// A new observer for one part of the picture.
    fn fork(&self) -> Self;

    /// Takes back what the observer of one part has seen.
    fn join(&mut self, part: Self);
}

/// An event sink: `()` or `dyn Events`. The innermost loops are compiled for these two, not anew for each observer.
pub trait EventSink: Events {
    /// Whether events have any effect.
    const ENABLED: bool;
}

impl EventSink for () {
    const ENABLED: bool = false;
}

impl EventSink for dyn Events + '_ {
    const ENABLED: bool = true;
}

impl Events for () {}

impl Observer for () {
    const WATCHES: bool = false;

    fn fork(&self) -> Self {}
    fn join(&mut self, (): ()) {}
}

/// Two observers of the same loops.
impl<A: Observer, B: Observer> Observer for (A, B) {
    const WATCHES: bool = A::WATCHES || B::WATCHES;

    fn fork(&self) -> Self {
        (self.0.fork(), self.1.fork())
    }

    fn join(&mut self, (first, second): Self) {
        self.0.join(first);
        self.1.join(second);
    }
}

impl<A: Events, B: Events> Events for (A, B) {
    fn has_enough(&mut self) -> bool {
        // `&` asks both: each may count that it was asked.
        self.0.has_enough() & self.1.has_enough()
    }

    fn primitive_begun(&mut self, primitive: u64, region: &Region) {
        self.0.primitive_begun(primitive, region);
        self.1.primitive_begun(primitive, region);
    }

    fn ray_begun(&mut self, sample: Sample) {
        self.0.ray_begun(sample);
        self.1.ray_begun(sample);
    }

    fn node_opened(&mut self, sample: Sample, node: u32, entered: bool) {
        self.0.node_opened(sample, node, entered);
        self.1.node_opened(sample, node, entered);
    }

    fn sample_tested(&mut self, sample: Sample, primitive: u64) {
        self.0.sample_tested(sample, primitive);
        self.1.sample_tested(sample, primitive);
    }

    fn edge_signs(&mut self, sample: Sample, primitive: u64, signs: [Option<Sign>; 3]) {
        self.0.edge_signs(sample, primitive, signs);
        self.1.edge_signs(sample, primitive, signs);
    }

    fn fragment(&mut self, sample: Sample, primitive: u64) {
        self.0.fragment(sample, primitive);
        self.1.fragment(sample, primitive);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, replaced: bool) {
        self.0.depth_test(sample, incoming, stored, replaced);
        self.1.depth_test(sample, incoming, stored, replaced);
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u64>) {
        self.0.hit(sample, primitive);
        self.1.hit(sample, primitive);
    }

    fn judged(&mut self, sample: Sample, question: Question) {
        self.0.judged(sample, question);
        self.1.judged(sample, question);
    }
}

/// The work of the algorithm: counts of events, for each primitive or ray alone. Neither threads nor the width of SIMD
/// change them.
///
/// A fast renderer does less than this for a frame, because it draws tiles of many samples at once and skips what is
/// hidden. [`Executed`] counts what it does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Primitives that the outer loop of object order began.
    pub primitives: u64,
    /// Rays that the outer loop of image order began.
    pub rays: u64,
    /// Boxes of the hierarchy that were tested against a ray. The fast ray tracer walks its hierarchy with many rays
    /// at once; for an observer each ray walks alone as well, so that the counts belong to the ray and not to its
    /// neighbours. All boxes of an opened node count.
    pub nodes: u64,
    /// Pairs of a primitive and a sample that were tested for coverage: the inner step of both loops.
    ///
    /// In object order these are the samples of the primitives' bounding regions. The region of a triangle wider than
    /// 256 samples is cut, sixteen rows at a time, to where the edge functions allow a fragment. The fast rasterizer
    /// skips clusters of triangles that are certainly hidden; for an observer it draws them, so that the counts do not
    /// depend on the order of drawing. In image order all triangles of an opened leaf count, without duplicates.
    pub tests: u64,
    /// Those of the tests in which the primitive covers the sample.
    pub fragments: u64,
    /// Comparisons of a fragment with an earlier one at its sample.
    pub depth_tests: u64,
    /// Coverage decisions that the fast arithmetic left to the exact judge.
    pub judged_coverage: u64,
    /// Depth decisions that the fast arithmetic left to the exact judge. In object order this count depends on which
    /// fragment comes first to a sample, and so on how the picture is cut into tiles.
    pub judged_nearest: u64,
}

impl Work {
    /// The work as one number of steps: each test of a primitive or a box and each depth test is one step, each question
    /// to the exact judge 256.
    pub fn steps(&self) -> u64 {
        const QUESTION: u64 = 256;
        let questions = self.judged_coverage + self.judged_nearest;
        self.nodes + self.tests + self.depth_tests + QUESTION * questions
    }
}

impl Observer for Work {
    fn fork(&self) -> Self {
        Work::default()
    }

    fn join(&mut self, part: Self) {
        self.primitives += part.primitives;
        self.rays += part.rays;
        self.nodes += part.nodes;
        self.tests += part.tests;
        self.fragments += part.fragments;
        self.depth_tests += part.depth_tests;
        self.judged_coverage += part.judged_coverage;
        self.judged_nearest += part.judged_nearest;
    }
}

impl Events for Work {
    fn counts(&mut self) -> Option<&mut Work> {
        Some(self)
    }

    fn primitive_begun(&mut self, _primitive: u64, _region: &Region) {
        self.primitives += 1;
    }

    fn ray_begun(&mut self, _sample: Sample) {
        self.rays += 1;
    }

    fn node_opened(&mut self, _sample: Sample, _node: u32, _entered: bool) {
        self.nodes += 1;
    }

    fn sample_tested(&mut self, _sample: Sample, _primitive: u64) {
        self.tests += 1;
    }

    fn fragment(&mut self, _sample: Sample, _primitive: u64) {
        self.fragments += 1;
    }

    fn depth_test(&mut self, _sample: Sample, _incoming: u64, _stored: u64, _replaced: bool) {
        self.depth_tests += 1;
    }

    fn judged(&mut self, _sample: Sample, question: Question) {
        match question {
            Question::Coverage => self.judged_coverage += 1,
            Question::Nearest => self.judged_nearest += 1,
        }
    }
}
