//! What one frame looks like: its picture, and its mask of coverage.

use crate::common::Frame;
use crate::common::frame::NO_PRIMITIVE;
use crate::common::glam::Vec3;
use crate::common::shade::srgb_from_linear;
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// The picture: each pixel is the average of its samples in linear light, as an sRGB colour.
pub fn picture(frame: &Frame) -> RgbImage {
    let ([width, height], [top, left]) = (frame.image(), first_pixel(frame));
    let mut picture = RgbImage::new(width, height);
    picture.par_chunks_exact_mut(3 * width as usize).enumerate().for_each(|(i, row)| {
        for (j, pixel) in row.chunks_exact_mut(3).enumerate() {
            pixel.copy_from_slice(
                &average(frame, top + i, left + j).to_array().map(srgb_from_linear),
            );
        }
    });
    picture
}

/// The mask: 0 where no sample of a pixel is covered, 255 where all are.
///
/// In between it is `255·covered / N²`, rounded, but never 0 or 255: partial coverage stays visible.
pub fn mask(frame: &Frame) -> GrayImage {
    let ([width, height], [top, left]) = (frame.image(), first_pixel(frame));
    let mut mask = GrayImage::new(width, height);
    mask.par_chunks_exact_mut(width as usize).enumerate().for_each(|(i, row)| {
        for (j, pixel) in row.iter_mut().enumerate() {
            *pixel = coverage_byte(frame, top + i, left + j);
        }
    });
    mask
}

/// The row and column of the frame's first pixel.
fn first_pixel(frame: &Frame) -> [usize; 2] {
    frame.crop().map_or([0; 2], |crop| [crop.row as usize, crop.column as usize])
}

fn average(frame: &Frame, i: usize, j: usize) -> Vec3 {
    let samples = frame.samples_of(i, j);
    let total: Vec3 = samples.map(|sample| frame.colours()[sample]).sum();
    #[expect(clippy::cast_precision_loss, reason = "a count of samples needs no more than f32")]
    let count = frame.samples().pow(2) as f32;
    total / count
}

fn coverage_byte(frame: &Frame, i: usize, j: usize) -> u8 {
    let covered =
        frame.samples_of(i, j).filter(|&sample| frame.ids()[sample] != NO_PRIMITIVE).count() as u64;
    let samples = u64::from(frame.samples()).pow(2);
    if covered == 0 {
        return 0;
    }
    if covered == samples {
        return u8::MAX;
    }
    let rounded = (2 * 255 * covered + samples) / (2 * samples);
    u8::try_from(rounded.clamp(1, 254)).expect("clamped to a byte")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::{Camera, Options};

    fn frame(samples: u32, seen: &[(usize, usize)]) -> Frame {
        let mut frame =
            Frame::new(&Camera::canonical(2, 1), &Options { samples, ..Options::default() });
        seen.iter().for_each(|&(row, column)| frame.set(row, column, 0, 1.0));
        frame
    }

    #[test]
    fn a_mask_counts_samples() {
        assert_eq!(mask(&frame(1, &[(0, 1)])).into_raw(), [0, 255]);
        assert_eq!(mask(&frame(2, &[(0, 0), (1, 1)])).into_raw(), [128, 0]);
        assert_eq!(mask(&frame(2, &[(0, 2), (0, 3), (1, 2), (1, 3)])).into_raw(), [0, 255]);
    }

    #[test]
    fn a_single_sample_of_many_is_not_lost() {
        assert_eq!(mask(&frame(64, &[(63, 64)])).into_raw(), [0, 1]);
    }

    #[test]
    fn samples_are_averaged_in_linear_light() {
        let mut frame = frame(2, &[]);
        for row in frame.shading_rows() {
            row.colours[0] = Vec3::ONE;
        }
        // Half of the light is 188 in sRGB, not 128.
        assert_eq!(picture(&frame).into_raw(), [188, 188, 188, 0, 0, 0]);
    }
}
