//! The comparison of two frames of one view: whether both orders see the same primitives.

use super::buffer::{Buffer, bytes};
use super::buffer_pair::{BufferPair, Decides};
use super::classes::Classes;
use super::compare::{self, BufferComparison};
use crate::common::Frame;
use crate::picture::picture;
use crate::wording::{count, grouped};
use image::RgbImage;
use serde::Serialize;

/// The result of comparing two frames of one view.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The comparison of covered samples.
    pub coverage: Coverage,
    /// The comparison of visible primitives.
    pub visible: Visible,
    /// The comparison of depths.
    pub depth: Depth,
    /// The comparison of colours.
    #[serde(rename = "colour")]
    pub color: Color,
    /// The complete comparison, in the form for any two buffers.
    #[serde(skip)]
    details: BufferComparison,
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

/// The pixels in which the orders see different primitives.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Visible {
    /// The number of pixels in which the ids differ at any sample, coverage included.
    pub differing_pixels: u64,
    /// The first differing pixels, at most 10, as `[i, j]` of the whole image, row by row.
    pub first_differing: Vec<[u32; 2]>,
}

/// Depth where both orders see the same primitive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Depth {
    /// The largest relative difference of a sample, as a part of the larger depth.
    pub max_relative_difference: f64,
    /// The number of pixels with a sample beyond [`DEPTH_TOLERANCE`](super::DEPTH_TOLERANCE).
    pub differing_pixels: u64,
}

/// The colours of the pixels; each colour is the average of the pixel's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Color {
    /// The largest difference in red, green or blue, in steps of 8-bit sRGB.
    pub max_difference: u8,
    /// The number of pixels beyond [`COLOR_TOLERANCE`](super::COLOR_TOLERANCE).
    pub differing_pixels: u64,
}

/// Compares the frames of both orders for one view.
///
/// # Panics
///
/// If the frames differ in size, crop or samples.
pub fn compare(object_order: &Frame, image_order: &Frame) -> Comparison {
    let pictures = [object_order, image_order].map(picture);
    compare_shown([object_order, image_order], pictures.each_ref())
}

/// Compares the frames of both orders for one view, with pictures that are already drawn.
///
/// # Panics
///
/// If the frames differ in size, crop or samples, or a picture and its frame have different sizes.
pub fn compare_shown(
    frames @ [object_order, image_order]: [&Frame; 2],
    [by_object, by_image]: [&RgbImage; 2],
) -> Comparison {
    let raster = |frame: &Frame| (frame.camera_image(), frame.crop(), frame.samples());
    let [a, b] = frames.map(raster);
    assert_eq!(a, b, "the frames show different views");
    let object_order = Buffer::of_frame(object_order, by_object);
    let image_order = Buffer::of_frame(image_order, by_image);
    let pair = BufferPair::new(&object_order, &image_order, Decides::Visibility);
    Comparison::new(compare::compare(&pair).expect("frames of one view can be compared"))
}

/// The verdict on frames that see the same everywhere, and cover so many samples.
pub fn verdict_of_equal(covered: u64) -> String {
    match covered {
        0 => "match: neither order covers any sample".into(),
        1 => "match: both orders cover the same sample and see the same primitive in it".into(),
        covered => format!(
            "match: both orders cover the same {} samples and see the same primitive in each",
            grouped(covered)
        ),
    }
}

impl Comparison {
    fn new(details: BufferComparison) -> Comparison {
        const ALL: &str = "frames tell everything";
        let (coverage, depth) = (details.coverage.expect(ALL), details.depth.expect(ALL));
        let color = details.color.expect(ALL);
        Comparison {
            coverage: Coverage {
                object_order: coverage.a,
                image_order: coverage.b,
                both: coverage.both,
                only_object_order: coverage.only_a,
                only_image_order: coverage.only_b,
                matches: coverage.matches,
            },
            visible: Visible {
                differing_pixels: details.differing_pixels,
                first_differing: details.first_differing.clone(),
            },
            depth: Depth {
                max_relative_difference: depth.max_relative_difference,
                differing_pixels: depth.differing_pixels,
            },
            color: Color {
                max_difference: bytes([color.max_difference])[0],
                differing_pixels: color.differing_pixels,
            },
            details,
        }
    }

    /// The verdict: whether both orders cover the same samples and see the same primitive in each.
    pub fn matches(&self) -> bool {
        self.coverage.matches && self.visible.differing_pixels == 0
    }

    /// The verdict in one line.
    pub fn verdict(&self) -> String {
        if self.matches() {
            return verdict_of_equal(self.coverage.both);
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

    /// The class of each pixel; in a crop, pixels are counted from the corner of the crop.
    pub fn classes(&self) -> &Classes {
        self.details.classes()
    }

    /// The comparison in the form for any two buffers, with object order as A.
    pub fn details(&self) -> &BufferComparison {
        &self.details
    }
}
