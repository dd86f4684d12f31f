//! A legend below a picture: a swatch, a name and a number of pixels a line.

use super::text::{self, Figures, Style, Weight};
use crate::wording::count;
use image::{Rgb, RgbImage};
use tiny_skia::Pixmap;

/// One line of a legend.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// The colour in the picture, in sRGB.
    pub color: [u8; 3],
    /// Its meaning.
    pub name: &'a str,
    /// The number of pixels of this colour.
    pub pixels: u64,
}

/// All lengths in pixels.
const MARGIN: u32 = 16;
const LINE: u32 = 26;
const SWATCH: u32 = 16;
const LETTERS: Style = Style {
    weight: Weight::Regular,
    size: 17.0,
    color: [0xe8, 0xe8, 0xe8],
    figures: Figures::Tabular,
};
const BACKGROUND: Rgb<u8> = Rgb([0x14, 0x17, 0x1c]);

/// The picture with a legend below it, at least as wide as the legend.
pub fn with_legend(picture: &RgbImage, entries: &[Entry]) -> RgbImage {
    let texts: Vec<String> = entries
        .iter()
        .map(|entry| format!("{}: {}", entry.name, count(entry.pixels, "pixels")))
        .collect();
    let widest = texts.iter().map(|text| text::width(text, LETTERS)).fold(0.0, f32::max);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the width of a short text"
    )]
    let needed = widest.ceil() as u32 + SWATCH + 3 * MARGIN;
    let lines = u32::try_from(entries.len()).expect("a legend is short");
    if lines == 0 {
        return picture.clone();
    }
    let (width, below) = (picture.width().max(needed), 2 * MARGIN + lines * LINE);
    let mut whole = RgbImage::from_pixel(width, picture.height() + below, BACKGROUND);
    image::imageops::replace(&mut whole, picture, 0, 0);
    let mut letters = Pixmap::new(width, below).expect("a legend has lines");
    letters.fill(tiny_skia::Color::from_rgba8(BACKGROUND[0], BACKGROUND[1], BACKGROUND[2], 255));
    for (line, text) in (0_u16..).zip(&texts) {
        let baseline = f32::from(line) * LINE as f32 + (MARGIN + SWATCH) as f32;
        text::draw(&mut letters, text, (2 * MARGIN + SWATCH) as f32, baseline - 1.0, LETTERS);
    }
    let top = picture.height();
    for (pixel, place) in letters.pixels().iter().zip(0..) {
        let color = pixel.demultiply();
        let at = (place % width, top + place / width);
        whole.put_pixel(at.0, at.1, Rgb([color.red(), color.green(), color.blue()]));
    }
    for (line, entry) in (0..).zip(entries) {
        let (left, first) = (MARGIN, top + MARGIN + line * LINE);
        for (y, x) in (0..SWATCH).flat_map(|y| (0..SWATCH).map(move |x| (y, x))) {
            whole.put_pixel(left + x, first + y, Rgb(entry.color));
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_stands_below_the_picture_and_widens_it() {
        let picture = RgbImage::from_pixel(10, 5, Rgb([1, 2, 3]));
        let entry = Entry { color: [200, 100, 50], name: "exact tie", pixels: 7 };
        let whole = with_legend(&picture, &[entry, entry]);
        assert_eq!(whole.height(), 5 + 2 * MARGIN + 2 * LINE);
        assert!(whole.width() > 150);
        assert_eq!(whole.get_pixel(9, 4), &Rgb([1, 2, 3]));
        assert_eq!(whole.get_pixel(MARGIN + 3, 5 + MARGIN + 3), &Rgb([200, 100, 50]));
        let letters = whole.pixels().filter(|pixel| pixel[0] > 0xd0 && pixel[2] > 0xd0).count();
        assert!(letters > 100, "{letters}");
        assert_eq!(with_legend(&picture, &[]), picture);
    }
}
