//! One level of a pyramid of pictures.

use glam::Vec3;

/// A picture of some size.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    pub(super) width: usize,
    /// Linear red, green and blue in 0 … 1, row by row from the top.
    pub(super) texels: Vec<Vec3>,
}

impl Level {
    /// Its width and its height, in texels.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.texels.len() / self.width]
    }

    /// Linear red, green and blue in 0 … 1, row by row from the top.
    pub fn texels(&self) -> &[Vec3] {
        &self.texels
    }

    /// The texel in a row and a column, both counted from the upper left corner.
    #[inline]
    pub(crate) fn texel(&self, row: usize, column: usize) -> Vec3 {
        self.texels[row * self.width + column]
    }
}
