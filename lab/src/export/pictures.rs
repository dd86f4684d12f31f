//! The pictures on surfaces, as PNG files.

use super::srgb::encoded_in_16_bits;
use crate::common::glam::Vec3;
use crate::common::look::color::{linear_from_srgb, srgb_from_linear};
use crate::common::scene::Pyramid;
use image::{ImageBuffer, ImageFormat, Rgb, RgbImage};
use std::io::Cursor;
use std::sync::Arc;

/// Pictures that surfaces name, each written once.
#[derive(Default)]
pub(super) struct Pictures {
    /// Each with the colour by which it is multiplied.
    known: Vec<(Arc<Pyramid>, Vec3)>,
    files: Vec<Vec<u8>>,
}

impl Pictures {
    /// The number of a picture, multiplied by a colour where the program cannot multiply.
    pub(super) fn place(&mut self, pyramid: &Arc<Pyramid>, color: Vec3) -> usize {
        let is_same = |(one, by): &(Arc<Pyramid>, Vec3)| Arc::ptr_eq(one, pyramid) && *by == color;
        self.known.iter().position(is_same).unwrap_or_else(|| {
            self.known.push((Arc::clone(pyramid), color));
            self.files.push(png(pyramid, color));
            self.files.len() - 1
        })
    }

    /// The name of the file of a picture, for a scene of this name.
    pub(super) fn name(scene: &str, number: usize) -> String {
        format!("{scene}-picture-{number}.png")
    }

    /// All files, in the order of their numbers.
    pub(super) fn files(self) -> Vec<Vec<u8>> {
        self.files
    }

    /// The same with their names.
    pub(super) fn named(self, scene: &str) -> impl Iterator<Item = (String, Vec<u8>)> {
        let named = |(number, bytes)| (Pictures::name(scene, number), bytes);
        self.files.into_iter().enumerate().map(named)
    }
}

/// A picture as a PNG of sRGB values: of 8 bits if they stand for each of its values, else of 16.
fn png(pyramid: &Pyramid, color: Vec3) -> Vec<u8> {
    let level = &pyramid.levels()[0];
    let [width, height] =
        level.size().map(|side| u32::try_from(side).expect("pictures have sides of 32 bits"));
    let values = || level.texels().iter().flat_map(|texel| (color * *texel).to_array());
    let is_of_bytes = values().all(|value| linear_from_srgb(srgb_from_linear(value)) == value);
    const ROOM: &str = "there is a value for each channel";
    let mut file = Cursor::new(Vec::new());
    let written = if is_of_bytes {
        let picture = RgbImage::from_raw(width, height, values().map(srgb_from_linear).collect());
        picture.expect(ROOM).write_to(&mut file, ImageFormat::Png)
    } else {
        let fine = values().map(encoded_in_16_bits).collect();
        let picture = ImageBuffer::<Rgb<u16>, Vec<u16>>::from_raw(width, height, fine);
        picture.expect(ROOM).write_to(&mut file, ImageFormat::Png)
    };
    written.expect("a picture with pixels is a PNG, and memory takes it");
    file.into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::common::look::color::linear_from_encoded;

    #[test]
    fn a_picture_takes_8_bits_where_they_are_enough() {
        let texels: Vec<Vec3> = [0, 1, 127, 255].map(linear_from_srgb).map(Vec3::splat).to_vec();
        let pyramid = Arc::new(Pyramid::new(2, texels.clone()));
        let mut pictures = Pictures::default();
        let places = [Vec3::ONE, Vec3::splat(0.5), Vec3::ONE];
        assert_eq!(places.map(|color| pictures.place(&pyramid, color)), [0, 1, 0]);
        let files = pictures.files();
        let [plain, halved] = [&files[0], &files[1]]
            .map(|bytes| image::load_from_memory_with_format(bytes, ImageFormat::Png).unwrap());
        assert_eq!([plain.color().bits_per_pixel(), halved.color().bits_per_pixel()], [24, 48]);
        let plain = plain.into_rgb8();
        assert_eq!(plain.pixels().map(|pixel| pixel.0[0]).collect::<Vec<_>>(), [0, 1, 127, 255]);
        for (pixel, texel) in halved.into_rgb16().pixels().zip(texels) {
            let value = linear_from_encoded(f32::from(pixel.0[1]) / 65535.0);
            assert!((value - 0.5 * texel.y).abs() < 2e-5, "{value}");
        }
    }
}
