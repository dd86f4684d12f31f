//! A drawing: shapes, texts and pictures on a canvas of 1920 × 1080 units, with two outputs: the text of an SVG file,
//! and a picture of pixels.
//!
//! Both outputs walk the same list of items, so that they show the same. Every shape is clipped before it gets into
//! the list: no output ever sees an extreme coordinate.

mod canvas;
mod clip;
mod items;
mod pixels;
mod svg;

pub use canvas::CANVAS;
pub use items::Drawing;
pub(crate) use items::{Anchor, Ink, Pen};
pub use pixels::Bands;

use super::text::{self, Style};
use clip::Rectangle;
use image::{ImageFormat, RgbImage};
use items::{Corners, Item, Text};
use std::io::Cursor;

impl Drawing {
    /// A canvas of one colour. The title and the description are for those who cannot see the picture.
    pub(crate) fn new(title: &str, description: &str, background: [u8; 3]) -> Drawing {
        Drawing {
            title: title.into(),
            description: description.into(),
            background,
            items: Vec::new(),
            window: Rectangle::CANVAS,
        }
    }

    /// The text of an SVG file. Its texts are outlines: it needs no fonts.
    pub fn svg(&self) -> String {
        svg::write(self)
    }

    /// A picture so many pixels wide, with the form of the canvas.
    ///
    /// # Panics
    ///
    /// If the width is 0, or more than 2¹⁴.
    pub fn pixels(&self, width: u32) -> RgbImage {
        Bands::whole(self, width)
    }

    /// The same picture in bands, from the top to the bottom, for those who need no more than one at a time: each has
    /// the width of the picture and some of its rows. Where a curve or a line goes on from one band to the next, a few
    /// pixels may differ from those of the whole picture by a subsample.
    ///
    /// # Panics
    ///
    /// As [`Drawing::pixels`].
    pub fn bands(&self, width: u32) -> Bands<'_> {
        Bands::new(self, width)
    }

    /// The same as a PNG.
    ///
    /// # Panics
    ///
    /// As [`Drawing::pixels`].
    pub fn png(&self, width: u32) -> Vec<u8> {
        let mut png = Cursor::new(Vec::new());
        let written = self.pixels(width).write_to(&mut png, ImageFormat::Png);
        written.expect("a picture with pixels is a PNG, and memory takes it");
        png.into_inner()
    }

    /// What is wrong with the texts: which of them leave the canvas, and which overlap.
    pub fn faults(&self) -> Vec<String> {
        let texts: Vec<&Text> = self
            .items
            .iter()
            .filter_map(|item| if let Item::Text(text) = item { Some(text) } else { None })
            .collect();
        let mut faults = Vec::new();
        for (number, text) in texts.iter().enumerate() {
            let [left, top, right, bottom] = text.extent();
            if left < 0.0 || top < 0.0 || right > CANVAS[0] || bottom > CANVAS[1] {
                faults.push(format!("'{}' leaves the canvas", text.text));
            }
            for other in &texts[..number] {
                let [other_left, other_top, other_right, other_bottom] = other.extent();
                if left < other_right
                    && other_left < right
                    && top < other_bottom
                    && other_top < bottom
                {
                    faults.push(format!("'{}' overlaps '{}'", text.text, other.text));
                }
            }
        }
        faults
    }

    /// Draws what follows only within a rectangle, given by its top left corner and its size; `None` is the whole canvas.
    pub(crate) fn window(&mut self, window: Option<([f64; 2], [f64; 2])>) {
        self.window = window.map_or(Rectangle::CANVAS, |(corner, size)| {
            Rectangle::new(corner, size).within(&Rectangle::CANVAS)
        });
    }

    pub(crate) fn rectangle(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], ink: Ink) {
        let (right, bottom) = (x + width, y + height);
        self.polygon(&[[x, y], [right, y], [right, bottom], [x, bottom]], ink);
    }

    /// Draws the frame of a rectangle. The middle of the pen runs along its sides.
    pub(crate) fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], pen: Pen) {
        let (right, bottom) = (x + width, y + height);
        self.closed_line(&[[x, y], [right, y], [right, bottom], [x, bottom]], pen);
    }

    /// Fills a polygon. Points that are not finite are left out.
    pub(crate) fn polygon(&mut self, points: &[[f64; 2]], ink: Ink) {
        let outline = self.window.clipped(points);
        if outline.len() >= 3 {
            self.items.push(Item::Fill { outline, ink });
        }
    }

    /// Draws a line from point to point. Where a point is not finite, the line is interrupted.
    pub(crate) fn line(&mut self, points: &[[f64; 2]], pen: Pen) {
        for points in self.window.parts(points) {
            self.items.push(Item::Line { points, closed: false, pen });
        }
    }

    /// Draws the outline of a polygon.
    pub(crate) fn closed_line(&mut self, points: &[[f64; 2]], pen: Pen) {
        if points.iter().all(|point| self.window.holds(*point)) {
            self.items.push(Item::Line { points: points.to_vec(), closed: true, pen });
        } else {
            let around: Vec<[f64; 2]> = points.iter().chain(points.first()).copied().collect();
            self.line(&around, pen);
        }
    }

    pub(crate) fn disc(&mut self, center: [f64; 2], radius: f64, ink: Ink) {
        if self.window.holds_disc(center, radius) {
            self.items.push(Item::Disc { center, radius, ink });
        } else {
            self.polygon(&circle(center, radius), ink);
        }
    }

    pub(crate) fn ring(&mut self, center: [f64; 2], radius: f64, pen: Pen) {
        self.closed_line(&circle(center, radius), pen);
    }

    /// A line with a head at its end.
    pub(crate) fn arrow(&mut self, from: [f64; 2], to: [f64; 2], pen: Pen) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]);
        let head = (4.0 * pen.width + 6.0).min(0.6 * length);
        if length.is_nan() || length < 1e-6 {
            return;
        }
        let unit = along.map(|part| part / length);
        let neck = [to[0] - head * unit[0], to[1] - head * unit[1]];
        let half = 0.42 * head;
        self.line(&[from, neck], pen);
        self.polygon(
            &[
                to,
                [neck[0] - half * unit[1], neck[1] + half * unit[0]],
                [neck[0] + half * unit[1], neck[1] - half * unit[0]],
            ],
            pen.ink,
        );
    }

    /// Fills a rectangle with lines that rise to the right: a second sign beside a colour.
    pub(crate) fn hatch(
        &mut self,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
        gap: f64,
        pen: Pen,
    ) {
        let before = self.window;
        self.window = Rectangle::new([x, y], [width, height]).within(&before);
        // The lines go through the canvas's multiples of the gap, so that neighbours continue one another.
        let first = ((x + y) / gap).ceil();
        let last = ((x + width + y + height) / gap).floor();
        let mut step = first;
        while step <= last {
            let sum = step * gap;
            self.line(&[[sum - y, y], [sum - y - height, y + height]], pen);
            step += 1.0;
        }
        self.window = before;
    }

    /// Writes a line of text, and gives its width.
    pub(crate) fn text(
        &mut self,
        [x, baseline]: [f64; 2],
        anchor: Anchor,
        text: &str,
        style: Style,
    ) -> f64 {
        self.text_with_halo([x, baseline], anchor, text, style, None)
    }

    /// Writes a line of text on a picture, with a line around its letters.
    pub(crate) fn text_with_halo(
        &mut self,
        [x, baseline]: [f64; 2],
        anchor: Anchor,
        text: &str,
        style: Style,
        halo: Option<[u8; 3]>,
    ) -> f64 {
        let width = f64::from(text::width(text, style));
        let left = match anchor {
            Anchor::Left => x,
            Anchor::Middle => x - 0.5 * width,
            Anchor::Right => x - width,
        };
        if !text.is_empty() {
            self.items.push(Item::Text(Text { text: text.into(), left, baseline, style, halo }));
        }
        width
    }

    /// Writes a line of text in the room given: smaller if the room is too narrow, and shortened if that is not enough.
    pub(crate) fn fitting(
        &mut self,
        [x, baseline]: [f64; 2],
        anchor: Anchor,
        text: &str,
        style: Style,
        room: f64,
    ) -> f64 {
        const SMALLEST: f64 = 0.6;
        let scale = (room / f64::from(text::width(text, style))).clamp(SMALLEST, 1.0);
        #[expect(clippy::cast_possible_truncation, reason = "a size of letters")]
        let style = Style { size: style.size * scale as f32, ..style };
        #[expect(clippy::cast_possible_truncation, reason = "a length on the canvas")]
        let text = text::shortened(text, style, room as f32 + 0.5);
        self.text([x, baseline], anchor, &text, style)
    }

    /// Writes a label beside a point, where it meets no other text and stays in the window: near, in the preferred
    /// direction (across, down), and on few strong lines and discs, with a thin line to the point if it stands far off.
    /// Where there is no room at all, nothing is written.
    pub(crate) fn label(
        &mut self,
        point: [f64; 2],
        prefer: [f64; 2],
        text: &str,
        style: Style,
        halo: Option<[u8; 3]>,
    ) {
        const DISTANCES: [f64; 5] = [16.0, 34.0, 60.0, 95.0, 140.0];
        /// What a label costs for each thing that it lies on, where a step farther away costs 1, and the side that is not
        /// preferred, too.
        const MEETS: f64 = 1.6;
        let (size, width) = (f64::from(style.size), f64::from(text::width(text, style)));
        let length = prefer[0].hypot(prefer[1]).max(f64::MIN_POSITIVE);
        let mut best: Option<(f64, Text, [f64; 2])> = None;
        for (step, distance) in DISTANCES.into_iter().enumerate() {
            for turn in 0..16 {
                let (down, across) = (std::f64::consts::TAU * f64::from(turn) / 16.0).sin_cos();
                // The side or the corner of the text that faces the point is so far from it.
                let left = point[0] + across * distance - 0.5 * width * (1.0 - across);
                let baseline = point[1] + down * (distance + 0.45 * size) + 0.35 * size;
                let label = Text { text: text.into(), left, baseline, style, halo };
                let along = (across * prefer[0] + down * prefer[1]) / length;
                let cost = step as f64 + 0.5 * (1.0 - along);
                let dearer = |best: &(f64, Text, [f64; 2])| cost >= best.0;
                if best.as_ref().is_some_and(dearer) || !self.is_free(&label) {
                    continue;
                }
                let cost = cost + MEETS * self.strong_items_under(&label) as f64;
                if best.as_ref().is_none_or(|best| cost < best.0) {
                    let facing = [left + 0.5 * width * (1.0 - across), baseline - 0.35 * size];
                    best = Some((cost, label, [facing[0], facing[1] - down * 0.6 * size]));
                }
            }
        }
        let Some((_, label, facing)) = best else { return };
        if (facing[0] - point[0]).hypot(facing[1] - point[1]) > 40.0 {
            self.line(&[point, facing], Pen::new(style.color, 1.2).alpha(0.7));
        }
        self.items.push(Item::Text(label));
    }

    /// How many discs and strong lines a text lies on.
    fn strong_items_under(&self, label: &Text) -> usize {
        const STRONG: f64 = 2.5;
        let [left, top, right, bottom] = label.extent();
        let around = |by: f64| {
            let size = [right - left + 2.0 * by, bottom - top + 2.0 * by];
            Rectangle::new([left - by, top - by], size)
        };
        let is_under = |item: &&Item| match item {
            Item::Disc { center, radius, .. } => around(*radius).holds(*center),
            Item::Line { points, closed, pen } if pen.width >= STRONG => {
                let closing = points.first().filter(|_| *closed);
                let points: Vec<[f64; 2]> = points.iter().chain(closing).copied().collect();
                !around(0.5 * pen.width).parts(&points).is_empty()
            }
            _ => false,
        };
        self.items.iter().filter(is_under).count()
    }

    /// Whether a text lies within the window and meets no other.
    fn is_free(&self, label: &Text) -> bool {
        const APART: f64 = 4.0;
        let [left, top, right, bottom] = label.extent();
        self.window.holds([left - APART, top - APART])
            && self.window.holds([right + APART, bottom + APART])
            && self.items.iter().all(|item| {
                let Item::Text(other) = item else { return true };
                let [other_left, other_top, other_right, other_bottom] = other.extent();
                left - APART >= other_right
                    || other_left >= right + APART
                    || top - APART >= other_bottom
                    || other_top >= bottom + APART
            })
    }

    /// Draws a picture in an upright frame.
    pub(crate) fn picture(
        &mut self,
        picture: RgbImage,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
    ) {
        self.tilted_picture(picture, [[x, y], [x + width, y], [x, y + height]], 1.0);
    }

    /// Draws a picture as a parallelogram. One that reaches far beyond the canvas is left out.
    pub(crate) fn tilted_picture(&mut self, picture: RgbImage, corners: Corners, alpha: f64) {
        const FAR: f64 = 8192.0;
        if corners.iter().flatten().all(|part| part.abs() <= FAR) && !picture.is_empty() {
            self.items.push(Item::Picture { picture, corners, alpha });
        }
    }
}

/// A circle, as a polygon whose sides are too short to be seen.
fn circle([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    const SIDES: u32 = 96;
    (0..SIDES)
        .map(|side| {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
            [x + radius * angle.cos(), y + radius * angle.sin()]
        })
        .collect()
}

#[cfg(test)]
mod tests;
