//! A drawing as the text of an SVG file.
//!
//! Letters are outlines, each written once and used where it stands, so that the file needs no fonts and stays small.
//! Pictures are PNG files within it.

use super::canvas::CANVAS;
use super::items::{Drawing, Ink, Item, Pen, Text};
use crate::figure::formula::plain;
use crate::figure::text::{self, Weight};
use base64::Engine;
use image::{ImageFormat, RgbImage};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::io::Cursor;

pub(super) fn write(drawing: &Drawing) -> String {
    let [width, height] = CANVAS;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" role=\"img\" aria-labelledby=\"title description\">\n\
         <title id=\"title\">{}</title>\n<desc id=\"description\">{}</desc>\n",
        escaped(&plain(&drawing.title)),
        escaped(&plain(&drawing.description))
    );
    svg += &letters(drawing);
    let canvas = path(&[[0.0, 0.0], [width, 0.0], CANVAS, [0.0, height]]);
    let _ = writeln!(svg, "<path d=\"{canvas}z\"{}/>", fill(Ink::new(drawing.background)));
    for item in &drawing.items {
        match item {
            Item::Fill { outline, ink } => {
                let _ = writeln!(svg, "<path d=\"{}z\"{}/>", path(outline), fill(*ink));
            }
            Item::Line { points, closed, pen } => {
                let close = if *closed { "z" } else { "" };
                let _ = writeln!(svg, "<path d=\"{}{close}\"{}/>", path(points), stroke(pen));
            }
            Item::Disc { center: [x, y], radius, ink } => {
                let (x, y, radius) = (number(*x), number(*y), number(*radius));
                let _ =
                    writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"{}/>", fill(*ink));
            }
            Item::Text(text) => svg += &line(text),
            Item::Picture { picture, corners, alpha } => svg += &image(picture, corners, *alpha),
        }
    }
    svg + "</svg>\n"
}

/// The outlines of all letters in use, in units of the font.
fn letters(drawing: &Drawing) -> String {
    let mut used = BTreeSet::new();
    for item in &drawing.items {
        if let Item::Text(text) = item {
            let glyphs = text::glyphs(&text.text, text.style);
            used.extend(glyphs.into_iter().map(|glyph| (glyph.weight, glyph.number)));
        }
    }
    let mut defined = String::new();
    for (weight, glyph) in used {
        let outline = text::outline(weight, glyph);
        if !outline.is_empty() {
            let _ = writeln!(defined, "<path id=\"{}\" d=\"{outline}\"/>", name(weight, glyph));
        }
    }
    if defined.is_empty() { defined } else { format!("<defs>\n{defined}</defs>\n") }
}

fn name(weight: Weight, glyph: u16) -> String {
    let weight = match weight {
        Weight::Regular => 'r',
        Weight::SemiBold => 's',
    };
    format!("{weight}{glyph}")
}

fn line(item: &Text) -> String {
    let Text { text: letters, left, baseline, style, halo } = item;
    let scale = f64::from(text::scale(*style));
    let mut used = String::new();
    for glyph in text::glyphs(letters, *style) {
        if text::outline(glyph.weight, glyph.number).is_empty() {
            continue;
        }
        let letter = name(glyph.weight, glyph.number);
        let _ = write!(used, "<use href=\"#{letter}\"{}/>", place_of(glyph));
    }
    let place = format!(
        "transform=\"matrix({scale:.5} 0 0 -{scale:.5} {} {})\"",
        number(*left),
        number(*baseline)
    );
    let mut svg = String::new();
    if let Some(halo) = halo {
        let width = super::pixels::HALO * f64::from(style.size) / scale;
        let _ = writeln!(
            svg,
            "<g {place} fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.0}\" stroke-linejoin=\"round\">{used}</g>",
            hex(*halo)
        );
    }
    let _ = writeln!(
        svg,
        "<g {place} fill=\"{}\" role=\"img\" aria-label=\"{}\">{used}</g>",
        hex(style.color),
        escaped(&plain(letters))
    );
    svg
}

/// Where a glyph stands in its line, as an attribute.
fn place_of(text::Glyph { x, y, size, .. }: text::Glyph) -> String {
    let [x, y] = [x, y].map(|part| number(part.into()));
    match (size, &*x, &*y) {
        (1.0, "0", "0") => String::new(),
        (1.0, _, "0") => format!(" x=\"{x}\""),
        _ => format!(" transform=\"matrix({size} 0 0 {size} {x} {y})\""),
    }
}

fn image(picture: &RgbImage, [corner, right, below]: &super::Corners, alpha: f64) -> String {
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Png).expect("a picture in memory can be written");
    let data = base64::engine::general_purpose::STANDARD.encode(file.get_ref());
    let [width, height] = [picture.width(), picture.height()].map(f64::from);
    let across = [(right[0] - corner[0]) / width, (right[1] - corner[1]) / width];
    let down = [(below[0] - corner[0]) / height, (below[1] - corner[1]) / height];
    // Pixels that are enlarged are squares to look at; those that are reduced are mixed.
    let enlarged = across[0].hypot(across[1]) >= 1.0;
    let style = if enlarged { " style=\"image-rendering:pixelated\"" } else { "" };
    let alpha = if alpha < 1.0 { format!(" opacity=\"{}\"", number(alpha)) } else { String::new() };
    format!(
        "<image transform=\"matrix({:.6} {:.6} {:.6} {:.6} {} {})\" width=\"{width}\" height=\"{height}\" \
         preserveAspectRatio=\"none\"{style}{alpha} href=\"data:image/png;base64,{data}\"/>\n",
        across[0] + 0.0,
        across[1] + 0.0,
        down[0] + 0.0,
        down[1] + 0.0,
        number(corner[0]),
        number(corner[1])
    )
}

fn path(points: &[[f64; 2]]) -> String {
    let mut path = String::new();
    for (k, [x, y]) in points.iter().enumerate() {
        let letter = if k == 0 { "M" } else { "L" };
        let _ = write!(path, "{letter}{} {}", number(*x), number(*y));
    }
    path
}

fn fill(Ink { color, alpha }: Ink) -> String {
    let alpha =
        if alpha < 1.0 { format!(" fill-opacity=\"{}\"", number(alpha)) } else { String::new() };
    format!(" fill=\"{}\"{alpha}", hex(color))
}

fn stroke(Pen { ink: Ink { color, alpha }, width, dash }: &Pen) -> String {
    let mut style = format!(
        " fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"",
        hex(*color),
        number(*width)
    );
    if *alpha < 1.0 {
        let _ = write!(style, " stroke-opacity=\"{}\"", number(*alpha));
    }
    if let Some([dash, gap]) = dash {
        let _ = write!(style, " stroke-dasharray=\"{} {}\"", number(*dash), number(*gap));
    }
    style
}

fn hex([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A number with at most two digits behind the point.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0".into() } else { short.into() }
}

/// A text between tags or in an attribute. Letters that XML forbids are left out.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\t' | '\n' => escaped.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => {}
            letter => escaped.push(letter),
        }
    }
    escaped
}
