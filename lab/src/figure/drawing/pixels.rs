//! A drawing as a picture of pixels.

use super::canvas::CANVAS;
use super::items::{Corners, Drawing, Ink, Item, Pen, Text};
use crate::figure::resize::resized;
use crate::figure::text;
use image::RgbImage;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap,
    PixmapPaint, Rect, Stroke, StrokeDash, Transform,
};

/// The width of the line around letters on a picture, in their size.
pub(super) const HALO: f64 = 0.22;

pub(super) fn draw(drawing: &Drawing, width: u32) -> RgbImage {
    assert!((1..=1 << 14).contains(&width), "a picture {width} pixels wide");
    let scale = f64::from(width) / CANVAS[0];
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "nine sixteenths of the width"
    )]
    let height = (CANVAS[1] * scale).round().max(1.0) as u32;
    let pixels = Pixmap::new(width, height).expect("both sides are positive");
    let mut canvas = Canvas { pixels, scale };
    for item in &drawing.items {
        match item {
            Item::Fill { outline, ink } => canvas.fill(outline, *ink),
            Item::Line { points, closed, pen } => canvas.line(points, *closed, pen),
            Item::Disc { center, radius, ink } => canvas.disc(*center, *radius, *ink),
            Item::Text(text) => canvas.text(text),
            Item::Picture { picture, corners, alpha } => canvas.picture(picture, corners, *alpha),
        }
    }
    canvas.into_image()
}

struct Canvas {
    pixels: Pixmap,
    /// Pixels in a unit.
    scale: f64,
}

impl Canvas {
    fn transform(&self) -> Transform {
        let scale = single(self.scale);
        Transform::from_scale(scale, scale)
    }

    fn fill(&mut self, outline: &[[f64; 2]], ink: Ink) {
        let transform = self.transform();
        // Upright rectangles of whole pixels keep sharp sides.
        if let Some(rectangle) = upright(outline) {
            self.pixels.fill_rect(rectangle, &paint(ink), transform, None);
        } else if let Some(path) = path(outline, true) {
            self.pixels.fill_path(&path, &paint(ink), FillRule::Winding, transform, None);
        }
    }

    fn line(&mut self, points: &[[f64; 2]], closed: bool, pen: &Pen) {
        if let Some(path) = path(points, closed) {
            let dash = pen.dash.and_then(|dash| StrokeDash::new(dash.map(single).to_vec(), 0.0));
            let stroke = Stroke {
                width: single(pen.width),
                line_cap: LineCap::Round,
                line_join: LineJoin::Round,
                dash,
                ..Stroke::default()
            };
            self.pixels.stroke_path(&path, &paint(pen.ink), &stroke, self.transform(), None);
        }
    }

    fn disc(&mut self, [x, y]: [f64; 2], radius: f64, ink: Ink) {
        if let Some(path) = PathBuilder::from_circle(single(x), single(y), single(radius)) {
            let transform = self.transform();
            self.pixels.fill_path(&path, &paint(ink), FillRule::Winding, transform, None);
        }
    }

    fn text(&mut self, item: &Text) {
        let Text { text: letters, left, baseline, style, halo } = item;
        let Some(path) = text::path(letters, *style) else { return };
        let scale = text::scale(*style);
        // In a font, y points up.
        let place = Transform::from_row(scale, 0.0, 0.0, -scale, single(*left), single(*baseline));
        let place = place.post_concat(self.transform());
        if let Some(halo) = halo {
            let stroke = Stroke {
                width: single(HALO) * style.size / scale,
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            self.pixels.stroke_path(&path, &paint(Ink::new(*halo)), &stroke, place, None);
        }
        self.pixels.fill_path(&path, &paint(Ink::new(style.color)), FillRule::Winding, place, None);
    }

    fn picture(&mut self, picture: &RgbImage, [corner, right, below]: &Corners, alpha: f64) {
        let place = |point: &[f64; 2]| point.map(|part| part * self.scale);
        let [corner, right, below] = [place(corner), place(right), place(below)];
        let upright = corner[1] == right[1] && corner[0] == below[0];
        let size = [right[0] - corner[0], below[1] - corner[1]].map(|side| side.round().max(1.0));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a size on the canvas"
        )]
        let pixels = size.map(|side| side as u32);
        // Our own resizing mixes light, and keeps enlarged pixels square.
        if upright && size.iter().all(|side| *side >= 1.0) {
            let resized = pixmap(&resized(picture, pixels));
            let place =
                Transform::from_translate(single(corner[0].round()), single(corner[1].round()));
            let paint = PixmapPaint { opacity: single(alpha), ..PixmapPaint::default() };
            self.pixels.draw_pixmap(0, 0, resized.as_ref(), &paint, place, None);
            return;
        }
        let [width, height] = [picture.width(), picture.height()].map(f64::from);
        let place = Transform::from_row(
            single((right[0] - corner[0]) / width),
            single((right[1] - corner[1]) / width),
            single((below[0] - corner[0]) / height),
            single((below[1] - corner[1]) / height),
            single(corner[0]),
            single(corner[1]),
        );
        let enlarged = (right[0] - corner[0]).hypot(right[1] - corner[1]) >= width;
        let quality = if enlarged { FilterQuality::Nearest } else { FilterQuality::Bilinear };
        let paint = PixmapPaint { opacity: single(alpha), quality, ..PixmapPaint::default() };
        if place.invert().is_some() {
            self.pixels.draw_pixmap(0, 0, pixmap(picture).as_ref(), &paint, place, None);
        }
    }

    /// The image, in the memory of the canvas: a slide is large beside the rest of a small run.
    fn into_image(self) -> RgbImage {
        let (width, height) = (self.pixels.width(), self.pixels.height());
        let mut bytes = self.pixels.take();
        // The background is opaque, and so are all pixels.
        for pixel in 0..bytes.len() / 4 {
            bytes.copy_within(4 * pixel..4 * pixel + 3, 3 * pixel);
        }
        bytes.truncate(bytes.len() / 4 * 3);
        RgbImage::from_raw(width, height, bytes).expect("three bytes a pixel")
    }
}

fn pixmap(picture: &RgbImage) -> Pixmap {
    let mut pixels = Pixmap::new(picture.width(), picture.height()).expect("a picture has pixels");
    let from = picture.as_chunks::<3>().0;
    for (to, &[red, green, blue]) in pixels.data_mut().as_chunks_mut::<4>().0.iter_mut().zip(from) {
        *to = [red, green, blue, u8::MAX];
    }
    pixels
}

/// The rectangle of an outline of four corners with upright sides.
fn upright(outline: &[[f64; 2]]) -> Option<Rect> {
    let [[a, b], [c, d], [e, f], [g, h]] = *outline else { return None };
    let is_upright = b == d && c == e && f == h && g == a;
    is_upright.then(|| Rect::from_ltrb(single(a), single(b), single(e), single(f))).flatten()
}

fn path(points: &[[f64; 2]], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (k, [x, y]) in points.iter().enumerate() {
        let (x, y) = (single(*x), single(*y));
        if k == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn paint(Ink { color: [red, green, blue], alpha }: Ink) -> Paint<'static> {
    let mut color = Color::from_rgba8(red, green, blue, u8::MAX);
    color.set_alpha(single(alpha));
    let mut paint = Paint::default();
    paint.set_color(color);
    paint
}

#[expect(clippy::cast_possible_truncation, reason = "lengths on the canvas")]
fn single(value: f64) -> f32 {
    value as f32
}
