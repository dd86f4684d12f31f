//! The difference as a picture: a class for each pixel.

use crate::picture::NOTHING;
use image::{Rgb, RgbImage};

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
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Classes {
    image: [u32; 2],
    classes: Vec<Class>,
}

impl Classes {
    /// The classes of all pixels, row by row.
    pub(super) fn new(image: [u32; 2], classes: Vec<Class>) -> Classes {
        Classes { image, classes }
    }

    /// The image's width and height in pixels.
    pub fn image(&self) -> [u32; 2] {
        self.image
    }

    /// The class of a pixel.
    ///
    /// # Panics
    ///
    /// If the pixel does not exist.
    pub fn at(&self, i: u32, j: u32) -> Class {
        self.classes[i as usize * self.image[0] as usize + j as usize]
    }

    /// The number of pixels of a class.
    pub fn count(&self, class: Class) -> u64 {
        self.classes.iter().filter(|&&other| other == class).count() as u64
    }

    /// The pixels `[i, j]` in which the orders disagree, row by row, each with its class.
    pub fn differing(&self) -> impl Iterator<Item = ([u32; 2], Class)> {
        pixels(self.image).zip(self.classes.iter().copied()).filter(|(_, class)| class.differs())
    }

    /// The difference image; `lit_by` is the picture of either order.
    ///
    /// # Panics
    ///
    /// If the picture has another size.
    pub fn picture(&self, lit_by: &RgbImage) -> RgbImage {
        assert_eq!([lit_by.width(), lit_by.height()], self.image, "the picture is of another size");
        let mut picture = RgbImage::new(self.image[0], self.image[1]);
        let lit = picture.pixels_mut().zip(lit_by.pixels());
        for ((pixel, light), class) in lit.zip(&self.classes) {
            *pixel = match class {
                Class::Alike => faint_grey(*light),
                class => Rgb(class.color()),
            };
        }
        picture
    }
}

/// A dark grey: the reader recognises the picture and sees every difference.
fn faint_grey(Rgb([red, green, blue]): Rgb<u8>) -> Rgb<u8> {
    // The weights of Rec. 709, in 256ths.
    let light = (54 * u32::from(red) + 183 * u32::from(green) + 19 * u32::from(blue)) / 256;
    Rgb([u8::try_from(44 + 96 * light / 255).expect("at most 140"); 3])
}

/// All pixels `[i, j]` of an image, row by row.
pub(super) fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |i| (0..width).map(move |j| [i, j]))
}
