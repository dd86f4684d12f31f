//! Where clusters and instances may be seen.

use crate::fast::vertices::FixedPointRaster;
use bothways_common::raster::Region;

/// Where something may be seen, and how near it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// First and last row, first and last column.
    pub(crate) bounds: [[u16; 2]; 2],
    /// No depth key in it is larger, except for rounding.
    pub(crate) nearest: f32,
}

impl Extent {
    /// The samples that are in it.
    pub(crate) fn region(&self) -> Region {
        let range = |[first, last]: [u16; 2]| first.into()..usize::from(last) + 1;
        let [rows, columns] = self.bounds;
        Region { rows: range(rows), columns: range(columns) }
    }

    /// Of what may be seen anywhere, and as near as can be.
    pub(crate) fn anywhere(raster: &FixedPointRaster) -> Extent {
        let last = raster.size.map(|size| u16::try_from(size - 1).expect("at most 65,536 samples"));
        Extent { bounds: last.map(|last| [0, last]), nearest: f32::INFINITY }
    }
}
