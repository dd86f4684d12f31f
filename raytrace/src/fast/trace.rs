//! Traces the rays of tiles: those of a picture and any other ray alike, so that the walk is not compiled for each.

use super::search::tile_frustum::FrustumTemplate;
use super::search::walk::Walker;
use super::store::{prefetch_rows, store};
use super::tile::TileBuffer;
use bothways_common::engine::context::LoopContext;
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{apart, dispatch_with};
use bothways_common::observe::Executed;
use bothways_common::raster::Region;
use std::ops::Range;

/// Takes a tile that was traced, the names of a region, and which of its samples are the tile's.
pub(super) type StoreIds<'a> = dyn FnMut(&TileBuffer, &[&mut [u32]], &Region) + 'a;

/// Traces the rays of the tiles that meet a region, and stores names and distances, row by row. After every tile, `done`
/// gets the names and the samples of the tile that lie in the region.
pub(super) fn trace_tiles<F: Fault>(
    walker: &mut Walker,
    template: &FrustumTemplate,
    region: &Region,
    (names, t): (&mut [&mut [u32]], &mut [&mut [f32]]),
    done: &mut StoreIds,
) -> Executed {
    let mut executed = Executed::default();
    let (map, side) = (walker.map, template.side);
    let tiles = |range: &Range<usize>| (range.start / side * side..range.end).step_by(side);
    dispatch_with!(F, walker.prepared.level, simd => {
        for top in tiles(&region.rows) {
            for left in tiles(&region.columns) {
                let size = [map.grid.height() - top, map.grid.width() - left];
                let size = size.map(|count| count.min(side));
                let [rows, columns] = [top..top + size[0], left..left + size[1]];
                let drawn = region.intersection(&Region { rows, columns });
                prefetch_rows(region, &drawn, names, t);
                walker.walk(&mut LoopContext::<_, (), F>::of(simd, &mut ()), template, [top, left], size);
                apart!(simd, store(simd, map, &walker.tile, (region, &drawn), names, t));
                done(&walker.tile, names, &drawn);
                executed += walker.tile.executed.of_one_tile();
            }
        }
    });
    executed
}
