//! The common entry point of both orders.

use super::counts::Counting;
use super::drawing::{InMemory, Streamed};
use super::measure::{Measured, frames, measure, prepared};
use super::options::RenderOptions;
use super::order::{Method, Order};
use super::rendered::Rendered;
use super::renderer::{
    FastRasterizer, FastRayTracer, OrdinaryRasterizer, OrdinaryRayTracer, TextbookRasterizer,
    TextbookRayTracer,
};
use super::rules::Rule;
use super::source::Source;
use super::times::Spread;
use crate::formats::mesh_stream::StreamError;
use crate::progress::Steps;
use std::sync::atomic::AtomicU64;

/// Renders a scene or a stream in one order, on the current rayon pool.
///
/// A separate frame before the timed frames counts the work of the algorithm, up to [`most_steps`](super::most_steps).
/// What the frame executed is counted in the timed frames themselves.
///
/// A stream is read once for every frame; the time for visibility includes the reading of all faces.
///
/// # Errors
///
/// An error in the file of a stream; a scene in memory has no errors.
///
/// # Panics
///
/// If `repeat` is 0, the camera does not allow this number of samples, the order has a rule and the method is not fast,
/// or the source is a stream and it is not object order, fast and exact.
///
/// ```
/// use bothways_lab::common::{Camera, View};
/// use bothways_lab::orders::{self, Method, Order, RenderOptions};
///
/// let scene = bothways_lab::scenes::load("canonical")?.scene;
/// let camera = Camera::canonical(32, 32);
/// let listener = |progress: bothways_lab::progress::Progress| {
///     eprintln!("{} of {}", progress.done, progress.total);
/// };
/// let options = RenderOptions { progress: Some(&listener), ..RenderOptions::default() };
/// let view = View::new(&scene, &camera);
/// let rendered = orders::render(Order::Object, Method::Textbook, &view, &options)?;
/// assert!(rendered.covered() > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn render<'a>(
    order: Order,
    method: Method,
    source: impl Into<Source<'a>>,
    options: &RenderOptions,
) -> Result<Rendered, StreamError> {
    let source = source.into();
    let rule = options.rules.of(order);
    assert!(rule.is_none() || method == Method::Fast, "a textbook has the exact rules");
    let samples = options.frame.pixels(source.camera().image()).region(options.frame.samples);
    let counting = Counting::new(options, order, samples.area() as u64);
    let counting = match (method, &source) {
        (Method::Textbook, Source::View(view)) => {
            counting.of_all_tests(view.scene.primitive_count())
        }
        _ => counting,
    };
    let done = AtomicU64::new(0);
    let is_cheap = matches!((method, rule, &source), (Method::Fast, None, Source::View(_)));
    let frames = frames(options, &counting, is_cheap);
    let within_frame = source.steps_of_a_frame(order, method, &options.frame);
    let steps = Steps::new(order, options.progress, within_frame, frames, &done);
    let Measured { frame, work, executed, times } = match source {
        Source::View(view) => {
            macro_rules! measured {
                ($renderer:expr) => {
                    measure(options, &counting, frames, &steps, || {
                        let (prepared, time) = prepared(&$renderer, view.scene, options);
                        (InMemory::new($renderer, &view, options, prepared), time)
                    })
                };
            }
            let Ok(measured) = match (rule, order, method) {
                (Some(Rule::Object(rule)), ..) => measured!(OrdinaryRasterizer(rule)),
                (Some(Rule::Image(rule)), ..) => measured!(OrdinaryRayTracer(rule)),
                (None, Order::Object, Method::Fast) => measured!(FastRasterizer),
                (None, Order::Object, Method::Textbook) => measured!(TextbookRasterizer),
                (None, Order::Image, Method::Fast) => measured!(FastRayTracer),
                (None, Order::Image, Method::Textbook) => measured!(TextbookRayTracer),
            };
            measured
        }
        Source::Stream { mesh, camera, look, opening } => {
            assert_eq!(
                (order, method, rule),
                (Order::Object, Method::Fast, None),
                "every ray and every textbook needs the whole scene in memory"
            );
            measure(options, &counting, frames, &steps, || {
                let time = Spread::of(vec![opening.as_secs_f64() * 1e3]);
                (Streamed::new(mesh, camera, look, options), time)
            })?
        }
    };
    Ok(Rendered { order, method, rule, frame, work, executed, times })
}
