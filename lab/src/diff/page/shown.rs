//! The pictures of a page: colours as they are, ids as colours, distances as greys, masks as white on dark.

use crate::common::glam::Vec3;
use crate::common::look::color::{linear_from_srgb, srgb_from_linear};
use crate::diff::aspect::Aspect;
use crate::diff::buffer::{Buffer, Content, Covered, bytes, distance_text};
use crate::diff::classes::{Class, pixels};
use crate::diff::compare::BufferComparison;
use crate::picture::{NOTHING, color_of_id};
use image::{Rgb, RgbImage};

/// The greys of the nearest and of the farthest distance.
const NEAR: f64 = 245.0;
const FAR: f64 = 60.0;
/// The most distances that decide about the range.
const MOST_DISTANCES: usize = 1 << 16;

/// A buffer as a picture.
pub(crate) struct Shown {
    pub(crate) picture: RgbImage,
    /// How to read the picture, if its colours are not those of the file.
    pub(super) note: Option<String>,
}

/// The pictures of A and B. Equal values have equal colours in both.
pub(crate) fn shown(buffers: [&Buffer; 2]) -> [Shown; 2] {
    let range = Range::of(buffers);
    buffers.map(|buffer| {
        let average = match buffer.samples() {
            1 => "",
            _ => "; a pixel is the average of its samples",
        };
        let note = |text: &str| Some(format!("{text}{average}"));
        if buffer.tells(Aspect::Color) {
            let note =
                (buffer.samples() > 1).then(|| "a pixel is the average of its samples".into());
            Shown { picture: colors(buffer), note }
        } else if buffer.tells(Aspect::Ids) {
            let picture = averaged(buffer, |sample| color_of_id(buffer.id(sample)));
            Shown { picture, note: note("each id has a colour; near black is nothing") }
        } else if buffer.tells(Aspect::T) {
            let picture = averaged(buffer, |sample| range.grey(buffer.t(sample)));
            Shown { picture, note: note(&range.note()) }
        } else if buffer.tells(Aspect::Normals) {
            let color = |sample| match buffer.covered(sample) {
                Some(true) => buffer.normal(sample).map(direction),
                _ => NOTHING,
            };
            let note =
                note("red, green and blue are x, y and z from -1 to 1; near black is nothing");
            Shown { picture: averaged(buffer, color), note }
        } else {
            let white = |sample| match buffer.covered(sample) {
                Some(true) => [u8::MAX; 3],
                _ => NOTHING,
            };
            Shown { picture: averaged(buffer, white), note: note("white is covered") }
        }
    })
}

/// The difference image without the classes: what lies beneath the colours of the groups.
pub(super) fn base(comparison: &BufferComparison) -> RgbImage {
    let mut base = comparison.picture();
    for ([i, j], _) in comparison.classes().differing() {
        base[(j, i)] = Rgb(Class::Alike.color());
    }
    base
}

/// Whether the colours of a buffer have alpha.
pub(super) fn has_alpha(buffer: &Buffer) -> bool {
    matches!(buffer.content(), Content::Picture(picture) if picture.covered == Covered::ByAlpha)
}

/// The colours of a picture; what is transparent lets the colour of nothing through.
fn colors(buffer: &Buffer) -> RgbImage {
    let [width, height] = buffer.size();
    let mut picture = buffer.light().unwrap_or_else(|| RgbImage::new(width, height));
    for (shown, pixel) in picture.pixels_mut().zip(pixels(buffer.size())) {
        match buffer.color(pixel) {
            Some(([red, green, blue, alpha], true)) if alpha < 255.0 => {
                let part = alpha / 255.0;
                let over =
                    |color: f32, nothing: u8| part * color + (1.0 - part) * f32::from(nothing);
                let [a, b, c] = NOTHING;
                *shown = Rgb(bytes([over(red, a), over(green, b), over(blue, c)]));
            }
            None if has_alpha(buffer) => *shown = Rgb(NOTHING),
            _ => {}
        }
    }
    picture
}

/// Pixels of the average colour of their samples, in linear light.
fn averaged(buffer: &Buffer, color: impl Fn(usize) -> [u8; 3]) -> RgbImage {
    let [width, height] = buffer.size();
    let mut picture = RgbImage::new(width, height);
    for (shown, pixel) in picture.pixels_mut().zip(pixels(buffer.size())) {
        let mut samples = buffer.samples_of(pixel);
        if buffer.samples() == 1 {
            *shown = Rgb(samples.next().map_or(NOTHING, &color));
            continue;
        }
        let mut light = Vec3::ZERO;
        let mut count = 0.0;
        for sample in samples {
            light += Vec3::from_array(color(sample).map(linear_from_srgb));
            count += 1.0;
        }
        *shown = Rgb((light / count).to_array().map(srgb_from_linear));
    }
    picture
}

/// A component of a normal as a part of a colour.
fn direction(component: f32) -> u8 {
    let [byte] = bytes([127.5 + 127.5 * component]);
    byte
}

/// The distances between white and dark.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range {
    near: f64,
    far: f64,
    /// Whether some distances lie outside.
    cut: bool,
}

impl Range {
    /// The range of both buffers, without a few distances that lie far away from all others: with them, all others
    /// would have the same grey.
    fn of(buffers: [&Buffer; 2]) -> Range {
        let finite = |buffer: &&Buffer| {
            let all = buffer.tells(Aspect::T).then(|| buffer.all_samples());
            let t = all.into_iter().flatten().map(|sample| buffer.t(sample));
            t.filter(|t| t.is_finite()).collect::<Vec<f64>>()
        };
        let all: Vec<f64> = buffers.iter().flat_map(finite).collect();
        let step = all.len().div_ceil(MOST_DISTANCES).max(1);
        let mut some: Vec<f64> = all.iter().copied().step_by(step).collect();
        some.sort_by(f64::total_cmp);
        let at = |part: usize| some.get((some.len().max(1) - 1) * part / 200).copied();
        let (Some(low), Some(high)) = (at(1), at(199)) else {
            return Range { near: 0.0, far: 1.0, cut: false };
        };
        let (least, most) =
            all.iter().fold((low, high), |(least, most), &t| (least.min(t), most.max(t)));
        let span = high - low;
        let (near, near_cut) = if least < low - span { (low, true) } else { (least, false) };
        let (far, far_cut) = if most > high + span { (high, true) } else { (most, false) };
        Range { near, far, cut: near_cut || far_cut }
    }

    fn grey(self, t: f64) -> [u8; 3] {
        if !t.is_finite() {
            return NOTHING;
        }
        // Halves first: the difference of two large numbers may be infinite.
        let span = self.far / 2.0 - self.near / 2.0;
        let part = if span > 0.0 { (t / 2.0 - self.near / 2.0) / span } else { 0.0 };
        #[expect(clippy::cast_possible_truncation, reason = "a grey needs no more")]
        let grey = (NEAR + (FAR - NEAR) * part.clamp(0.0, 1.0)) as f32;
        bytes([grey; 3])
    }

    fn note(self) -> String {
        let [near, far] = [self.near, self.far].map(rounded);
        let cut = if self.cut { "; some t lie outside" } else { "" };
        format!("bright is near: t from {near} to {far}{cut}; near black is nothing")
    }
}

/// A distance with four digits.
fn rounded(t: f64) -> String {
    let short: f64 = format!("{t:.3e}").parse().unwrap_or(t);
    if short != 0.0 && !(1e-4..1e7).contains(&short.abs()) {
        return format!("{short:e}");
    }
    distance_text(short)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::buffer::{Picture, Pixels};

    fn row(content: Content<'_>, width: u32) -> Buffer<'_> {
        Buffer::new([width, 1], 1, content)
    }

    fn greys(picture: &RgbImage) -> Vec<u8> {
        picture.pixels().map(|pixel| pixel.0[0]).collect()
    }

    #[test]
    fn equal_distances_have_equal_greys_and_near_is_bright() {
        let a = row(Content::Distances(vec![1.0, 2.0, f64::INFINITY]), 3);
        let b = row(Content::Distances(vec![3.0, 2.0, f64::NAN]), 3);
        let [a, b] = shown([&a, &b]);
        assert_eq!(greys(&a.picture), [245, 153, NOTHING[0]]);
        assert_eq!(greys(&b.picture), [60, 153, NOTHING[0]]);
        let note = "bright is near: t from 1 to 3; near black is nothing";
        assert_eq!(a.note.as_deref(), Some(note));
    }

    #[test]
    fn a_huge_distance_for_nothing_does_not_hide_the_others() {
        let mut t: Vec<f64> = (0..1000).map(|step| 2.0 + f64::from(step) / 1000.0).collect();
        t[7] = 1e30;
        let buffer = row(Content::Distances(t), 1000);
        let [shown, _] = shown([&buffer, &buffer]);
        let greys = greys(&shown.picture);
        assert!(greys[0] > 240 && greys[999] < 65 && greys[7] == 60, "{greys:?}");
        assert!(shown.note.unwrap().contains("some t lie outside"));
    }

    #[test]
    fn distances_at_the_ends_of_the_numbers_have_greys() {
        let ends = row(Content::Distances(vec![f64::MAX, -f64::MAX, 0.0]), 3);
        let same = row(Content::Distances(vec![4.0, 4.0, 4.0]), 3);
        assert_eq!(greys(&shown([&ends, &ends])[0].picture), [60, 245, 153]);
        assert_eq!(greys(&shown([&same, &same])[0].picture), [245, 245, 245]);
    }

    #[test]
    fn masks_are_white_on_dark_and_samples_are_averaged() {
        let mask = Buffer::new([2, 1], 2, Content::Mask([[true; 4], [false; 4]].concat().into()));
        let half = vec![Some(3), Some(3), None, None, Some(3), Some(3), Some(3), Some(3)];
        let ids = Buffer::new([2, 1], 2, Content::Ids(half));
        let [mask, ids] = shown([&mask, &ids]);
        assert_eq!(greys(&mask.picture), [255, NOTHING[0]]);
        let [mixed, full] = [0, 1].map(|j| ids.picture[(j, 0)].0);
        assert_eq!(full, color_of_id(Some(3)));
        assert!(mixed.iter().zip(full).all(|(mixed, full)| *mixed < full));
        assert!(ids.note.unwrap().contains("average of its samples"));
    }

    #[test]
    fn what_is_transparent_is_dark() {
        let pixels = Pixels::Bytes(vec![[200, 100, 0, 255], [255, 255, 255, 0], [255, 0, 0, 51]]);
        let picture = Picture { pixels, covered: Covered::ByAlpha };
        let buffer = row(Content::Picture(picture), 3);
        let [shown, _] = shown([&buffer, &buffer]);
        let colors: Vec<[u8; 3]> = shown.picture.pixels().map(|pixel| pixel.0).collect();
        assert_eq!(colors, [[200, 100, 0], NOTHING, [57, 8, 10]]);
    }
}
