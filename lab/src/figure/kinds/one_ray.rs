//! What image order does for one ray, and whose ray to look at if nobody chooses a pixel.

use super::counts::{Counted, Counts};
use super::work::watch;
use crate::common::observe::{Events, Observer, Question};
use crate::common::raster::Sample;
use crate::common::{Crop, Frame, Options, View};
use crate::figure::subject::FigureError;
use crate::orders::Order;
use crate::raytrace;

/// The pixel whose ray hits most; of several, the one nearest to the middle.
pub(super) fn telling(view: &View) -> Result<[u32; 2], FigureError> {
    let mut counts = Counts::new(view.camera.image(), Counted::Fragments);
    watch(view, Order::Object, &mut counts);
    let [width, height] = view.camera.image();
    let middle = [f64::from(height) / 2.0, f64::from(width) / 2.0];
    let far = |[i, j]: [u32; 2]| (f64::from(i) - middle[0]).hypot(f64::from(j) - middle[1]);
    let pixels = (0..height).flat_map(|i| (0..width).map(move |j| [i, j]));
    // More than a handful of hits is more than a slide shows well.
    let of_pixel = |[i, j]: [u32; 2]| counts.at(i as usize, j as usize).min(5);
    pixels
        .filter(|pixel| of_pixel(*pixel) > 0)
        .min_by(|a, b| of_pixel(*b).cmp(&of_pixel(*a)).then(far(*a).total_cmp(&far(*b))))
        .ok_or_else(|| {
            FigureError::new(
                "no ray hits anything; choose a pixel with --pixel ROW,COLUMN to see a miss",
            )
        })
}

/// What the fast ray tracer did for one ray.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    sample: Option<Sample>,
    /// The boxes that were tested, by their numbers, and whether the ray hits them.
    pub(super) opened: Vec<(u32, bool)>,
    /// The primitives that were tested.
    pub(super) tested: u64,
    /// The decisions of the exact judge.
    pub(super) judged: u64,
}

impl Path {
    pub(super) fn of(view: &View, prepared: &raytrace::fast::Prepared, [i, j]: [u32; 2]) -> Path {
        let crop = Crop { row: i, column: j, height: 1, width: 1 };
        let options = Options { crop: Some(crop), ..Options::default() };
        let mut frame = Frame::new(view.camera, &options);
        let sample = Sample { row: i as usize, column: j as usize };
        let mut path = Path { sample: Some(sample), ..Path::default() };
        raytrace::fast::determine_visibility(prepared, view, &options, &mut frame, &mut path);
        path
    }
}

impl Observer for Path {
    fn fork(&self) -> Self {
        Path { sample: self.sample, ..Path::default() }
    }

    fn join(&mut self, part: Self) {
        self.opened.extend(part.opened);
        self.tested += part.tested;
        self.judged += part.judged;
    }
}

impl Events for Path {
    fn node_opened(&mut self, sample: Sample, node: u32, hit: bool) {
        if self.sample == Some(sample) {
            self.opened.push((node, hit));
        }
    }

    fn sample_tested(&mut self, sample: Sample, _primitive: u64) {
        self.tested += u64::from(self.sample == Some(sample));
    }

    fn judged(&mut self, sample: Sample, _question: Question) {
        self.judged += u64::from(self.sample == Some(sample));
    }
}
