//! Writes the ids and distances of a tile into a frame.

use super::camera_map::CameraMap;
use super::distances::find_distances;
use super::tile::{BLOCK, TileBuffer, place};
use bothways_common::Projection;
use bothways_common::engine::simd::{Select, Simd, SimdBase, SimdMask, f32x16, u32x16};
use bothways_common::frame::{NO_PRIMITIVE, NO_WIDE_PRIMITIVE};
use bothways_common::raster::Region;
use std::ops::Range;

/// Writes as much of a tile as a region of a frame holds.
#[inline(always)]
pub(super) fn store<S: Simd>(
    simd: S,
    map: &CameraMap,
    tile: &TileBuffer,
    region: &Region,
    ids: &mut [&mut [u32]],
    t: &mut [&mut [f32]],
) {
    // What the region holds of the tile, counted from the tile's first row and column.
    let held = |axis: usize, of: &Range<usize>| {
        let (first, count) = (tile.start[axis], tile.size[axis]);
        of.start.saturating_sub(first)..(of.end - first).min(count)
    };
    let (rows, columns) = (held(0, &region.rows), held(1, &region.columns));
    let [top, left] = tile.start;
    let line = |row: usize| row + top - region.rows.start;
    let place_in_line = |column: usize| column + left - region.columns.start;
    if !tile.touched {
        let columns = place_in_line(columns.start)..place_in_line(columns.end);
        for row in rows.map(line) {
            ids[row][columns.clone()].fill(NO_PRIMITIVE);
            t[row][columns.clone()].fill(f32::INFINITY);
        }
        return;
    }
    if tile.side() < BLOCK {
        let (mut shown, mut far) = ([0; 16], [0.0; 16]);
        block_values(simd, map, tile, 0, &mut shown, &mut far);
        ids[line(0)][place_in_line(0)] = shown[0];
        t[line(0)][place_in_line(0)] = far[0];
        return;
    }
    for block in 0..tile.blocks() {
        let [top, left] = place(tile.side(), block * 16);
        let rows = top.max(rows.start)..rows.end.min(top + BLOCK);
        let columns = left.max(columns.start)..columns.end.min(left + BLOCK);
        if rows.is_empty() || columns.is_empty() {
            continue;
        }
        let (mut shown, mut far) = ([0; 16], [0.0; 16]);
        block_values(simd, map, tile, block, &mut shown, &mut far);
        let (wide, start) = (columns.len(), place_in_line(columns.start));
        for row in rows {
            let from = (row - top) * BLOCK + columns.start - left;
            let (ids, t) = (&mut ids[line(row)], &mut t[line(row)]);
            if wide == BLOCK {
                ids[start..start + BLOCK].copy_from_slice(&shown[from..from + BLOCK]);
                t[start..start + BLOCK].copy_from_slice(&far[from..from + BLOCK]);
            } else {
                ids[start..start + wide].copy_from_slice(&shown[from..from + wide]);
                t[start..start + wide].copy_from_slice(&far[from..from + wide]);
            }
        }
    }
}

/// Writes the wide ids of the samples that were drawn in a tile, from their names; both cover a region.
pub(super) fn store_wide_ids(
    tile: &TileBuffer,
    region: &Region,
    drawn: &Region,
    names: &[&mut [u32]],
    ids: &mut [&mut [u64]],
) {
    let columns =
        drawn.columns.start - region.columns.start..drawn.columns.end - region.columns.start;
    for row in drawn.rows.clone() {
        let line = row - region.rows.start;
        let to = &mut ids[line][columns.clone()];
        for (id, &name) in to.iter_mut().zip(&names[line][columns.clone()]) {
            *id = if name == NO_PRIMITIVE { NO_WIDE_PRIMITIVE } else { tile.names.id(name) };
        }
    }
}

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
    const NARROW: f32 = 1.5e-6;
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
