//! Opens picture files of any origin: PNG, JPEG, BMP and PNM, which the `image` crate decodes. They are checked before,
//! because decoders fill what is missing, trust sizes, and some of them panic.

mod jpeg;
mod png;
mod problem;
pub(crate) mod texture;

pub use problem::{Problem, ends_early};
pub use texture::ReadTextureError;

use crate::source::quote::visible;
use image::error::ImageError;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::io::{BufRead, ErrorKind, Read, Seek};

/// A picture file whose pixels have not been decoded yet.
#[expect(missing_debug_implementations, reason = "decoders have none")]
pub struct OpenPicture<'a> {
    decoder: Box<dyn ImageDecoder + 'a>,
    format: ImageFormat,
    length: u64,
    has_palette: bool,
}

/// Opens a picture of a known format, in a file of `length` bytes. Decoding takes at most so much memory.
///
/// # Errors
///
/// A file that is damaged, too short for its pixels, or of a kind that is not read.
pub fn open<'a>(
    mut input: impl BufRead + Seek + 'a,
    length: u64,
    format: ImageFormat,
    most_memory: u64,
) -> Result<OpenPicture<'a>, Problem> {
    let mut has_palette = false;
    match format {
        ImageFormat::Png => has_palette = png::check(&mut input, length)?,
        ImageFormat::Bmp => has_palette = check_bmp(&mut input, length)?,
        ImageFormat::Jpeg => jpeg::check(&mut input, length)?,
        _ => {}
    }
    input.rewind()?;
    let mut reader = ImageReader::with_format(input, format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(most_memory);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(|error| problem(error, format, length))?;
    let opened = OpenPicture { decoder: Box::new(decoder), format, length, has_palette };
    if format == ImageFormat::Jpeg {
        jpeg::check_size(opened.size(), length)?;
    }
    Ok(opened)
}

impl OpenPicture<'_> {
    /// Its width and height in pixels, as its header states them.
    pub fn size(&self) -> [u32; 2] {
        self.decoder.dimensions().into()
    }

    /// The type of its pixels.
    pub fn color_type(&self) -> ColorType {
        self.decoder.color_type()
    }

    /// Whether the pixels are colours of a palette.
    pub fn has_palette(&self) -> bool {
        self.has_palette
    }

    /// Decodes the pixels.
    ///
    /// # Errors
    ///
    /// Damaged or missing pixels.
    pub fn decode(self) -> Result<DynamicImage, Problem> {
        let OpenPicture { decoder, format, length, .. } = self;
        if format == ImageFormat::Png {
            png::check_size(decoder.dimensions().into(), length)?;
        }
        DynamicImage::from_decoder(decoder).map_err(|error| problem(error, format, length))
    }
}

/// The most pixels that two bytes of a run-length BMP can fill.
const LONGEST_RUN: u64 = 255;

/// Refuses a run-length BMP that is far too short for its size: a file of a few bytes can claim any size. The result says
/// whether the pixels are colours of a palette, as all pixels of up to eight bits are.
fn check_bmp(input: &mut (impl BufRead + Seek), length: u64) -> Result<bool, Problem> {
    let mut header = Vec::new();
    input.rewind()?;
    input.by_ref().take(34).read_to_end(&mut header)?;
    if header.len() < 34 {
        return Ok(false);
    }
    let number = |at: usize| header[at..at + 4].try_into().map_or(0, i32::from_le_bytes);
    // The first version of the format has a shorter header.
    let is_short = number(14) < 40;
    let bits = header[if is_short { 24 } else { 28 }];
    let ([width, height], compression) = ([number(18), number(22)], number(30));
    let runs = matches!(compression, 1 | 2) && !is_short;
    // The height is negative if the rows come from the top.
    let [width, height] = [width, height].map(i32::unsigned_abs);
    if runs && u64::from(width) * u64::from(height) > length * LONGEST_RUN {
        return Err(Problem::Content(format!(
            "a run-length BMP of {length} bytes cannot fill {width} x {height} pixels; if the file is \
             complete, save it as PNG"
        )));
    }
    Ok(matches!(bits, 1..=8))
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
        ImageError::Limits(_) => return Problem::Memory,
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
