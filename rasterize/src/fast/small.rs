//! Triangles over few samples: sixteen triangles at a time, each testing one of its samples.

use super::setup::Setup;
use super::tile::TileBuffer;
use bothways_common::fault::Fault;
use bothways_common::observe::Observer;
use bothways_common::simd::{Select, Simd, SimdBase, SimdInt, SimdMask, f32x16, i32x16, mask32x16};

/// Boxes of at most this many samples are drawn together, apart from larger ones: sixteen triangles take
/// as long as the one with most samples.
pub(super) const VERY_FEW_SAMPLES: u32 = 4;
/// Boxes of at most this many samples are drawn here.
pub(super) const MOST_SAMPLES: u32 = 16;

/// Draws what of the triangles lies in the tile.
#[inline(always)]
pub(super) fn draw<S: Simd, O: Observer, F: Fault>(
    simd: S,
    setup: &Setup,
    buffer: &mut TileBuffer,
    observer: &mut O,
) {
    let load = |lanes: &[f32; 16]| f32x16::load_array_ref(simd, lanes);
    let edges: [_; 3] = std::array::from_fn(|k| {
        (load(&setup.at_origin[k]), load(&setup.across[k]), load(&setup.down[k]))
    });
    let error = load(&setup.error);
    let (key, key_b, key_c) = (load(&setup.key), load(&setup.key_b), load(&setup.key_c));
    let Walk { left, right, top, mut index, mut remaining, to_next_row } =
        Walk::new(simd, setup, buffer);
    let one = i32x16::splat(simd, 1);
    let (first, end) = (left.to_float::<f32x16<S>>(), right.to_float::<f32x16<S>>());
    let (mut column, mut row) = (first, top.to_float::<f32x16<S>>());
    loop {
        let active = remaining.simd_gt(i32x16::splat(simd, 0));
        if !active.any_true() {
            break;
        }
        let values: [f32x16<S>; 3] = std::array::from_fn(|k| {
            let (at_origin, across, down) = edges[k];
            (at_origin + down * row) + across * column
        });
        let least = values[0].min(values[1]).min(values[2]);
        let inside = active & least.simd_gt(error);
        let perhaps = active & least.simd_ge(-error);
        let keys = key + key_b * values[2] + key_c * values[0];
        if O::WATCHES {
            tell(setup, buffer, observer, active, &index.to_array(), &values, error);
        }
        let (mut fragments, perhaps) = (inside.to_bitmask(), perhaps.to_bitmask());
        if perhaps != 0 {
            let (index, keys) = (index.to_array(), keys.to_array());
            let mut open = perhaps & !fragments;
            while fragments != 0 {
                let lane = (fragments.trailing_zeros() & 15) as usize;
                fragments &= fragments - 1;
                let at = index[lane].cast_unsigned() as usize;
                buffer.fragment::<O, F>(at, setup.ids[lane], keys[lane], observer);
            }
            while open != 0 {
                let lane = (open.trailing_zeros() & 15) as usize;
                open &= open - 1;
                let at = index[lane].cast_unsigned() as usize;
                buffer.leave_open(at, setup.ids[lane], keys[lane], false);
            }
        }
        // On to the next sample of each box, row by row.
        column += f32x16::splat(simd, 1.0);
        let wraps = column.simd_ge(end);
        column = wraps.select(first, column);
        row += wraps.select(f32x16::splat(simd, 1.0), f32x16::splat(simd, 0.0));
        index += wraps.select(to_next_row, one);
        remaining -= one;
    }
}

/// The samples of all boxes that lie in the tile.
struct Walk<S: Simd> {
    /// First and behind the last column, and first row, each within its box.
    left: i32x16<S>,
    right: i32x16<S>,
    top: i32x16<S>,
    /// Where the first sample is kept, and from the last of a row to the first of the next.
    index: i32x16<S>,
    to_next_row: i32x16<S>,
    /// How many samples.
    remaining: i32x16<S>,
}

impl<S: Simd> Walk<S> {
    #[inline(always)]
    fn new(simd: S, setup: &Setup, buffer: &TileBuffer) -> Self {
        let splat = |value: usize| {
            i32x16::splat(simd, i32::try_from(value).expect("a side has at most 65,536 samples"))
        };
        let load = |lanes: &[i32; 16]| i32x16::load_array_ref(simd, lanes);
        let zero = splat(0);
        let (tile, stride) = (buffer.region(), splat(buffer.stride()));
        let (column, row) = (load(&setup.first_column), load(&setup.first_row));
        let left = (splat(tile.columns.start) - column).max(zero);
        let right = (splat(tile.columns.end) - column).min(load(&setup.columns));
        let top = (splat(tile.rows.start) - row).max(zero);
        let bottom = (splat(tile.rows.end) - row).min(load(&setup.rows));
        let (width, height) = ((right - left).max(zero), (bottom - top).max(zero));
        let first_row = row + top - splat(tile.rows.start);
        Walk {
            left,
            right,
            top,
            index: first_row * stride + column + left - splat(tile.columns.start),
            to_next_row: stride - width + splat(1),
            remaining: width * height,
        }
    }
}

/// Tells of the tests of one step.
fn tell<S: Simd, O: Observer>(
    setup: &Setup,
    buffer: &TileBuffer,
    observer: &mut O,
    active: mask32x16<S>,
    index: &[i32; 16],
    values: &[f32x16<S>; 3],
    error: f32x16<S>,
) {
    let (values, error) = (values.map(SimdBase::to_array), error.to_array());
    for lane in (0..16).filter(|lane| active.to_bitmask() >> lane & 1 == 1) {
        let at = index[lane].cast_unsigned() as usize;
        let edges = values.map(|values| values[lane]);
        setup.tell_test(lane, buffer.sample(at), edges, error[lane], observer);
    }
}
