//! Pictures of any origin: PNG and what else the `image` crate reads.

use super::read::Problem;
use super::{Buffer, Content, Covered, Picture};
use crate::common::camera::{MAX_SAMPLES, check_samples};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::Cursor;

/// Reads a picture of a format that is known.
pub(super) fn read(
    bytes: &[u8],
    format: ImageFormat,
    background: Option<[u8; 3]>,
) -> Result<Buffer, Problem> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::no_limits();
    // The largest picture, four channels of 16 bits; a small file may claim any size.
    limits.max_alloc = Some(MAX_SAMPLES * 8);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(Problem::Picture)?;
    let (width, height) = decoder.dimensions();
    check_samples([width, height], 1)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(Problem::Picture)?;
    Ok(Buffer::new([width, height], 1, content(picture, background)))
}

fn content(picture: DynamicImage, background: Option<[u8; 3]>) -> Content {
    let colour = picture.color();
    let covered = match (colour.has_alpha(), colour.has_color()) {
        (true, _) => Covered::ByAlpha,
        (false, false) => Covered::ByLight,
        (false, true) => background.map_or(Covered::Unknown, Covered::ByBackground),
    };
    // Sixteen bits hold eight exactly: 65,535 / 255 = 257.
    let pixels: Vec<[f32; 4]> = picture
        .into_rgba16()
        .pixels()
        .map(|pixel| pixel.0.map(|value| f32::from(value) / 257.0))
        .collect();
    if covered == Covered::ByLight && has_two_values(&pixels) {
        return Content::Mask(pixels.iter().map(|pixel| pixel[0] != 0.0).collect());
    }
    Content::Picture(Picture { pixels, covered })
}

/// Whether a grey picture is black and one other value at most: a mask, be its white 1 or 255.
fn has_two_values(pixels: &[[f32; 4]]) -> bool {
    let mut lit = pixels.iter().map(|pixel| pixel[0]).filter(|&light| light != 0.0);
    let first = lit.next();
    lit.all(|light| Some(light) == first)
}
