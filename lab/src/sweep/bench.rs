//! Carries out the measurements of a sweep.

use super::case::Case;
use super::plan::{Quantity, Task};
use super::table::{Measured, Source};
use crate::common::{Camera, Frame, Options, Scene, View, Work};
use crate::orders::{Method, Order};
use crate::{rasterize, raytrace};
use std::time::{Duration, Instant};

/// A textbook that tests no more pairs of a primitive and a sample is counted while it runs; beyond, its count is known
/// by the definition of its loops.
const COUNTED_BY_RUNNING: u64 = 1 << 22;
/// The frames of one measured time, after one that warms up; their median counts.
const FRAMES: usize = 5;
/// After this much time, no further frame is begun.
const BUDGET: Duration = Duration::from_millis(600);

/// Carries out measurements, on the current rayon pool. It keeps the scene and what each order prepared of it, so that
/// consecutive measurements of one scene share them.
#[derive(Debug, Default)]
pub struct Bench {
    stage: Option<Stage>,
}

#[derive(Debug)]
struct Stage {
    case: Case,
    scene: Scene,
    camera: Camera,
    rasterizer: rasterize::fast::Prepared,
    ray_tracer: raytrace::fast::Prepared,
}

impl Bench {
    /// Carries out one measurement.
    pub fn measure(&mut self, task: &Task) -> Measured {
        let pairs = task.case.triangles * task.case.samples();
        if task.quantity == Quantity::Steps
            && task.method == Method::Textbook
            && pairs > COUNTED_BY_RUNNING
        {
            let value = by_definition(task) as f64;
            return Measured { value, source: Source::ByDefinition };
        }
        let stage = self.stage(task.case);
        match task.quantity {
            Quantity::Steps => {
                let mut work = Work::default();
                stage.draw(task, &mut frame(stage), Some(&mut work));
                Measured { value: steps(&work) as f64, source: Source::Counted }
            }
            Quantity::Milliseconds => {
                Measured { value: time(stage, task), source: Source::Measured }
            }
        }
    }

    /// The scene of a case, prepared for both orders.
    fn stage(&mut self, case: Case) -> &Stage {
        if self.stage.as_ref().is_none_or(|stage| stage.case != case) {
            // Two scenes never exist at once: they take much memory.
            self.stage = None;
        }
        self.stage.get_or_insert_with(|| Stage::new(case))
    }
}

/// Iterations of all loops: the outer ones begin primitives or rays, the inner ones test boxes and primitives.
pub fn steps(work: &Work) -> u64 {
    work.primitives + work.rays + work.nodes + work.tests
}

/// The steps of a textbook: every primitive at every sample, and the outer loop.
fn by_definition(task: &Task) -> u64 {
    let (triangles, samples) = (task.case.triangles, task.case.samples());
    let outer = match task.order {
        Order::Object => triangles,
        Order::Image => samples,
    };
    outer + triangles * samples
}

/// The median of some frames, in milliseconds. A textbook draws one frame only: it has nothing to warm up.
fn time(stage: &Stage, task: &Task) -> f64 {
    let mut frame = frame(stage);
    let mut timed = || {
        let begun = Instant::now();
        stage.draw(task, &mut frame, None);
        begun.elapsed().as_secs_f64() * 1e3
    };
    if task.method == Method::Textbook {
        return rounded(timed());
    }
    timed();
    let begun = Instant::now();
    let mut times = Vec::new();
    while times.len() < FRAMES && (times.is_empty() || begun.elapsed() < BUDGET) {
        times.push(timed());
    }
    times.sort_by(f64::total_cmp);
    rounded(times[times.len() / 2])
}

/// To a tenth of a microsecond, but never 0: a logarithm is taken of it.
fn rounded(time: f64) -> f64 {
    ((time * 1e4).round() / 1e4).max(1e-4)
}

fn frame(stage: &Stage) -> Frame {
    Frame::new(&stage.camera, &Options::default())
}

impl Stage {
    fn new(case: Case) -> Stage {
        let (shape, camera) = case.shape();
        debug_assert_eq!(shape.primitive_count() as u64, case.triangles, "{case:?}");
        let camera = Camera::new(camera).expect("it is a camera");
        let scene = Scene::new(vec![shape.into()]).expect("it is a scene");
        let rasterizer = rasterize::fast::prepare(&scene);
        let ray_tracer = raytrace::fast::prepare(&scene);
        Stage { case, scene, camera, rasterizer, ray_tracer }
    }

    /// Draws one frame, which may be counted.
    fn draw(&self, task: &Task, frame: &mut Frame, work: Option<&mut Work>) {
        let view = View::new(&self.scene, &self.camera);
        let options = Options::default();
        macro_rules! draw {
            ($draw:path $(, $prepared:expr)?) => {
                match work {
                    Some(work) => {
                        $draw($($prepared,)? &view, &options, frame, work);
                    }
                    None => {
                        $draw($($prepared,)? &view, &options, frame, &mut ());
                    }
                }
            };
        }
        match (task.order, task.method) {
            (Order::Object, Method::Textbook) => draw!(rasterize::textbook::determine_visibility),
            (Order::Image, Method::Textbook) => draw!(raytrace::textbook::determine_visibility),
            (Order::Object, Method::Fast) => {
                draw!(rasterize::fast::determine_visibility, &self.rasterizer)
            }
            (Order::Image, Method::Fast) => {
                draw!(raytrace::fast::determine_visibility, &self.ray_tracer)
            }
        }
    }
}
