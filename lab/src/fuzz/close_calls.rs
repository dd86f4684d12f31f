//! Counts of close calls: exact ties, and decisions that are left to the exact judge.

use crate::common::camera::SampleGrid;
use crate::common::exact::Sign;
use crate::common::observe::{Events, Observer};
use crate::common::raster::Sample;
use crate::common::{View, Work};
use std::cmp::Ordering;
use std::sync::Arc;

/// An observer that counts close calls.
#[derive(Clone, Debug)]
pub struct CloseCalls<'a> {
    view: &'a View<'a>,
    grid: Arc<SampleGrid<'a>>,
    /// Tests of a triangle at a sample in which a zero edge function decides, and comparisons of two primitives at
    /// exactly the same distance. Only the textbooks send the events that show a tie.
    pub exact_ties: u64,
    /// The counted work; of the fast renderers with the decisions that are left to the exact judge.
    pub work: Work,
}

impl<'a> CloseCalls<'a> {
    /// An observer with all counts at zero.
    pub fn new(view: &'a View<'a>, samples: u32) -> CloseCalls<'a> {
        let grid = Arc::new(view.camera.sample_grid(samples));
        CloseCalls { view, grid, exact_ties: 0, work: Work::default() }
    }

    /// Decisions that fast arithmetic left to the exact judge.
    pub fn exact_fallbacks(&self) -> u64 {
        self.work.judged_coverage + self.work.judged_nearest
    }
}

impl Observer for CloseCalls<'_> {
    fn fork(&self) -> Self {
        CloseCalls { exact_ties: 0, work: Work::default(), ..self.clone() }
    }

    fn join(&mut self, part: Self) {
        self.exact_ties += part.exact_ties;
        self.work.join(part.work);
    }
}

impl Events for CloseCalls<'_> {
    fn counts(&mut self) -> Option<&mut Work> {
        Some(&mut self.work)
    }

    fn edge_signs(&mut self, _sample: Sample, _primitive: u64, signs: [Option<Sign>; 3]) {
        let has = |sign| signs.contains(&Some(sign));
        let decided_elsewhere = has(Sign::Negative) && has(Sign::Positive);
        self.exact_ties += u64::from(has(Sign::Zero) && !decided_elsewhere);
    }

    fn depth_test(&mut self, sample: Sample, incoming: u64, stored: u64, _replaced: bool) {
        let ray = self.grid.ray(sample.row, sample.column);
        let [incoming, stored] = [incoming, stored].map(|id| self.view.primitive(id));
        let order = self.view.judge().compare(&incoming, &stored, &ray).at_sample;
        self.exact_ties += u64::from(order == Ordering::Equal);
    }

    fn judged(&mut self, sample: Sample, question: crate::common::observe::Question) {
        self.work.judged(sample, question);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{
        Camera, CameraDescription, Frame, Options, Projection, Scene, Shape, Triangle,
    };
    use crate::rasterize::textbook;

    #[test]
    fn samples_on_edges_and_equal_distances_are_ties() {
        // On 3 x 3 pixels of side 1, the diagonal of the square runs through three samples. Twice the same
        // triangle: every sample that it covers is a comparison of equal distances.
        let [a, b, c] = [[-1.5, -1.5, -1.0], [1.5, -1.5, -1.0], [-1.5, 1.5, -1.0]].map(Into::into);
        let triangle = Shape::Triangle(Triangle { a, b, c });
        let scene = Scene::new(vec![triangle.clone().into(), triangle.into()]).unwrap();
        let camera = Camera::new(CameraDescription {
            projection: Projection::Parallel,
            viewport: [3.0, 3.0],
            image: [3, 3],
            ..CameraDescription::default()
        });
        let (camera, options) = (camera.unwrap(), Options::default());
        let view = View::new(&scene, &camera);
        let mut frame = Frame::new(&camera, &options);
        let mut close = CloseCalls::new(&view, 1);
        textbook::determine_visibility(&view, &options, &mut frame, &mut close);
        let covered = frame.ids().iter().filter(|id| *id == Some(0)).count() as u64;
        assert_eq!(close.exact_ties, 2 * 3 + covered);
    }
}
