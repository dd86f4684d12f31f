//! The slide that shows both orders side by side, with their difference and their work.

use super::fallback::drawable;
use super::resize::{fitted, footprint, resized};
use super::text::{Figures, Style, Weight, draw, has, shortened, width};
use crate::common::Work;
use crate::diff::{Class, Classes, Comparison};
use crate::orders::{Counts, Order, Rendered};
use crate::wording::{count, grouped, milliseconds, pixels_shown};
use image::{Rgb, RgbImage};
use std::ops::RangeInclusive;
use tiny_skia::{Color, Paint, Pixmap, Rect, Transform};

/// The slide's width and height in pixels, for pictures of every size.
pub const SLIDE_SIZE: [u32; 2] = [1920, 1080];

/// The content of a slide.
#[derive(Clone, Copy, Debug)]
pub struct Slide<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The scene in one line; the slide leaves out the part that does not fit.
    pub about: Option<&'a str>,
    /// Primitives in the scene.
    pub primitives: u32,
    /// The number of rendering threads; the slide shows this number if it shows times.
    pub threads: usize,
    /// The result of object order.
    pub object_order: &'a Rendered,
    /// The result of image order.
    pub image_order: &'a Rendered,
    /// The pictures of both orders: object order, image order.
    pub pictures: [&'a RgbImage; 2],
    /// The comparison of the two.
    pub comparison: &'a Comparison,
}

const BACKGROUND: [u8; 3] = [0x10, 0x14, 0x18];
const MAT: [u8; 3] = [0x0b, 0x0e, 0x11];
const HAIRLINE: [u8; 3] = [0x2a, 0x32, 0x3a];
const BRIGHT: [u8; 3] = [0xee, 0xf1, 0xf4];
const QUIET: [u8; 3] = [0xa0, 0xac, 0xb7];
const MATCH: [u8; 3] = [0x62, 0xc9, 0xa4];
const DIFFER: [u8; 3] = [0xe6, 0x9f, 0x00];

const MARGIN: f32 = 72.0;
/// The left edges of the three columns.
const COLUMNS: [f32; 3] = [MARGIN, 676.0, 1280.0];
const COLUMN_WIDTH: f32 = 568.0;
const RIGHT: f32 = 1920.0 - MARGIN;

/// Baselines and edges, from the top.
const TITLE: f32 = 74.0;
/// Baselines below the title: of the line about the scene, if there is one, and of the line with the scene's data.
const BELOW_TITLE: [f32; 2] = [110.0, 144.0];
const HEADING: f32 = 200.0;
const FIRST_LOOP: f32 = 233.0;
const SECOND_LOOP: f32 = 263.0;
const PICTURES: f32 = 286.0;
const FIRST_ROW: f32 = 752.0;
const ROW: f32 = 31.0;
const RULE: f32 = 988.0;
const VERDICT: f32 = 1035.0;
/// The largest size of a picture: a 4:3 picture fills this frame.
const PICTURE_FRAME: [u32; 2] = [568, 426];

impl Slide<'_> {
    /// Draws the slide.
    ///
    /// # Panics
    ///
    /// If the pictures and the comparison have different sizes.
    pub fn draw(&self) -> RgbImage {
        let mut canvas = Canvas::new();
        self.title(&mut canvas);
        let classes = self.comparison.classes();
        let size = fitted(classes.image(), PICTURE_FRAME);
        for ((rendered, picture), left) in
            [self.object_order, self.image_order].into_iter().zip(self.pictures).zip(COLUMNS)
        {
            let order = rendered.order;
            canvas.heading(left, &rendered.name(), order.common_name(), order.loops());
            canvas.picture(left, &resized(picture, size));
            canvas.rows(left, &figures(rendered));
        }
        let [_, _, left] = COLUMNS;
        let explanation =
            ["The same primitive at every sample?", "Ids are compared without tolerance."];
        canvas.heading(left, "difference", "", explanation);
        canvas.picture(left, &marked_difference(classes, self.pictures[0], size));
        self.legend(&mut canvas, left, classes);
        self.verdict(&mut canvas);
        canvas.into_image()
    }

    fn title(&self, canvas: &mut Canvas) {
        let frame = &self.object_order.frame;
        let samples = match frame.samples() {
            1 => "1 sample a pixel".into(),
            n => format!("{n} × {n} samples a pixel"),
        };
        let primitives = count(self.primitives.into(), "primitives");
        let pixels = pixels_shown(frame.camera_image(), frame.crop(), "×");
        let mut facts = format!("{primitives}   ·   {pixels}   ·   {samples}");
        facts += &format!("   ·   method {}", self.object_order.method.name());
        if self.object_order.times.is_some() {
            facts += &format!("   ·   {}", count(self.threads as u64, "threads"));
        }
        let room = RIGHT - MARGIN;
        canvas.fitting(MARGIN, TITLE, &line(self.scene), TITLE_STYLE, room);
        let about = self.about.map(line).map(|about| (about, BRIGHT));
        let lines = about.into_iter().chain([(facts, QUIET)]);
        for ((text, color), baseline) in lines.zip(BELOW_TITLE) {
            canvas.fitting(MARGIN, baseline, &text, SENTENCE.of(color), room);
        }
    }

    fn legend(&self, canvas: &mut Canvas, left: f32, classes: &Classes) {
        const SWATCH: f32 = 18.0;
        let mut baseline = FIRST_ROW;
        for class in Class::ALL {
            canvas.framed(left, baseline - 17.0, SWATCH, class.color());
            let pixels = count(classes.count(class), "pixels");
            canvas.row(left + SWATCH + 14.0, left + COLUMN_WIDTH, baseline, class.name(), &pixels);
            baseline += ROW;
        }
        let depth = difference(self.comparison.depth.max_relative_difference);
        canvas.row(left, left + COLUMN_WIDTH, baseline, "depths differ by at most", &depth);
        let color = format!("{} of 255", self.comparison.color.max_difference);
        canvas.row(left, left + COLUMN_WIDTH, baseline + ROW, "colours differ by at most", &color);
    }

    fn verdict(&self, canvas: &mut Canvas) {
        let color = if self.comparison.matches() { MATCH } else { DIFFER };
        canvas.rectangle(MARGIN, RULE, RIGHT - MARGIN, 1.0, HAIRLINE);
        let verdict = self.comparison.verdict();
        canvas.fitting(MARGIN, VERDICT, &verdict, VERDICT_STYLE.of(color), RIGHT - MARGIN);
    }
}

/// A text of any length and in any letters, reduced to the part that can be drawn on one line.
fn line(text: &str) -> String {
    // More letters than a line holds, and few enough that a very long name takes no time.
    const MOST: usize = 400;
    drawable(&text.chars().take(MOST).collect::<String>(), has)
}

/// The work of one order: labels and figures, row by row.
fn figures(rendered: &Rendered) -> Vec<(&'static str, String)> {
    let mut rows = match rendered.work {
        Counts::Counted(work) => counts(rendered.order, &work),
        Counts::TooMany { most } => vec![
            ("work for a frame", "not counted".into()),
            ("it is more than", format!("{} steps", grouped(most))),
        ],
        Counts::LeftOut => vec![],
    };
    if let Some(times) = rendered.times {
        // The time for shading is left out: shading is the same task in both orders, and would hide the other times.
        rows.push(("time to prepare", milliseconds(times.prepare.median)));
        rows.push(("time for visibility", milliseconds(times.visibility.median)));
    }
    rows
}

fn counts(order: Order, work: &Work) -> Vec<(&'static str, String)> {
    let Work { primitives, rays, nodes, tests, fragments, depth_tests, .. } = *work;
    let judged = work.judged_coverage + work.judged_nearest;
    let (outer, boxes) = match order {
        Order::Object => (("primitives", primitives), None),
        Order::Image => (("rays", rays), Some(nodes)),
    };
    vec![
        (outer.0, grouped(outer.1)),
        ("boxes tested", boxes.map_or("–".into(), grouped)),
        ("primitive × sample tested", grouped(tests)),
        ("of these, covered", grouped(fragments)),
        ("depth comparisons", grouped(depth_tests)),
        ("left to the exact judge", grouped(judged)),
    ]
}

fn difference(relative: f64) -> String {
    match relative {
        0.0 => "0".into(),
        small if small < 1e-3 => format!("{small:.0e} of the depth"),
        large => format!("{:.1} % of the depth", 100.0 * large),
    }
}

/// The difference image in its size on the slide. Every differing pixel is easy to see: where the pixel would be
/// smaller, a square of [`SMALLEST_MARK`] pixels marks it.
fn marked_difference(classes: &Classes, lit_by: &RgbImage, size: [u32; 2]) -> RgbImage {
    let mut picture = resized(&classes.picture(lit_by), size);
    let image = classes.image();
    // The worse class is painted later.
    let mut differing: Vec<_> = classes.differing().collect();
    differing.sort_by_key(|&(_, class)| std::cmp::Reverse(class));
    for ([i, j], class) in differing {
        for y in widened(footprint(i, image[1], size[1]), size[1]) {
            for x in widened(footprint(j, image[0], size[0]), size[0]) {
                picture.put_pixel(x, y, Rgb(class.color()));
            }
        }
    }
    picture
}

/// The smallest side of a differing pixel on the slide.
const SMALLEST_MARK: u32 = 5;

/// The range, widened to the length of a mark, within `0..side`.
fn widened(range: RangeInclusive<u32>, side: u32) -> RangeInclusive<u32> {
    let missing = SMALLEST_MARK.saturating_sub(range.end() - range.start() + 1);
    let begin = range.start().saturating_sub(missing / 2);
    begin..=(range.end() + missing.div_ceil(2)).min(side - 1)
}

const REGULAR: Style =
    Style { weight: Weight::Regular, size: 23.0, color: BRIGHT, figures: Figures::Tabular };
const SENTENCE: Style = Style { figures: Figures::Proportional, ..REGULAR };
const SEMI_BOLD: Style = Style { weight: Weight::SemiBold, ..SENTENCE };
const TITLE_STYLE: Style = Style { size: 46.0, ..SEMI_BOLD };
const HEADING_STYLE: Style = Style { size: 30.0, ..SEMI_BOLD };
const VERDICT_STYLE: Style = Style { size: 32.0, ..SEMI_BOLD };

impl Style {
    fn of(self, color: [u8; 3]) -> Style {
        Style { color, ..self }
    }
}

/// The slide during drawing.
struct Canvas {
    pixels: Pixmap,
}

impl Canvas {
    fn new() -> Canvas {
        let [width, height] = SLIDE_SIZE;
        let mut pixels = Pixmap::new(width, height).expect("the slide has a size");
        pixels.fill(opaque(BACKGROUND));
        Canvas { pixels }
    }

    fn heading(&mut self, left: f32, name: &str, common_name: &str, loops: [&str; 2]) {
        let taken = self.right(left + COLUMN_WIDTH, HEADING, common_name, REGULAR.of(QUIET));
        self.fitting(left, HEADING, name, HEADING_STYLE, COLUMN_WIDTH - taken - REGULAR.size);
        let inner = if common_name.is_empty() { 0.0 } else { 32.0 };
        draw(&mut self.pixels, loops[0], left, FIRST_LOOP, REGULAR.of(QUIET));
        draw(&mut self.pixels, loops[1], left + inner, SECOND_LOOP, REGULAR.of(QUIET));
    }

    /// Draws a picture in the middle of its mat.
    fn picture(&mut self, left: f32, picture: &RgbImage) {
        let [frame_width, frame_height] = PICTURE_FRAME;
        let [wide, high] = PICTURE_FRAME.map(pixels);
        self.rectangle(left, PICTURES, wide, high, MAT);
        let x = whole(left) + (frame_width - picture.width()) / 2;
        let y = whole(PICTURES) + (frame_height - picture.height()) / 2;
        let [wide, high] = [picture.width(), picture.height()].map(pixels);
        self.rectangle(pixels(x) - 1.0, pixels(y) - 1.0, wide + 2.0, high + 2.0, HAIRLINE);
        let stride = SLIDE_SIZE[0] as usize;
        let canvas = self.pixels.pixels_mut();
        for (column, row, Rgb([red, green, blue])) in picture.enumerate_pixels() {
            let index = (y + row) as usize * stride + (x + column) as usize;
            canvas[index] = tiny_skia::ColorU8::from_rgba(*red, *green, *blue, 255).premultiply();
        }
    }

    fn rows(&mut self, left: f32, rows: &[(&str, String)]) {
        let mut baseline = FIRST_ROW;
        for (label, figure) in rows {
            self.row(left, left + COLUMN_WIDTH, baseline, label, figure);
            baseline += ROW;
        }
    }

    /// Draws a label on the left and a figure on the right.
    fn row(&mut self, left: f32, right: f32, baseline: f32, label: &str, figure: &str) {
        let figure_width = self.right(right, baseline, figure, REGULAR);
        let room = right - left - figure_width - REGULAR.size;
        self.fitting(left, baseline, label, REGULAR.of(QUIET), room);
    }

    /// Draws a text that ends at `right`, and returns its width.
    fn right(&mut self, right: f32, baseline: f32, text: &str, style: Style) -> f32 {
        let width = width(text, style);
        draw(&mut self.pixels, text, right - width, baseline, style);
        width
    }

    /// Draws a text in the room given: in a smaller size if the room is too narrow, and shortened if that is not
    /// enough.
    fn fitting(&mut self, left: f32, baseline: f32, text: &str, style: Style, room: f32) {
        const SMALLEST: f32 = 0.6;
        let scale = (room / width(text, style)).clamp(SMALLEST, 1.0);
        let style = Style { size: style.size * scale, ..style };
        let text = shortened(text, style, room + 0.5);
        draw(&mut self.pixels, &text, left, baseline, style);
    }

    /// Draws a square with a frame, because the colour may be as dark as the slide.
    fn framed(&mut self, x: f32, y: f32, side: f32, color: [u8; 3]) {
        self.rectangle(x - 1.0, y - 1.0, side + 2.0, side + 2.0, HAIRLINE);
        self.rectangle(x, y, side, side, color);
    }

    fn rectangle(&mut self, x: f32, y: f32, width: f32, height: f32, color: [u8; 3]) {
        let mut paint = Paint::default();
        paint.set_color(opaque(color));
        if let Some(rectangle) = Rect::from_xywh(x, y, width, height) {
            self.pixels.fill_rect(rectangle, &paint, Transform::identity(), None);
        }
    }

    fn into_image(self) -> RgbImage {
        let bytes = self.pixels.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]);
        let [width, height] = SLIDE_SIZE;
        RgbImage::from_raw(width, height, bytes.collect()).expect("three bytes a pixel")
    }
}

fn opaque([red, green, blue]: [u8; 3]) -> Color {
    Color::from_rgba8(red, green, blue, u8::MAX)
}

#[expect(clippy::cast_precision_loss, reason = "places on the slide are small")]
fn pixels(count: u32) -> f32 {
    count as f32
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
fn whole(place: f32) -> u32 {
    place as u32
}

#[cfg(test)]
mod tests;
