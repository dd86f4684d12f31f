//! The summary at the top of a page: verdict, files, counts, and what may be the cause.

use super::content::Page;
use super::escape::escaped;
use crate::diff::aspect::{Aspect, Unit};
use crate::diff::buffer::Buffer;
use crate::diff::compare::BufferComparison;
use crate::diff::tolerance::Tolerances;
use crate::formats::source::quote::visible;
use crate::wording::{count, grouped};
use std::io::{self, Write};

/// Whether A and B differ, in one sentence.
pub(super) fn verdict(comparison: &BufferComparison) -> String {
    let Some([row, column, height, width]) = comparison.region else {
        return "equal in everything compared".into();
    };
    let pixels = count(comparison.differing_pixels, "pixels");
    let all = grouped(comparison.size.map(u64::from).iter().product());
    let (bottom, right) = (row + height - 1, column + width - 1);
    let place = match comparison.differing_pixels {
        1 => format!("at ({row}, {column})"),
        _ => format!("from ({row}, {column}) to ({bottom}, {right})"),
    };
    let verdict = if comparison.passes { "equal enough: they differ in" } else { "differ:" };
    format!("{verdict} {pixels} of {all}, {place}")
}

/// The counts of a comparison.
pub(super) fn figures(
    comparison: &BufferComparison,
    buffers: [&Buffer; 2],
) -> Vec<(String, String)> {
    let mut figures: Vec<(String, String)> = Vec::new();
    let mut add = |label: String, number| figures.push((label, grouped(number)));
    if let Some(coverage) = comparison.coverage {
        let one_sample = buffers.iter().all(|buffer| buffer.samples() == 1);
        let things = match coverage.unit {
            Unit::Samples if !one_sample => "samples",
            Unit::Samples | Unit::Pixels => "pixels",
        };
        add(format!("{things} covered in A"), coverage.a);
        add(format!("{things} covered in B"), coverage.b);
        add("in both".into(), coverage.both);
        add("only in A".into(), coverage.only_a);
        add("only in B".into(), coverage.only_b);
    }
    if let Some(ids) = comparison.ids {
        add("in both, other ids".into(), ids.differing_samples);
    }
    let tolerances = comparison.tolerances;
    if let Some(depth) = comparison.depth {
        add(format!("pixels with t beyond {:e}", tolerances.t), depth.differing_pixels);
    }
    if let Some(normals) = comparison.normals {
        let label = format!("pixels with normals beyond {}°", tolerances.normals);
        add(label, normals.differing_pixels);
    }
    if let Some(color) = comparison.color {
        let label = format!("pixels beyond {}/255 in colour", tolerances.color);
        add(label, color.differing_pixels);
    }
    if comparison.ignored_pixels > 0 {
        add("pixels ignored".into(), comparison.ignored_pixels);
    }
    figures.extend(measures(comparison));
    figures
}

/// How far A and B are apart as a whole.
fn measures(comparison: &BufferComparison) -> Vec<(String, String)> {
    let mut measures = Vec::new();
    let mut add = |label: &str, value| measures.push((label.to_owned(), value));
    if let Some(coverage) = comparison.measures.coverage {
        if let Some(part) = coverage.intersection_over_union {
            add("intersection over union", rounded_down(part));
        }
        if let Some(farthest) = coverage.largest_border_distance {
            let ([i, j], pixels) = (farthest.at, farthest.pixels);
            add("farthest from the other mask", format!("{pixels:.1} pixels, at ({i}, {j})"));
        }
    }
    if let Some(color) = comparison.measures.color {
        if let Some(psnr) = color.psnr {
            add("PSNR", format!("{psnr:.2} dB"));
        }
        if let Some(ssim) = color.ssim {
            add("SSIM", rounded_down(ssim));
        }
    }
    measures
}

/// A part of 1 with four decimals; nothing but 1 itself is shown as 1.
fn rounded_down(part: f64) -> String {
    let digits = (part * 1e4).floor() / 1e4;
    if digits == 1.0 { "1".into() } else { format!("{digits:.4}") }
}

/// Writes the summary as HTML.
pub(super) fn write(page: &Page, out: &mut impl Write) -> io::Result<()> {
    let state = if page.good { "good" } else { "bad" };
    let verdict = escaped(&visible(&page.verdict)).into_owned();
    writeln!(out, "<h1 class=\"{state}\">{verdict}</h1>")?;
    writeln!(out, "<ul class=\"files\">")?;
    for ((side, name), buffer) in ["A", "B"].into_iter().zip(&page.names).zip(page.buffers) {
        let name = visible(name);
        let samples = match buffer.samples() {
            1 => String::new(),
            n => format!(", {n} × {n} samples a pixel"),
        };
        let (name, kind) = (escaped(&name), buffer.kind());
        writeln!(out, "<li><b class=\"side\">{side}</b> <span class=\"file\">{name}</span> ")?;
        writeln!(out, "<span class=\"kind\">{kind}{samples}</span></li>")?;
    }
    writeln!(out, "</ul>\n<p>{}</p>", escaped(&compared(page.comparison)))?;
    write_figures(page, out)?;
    if !page.findings.is_empty() {
        let findings = page.findings.iter().map(|text| visible(text));
        let items: String = findings.map(|text| format!("<li>{}</li>", escaped(&text))).collect();
        writeln!(out, "<ul class=\"findings\" aria-label=\"Possible causes\">{items}</ul>")?;
    }
    Ok(())
}

fn write_figures(page: &Page, out: &mut impl Write) -> io::Result<()> {
    if page.figures.is_empty() {
        return Ok(());
    }
    writeln!(out, "<dl class=\"figures\">")?;
    for (label, value) in &page.figures {
        let [label, value] = [label, value].map(|text| visible(text));
        let (label, value) = (escaped(&label), escaped(&value));
        writeln!(out, "<div><dt>{label}</dt><dd>{value}</dd></div>")?;
    }
    writeln!(out, "</dl>")
}

/// The size, and what was compared and what was not.
fn compared(comparison: &BufferComparison) -> String {
    let [width, height] = comparison.size;
    let names = comparison.compared.iter().map(|aspect| name(*aspect, &comparison.tolerances));
    let names: Vec<String> = names.collect();
    let mut text = format!("{width} × {height} pixels; compared: {}", names.join(", "));
    for what in &comparison.not_compared {
        text += &format!("; not compared: {what}");
    }
    text
}

/// An aspect with its tolerance.
fn name(aspect: Aspect, tolerances: &Tolerances) -> String {
    match aspect {
        Aspect::Coverage | Aspect::Ids => aspect.name().to_owned(),
        Aspect::T => format!("t (within {:e})", tolerances.t),
        Aspect::Normals => format!("normals (within {}°)", tolerances.normals),
        Aspect::Color => format!("colour (within {}/255)", tolerances.color),
    }
}
