//! How the picture is cut into tiles.

use crate::fast::camera_map::CameraMap;
use bothways_common::raster::Region;

/// Each thread should get so many tiles, so that all end at about the same time.
const TILES_A_THREAD: usize = 5;

/// The logarithms of a tile's rows and columns, for a region that so many threads draw: the usual ones, or half of them where
/// there would be too few tiles. Smaller tiles than that would cost more than the threads gain, as clusters lie in several.
pub(crate) fn tile_for_threads(usual: [u32; 2], threads: usize, region: &Region) -> [u32; 2] {
    let are_enough = |[rows, columns]: [u32; 2]| {
        region.tiles(1 << rows, 1 << columns).count() >= threads.saturating_mul(TILES_A_THREAD)
    };
    let [rows, columns] = usual;
    let (low, narrow) = (rows.saturating_sub(1), columns.saturating_sub(1));
    let sizes = [usual, [rows, narrow], [low, narrow]];
    sizes.into_iter().find(|size| are_enough(*size)).unwrap_or(sizes[2])
}

/// How the picture is cut into tiles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tiling {
    /// Rows and columns of a tile.
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// The logarithms of both, before they were cut to the picture.
    row_bits: u32,
    column_bits: u32,
    /// Of the picture's tiles, those that hold what is drawn: the first and the last row of them, and the first and
    /// the last in a row.
    tile_rows: [u32; 2],
    tile_columns: [u32; 2],
    /// How many of them are in a row.
    across: u32,
    /// The index of the first drawn tile, if every row of the picture had `across` tiles.
    first_tile: u32,
    /// The first and the last sample that is drawn: row and column, as a vertex has them.
    pub(crate) first: [i32; 4],
    pub(crate) last: [i32; 4],
}

impl Tiling {
    /// Tiles of `2^row_bits` by `2^column_bits` samples, of which those are drawn that hold a region.
    pub(crate) fn new(
        map: &CameraMap,
        [row_bits, column_bits]: [u32; 2],
        region: &Region,
    ) -> Tiling {
        let (height, width) = (map.grid.height(), map.grid.width());
        let (rows, columns) = (height.min(1 << row_bits), width.min(1 << column_bits));
        let number = |place: usize| i32::try_from(place).expect("at most 65,536 samples");
        let first = [region.rows.start, region.columns.start].map(number);
        let last = [region.rows.end - 1, region.columns.end - 1].map(number);
        let tiles = |axis: usize, bits: u32| {
            [first[axis].cast_unsigned() >> bits, last[axis].cast_unsigned() >> bits]
        };
        let (tile_rows, tile_columns) = (tiles(0, row_bits), tiles(1, column_bits));
        let across = tile_columns[1] - tile_columns[0] + 1;
        Tiling {
            rows,
            columns,
            row_bits,
            column_bits,
            tile_rows,
            tile_columns,
            across,
            first_tile: tile_rows[0] * across + tile_columns[0],
            first: [first[0], first[1], 0, 0],
            last: [last[0], last[1], 0, 0],
        }
    }

    /// How many tiles are drawn.
    pub(crate) fn count(&self) -> usize {
        let down = self.tile_rows[1] - self.tile_rows[0] + 1;
        (self.across * down) as usize
    }

    /// The samples that are drawn.
    pub(crate) fn region(&self) -> Region {
        let range = |axis: usize| {
            let [first, last] = [self.first[axis], self.last[axis]].map(i32::cast_unsigned);
            first as usize..last as usize + 1
        };
        Region { rows: range(0), columns: range(1) }
    }

    /// The number of the drawn tile in this row and column of the picture's tiles.
    #[inline(always)]
    fn tile(&self, row: u32, column: u32) -> usize {
        (row * self.across + column - self.first_tile) as usize
    }

    /// The numbers of the tiles that are drawn and that meet a box of samples: first and last row, first and last
    /// column.
    pub(crate) fn tiles<T: Into<u32>>(
        &self,
        bounds: [[T; 2]; 2],
    ) -> impl Iterator<Item = usize> + use<'_, T> {
        let [rows, columns] = bounds.map(|ends| ends.map(Into::into));
        let within = |[first, last]: [u32; 2], bits: u32, drawn: [u32; 2]| {
            (first >> bits).max(drawn[0])..=(last >> bits).min(drawn[1])
        };
        let rows = within(rows, self.row_bits, self.tile_rows);
        let columns = within(columns, self.column_bits, self.tile_columns);
        rows.flat_map(move |row| columns.clone().map(move |column| self.tile(row, column)))
    }

    /// The number of the only tile that a box meets, one that is drawn; `None` if the box meets several.
    #[inline(always)]
    pub(crate) fn only_tile(&self, [rows, columns]: [[u32; 2]; 2]) -> Option<usize> {
        let [row, column] = [rows[0] >> self.row_bits, columns[0] >> self.column_bits];
        let is_only = row == rows[1] >> self.row_bits && column == columns[1] >> self.column_bits;
        is_only.then(|| self.tile(row, column))
    }
}
