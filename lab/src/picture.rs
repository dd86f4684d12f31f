//! The images of a frame: its picture, its mask of coverage, and its ids as colours.

use crate::common::Frame;
use crate::common::glam::Vec3;
use crate::common::look::color::{linear_from_srgb, srgb_from_linear};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

/// The sRGB colour of an uncovered pixel, in images with colours that do not represent light.
pub const NOTHING: [u8; 3] = [0x08, 0x0a, 0x0c];

/// The picture of a frame as an image.
pub fn picture(frame: &Frame) -> RgbImage {
    let [width, height] = frame.image();
    let bytes = frame.picture().as_flattened().to_vec();
    RgbImage::from_raw(width, height, bytes).expect("a frame has three bytes for each pixel")
}

/// The ids as colours: a primitive has the same colour in every pixel; near black is nothing. Each pixel is the
/// average of its samples, as in the picture.
///
/// Consecutive ids, which neighbours in a mesh mostly have, get very different colours. There are more ids than
/// colours, so two distant ids may look alike: programs read the ids themselves.
pub fn id_picture(frame: &Frame) -> RgbImage {
    let linear: Vec<f32> = (0..=u8::MAX).map(linear_from_srgb).collect();
    let color = |sample: usize| {
        let bytes = color_of_id(frame.ids().get(sample));
        Vec3::from_array(bytes.map(|channel| linear[usize::from(channel)]))
    };
    let ([width, height], [top, left]) = (frame.image(), first_pixel(frame));
    let mut picture = RgbImage::new(width, height);
    picture.par_chunks_exact_mut(3 * width as usize).enumerate().for_each(|(i, row)| {
        for (j, pixel) in row.chunks_exact_mut(3).enumerate() {
            let average = average(frame, top + i, left + j, color);
            pixel.copy_from_slice(&average.to_array().map(srgb_from_linear));
        }
    });
    picture
}

/// The sRGB colour of a primitive in an [`id_picture`]; `None` for nothing.
pub fn color_of_id(id: Option<u64>) -> [u8; 3] {
    let Some(id) = id else { return NOTHING };
    // Ids of 64 bits are folded: neighbours stay as far apart as others are.
    #[expect(clippy::cast_possible_truncation, reason = "the two halves of 64 bits")]
    let id = (id as u32).wrapping_add(((id >> 32) as u32).wrapping_mul(0x632b_e5ab));
    // Steps of the golden section around the circle of hues: a few consecutive ids are as far apart as possible.
    const GOLDEN: u32 = 0x9e37_79b9;
    let hue = 6.0 * part(id.wrapping_mul(GOLDEN));
    // Two ids that differ by a Fibonacci number have nearly the same hue; so saturation and brightness are mixed.
    let mixed = (id ^ (id >> 15)).wrapping_mul(0x2c1b_3c6d);
    let mixed = (mixed ^ (mixed >> 12)).wrapping_mul(0x297a_2d39);
    let saturation = 0.35 + 0.5 * part(mixed << 16);
    let brightness = 0.6 + 0.4 * part(mixed);
    // The maxima of red, green and blue are a third of the circle apart.
    [0.0, 4.0, 2.0].map(|from| {
        let away = ((hue + from) % 6.0 - 3.0).abs();
        let channel = brightness * (1.0 - saturation * (1.0 - (away - 1.0).clamp(0.0, 1.0)));
        srgb_byte(channel)
    })
}

/// A 32-bit number as a fraction of 2³².
fn part(bits: u32) -> f64 {
    f64::from(bits) / 4_294_967_296.0
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
fn srgb_byte(encoded: f64) -> u8 {
    (255.0 * encoded).round() as u8
}

/// The picture, enlarged by the largest whole factor at which neither side is longer than 512 pixels, so that single
/// pixels of a very small picture are visible; a larger picture stays unchanged.
///
/// ```
/// use bothways_lab::picture::enlarged;
///
/// let size = |side| enlarged(image::RgbImage::new(side, side / 2)).dimensions();
/// assert_eq!([size(64), size(200), size(640)], [(512, 256), (400, 200), (640, 320)]);
/// ```
pub fn enlarged(picture: RgbImage) -> RgbImage {
    const READABLE: u32 = 512;
    let (width, height) = picture.dimensions();
    match READABLE / width.max(height).max(1) {
        0 | 1 => picture,
        factor => RgbImage::from_fn(factor * width, factor * height, |x, y| {
            *picture.get_pixel(x / factor, y / factor)
        }),
    }
}

/// The mask: 0 where no sample of a pixel is covered, 255 where all samples are covered.
///
/// A partly covered pixel has `255·covered / N²`, rounded, but never 0 or 255: partial coverage stays visible.
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

fn average(frame: &Frame, i: usize, j: usize, color: impl Fn(usize) -> Vec3) -> Vec3 {
    let samples = frame.samples_of(i, j);
    let total: Vec3 = samples.map(color).sum();
    #[expect(clippy::cast_precision_loss, reason = "a count of samples needs no more than f32")]
    let count = frame.samples().pow(2) as f32;
    total / count
}

fn coverage_byte(frame: &Frame, i: usize, j: usize) -> u8 {
    let covered =
        frame.samples_of(i, j).filter(|&sample| frame.ids().is_covered(sample)).count() as u64;
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
            Frame::new(&Camera::canonical(1, 2), &Options { samples, ..Options::default() });
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
    fn neighbouring_ids_look_different_and_none_like_nothing() {
        let apart = |a: [u8; 3], b: [u8; 3]| {
            a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>()
        };
        let colors: Vec<_> = (0..3000).map(|id| color_of_id(Some(id))).collect();
        for (id, &color) in colors.iter().enumerate() {
            assert!(color.iter().any(|&channel| channel >= 128), "{id}: {color:?}");
            for near in 1..=5 {
                let other = colors[(id + near) % 3000];
                assert!(id + near >= 3000 || apart(color, other) > 24, "{id}: {color:?} {other:?}");
            }
        }
        // At the start of every row of a mesh, few triangles look like their neighbours.
        for row in 6..600 {
            let alike = (0..2000).filter(|&id| apart(colors[id], colors[id + row]) <= 24).count();
            assert!(alike < 700, "{row}: {alike}");
        }
        assert_eq!(color_of_id(None), NOTHING);
        assert_eq!(color_of_id(Some(0)), colors[0]);
    }

    #[test]
    fn ids_are_shown_pixel_by_pixel() {
        let shown = id_picture(&frame(1, &[(0, 1)])).into_raw();
        assert_eq!(shown, [NOTHING, color_of_id(Some(0))].concat());
    }

    #[test]
    fn tiny_pictures_grow_by_whole_factors() {
        let picture = RgbImage::from_raw(2, 1, vec![1, 2, 3, 4, 5, 6]).unwrap();
        let large = enlarged(picture);
        assert_eq!(large.dimensions(), (512, 256));
        assert_eq!((large[(255, 255)].0, large[(256, 0)].0), ([1, 2, 3], [4, 5, 6]));
    }
}
