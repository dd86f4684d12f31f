//! The ids of a frame: of 32 bits, or of 64 where a scene has more primitives.

use crate::engine::memory::filled;
use crate::engine::simd::prefetch_all;
use crate::raster::Region;
use std::ops::Range;

/// The number that an id buffer stores for "no primitive"; [`Frame::id`](super::Frame::id) says `None`.
pub const NO_PRIMITIVE: u32 = u32::MAX;
/// The same where ids do not fit into 32 bits: see [`Ids`].
pub const NO_WIDE_PRIMITIVE: u64 = u64::MAX;

/// Ids of samples, one after another. They are narrow wherever the ids of the scene fit into 32 bits.
///
/// Two are equal if the same primitives are seen.
#[derive(Clone, Copy, Debug)]
pub enum Ids<'a> {
    /// Ids of 32 bits; [`NO_PRIMITIVE`] for nothing.
    Narrow(&'a [u32]),
    /// Ids of 64 bits; [`NO_WIDE_PRIMITIVE`] for nothing.
    Wide(&'a [u64]),
}

impl<'a> Ids<'a> {
    /// How many samples there are.
    pub fn len(self) -> usize {
        match self {
            Ids::Narrow(ids) => ids.len(),
            Ids::Wide(ids) => ids.len(),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }

    /// The id at a sample; `None` for nothing.
    ///
    /// # Panics
    ///
    /// If there is no such sample.
    #[inline]
    pub fn get(self, sample: usize) -> Option<u64> {
        match self {
            Ids::Narrow(ids) => Some(ids[sample]).filter(|id| *id != NO_PRIMITIVE).map(u64::from),
            Ids::Wide(ids) => Some(ids[sample]).filter(|id| *id != NO_WIDE_PRIMITIVE),
        }
    }

    /// Whether something is seen at a sample.
    ///
    /// # Panics
    ///
    /// If there is no such sample.
    #[inline]
    pub fn is_covered(self, sample: usize) -> bool {
        match self {
            Ids::Narrow(ids) => ids[sample] != NO_PRIMITIVE,
            Ids::Wide(ids) => ids[sample] != NO_WIDE_PRIMITIVE,
        }
    }

    /// The ids of all samples; `None` for nothing.
    pub fn iter(
        self,
    ) -> impl ExactSizeIterator<Item = Option<u64>> + DoubleEndedIterator + Clone + use<'a> {
        (0..self.len()).map(move |sample| self.get(sample))
    }

    /// The ids of some samples.
    ///
    /// # Panics
    ///
    /// If there are no such samples.
    #[must_use]
    pub fn of(self, samples: Range<usize>) -> Ids<'a> {
        match self {
            Ids::Narrow(ids) => Ids::Narrow(&ids[samples]),
            Ids::Wide(ids) => Ids::Wide(&ids[samples]),
        }
    }

    /// Asks the machine for the ids of some samples before use.
    #[inline(always)]
    pub(crate) fn prefetch(self, samples: Range<usize>) {
        match self {
            Ids::Narrow(ids) => prefetch_all(&ids[samples]),
            Ids::Wide(ids) => prefetch_all(&ids[samples]),
        }
    }

    /// The ids of so many samples at a time, the last time perhaps of fewer.
    ///
    /// # Panics
    ///
    /// If `size` is 0.
    pub fn chunks(self, size: usize) -> impl ExactSizeIterator<Item = Ids<'a>> + use<'a> {
        let count = self.len().div_ceil(size);
        (0..count).map(move |k| self.of(k * size..self.len().min((k + 1) * size)))
    }

    /// At how many samples something is seen.
    pub fn covered(self) -> usize {
        match self {
            Ids::Narrow(ids) => ids.iter().filter(|&&id| id != NO_PRIMITIVE).count(),
            Ids::Wide(ids) => ids.iter().filter(|&&id| id != NO_WIDE_PRIMITIVE).count(),
        }
    }

    /// The ids of 32 bits, [`NO_PRIMITIVE`] for nothing; `None` if they are wider.
    pub fn narrow(self) -> Option<&'a [u32]> {
        match self {
            Ids::Narrow(ids) => Some(ids),
            Ids::Wide(_) => None,
        }
    }
}

impl PartialEq for Ids<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Ids::Narrow(one), Ids::Narrow(other)) => one == other,
            (Ids::Wide(one), Ids::Wide(other)) => one == other,
            _ => self.iter().eq(other.iter()),
        }
    }
}

impl Eq for Ids<'_> {}

/// The ids of a tile that one thread may write, a slice for each row.
#[derive(Debug)]
pub enum IdRows<'a> {
    /// Ids of 32 bits; [`NO_PRIMITIVE`] for nothing.
    Narrow(Vec<&'a mut [u32]>),
    /// Ids of 64 bits; [`NO_WIDE_PRIMITIVE`] for nothing.
    Wide(Vec<&'a mut [u64]>),
}

impl<'a> IdRows<'a> {
    /// The rows of 32 bits, for those who draw no scene of wider ids.
    ///
    /// # Panics
    ///
    /// If they are wider.
    pub fn narrow(self) -> Vec<&'a mut [u32]> {
        match self {
            IdRows::Narrow(rows) => rows,
            IdRows::Wide(_) => panic!("the ids of this scene have 64 bits"),
        }
    }

    /// Nothing is seen.
    pub fn clear(&mut self) {
        match self {
            IdRows::Narrow(rows) => rows.iter_mut().for_each(|row| row.fill(NO_PRIMITIVE)),
            IdRows::Wide(rows) => rows.iter_mut().for_each(|row| row.fill(NO_WIDE_PRIMITIVE)),
        }
    }
}

/// The ids that a frame stores.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum IdPlane {
    Narrow(Vec<u32>),
    Wide(Vec<u64>),
}

impl IdPlane {
    /// Makes room for so many ids, wide ones or not; keeps what is there if it fits.
    pub(super) fn fit(&mut self, count: usize, are_wide: bool) {
        match self {
            IdPlane::Narrow(ids) if !are_wide && ids.len() == count => {}
            IdPlane::Wide(ids) if are_wide && ids.len() == count => {}
            _ if are_wide => *self = IdPlane::Wide(vec![NO_WIDE_PRIMITIVE; count]),
            _ => *self = IdPlane::Narrow(filled(NO_PRIMITIVE, count)),
        }
    }

    pub(super) fn clear(&mut self) {
        match self {
            IdPlane::Narrow(ids) => ids.fill(NO_PRIMITIVE),
            IdPlane::Wide(ids) => ids.fill(NO_WIDE_PRIMITIVE),
        }
    }

    pub(super) fn set(&mut self, index: usize, id: u64) {
        match self {
            IdPlane::Narrow(ids) => {
                ids[index] = u32::try_from(id).expect("the frame has room for narrow ids alone");
            }
            IdPlane::Wide(ids) => ids[index] = id,
        }
    }

    pub(super) fn as_ids(&self) -> Ids<'_> {
        match self {
            IdPlane::Narrow(ids) => Ids::Narrow(ids),
            IdPlane::Wide(ids) => Ids::Wide(ids),
        }
    }

    /// The ids, cut into bands of so many rows of tiles' samples: see [`bands`].
    pub(super) fn bands(&mut self, region: &Region, rows: usize) -> Vec<IdBand<'_>> {
        match self {
            IdPlane::Narrow(ids) => {
                bands(ids, region, rows).into_iter().map(IdBand::Narrow).collect()
            }
            IdPlane::Wide(ids) => bands(ids, region, rows).into_iter().map(IdBand::Wide).collect(),
        }
    }
}

/// The ids of a band of a frame.
#[derive(Debug)]
pub(super) enum IdBand<'a> {
    Narrow(&'a mut [u32]),
    Wide(&'a mut [u64]),
}

impl<'a> IdBand<'a> {
    /// The ids of its tiles, from left to right.
    pub(super) fn cut(self, band: &Region, columns: usize) -> Vec<IdRows<'a>> {
        match self {
            IdBand::Narrow(ids) => {
                cut(ids, band, columns).into_iter().map(IdRows::Narrow).collect()
            }
            IdBand::Wide(ids) => cut(ids, band, columns).into_iter().map(IdRows::Wide).collect(),
        }
    }
}

/// Cuts a plane, which covers a region, into bands: one for each row of tiles of at most so many rows.
pub(super) fn bands<'a, T>(
    mut plane: &'a mut [T],
    region: &Region,
    rows: usize,
) -> Vec<&'a mut [T]> {
    let width = region.columns.len();
    let areas = region.bands(rows).map(|band| band.rows.len() * width);
    areas.map(|area| plane.split_off_mut(..area).expect("bands cover the frame")).collect()
}

/// Cuts a band into tiles of at most so many columns, from left to right: for each a slice for each row.
pub(super) fn cut<'a, T>(
    plane: &'a mut [T],
    band: &Region,
    columns: usize,
) -> Vec<Vec<&'a mut [T]>> {
    let width = band.columns.len();
    let (widths, mut tiles): (Vec<usize>, Vec<Vec<&mut [T]>>) = band
        .tiles(usize::MAX, columns)
        .map(|tile| (tile.columns.len(), Vec::with_capacity(tile.rows.len())))
        .unzip();
    for mut line in plane.chunks_mut(width) {
        for (tile, width) in tiles.iter_mut().zip(&widths) {
            tile.push(line.split_off_mut(..*width).expect("tiles are as wide as the frame"));
        }
    }
    tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn narrow_and_wide_ids_are_equal_where_they_show_the_same() {
        let narrow = [3, NO_PRIMITIVE, 0];
        let wide = [3, NO_WIDE_PRIMITIVE, 0];
        let (narrow, wide) = (Ids::Narrow(&narrow), Ids::Wide(&wide));
        assert_eq!(narrow, wide);
        assert_eq!([narrow.covered(), wide.covered()], [2, 2]);
        // This is the id of a primitive.
        let last = [3, u64::from(NO_PRIMITIVE), 0];
        assert_ne!(narrow, Ids::Wide(&last));
        assert_eq!(Ids::Wide(&last).get(1), Some(u64::from(NO_PRIMITIVE)));
        let pairs: Vec<usize> = wide.chunks(2).map(Ids::covered).collect();
        assert_eq!(pairs, [1, 1]);
    }

    #[test]
    fn a_plane_becomes_wide_and_narrow_again() {
        let mut plane = IdPlane::Narrow(vec![7; 2]);
        plane.fit(2, false);
        assert_eq!(plane.as_ids().get(0), Some(7));
        plane.fit(2, true);
        plane.set(1, 1 << 40);
        assert_eq!(plane.as_ids().iter().collect::<Vec<_>>(), [None, Some(1 << 40)]);
        plane.clear();
        plane.fit(2, false);
        assert_eq!(plane, IdPlane::Narrow(vec![NO_PRIMITIVE; 2]));
    }
}
