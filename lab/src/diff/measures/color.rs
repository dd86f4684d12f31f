//! The mean differences of colours.

use super::band::Band;
use super::similarity;
use crate::diff::buffer_pair::BufferPair;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// The rows that are measured at once, so that a large picture takes little memory.
const BAND: u32 = 64;

/// How far the colours are apart, in red, green and blue, where neither buffer marks a pixel as uncovered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ColorMeasures {
    /// The mean of the absolute differences of all channels, in steps of 1/255.
    pub mean_difference: f64,
    /// The root of the mean of their squares.
    pub rms_difference: f64,
    /// The peak signal-to-noise ratio in decibels, 20·log₁₀(255/RMS); `None` for equal colours, for which it is infinite.
    pub psnr: Option<f64>,
    /// The structural similarity, 1 for equal colours; `None` if no window of 11 × 11 pixels
    /// is compared whole.
    ///
    /// Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity",
    /// IEEE Transactions on Image Processing 13(4), 2004: Gaussian windows of σ = 1.5 that lie in the picture,
    /// K₁ = 0.01, K₂ = 0.03, L = 255, with weights as for a population. The mean over all windows and over red, green
    /// and blue, each by itself.
    pub ssim: Option<f64>,
}

/// Measures all compared colours; `None` if there are none.
pub(super) fn measure(pair: &BufferPair) -> Option<ColorMeasures> {
    let [_, height] = pair.a.size();
    let starts: Vec<u32> = (0..height).step_by(BAND as usize).collect();
    // Bands are summed in their order, so that the result is the same on any number of threads.
    let sums: Vec<Sums> = starts.into_par_iter().map(|start| Sums::of(pair, start)).collect();
    let sums = sums.into_iter().fold(Sums::default(), Sums::plus);
    if sums.values == 0.0 {
        return None;
    }
    let rms = (sums.squares / sums.values).sqrt();
    Some(ColorMeasures {
        mean_difference: sums.absolute / sums.values,
        rms_difference: rms,
        psnr: (rms > 0.0).then(|| 20.0 * (255.0 / rms).log10()),
        ssim: (sums.windows > 0.0).then(|| sums.similarities / sums.windows),
    })
}

/// The sums over some rows.
#[derive(Clone, Copy, Default)]
struct Sums {
    values: f64,
    absolute: f64,
    squares: f64,
    windows: f64,
    similarities: f64,
}

impl Sums {
    /// The sums over a band, and over the windows whose middles lie in it.
    fn of(pair: &BufferPair, start: u32) -> Sums {
        let [_, height] = pair.a.size();
        let (end, margin) = ((start + BAND).min(height), similarity::MARGIN);
        let [first, last] = [start.saturating_sub(margin), (end + margin).min(height)];
        let Some(band) = Band::new(pair, first..last) else { return Sums::default() };
        let mut sums = Sums::default();
        sums.add_differences(&band, (start - first) as usize..(end - first) as usize);
        // The rows of middles, counted in the band: a window may not reach out of the picture.
        let begin = start.max(margin) - first;
        let end = end.min(height.saturating_sub(margin)).saturating_sub(first);
        (sums.windows, sums.similarities) = similarity::sums(&band, begin as usize..end as usize);
        sums
    }

    /// Adds the differences of the compared pixels in some rows of a band.
    fn add_differences(&mut self, band: &Band, rows: Range<usize>) {
        for row in rows {
            self.values += 3.0 * band.compared_in(row);
            // Equal colours add nothing but their number.
            for part in band.perhaps_differing(row) {
                let [absolute, squares] = match band.is_compared_whole() {
                    true => band.differences(part),
                    false => {
                        let compared = part.filter(|&at| band.is_compared(at));
                        compared.map(|at| band.differences(at..at + 1)).fold([0.0; 2], added)
                    }
                };
                self.absolute += absolute;
                self.squares += squares;
            }
        }
    }

    fn plus(self, other: Sums) -> Sums {
        Sums {
            values: self.values + other.values,
            absolute: self.absolute + other.absolute,
            squares: self.squares + other.squares,
            windows: self.windows + other.windows,
            similarities: self.similarities + other.similarities,
        }
    }
}

fn added([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    [a + c, b + d]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::foreign::{Buffer, Content, Covered, Picture, Pixels, compare};

    /// A picture of many gradients, each with its own disturbance.
    fn picture([width, height]: [u32; 2], disturbance: u32, covered: Covered) -> Buffer<'static> {
        let channel = |i: u32, j: u32, c: u32| {
            let disturbed = disturbance * ((31 * i + 17 * j + 5 * c) % 23);
            u8::try_from((7 * i * i + 13 * j * (c + 1) + disturbed) % 256).unwrap()
        };
        let pixel = |i, j| [channel(i, j, 0), channel(i, j, 1), channel(i, j, 2), 255];
        let pixels = (0..height).flat_map(|i| (0..width).map(move |j| pixel(i, j)));
        let pixels = pixels.collect();
        let content = Content::Picture(Picture { pixels: Pixels::Bytes(pixels), covered });
        Buffer::new([width, height], 1, content)
    }

    fn measured(a: &Buffer, b: &Buffer) -> Option<ColorMeasures> {
        compare(a, b).unwrap().measures.color
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= 1e-12 * b.abs()
    }

    /// The numbers of scikit-image 0.26: `structural_similarity` with `gaussian_weights=True, sigma=1.5,
    /// use_sample_covariance=False, data_range=255, channel_axis=2`, and `peak_signal_noise_ratio`.
    #[test]
    fn measures_are_those_of_scikit_image() {
        let cases = [
            ([24, 20], 1, 0.748_553_428_319_143_5, 14.098_967_838_337_657, 20.234_027_777_777_78),
            ([11, 11], 3, 0.243_424_421_637_976_76, 9.925_635_346_188_779, 53.198_347_107_438_02),
            // More rows than one band.
            ([40, 90], 2, 0.559_636_684_766_196_2, 11.243_590_830_846_14, 38.496_481_481_481_48),
        ];
        for (size, disturbance, ssim, psnr, mean) in cases {
            let [a, b] = [0, disturbance].map(|by| picture(size, by, Covered::Unknown));
            let found = measured(&a, &b).unwrap();
            assert!((found.ssim.unwrap() - ssim).abs() < 1e-9, "{found:?}");
            assert!(close(found.psnr.unwrap(), psnr), "{found:?}");
            assert!(close(found.mean_difference, mean), "{found:?}");
        }
    }

    #[test]
    fn few_differences_are_measured_as_if_every_pixel_were_looked_at() {
        for size @ [width, _] in [[150, 80], [64, 70], [75, 12]] {
            let a = picture(size, 0, Covered::Unknown);
            let Content::Picture(Picture { pixels: Pixels::Bytes(mut pixels), covered }) =
                a.content().clone()
            else {
                panic!("no bytes")
            };
            for at in [3, 63, 64, 4 * width + 74, 11 * width - 1, 9 * width + 10] {
                pixels[at as usize][1] ^= 0x5a;
            }
            // Pictures that are stored in different ways are looked at as a whole.
            let steps = pixels.iter().map(|color| color.map(f32::from)).collect();
            let [few, all] = [Pixels::Bytes(pixels), Pixels::Steps(steps)].map(|pixels| {
                let b = Content::Picture(Picture { pixels, covered });
                measured(&a, &Buffer::new(size, 1, b))
            });
            assert!(few.unwrap().ssim.unwrap() < 1.0, "{few:?}");
            assert_eq!(few, all, "{size:?}");
        }
    }

    #[test]
    fn equal_pictures_are_perfectly_similar_and_have_no_noise() {
        let a = picture([12, 70], 1, Covered::Unknown);
        let expected = ColorMeasures {
            mean_difference: 0.0,
            rms_difference: 0.0,
            psnr: None,
            ssim: Some(1.0),
        };
        assert_eq!(measured(&a, &a), Some(expected));
    }

    #[test]
    fn only_compared_pixels_are_measured() {
        let [a, b] = [0, 1].map(|by| picture([12, 11], by, Covered::Unknown));
        let narrow = [0, 1].map(|by| picture([10, 11], by, Covered::Unknown));
        assert_eq!(measured(&narrow[0], &narrow[1]).unwrap().ssim, None);
        // The last column is the background, and with it one of the two windows.
        let Content::Picture(Picture { pixels: Pixels::Bytes(mut pixels), .. }) =
            a.content().clone()
        else {
            panic!("no bytes")
        };
        let changed = pixels.iter_mut();
        changed.skip(11).step_by(12).for_each(|pixel| *pixel = [1, 2, 3, 255]);
        let covered = Covered::ByBackground([1, 2, 3]);
        let picture = Picture { pixels: Pixels::Bytes(pixels), covered };
        let without = Buffer::new([12, 11], 1, Content::Picture(picture));
        let first = [0, 1].map(|by| self::picture([11, 11], by, Covered::Unknown));
        let expected = measured(&first[0], &first[1]).unwrap();
        assert_eq!(measured(&without, &b), Some(expected));
        assert_ne!(measured(&a, &b), Some(expected));
    }
}
