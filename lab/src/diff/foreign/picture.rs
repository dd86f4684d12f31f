//! Pictures of any origin: PNG and the other formats that the `image` crate reads.

use super::problem::{Problem, ends_early};
use super::read::{ReadBuffer, ReadOptions};
use super::{jpeg, png};
use crate::common::raster::check_samples;
use crate::diff::buffer::{Buffer, Content, Covered, Picture, Pixels};
use crate::formats::source::quote::visible;
use image::error::ImageError;
use image::{
    ColorType, DynamicImage, GrayImage, ImageDecoder, ImageFormat, ImageReader, Limits, Rgb,
};
use std::io::{BufRead, ErrorKind, Read, Seek};

/// The most memory that reading a picture may take. A grey picture of 2³⁰ pixels fits, and a picture of 2²⁸ pixels
/// with four channels of 8 bits.
pub(super) const MOST_MEMORY: u64 = 2 << 30;
/// The most pixels that two bytes of a run-length BMP can fill.
const LONGEST_RUN: u64 = 255;

/// Reads a picture of a known format.
pub(super) fn read(
    mut input: impl BufRead + Seek,
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
    let mut has_palette = false;
    match format {
        ImageFormat::Png => has_palette = png::check(&mut input, length)?,
        ImageFormat::Bmp => check_runs(&mut input, length)?,
        ImageFormat::Jpeg => jpeg::check(&mut input, length)?,
        _ => {}
    }
    input.rewind()?;
    let mut reader = ImageReader::with_format(input, format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    let told = |error| problem(error, format, length);
    let decoder = reader.into_decoder().map_err(told)?;
    let size = decoder.dimensions().into();
    check_samples(size, 1)?;
    let color = decoder.color_type();
    // A grey picture may become a mask.
    let mut kept = if color == ColorType::L8 || color == ColorType::L16 { 1 } else { kept(color) };
    let mut warnings = Vec::new();
    if format == ImageFormat::Jpeg {
        jpeg::check_size(size, length)?;
        warnings.push(jpeg::WARNING.into());
        // A progressive JPEG is in memory as coefficients of two bytes, too.
        kept += 2 * color.channel_count();
    }
    check_memory(size, color, kept)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(told)?;
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

/// Refuses a run-length BMP that is far too short for its size: a file of a few bytes can claim any size.
fn check_runs(input: &mut (impl BufRead + Seek), length: u64) -> Result<(), Problem> {
    let mut header = Vec::new();
    input.rewind()?;
    input.by_ref().take(34).read_to_end(&mut header)?;
    if header.len() < 34 {
        return Ok(());
    }
    let number = |at: usize| header[at..at + 4].try_into().map_or(0, i32::from_le_bytes);
    let ([width, height], compression) = ([number(18), number(22)], number(30));
    let runs = matches!(compression, 1 | 2) && number(14) >= 40;
    // The height is negative if the rows come from the top.
    let [width, height] = [width, height].map(i32::unsigned_abs);
    if runs && u64::from(width) * u64::from(height) > length * LONGEST_RUN {
        return Err(Problem::Content(format!(
            "a run-length BMP of {length} bytes cannot fill {width} x {height} pixels; if the file is \
             complete, save it as PNG"
        )));
    }
    Ok(())
}

/// The message of a decoder in our words: the decoders' own messages name bytes of their formats, and no remedy.
fn problem(error: ImageError, format: ImageFormat, length: u64) -> Problem {
    let name = match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Jpeg => "JPEG",
        _ => "PNM",
    };
    Problem::Content(match error {
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            ends_early(length)
        }
        ImageError::IoError(error) => return Problem::Io(error),
        ImageError::Limits(_) => format!(
            "it needs more than the {} MiB of memory that a picture may take; compare parts of it",
            MOST_MEMORY >> 20
        ),
        ImageError::Unsupported(_) => {
            format!("this kind of {name} is not read; save it as a PNG of 8 or 16 bits a channel")
        }
        // If all chunks of a PNG are sound, its pixels are damaged. The words of the decoder do not matter.
        ImageError::Decoding(error) if format != ImageFormat::Png => {
            let said = std::error::Error::source(&error).map(ToString::to_string);
            let said = said.unwrap_or_else(|| "no reason given".into());
            if said.contains("fill whole buffer") || said.contains("Not enough data") {
                ends_early(length)
            } else {
                let said: String = said.chars().take(100).collect();
                format!("the {name} is damaged ({}); save it again, as PNG at best", visible(&said))
            }
        }
        _ => format!("the pixels of the {name} are damaged; copy the file or save it again"),
    })
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
