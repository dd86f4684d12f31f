//! A part of a picture: the same pixels as in the whole, and no others.

use crate::frame::Region;
use std::fmt;

/// A rectangle of an image's pixels, which alone are rendered.
///
/// It changes nothing else: pixels keep their numbers, rays and bits. A camera with a smaller image
/// would have rays that are rounded differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Crop {
    /// The first row, from the image's top.
    pub row: u32,
    /// The first column, from the image's left.
    pub column: u32,
    /// How many rows.
    pub height: u32,
    /// How many columns.
    pub width: u32,
}

/// Why an image has no such crop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CropError {
    /// It holds no pixel.
    #[error(
        "the crop {crop} of an image of {}x{} holds no pixel; its height and width, the last two \
         numbers, must be at least 1",
        image[0], image[1]
    )]
    Empty {
        /// As it was given.
        crop: Crop,
        /// The image's width and height.
        image: [u32; 2],
    },
    /// It holds pixels that the image does not have.
    #[error(
        "the crop {crop} ends at pixel ({}, {}), outside of an image of {}x{}, whose last pixel is \
         ({}, {}); give ROW,COLUMN,HEIGHT,WIDTH with ROW + HEIGHT up to {} and COLUMN + WIDTH up to {}",
        crop.end()[0] - 1, crop.end()[1] - 1,
        image[0], image[1],
        image[1] - 1, image[0] - 1,
        image[1], image[0]
    )]
    Outside {
        /// As it was given.
        crop: Crop,
        /// The image's width and height.
        image: [u32; 2],
    },
}

impl Crop {
    /// All of an image of this width and height.
    pub fn whole([width, height]: [u32; 2]) -> Crop {
        Crop { row: 0, column: 0, height, width }
    }

    /// Whether an image of this width and height has such a crop.
    ///
    /// # Errors
    ///
    /// A crop without pixels, or with some outside of the image.
    ///
    /// ```
    /// use bothways_common::Crop;
    ///
    /// let crop = Crop { row: 470, column: 0, height: 10, width: 640 };
    /// assert_eq!(crop.check([640, 480]), Ok(()));
    /// assert!(crop.check([640, 479]).is_err());
    /// ```
    pub fn check(&self, image: [u32; 2]) -> Result<(), CropError> {
        let crop = *self;
        if self.height == 0 || self.width == 0 {
            return Err(CropError::Empty { crop, image });
        }
        let [end_row, end_column] = self.end();
        if end_row > image[1].into() || end_column > image[0].into() {
            return Err(CropError::Outside { crop, image });
        }
        Ok(())
    }

    /// Behind the last row, and behind the last column.
    fn end(&self) -> [u64; 2] {
        [(self.row, self.height), (self.column, self.width)]
            .map(|(first, count)| u64::from(first) + u64::from(count))
    }

    /// Its samples on the raster of the whole image, so many along one side of a pixel.
    pub fn region(&self, samples: u32) -> Region {
        let n = samples as usize;
        let range = |first: u32, count: u32| {
            let first = first as usize;
            first * n..(first + count as usize) * n
        };
        Region { rows: range(self.row, self.height), columns: range(self.column, self.width) }
    }

    /// ROW, COLUMN, HEIGHT and WIDTH, as the command line takes them.
    pub fn to_array(&self) -> [u32; 4] {
        [self.row, self.column, self.height, self.width]
    }
}

impl From<[u32; 4]> for Crop {
    fn from([row, column, height, width]: [u32; 4]) -> Crop {
        Crop { row, column, height, width }
    }
}

impl fmt::Display for Crop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [row, column, height, width] = self.to_array();
        write!(f, "{row},{column},{height},{width}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crop_lies_in_its_image() {
        let checked = |numbers: [u32; 4]| Crop::from(numbers).check([7, 5]);
        for inside in [[0, 0, 5, 7], [4, 6, 1, 1], [2, 0, 3, 7]] {
            assert_eq!(checked(inside), Ok(()), "{inside:?}");
        }
        for empty in [[0, 0, 0, 7], [0, 0, 5, 0], [9, 9, 0, 0]] {
            assert!(matches!(checked(empty), Err(CropError::Empty { .. })), "{empty:?}");
        }
        for outside in [[0, 0, 7, 5], [1, 0, 5, 1], [0, 7, 1, 1], [u32::MAX, 0, u32::MAX, 1]] {
            assert!(matches!(checked(outside), Err(CropError::Outside { .. })), "{outside:?}");
        }
    }

    #[test]
    fn messages_name_the_crop_the_image_and_what_to_do() {
        let message = |numbers: [u32; 4]| Crop::from(numbers).check([640, 480]).unwrap_err();
        let outside = "the crop 470,0,20,10 ends at pixel (489, 9), outside of an image of 640x480, \
                       whose last pixel is (479, 639); give ROW,COLUMN,HEIGHT,WIDTH with ROW + HEIGHT \
                       up to 480 and COLUMN + WIDTH up to 640";
        assert_eq!(message([470, 0, 20, 10]).to_string(), outside);
        let empty = "the crop 1,2,0,3 of an image of 640x480 holds no pixel; its height and width, \
                     the last two numbers, must be at least 1";
        assert_eq!(message([1, 2, 0, 3]).to_string(), empty);
    }

    #[test]
    fn samples_are_counted_in_the_whole_image() {
        let region = Crop { row: 2, column: 3, height: 1, width: 4 }.region(3);
        assert_eq!((region.rows, region.columns), (6..9, 9..21));
    }
}
