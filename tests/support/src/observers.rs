//! Observers that count.

use bothways_common::exact::Sign;
use bothways_common::observe::{Events, Observer};
use bothways_common::raster::Sample;
use bothways_common::{Camera, Options, View};
use std::cmp::Ordering;

/// An observer that counts exact ties: of edges where the edges decide, and of distances.
#[derive(Clone, Debug)]
pub struct Ties<'a> {
    view: &'a View<'a>,
    samples: u32,
    /// Tests in which a zero edge function decides.
    pub edge: u64,
    /// Depth tests between equal distances.
    pub distance: u64,
    /// All tests of a primitive at a sample.
    pub tested: u64,
}

impl<'a> Ties<'a> {
    /// An observer with all counts at zero.
    pub fn new(view: &'a View<'a>, samples: u32) -> Self {
        Ties { view, samples, edge: 0, distance: 0, tested: 0 }
    }
}

impl Observer for Ties<'_> {
    fn fork(&self) -> Self {
        Ties::new(self.view, self.samples)
    }

    fn join(&mut self, part: Self) {
        self.edge += part.edge;
        self.distance += part.distance;
        self.tested += part.tested;
    }
}

impl Events for Ties<'_> {
    fn sample_tested(&mut self, _sample: Sample, _primitive: u64) {
        self.tested += 1;
    }

    fn edge_signs(&mut self, _sample: Sample, _primitive: u64, signs: [Option<Sign>; 3]) {
        let has = |sign| signs.contains(&Some(sign));
        let decided_elsewhere = has(Sign::Negative) && has(Sign::Positive);
        self.edge += u64::from(has(Sign::Zero) && !decided_elsewhere);
    }

    fn depth_test(&mut self, sample: Sample, challenger: u64, holder: u64, _replaced: bool) {
        let ray = self.view.camera.sample_grid(self.samples).ray(sample.row, sample.column);
        let [first, second] = [challenger, holder].map(|id| self.view.primitive(id));
        let at_sample = self.view.judge().compare(&first, &second, &ray).at_sample;
        self.distance += u64::from(at_sample == Ordering::Equal);
    }
}

/// An observer that counts, for every sample, the primitives that cover it.
#[derive(Clone, Debug)]
pub struct Owners {
    width: usize,
    /// One count for every sample, row by row.
    pub counts: Vec<u32>,
}

impl Owners {
    /// An observer with all counts at zero.
    pub fn new(camera: &Camera, options: &Options) -> Self {
        let [width, height] = camera.image().map(|side| (side * options.samples) as usize);
        Owners { width, counts: vec![0; width * height] }
    }
}

impl Observer for Owners {
    fn fork(&self) -> Self {
        Owners { width: self.width, counts: vec![0; self.counts.len()] }
    }

    fn join(&mut self, part: Self) {
        for (count, more) in self.counts.iter_mut().zip(part.counts) {
            *count += more;
        }
    }
}

impl Events for Owners {
    fn fragment(&mut self, sample: Sample, _primitive: u64) {
        self.counts[sample.row * self.width + sample.column] += 1;
    }
}
