//! Where a file differs from a picture.

use super::convention::Placement;
use super::encoding::Encoding;
use super::expected::Expected;
use super::observed::Observed;

/// Where the file differs from a picture.
pub(super) struct Differences<'a> {
    pub(super) expected: &'a Expected<'a>,
    pub(super) observed: &'a Observed,
    pub(super) encoding: Encoding,
    /// Whether it does, for each pixel of the picture, row by row.
    pub(super) differs: Vec<bool>,
    /// Whether it shows anything there.
    pub(super) shows: Vec<bool>,
}

impl<'a> Differences<'a> {
    pub(super) fn new(
        expected: &'a Expected<'a>,
        observed: &'a Observed,
        placement: Placement,
        encoding: Encoding,
    ) -> Differences<'a> {
        let pixels = expected.drawn.ids.len();
        let (mut differs, mut shows) = (Vec::with_capacity(pixels), Vec::with_capacity(pixels));
        expected.each(observed, placement, &encoding, |index, is_other, _| {
            differs.push(is_other);
            shows.push(observed.covered(index, encoding.nothing));
        });
        Differences { expected, observed, encoding, differs, shows }
    }

    /// Whether the file shows nothing at a pixel where something should be seen.
    pub(super) fn is_lost(&self, pixel: usize) -> bool {
        self.differs[pixel] && !self.shows[pixel]
    }

    /// Whether all differences lie in one row or one column.
    pub(super) fn is_one_line(&self) -> bool {
        let width = self.expected.view.camera.image()[0] as usize;
        let mut pixels = (0..self.differs.len()).filter(|&pixel| self.differs[pixel]);
        let Some(first) = pixels.next() else { return true };
        let (mut rows, mut columns) = (false, false);
        for pixel in pixels {
            rows |= pixel / width != first / width;
            columns |= pixel % width != first % width;
            if rows && columns {
                return false;
            }
        }
        true
    }
}
