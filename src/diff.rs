//! The verdict: do both orders see the same?
//!
//! Coverage and primitive ids have no tolerance, and they alone decide. Depth and colour, which
//! each order rounds in its own way, are measured and reported.
//!
//! [`foreign`] does the same for files of any origin, and [`pairs`] finds those of two folders that
//! belong together.

mod classes;
pub mod foreign;
pub mod pairs;

pub use classes::{Class, Classes};

use crate::common::Frame;
use crate::common::frame::NO_PRIMITIVE;
use crate::picture::picture;
use crate::wording::{count, grouped};
use image::RgbImage;
use serde::Serialize;

/// Two depths of one primitive differ beyond this part of the larger.
pub const DEPTH_TOLERANCE: f64 = 1e-5;
/// Two colours differ beyond this many of the 255 steps of sRGB.
pub const COLOR_TOLERANCE: u8 = 2;
/// How many differing pixels a comparison names.
const NAMED_PIXELS: usize = 10;

/// Everything that is said about two frames of one view.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Which samples are covered.
    pub coverage: Coverage,
    /// Which primitive is seen.
    pub visible: Visible,
    /// How far it is.
    pub depth: Depth,
    /// What it looks like.
    #[serde(rename = "colour")]
    pub color: Color,
}

/// Coverage, counted in samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Coverage {
    /// Covered in object order.
    pub object_order: u64,
    /// Covered in image order.
    pub image_order: u64,
    /// Covered in both.
    pub both: u64,
    /// Covered in object order alone.
    pub only_object_order: u64,
    /// Covered in image order alone.
    pub only_image_order: u64,
    /// Whether both orders cover the same samples.
    #[serde(rename = "match")]
    pub matches: bool,
}

/// Pixels in which the orders do not see the same primitives.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Visible {
    /// Pixels in which the ids differ at any sample, coverage included.
    pub differing_pixels: u64,
    /// The first of them, at most 10, as `[i, j]` of the whole image, row by row.
    pub first_differing: Vec<[u32; 2]>,
}

/// Depth where both orders see the same primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Depth {
    /// The largest difference of a sample, as a part of the larger depth.
    pub max_relative_difference: f64,
    /// Pixels with a sample beyond [`DEPTH_TOLERANCE`].
    pub differing_pixels: u64,
}

/// Colour of the pixels, each the average of its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Color {
    /// The largest difference in red, green or blue, in steps of 8-bit sRGB.
    pub max_difference: u8,
    /// Pixels beyond [`COLOR_TOLERANCE`].
    pub differing_pixels: u64,
}

/// Compares what both orders saw of one view.
///
/// # Panics
///
/// If the frames differ in size, crop or samples.
pub fn compare(object_order: &Frame, image_order: &Frame) -> Comparison {
    assert_same_raster(object_order, image_order);
    Comparison {
        coverage: coverage(object_order, image_order),
        visible: visible(object_order, image_order),
        depth: depth(object_order, image_order),
        color: color(&picture(object_order), &picture(image_order)),
    }
}

impl Comparison {
    /// The verdict: whether both orders cover the same samples and see the same primitive in each.
    pub fn matches(&self) -> bool {
        self.coverage.matches && self.visible.differing_pixels == 0
    }

    /// The verdict in one line.
    pub fn verdict(&self) -> String {
        if self.matches() {
            return match self.coverage.both {
                0 => "match: neither order covers any sample".into(),
                1 => "match: both orders cover the same sample and see the same primitive in it"
                    .into(),
                covered => format!(
                    "match: both orders cover the same {} samples and see the same primitive in each",
                    grouped(covered)
                ),
            };
        }
        let pixels = count(self.visible.differing_pixels, "pixels");
        let alone = self.coverage.only_object_order + self.coverage.only_image_order;
        let alone = match alone {
            0 => "both cover the same samples".into(),
            1 => "1 sample is covered by one of them only".into(),
            _ => format!("{} samples are covered by one of them only", grouped(alone)),
        };
        let first = self.visible.first_differing.first();
        let first = first.map(|[i, j]| format!(", first at ({i}, {j})")).unwrap_or_default();
        format!("differ: the orders see different primitives in {pixels}{first}; {alone}")
    }
}

fn assert_same_raster(object_order: &Frame, image_order: &Frame) {
    let raster = |frame: &Frame| (frame.camera_image(), frame.crop(), frame.samples());
    assert_eq!(raster(object_order), raster(image_order), "the frames show different views");
}

fn coverage(object_order: &Frame, image_order: &Frame) -> Coverage {
    let mut coverage = Coverage::default();
    for (&by_object, &by_image) in object_order.ids().iter().zip(image_order.ids()) {
        match (by_object != NO_PRIMITIVE, by_image != NO_PRIMITIVE) {
            (true, true) => coverage.both += 1,
            (true, false) => coverage.only_object_order += 1,
            (false, true) => coverage.only_image_order += 1,
            (false, false) => {}
        }
    }
    coverage.object_order = coverage.both + coverage.only_object_order;
    coverage.image_order = coverage.both + coverage.only_image_order;
    coverage.matches = coverage.only_object_order + coverage.only_image_order == 0;
    coverage
}

fn visible(object_order: &Frame, image_order: &Frame) -> Visible {
    let mut visible = Visible::default();
    for [i, j] in object_order.pixels() {
        let mut samples = object_order.samples_of(i as usize, j as usize);
        if samples.any(|sample| object_order.ids()[sample] != image_order.ids()[sample]) {
            visible.differing_pixels += 1;
            if visible.first_differing.len() < NAMED_PIXELS {
                visible.first_differing.push([i, j]);
            }
        }
    }
    visible
}

fn depth(object_order: &Frame, image_order: &Frame) -> Depth {
    let relative_difference = |sample: usize| {
        let id = object_order.ids()[sample];
        if id == NO_PRIMITIVE || id != image_order.ids()[sample] {
            return 0.0;
        }
        let by_object = f64::from(object_order.distances()[sample]);
        let by_image = f64::from(image_order.distances()[sample]);
        (by_object - by_image).abs() / by_object.max(by_image)
    };
    let mut depth = Depth::default();
    for [i, j] in object_order.pixels() {
        let samples = object_order.samples_of(i as usize, j as usize);
        let worst = samples.map(relative_difference).fold(0.0, f64::max);
        depth.max_relative_difference = depth.max_relative_difference.max(worst);
        depth.differing_pixels += u64::from(worst > DEPTH_TOLERANCE);
    }
    depth
}

fn color(object_order: &RgbImage, image_order: &RgbImage) -> Color {
    let mut color = Color::default();
    for (by_object, by_image) in object_order.pixels().zip(image_order.pixels()) {
        let channels = by_object.0.iter().zip(&by_image.0);
        let worst = channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0);
        color.max_difference = color.max_difference.max(worst);
        color.differing_pixels += u64::from(worst > COLOR_TOLERANCE);
    }
    color
}

/// All pixels `[i, j]` of an image, row by row.
fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |i| (0..width).map(move |j| [i, j]))
}

#[cfg(test)]
mod tests;
