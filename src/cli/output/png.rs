//! Pictures among the files of a run.

use super::Staging;
use crate::cli::failure::Failure;
use image::codecs::png::PngEncoder;
use image::{ColorType, GrayImage, ImageEncoder, RgbImage};
use std::io;

impl Staging {
    /// Writes a picture as PNG.
    pub(in crate::cli) fn write_rgb(
        &mut self,
        name: &str,
        picture: &RgbImage,
    ) -> Result<(), Failure> {
        self.write_png(name, picture, picture.dimensions(), ColorType::Rgb8)
    }

    /// Writes a grey picture as PNG.
    pub(in crate::cli) fn write_grey(
        &mut self,
        name: &str,
        picture: &GrayImage,
    ) -> Result<(), Failure> {
        self.write_png(name, picture, picture.dimensions(), ColorType::L8)
    }

    fn write_png(
        &mut self,
        name: &str,
        bytes: &[u8],
        (width, height): (u32, u32),
        color: ColorType,
    ) -> Result<(), Failure> {
        self.write(name, |out| {
            PngEncoder::new(out)
                .write_image(bytes, width, height, color.into())
                .map_err(io::Error::other)
        })
    }
}
