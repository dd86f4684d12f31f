//! What an image is: rows and columns of pixels, each with a colour.

use super::interest::outline;
use super::patch::Patch;
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::Role;
use crate::picture::picture;
use image::RgbImage;

const PICTURE: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [720.0, 540.0]);
const PATCH: ([f64; 2], [f64; 2]) = ([900.0, TOP + 44.0], [RIGHT - 900.0, 712.0]);
/// Rows and columns of the patch, as far as the image has them.
const SIZE: [usize; 2] = [6, 8];

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let frame = subject.frame();
    let picture = picture(&frame);
    let pixel = subject.pixel().unwrap_or_else(|| outline(&subject.view, &frame));
    let [width, height] = subject.view.camera.image();
    let point = "canvas[i, j] = color: to draw is to decide the colour of every pixel.";
    let mut sheet = Sheet::new(subject, "An image is rows and columns of pixels", point);
    let patch = Patch::around(pixel, [width, height], SIZE, PATCH);
    whole(&mut sheet, &picture, &patch);
    let (corner, size) = patch.extent();
    sheet.heading([corner[0], PATCH.0[1]], size[0], "some of them", &patch.name());
    cells(&mut sheet, &picture, &patch);
    let theme = sheet.theme;
    let y = PICTURE.0[1] + PICTURE.1[1] + 60.0;
    let numbers = format!(
        "{height} rows × {width} columns = {} pixels",
        crate::wording::grouped(u64::from(width) * u64::from(height))
    );
    let lines = [
        (numbers.as_str(), theme.heading()),
        ("i counts rows from the top, j columns from the left, here from 0.", theme.text()),
        ("The three numbers are red, green and blue, from 0 to 255.", theme.text()),
    ];
    sheet.lines([MARGIN, y], PICTURE.1[0] + 60.0, 44.0, &lines);
    Ok(sheet.drawing)
}

/// The whole picture, with the patch framed.
fn whole(sheet: &mut Sheet, picture: &RgbImage, patch: &Patch) {
    let (corner, room) = PICTURE;
    let image = [picture.width(), picture.height()];
    sheet.heading(corner, room[0], "the whole image", "");
    let size = sheet.picture(picture.clone(), corner, room);
    let scale = [size[0] / f64::from(image[0]), size[1] / f64::from(image[1])];
    let at = [
        corner[0] + patch.first[1] as f64 * scale[0],
        corner[1] + patch.first[0] as f64 * scale[1],
    ];
    let framed = [patch.size[1] as f64 * scale[0], patch.size[0] as f64 * scale[1]];
    // A patch of a large image is small: its frame stays seen.
    let grown = framed.map(|side| (26.0 - side).max(0.0) / 2.0);
    let at = [at[0] - grown[0], at[1] - grown[1]];
    let framed = [framed[0] + 2.0 * grown[0], framed[1] + 2.0 * grown[1]];
    let focus = sheet.theme.of(Role::Focus);
    sheet.drawing.frame(at, framed, Pen::new(sheet.theme.background(), 7.0));
    sheet.drawing.frame(at, framed, Pen::new(focus, 3.5));
    let ([x, y], [_, height]) = patch.extent();
    let from = [at[0] + framed[0], at[1] + 0.5 * framed[1]];
    let thin = Pen::new(focus, 2.0).dashed(3.0, 7.0);
    sheet.drawing.line(&[from, [x - 10.0, y]], thin);
    sheet.drawing.line(&[from, [x - 10.0, y + height]], thin);
}

/// The pixels of the patch with their numbers.
fn cells(sheet: &mut Sheet, picture: &RgbImage, patch: &Patch) {
    let theme = sheet.theme;
    for [row, column] in patch.pixels() {
        let side = |part: usize| u32::try_from(part).expect("within the image");
        let color = picture.get_pixel(side(column), side(row)).0;
        let corner = patch.corner([row, column]);
        sheet.drawing.rectangle(corner, [patch.cell; 2], Ink::new(color));
        // Letters that stand out from the pixel: dark on light ones, light on dark ones.
        let light =
            0.3 * f64::from(color[0]) + 0.59 * f64::from(color[1]) + 0.11 * f64::from(color[2]);
        let letters = if light > 120.0 { [0x10, 0x14, 0x18] } else { [0xff; 3] };
        #[expect(clippy::cast_possible_truncation, reason = "a size of letters")]
        let size = (0.17 * patch.cell).min(26.0) as f32;
        let [x, y] = patch.middle([row, column]);
        for (line, value) in color.into_iter().enumerate() {
            let baseline = y + 0.06 * patch.cell + (line as f64 - 1.0) * 0.25 * patch.cell;
            let style = theme.text().tabular().sized(size).of(letters);
            sheet.drawing.text([x, baseline], Anchor::Middle, &value.to_string(), style);
        }
    }
    patch.draw_lines(&mut sheet.drawing, Pen::new(theme.background(), 2.0));
}
