//! When each order decided each pixel: the pixels coloured by the work that was done before.

use super::counts::scale_bar;
use super::work::watch;
use crate::common::observe::{Events, Observer};
use crate::common::raster::Sample;
use crate::common::{Camera, Frame, Options, View};
use crate::figure::drawing::{Anchor, Drawing, Pen};
use crate::figure::marks::mark;
use crate::figure::resize::within;
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP, drawn_size};
use crate::figure::subject::{FigureError, Subject, with_image};
use crate::figure::theme::{Theme, ramp};
use crate::orders::{Method, Order};
use crate::sample_map::SampleMap;
use crate::wording::count;
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};

/// The room of a map; the maps of a row stand side by side, with the curves at their right.
const MAP: [f64; 2] = [520.0, 320.0];
const TOPS: [f64; 2] = [TOP + 44.0, TOP + 424.0];
const LEFT: f64 = MARGIN + 272.0;
const GAP: f64 = 44.0;
/// The least width of a map's heading.
const HEADING: f64 = 400.0;
/// The most tests of a textbook's run: then a picture of fewer pixels is drawn.
const MOST_TESTS: u64 = 40_000_000;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let theme = subject.theme;
    let point = "Object order goes through the scene, image order through the picture; at the end both show the same.";
    let mut sheet = Sheet::new(subject, "When is a pixel decided?", point);
    let small = smaller(view);
    // Both rows have the same columns, though their pictures may have other sizes.
    let widths = small.iter().chain([view.camera]).map(|camera| drawn_size(camera.image(), MAP)[0]);
    let column = widths.map(f64::from).fold(HEADING, f64::max);
    for (row, method) in [Method::Textbook, Method::Fast].into_iter().enumerate() {
        let camera = match method {
            Method::Textbook => small.as_ref(),
            Method::Fast => Some(view.camera),
        };
        let top = TOPS[row];
        let size = camera.map(Camera::image);
        let size = size.map_or("would take too long".into(), |[width, height]| {
            format!("{width} × {height} pixels")
        });
        let words = [(method.name(), theme.heading()), (&*size, theme.label())];
        sheet.lines([MARGIN, top + 0.5 * MAP[1]], LEFT - MARGIN - 20.0, 36.0, &words);
        let Some(camera) = camera else { continue };
        let view = View::new(view.scene, camera);
        let (object_order, image_order) = rayon::join(
            || clock(&view, Order::Object, method),
            || clock(&view, Order::Image, method),
        );
        let clocks = [object_order, image_order];
        let mut left = LEFT;
        for clock in &clocks {
            let size = sheet.picture(clock.picture(camera.image(), theme), [left, top], MAP);
            sheet.heading(
                [left, top],
                size[0].max(HEADING),
                clock.order.name(),
                &count(clock.steps, "steps"),
            );
            left += column + GAP;
        }
        curves(&mut sheet, &clocks, camera.image(), [left, top]);
    }
    legend(&mut sheet);
    Ok(sheet.drawing)
}

/// What the colours and the word step mean.
fn legend(sheet: &mut Sheet) {
    let label = sheet.theme.label();
    let [x, y] = [LEFT, 944.0];
    scale_bar(sheet, [x, y], RIGHT - x, &[]);
    sheet.drawing.text([x, y + 40.0], Anchor::Left, "decided first", label);
    sheet.drawing.text(
        [0.5 * (x + RIGHT), y + 40.0],
        Anchor::Middle,
        "half of this order's steps are done",
        label,
    );
    sheet.drawing.text([RIGHT, y + 40.0], Anchor::Right, "last", label);
    sheet.drawing.text(
        [MARGIN, y + 14.0],
        Anchor::Left,
        "a step: one primitive or one",
        label.sized(19.0),
    );
    sheet.drawing.text(
        [MARGIN, y + 40.0],
        Anchor::Left,
        "box is tested; plain: nothing",
        label.sized(19.0),
    );
}

/// How many pixels each order has decided after which part of its steps.
fn curves(sheet: &mut Sheet, clocks: &[Clock; 2], image: [u32; 2], corner: [f64; 2]) {
    let theme = sheet.theme;
    let size = [RIGHT - corner[0], MAP[1]];
    sheet.heading(corner, size[0], "pixels decided", "up to all, by the part of its own steps");
    sheet.mat(corner, size);
    let lines = clocks.each_ref().map(|clock| {
        let course = clock.course(image).into_iter();
        let place = |[steps, pixels]: [f64; 2]| {
            [corner[0] + steps * size[0], corner[1] + (0.97 - 0.92 * pixels) * size[1]]
        };
        course.map(place).collect::<Vec<_>>()
    });
    for (clock, line) in clocks.iter().zip(&lines) {
        let pen = Pen::new(theme.of(clock.order.into()), 4.0);
        let pen = if clock.order == Order::Image { pen.dashed(14.0, 10.0) } else { pen };
        sheet.drawing.line(line, pen);
    }
    // Each mark has a place of its own, so that curves that coincide are told apart.
    let marked = clocks.iter().zip(&lines).map(|(clock, line)| {
        let (third, side) = match clock.order {
            Order::Object => (2, [0.7, 1.0]),
            Order::Image => (1, [-0.7, -1.0]),
        };
        (clock.order, line[third * line.len() / 3], side)
    });
    for (order, at, _) in marked.clone() {
        mark(&mut sheet.drawing, order, at, 10.0, theme.ink(order.into()));
    }
    sheet.drawing.window(Some((corner, size)));
    for (order, at, side) in marked {
        let style = theme.label().of(theme.of(order.into())).semi_bold();
        sheet.drawing.label(at, side, order.name(), style, Some(theme.mat()));
    }
    sheet.drawing.window(None);
    sheet.border(corner, size);
}

/// The camera with an image so small that the textbook ends soon; `None` if that would be hardly a picture.
fn smaller(view: &View) -> Option<Camera> {
    const FEWEST: u64 = 48;
    let most = MOST_TESTS / view.scene.primitive_count().max(1);
    let image = view.camera.image();
    let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    if pixels(image) <= most {
        return Some(*view.camera);
    }
    let image = within(image, most).filter(|image| pixels(*image) >= FEWEST)?;
    Some(with_image(view.camera, image))
}

/// Renders, and gives when each pixel was decided.
fn clock(view: &View, order: Order, method: Method) -> Clock {
    let mut clock = Clock::new(order);
    if method == Method::Fast {
        watch_in_order(view, order, &mut clock);
        return clock;
    }
    let options = Options::default();
    let mut frame = Frame::new(view.camera, &options);
    match order {
        Order::Object => {
            rasterize::textbook::determine_visibility(view, &options, &mut frame, &mut clock);
        }
        Order::Image => {
            raytrace::textbook::determine_visibility(view, &options, &mut frame, &mut clock);
        }
    }
    clock
}

/// Renders with one thread, so that the parts of the picture come one after the other.
fn watch_in_order(view: &View, order: Order, clock: &mut Clock) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    match pool {
        Ok(pool) => pool.install(|| watch(view, order, clock)),
        // The parts are joined in a fixed order in any case.
        Err(_) => watch(view, order, clock),
    }
}

/// An observer that keeps when each sample got what it shows.
#[derive(Clone, Debug)]
struct Clock {
    order: Order,
    steps: u64,
    /// The steps before each sample was decided; [`NEVER`] for nothing.
    decided: SampleMap<u64>,
}

/// No step.
const NEVER: u64 = u64::MAX;

impl Clock {
    fn new(order: Order) -> Clock {
        Clock { order, steps: 0, decided: SampleMap::new(NEVER) }
    }

    /// The part of the pixels that are decided after some parts of the steps, of those that show something.
    fn course(&self, [width, height]: [u32; 2]) -> Vec<[f64; 2]> {
        const PARTS: usize = 120;
        let samples = (0..height as usize)
            .flat_map(|row| (0..width as usize).map(move |column| Sample { row, column }));
        let mut decided: Vec<u64> =
            samples.map(|sample| self.decided.get(sample)).filter(|at| *at != NEVER).collect();
        decided.sort_unstable();
        (0..=PARTS)
            .map(|part| {
                let steps = part as f64 / PARTS as f64;
                let so_far = decided.partition_point(|at| *at as f64 <= steps * self.steps as f64);
                [steps, so_far as f64 / decided.len().max(1) as f64]
            })
            .collect()
    }

    fn picture(&self, [width, height]: [u32; 2], theme: Theme) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            let at = self.decided.get(Sample { row: y as usize, column: x as usize });
            let part = at as f64 / self.steps.max(1) as f64;
            Rgb(if at == NEVER { theme.mat() } else { ramp(part) })
        })
    }
}

impl Observer for Clock {
    fn fork(&self) -> Self {
        Clock::new(self.order)
    }

    fn join(&mut self, part: Self) {
        let before = self.steps;
        self.decided.join(part.decided, |decided, at| {
            if at != NEVER {
                *decided = before + at;
            }
        });
        self.steps += part.steps;
    }
}

impl Events for Clock {
    fn node_opened(&mut self, _sample: Sample, _node: u32, _entered: bool) {
        self.steps += 1;
    }

    fn sample_tested(&mut self, _sample: Sample, _primitive: u64) {
        self.steps += 1;
    }

    fn fragment(&mut self, sample: Sample, _primitive: u64) {
        if self.order == Order::Object {
            let decided = self.decided.get_mut(sample);
            *decided = self.steps.min(*decided);
        }
    }

    fn depth_test(&mut self, sample: Sample, _incoming: u64, _stored: u64, replaced: bool) {
        if self.order == Order::Object && replaced {
            *self.decided.get_mut(sample) = self.steps;
        }
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u64>) {
        if self.order == Order::Image && primitive.is_some() {
            *self.decided.get_mut(sample) = self.steps;
        }
    }
}
