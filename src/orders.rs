//! Both orders behind one door: which to run, how, and what it cost.

mod stream;

pub use stream::render_stream;

use crate::common::frame::NO_PRIMITIVE;
use crate::common::{Frame, Observer, Options, Scene, View, Work};
use crate::{rasterize, raytrace};
use serde::Serialize;
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
    pub work: Work,
    /// How long it took; `None` if times are to be left out.
    pub times: Option<Times>,
}

impl Rendered {
    /// How many samples are covered.
    pub fn covered(&self) -> u64 {
        self.frame.ids().iter().filter(|&&id| id != NO_PRIMITIVE).count() as u64
    }
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

/// Renders a view in one order, on the rayon pool that this is called in.
///
/// With `repeat`, everything is done once to warm up and then timed so many times, into the same
/// buffers; without, it is timed once. The work is counted in a frame of its own, before the timed
/// ones.
///
/// # Panics
///
/// If `repeat` is 0, or the camera does not allow this number of samples.
pub fn render(
    order: Order,
    method: Method,
    view: &View,
    options: &Options,
    repeat: Option<u32>,
) -> Rendered {
    let (frame, work, times) = match (order, method) {
        (Order::Object, Method::Fast) => measure::<FastRasterizer>(view, options, repeat),
        (Order::Object, Method::Textbook) => measure::<TextbookRasterizer>(view, options, repeat),
        (Order::Image, Method::Fast) => measure::<FastRayTracer>(view, options, repeat),
        (Order::Image, Method::Textbook) => measure::<TextbookRayTracer>(view, options, repeat),
    };
    Rendered { order, method, frame, work, times: Some(times) }
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
    options: &Options,
    repeat: Option<u32>,
) -> (Frame, Work, Times) {
    let (prepared, prepare) = measure_preparing::<R>(view.scene, repeat);
    let mut frame = Frame::new(view.camera, options);

    let mut work = Work::default();
    R::determine_visibility(&prepared, view, options, &mut frame, &mut work);

    if repeat.is_some() {
        R::determine_visibility(&prepared, view, options, &mut frame, &mut ());
        R::shade(view, &mut frame);
    }
    let (mut visibility, mut shading) = (Vec::new(), Vec::new());
    for _ in 0..repeat.unwrap_or(1) {
        let ((), time) = timed(|| {
            R::determine_visibility(&prepared, view, options, &mut frame, &mut ());
        });
        visibility.push(time);
        let ((), time) = timed(|| R::shade(view, &mut frame));
        shading.push(time);
    }
    let times = Times { prepare, visibility: Spread::of(visibility), shading: Spread::of(shading) };
    (frame, work, times)
}

fn measure_preparing<R: Renderer>(scene: &Scene, repeat: Option<u32>) -> (R::Prepared, Spread) {
    let begun = Instant::now();
    let (mut prepared, first) = timed(|| R::prepare(scene));
    let Some(repeat) = repeat else {
        return (prepared, Spread::of(vec![first]));
    };
    // The first one was the warm-up.
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
    /// The spread of some measurements, to a tenth of a microsecond.
    ///
    /// # Panics
    ///
    /// If there are none.
    fn of(mut times: Vec<f64>) -> Spread {
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
    use crate::common::{Camera, Shape, Sphere};

    #[test]
    fn the_median_lies_in_the_middle() {
        let odd = Spread { median: 2.0, min: 1.0, max: 9.0 };
        assert_eq!(Spread::of(vec![9.0, 1.0, 2.0]), odd);
        let even = Spread { median: 2.5, min: 1.0, max: 9.0 };
        assert_eq!(Spread::of(vec![9.0, 3.0, 1.0, 2.0]), even);
    }

    #[test]
    fn repeating_changes_neither_picture_nor_counts() {
        let ball = Shape::Sphere(Sphere { center: Vec3::new(0.0, 0.0, -3.0), radius: 1.0 });
        let scene = Scene::new(vec![ball.into()]).unwrap();
        let camera = Camera::canonical(9, 7);
        let view = View::new(&scene, &camera);
        for order in [Order::Object, Order::Image] {
            for method in [Method::Fast, Method::Textbook] {
                let once = render(order, method, &view, &Options::default(), None);
                let thrice = render(order, method, &view, &Options::default(), Some(3));
                assert_eq!((once.frame, once.work), (thrice.frame, thrice.work));
            }
        }
    }
}
