//! Why both orders differ, pixel by pixel, when one of them has the rules of an ordinary renderer.

use super::both::{Both, both};
use crate::diff::foreign::Buffer;
use crate::diff::why::{ReasonKind, Reasons, find_reasons};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::faded;
use crate::wording::{count, grouped};
use image::Rgb;

const ROOM: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [1090.0, 750.0]);
const WORDS: f64 = 1220.0;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let both = both(subject)?;
    let differing: Vec<[u32; 2]> =
        both.comparison.classes().differing().map(|(pixel, _)| pixel).collect();
    let [a, b] = [&both.object_order, &both.image_order].map(crate::orders::Rendered::name);
    let title = format!("Why do {a} and {b} differ?");
    let point = if differing.is_empty() {
        "They agree in every pixel: there is nothing to explain. Give one of them other rules with --object-rules.".into()
    } else {
        format!(
            "{} of the picture differ; the exact judge says why.",
            count(differing.len() as u64, "pixels")
        )
    };
    let mut sheet = Sheet::new(subject, &title, &point);
    let buffers = [
        Buffer::of_frame(&both.object_order.frame, &both.pictures[0]),
        Buffer::of_frame(&both.image_order.frame, &both.pictures[1]),
    ];
    let reasons = find_reasons(&subject.view, &buffers[0], &buffers[1], &differing)
        .map_err(|error| FigureError::new(error.to_string()))?;
    map(&mut sheet, &both, &reasons);
    table(&mut sheet, &both, &reasons);
    Ok(sheet.drawing)
}

/// The picture, pale, with the differing pixels in the colours of their reasons.
fn map(sheet: &mut Sheet, both: &Both, reasons: &Reasons) {
    let theme = sheet.theme;
    let (corner, room) = ROOM;
    let mut picture = faded(&both.pictures[1], theme, 0.34);
    for found in &reasons.pixels {
        let [i, j] = found.pixel;
        picture.put_pixel(j, i, Rgb(found.reason.kind().color()));
    }
    let columns = f64::from(picture.width());
    let size = sheet.picture(picture, corner, room);
    sheet.heading(
        corner,
        size[0].max(700.0),
        "where they differ",
        "each pixel in the colour of its reason",
    );
    // A pixel that is smaller than a mark gets a ring around it, if there are few.
    let cell = size[0] / columns;
    if cell < 5.0 && reasons.pixels.len() <= 200 {
        for found in &reasons.pixels {
            let [i, j] = found.pixel.map(f64::from);
            let middle = [corner[0] + (j + 0.5) * cell, corner[1] + (i + 0.5) * cell];
            sheet.drawing.ring(middle, 7.0, Pen::new(found.reason.kind().color(), 2.0));
        }
    }
}

fn table(sheet: &mut Sheet, both: &Both, reasons: &Reasons) {
    let theme = sheet.theme;
    let (mut y, width) = (ROOM.0[1], RIGHT - WORDS);
    sheet.heading([WORDS, y], width, "reasons", "pixels");
    y += 34.0;
    let counts = reasons.counts();
    if counts.is_empty() {
        sheet.drawing.text([WORDS, y], Anchor::Left, "none: both see the same", theme.text());
        return;
    }
    for (kind, pixels) in &counts {
        swatch(sheet, [WORDS, y - 20.0], *kind);
        let taken = sheet.drawing.text(
            [RIGHT, y],
            Anchor::Right,
            &grouped(*pixels),
            theme.text().tabular(),
        );
        let room = width - taken - 60.0;
        sheet.drawing.fitting([WORDS + 40.0, y], Anchor::Left, kind.name(), theme.text(), room);
        y += 44.0;
    }
    if reasons.is_partial() {
        let looked = format!(
            "{} pixels were looked at, spread evenly; the numbers are scaled.",
            grouped(reasons.pixels.len() as u64)
        );
        y = sheet.paragraph([WORDS, y], width, 30.0, &looked, theme.label());
    }
    y += 14.0;
    let names = [&both.object_order, &both.image_order].map(crate::orders::Rendered::name);
    // The first pixel of each kind, in words, as far as there is room.
    for (kind, _) in &counts {
        let Some(found) = reasons.pixels.iter().find(|one| one.reason.kind() == *kind) else {
            continue;
        };
        let [i, j] = found.pixel;
        let sentence = found.reason.sentence();
        let text = format!("({i}, {j}): {}", in_names(&sentence, &names));
        let lines = text.len() as f64 / 40.0 + 1.0;
        if y + 34.0 * lines > 960.0 {
            break;
        }
        y = sheet.paragraph([WORDS, y], width, 34.0, &text, theme.text());
        y += 12.0;
    }
}

/// A sentence about files A and B, with the orders' names.
fn in_names(sentence: &str, [a, b]: &[String; 2]) -> String {
    let words = sentence.split(' ').map(|word| match word {
        "A" => a.as_str(),
        "B" => b.as_str(),
        "A's" => "object order's",
        "B's" => "image order's",
        word => word,
    });
    words.collect::<Vec<_>>().join(" ")
}

fn swatch(sheet: &mut Sheet, corner: [f64; 2], kind: ReasonKind) {
    sheet.drawing.rectangle(
        corner.map(|part| part - 1.0),
        [26.0; 2],
        Ink::new(sheet.theme.hairline()),
    );
    sheet.drawing.rectangle(corner, [24.0; 2], Ink::new(kind.color()));
}
