//! The raster: rows and columns of samples, and the rectangles that are cut out of it.

use std::fmt;
use std::ops::Range;

/// The largest number of samples along one side of the picture, `N·W` or `N·H`.
pub const MAX_SIDE: u32 = 65_536;
/// The largest number of samples in one picture, `W·H·N²`.
pub const MAX_SAMPLES: u64 = 1 << 30;

/// Why a picture is refused for its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SizeError {
    /// The image has no pixels.
    #[error("the image is {width}x{height}; both sides need at least 1 pixel")]
    Empty {
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
    },
    /// The pixels have no samples.
    #[error("a pixel has 0x0 samples; give at least 1")]
    NoSamples,
    /// The image has too many samples.
    #[error(
        "the image is {width}x{height} with {samples}x{samples} samples a pixel; a side may have at \
         most {MAX_SIDE} samples and the image at most {MAX_SAMPLES}"
    )]
    TooManySamples {
        /// The image's width.
        width: u32,
        /// The image's height.
        height: u32,
        /// Samples along one side of a pixel.
        samples: u32,
    },
}

/// Tells whether a picture of this size may have `samples` × `samples` samples a pixel.
///
/// # Errors
///
/// Each [`SizeError`], naming the limits.
pub fn check_samples(image: [u32; 2], samples: u32) -> Result<(), SizeError> {
    let [width, height] = image;
    if width == 0 || height == 0 {
        return Err(SizeError::Empty { width, height });
    }
    if samples == 0 {
        return Err(SizeError::NoSamples);
    }
    let side = |pixels: u32| u64::from(pixels) * u64::from(samples);
    let fits = |pixels: u32| side(pixels) <= u64::from(MAX_SIDE);
    if !fits(width) || !fits(height) || side(width) * side(height) > MAX_SAMPLES {
        return Err(SizeError::TooManySamples { width, height, samples });
    }
    Ok(())
}

/// All samples of one picture as rows and columns, and how they lie on the viewport.
///
/// Row 0 is at the top, column 0 on the left, and a sample in the middle of its cell. Pairs are in the order row,
/// column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Raster {
    size: [u32; 2],
    viewport: [f64; 2],
}

impl Raster {
    /// The raster of an image of this width and height, on a viewport `vw` wide and `vh` high.
    ///
    /// # Errors
    ///
    /// As [`check_samples`].
    pub fn new(image: [u32; 2], samples: u32, [vw, vh]: [f64; 2]) -> Result<Raster, SizeError> {
        check_samples(image, samples)?;
        let [width, height] = image;
        Ok(Raster { size: [height * samples, width * samples], viewport: [vh, vw] })
    }

    /// `H·N` and `W·N`: how many rows and columns of samples.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// `vh/(H·N)` and `vw/(W·N)`, each rounded once: from a row and from a column to the next.
    pub fn spacing(&self) -> [f64; 2] {
        std::array::from_fn(|axis| self.viewport[axis] / f64::from(self.size[axis]))
    }

    /// The row and the column of the viewport's middle, exactly: `(H·N − 1)/2` and `(W·N − 1)/2`.
    pub fn middle(&self) -> [f64; 2] {
        self.size.map(|count| 0.5 * (f64::from(count) - 1.0))
    }

    /// `y` on the viewport, for each row from the top; descending.
    pub fn y(&self) -> impl Iterator<Item = f64> + use<> {
        let ([count, _], [vh, _]) = (self.size, self.viewport);
        (0..count).map(move |row| -viewport_coordinate(vh, row, count))
    }

    /// `x` on the viewport, for each column from the left; ascending.
    pub fn x(&self) -> impl Iterator<Item = f64> + use<> {
        let ([_, count], [_, vw]) = (self.size, self.viewport);
        (0..count).map(move |column| viewport_coordinate(vw, column, count))
    }
}

/// `extent·(2·index + 1 − count)/(2·count)`: the middle of a cell of the viewport.
///
/// The numerator is exact (24 + 17 bits), so the quotient is correctly rounded, and the cells on
/// both sides of the middle are each other's negatives.
pub(crate) fn viewport_coordinate(extent: f64, index: u32, count: u32) -> f64 {
    let numerator = 2.0 * f64::from(index) + 1.0 - f64::from(count);
    extent * numerator / (2.0 * f64::from(count))
}

/// One sample of the picture: its row and column on the raster of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Sample {
    /// The row from the top, counted from 0.
    pub row: usize,
    /// The column from the left, counted from 0.
    pub column: usize,
}

/// A rectangle of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Rows from the top.
    pub rows: Range<usize>,
    /// Columns from the left.
    pub columns: Range<usize>,
}

impl Region {
    /// How many samples it holds.
    pub fn area(&self) -> usize {
        self.rows.len() * self.columns.len()
    }

    /// Whether it holds no sample.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty() || self.columns.is_empty()
    }

    /// The parts of the picture's tiles that lie in it, row by row. A tile has at most so many rows and columns.
    ///
    /// # Panics
    ///
    /// If `rows` or `columns` is 0.
    pub fn tiles(&self, rows: usize, columns: usize) -> impl Iterator<Item = Region> + use<> {
        let across = pieces(&self.columns, columns);
        pieces(&self.rows, rows).flat_map(move |rows| {
            across.clone().map(move |columns| Region { rows: rows.clone(), columns })
        })
    }

    /// The parts of the picture's bands that lie in it, from above. A band has at most so many rows, and all columns.
    ///
    /// # Panics
    ///
    /// If `rows` is 0.
    pub fn bands(&self, rows: usize) -> impl Iterator<Item = Region> + use<> {
        let columns = self.columns.clone();
        pieces(&self.rows, rows).map(move |rows| Region { rows, columns: columns.clone() })
    }

    /// The samples that both hold.
    #[inline]
    pub fn intersection(&self, other: &Region) -> Region {
        let overlap = |a: &Range<usize>, b: &Range<usize>| {
            let start = a.start.max(b.start);
            start..a.end.min(b.end).max(start)
        };
        Region {
            rows: overlap(&self.rows, &other.rows),
            columns: overlap(&self.columns, &other.columns),
        }
    }
}

/// A rectangle of an image's pixels; only they are rendered.
///
/// A crop changes nothing else: pixels keep their numbers, rays and bits. (A camera with a smaller image has rays
/// that are rounded differently.)
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

    /// The first row behind the crop, and the first column behind it.
    fn end(&self) -> [u64; 2] {
        [(self.row, self.height), (self.column, self.width)]
            .map(|(first, count)| u64::from(first) + u64::from(count))
    }

    /// Its samples on the raster of the whole image, for `samples` × `samples` samples a pixel.
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

/// A range cut at the multiples of a number.
fn pieces(range: &Range<usize>, side: usize) -> impl Iterator<Item = Range<usize>> + Clone + use<> {
    let Range { start, end } = *range;
    let first = start / side * side;
    (first..end).step_by(side).map(move |piece| piece.max(start)..end.min(piece + side))
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
