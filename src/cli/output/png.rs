//! Pictures among the files of a run.

use super::{NewFile, Out, Staging};
use crate::cli::failure::Failure;
use bothways::figure::{Bands, Drawing};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ColorType, GrayImage, ImageEncoder, RgbImage};
use std::io::{self, Write};

impl Staging {
    /// Writes a picture as PNG.
    pub(in crate::cli) fn write_rgb(
        &mut self,
        name: &str,
        picture: &RgbImage,
    ) -> Result<(), Failure> {
        self.write(name, |out| rgb(out, picture))
    }

    /// Writes a grey picture as PNG.
    pub(in crate::cli) fn write_grey(
        &mut self,
        name: &str,
        picture: &GrayImage,
    ) -> Result<(), Failure> {
        self.write(name, |out| grey(out, picture))
    }
}

impl<'a> NewFile<'a> {
    /// A picture as PNG.
    pub(in crate::cli) fn rgb(
        name: impl Into<String>,
        picture: impl FnOnce() -> RgbImage + Send + 'a,
    ) -> NewFile<'a> {
        NewFile::new(name, |out| rgb(out, &picture()))
    }

    /// A picture that is there already, as PNG.
    pub(in crate::cli) fn finished_rgb(
        name: impl Into<String>,
        picture: &'a RgbImage,
    ) -> NewFile<'a> {
        NewFile::new(name, |out| rgb(out, picture))
    }

    /// A drawing as a PNG so many pixels wide. Its pixels are never all in memory: a slide is large beside the rest of a
    /// small run.
    pub(in crate::cli) fn drawing(
        name: impl Into<String>,
        drawing: impl FnOnce() -> Drawing + Send + 'a,
        width: u32,
    ) -> NewFile<'a> {
        NewFile::new(name, move |out| in_bands(out, drawing().bands(width)))
    }

    /// A grey picture as PNG.
    pub(in crate::cli) fn grey(
        name: impl Into<String>,
        picture: impl FnOnce() -> GrayImage + Send + 'a,
    ) -> NewFile<'a> {
        NewFile::new(name, |out| grey(out, &picture()))
    }
}

fn rgb(out: &mut Out, picture: &RgbImage) -> io::Result<()> {
    png(out, picture, picture.dimensions(), ColorType::Rgb8)
}

fn grey(out: &mut Out, picture: &GrayImage) -> io::Result<()> {
    png(out, picture, picture.dimensions(), ColorType::L8)
}

fn in_bands(out: &mut Out, bands: Bands) -> io::Result<()> {
    // The bytes of a chunk of the file.
    const CHUNK: usize = 1 << 16;
    let [width, height] = bands.size();
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Paeth);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    for band in bands {
        stream.write_all(&band)?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
}

/// One filter for all rows: of our pictures it makes files as small as the best filter for each row, in less time.
fn png(
    out: &mut Out,
    bytes: &[u8],
    (width, height): (u32, u32),
    color: ColorType,
) -> io::Result<()> {
    PngEncoder::new_with_quality(out, CompressionType::Fast, FilterType::Paeth)
        .write_image(bytes, width, height, color.into())
        .map_err(io::Error::other)
}
