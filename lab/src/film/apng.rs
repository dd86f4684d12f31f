//! A film as an animated PNG: of each frame only what changed, in true colour. Its default image, which programs without
//! animation show, is the finished picture.

use super::change::{changed, pixels};
use super::recorded::Film;
use crate::figure::Theme;
use image::RgbImage;
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, EncodingError, Writer};
use std::io::{self, Write};

pub(super) fn write<W: Write>(
    film: &Film,
    out: W,
    theme: Theme,
    width: u32,
    progress: &mut dyn FnMut(u32),
) -> io::Result<()> {
    let last = film.last_frame(theme, width);
    let mut encoder = Encoder::new(out, last.width(), last.height());
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_animated(film.length().frames(), 0).map_err(failed)?;
    encoder.set_sep_def_img(true).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&opaque(&last)).map_err(failed)?;
    film.each_frame(theme, width, progress, |before, picture, delay| {
        writer.set_frame_delay(delay, 100).map_err(failed)?;
        writer.set_dispose_op(DisposeOp::None).map_err(failed)?;
        write_frame(&mut writer, before, picture).map_err(failed)
    })?;
    writer.finish().map_err(failed)
}

fn write_frame<W: Write>(
    writer: &mut Writer<W>,
    before: Option<&RgbImage>,
    picture: &RgbImage,
) -> Result<(), EncodingError> {
    let Some(before) = before else {
        writer.set_blend_op(BlendOp::Source)?;
        return writer.write_image_data(&opaque(picture));
    };
    let rectangle = changed(before, picture);
    // The old place and the new size might not fit together.
    writer.reset_frame_position()?;
    writer.set_frame_dimension(rectangle.width, rectangle.height)?;
    writer.set_frame_position(rectangle.left, rectangle.top)?;
    writer.set_blend_op(BlendOp::Over)?;
    let stays = [0; 4];
    let pixel = |color: Option<[u8; 3]>| color.map_or(stays, |[r, g, b]| [r, g, b, u8::MAX]);
    let data: Vec<u8> = pixels(before, picture, rectangle).flat_map(pixel).collect();
    writer.write_image_data(&data)
}

fn opaque(picture: &RgbImage) -> Vec<u8> {
    picture.pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2], u8::MAX]).collect()
}

fn failed(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        error => io::Error::other(error),
    }
}
