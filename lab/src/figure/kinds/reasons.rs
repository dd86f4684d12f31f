//! Why both orders differ, pixel by pixel, when one of them has the rules of an ordinary renderer.

use super::both::{Both, both};
use crate::diff::foreign::{Buffer, Side};
use crate::diff::why::{
    Explanation, Finding, Findings, ReasonKind, Reasons, find_conventions, find_reasons,
};
use crate::figure::drawing::{Anchor, Drawing, Ink, Pen};
use crate::figure::sheet::{MARGIN, RIGHT, Sheet, TOP};
use crate::figure::subject::{FigureError, Subject};
use crate::figure::theme::faded;
use crate::orders::Rendered;
use crate::wording::{count, grouped};
use image::Rgb;

const ROOM: ([f64; 2], [f64; 2]) = ([MARGIN, TOP + 44.0], [1090.0, 750.0]);
const WORDS: f64 = 1220.0;

pub(super) fn draw(subject: &Subject) -> Result<Drawing, FigureError> {
    let both = both(subject)?;
    let differing: Vec<[u32; 2]> =
        both.comparison.classes().differing().map(|(pixel, _)| pixel).collect();
    let names = [&both.object_order, &both.image_order].map(name);
    let title = format!("Why do {} and {} differ?", names[0], names[1]);
    let buffers = [
        Buffer::of_frame(&both.object_order.frame, &both.pictures[0]),
        Buffer::of_frame(&both.image_order.frame, &both.pictures[1]),
    ];
    let mut reasons = find_reasons(&subject.view, &buffers[0], &buffers[1], &differing)
        .map_err(|error| FigureError::new(error.to_string()))?;
    let conventions = conventions(subject, &both, &buffers, &mut reasons);
    let mut sheet = Sheet::new(subject, &title, &point(&reasons));
    map(&mut sheet, &both, &reasons);
    table(&mut sheet, &names, &conventions, &reasons);
    Ok(sheet.drawing)
}

/// The name of an order, with its rule: "object order (corner)".
fn name(rendered: &Rendered) -> String {
    let order = rendered.order.name();
    rendered.rule.map_or(order.into(), |rule| format!("{order} ({rule})"))
}

/// What there is to see, in a sentence.
fn point(reasons: &Reasons) -> String {
    if reasons.differing == 0 {
        return "They agree in every pixel: there is nothing to explain. Give one of them other rules with --object-rules."
            .into();
    }
    let unexplained = reasons.count_of(|kind| kind == ReasonKind::Unexplained);
    let differ = format!("{} of the picture differ", count(reasons.differing, "pixels"));
    match unexplained {
        0 => format!("{differ}; each of them has a reason."),
        some => format!("{differ}; for {} of them no reason is known.", grouped(some)),
    }
}

/// What an order with other rules does otherwise as a whole, in sentences; the pixels that it explains get it for their reason.
fn conventions(
    subject: &Subject,
    both: &Both,
    buffers: &[Buffer; 2],
    reasons: &mut Reasons,
) -> Vec<String> {
    let mut sentences = Vec::new();
    let orders = [&both.object_order, &both.image_order];
    for ((rendered, buffer), side) in orders.into_iter().zip(buffers).zip([Side::A, Side::B]) {
        let found = rendered.rule.and_then(|_| find_conventions(&subject.view, buffer).ok());
        if let Some(Findings { finding: Finding::Explained(found), differing, .. }) = found
            && !found[0].is_a_guess(differing)
        {
            reasons.explained_by(side, &found[0]);
            // Of several explanations, what all of them say is certain.
            let said = |one: &Explanation| one.sentences(&name(rendered), subject.view.camera);
            let others: Vec<Vec<String>> = found[1..].iter().map(said).collect();
            let certain = |sentence: &String| others.iter().all(|other| other.contains(sentence));
            sentences.extend(said(&found[0]).into_iter().filter(certain));
        }
    }
    sentences
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

fn table(sheet: &mut Sheet, names: &[String; 2], conventions: &[String], reasons: &Reasons) {
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
    for sentence in conventions {
        y = sheet.paragraph([WORDS, y], width, 34.0, sentence, theme.text());
        y += 12.0;
    }
    // The first pixel of each kind, in words, as far as there is room.
    for (kind, _) in counts.iter().filter(|(kind, _)| *kind != ReasonKind::Convention) {
        let Some(found) = reasons.pixels.iter().find(|one| one.reason.kind() == *kind) else {
            continue;
        };
        let [i, j] = found.pixel;
        let sentence = found.reason.sentence();
        let text = format!("({i}, {j}): {}", in_names(&sentence, names));
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
