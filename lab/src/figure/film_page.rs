//! A frame of a film: both pictures so far, the code with the line that runs, and how far both are on one clock.

use super::drawing::{Anchor, CANVAS, Drawing, Ink, Pen};
use super::fallback::drawable;
use super::marks::mark;
use super::resize::fitted;
use super::text::has;
use super::theme::{Role, Theme};
use crate::orders::Order;
use crate::wording::{count, grouped};
use image::RgbImage;

/// The content of a frame.
#[derive(Clone, Debug)]
pub(crate) struct FilmPage<'a> {
    pub(crate) scene: &'a str,
    pub(crate) facts: String,
    /// Object order, image order.
    pub(crate) halves: [FilmHalf<'a>; 2],
    /// The steps so far, and the steps of the order that takes longer.
    pub(crate) clock: u64,
    pub(crate) whole: u64,
    /// The pixels of a picture.
    pub(crate) pixels: u64,
    /// The finished pixels of both orders, for each frame so far, and the frames of the film.
    pub(crate) finished: &'a [[u64; 2]],
    pub(crate) frames: u32,
    /// At the end: what the comparison says, and whether both orders see the same.
    pub(crate) verdict: Option<String>,
    pub(crate) matches: bool,
}

/// One order in a frame.
#[derive(Clone, Debug)]
pub(crate) struct FilmHalf<'a> {
    pub(crate) order: Order,
    pub(crate) picture: &'a RgbImage,
    /// The pixels `[i, j]` that changed since the frame before.
    pub(crate) fresh: &'a [[u32; 2]],
    /// The pixel `[i, j]` that the loops are at.
    pub(crate) cursor: Option<[usize; 2]>,
    pub(crate) lines: Vec<CodeLine>,
    /// The line that runs.
    pub(crate) lit: usize,
    /// The pixels that look as in the finished picture.
    pub(crate) finished: u64,
}

/// A line of code, and the value of its variable.
#[derive(Clone, Debug)]
pub(crate) struct CodeLine {
    pub(crate) code: &'static str,
    pub(crate) indent: usize,
    pub(crate) variable: String,
}

const MARGIN: f64 = 48.0;
const RIGHT: f64 = CANVAS[0] - MARGIN;
const PANEL: f64 = 888.0;
/// The left edges of both panels.
const PANELS: [f64; 2] = [MARGIN, RIGHT - PANEL];
const TITLE: f64 = 56.0;
const HEADING: f64 = 104.0;
const PICTURE: f64 = 130.0;
const PICTURE_HEIGHT: f64 = 528.0;
const CODE: f64 = 670.0;
const LINE: f64 = 34.0;
const CLOCK: f64 = 880.0;
/// The top and the bottom of the curves.
const CURVES: [f64; 2] = [898.0, 1052.0];

impl FilmPage<'_> {
    /// The colours of a page without its pictures.
    pub(crate) fn colors(theme: Theme) -> Vec<[u8; 3]> {
        let roles = [Role::Object, Role::Image, Role::Good, Role::Bad, Role::Focus];
        let plain =
            [theme.background(), theme.mat(), theme.hairline(), theme.bright(), theme.quiet()];
        let roles = roles.map(|role| theme.of(role));
        plain.into_iter().chain(theme.nothing()).chain(roles).collect()
    }

    /// Draws the frame, for a film so many pixels wide: there, a pixel of the picture is a square of whole pixels.
    pub(crate) fn draw(&self, theme: Theme, width: u32) -> Drawing {
        let title = format!("{}: both orders draw one picture", self.scene);
        let mut page =
            Page { drawing: Drawing::new(&title, &self.facts, theme.background()), theme, width };
        self.title(&mut page);
        for (half, left) in self.halves.iter().zip(PANELS) {
            self.heading(&mut page, half, left);
            page.picture(half, left);
            page.code(half, left);
        }
        self.clock(&mut page);
        self.curves(&mut page);
        page.drawing
    }

    fn title(&self, page: &mut Page) {
        let theme = page.theme;
        let style = theme.label().sized(25.0);
        let taken = page.drawing.text([RIGHT, TITLE], Anchor::Right, &self.facts, style);
        let room = RIGHT - MARGIN - taken - 48.0;
        let scene: String = self.scene.chars().take(200).collect();
        let title = format!("{}: one picture, two loops", drawable(&scene, has));
        let style = theme.title().sized(40.0);
        page.drawing.fitting([MARGIN, TITLE], Anchor::Left, &title, style, room);
    }

    fn heading(&self, page: &mut Page, half: &FilmHalf, left: f64) {
        let theme = page.theme;
        let style = theme.heading().sized(32.0).of(theme.of(half.order.into()));
        let ink = theme.ink(half.order.into());
        mark(&mut page.drawing, half.order, [left + 10.0, HEADING - 11.0], 10.0, ink);
        let name = half.order.name();
        let wide = page.drawing.text([left + 30.0, HEADING], Anchor::Left, name, style);
        let common = theme.text().of(theme.quiet());
        let at = [left + 30.0 + wide + 16.0, HEADING];
        page.drawing.text(at, Anchor::Left, half.order.common_name(), common);
        let finished =
            format!("{} of {} finished", grouped(half.finished), count(self.pixels, "pixels"));
        let style = theme.text().tabular();
        page.drawing.text([left + PANEL, HEADING], Anchor::Right, &finished, style);
    }

    fn clock(&self, page: &mut Page) {
        let theme = page.theme;
        let clock = format!("work done: {} of {}", grouped(self.clock), count(self.whole, "steps"));
        let style = theme.heading().sized(28.0).tabular();
        let taken = page.drawing.text([RIGHT, CLOCK], Anchor::Right, &clock, style);
        match &self.verdict {
            Some(verdict) => {
                let role = if self.matches { Role::Good } else { Role::Bad };
                let style = theme.heading().sized(32.0).of(theme.of(role));
                let room = RIGHT - MARGIN - taken - 32.0;
                page.drawing.fitting([MARGIN, CLOCK], Anchor::Left, verdict, style, room);
            }
            None => legend(page),
        }
    }

    /// The finished pixels of both orders over the clock, as far as the clock is.
    fn curves(&self, page: &mut Page) {
        let (theme, [top, bottom]) = (page.theme, CURVES);
        let drawing = &mut page.drawing;
        drawing.rectangle([MARGIN, top], [RIGHT - MARGIN, bottom - top], Ink::new(theme.mat()));
        let across =
            |frame: usize| MARGIN + (RIGHT - MARGIN) * exact(frame as u64) / f64::from(self.frames);
        let now = across(self.finished.len());
        drawing.rectangle([MARGIN, bottom - 2.0], [now - MARGIN, 4.0], Ink::new(theme.bright()));
        let up = |finished: u64| {
            bottom - 4.0 - (bottom - top - 12.0) * exact(finished) / exact(self.pixels.max(1))
        };
        for (which, half) in self.halves.iter().enumerate() {
            let pen = Pen::new(theme.of(half.order.into()), 5.0);
            // The dashes of image order tell the curves apart without colour.
            let pen = if half.order == Order::Image { pen.dashed(16.0, 12.0) } else { pen };
            let finished = self.finished.iter().map(|both| both[which]);
            let points = std::iter::once([MARGIN, up(0)])
                .chain((1..).zip(finished).map(|(frame, pixels)| [across(frame), up(pixels)]));
            let points: Vec<[f64; 2]> = points.collect();
            drawing.line(&points, pen);
            if let Some(&head) = points.last() {
                mark(drawing, half.order, head, 10.0, theme.ink(half.order.into()));
            }
        }
    }
}

/// What the curves and the yellow outlines mean.
fn legend(page: &mut Page) {
    const SIDE: f64 = 18.0;
    let style = page.theme.text().of(page.theme.quiet());
    let curves = "pixels with their final colour, by the work done";
    let taken = page.drawing.text([MARGIN, CLOCK], Anchor::Left, curves, style);
    let left = MARGIN + taken + 44.0;
    let pen = Pen::new(page.theme.of(Role::Focus), 2.5);
    page.drawing.frame([left, CLOCK - SIDE], [SIDE; 2], pen);
    let changed = "changed since the frame before";
    page.drawing.text([left + SIDE + 12.0, CLOCK], Anchor::Left, changed, style);
}

#[expect(clippy::cast_precision_loss, reason = "a place on the canvas")]
fn exact(number: u64) -> f64 {
    number as f64
}

/// A frame during drawing.
struct Page {
    drawing: Drawing,
    theme: Theme,
    /// The width of the film.
    width: u32,
}

impl Page {
    fn picture(&mut self, half: &FilmHalf, left: f64) {
        let theme = self.theme;
        let unit = CANVAS[0] / f64::from(self.width);
        self.drawing.rectangle([left, PICTURE], [PANEL, PICTURE_HEIGHT], Ink::new(theme.mat()));
        let (width, height) = half.picture.dimensions();
        let size =
            enlarged([width, height], [PANEL, PICTURE_HEIGHT].map(|side| whole(side / unit)));
        let size = size.map(|side| f64::from(side) * unit);
        // A whole number of the film's pixels from the edges.
        let corner = [
            left + ((PANEL - size[0]) / (2.0 * unit)).floor() * unit,
            PICTURE + ((PICTURE_HEIGHT - size[1]) / (2.0 * unit)).floor() * unit,
        ];
        self.drawing.picture(half.picture.clone(), corner, size);
        let pixel = [size[0] / f64::from(width), size[1] / f64::from(height)];
        self.fresh(half, corner, pixel, unit);
        self.drawing.frame(
            [corner[0] - 0.5 * unit, corner[1] - 0.5 * unit],
            [size[0] + unit, size[1] + unit],
            Pen::new(theme.hairline(), unit),
        );
        if let Some([row, column]) = half.cursor {
            let [row, column] = [row, column].map(|index| exact(index as u64) + 0.5);
            self.cursor(corner, size, [column * pixel[0], row * pixel[1]]);
        }
    }

    /// Outlines what changed since the frame before.
    fn fresh(&mut self, half: &FilmHalf, corner: [f64; 2], pixel: [f64; 2], unit: f64) {
        let ink = self.theme.ink(Role::Focus);
        let mut fresh = half.fresh.to_vec();
        fresh.sort_unstable();
        fresh.dedup();
        let is_fresh = |i: i64, j: i64| {
            let place = [u32::try_from(i), u32::try_from(j)];
            matches!(place, [Ok(i), Ok(j)] if fresh.binary_search(&[i, j]).is_ok())
        };
        for &[i, j] in &fresh {
            let [x, y] = [corner[0] + f64::from(j) * pixel[0], corner[1] + f64::from(i) * pixel[1]];
            let [wide, high] = pixel;
            let (i, j) = (i64::from(i), i64::from(j));
            let sides = [
                (is_fresh(i - 1, j), [x, y], [wide, unit]),
                (is_fresh(i + 1, j), [x, y + high - unit], [wide, unit]),
                (is_fresh(i, j - 1), [x, y], [unit, high]),
                (is_fresh(i, j + 1), [x + wide - unit, y], [unit, high]),
            ];
            for (inside, at, size) in sides {
                if !inside {
                    self.drawing.rectangle(at, size, ink);
                }
            }
        }
    }

    /// Points at the row and the column of a pixel, from outside of the picture.
    fn cursor(&mut self, [left, top]: [f64; 2], [wide, _]: [f64; 2], [x, y]: [f64; 2]) {
        const LONG: f64 = 16.0;
        const HALF: f64 = 9.0;
        let ink = self.theme.ink(Role::Focus);
        for (from, to) in [(left - LONG, left - 2.0), (left + wide + LONG, left + wide + 2.0)] {
            let y = top + y;
            self.drawing.polygon(&[[to, y], [from, y - HALF], [from, y + HALF]], ink);
        }
        let x = left + x;
        self.drawing
            .polygon(&[[x, top - 2.0], [x - HALF, top - LONG], [x + HALF, top - LONG]], ink);
    }

    fn code(&mut self, half: &FilmHalf, left: f64) {
        const INDENT: f64 = 30.0;
        const VARIABLES: f64 = 500.0;
        let theme = self.theme;
        for (number, line) in half.lines.iter().enumerate() {
            let top = CODE + LINE * exact(number as u64);
            let baseline = top + 27.0;
            let is_lit = number == half.lit;
            if is_lit {
                let ink = theme.ink(half.order.into());
                self.drawing.rectangle([left, top], [PANEL, LINE], ink.alpha(0.24));
                let [low, high] = [top + 8.0, top + LINE - 8.0];
                let middle = 0.5 * (low + high);
                self.drawing
                    .polygon(&[[left + 6.0, low], [left + 20.0, middle], [left + 6.0, high]], ink);
            }
            let style = theme.text().sized(28.0);
            let style = if is_lit { style.semi_bold() } else { style.of(theme.quiet()) };
            let indent = left + 30.0 + INDENT * exact(line.indent as u64);
            self.drawing.text([indent, baseline], Anchor::Left, line.code, style);
            let style = theme.text().sized(28.0).tabular();
            let at = [left + VARIABLES, baseline];
            self.drawing.fitting(at, Anchor::Left, &line.variable, style, PANEL - VARIABLES - 8.0);
        }
    }
}

/// The size of a picture in a room, in pixels of the film: enlarged by a whole factor, or reduced.
fn enlarged([width, height]: [u32; 2], room: [u32; 2]) -> [u32; 2] {
    match (room[0] / width).min(room[1] / height) {
        0 => fitted([width, height], room),
        factor => [factor * width, factor * height],
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a side of a film")]
fn whole(side: f64) -> u32 {
    side as u32
}
