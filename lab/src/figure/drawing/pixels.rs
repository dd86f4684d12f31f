//! A drawing as a picture of pixels.
//!
//! It can be drawn in bands of some rows: then it is never in memory as a whole.

use super::canvas::CANVAS;
use super::items::{Corners, Drawing, Ink, Item, Pen, Text};
use crate::figure::resize::resized;
use crate::figure::text;
use image::RgbImage;
use std::borrow::Cow;
use std::ops::Range;
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap,
    PixmapPaint, Rect, Stroke, StrokeDash, Transform,
};

/// The width of the line around letters on a picture, in their size.
pub(super) const HALO: f64 = 0.22;

/// The pixels of a band: half a MiB of them.
const BAND: u32 = 1 << 17;

/// The bands of a picture, from the top to the bottom.
#[derive(Debug)]
pub struct Bands<'a> {
    shapes: Vec<Shape<'a>>,
    background: [u8; 3],
    size: [u32; 2],
    /// The most rows of a band.
    rows: u32,
    /// The first row of the next band.
    next: u32,
}

impl<'a> Bands<'a> {
    pub(super) fn new(drawing: &'a Drawing, width: u32) -> Bands<'a> {
        assert!((1..=1 << 14).contains(&width), "a picture {width} pixels wide");
        let scale = f64::from(width) / CANVAS[0];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "nine sixteenths of the width"
        )]
        let height = (CANVAS[1] * scale).round().max(1.0) as u32;
        let mut shapes = Shapes { all: Vec::new(), scale };
        drawing.items.iter().for_each(|item| shapes.add(item));
        Bands {
            shapes: shapes.all,
            background: drawing.background,
            size: [width, height],
            rows: (BAND / width).max(1),
            next: 0,
        }
    }

    /// The whole picture.
    pub(super) fn whole(drawing: &'a Drawing, width: u32) -> RgbImage {
        let all = Bands::new(drawing, width);
        let rows = all.size[1];
        Bands { rows, ..all }.next().expect("a picture has rows")
    }

    /// The width and height of the whole picture, in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The row where the next band ends: the last one in its second half that cuts no path that is less high than a band, if
    /// there is one. A curve that is cut is made of other lines, so that some pixels change a little.
    fn end(&self) -> u32 {
        let [_, height] = self.size;
        let last = height.min(self.next + self.rows);
        let most = single(self.rows.into());
        let lower = |rows: &&Range<f32>| rows.end - rows.start < most;
        let low: Vec<_> = self.shapes.iter().filter_map(Shape::cuttable).filter(lower).collect();
        let mut end = last;
        while end < height && end > self.next + self.rows / 2 {
            let row = single(end.into());
            let Some(cut) = low.iter().find(|rows| rows.start < row && row < rows.end) else {
                return end;
            };
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a row; what begins above the picture gives row 0"
            )]
            let above = cut.start.floor() as u32;
            end = above;
        }
        last
    }
}

impl Iterator for Bands<'_> {
    type Item = RgbImage;

    fn next(&mut self) -> Option<RgbImage> {
        let end = self.end();
        let rows = std::mem::replace(&mut self.next, end)..end;
        // There are no rows behind the last.
        let mut pixels = Pixmap::new(self.size[0], rows.end - rows.start)?;
        let [red, green, blue] = self.background;
        pixels.fill(Color::from_rgba8(red, green, blue, u8::MAX));
        self.shapes.iter().for_each(|shape| shape.draw(&mut pixels, &rows));
        Some(image(pixels))
    }
}

/// An item of a drawing in pixels, ready to be drawn.
#[derive(Debug)]
enum Shape<'a> {
    Rectangle {
        rectangle: Rect,
        ink: Ink,
    },
    Path(Inked),
    /// A picture of the size it has here, and where its top left pixel lies.
    Picture {
        pixels: Cow<'a, RgbImage>,
        corner: [f64; 2],
        alpha: f64,
    },
    Tilted {
        pixels: Pixmap,
        paint: PixmapPaint,
        place: Transform,
    },
}

/// A path in pixels that is filled; or one that a stroke follows, and the place of both.
#[derive(Debug)]
struct Inked {
    path: Path,
    stroke: Option<(Stroke, Transform)>,
    ink: Ink,
    /// From where to where there may be ink, from the top.
    extent: Range<f32>,
}

impl Shape<'_> {
    /// The extent of a path.
    fn cuttable(&self) -> Option<&Range<f32>> {
        if let Shape::Path(path) = self { Some(&path.extent) } else { None }
    }

    /// Draws what lies in these rows of the picture.
    fn draw(&self, band: &mut Pixmap, rows: &Range<u32>) {
        let [above, below] = [rows.start, rows.end].map(|row| single(row.into()));
        // Fills are in pixels already, and are moved by a whole number of them, so that no coordinate is rounded.
        let up = Transform::from_translate(0.0, -above);
        match self {
            Shape::Rectangle { rectangle, ink } => {
                let [top, bottom] =
                    [rectangle.top(), rectangle.bottom()].map(|y| y.clamp(above, below) - above);
                let part = Rect::from_ltrb(rectangle.left(), top, rectangle.right(), bottom);
                if let Some(part) = part.filter(|part| part.height() > 0.0) {
                    band.fill_rect(part, &paint(*ink), Transform::identity(), None);
                }
            }
            Shape::Path(Inked { path, stroke, ink, extent }) => {
                if extent.start < below && above < extent.end {
                    match stroke {
                        None => band.fill_path(path, &paint(*ink), FillRule::Winding, up, None),
                        Some((stroke, place)) => {
                            let place = place.post_concat(up);
                            band.stroke_path(path, &paint(*ink), stroke, place, None);
                        }
                    }
                }
            }
            Shape::Picture { pixels, corner: [x, y], alpha } => {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "within the height"
                )]
                let [first, end] = [rows.start, rows.end]
                    .map(|row| (f64::from(row) - y).clamp(0.0, f64::from(pixels.height())) as u32);
                if first < end {
                    let part = pixmap(pixels, first..end);
                    let down = y + f64::from(first) - f64::from(rows.start);
                    let place = Transform::from_translate(single(*x), single(down));
                    let paint = PixmapPaint { opacity: single(*alpha), ..PixmapPaint::default() };
                    band.draw_pixmap(0, 0, part.as_ref(), &paint, place, None);
                }
            }
            Shape::Tilted { pixels, paint, place } => {
                band.draw_pixmap(0, 0, pixels.as_ref(), paint, place.post_concat(up), None);
            }
        }
    }
}

/// The shapes of a drawing.
struct Shapes<'a> {
    all: Vec<Shape<'a>>,
    /// Pixels in a unit.
    scale: f64,
}

impl<'a> Shapes<'a> {
    fn transform(&self) -> Transform {
        let scale = single(self.scale);
        Transform::from_scale(scale, scale)
    }

    fn add(&mut self, item: &'a Item) {
        match item {
            Item::Fill { outline, ink } => self.fill(outline, *ink),
            Item::Line { points, closed, pen } => self.line(points, *closed, pen),
            Item::Disc { center: [x, y], radius, ink } => {
                let disc = PathBuilder::from_circle(single(*x), single(*y), single(*radius));
                self.filled(disc, self.transform(), *ink);
            }
            Item::Text(text) => self.text(text),
            Item::Picture { picture, corners, alpha } => self.picture(picture, corners, *alpha),
        }
    }

    fn filled(&mut self, path: Option<Path>, place: Transform, ink: Ink) {
        let Some(path) = path.and_then(|path| path.transform(place)) else { return };
        let extent = path.bounds().top()..path.bounds().bottom();
        self.path(Inked { path, stroke: None, ink, extent });
    }

    fn stroked(&mut self, path: Option<Path>, place: Transform, stroke: Stroke, ink: Ink) {
        let Some(path) = path else { return };
        let half = 0.5 * stroke.width;
        let bounds = path.bounds().outset(half, half).and_then(|bounds| bounds.transform(place));
        let Some(extent) = bounds.map(|bounds| bounds.top()..bounds.bottom()) else { return };
        self.path(Inked { path, stroke: Some((stroke, place)), ink, extent });
    }

    fn path(&mut self, path: Inked) {
        // A pixel more on each side, for what is rounded.
        let extent = path.extent.start - 1.0..path.extent.end + 1.0;
        self.all.push(Shape::Path(Inked { extent, ..path }));
    }

    fn fill(&mut self, outline: &[[f64; 2]], ink: Ink) {
        // Upright rectangles of whole pixels keep sharp sides. At another scale, sides lie between pixels.
        match upright(outline) {
            Some(rectangle) if self.scale == 1.0 => {
                self.all.push(Shape::Rectangle { rectangle, ink });
            }
            _ => self.filled(path(outline, true), self.transform(), ink),
        }
    }

    fn line(&mut self, points: &[[f64; 2]], closed: bool, pen: &Pen) {
        let dash = pen.dash.and_then(|dash| StrokeDash::new(dash.map(single).to_vec(), 0.0));
        let stroke = Stroke {
            width: single(pen.width),
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        self.stroked(path(points, closed), self.transform(), stroke, pen.ink);
    }

    fn text(&mut self, item: &Text) {
        let Text { text: letters, left, baseline, style, halo } = item;
        let path = text::path(letters, *style);
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
            self.stroked(path.clone(), place, stroke, Ink::new(*halo));
        }
        self.filled(path, place, Ink::new(style.color));
    }

    fn picture(&mut self, picture: &'a RgbImage, [corner, right, below]: &Corners, alpha: f64) {
        let [corner, right, below] =
            [corner, right, below].map(|corner| corner.map(|part| part * self.scale));
        let upright = corner[1] == right[1] && corner[0] == below[0];
        let size = [right[0] - corner[0], below[1] - corner[1]].map(|side| side.round().max(1.0));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a size on the canvas"
        )]
        let pixels = size.map(|side| side as u32);
        // Our own resizing mixes light, and keeps enlarged pixels square.
        if upright {
            let pixels = resized(picture, pixels);
            self.all.push(Shape::Picture { pixels, corner: corner.map(f64::round), alpha });
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
            let pixels = pixmap(picture, 0..picture.height());
            self.all.push(Shape::Tilted { pixels, paint, place });
        }
    }
}

/// The image of opaque pixels, in their memory.
fn image(pixels: Pixmap) -> RgbImage {
    let (width, height) = (pixels.width(), pixels.height());
    let mut bytes = pixels.take();
    for pixel in 0..bytes.len() / 4 {
        bytes.copy_within(4 * pixel..4 * pixel + 3, 3 * pixel);
    }
    bytes.truncate(bytes.len() / 4 * 3);
    RgbImage::from_raw(width, height, bytes).expect("three bytes a pixel")
}

/// These rows of a picture; there is at least one.
fn pixmap(picture: &RgbImage, rows: Range<u32>) -> Pixmap {
    let (width, height) = (picture.width(), rows.end - rows.start);
    let mut pixels = Pixmap::new(width, height).expect("a picture has pixels");
    let from = &picture.as_chunks::<3>().0[width as usize * rows.start as usize..];
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::drawing::Anchor;
    use crate::figure::theme::Theme;

    /// The picture in bands of so many rows.
    fn in_bands(drawing: &Drawing, width: u32, rows: u32) -> Vec<u8> {
        let bands = Bands { rows, ..Bands::new(drawing, width) };
        let bands: Vec<RgbImage> = bands.collect();
        let whole = bands.iter().take(bands.len() - 1);
        assert!(whole.clone().all(|band| band.dimensions() == (width, rows)));
        bands.into_iter().flat_map(RgbImage::into_raw).collect()
    }

    fn checkered() -> RgbImage {
        RgbImage::from_fn(40, 90, |x, y| {
            image::Rgb(if (x + y) % 2 == 0 { [255; 3] } else { [9; 3] })
        })
    }

    #[test]
    fn pictures_and_rectangles_are_the_same_in_bands_of_any_height() {
        let mut drawing = Drawing::new("", "", [250, 250, 240]);
        drawing.rectangle([50.0, 130.0], [1500.0, 700.0], Ink::new([1, 2, 3]).alpha(0.5));
        drawing.picture(checkered(), [100.0, 200.0], [80.0, 180.0]);
        drawing.picture(checkered(), [900.0, -60.0], [160.0, 360.0]);
        drawing.picture(checkered(), [300.0, 960.0], [80.0, 180.0]);
        for width in [960, 1920] {
            let whole = drawing.pixels(width).into_raw();
            for rows in [1, 7, 68, 539] {
                let parts = in_bands(&drawing, width, rows);
                assert!(parts == whole, "{width} pixels wide, in bands of {rows} rows");
            }
            // The second pixel of the first picture.
            let [row, column] = [5 * width / 48, 5 * width / 96 + width / 960];
            assert_eq!(whole[3 * (row * width + column) as usize..][..3], [9; 3]);
        }
    }

    #[test]
    fn paths_and_texts_go_on_from_band_to_band() {
        let mut drawing = Drawing::new("", "", [255; 3]);
        let pen = Pen::new([0; 3], 9.0);
        drawing.line(&[[20.0, 10.0], [1900.0, 1060.0], [60.0, 1070.0]], pen);
        drawing.ring([960.0, 540.0], 500.0, pen.dashed(30.0, 20.0));
        drawing.disc([960.0, 540.0], 300.0, Ink::new([200, 40, 10]));
        let grey = RgbImage::from_fn(40, 90, |x, y| image::Rgb([(2 * x + y).to_le_bytes()[0]; 3]));
        drawing.tilted_picture(grey, [[1300.0, 300.0], [1700.0, 340.0], [1260.0, 900.0]], 0.5);
        for line in 1..30 {
            let baseline = 35.3 * f64::from(line);
            let style = Theme::Light.text();
            drawing.text_with_halo([300.0, baseline], Anchor::Left, "Ågy", style, Some([90; 3]));
        }
        let whole = in_bands(&drawing, 960, 540);
        for rows in [1, 7, 68, 539] {
            let parts = in_bands(&drawing, 960, rows);
            let apart: Vec<u8> = whole.iter().zip(&parts).map(|(a, b)| a.abs_diff(*b)).collect();
            // A row has four subsamples from top to bottom: one of them may be rounded to the other side.
            let total: u64 = apart.iter().map(|&apart| u64::from(apart)).sum();
            assert!(apart.iter().all(|&apart| apart <= 80), "bands of {rows} rows");
            assert!(total < apart.len() as u64 / 10, "bands of {rows} rows: {total}");
        }
    }

    #[test]
    fn the_canvas_is_opaque_to_its_last_row() {
        // The canvas is 562.5 pixels high.
        let drawing = Drawing::new("", "", [250; 3]);
        assert!(drawing.pixels(1000).iter().all(|&byte| byte == 250));
    }
}
