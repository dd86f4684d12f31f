//! A film as a GIF: one palette for all frames, and of each frame only what changed.

use super::change::{changed, pixels};
use super::palette::{Histogram, Palette};
use super::recorded::Film;
use crate::figure::{FilmPage, Theme};
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use image::RgbImage;
use std::borrow::Cow;
use std::io::{self, Write};

pub(super) fn write<W: Write>(
    film: &Film,
    out: W,
    theme: Theme,
    width: u32,
    progress: &mut dyn FnMut(u32),
) -> io::Result<W> {
    let mut palette = palette(film, theme, width);
    let mut colors: Vec<u8> = palette.colors().as_flattened().to_vec();
    colors.extend([0; 3]);
    let [wide, high] = [width, width / 16 * 9].map(side);
    let mut encoder = Encoder::new(out, wide, high, &colors).map_err(failed)?;
    encoder.set_repeat(Repeat::Infinite).map_err(failed)?;
    film.each_frame(theme, width, progress, |before, picture, delay| {
        let frame = Frame { delay, ..frame(before, picture, &mut palette) };
        encoder.write_frame(&frame).map_err(failed)
    })?;
    encoder.into_inner().map_err(failed)
}

/// The palette, from frames all over the film.
fn palette(film: &Film, theme: Theme, width: u32) -> Palette {
    let mut histogram = Histogram::default();
    film.some_frames(theme, width).iter().for_each(|frame| histogram.add(frame));
    Palette::new(&histogram, &FilmPage::colors(theme))
}

/// The frame with what changed since the one before.
fn frame(before: Option<&RgbImage>, picture: &RgbImage, palette: &mut Palette) -> Frame<'static> {
    let transparent = palette.transparent();
    let (left, top, width, height, buffer) = match before {
        None => {
            let buffer: Vec<u8> = picture.pixels().map(|pixel| palette.nearest(pixel.0)).collect();
            (0, 0, picture.width(), picture.height(), buffer)
        }
        Some(before) => {
            let rectangle = changed(before, picture);
            let number = |color: Option<[u8; 3]>| color.map_or(transparent, |c| palette.nearest(c));
            let buffer: Vec<u8> = pixels(before, picture, rectangle).map(number).collect();
            (rectangle.left, rectangle.top, rectangle.width, rectangle.height, buffer)
        }
    };
    Frame {
        dispose: DisposalMethod::Keep,
        transparent: Some(transparent),
        left: side(left),
        top: side(top),
        width: side(width),
        height: side(height),
        buffer: Cow::Owned(buffer),
        ..Frame::default()
    }
}

fn side(pixels: u32) -> u16 {
    u16::try_from(pixels).expect("a film is at most 3840 pixels wide")
}

fn failed(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        error => io::Error::other(error),
    }
}
