//! Where in a tile a box may be seen.

/// The rows and columns of a tile at which a box may be seen: the first and the last row, the first and the last column,
/// five bits each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TilePlace(u32);

impl TilePlace {
    /// All of a tile of any size.
    pub(crate) const ALL: TilePlace = TilePlace(TilePlace::WHOLE);
    /// The same as a whole number, which an `f32` holds, too.
    pub(super) const WHOLE: u32 = 31 << 5 | 31 << 15;
    pub(super) const WHOLE_TILE: f32 = TilePlace::LAST * 31.0 * (1.0 + TilePlace::COLUMN);
    /// As a whole number, a place is the sum of its first row, and of its last row, its first column and its last column
    /// times these numbers.
    pub(super) const LAST: f32 = 32.0;
    pub(super) const COLUMN: f32 = 1024.0;

    /// The first and the last row, and the first and the last column.
    #[inline(always)]
    pub(crate) fn ends(self) -> [[usize; 2]; 2] {
        let end = |from: u32| (self.0 >> from & 31) as usize;
        [[end(0), end(5)], [end(10), end(15)]]
    }

    /// The place that a whole number of 20 bits stands for: vectors hold it in an `f32`, which holds it exactly.
    #[inline(always)]
    pub(super) const fn from_whole_number(number: u32) -> TilePlace {
        TilePlace(number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_number_holds_four_ends() {
        assert_eq!(TilePlace::ALL.ends(), [[0, 31]; 2]);
        assert_eq!(TilePlace::WHOLE_TILE, TilePlace::WHOLE as f32);
        assert_eq!([TilePlace::LAST, TilePlace::COLUMN], [32.0, 1024.0]);
        let number = 3 + 7 * 32 + (30 + 31 * 32) * 1024;
        assert_eq!(TilePlace::from_whole_number(number).ends(), [[3, 7], [30, 31]]);
    }
}
