//! Pictures of any origin: PNG and the other formats that the `image` crate reads.

use super::read_buffer::{ReadBuffer, ReadOptions};
use crate::common::raster::check_samples;
use crate::diff::buffer::{Buffer, Content, Covered, Picture, Pixels};
use crate::formats::picture::{self, Problem};
use image::{ColorType, DynamicImage, GrayImage, ImageFormat, Rgb};
use std::io::{BufRead, Seek};

/// The most memory that reading a picture may take. A grey picture of 2³⁰ pixels fits, and a picture of 2²⁸ pixels
/// with four channels of 8 bits.
pub(super) const MOST_MEMORY: u64 = 2 << 30;
/// What a JPEG does to a mask.
const JPEG: &str = "JPEG changes pixels, most of all at edges, so that what is covered (not black, or not the \
     background) is not trustworthy; save the picture as PNG";

/// Reads a picture of a known format.
pub(super) fn read(
    input: impl BufRead + Seek,
    length: u64,
    format: ImageFormat,
    options: &ReadOptions,
) -> Result<ReadBuffer, Problem> {
    if options.normals {
        return Err(Problem::Content(
            "normals are read from floats; save them as NPY (H x W x 3) or EXR, or leave --normals out"
                .into(),
        ));
    }
    let opened = picture::open(input, length, format, MOST_MEMORY)?;
    let (size, color, has_palette) = (opened.size(), opened.color_type(), opened.has_palette());
    check_samples(size, 1)?;
    // A grey picture may become a mask.
    let mut kept = if color == ColorType::L8 || color == ColorType::L16 { 1 } else { kept(color) };
    let mut warnings = Vec::new();
    if format == ImageFormat::Jpeg {
        warnings.push(JPEG.into());
        // A progressive JPEG is in memory as coefficients of two bytes, too.
        kept += 2 * color.channel_count();
    }
    check_memory(size, color, kept)?;
    let picture = opened.decode()?;
    let picture = if has_palette { without_palette(picture) } else { picture };
    let content = content(picture, options.background)?;
    Ok(ReadBuffer { warnings, ..Buffer::new(size, 1, content).into() })
}

/// A picture whose palette has grey colours alone is grey: programs save masks like that, to need only one bit.
fn without_palette(picture: DynamicImage) -> DynamicImage {
    match picture {
        DynamicImage::ImageRgb8(colors)
            if colors.pixels().all(|Rgb([red, green, blue])| red == green && green == blue) =>
        {
            let greys = colors.pixels().map(|pixel| pixel.0[0]).collect();
            let grey = GrayImage::from_raw(colors.width(), colors.height(), greys);
            DynamicImage::ImageLuma8(grey.expect("a grey for each pixel"))
        }
        picture => picture,
    }
}

/// Checks that the decoded picture and its [`Buffer`] together fit into the permitted memory.
fn check_memory([width, height]: [u32; 2], color: ColorType, kept: u8) -> Result<(), String> {
    let bytes = u64::from(width) * u64::from(height) * u64::from(color.bytes_per_pixel() + kept);
    if bytes <= MOST_MEMORY {
        return Ok(());
    }
    let needed = bytes.div_ceil(1 << 20);
    Err(format!(
        "its {width} x {height} pixels need {needed} MiB of memory, and a picture may take {}; compare \
         parts of it, or pictures with fewer channels or bits",
        MOST_MEMORY >> 20
    ))
}

/// The bytes of a pixel besides the decoded bytes, until the pixel is part of [`Pixels`].
fn kept(color: ColorType) -> u8 {
    if is_fine(color) { 8 + 16 } else { 4 }
}

/// Whether a channel has more than 8 bits.
fn is_fine(color: ColorType) -> bool {
    color.bytes_per_pixel() > color.channel_count()
}

fn content(picture: DynamicImage, background: Option<[u8; 3]>) -> Result<Content<'static>, String> {
    let color = picture.color();
    let covered = match (color.has_alpha(), color.has_color()) {
        (true, _) => Covered::ByAlpha,
        (false, false) => Covered::ByLight,
        (false, true) => background.map_or(Covered::Unknown, Covered::ByBackground),
    };
    if covered == Covered::ByLight
        && let Some(mask) = mask(&picture)
    {
        return Ok(Content::Mask(mask.into()));
    }
    check_memory([picture.width(), picture.height()], color, kept(color))?;
    let pixels = if is_fine(color) {
        // Sixteen bits hold eight exactly: 65,535 / 255 = 257.
        let steps = |pixel: &image::Rgba<u16>| pixel.0.map(|value| f32::from(value) / 257.0);
        Pixels::Steps(picture.into_rgba16().pixels().map(steps).collect())
    } else {
        match picture {
            DynamicImage::ImageRgb8(colors) => Pixels::Opaque(colors.into()),
            picture => Pixels::Bytes(picture.into_rgba8().as_chunks().0.to_vec()),
        }
    };
    Ok(Content::Picture(Picture { pixels, covered }))
}

/// A grey picture is a mask if its values are black and at most one other value, such as 1 or 255.
fn mask(picture: &DynamicImage) -> Option<Vec<bool>> {
    fn two_values<T: Copy + Default + PartialEq>(values: &[T]) -> Option<Vec<bool>> {
        let black = T::default();
        let lit = values.iter().find(|value| **value != black).copied().unwrap_or(black);
        let is_mask = values.iter().all(|value| *value == black || *value == lit);
        is_mask.then(|| values.iter().map(|value| *value != black).collect())
    }
    match picture {
        DynamicImage::ImageLuma8(grey) => two_values(grey.as_raw()),
        DynamicImage::ImageLuma16(grey) => two_values(grey.as_raw()),
        _ => None,
    }
}
