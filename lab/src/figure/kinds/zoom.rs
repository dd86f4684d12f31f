//! A patch of all buffers of both orders: colour, ids, distances, coverage.

use super::both::{Both, both};
use super::interest::outline;
use super::patch::Patch;
use crate::common::{Frame, View};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::sheet::{MARGIN, Sheet, TOP, number};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::{Role, ramp};
use crate::picture::color_of_id;
use crate::wording::count;
use image::RgbImage;

/// Rows and columns of the patch, as far as the image has them.
const SIZE: [usize; 2] = [12, 16];
const ROOM: [f64; 2] = [420.0, 316.0];
const STEP: f64 = 452.0;
const TOPS: [f64; 2] = [TOP + 50.0, TOP + 440.0];
const BUFFERS: [&str; 4] = ["colour", "ids", "distance t", "coverage"];

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let both = both(subject)?;
    let pixel = subject.pixel().unwrap_or_else(|| telling(&subject.view, &both));
    let image = subject.view.camera.image();
    let [i, j] = pixel;
    let patch = Patch::around(pixel, image, SIZE, ([0.0; 2], ROOM));
    let point = point(&both, &patch);
    let mut sheet = Sheet::new(subject, &format!("All buffers around pixel ({i}, {j})"), &point);
    let range = distances(&both, &patch);
    for (row, rendered) in [&both.object_order, &both.image_order].into_iter().enumerate() {
        for (column, buffer) in BUFFERS.into_iter().enumerate() {
            let corner = [MARGIN + column as f64 * STEP, TOPS[row]];
            let patch = Patch::around(pixel, image, SIZE, (corner, ROOM));
            match column {
                0 => sheet.heading(corner, ROOM[0], &rendered.name(), buffer),
                _ => sheet.heading(corner, ROOM[0], buffer, ""),
            }
            let picture = &both.pictures[row];
            cells(&mut sheet, &patch, &rendered.frame, picture, column, range);
            mark(&mut sheet, &patch, &both, pixel);
        }
    }
    legend(&mut sheet, range, &both, &patch);
    Ok(sheet.drawing)
}

/// What there is to see, in a sentence.
fn point(both: &Both, patch: &Patch) -> String {
    let comparison = &both.comparison;
    let here = patch.pixels().filter(|pixel| differs(both, *pixel)).count() as u64;
    let within = comparison.depth.differing_pixels == 0 && comparison.color.differing_pixels == 0;
    match (comparison.visible.differing_pixels, here) {
        (0, _) if within => {
            "Both orders write the same ids and the same coverage; colours and distances agree within rounding.".into()
        }
        (0, _) => "Both orders write the same ids and the same coverage; their colours or distances differ.".into(),
        (all, 0) => format!("The orders see different primitives in {}, none of them here.", count(all, "pixels")),
        (all, here) => format!(
            "The orders see different primitives in {} of the picture; the {} here are framed.",
            count(all, "pixels"),
            crate::wording::grouped(here)
        ),
    }
}

/// Whether the orders see different primitives in a pixel.
fn differs(both: &Both, [row, column]: [usize; 2]) -> bool {
    let side = |part: usize| u32::try_from(part).expect("within the image");
    both.comparison.classes().at(side(row), side(column)).differs()
}

/// The first differing pixel; if there is none, an outline near the middle.
fn telling(view: &View, both: &Both) -> [u32; 2] {
    if let Some(pixel) = both.comparison.visible.first_differing.first() {
        return *pixel;
    }
    outline(view, &both.object_order.frame)
}

/// The least and the greatest distance in the patch.
fn distances(both: &Both, patch: &Patch) -> [f64; 2] {
    let frame = &both.object_order.frame;
    let all = patch.pixels().filter_map(|[row, column]| frame.t(row, column)).map(f64::from);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| [low.min(t), high.max(t)])
}

/// Draws one buffer of the patch, pixel by pixel.
fn cells(
    sheet: &mut Sheet,
    patch: &Patch,
    frame: &Frame,
    picture: &RgbImage,
    buffer: usize,
    [low, high]: [f64; 2],
) {
    let theme = sheet.theme;
    for [row, column] in patch.pixels() {
        let (corner, size) = (patch.corner([row, column]), [patch.cell; 2]);
        let side = |part: usize| u32::try_from(part).expect("within the image");
        let color = match buffer {
            0 => Some(picture.get_pixel(side(column), side(row)).0),
            1 => frame.id(row, column).map(|id| color_of_id(Some(id))),
            2 => frame.t(row, column).map(|t| {
                let span = if high > low { high - low } else { 1.0 };
                ramp(0.06 + 0.94 * (f64::from(t) - low) / span)
            }),
            _ => frame.id(row, column).map(|_| theme.bright()),
        };
        sheet.drawing.rectangle(corner, size, Ink::new(color.unwrap_or(theme.mat())));
        if color.is_none() {
            sheet.drawing.hatch(corner, size, 9.0, Pen::new(theme.hairline(), 1.2));
        }
    }
    patch.draw_lines(&mut sheet.drawing, Pen::new(theme.background(), 1.0));
}

/// Frames the pixels in which the orders differ, and the one that is looked at.
fn mark(sheet: &mut Sheet, patch: &Patch, both: &Both, looked_at: [u32; 2]) {
    let looked_at = looked_at.map(|part| part as usize);
    for [row, column] in patch.pixels() {
        let differs = differs(both, [row, column]);
        if differs || [row, column] == looked_at {
            let color = if differs { sheet.theme.of(Role::Focus) } else { sheet.theme.bright() };
            let corner = patch.corner([row, column]).map(|part| part + 1.0);
            sheet.drawing.frame(
                corner,
                [patch.cell - 2.0; 2],
                Pen::new(sheet.theme.background(), 5.0),
            );
            sheet.drawing.frame(corner, [patch.cell - 2.0; 2], Pen::new(color, 3.0));
        }
    }
}

fn legend(sheet: &mut Sheet, [low, high]: [f64; 2], both: &Both, patch: &Patch) {
    let theme = sheet.theme;
    let y = 986.0;
    let frames = [&both.object_order.frame, &both.image_order.frame];
    let sees_nothing =
        |[row, column]: [usize; 2]| frames.iter().any(|frame| frame.id(row, column).is_none());
    let hatched = if patch.pixels().any(sees_nothing) { ";  hatched: nothing is seen" } else { "" };
    let rows = format!("{}{hatched}", patch.name());
    sheet.drawing.text([MARGIN, y], Anchor::Left, &rows, theme.label());
    let range = if low < high {
        format!("t from {} (dark) to {} (light)", number(low, 5), number(high, 5))
    } else if low == high {
        format!("t = {} wherever something is seen", number(low, 5))
    } else {
        return;
    };
    sheet.drawing.text([MARGIN + 2.0 * STEP, y], Anchor::Left, &range, theme.label());
}
