//! The difference as a picture: a class for each pixel.

use super::bits::packed_bits;
use crate::picture::NOTHING;
use image::RgbImage;
use rayon::prelude::*;
use std::sync::Arc;

/// The agreement of both orders at a pixel, from the worst class to the best; a pixel of several samples has the
/// worst class of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Class {
    /// Only object order covers the pixel.
    OnlyObjectOrder,
    /// Only image order covers the pixel.
    OnlyImageOrder,
    /// Both orders cover the pixel and see different primitives.
    OtherPrimitive,
    /// Both orders see the same primitive.
    Alike,
    /// Neither order sees a primitive.
    Neither,
    /// The pixel is not compared.
    Ignored,
}

impl Class {
    /// The classes of compared pixels, from the worst to the best.
    pub const ALL: [Class; 5] = [
        Class::OnlyObjectOrder,
        Class::OnlyImageOrder,
        Class::OtherPrimitive,
        Class::Alike,
        Class::Neither,
    ];

    /// The name of the class in a legend.
    pub fn name(self) -> &'static str {
        match self {
            Class::OnlyObjectOrder => "only object order",
            Class::OnlyImageOrder => "only image order",
            Class::OtherPrimitive => "different primitives",
            Class::Alike => "both alike",
            Class::Neither => "neither",
            Class::Ignored => "not compared",
        }
    }

    /// The sRGB colour of the class in a difference image. Alike pixels are grey, lit faintly by the picture; this
    /// colour is the middle grey.
    ///
    /// Readers with any colour vision can distinguish the colours: Okabe and Ito, "Color Universal Design", 2008.
    pub fn color(self) -> [u8; 3] {
        match self {
            Class::OnlyObjectOrder => [0xe6, 0x9f, 0x00],
            Class::OnlyImageOrder => [0x00, 0x72, 0xb2],
            Class::OtherPrimitive => [0xcc, 0x79, 0xa7],
            Class::Alike => [0x58; 3],
            Class::Neither => NOTHING,
            // Half as bright as the bluish green of the same set: the eye goes to the differences.
            Class::Ignored => [0x00, 0x4f, 0x3a],
        }
    }

    /// Whether the orders disagree.
    pub fn differs(self) -> bool {
        self < Class::Alike
    }
}

/// The class of every pixel of a picture; in a crop, pixels are counted from the corner of the crop.
#[derive(Clone, Debug)]
pub struct Classes {
    image: [u32; 2],
    stored: Stored,
}

/// How classes are stored.
#[derive(Clone, Debug)]
enum Stored {
    /// The bits of the codes of all pixels, 64 pixels of a row in a word; the last word of a row may have fewer. Where
    /// nothing differs only the first plane has ones, so that the pages of the others are never touched.
    Planes([Vec<u64>; 3]),
    /// Two equal masks: pixels are alike where the mask is true, and empty elsewhere. To pack them would take longer than
    /// to compare them, and most comparisons never ask for the class of an equal pixel.
    EqualMask(Arc<Vec<bool>>),
}

impl PartialEq for Classes {
    fn eq(&self, other: &Classes) -> bool {
        self.image == other.image && self.words().eq(other.words())
    }
}

impl Eq for Classes {}

/// The pixels of a word.
pub(super) const WORD: u32 = u64::BITS;

/// The classes of up to 64 pixels of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Word([u64; 3]);

impl Word {
    /// Pixels that are alike where a bit is 1, and empty elsewhere.
    pub(super) fn alike(bits: u64) -> Word {
        Word([bits, 0, 0])
    }

    /// The classes of pixels of two masks.
    pub(super) fn of_masks([a, b]: [u64; 2]) -> Word {
        let mut word = Word::default();
        for (class, bits) in [
            (Class::Alike, a & b),
            (Class::OnlyObjectOrder, a & !b),
            (Class::OnlyImageOrder, !a & b),
        ] {
            for (plane, stored) in word.0.iter_mut().enumerate() {
                *stored |= bits * (class.code() >> plane & 1);
            }
        }
        word
    }

    /// Makes pixels alike, which must have no class yet.
    pub(super) fn put_alike(&mut self, bits: u64) {
        self.0[0] |= bits;
    }

    /// Sets the class of a pixel, which must not be set yet.
    pub(super) fn put(&mut self, pixel: u32, class: Class) {
        for (plane, bits) in self.0.iter_mut().enumerate() {
            *bits |= (class.code() >> plane & 1) << pixel;
        }
    }

    fn class(self, pixel: u32) -> Class {
        Class::of_code([0, 1, 2].map(|plane| self.0[plane] >> pixel & 1))
    }

    /// The pixels of the first `count` that are not alike.
    fn not_alike(self, count: usize) -> u64 {
        let all = if count < 64 { (1 << count) - 1 } else { u64::MAX };
        all & !self.of_class(Class::Alike)
    }

    /// The pixels of a class that differs.
    fn differing(self) -> u64 {
        let [low, middle, high] = self.0;
        middle | (high & !low)
    }

    /// The pixels of a class.
    fn of_class(self, class: Class) -> u64 {
        let bit = |plane: usize| class.code() >> plane & 1 == 1;
        (0..3).fold(u64::MAX, |all, plane| {
            all & if bit(plane) { self.0[plane] } else { !self.0[plane] }
        })
    }
}

impl Class {
    /// The number of the class in the planes; [`Class::Neither`] is 0, [`Class::Alike`] is 1.
    fn code(self) -> u64 {
        match self {
            Class::Neither => 0b000,
            Class::Alike => 0b001,
            Class::OnlyObjectOrder => 0b010,
            Class::OnlyImageOrder => 0b011,
            Class::OtherPrimitive => 0b100,
            Class::Ignored => 0b101,
        }
    }

    /// The class of a code, its lowest bit first.
    fn of_code(code: [u64; 3]) -> Class {
        match code {
            [0, 0, 0] => Class::Neither,
            [1, 0, 0] => Class::Alike,
            [0, 1, 0] => Class::OnlyObjectOrder,
            [1, 1, 0] => Class::OnlyImageOrder,
            [0, 0, 1] => Class::OtherPrimitive,
            _ => Class::Ignored,
        }
    }
}

/// Some rows of classes, to be written.
pub(super) struct Rows<'a> {
    /// The number of the first row, and of the rows.
    pub(super) first: u32,
    pub(super) count: u32,
    planes: [&'a mut [u64]; 3],
    words: usize,
}

impl Rows<'_> {
    /// Writes the word at a place: its row, counted from the first, and its number in the row.
    pub(super) fn write(&mut self, row: u32, word: u32, classes: Word) {
        let index = row as usize * self.words + word as usize;
        for (plane, bits) in self.planes.iter_mut().zip(classes.0) {
            // What is 0 is never written: see `Stored::Planes`.
            if bits != 0 {
                plane[index] = bits;
            }
        }
    }
}

impl Classes {
    /// The classes of two equal masks, of which this is one.
    pub(super) fn of_equal(image: [u32; 2], mask: &Arc<Vec<bool>>) -> Classes {
        Classes { image, stored: Stored::EqualMask(Arc::clone(mask)) }
    }

    /// The classes that a function writes, several rows at once, and what it returns for the rows, from top to bottom.
    pub(super) fn written<T: Send>(
        image: [u32; 2],
        rows: u32,
        write: impl Fn(&mut Rows) -> T + Sync,
    ) -> (Classes, Vec<T>) {
        let (words, height) = (words_of(image), image[1]);
        let mut planes = [0, 1, 2].map(|_| vec![0; words * height as usize]);
        let band = rows as usize * words;
        let [low, middle, high] = planes.each_mut().map(|plane| plane.par_chunks_mut(band));
        let firsts: Vec<u32> = (0..height).step_by(rows as usize).collect();
        let written =
            low.zip(middle).zip(high).zip(firsts).map(|(((low, middle), high), first)| {
                let count = rows.min(height - first);
                write(&mut Rows { first, count, planes: [low, middle, high], words })
            });
        let written = written.collect();
        (Classes { image, stored: Stored::Planes(planes) }, written)
    }

    /// The image's width and height in pixels.
    pub fn image(&self) -> [u32; 2] {
        self.image
    }

    /// A word by its number, row by row.
    fn word(&self, index: usize) -> Word {
        match &self.stored {
            Stored::Planes(planes) => Word(planes.each_ref().map(|plane| plane[index])),
            Stored::EqualMask(mask) => {
                let (width, words) = (self.image[0] as usize, words_of(self.image));
                let first = index % words * WORD as usize;
                let row = &mask[index / words * width..][..width];
                Word::alike(packed_bits(&row[first..width.min(first + WORD as usize)]))
            }
        }
    }

    /// All words, row by row.
    fn words(&self) -> impl Iterator<Item = Word> {
        (0..words_of(self.image) * self.image[1] as usize).map(|index| self.word(index))
    }

    /// The class of a pixel.
    ///
    /// # Panics
    ///
    /// If the pixel does not exist.
    pub fn at(&self, i: u32, j: u32) -> Class {
        let [width, height] = self.image;
        assert!(i < height && j < width, "there is no pixel ({i}, {j}) in {width} x {height}");
        self.word(i as usize * words_of(self.image) + (j / WORD) as usize).class(j % WORD)
    }

    /// The number of pixels of a class.
    pub fn count(&self, class: Class) -> u64 {
        if class == Class::Neither {
            // The rest of a row's last word has the code of this class, too.
            let all: u64 = self.image.map(u64::from).iter().product();
            let others = Class::ALL.into_iter().chain([Class::Ignored]);
            let others = others.filter(|&other| other != class).map(|other| self.count(other));
            return all - others.sum::<u64>();
        }
        self.words().map(|word| u64::from(word.of_class(class).count_ones())).sum()
    }

    /// The pixels `[i, j]` in which the orders disagree, row by row, each with its class.
    pub fn differing(&self) -> impl Iterator<Item = ([u32; 2], Class)> {
        let words = 0..u32::try_from(words_of(self.image)).expect("fewer than columns");
        let rows = match self.stored {
            Stored::Planes(_) => 0..self.image[1],
            // Nothing differs.
            Stored::EqualMask(_) => 0..0,
        };
        let places = rows.flat_map(move |i| words.clone().map(move |word| (i, word)));
        places.enumerate().flat_map(|(index, (i, number))| {
            let word = self.word(index);
            let mut bits = word.differing();
            std::iter::from_fn(move || {
                let pixel = bits.trailing_zeros();
                (bits != 0).then(|| {
                    bits &= bits - 1;
                    ([i, number * WORD + pixel], word.class(pixel))
                })
            })
        })
    }

    /// The difference image; `lit_by` is the picture of either order.
    ///
    /// # Panics
    ///
    /// If the picture has another size.
    pub fn picture(&self, lit_by: &RgbImage) -> RgbImage {
        assert_eq!([lit_by.width(), lit_by.height()], self.image, "the picture is of another size");
        let lights = lit_by.as_raw().as_chunks::<3>().0;
        self.lit(|pixel| lights[pixel])
    }

    /// The same with the light of each pixel, by its number, row by row.
    pub(super) fn lit(&self, light: impl Fn(usize) -> [u8; 3] + Sync) -> RgbImage {
        let mut picture = RgbImage::new(self.image[0], self.image[1]);
        let width = self.image[0] as usize;
        picture.par_chunks_exact_mut(3 * width).enumerate().for_each(|(i, pixels)| {
            let words = pixels.as_chunks_mut::<3>().0.chunks_mut(WORD as usize);
            for (number, pixels) in words.enumerate() {
                let word = self.word(i * words_of(self.image) + number);
                let first = i * width + number * WORD as usize;
                for (at, pixel) in (first..).zip(pixels.iter_mut()) {
                    *pixel = alike_color(light(at));
                }
                // Most pixels of most pictures are alike.
                let mut others = word.not_alike(pixels.len());
                while others != 0 {
                    let k = others.trailing_zeros();
                    pixels[k as usize] = word.class(k).color();
                    others &= others - 1;
                }
            }
        });
        picture
    }
}

/// The colour of a pixel that is covered alike, in the difference image: a dark grey by the light of its picture. The reader
/// recognises the picture and sees every difference.
pub fn alike_color([red, green, blue]: [u8; 3]) -> [u8; 3] {
    /// The grey of each light.
    const GREYS: [u8; 256] = {
        let mut greys = [0; 256];
        let mut light = 0;
        while light < 256 {
            #[expect(clippy::cast_possible_truncation, reason = "at most 140")]
            let grey = (44 + 96 * light / 255) as u8;
            greys[light] = grey;
            light += 1;
        }
        greys
    };
    // The weights of Rec. 709, in 256ths.
    let light = (54 * u32::from(red) + 183 * u32::from(green) + 19 * u32::from(blue)) / 256;
    [GREYS[light as usize & 255]; 3]
}

/// The words of a row.
fn words_of([width, _]: [u32; 2]) -> usize {
    width.div_ceil(WORD) as usize
}

/// All pixels `[i, j]` of an image, row by row.
pub(super) fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |i| (0..width).map(move |j| [i, j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_is_found_again_in_rows_of_any_width() {
        let kinds = [
            Class::Neither,
            Class::Alike,
            Class::OnlyObjectOrder,
            Class::OnlyImageOrder,
            Class::OtherPrimitive,
            Class::Ignored,
        ];
        for width in [1, 63, 64, 65, 130] {
            let image = [width, 7];
            let class = |i: u32, j: u32| kinds[(5 * i + j * (j + i)) as usize % kinds.len()];
            let (classes, firsts) = Classes::written(image, 3, |rows| {
                for i in 0..rows.count {
                    for word in 0..width.div_ceil(WORD) {
                        let mut classes = Word::default();
                        for pixel in 0..WORD.min(width - word * WORD) {
                            classes.put(pixel, class(rows.first + i, word * WORD + pixel));
                        }
                        rows.write(i, word, classes);
                    }
                }
                rows.first
            });
            assert_eq!(firsts, [0, 3, 6]);
            assert!(pixels(image).all(|[i, j]| classes.at(i, j) == class(i, j)), "{width}");
            for kind in kinds {
                let expected = pixels(image).filter(|&[i, j]| class(i, j) == kind).count();
                assert_eq!(classes.count(kind), expected as u64, "{width}, {kind:?}");
            }
            let all = pixels(image).map(|[i, j]| ([i, j], class(i, j)));
            let expected: Vec<_> = all.filter(|(_, class)| class.differs()).collect();
            assert_eq!(classes.differing().collect::<Vec<_>>(), expected, "{width}");
        }
    }

    #[test]
    fn equal_masks_have_the_classes_that_they_would_have_pixel_by_pixel() {
        for width in [1, 63, 64, 65, 130] {
            let image = [width, 5];
            let mask: Vec<bool> = pixels(image).map(|[i, j]| (3 * i + j * j) % 7 < 3).collect();
            let of = |covered: bool| if covered { Class::Alike } else { Class::Neither };
            let (written, _) = Classes::written(image, 2, |rows| {
                for i in 0..rows.count {
                    let first = ((rows.first + i) * width) as usize;
                    for word in 0..width.div_ceil(WORD) {
                        let mut classes = Word::default();
                        for pixel in 0..WORD.min(width - word * WORD) {
                            let at = first + (word * WORD + pixel) as usize;
                            classes.put(pixel, of(mask[at]));
                        }
                        rows.write(i, word, classes);
                    }
                }
            });
            let shared = Classes::of_equal(image, &Arc::new(mask));
            assert_eq!(shared, written, "{width}");
            for class in Class::ALL {
                assert_eq!(shared.count(class), written.count(class), "{width}, {class:?}");
            }
            assert!(pixels(image).all(|[i, j]| shared.at(i, j) == written.at(i, j)), "{width}");
            assert_eq!(shared.differing().count(), 0, "{width}");
            let light = RgbImage::from_pixel(width, 5, image::Rgb([9, 200, 30]));
            assert_eq!(shared.picture(&light), written.picture(&light), "{width}");
        }
    }
}
