//! A palette for a film: the colours of its drawing, and the best few of its pictures.
//!
//! The method is the median cut of Heckbert, "Color Image Quantization for Frame Buffer Display", SIGGRAPH 1982. A
//! colour counts with the square root of its pixels, so that a small bright thing keeps its colour beside a large floor.

use image::RgbImage;
use std::collections::BTreeMap;
use std::collections::HashMap;

/// The colours of a palette; a GIF has 256, and one of them stands for a pixel that stays as it was.
const MOST: usize = 255;

/// A palette.
#[derive(Clone, Debug)]
pub(super) struct Palette {
    colors: Vec<[u8; 3]>,
    nearest: HashMap<[u8; 3], u8>,
}

/// Counts the colours of pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct Histogram {
    // Sorted, so that the same pictures have the same palette.
    counts: BTreeMap<[u8; 3], u64>,
}

impl Histogram {
    pub(super) fn add(&mut self, picture: &RgbImage) {
        // Neighbours are mostly alike.
        let mut run: Option<([u8; 3], u64)> = None;
        for pixel in picture.pixels() {
            match &mut run {
                Some((color, length)) if *color == pixel.0 => *length += 1,
                _ => {
                    self.end(run);
                    run = Some((pixel.0, 1));
                }
            }
        }
        self.end(run);
    }

    fn end(&mut self, run: Option<([u8; 3], u64)>) {
        if let Some((color, length)) = run {
            *self.counts.entry(color).or_default() += length;
        }
    }
}

/// A box of colours, each with its weight.
struct ColorBox(Vec<([u8; 3], f64)>);

impl ColorBox {
    /// The channel in which the colours differ most, and by how much.
    fn longest(&self) -> (usize, u8) {
        let range = |channel: usize| {
            let values = self.0.iter().map(|(color, _)| color[channel]);
            let (low, high) = values.fold((u8::MAX, 0), |(low, high), v| (low.min(v), high.max(v)));
            high.saturating_sub(low)
        };
        (0..3)
            .map(|channel| (channel, range(channel)))
            .max_by_key(|(_, range)| *range)
            .unwrap_or((0, 0))
    }

    fn weight(&self) -> f64 {
        self.0.iter().map(|(_, weight)| weight).sum()
    }

    /// How much there is to gain by a cut.
    fn urgency(&self) -> f64 {
        let (_, range) = self.longest();
        self.weight() * f64::from(range).powi(2)
    }

    /// Cuts at the median along the longest side.
    fn cut(mut self) -> [ColorBox; 2] {
        let (channel, _) = self.longest();
        self.0.sort_by_key(|(color, _)| (color[channel], *color));
        let half = 0.5 * self.weight();
        let mut sum = 0.0;
        let before = self.0.iter().take_while(|(_, weight)| {
            sum += weight;
            sum < half
        });
        let at = before.count().clamp(1, self.0.len() - 1);
        let upper = self.0.split_off(at);
        [self, ColorBox(upper)]
    }

    fn mean(&self) -> [u8; 3] {
        let all = self.weight();
        [0, 1, 2].map(|channel| {
            let sum: f64 = self.0.iter().map(|(c, weight)| weight * f64::from(c[channel])).sum();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a mean of bytes"
            )]
            let mean = (sum / all).round() as u8;
            mean
        })
    }
}

impl Palette {
    /// A palette for these colours that has some of them exactly.
    pub(super) fn new(histogram: &Histogram, exact: &[[u8; 3]]) -> Palette {
        let mut colors = exact.to_vec();
        colors.sort_unstable();
        colors.dedup();
        let rest = histogram.counts.iter().filter(|(color, _)| !exact.contains(color));
        #[expect(clippy::cast_precision_loss, reason = "a weight")]
        let rest: Vec<_> = rest.map(|(color, count)| (*color, (*count as f64).sqrt())).collect();
        let mut boxes = vec![ColorBox(rest)];
        boxes.retain(|one| !one.0.is_empty());
        while colors.len() + boxes.len() < MOST {
            let can_be_cut = |one: &(usize, &ColorBox)| one.1.0.len() > 1;
            let most = boxes.iter().enumerate().filter(can_be_cut);
            let most = most.max_by(|(_, a), (_, b)| a.urgency().total_cmp(&b.urgency()));
            let Some((number, _)) = most else { break };
            let halves = boxes.swap_remove(number).cut();
            boxes.extend(halves);
        }
        colors.extend(boxes.iter().map(ColorBox::mean));
        Palette { colors, nearest: HashMap::new() }
    }

    /// The colours.
    pub(super) fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The number that stands for a pixel that stays as it was.
    pub(super) fn transparent(&self) -> u8 {
        u8::try_from(self.colors.len()).expect("there are at most 255 colours")
    }

    /// The number of the colour that is nearest.
    pub(super) fn nearest(&mut self, color: [u8; 3]) -> u8 {
        *self.nearest.entry(color).or_insert_with(|| {
            let away = |other: &[u8; 3]| -> u32 {
                other.iter().zip(color).map(|(a, b)| u32::from(a.abs_diff(b)).pow(2)).sum()
            };
            let nearest = self.colors.iter().enumerate().min_by_key(|(_, other)| away(other));
            nearest.map_or(0, |(number, _)| u8::try_from(number).expect("at most 255 colours"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn byte(number: u32) -> u8 {
        u8::try_from(number).unwrap()
    }

    #[test]
    fn few_colors_stay_as_they_are() {
        let picture = RgbImage::from_fn(20, 10, |x, _| Rgb([10 * byte(x), 3, 200]));
        let mut histogram = Histogram::default();
        histogram.add(&picture);
        let mut palette = Palette::new(&histogram, &[[1, 2, 3]]);
        assert_eq!((palette.colors().len(), palette.transparent()), (21, 21));
        for color in picture.pixels().map(|pixel| pixel.0).chain([[1, 2, 3]]) {
            let number = usize::from(palette.nearest(color));
            assert_eq!(palette.colors()[number], color);
        }
    }

    #[test]
    fn many_colors_become_near_ones() {
        let picture = RgbImage::from_fn(256, 256, |x, y| Rgb([byte(x), byte(y), 77]));
        let mut histogram = Histogram::default();
        histogram.add(&picture);
        let exact = [[255, 0, 255]];
        let mut palette = Palette::new(&histogram, &exact);
        assert_eq!(palette.colors().len(), 255);
        let number = usize::from(palette.nearest(exact[0]));
        assert_eq!(palette.colors()[number], exact[0]);
        for pixel in picture.pixels() {
            let number = usize::from(palette.nearest(pixel.0));
            let near = palette.colors()[number];
            assert!(
                near.iter().zip(pixel.0).all(|(a, b)| a.abs_diff(b) <= 17),
                "{pixel:?} {near:?}"
            );
        }
    }
}
