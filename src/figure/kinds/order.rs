//! When each order decided each pixel: the pixels coloured by the work that was done before.

use super::counts::{fit, scale_bar};
use super::work::watch;
use crate::common::observe::{Events, Observer};
use crate::common::raster::Sample;
use crate::common::{Camera, CameraDescription, Frame, Options, View};
use crate::figure::drawing::{Anchor, Drawing};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Theme, ramp};
use crate::orders::{Method, Order};
use crate::wording::count;
use crate::{rasterize, raytrace};
use image::{Rgb, RgbImage};
use std::collections::HashMap;

const MAP: [f64; 2] = [700.0, 320.0];
const TOPS: [f64; 2] = [TOP + 44.0, TOP + 424.0];
const LEFTS: [f64; 2] = [MARGIN + 300.0, MARGIN + 1060.0];
/// The most tests of a textbook's run: then a picture of fewer pixels is drawn.
const MOST_TESTS: u64 = 12_000_000;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let view = &subject.view;
    let theme = subject.theme;
    let point = "Object order goes through the scene, image order through the picture; at the end both show the same.";
    let mut sheet = Sheet::new(subject, "When is a pixel decided?", point);
    let small = smaller(view);
    for (row, method) in [Method::Textbook, Method::Fast].into_iter().enumerate() {
        let camera = match method {
            Method::Textbook => small.as_ref(),
            Method::Fast => Some(view.camera),
        };
        let y = TOPS[row] + 0.5 * MAP[1];
        let size = camera.map(Camera::image);
        let size = size.map_or("would take too long".into(), |[width, height]| {
            format!("{width} × {height} pixels")
        });
        let words = [(method.name(), theme.heading()), (&*size, theme.label())];
        sheet.lines([MARGIN, y], 280.0, 36.0, &words);
        let Some(camera) = camera else { continue };
        for (column, order) in Order::ALL.into_iter().enumerate() {
            let corner = [LEFTS[column], TOPS[row]];
            let clock = clock(&View::new(view.scene, camera), order, method);
            let picture = clock.picture(camera.image(), theme);
            let (_, size) = fit(&mut sheet, picture, corner, MAP);
            let note = count(clock.steps, "steps");
            sheet.heading(corner, size[0].max(400.0), order.name(), &note);
        }
    }
    let y = 944.0;
    let label = theme.label();
    let x = LEFTS[0];
    scale_bar(&mut sheet, [x, y], RIGHT - x, &[]);
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
    Ok(sheet.drawing)
}

/// The camera with an image so small that the textbook ends soon; `None` if that would be hardly a picture.
fn smaller(view: &View) -> Option<Camera> {
    const FEWEST: u64 = 48;
    let [width, height] = view.camera.image();
    let most = MOST_TESTS / u64::from(view.scene.primitive_count()).max(1);
    let scale = (most as f64 / (f64::from(width) * f64::from(height))).sqrt().min(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "smaller than a side"
    )]
    let [mut width, mut height] =
        [width, height].map(|side| ((f64::from(side) * scale) as u32).max(1));
    // A picture of one row or column is still too long.
    let longest = u32::try_from(most.max(1)).unwrap_or(u32::MAX);
    (width, height) =
        (width.min(longest / height.min(longest)), height.min(longest / width.min(longest)));
    let image = [width.max(1), height.max(1)];
    let pixels = u64::from(image[0]) * u64::from(image[1]);
    let whole = view.camera.image() == image;
    (pixels <= most.max(1) && (whole || pixels >= FEWEST)).then(|| {
        Camera::new(CameraDescription { image, ..*view.camera.description() })
            .expect("a smaller image is allowed")
    })
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
    /// For squares of samples, as far as anything is decided there: the steps before; [`NEVER`] for nothing.
    decided: HashMap<[usize; 2], Vec<u64>>,
}

/// No step.
const NEVER: u64 = u64::MAX;
/// The side of a square of samples that are stored together.
const SQUARE: usize = 16;

impl Clock {
    fn new(order: Order) -> Clock {
        Clock { order, steps: 0, decided: HashMap::new() }
    }

    /// When a sample was decided.
    fn at(&mut self, Sample { row, column }: Sample) -> &mut u64 {
        let square = self.decided.entry([row / SQUARE, column / SQUARE]);
        let square = square.or_insert_with(|| vec![NEVER; SQUARE * SQUARE]);
        &mut square[row % SQUARE * SQUARE + column % SQUARE]
    }

    fn picture(&self, [width, height]: [u32; 2], theme: Theme) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            let (row, column) = (y as usize, x as usize);
            let square = self.decided.get(&[row / SQUARE, column / SQUARE]);
            let at = square.map_or(NEVER, |square| square[row % SQUARE * SQUARE + column % SQUARE]);
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
        for (square, decided) in part.decided {
            let stored = self.decided.entry(square).or_insert_with(|| vec![NEVER; SQUARE * SQUARE]);
            for (stored, at) in stored.iter_mut().zip(decided).filter(|(_, at)| *at != NEVER) {
                *stored = before + at;
            }
        }
        self.steps += part.steps;
    }
}

impl Events for Clock {
    fn node_opened(&mut self, _sample: Sample, _node: u32, _entered: bool) {
        self.steps += 1;
    }

    fn sample_tested(&mut self, _sample: Sample, _primitive: u32) {
        self.steps += 1;
    }

    fn fragment(&mut self, sample: Sample, _primitive: u32) {
        if self.order == Order::Object {
            let steps = self.steps;
            let at = self.at(sample);
            *at = steps.min(*at);
        }
    }

    fn depth_test(&mut self, sample: Sample, _incoming: u32, _stored: u32, replaced: bool) {
        if self.order == Order::Object && replaced {
            let steps = self.steps;
            *self.at(sample) = steps;
        }
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u32>) {
        if self.order == Order::Image && primitive.is_some() {
            let steps = self.steps;
            *self.at(sample) = steps;
        }
    }
}
