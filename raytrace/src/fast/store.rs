//! Writes the ids and distances of a tile into a frame.

use super::camera_map::CameraMap;
use super::distances::find_distances;
use super::tile::{BLOCK, TileBuffer, place};
use bothways_common::Projection;
use bothways_common::engine::simd::{
    Bytes, Select, Simd, SimdBase, SimdCombine, SimdMask, SimdSplit, f32x16, prefetch, u32x16,
};
use bothways_common::frame::{NO_PRIMITIVE, NO_WIDE_PRIMITIVE};
use bothways_common::look::lanes::each;
use bothways_common::raster::Region;
use std::ops::Range;

/// Asks the machine for the memory of those samples of a region that are traced next, before [`store`] writes it. The machine
/// does not guess where that is, as the rows of a tile are far from each other.
pub(super) fn prefetch_rows(region: &Region, next: &Region, ids: &[&mut [u32]], t: &[&mut [f32]]) {
    if next.is_empty() {
        return;
    }
    let [rows, columns] = counted_from(region, next);
    // The columns of a tile lie in two lines of the cache, or in three.
    let at = [columns.start, columns.end.min(columns.start + 16) - 1, columns.end - 1];
    for (ids, t) in ids[rows.clone()].iter().zip(&t[rows]) {
        for at in at {
            prefetch(&ids[at]);
            prefetch(&t[at]);
        }
    }
}

/// Rows and columns of the picture, counted from the first ones of a region that holds them.
fn counted_from(region: &Region, Region { rows, columns }: &Region) -> [Range<usize>; 2] {
    let [first_row, first_column] = [region.rows.start, region.columns.start];
    [
        rows.start - first_row..rows.end - first_row,
        columns.start - first_column..columns.end - first_column,
    ]
}

/// Writes some samples of a tile into a region of a frame: those that are `drawn`, all of which lie in the region.
#[inline(always)]
pub(super) fn store<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    (region, drawn): (&Region, &Region),
    ids: &mut [&mut [u32]],
    t: &mut [&mut [f32]],
) {
    if drawn.is_empty() {
        return;
    }
    if !tile.touched {
        let [rows, columns] = counted_from(region, drawn);
        for (ids, t) in ids[rows.clone()].iter_mut().zip(&mut t[rows]) {
            ids[columns.clone()].fill(NO_PRIMITIVE);
            t[columns.clone()].fill(f32::INFINITY);
        }
        return;
    }
    // Four blocks beside each other at a time: whole lines of the cache, if a row begins with one. The tile of a ray alone has one block,
    // and nothing beside it.
    for first in (0..tile.blocks()).step_by(4) {
        let [top, left] = place(tile.side(), first * 16);
        let [top, left] = [tile.start[0] + top, tile.start[1] + left];
        let strip = Region { rows: top..top + BLOCK, columns: left..left + 4 * BLOCK };
        let here = drawn.intersection(&strip);
        if here.is_empty() {
            continue;
        }
        let (from, wide) = (here.columns.start - left, here.columns.len());
        let [shown, far] = values_of_four(simd, map, tile, first, from..from + wide);
        let [rows, columns] = counted_from(region, &here);
        let lines = ids[rows.clone()].iter_mut().zip(&mut t[rows]);
        for (row, (ids, t)) in (here.rows.start - top..).zip(lines) {
            let (ids, t) = (&mut ids[columns.clone()], &mut t[columns.clone()]);
            let (shown, far) = (shown[row % BLOCK].bitcast::<u32x16<S>>(), far[row % BLOCK]);
            if wide == 4 * BLOCK {
                shown.store_slice(ids);
                far.store_slice(t);
            } else {
                ids.copy_from_slice(&shown.to_array()[from..from + wide]);
                t.copy_from_slice(&far.to_array()[from..from + wide]);
            }
        }
    }
}

/// The ids, as the bits of `f32`, and the distances of four blocks beside each other, row by row; anything in blocks that hold
/// none of the columns.
#[inline(always)]
fn values_of_four<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    first: usize,
    columns: Range<usize>,
) -> [[f32x16<S>; 4]; 2] {
    let blocks = each!(k in [0, 1, 2, 3] => {
        let (mut shown, mut far) = ([0; 16], [0.0; 16]);
        if BLOCK * k < columns.end && columns.start < BLOCK * (k + 1) {
            block_values(simd, map, tile, first + k, &mut shown, &mut far);
        }
        [u32x16::load_array(simd, shown).bitcast(), f32x16::load_array(simd, far)]
    });
    each!(of in [0, 1] => rows_of_four(each!(k in [0, 1, 2, 3] => blocks[k][of])))
}

/// The rows of four blocks beside each other.
#[inline(always)]
fn rows_of_four<S: Simd>(blocks: [f32x16<S>; 4]) -> [f32x16<S>; 4] {
    let parts = each!(k in [0, 1, 2, 3] => {
        let (upper, lower) = blocks[k].split();
        let ((a, b), (c, d)) = (upper.split(), lower.split());
        [a, b, c, d]
    });
    each!(row in [0, 1, 2, 3] => {
        let [a, b, c, d] = each!(k in [0, 1, 2, 3] => parts[k][row]);
        a.combine(b).combine(c.combine(d))
    })
}

/// Writes the wide ids of the samples that were drawn in a tile, from their names; both cover a region.
pub(super) fn store_wide_ids(
    tile: &TileBuffer,
    region: &Region,
    drawn: &Region,
    names: &[&mut [u32]],
    ids: &mut [&mut [u64]],
) {
    let [rows, columns] = counted_from(region, drawn);
    for row in rows {
        let to = &mut ids[row][columns.clone()];
        for (id, &name) in to.iter_mut().zip(&names[row][columns.clone()]) {
            *id = if name == NO_PRIMITIVE { NO_WIDE_PRIMITIVE } else { tile.names.id(name) };
        }
    }
}

/// A key's interval is narrow if it is no longer than this part of its middle.
pub(super) const NARROW: f32 = 1.5e-6;

/// The ids and distances of a block. A distance is taken from the middle of its key's interval if that is
/// narrow: within 0.75·10⁻⁶ of the true one, and three roundings of `ε₂₄`.
#[inline(always)]
fn block_values<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    block: usize,
    ids: &mut [u32; 16],
    t: &mut [f32; 16],
) {
    let from = block * 16;
    let low = f32x16::from_slice(simd, &tile.low[from..from + 16]);
    let high = f32x16::from_slice(simd, &tile.high[from..from + 16]);
    let nothing = high.simd_eq(f32x16::splat(simd, f32::NEG_INFINITY));
    let middle = low * 0.5 + high * 0.5;
    #[expect(clippy::cast_possible_truncation, reason = "one of the roundings")]
    let scale = map.depth.scale as f32;
    let distance = match map.depth.projection {
        Projection::Perspective => f32x16::splat(simd, 1.0 / scale) / middle,
        Projection::Parallel => -middle * (1.0 / scale),
    };
    // Far from overflow and underflow.
    const ORDINARY: Range<f32> = 1e-30..1e30;
    let plain = ORDINARY.contains(&scale);
    let sure = (high - low).simd_le(middle.abs() * NARROW)
        & distance.simd_gt(f32x16::splat(simd, ORDINARY.start))
        & distance.simd_lt(f32x16::splat(simd, ORDINARY.end));
    let seen = u32x16::from_slice(simd, &tile.ids[from..from + 16]);
    nothing.select(u32x16::splat(simd, NO_PRIMITIVE), seen).store_array(ids);
    nothing.select(f32x16::splat(simd, f32::INFINITY), distance).store_array(t);
    let unsure = if plain { !(sure | nothing) } else { !nothing };
    if unsure.any_true() {
        find_distances(map, tile, from, unsure.to_bitmask(), ids, t);
    }
}
