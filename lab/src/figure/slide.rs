//! The slide that shows both orders side by side, with their difference, their work and what they executed.

mod figures;

use super::drawing::{Anchor, CANVAS, Drawing, Ink};
use super::fallback::drawable;
use super::resize::{fitted, footprint, resized};
use super::text::{Figures, Style, Weight, has};
use super::theme::{Role, Theme};
use crate::diff::{Class, Classes, Comparison};
use crate::orders::Rendered;
use crate::wording::{count, pixels_shown};
use figures::{Group, figures};
use image::{Rgb, RgbImage};
use std::ops::RangeInclusive;

/// The content of a slide.
#[derive(Clone, Copy, Debug)]
pub struct Slide<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The scene in one line; the slide leaves out the part that does not fit.
    pub about: Option<&'a str>,
    /// Primitives in the scene.
    pub primitives: u64,
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

const MARGIN: f64 = 72.0;
/// The left edges of the three columns.
const COLUMNS: [f64; 3] = [MARGIN, 676.0, 1280.0];
const COLUMN_WIDTH: f64 = 568.0;
const RIGHT: f64 = CANVAS[0] - MARGIN;

/// Baselines and edges, from the top.
const TITLE: f64 = 74.0;
/// Baselines below the title: of the line about the scene, if there is one, and of the line with the scene's data.
const BELOW_TITLE: [f64; 2] = [110.0, 144.0];
const HEADING: f64 = 200.0;
const FIRST_LOOP: f64 = 233.0;
const SECOND_LOOP: f64 = 263.0;
const PICTURES: f64 = 286.0;
const FIRST_ROW: f64 = 752.0;
const ROW: f64 = 31.0;
/// The width of the first of two groups of rows, and the room between them.
const FIRST_GROUP: f64 = 294.0;
const GROUP_GAP: f64 = 26.0;
const RULE: f64 = 988.0;
const VERDICT: f64 = 1035.0;
/// The largest size of a picture: a 4:3 picture fills this frame.
const PICTURE_FRAME: [u32; 2] = [568, 426];

impl Slide<'_> {
    /// Draws the slide.
    ///
    /// # Panics
    ///
    /// If the pictures and the comparison have different sizes.
    pub fn draw(&self, theme: Theme) -> Drawing {
        let title = format!("{}: object order and image order", line(self.scene));
        let drawing = Drawing::new(&title, &self.comparison.verdict(), theme.background());
        let mut canvas = Canvas { drawing, theme };
        self.title(&mut canvas);
        let classes = self.comparison.classes();
        let size = fitted(classes.image(), PICTURE_FRAME);
        let [by_object, by_image] = self.pictures;
        let (shown, difference) = rayon::join(
            || {
                let shown = |picture| resized(picture, size).into_owned();
                rayon::join(|| shown(by_object), || shown(by_image))
            },
            || marked_difference(classes, by_object, size),
        );
        let orders = [(self.object_order, shown.0), (self.image_order, shown.1)];
        for ((rendered, picture), left) in orders.into_iter().zip(COLUMNS) {
            let order = rendered.order;
            canvas.heading(left, &rendered.name(), order.common_name(), order.loops());
            canvas.picture(left, picture);
            canvas.groups(left, &figures(rendered));
        }
        let [_, _, left] = COLUMNS;
        let explanation =
            ["The same primitive at every sample?", "Ids are compared without tolerance."];
        canvas.heading(left, "difference", "", explanation);
        canvas.picture(left, difference);
        self.legend(&mut canvas, left, classes);
        self.verdict(&mut canvas);
        canvas.drawing
    }

    fn title(&self, canvas: &mut Canvas) {
        let frame = &self.object_order.frame;
        let samples = match frame.samples() {
            1 => "1 sample a pixel".into(),
            n => format!("{n} × {n} samples a pixel"),
        };
        let primitives = count(self.primitives, "primitives");
        let pixels = pixels_shown(frame.camera_image(), frame.crop(), "×");
        let mut facts = format!("{primitives}   ·   {pixels}   ·   {samples}");
        facts += &format!("   ·   method {}", self.object_order.method.name());
        if self.object_order.times.is_some() {
            facts += &format!("   ·   {}", count(self.threads as u64, "threads"));
        }
        let room = RIGHT - MARGIN;
        let theme = canvas.theme;
        canvas.fitting(MARGIN, TITLE, &line(self.scene), theme.title(), room);
        let about = self.about.map(line).map(|about| (about, theme.bright()));
        let lines = about.into_iter().chain([(facts, theme.quiet())]);
        for ((text, color), baseline) in lines.zip(BELOW_TITLE) {
            canvas.fitting(MARGIN, baseline, &text, SENTENCE.of(color), room);
        }
    }

    fn legend(&self, canvas: &mut Canvas, left: f64, classes: &Classes) {
        const SWATCH: f64 = 18.0;
        let mut baseline = FIRST_ROW;
        for class in Class::ALL {
            canvas.framed(left, baseline - 17.0, SWATCH, class.color());
            let pixels = count(classes.count(class), "pixels");
            let ends = [left + SWATCH + 14.0, left + COLUMN_WIDTH];
            canvas.row(ends, baseline, class.name(), &pixels, ROWS);
            baseline += ROW;
        }
        let depth = difference(self.comparison.depth.max_relative_difference);
        let ends = [left, left + COLUMN_WIDTH];
        canvas.row(ends, baseline, "depths differ by at most", &depth, ROWS);
        let color = format!("{} of 255", self.comparison.color.max_difference);
        canvas.row(ends, baseline + ROW, "colours differ by at most", &color, ROWS);
    }

    fn verdict(&self, canvas: &mut Canvas) {
        let theme = canvas.theme;
        let role = if self.comparison.matches() { Role::Good } else { Role::Object };
        canvas.rectangle(MARGIN, RULE, RIGHT - MARGIN, 1.0, theme.hairline());
        let (verdict, style) = (self.comparison.verdict(), theme.title().sized(32.0));
        canvas.fitting(MARGIN, VERDICT, &verdict, style.of(theme.of(role)), RIGHT - MARGIN);
    }
}

/// A text of any length and in any letters, reduced to the part that can be drawn on one line.
fn line(text: &str) -> String {
    // More letters than a line holds, and few enough that a very long name takes no time.
    const MOST: usize = 400;
    drawable(&text.chars().take(MOST).collect::<String>(), has)
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
    let mut picture = resized(&classes.picture(lit_by), size).into_owned();
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

/// The letters of rows and sentences; each has the colour of its theme.
const ROWS: Style = Style { figures: Figures::Tabular, ..SENTENCE };
const SENTENCE: Style =
    Style { weight: Weight::Regular, size: 23.0, color: [0; 3], figures: Figures::Proportional };

/// The slide during drawing.
struct Canvas {
    drawing: Drawing,
    theme: Theme,
}

impl Canvas {
    fn heading(&mut self, left: f64, name: &str, common_name: &str, loops: [&str; 2]) {
        let (quiet, bright) = (self.theme.quiet(), self.theme.heading());
        let taken = self.right(left + COLUMN_WIDTH, HEADING, common_name, SENTENCE.of(quiet));
        let room = COLUMN_WIDTH - taken - f64::from(SENTENCE.size);
        self.fitting(left, HEADING, name, bright.sized(30.0), room);
        let inner = if common_name.is_empty() { 0.0 } else { 32.0 };
        for ([x, baseline], text) in
            [[left, FIRST_LOOP], [left + inner, SECOND_LOOP]].into_iter().zip(loops)
        {
            self.drawing.text([x, baseline], Anchor::Left, text, SENTENCE.of(quiet));
        }
    }

    /// Draws a picture in the middle of its mat.
    fn picture(&mut self, left: f64, picture: RgbImage) {
        let frame = PICTURE_FRAME.map(f64::from);
        self.rectangle(left, PICTURES, frame[0], frame[1], self.theme.mat());
        let [width, height] = [picture.width(), picture.height()];
        let x = left + f64::from((PICTURE_FRAME[0] - width) / 2);
        let y = PICTURES + f64::from((PICTURE_FRAME[1] - height) / 2);
        let size = [width, height].map(f64::from);
        self.rectangle(x - 1.0, y - 1.0, size[0] + 2.0, size[1] + 2.0, self.theme.hairline());
        self.drawing.picture(picture, [x, y], size);
    }

    /// Draws one group of rows over the whole column, or two beside each other in smaller letters.
    fn groups(&mut self, left: f64, groups: &[Group]) {
        let right = left + COLUMN_WIDTH;
        match groups {
            [one, two] => {
                let narrow = ROWS.sized(20.0);
                self.group([left, left + FIRST_GROUP], one, narrow);
                self.group([left + FIRST_GROUP + GROUP_GAP, right], two, narrow);
            }
            groups => groups.iter().for_each(|group| self.group([left, right], group, ROWS)),
        }
    }

    fn group(&mut self, [left, right]: [f64; 2], Group { heading, rows }: &Group, style: Style) {
        let mut baseline = FIRST_ROW;
        if let Some(heading) = heading {
            let style = style.of(self.theme.bright()).semi_bold();
            self.fitting(left, baseline, heading, style, right - left);
            baseline += ROW;
        }
        for (label, figure) in rows {
            self.row([left, right], baseline, label, figure, style);
            baseline += ROW;
        }
    }

    /// Draws a label on the left and a figure on the right.
    fn row(
        &mut self,
        [left, right]: [f64; 2],
        baseline: f64,
        label: &str,
        figure: &str,
        style: Style,
    ) {
        let taken = self.right(right, baseline, figure, style.of(self.theme.bright()));
        let room = right - left - taken - 0.5 * f64::from(style.size);
        self.fitting(left, baseline, label, style.of(self.theme.quiet()), room);
    }

    /// Draws a text that ends at `right`, and returns its width.
    fn right(&mut self, right: f64, baseline: f64, text: &str, style: Style) -> f64 {
        self.drawing.text([right, baseline], Anchor::Right, text, style)
    }

    fn fitting(&mut self, left: f64, baseline: f64, text: &str, style: Style, room: f64) {
        self.drawing.fitting([left, baseline], Anchor::Left, text, style, room);
    }

    /// Draws a square with a frame, because the colour may be as dark as the slide.
    fn framed(&mut self, x: f64, y: f64, side: f64, color: [u8; 3]) {
        self.rectangle(x - 1.0, y - 1.0, side + 2.0, side + 2.0, self.theme.hairline());
        self.rectangle(x, y, side, side, color);
    }

    fn rectangle(&mut self, x: f64, y: f64, width: f64, height: f64, color: [u8; 3]) {
        self.drawing.rectangle([x, y], [width, height], Ink::new(color));
    }
}

#[cfg(test)]
mod tests;
