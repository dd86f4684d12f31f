//! Pictures in other sizes: enlarged so that pixels stay squares, reduced without loss of light.

use crate::common::look::color::{linear_from_srgb, srgb_from_linear};
use image::{Rgb, RgbImage};
use std::borrow::Cow;
use std::ops::RangeInclusive;

/// The size of a picture in a frame. The picture fills the frame; but if the largest whole factor nearly fills the
/// frame, this factor enlarges the picture, so that all pixels are squares of one size.
pub(super) fn fitted(picture: [u32; 2], frame: [u32; 2]) -> [u32; 2] {
    let factor = (frame[0] / picture[0]).min(frame[1] / picture[1]);
    let enlarged = picture.map(|side| side * factor);
    // "Nearly" means seven eighths of a side.
    if (0..2).any(|axis| 8 * enlarged[axis] >= 7 * frame[axis]) {
        return enlarged;
    }
    let [width, height] = picture.map(u64::from);
    let [most_wide, most_high] = frame.map(u64::from);
    // The tighter of the two scales applies; the other side is rounded.
    let scaled = |side: u64, most: u64, of: u64| {
        u32::try_from(((2 * side * most + of) / (2 * of)).max(1)).expect("smaller than it was")
    };
    if width * most_high >= height * most_wide {
        [frame[0], scaled(height, most_wide, width)]
    } else {
        [scaled(width, most_high, height), frame[1]]
    }
}

/// The largest size of the form of another that has at most so many pixels, if there is one.
pub(crate) fn within([width, height]: [u32; 2], pixels: u64) -> Option<[u32; 2]> {
    let [wide, high] = [width, height].map(f64::from);
    #[expect(clippy::cast_precision_loss, reason = "a number of pixels")]
    let scale = (pixels as f64 / (wide * high)).sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a side smaller than it was"
    )]
    let size = [wide, high].map(|side| (side * scale) as u32);
    (size[0] > 0 && size[1] > 0).then_some(size)
}

/// The pixels of the reduced picture that a pixel of the original overlaps, along one side.
pub(super) fn footprint(pixel: u32, from: u32, to: u32) -> RangeInclusive<u32> {
    let position = |pixel: u64| pixel * u64::from(to);
    let (begin, end) = (position(u64::from(pixel)), position(u64::from(pixel) + 1));
    let index = |position: u64| u32::try_from(position / u64::from(from)).expect("within a side");
    index(begin)..=index(end - 1)
}

/// The picture in another size, for a size from [`fitted`].
pub(super) fn resized(picture: &RgbImage, size: [u32; 2]) -> Cow<'_, RgbImage> {
    let [width, height] = [picture.width(), picture.height()];
    if size == [width, height] {
        return Cow::Borrowed(picture);
    }
    if size[0].is_multiple_of(width) && size[1].is_multiple_of(height) {
        let (across, down) = (size[0] / width, size[1] / height);
        return Cow::Owned(RgbImage::from_fn(size[0], size[1], |x, y| {
            *picture.get_pixel(x / across, y / down)
        }));
    }
    Cow::Owned(averaged(picture, size))
}

/// The average, in linear light, of the area that each new pixel covers. In an enlarged picture, pixels stay squares
/// with sharp sides; only the new pixels on a side are mixtures.
fn averaged(picture: &RgbImage, [width, height]: [u32; 2]) -> RgbImage {
    let linear: Vec<f32> = (0..=u8::MAX).map(linear_from_srgb).collect();
    let columns = Overlaps::new(picture.width(), width);
    let rows = Overlaps::new(picture.height(), height);

    let mut resized = RgbImage::new(width, height);
    // The light of one old row in the new columns, and of the new row that old rows are being added to.
    let mut narrow = vec![[0.0_f32; 3]; width as usize];
    let mut sums = narrow.clone();
    let mut finished = resized.chunks_exact_mut(3 * width as usize);
    for (i, row) in picture.rows().enumerate() {
        narrow.fill([0.0; 3]);
        for (j, Rgb(pixel)) in row.enumerate() {
            let light = pixel.map(|channel| linear[usize::from(channel)]);
            for &(x, fraction) in columns.of(j) {
                add(&mut narrow[x], light, fraction);
            }
        }
        let next = rows.of(i + 1).first().map(|&(y, _)| y);
        for &(y, fraction) in rows.of(i) {
            sums.iter_mut().zip(&narrow).for_each(|(sum, light)| add(sum, *light, fraction));
            if next != Some(y) {
                let pixels = finished.next().expect("new rows are finished in their order");
                for (pixel, sum) in pixels.as_chunks_mut::<3>().0.iter_mut().zip(&mut sums) {
                    *pixel = std::mem::take(sum).map(srgb_from_linear);
                }
            }
        }
    }
    resized
}

fn add(sum: &mut [f32; 3], light: [f32; 3], fraction: f32) {
    sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += fraction * light);
}

/// The new pixels that each old pixel overlaps, along one side, and the fraction of each new pixel that the old pixel
/// fills.
struct Overlaps {
    /// Those of all old pixels, one after another.
    all: Vec<(usize, f32)>,
    /// Where those of each old pixel end.
    ends: Vec<usize>,
}

impl Overlaps {
    fn new(from: u32, to: u32) -> Overlaps {
        let (from, to) = (u64::from(from), u64::from(to));
        let (mut all, mut ends) = (Vec::new(), Vec::new());
        for pixel in 0..from {
            // In units in which an old pixel is `to` long and a new pixel is `from` long.
            let (begin, end) = (pixel * to, (pixel + 1) * to);
            all.extend((begin / from..=(end - 1) / from).map(|new| {
                let common = end.min((new + 1) * from) - begin.max(new * from);
                #[expect(clippy::cast_precision_loss, reason = "a fraction needs no more than f32")]
                let fraction = common as f32 / from as f32;
                #[expect(clippy::cast_possible_truncation, reason = "an index that fits a side")]
                let new = new as usize;
                (new, fraction)
            }));
            ends.push(all.len());
        }
        Overlaps { all, ends }
    }

    /// Those of one old pixel; none beyond the last.
    fn of(&self, pixel: usize) -> &[(usize, f32)] {
        let Some(&end) = self.ends.get(pixel) else { return &[] };
        let begin = pixel.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[begin..end]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_grow_by_whole_factors() {
        assert_eq!(fitted([64, 64], [568, 426]), [384, 384]);
        assert_eq!(fitted([1, 1], [568, 426]), [426, 426]);
        assert_eq!(fitted([142, 100], [568, 426]), [568, 400]);
        assert_eq!(fitted([500, 375], [568, 426]), [500, 375]);
    }

    #[test]
    fn pictures_between_whole_factors_fill_the_frame() {
        assert_eq!(fitted([285, 214], [568, 426]), [567, 426]);
        assert_eq!(fitted([320, 200], [568, 426]), [568, 355]);
        assert_eq!(fitted([160, 120], [568, 426]), [568, 426]);
        for width in 1..=2000 {
            for height in [1, 2, 100, width, 1080] {
                let [wide, high] = fitted([width, height], [568, 426]);
                assert!(wide <= 568 && high <= 426, "{width} x {height}");
                assert!(8 * wide >= 7 * 568 || 8 * high >= 7 * 426, "{width} x {height}");
            }
        }
    }

    #[test]
    fn large_pictures_shrink_to_fit_and_keep_their_form() {
        assert_eq!(fitted([640, 480], [568, 426]), [568, 426]);
        assert_eq!(fitted([3840, 2160], [568, 426]), [568, 320]);
        assert_eq!(fitted([100, 5000], [568, 426]), [9, 426]);
        assert_eq!(fitted([65_536, 1], [568, 426]), [568, 1]);
    }

    #[test]
    fn enlarged_pixels_are_squares() {
        let picture = RgbImage::from_raw(2, 1, vec![1, 2, 3, 4, 5, 6]).unwrap();
        let large = resized(&picture, [4, 2]);
        assert_eq!(large.get_pixel(1, 1).0, [1, 2, 3]);
        assert_eq!(large.get_pixel(2, 0).0, [4, 5, 6]);
    }

    #[test]
    fn pixels_enlarged_by_a_fraction_keep_their_middles_and_mix_at_their_sides() {
        let picture = RgbImage::from_raw(2, 1, vec![0, 0, 0, 255, 255, 255]).unwrap();
        let large = resized(&picture, [5, 2]);
        let row: Vec<u8> = (0..5).map(|x| large.get_pixel(x, 1).0[0]).collect();
        assert_eq!(row, [0, 0, srgb_from_linear(0.5), 255, 255]);
    }

    #[test]
    fn reducing_keeps_the_light() {
        let picture =
            RgbImage::from_fn(9, 7, |x, y| Rgb([if (x + y) % 2 == 0 { 255 } else { 0 }; 3]));
        let one = resized(&picture, [1, 1]).get_pixel(0, 0).0;
        assert_eq!(one, [srgb_from_linear(32.0 / 63.0); 3]);
        let plain = RgbImage::from_pixel(1000, 300, Rgb([90, 160, 30]));
        let small = resized(&plain, [567, 170]);
        assert!(small.pixels().all(|pixel| pixel.0 == [90, 160, 30]));
    }

    #[test]
    fn a_footprint_holds_every_pixel_that_is_touched() {
        assert_eq!(footprint(0, 4, 2), 0..=0);
        assert_eq!(footprint(1, 3, 2), 0..=1);
        assert_eq!(footprint(2, 3, 2), 1..=1);
        assert_eq!(footprint(1, 2, 6), 3..=5);
    }
}
