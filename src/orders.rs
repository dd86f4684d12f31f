//! Both orders behind one door: which to run, how, and what it cost.

mod stream;

pub use stream::render_stream;

use crate::common::frame::NO_PRIMITIVE;
use crate::common::observe::budget::{Budget, WorkWithin};
use crate::common::{Camera, Frame, Observer, Options, Scene, View, Work};
use crate::progress::{Listener, Steps};
use crate::{rasterize, raytrace};
use serde::Serialize;
use std::convert::Infallible;
use std::sync::atomic::AtomicU64;
use std::time::{Duration, Instant};

/// Which loop is the outer one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Order {
    /// For each object, for each pixel: rasterization.
    Object,
    /// For each pixel, for each object: ray tracing.
    Image,
}

impl Order {
    /// The lecture's name for it.
    pub fn name(self) -> &'static str {
        match self {
            Order::Object => "object order",
            Order::Image => "image order",
        }
    }

    /// What everybody else calls it.
    pub fn common_name(self) -> &'static str {
        match self {
            Order::Object => "rasterization",
            Order::Image => "ray tracing",
        }
    }

    /// The lecture's two loops, the outer one first.
    pub fn loops(self) -> [&'static str; 2] {
        match self {
            Order::Object => ["for each object in the scene", "for each pixel it may affect"],
            Order::Image => ["for each pixel in the image", "for each object its ray may hit"],
        }
    }

    /// How its files' names begin or end.
    pub fn file_stem(self) -> &'static str {
        match self {
            Order::Object => "object-order",
            Order::Image => "image-order",
        }
    }
}

/// How an order skips work that cannot matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// With all its machinery.
    #[default]
    Fast,
    /// Not at all: every primitive at every sample.
    Textbook,
}

impl Method {
    /// Its name on the command line and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Method::Fast => "fast",
            Method::Textbook => "textbook",
        }
    }
}

/// What one order saw, and what it cost.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// Which order it was.
    pub order: Order,
    /// How it was run.
    pub method: Method,
    /// What it saw.
    pub frame: Frame,
    /// How much was done for one frame.
    pub work: Counts,
    /// How long it took; `None` if times are to be left out.
    pub times: Option<Times>,
}

impl Rendered {
    /// How many samples are covered.
    pub fn covered(&self) -> u64 {
        self.frame.ids().iter().filter(|&&id| id != NO_PRIMITIVE).count() as u64
    }

    /// The work for one frame, if it was counted.
    pub fn work(&self) -> Option<&Work> {
        match &self.work {
            Counts::Counted(work) => Some(work),
            Counts::TooMany { .. } | Counts::LeftOut => None,
        }
    }
}

/// What was counted of the work for a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Counts {
    /// All of it.
    Counted(Work),
    /// Nothing: it is more than so many steps, as [`Work::steps`] has them.
    TooMany {
        /// See [`most_steps`].
        most: u64,
    },
    /// Nothing: nobody wanted it counted.
    LeftOut,
}

/// At how many steps counting is given up, for a frame of so many samples: 2¹⁰ a sample and 2²⁸ besides. Rays meet
/// some hundred boxes and triangles each, as a rule; who has more to count has it without end.
pub fn most_steps(samples: u64) -> u64 {
    (1 << 28) + (samples << 10)
}

/// How long the parts of a rendering took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// Work on the scene alone, which a moving camera would not repeat.
    pub prepare: Spread,
    /// Per frame: from the cleared frame to all ids and distances.
    pub visibility: Spread,
    /// Per frame: normals and colours of what is visible.
    pub shading: Spread,
}

/// Repeated measurements of one thing, in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The middle one; of an even number, the mean of the middle two.
    pub median: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
}

/// Preparing is repeated as often as a frame, but only until this much time is spent on it.
const PREPARE_BUDGET: Duration = Duration::from_secs(2);
/// What takes no longer than this is done twice to be timed once: the first time brings memory and caches in.
const WARM_UP_BUDGET: Duration = Duration::from_millis(200);

/// How an order is to be run and told of. The default: one sample a pixel, one frame, told to nobody.
#[derive(Clone, Copy, Default)]
pub struct RenderOptions<'a> {
    /// What a frame holds.
    pub frame: Options,
    /// With a number, everything is done once to warm up and then timed so many times, into the same
    /// buffers; without, it is timed once, warmed up by what went before. Never 0.
    pub repeat: Option<u32>,
    /// Whether the frame that counts the work is left out. It may take longer than those that are timed.
    pub no_counts: bool,
    /// Who is told how far the rendering has come; that changes no bit of the answer.
    pub progress: Option<Listener<'a>>,
}

impl std::fmt::Debug for RenderOptions<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        let RenderOptions { frame, repeat, no_counts, progress } = self;
        let progress = progress.map(|_| "a listener");
        formatter
            .debug_struct("RenderOptions")
            .field("frame", frame)
            .field("repeat", repeat)
            .field("no_counts", no_counts)
            .field("progress", &progress)
            .finish()
    }
}

impl RenderOptions<'_> {
    /// How many frames are rendered: one that counts the work, one to warm up, and the timed ones.
    fn frames(&self, counting: &Counting) -> u64 {
        counting.frames() + self.repeat.map_or(1, |repeat| 1 + u64::from(repeat))
    }
}

/// Renders a view in one order, on the rayon pool that this is called in.
///
/// The work is counted in a frame of its own, before the timed ones, as long as it is at most
/// [`most_steps`].
///
/// # Panics
///
/// If `repeat` is 0, or the camera does not allow this number of samples.
///
/// ```
/// use bothways::common::{Camera, View};
/// use bothways::orders::{self, Method, Order, RenderOptions};
///
/// let scene = bothways::scenes::load("canonical")?.scene;
/// let camera = Camera::canonical(32, 32);
/// let told = |progress: bothways::progress::Progress| {
///     eprintln!("{} of {}", progress.done, progress.total);
/// };
/// let options = RenderOptions { progress: Some(&told), ..RenderOptions::default() };
/// let view = View::new(&scene, &camera);
/// let rendered = orders::render(Order::Object, Method::Textbook, &view, &options);
/// assert!(rendered.covered() > 0);
/// # Ok::<(), bothways::scenes::LoadError>(())
/// ```
pub fn render(order: Order, method: Method, view: &View, options: &RenderOptions) -> Rendered {
    let outer_loop = match (method, order) {
        (Method::Fast, _) => None,
        (Method::Textbook, Order::Object) => Some(view.scene.primitive_count().into()),
        (Method::Textbook, Order::Image) => {
            let rows = options.frame.pixels(view.camera.image()).height;
            Some(u64::from(rows) * u64::from(options.frame.samples))
        }
    };
    let counting = Counting::new(view.camera, options);
    let counting = match method {
        Method::Fast => counting,
        Method::Textbook => counting.of_all_tests(view.scene.primitive_count()),
    };
    let done = AtomicU64::new(0);
    let frames = options.frames(&counting);
    let steps = Steps::new(order, options.progress, outer_loop, frames, &done);
    let measure = match (order, method) {
        (Order::Object, Method::Fast) => measure::<FastRasterizer>,
        (Order::Object, Method::Textbook) => measure::<TextbookRasterizer>,
        (Order::Image, Method::Fast) => measure::<FastRayTracer>,
        (Order::Image, Method::Textbook) => measure::<TextbookRayTracer>,
    };
    let (frame, work, times) = measure(view, options, &counting, &steps);
    Rendered { order, method, frame, work, times: Some(times) }
}

/// Whether the work is counted.
#[derive(Clone, Copy, Debug)]
enum Counting {
    /// In a frame of its own, as long as it is at most so many steps.
    AtMost { most: u64, samples: u64 },
    /// It is not, for a reason that is known beforehand.
    Not(Counts),
}

impl Counting {
    fn new(camera: &Camera, options: &RenderOptions) -> Counting {
        if options.no_counts {
            return Counting::Not(Counts::LeftOut);
        }
        let Options { samples, .. } = options.frame;
        let samples = options.frame.pixels(camera.image()).region(samples).area() as u64;
        Counting::AtMost { most: most_steps(samples), samples }
    }

    /// The same where every primitive is tested at every sample: then it is known whether that is too much.
    fn of_all_tests(self, primitives: u32) -> Counting {
        match self {
            Counting::AtMost { most, samples }
                if u64::from(primitives).saturating_mul(samples) > most =>
            {
                Counting::Not(Counts::TooMany { most })
            }
            counting => counting,
        }
    }

    fn frames(&self) -> u64 {
        u64::from(matches!(self, Counting::AtMost { .. }))
    }

    /// Counts the work of a frame that is drawn for it.
    fn count<E>(&self, draw: impl FnOnce(&mut WorkWithin) -> Result<(), E>) -> Result<Counts, E> {
        match *self {
            Counting::Not(counts) => Ok(counts),
            Counting::AtMost { most, .. } => {
                let budget = Budget::new(most);
                let mut work = WorkWithin::new(&budget);
                draw(&mut work)?;
                Ok(work.work().map_or(Counts::TooMany { most }, Counts::Counted))
            }
        }
    }
}

/// What the four renderers have in common.
trait Renderer {
    type Prepared;
    fn prepare(scene: &Scene) -> Self::Prepared;
    fn determine_visibility(
        prepared: &Self::Prepared,
        view: &View,
        options: &Options,
        frame: &mut Frame,
        observer: &mut impl Observer,
    );
    fn shade(view: &View, frame: &mut Frame);
}

macro_rules! renderer {
    ($name:ident: fast $order:ident) => {
        struct $name;

        impl Renderer for $name {
            type Prepared = $order::fast::Prepared;

            fn prepare(scene: &Scene) -> Self::Prepared {
                $order::fast::prepare(scene)
            }

            fn determine_visibility(
                prepared: &Self::Prepared,
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) {
                $order::fast::determine_visibility(prepared, view, options, frame, observer);
            }

            fn shade(view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
    ($name:ident: textbook $order:ident) => {
        struct $name;

        impl Renderer for $name {
            type Prepared = ();

            fn prepare(_scene: &Scene) {}

            fn determine_visibility(
                (): &(),
                view: &View,
                options: &Options,
                frame: &mut Frame,
                observer: &mut impl Observer,
            ) {
                $order::textbook::determine_visibility(view, options, frame, observer);
            }

            fn shade(view: &View, frame: &mut Frame) {
                $order::shade(view, frame);
            }
        }
    };
}

renderer! { FastRasterizer: fast rasterize }
renderer! { TextbookRasterizer: textbook rasterize }
renderer! { FastRayTracer: fast raytrace }
renderer! { TextbookRayTracer: textbook raytrace }

fn measure<R: Renderer>(
    view: &View,
    &RenderOptions { frame: ref options, repeat, .. }: &RenderOptions,
    counting: &Counting,
    steps: &Steps,
) -> (Frame, Counts, Times) {
    steps.preparing();
    let (prepared, prepare) = measure_preparing::<R>(view.scene, repeat);
    let mut frame = Frame::new(view.camera, options);

    steps.frames_done(0);
    let Ok(work) = counting.count::<Infallible>(|work| {
        watched::<R, _>(&prepared, view, options, &mut frame, work, steps);
        Ok(())
    });
    steps.frames_done(counting.frames());

    let run = |part| {
        match part {
            Part::Visibility => {
                watched::<R, _>(&prepared, view, options, &mut frame, &mut (), steps);
            }
            Part::Shading => R::shade(view, &mut frame),
        }
        Ok(())
    };
    let Ok([visibility, shading]) = repeated::<Infallible>(repeat, steps, run);
    (frame, work, Times { prepare, visibility, shading })
}

/// A part of rendering a frame.
#[derive(Clone, Copy)]
enum Part {
    Visibility,
    Shading,
}

/// Renders the frames that follow those drawn before, in which the work is counted, and tells how long visibility and shading
/// took. Each is repeated by itself, so that no shading lies between two frames of which visibility is timed: it
/// does not in other programs, which ours are held against.
fn repeated<E>(
    repeat: Option<u32>,
    steps: &Steps,
    mut run: impl FnMut(Part) -> Result<(), E>,
) -> Result<[Spread; 2], E> {
    let mut drawn = steps.frames_drawn();
    let mut spread_of = |part| {
        // One more to warm up.
        let runs = repeat.map_or(1, |repeat| u64::from(repeat) + 1);
        let mut times = Vec::new();
        for _ in 0..runs {
            let (done, time) = timed(|| run(part));
            done?;
            times.push(time);
            if matches!(part, Part::Visibility) {
                drawn += 1;
                steps.frames_done(drawn);
            }
        }
        Ok(Spread::of(times.split_off(usize::from(repeat.is_some()))))
    };
    Ok([spread_of(Part::Visibility)?, spread_of(Part::Shading)?])
}

/// Finds what is visible, and tells of the steps within the frame if somebody wants to know.
fn watched<R: Renderer, O: Observer>(
    prepared: &R::Prepared,
    view: &View,
    options: &Options,
    frame: &mut Frame,
    observer: &mut O,
    steps: &Steps,
) {
    match steps.watch() {
        None => R::determine_visibility(prepared, view, options, frame, observer),
        Some(watch) => {
            let mut both = (observer.fork(), watch);
            R::determine_visibility(prepared, view, options, frame, &mut both);
            observer.join(both.0);
        }
    }
}

fn measure_preparing<R: Renderer>(scene: &Scene, repeat: Option<u32>) -> (R::Prepared, Spread) {
    let begun = Instant::now();
    let (mut prepared, first) = timed(|| R::prepare(scene));
    // The first one was the warm-up; without `repeat`, too, unless somebody would wait for the second.
    let repeat = repeat.unwrap_or(u32::from(begun.elapsed() < WARM_UP_BUDGET));
    if repeat == 0 {
        return (prepared, Spread::of(vec![first]));
    }
    let mut times = Vec::new();
    for _ in 0..repeat {
        // Never two at once: they are what takes memory.
        drop(prepared);
        let (next, time) = timed(|| R::prepare(scene));
        prepared = next;
        times.push(time);
        if begun.elapsed() > PREPARE_BUDGET {
            break;
        }
    }
    (prepared, Spread::of(times))
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begun = Instant::now();
    let result = work();
    (result, begun.elapsed().as_secs_f64() * 1e3)
}

impl Spread {
    /// The spread of some measurements in milliseconds, to a tenth of a microsecond.
    ///
    /// # Panics
    ///
    /// If there are none.
    pub fn of(mut times: Vec<f64>) -> Spread {
        times.sort_by(f64::total_cmp);
        let rounded = |time: f64| (time * 1e4).round() / 1e4;
        let last = times.len() - 1;
        Spread {
            median: rounded(f64::midpoint(times[last / 2], times[last.div_ceil(2)])),
            min: rounded(times[0]),
            max: rounded(times[last]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::glam::Vec3;
    use crate::common::{Shape, Sphere};
    use crate::progress::{Progress, Stage};
    use std::sync::Mutex;

    #[test]
    fn the_median_lies_in_the_middle() {
        let odd = Spread { median: 2.0, min: 1.0, max: 9.0 };
        assert_eq!(Spread::of(vec![9.0, 1.0, 2.0]), odd);
        let even = Spread { median: 2.5, min: 1.0, max: 9.0 };
        assert_eq!(Spread::of(vec![9.0, 3.0, 1.0, 2.0]), even);
    }

    fn two_balls() -> Scene {
        let ball = |x| Shape::Sphere(Sphere { center: Vec3::new(x, 0.0, -3.0), radius: 1.0 });
        Scene::new(vec![ball(0.0).into(), ball(0.5).into()]).unwrap()
    }

    #[test]
    fn repeating_changes_neither_picture_nor_counts() {
        let scene = two_balls();
        let camera = Camera::canonical(9, 7);
        let view = View::new(&scene, &camera);
        for order in [Order::Object, Order::Image] {
            for method in [Method::Fast, Method::Textbook] {
                let once = render(order, method, &view, &RenderOptions::default());
                let repeating = RenderOptions { repeat: Some(3), ..RenderOptions::default() };
                let thrice = render(order, method, &view, &repeating);
                assert_eq!((once.frame, once.work), (thrice.frame, thrice.work));
            }
        }
    }

    #[test]
    fn the_largest_number_of_repetitions_is_no_smaller_one() {
        let done = AtomicU64::new(0);
        let steps = Steps::new(Order::Object, None, None, 1, &done);
        let mut runs = 0;
        let spreads = repeated(Some(u32::MAX), &steps, |_| {
            runs += 1;
            if runs < 5 { Ok(()) } else { Err("enough") }
        });
        assert_eq!((spreads, runs), (Err("enough"), 5));
    }

    #[test]
    fn progress_is_told_to_the_end_and_changes_nothing() {
        let (scene, camera) = (two_balls(), Camera::canonical(9, 7));
        let view = View::new(&scene, &camera);
        let frame = Options { samples: 2, ..Options::default() };
        // Steps within a frame: frames, primitives, or rows of samples.
        for (order, method, steps) in [
            (Order::Object, Method::Fast, 1),
            (Order::Object, Method::Textbook, 2),
            (Order::Image, Method::Fast, 1),
            (Order::Image, Method::Textbook, 14),
        ] {
            for (repeat, frames) in [(None, 2), (Some(1), 3), (Some(3), 5)] {
                let told = Mutex::new(Vec::new());
                let listener = |progress| told.lock().unwrap().push(progress);
                let options = RenderOptions {
                    frame,
                    repeat,
                    progress: Some(&listener),
                    ..RenderOptions::default()
                };
                let told_of = render(order, method, &view, &options);
                let options = RenderOptions { progress: None, ..options };
                let alone = render(order, method, &view, &options);
                assert_eq!((told_of.frame, told_of.work), (alone.frame, alone.work));

                let total = steps * frames;
                let step = |stage, done| Progress { order, stage, done, total };
                let rendering = (0..=total).map(|done| step(Stage::Rendering, done));
                let mut expected = vec![step(Stage::Preparing, 0)];
                expected.extend(rendering);
                assert_eq!(told.into_inner().unwrap(), expected, "{order:?} {method:?}");
            }
        }
    }
}
