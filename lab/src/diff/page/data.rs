//! What the page's script reads: facts as JSON, pictures as PNG, values and groups as arrays.

use super::arrays::{Array, Kind, write_base64};
use super::content::{MOST_VALUES, Page};
use super::escape::{escaped, json};
use super::groups::Group;
use super::shown::{Shown, base, has_alpha, shown};
use crate::diff::aspect::Aspect;
use crate::diff::buffer::{Buffer, bytes};
use crate::diff::classes::pixels;
use crate::formats::source::quote::visible;
use crate::wording::grouped;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ColorType, ImageEncoder, RgbImage};
use serde::Serialize;
use std::borrow::Cow;
use std::io::{self, Write};

/// The facts.
#[derive(Serialize)]
struct Facts<'a> {
    size: [u32; 2],
    origin: [u32; 2],
    sides: [SideFacts; 2],
    groups: Vec<GroupFacts<'a>>,
    why: Option<Cow<'a, str>>,
    /// Why the page has no values.
    omitted: Option<String>,
}

#[derive(Serialize)]
struct SideFacts {
    samples: u32,
    /// Whether the colours have alpha.
    alpha: bool,
    /// The arrays of this side: `ids`, `t`, `normals`, `color` or `covered`, with the type of their elements.
    arrays: Vec<ArrayFacts>,
}

#[derive(Serialize)]
struct ArrayFacts {
    name: &'static str,
    kind: &'static str,
    /// Whether the array is B's, and told by its difference from A's.
    from_a: bool,
}

#[derive(Serialize)]
struct GroupFacts<'a> {
    name: Cow<'a, str>,
    explanation: Option<Cow<'a, str>>,
    color: [u8; 3],
}

/// Writes the pictures as they are seen without a script, and on paper.
pub(super) fn write_pictures(page: &Page, out: &mut impl Write) -> io::Result<()> {
    let shown = shown(page.buffers);
    for ((side, name), Shown { picture, note }) in
        ["A", "B"].into_iter().zip(&page.names).zip(shown)
    {
        let (id, caption) = (side.to_lowercase(), format!("{side}: {}", visible(name)));
        write_picture(&id, &picture, &caption, note.as_deref(), out)?;
    }
    let mut difference = base(page.comparison);
    write_picture("base", &difference, "where both agree", None, out)?;
    // The first of several groups is the one that is seen.
    for group in page.groups.iter().rev() {
        group.pixels.iter().for_each(|&[i, j]| difference[(j, i)].0 = group.color);
    }
    write_picture("difference", &difference, "difference", None, out)
}

fn write_picture(
    id: &str,
    picture: &RgbImage,
    caption: &str,
    note: Option<&str>,
    out: &mut impl Write,
) -> io::Result<()> {
    let caption = escaped(caption);
    write!(out, "<figure><img id=\"picture-{id}\" alt=\"{caption}\" src=\"")?;
    write_data_uri(picture, out)?;
    let note = note.map(|note| format!(" <span class=\"note\">{}</span>", escaped(note)));
    writeln!(out, "\"><figcaption>{caption}{}</figcaption></figure>", note.unwrap_or_default())
}

/// Writes a picture as a PNG in the address itself.
pub(crate) fn write_data_uri(picture: &RgbImage, out: &mut impl Write) -> io::Result<()> {
    out.write_all(b"data:image/png;base64,")?;
    write_base64(&png(picture)?, out)
}

fn png(picture: &RgbImage) -> io::Result<Vec<u8>> {
    let mut png = Vec::new();
    let (width, height) = picture.dimensions();
    PngEncoder::new_with_quality(&mut png, CompressionType::Default, FilterType::Adaptive)
        .write_image(picture, width, height, ColorType::Rgb8.into())
        .map_err(io::Error::other)?;
    Ok(png)
}

/// Writes the facts, the values and the groups.
pub(super) fn write_data(page: &Page, out: &mut impl Write) -> io::Result<()> {
    let [a, b] = match page.has_values() {
        true => page.buffers.map(arrays),
        false => [Vec::new(), Vec::new()],
    };
    let base = |name: &str, array: &Array| {
        a.iter().find(|(of_a, in_a)| *of_a == name && in_a.is_like(array)).map(|(_, in_a)| in_a)
    };
    let array_facts = |side: &[(&'static str, Array)], is_b: bool| {
        side.iter()
            .map(|(name, array)| ArrayFacts {
                name,
                kind: array.kind.name(),
                from_a: is_b && base(name, array).is_some(),
            })
            .collect()
    };
    let [in_a, in_b] = page.buffers;
    let facts = |buffer: &Buffer, arrays| SideFacts {
        samples: buffer.samples(),
        alpha: has_alpha(buffer),
        arrays,
    };
    let facts = Facts {
        size: page.comparison.size,
        origin: in_a.origin(),
        sides: [facts(in_a, array_facts(&a, false)), facts(in_b, array_facts(&b, true))],
        groups: page.groups.iter().map(group_facts).collect(),
        why: page.why.as_deref().map(visible),
        omitted: (!page.has_values()).then(omitted),
    };
    writeln!(out, "<script type=\"application/json\" id=\"facts\">{}</script>", json(&facts))?;
    for (name, array) in &a {
        write_array(&format!("a-{name}"), array, None, out)?;
    }
    for (name, array) in &b {
        write_array(&format!("b-{name}"), array, base(name, array), out)?;
    }
    for (number, group) in page.groups.iter().enumerate() {
        write_array(&format!("group-{number}"), &places(group, page.comparison.size), None, out)?;
    }
    Ok(())
}

fn omitted() -> String {
    format!(
        "The values are left out: beyond {} samples, a page has the pictures alone.",
        grouped(MOST_VALUES)
    )
}

fn group_facts(group: &Group) -> GroupFacts<'_> {
    let explanation = group.explanation.as_deref().map(visible);
    GroupFacts { name: visible(&group.name), explanation, color: group.color }
}

fn write_array(
    id: &str,
    array: &Array,
    base: Option<&Array>,
    out: &mut impl Write,
) -> io::Result<()> {
    write!(out, "<script type=\"text/plain\" id=\"{id}\">")?;
    array.write(base, out)?;
    writeln!(out, "</script>")
}

/// The numbers of the pixels of a group, row by row, in rising order.
fn places(group: &Group, [width, height]: [u32; 2]) -> Array {
    let number = |&[i, j]: &[u32; 2]| {
        assert!(i < height && j < width, "a group names ({i}, {j}), which does not exist");
        i * width + j
    };
    let mut numbers: Vec<u32> = group.pixels.iter().map(number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    Array::new(Kind::U32, numbers.into_iter().map(u32::to_le_bytes))
}

/// All values of a buffer: an array for each aspect, pixel by pixel and sample by sample.
fn arrays(buffer: &Buffer) -> Vec<(&'static str, Array)> {
    let mut arrays = Vec::new();
    if buffer.tells(Aspect::Ids) {
        arrays.push(("ids", ids(buffer)));
    }
    if buffer.tells(Aspect::T) {
        arrays.push(("t", distances(buffer)));
    }
    if buffer.tells(Aspect::Normals) {
        let normals = buffer.all_samples().map(|sample| stored::<3, 12>(buffer.normal(sample)));
        arrays.push(("normals", Array::new(Kind::F32x3, normals)));
    }
    if buffer.tells(Aspect::Color) {
        arrays.push(("color", colors(buffer)));
    }
    // Ids and distances tell by themselves what is covered.
    let is_told = buffer.tells(Aspect::Ids) || buffer.tells(Aspect::T);
    if buffer.has_coverage() && !is_told {
        let covered = buffer.all_samples().map(|sample| buffer.covered(sample) == Some(true));
        arrays.push(("covered", Array::new(Kind::U8, covered.map(|covered| [u8::from(covered)]))));
    }
    arrays
}

/// The ids, all ones for nothing, in as few bytes as they need.
fn ids(buffer: &Buffer) -> Array {
    let ids = || buffer.all_samples().map(|sample| buffer.id(sample));
    if ids().flatten().all(|id| id < u64::from(u32::MAX)) {
        let short = |id| u32::try_from(id).expect("all ids are small");
        let short = ids().map(|id| id.map_or(u32::MAX, short).to_le_bytes());
        return Array::new(Kind::U32, short);
    }
    Array::new(Kind::U64, ids().map(|id| id.unwrap_or(u64::MAX).to_le_bytes()))
}

/// The distances, infinity for nothing, as `f32` if that changes none of them.
fn distances(buffer: &Buffer) -> Array {
    let all = || {
        let t = buffer.all_samples().map(|sample| buffer.t(sample));
        t.map(|t| if t.is_finite() { t } else { f64::INFINITY })
    };
    #[expect(clippy::cast_possible_truncation, reason = "only used if it changes nothing")]
    let single = |t: f64| t as f32;
    if all().all(|t| f64::from(single(t)) == t) {
        return Array::new(Kind::F32, all().map(|t| single(t).to_le_bytes()));
    }
    Array::new(Kind::F64, all().map(f64::to_le_bytes))
}

/// The colours, black without alpha where there is none, as bytes if that changes none of them.
fn colors(buffer: &Buffer) -> Array {
    let all = || {
        let colors = pixels(buffer.size()).map(|pixel| buffer.color(pixel));
        colors.map(|color| color.map_or([0.0; 4], |(color, _)| color))
    };
    if all().all(|color| bytes(color).map(f32::from) == color) {
        return Array::new(Kind::U8x4, all().map(bytes));
    }
    Array::new(Kind::F32x4, all().map(stored::<4, 16>))
}

/// The bytes of some numbers.
fn stored<const N: usize, const BYTES: usize>(numbers: [f32; N]) -> [u8; BYTES] {
    let mut stored = [0; BYTES];
    for (four, number) in stored.chunks_exact_mut(4).zip(numbers) {
        four.copy_from_slice(&number.to_le_bytes());
    }
    stored
}
