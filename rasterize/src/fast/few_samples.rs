//! Triangles over few samples: sixteen triangles at a time, each testing one of its samples.

use super::fragments::{Fragments, leave_open};
use super::lanes::{in_all_lanes, lanes_of};
use super::picture::Picture;
use super::setup::Setup;
use super::tile::TileBuffer;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdInt, SimdMask, f32x16, i32x16, mask32x16, u32x16,
};
use bothways_common::look::lanes::each;
use bothways_common::observe::Events;

/// Draws sixteen triangles, as far as they lie in the tile.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    setup: &Setup,
    picture: &Picture,
    fragments: &mut Fragments,
    buffer: &mut TileBuffer,
) {
    let simd = context.simd();
    let ids = u32x16::load_array_ref(simd, &setup.ids);
    let load = |lanes: &[f32; 16]| f32x16::load_array_ref(simd, lanes);
    let edges: [_; 3] = std::array::from_fn(|k| {
        (load(&setup.at_origin[k]), load(&setup.across[k]), load(&setup.down[k]))
    });
    let error = load(&setup.error);
    let key = [load(&setup.key[0]), load(&setup.key[1]), load(&setup.key[2])];
    let Scan { left, right, top, mut index, mut remaining, to_next_row } =
        Scan::new(simd, setup, buffer);
    let one = i32x16::splat(simd, 1);
    let (first, end) = (left.to_float::<f32x16<C::Simd>>(), right.to_float::<f32x16<C::Simd>>());
    let (mut row, mut column) = (top.to_float::<f32x16<C::Simd>>(), first);
    let mut steps = 0;
    loop {
        let active = remaining.simd_gt(i32x16::splat(simd, 0));
        if !active.any_true() {
            break;
        }
        steps += 1;
        let values = each!(k in [0, 1, 2] => {
            let (at_origin, across, down) = edges[k];
            (at_origin + down * row) + across * column
        });
        let least = values[0].min(values[1]).min(values[2]);
        let inside = active & least.simd_gt(error);
        let perhaps = active & least.simd_ge(-error);
        let keys = (key[0] + key[2] * row) + key[1] * column;
        if C::WATCHED {
            emit_tests(context, setup, buffer, active, &index.to_array(), &values);
        }
        fragments.add(index, keys, ids, inside);
        let open = (perhaps & !inside).to_bitmask();
        if open != 0 {
            let fragments = (&setup.ids, &index.to_array(), &keys.to_array());
            leave_open(&mut context.scalar(), picture, buffer, open, fragments);
        }
        // On to the next sample of each box, row by row.
        column += f32x16::splat(simd, 1.0);
        let wraps = column.simd_ge(end);
        column = wraps.select(first, column);
        row += wraps.select(f32x16::splat(simd, 1.0), f32x16::splat(simd, 0.0));
        index += wraps.select(to_next_row, one);
        remaining -= one;
    }
    buffer.executed.lane_steps += steps;
    fragments.test_depth(context, picture, buffer);
}

/// The samples of sixteen boxes that lie in the tile, row by row.
struct Scan<S: Simd> {
    /// The first column, the one behind the last, and the first row, each counted within its box.
    left: i32x16<S>,
    right: i32x16<S>,
    top: i32x16<S>,
    /// The index of the first sample in the tile, and the step from the last of a row to the first of the next.
    index: i32x16<S>,
    to_next_row: i32x16<S>,
    /// How many samples.
    remaining: i32x16<S>,
}

impl<S: Simd> Scan<S> {
    #[inline(always)]
    fn new(simd: S, setup: &Setup, buffer: &TileBuffer) -> Self {
        let splat = |samples: usize| in_all_lanes(simd, samples);
        let load = |lanes: &[i32; 16]| i32x16::load_array_ref(simd, lanes);
        let zero = splat(0);
        let (tile, stride) = (buffer.region(), splat(buffer.stride()));
        let (row, column) = (load(&setup.first_row), load(&setup.first_column));
        let left = (splat(tile.columns.start) - column).max(zero);
        let right = (splat(tile.columns.end) - column).min(load(&setup.columns));
        let top = (splat(tile.rows.start) - row).max(zero);
        let bottom = (splat(tile.rows.end) - row).min(load(&setup.rows));
        let (height, width) = ((bottom - top).max(zero), (right - left).max(zero));
        let first_row = row + top - splat(tile.rows.start);
        Scan {
            left,
            right,
            top,
            index: first_row * stride + column + left - splat(tile.columns.start),
            to_next_row: stride - width + splat(1),
            remaining: width * height,
        }
    }
}

/// Emits the tests of one step.
#[inline(always)]
fn emit_tests<C: Context>(
    context: &mut C,
    setup: &Setup,
    buffer: &TileBuffer,
    active: mask32x16<C::Simd>,
    index: &[i32; 16],
    values: &[f32x16<C::Simd>; 3],
) {
    if let Some(counts) = context.sink().counts() {
        counts.tests += u64::from(active.to_bitmask().count_ones());
        return;
    }
    let values = values.map(SimdBase::to_array);
    for lane in lanes_of(active.to_bitmask()) {
        let at = index[lane].cast_unsigned() as usize;
        let edges = values.map(|values| values[lane]);
        setup.triangle(lane).emit_test(context.sink(), &buffer.names, buffer.sample(at), edges);
    }
}
