//! Pictures that surfaces are covered with.

mod level;
mod mipmaps;

pub use level::Level;

use glam::Vec3;
use std::sync::Arc;

/// A picture, and how it is read between and beyond its texels.
///
/// The texture coordinate (0, 0) is the lower left corner of the picture, and (1, 1) the upper right one.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The picture; several textures may share it.
    pub pyramid: Arc<Pyramid>,
    /// How it is read.
    pub sampler: Sampler,
}

/// A picture in linear light, and behind it smaller and smaller ones, down to a single texel.
///
/// Each is half as wide and half as high as the one before it, rounded down, and each of its texels is the average over
/// the area that it covers there: a box filter, in linear light.
///
/// Williams, "Pyramidal Parametrics", SIGGRAPH 1983.
#[derive(Clone, Debug, PartialEq)]
pub struct Pyramid {
    levels: Vec<Level>,
}

/// How a texture is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampler {
    /// Where a texel is larger than a sample.
    pub magnified: Filter,
    /// Where a texel is smaller than a sample.
    pub minified: Filter,
    /// From which of the smaller pictures, where a texel is smaller than a sample.
    pub levels: Levels,
    /// What is seen beyond the picture, across and up.
    pub wrap: [Wrap; 2],
    /// Pictures to one unit of the texture coordinate, across and up; positive.
    pub tiles: [f32; 2],
}

/// How a picture is read between its texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The texel that the place lies in.
    Nearest,
    /// The four texels around the place, weighted by their nearness.
    Bilinear,
}

/// Which of the smaller pictures of a [`Pyramid`] are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// None: the picture itself is read.
    One,
    /// The one whose texels are nearest to a sample's size.
    Nearest,
    /// The two around a sample's size, weighted by their nearness.
    Blended,
}

/// What is seen beyond a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    Repeat,
    /// The texels of its border.
    Clamp,
    /// The picture again, every second one mirrored.
    Mirror,
}

impl Sampler {
    /// The nearest texel of a picture that is repeated.
    pub const NEAREST: Sampler = Sampler {
        magnified: Filter::Nearest,
        minified: Filter::Nearest,
        levels: Levels::One,
        wrap: [Wrap::Repeat; 2],
        tiles: [1.0; 2],
    };
    /// Between the four texels around a place of a picture that is repeated.
    pub const BILINEAR: Sampler =
        Sampler { magnified: Filter::Bilinear, minified: Filter::Bilinear, ..Sampler::NEAREST };
    /// The same, also between two levels where texels are smaller than samples.
    pub const MIPMAPS: Sampler = Sampler { levels: Levels::Blended, ..Sampler::BILINEAR };
}

impl Sampler {
    /// Whether it matters how large a sample is on the texture.
    pub fn has_footprint(&self) -> bool {
        self.levels != Levels::One || self.magnified != self.minified
    }
}

impl Pyramid {
    /// A picture of linear red, green and blue in 0 … 1, row by row from the top, and its smaller ones.
    ///
    /// # Panics
    ///
    /// If there are no texels, or not the same number in each row.
    pub fn new(width: usize, texels: Vec<Vec3>) -> Pyramid {
        let is_picture = width > 0 && !texels.is_empty() && texels.len().is_multiple_of(width);
        assert!(is_picture, "{} texels make no rows of {width}", texels.len());
        Pyramid { levels: mipmaps::levels(Level { width, texels }) }
    }

    /// The picture, and behind it the smaller ones.
    pub fn levels(&self) -> &[Level] {
        &self.levels
    }
}
