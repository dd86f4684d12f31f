//! Heat maps of the work at each sample, for both orders, textbook and fast, on one scale.

use super::counts::{Counted, Counts, heat_map, scale_bar};
use crate::common::observe::Observer;
use crate::common::raster::Region;
use crate::common::{Frame, Options, View};
use crate::figure::drawing::{Anchor, Drawing};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject};
use crate::orders::{Method, Order};
use crate::wording::{count, grouped};
use crate::{rasterize, raytrace};

/// The room of a map and of the words beside it.
const CELL: [f64; 2] = [876.0, 330.0];
const MAP: [f64; 2] = [430.0, 330.0];
const TOPS: [f64; 2] = [TOP + 44.0, TOP + 440.0];
const LEFTS: [f64; 2] = [MARGIN, MARGIN + 900.0];

/// The work at each sample of a picture.
#[derive(Clone, Debug)]
pub struct WorkMap {
    /// The order.
    pub order: Order,
    /// The method.
    pub method: Method,
    /// Rows and columns.
    pub size: [usize; 2],
    /// Primitives and boxes tested at each sample, row by row.
    pub counts: Vec<u64>,
}

/// Counts the work at each sample, for both orders, textbook and fast: primitives and boxes tested, each ray and each
/// primitive by itself. The textbooks need no run: they test every primitive at every sample.
pub fn work_maps(view: &View) -> Vec<WorkMap> {
    let all = [Method::Textbook, Method::Fast]
        .into_iter()
        .flat_map(|method| Order::ALL.map(move |order| (order, method)));
    let [width, height] = view.camera.image().map(|side| side as usize);
    all.map(|(order, method)| {
        let counts = match method {
            Method::Fast => work_at_samples(view, order, &Options::default()),
            Method::Textbook => vec![view.scene.primitive_count(); width * height],
        };
        WorkMap { order, method, size: [height, width], counts }
    })
    .collect()
}

/// Counts the work of the fast method at each sample of a frame with these options, row by row: primitives and boxes
/// tested, each ray and each primitive by itself.
///
/// # Panics
///
/// As [`Frame::new`].
pub fn work_at_samples(view: &View, order: Order, options: &Options) -> Vec<u64> {
    let raster = view.camera.image().map(|side| side * options.samples);
    let mut counts = Counts::new(raster, Counted::Tests);
    watch_with(view, order, options, &mut counts);
    let Region { rows, columns } = options.pixels(view.camera.image()).region(options.samples);
    rows.flat_map(|row| columns.clone().map(move |column| [row, column]))
        .map(|[row, column]| counts.at(row, column))
        .collect()
}

/// Renders by the fast method for an observer.
pub(super) fn watch(view: &View, order: Order, observer: &mut impl Observer) {
    watch_with(view, order, &Options::default(), observer);
}

fn watch_with(view: &View, order: Order, options: &Options, observer: &mut impl Observer) {
    let mut frame = Frame::new(view.camera, options);
    match order {
        Order::Object => {
            let prepared = rasterize::fast::prepare(view.scene);
            rasterize::fast::determine_visibility(&prepared, view, options, &mut frame, observer);
        }
        Order::Image => {
            let prepared = raytrace::fast::prepare(view.scene);
            raytrace::fast::determine_visibility(&prepared, view, options, &mut frame, observer);
        }
    }
}

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    Ok(work_figure(subject, &work_maps(&subject.view)))
}

/// Draws maps of work that are counted already: the figure of [`Kind::Work`](crate::figure::Kind::Work).
pub fn work_figure(subject: &Subject, maps: &[WorkMap]) -> Drawing {
    let point = "Counted as if each primitive and each ray were alone; a timed frame takes many together, and does less.";
    let mut sheet = Sheet::new(subject, "How many tests does each pixel take?", point);
    let most = maps.iter().flat_map(|map| map.counts.iter().copied()).max().unwrap_or(1).max(1);
    for (place, map) in maps.iter().enumerate() {
        let corner = [LEFTS[place % 2], TOPS[place / 2]];
        let name = format!("{}, {}", map.order.name(), map.method.name());
        sheet.heading(corner, CELL[0], &name, "");
        heat_map(&mut sheet, (map.size, &map.counts), corner, MAP, |count| shade(count, most));
        words(&mut sheet, map, [corner[0] + MAP[0] + 28.0, corner[1] + 34.0]);
    }
    let ticks = ticks(most);
    let wide = RIGHT - MARGIN - 330.0;
    let y = 956.0;
    sheet.drawing.text(
        [MARGIN, y + 14.0],
        Anchor::Left,
        "tests at a pixel, logarithmic:",
        sheet.theme.label(),
    );
    bar(&mut sheet, [MARGIN + 330.0, y], wide, &ticks, most);
    sheet.drawing
}

/// The place on the ramp, in equal ratios, so that 1 and the greatest number are its ends.
fn shade(count: u64, most: u64) -> f64 {
    (1.0 + count as f64).ln() / (1.0 + most as f64).ln()
}

/// Powers of ten up to the greatest number.
fn ticks(most: u64) -> Vec<u64> {
    let mut ticks: Vec<u64> = (0..20)
        .map(|power| 10_u64.saturating_pow(power))
        .take_while(|tick| *tick <= most)
        .collect();
    ticks.insert(0, 0);
    ticks
}

/// The scale, with a number at each power of ten.
fn bar(sheet: &mut Sheet, [x, y]: [f64; 2], width: f64, ticks: &[u64], most: u64) {
    scale_bar(sheet, [x, y], width, &[]);
    let mut free = x;
    for tick in ticks {
        let at = x + width * shade(*tick, most);
        let style = sheet.theme.label().sized(19.0);
        let half = 0.5 * f64::from(crate::figure::text::width(&grouped(*tick), style));
        let middle = at.clamp(x + half, x + width - half);
        if middle - half >= free {
            sheet.drawing.text([middle, y + 38.0], Anchor::Middle, &grouped(*tick), style);
            free = middle + half + 14.0;
        }
    }
}

fn words(sheet: &mut Sheet, map: &WorkMap, [x, y]: [f64; 2]) {
    let theme = sheet.theme;
    let width = CELL[0] - MAP[0] - 28.0;
    let total: u64 = map.counts.iter().sum();
    let most = map.counts.iter().copied().max().unwrap_or(0);
    let mean = total as f64 / map.counts.len() as f64;
    let (what, unit) = match (map.order, map.method) {
        (Order::Image, Method::Fast) => ("tests of a primitive, or a box, at a pixel", "tests"),
        _ => ("tests of a primitive at a pixel", "tests"),
    };
    let bold = theme.heading().sized(34.0);
    let mut y = sheet.lines([x, y], width, 40.0, &[(&grouped(total), bold)]);
    y = sheet.lines([x, y], width, 44.0, &[(what, theme.text().of(theme.quiet()))]);
    let lines = match map.method {
        Method::Textbook => vec![
            format!("{} at every pixel:", count(most, unit)),
            "every primitive, everywhere,".into(),
            "by the definition of the loop".into(),
        ],
        Method::Fast => vec![
            format!("{} a pixel on average", number(mean, 3)),
            format!("{} at most", grouped(most)),
        ],
    };
    let lines: Vec<_> = lines.iter().map(|line| (line.as_str(), theme.text())).collect();
    sheet.lines([x, y], width, 36.0, &lines);
}
