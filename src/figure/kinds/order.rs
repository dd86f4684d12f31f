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
        let y = TOPS[row] + 0.5 * MAP[1];
        let [_, height] = if row == 0 { small.image() } else { view.camera.image() };
        let width = if row == 0 { small.image()[0] } else { view.camera.image()[0] };
        let words = [
            (method.name(), theme.heading()),
            (&*format!("{width} × {height} pixels"), theme.label()),
        ];
        sheet.lines([MARGIN, y], 280.0, 36.0, &words);
        for (column, order) in Order::ALL.into_iter().enumerate() {
            let corner = [LEFTS[column], TOPS[row]];
            let clock = match method {
                Method::Textbook => textbook(&View::new(view.scene, &small), order),
                Method::Fast => {
                    let mut clock = Clock::new(order);
                    watch_in_order(view, order, &mut clock);
                    clock
                }
            };
            let image = if row == 0 { small.image() } else { view.camera.image() };
            let (_, size) = fit(&mut sheet, clock.picture(image, theme), corner, MAP);
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
        "a step: one primitive,",
        label.sized(19.0),
    );
    sheet.drawing.text(
        [MARGIN, y + 40.0],
        Anchor::Left,
        "or one box, is tested",
        label.sized(19.0),
    );
    Ok(sheet.drawing)
}

/// The camera with an image so small that the textbook ends soon.
fn smaller(view: &View) -> Camera {
    let [width, height] = view.camera.image();
    let pixels = u64::from(width) * u64::from(height);
    let most = (MOST_TESTS / u64::from(view.scene.primitive_count()).max(1)).max(64);
    let scale = (most as f64 / pixels as f64).sqrt().min(1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "smaller than a side"
    )]
    let image = [width, height].map(|side| ((f64::from(side) * scale) as u32).max(1));
    Camera::new(CameraDescription { image, ..*view.camera.description() })
        .expect("a smaller image is allowed")
}

fn textbook(view: &View, order: Order) -> Clock {
    let options = Options::default();
    let mut frame = Frame::new(view.camera, &options);
    let mut clock = Clock::new(order);
    match order {
        Order::Object => {
            rasterize::textbook::determine_visibility(view, &options, &mut frame, &mut clock)
        }
        Order::Image => {
            raytrace::textbook::determine_visibility(view, &options, &mut frame, &mut clock)
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
    decided: HashMap<Sample, u64>,
}

impl Clock {
    fn new(order: Order) -> Clock {
        Clock { order, steps: 0, decided: HashMap::new() }
    }

    fn picture(&self, [width, height]: [u32; 2], theme: Theme) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| {
            let decided = self.decided.get(&Sample { row: y as usize, column: x as usize });
            let part = |at: &u64| *at as f64 / self.steps.max(1) as f64;
            Rgb(decided.map_or(theme.mat(), |at| ramp(part(at))))
        })
    }
}

impl Observer for Clock {
    fn fork(&self) -> Self {
        Clock::new(self.order)
    }

    fn join(&mut self, part: Self) {
        let before = self.steps;
        self.decided.extend(part.decided.into_iter().map(|(sample, at)| (sample, before + at)));
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
            self.decided.entry(sample).or_insert(self.steps);
        }
    }

    fn depth_test(&mut self, sample: Sample, _incoming: u32, _stored: u32, replaced: bool) {
        if self.order == Order::Object && replaced {
            self.decided.insert(sample, self.steps);
        }
    }

    fn hit(&mut self, sample: Sample, primitive: Option<u32>) {
        if self.order == Order::Image && primitive.is_some() {
            self.decided.insert(sample, self.steps);
        }
    }
}
