//! Triangles over many samples: one triangle at a time, sixteen samples at once.

use super::setup::Setup;
use super::tile::{TileBuffer, nearer_by};
use bothways_common::fault::Fault;
use bothways_common::observe::{Observer, Sample};
use bothways_common::simd::{
    Select, Simd, SimdBase, SimdMask, f32x8, f32x16, mask32x16, u32x8, u32x16,
};
use std::ops::Range;

/// One triangle of a setup, its numbers in every lane.
struct Brush<S: Simd> {
    id: u32,
    edges: [[f32x16<S>; 3]; 3],
    error: f32x16<S>,
    keys: [f32x16<S>; 3],
}

/// Sixteen samples tested.
struct Tested<S: Simd> {
    values: [f32x16<S>; 3],
    inside: mask32x16<S>,
    perhaps: mask32x16<S>,
    keys: f32x16<S>,
}

/// Draws what of one triangle lies in the tile.
#[inline(always)]
pub(super) fn draw<S: Simd, O: Observer, F: Fault>(
    simd: S,
    setup: &Setup,
    lane: usize,
    buffer: &mut TileBuffer,
    observer: &mut O,
) {
    let brush = Brush::new(simd, setup, lane);
    let tile = buffer.region().clone();
    let columns = within(setup.first_column[lane], setup.columns[lane], &tile.columns);
    let rows = within(setup.first_row[lane], setup.rows[lane], &tile.rows);
    let narrow = columns.len() <= 8;
    let (across, down) = if narrow { (8, 2) } else { (16, 1) };
    #[expect(clippy::cast_precision_loss, reason = "at most 16")]
    let of_lane = |place: fn(usize, usize) -> usize| {
        f32x16::load_array(simd, std::array::from_fn(|lane| place(lane, across) as f32))
    };
    let lane_column = of_lane(|lane, across| lane % across);
    let lane_row = of_lane(|lane, across| lane / across);
    // Columns and rows of the triangle's own box.
    let own = |place: usize, first: i32| {
        #[expect(clippy::cast_precision_loss, reason = "at most 256")]
        let own = (place as i64 - i64::from(first)) as f32;
        own
    };
    let ends = [own(columns.end, setup.first_column[lane]), own(rows.end, setup.first_row[lane])];
    let [end_column, end_row] = ends.map(|end| f32x16::splat(simd, end));

    for row in rows.step_by(down) {
        let own_row = lane_row + own(row, setup.first_row[lane]);
        let values_on_row = brush.on_row(own_row);
        for column in columns.clone().step_by(across) {
            let own_column = lane_column + own(column, setup.first_column[lane]);
            let in_box = own_column.simd_lt(end_column) & own_row.simd_lt(end_row);
            let tested = brush.test(&values_on_row, own_column, in_box);
            let index = buffer.index(Sample { row, column });
            if O::WATCHES {
                tell::<S, O, F>(setup, lane, buffer, observer, index, across, in_box, &tested);
            }
            let doubt = if narrow {
                keep_two_rows::<S, F>(simd, &brush, &tested, buffer, index)
            } else {
                keep_row::<S, F>(simd, &brush, &tested, buffer, index)
            };
            if doubt != 0 {
                leave_open(&brush, &tested, buffer, index, across, doubt);
            }
        }
    }
}

/// The part of a triangle's columns or rows that lies in the tile.
#[inline(always)]
fn within(first: i32, count: i32, tile: &Range<usize>) -> Range<usize> {
    let first = first.cast_unsigned() as usize;
    let end = (first + count.cast_unsigned() as usize).min(tile.end);
    first.max(tile.start)..end
}

impl<S: Simd> Brush<S> {
    #[inline(always)]
    fn new(simd: S, setup: &Setup, lane: usize) -> Self {
        let splat = |lanes: &[f32; 16]| f32x16::splat(simd, lanes[lane]);
        let edge =
            |k: usize| [splat(&setup.at_origin[k]), splat(&setup.across[k]), splat(&setup.down[k])];
        Brush {
            id: setup.ids[lane],
            edges: [edge(0), edge(1), edge(2)],
            error: splat(&setup.error),
            keys: [splat(&setup.key), splat(&setup.key_b), splat(&setup.key_c)],
        }
    }

    #[inline(always)]
    fn on_row(&self, row: f32x16<S>) -> [f32x16<S>; 3] {
        self.edges.map(|[at_origin, _, down]| at_origin + down * row)
    }

    #[inline(always)]
    fn test(&self, on_row: &[f32x16<S>; 3], column: f32x16<S>, in_box: mask32x16<S>) -> Tested<S> {
        let value = |k: usize| on_row[k] + self.edges[k][1] * column;
        let values = [value(0), value(1), value(2)];
        let least = values[0].min(values[1]).min(values[2]);
        let [key, key_b, key_c] = self.keys;
        Tested {
            values,
            inside: in_box & least.simd_gt(self.error),
            perhaps: in_box & least.simd_ge(-self.error),
            keys: key + key_b * values[2] + key_c * values[0],
        }
    }
}

/// The depth test of one row of sixteen samples; tells which lanes are left open.
#[inline(always)]
fn keep_row<S: Simd, F: Fault>(
    simd: S,
    brush: &Brush<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
) -> u64 {
    let (ids, keys) = buffer.from(index);
    let (ids, keys) = (&mut ids[..16], &mut keys[..16]);
    let held = f32x16::from_slice(simd, keys);
    let (replaces, doubt) = depth_test::<S, F>(tested, held);
    replaces.select(tested.keys, held).store_slice(keys);
    let shown = u32x16::from_slice(simd, ids);
    replaces.select(u32x16::splat(simd, brush.id), shown).store_slice(ids);
    doubt.to_bitmask()
}

/// The depth test of two rows of eight samples; tells which lanes are left open.
#[inline(always)]
fn keep_two_rows<S: Simd, F: Fault>(
    simd: S,
    brush: &Brush<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
) -> u64 {
    let stride = buffer.stride();
    let (ids, keys) = buffer.from(index);
    let (ids, keys) = (&mut ids[..stride + 8], &mut keys[..stride + 8]);
    let held = simd.combine_f32x8(
        f32x8::from_slice(simd, &keys[..8]),
        f32x8::from_slice(simd, &keys[stride..stride + 8]),
    );
    let (replaces, doubt) = depth_test::<S, F>(tested, held);
    let (upper, lower) = simd.split_f32x16(replaces.select(tested.keys, held));
    upper.store_slice(&mut keys[..8]);
    lower.store_slice(&mut keys[stride..stride + 8]);
    let shown = simd.combine_u32x8(
        u32x8::from_slice(simd, &ids[..8]),
        u32x8::from_slice(simd, &ids[stride..stride + 8]),
    );
    let (upper, lower) = simd.split_u32x16(replaces.select(u32x16::splat(simd, brush.id), shown));
    upper.store_slice(&mut ids[..8]);
    lower.store_slice(&mut ids[stride..stride + 8]);
    doubt.to_bitmask()
}

/// Which fragments are certainly nearest so far, and which samples are not decided.
#[inline(always)]
fn depth_test<S: Simd, F: Fault>(
    tested: &Tested<S>,
    held: f32x16<S>,
) -> (mask32x16<S>, mask32x16<S>) {
    let nearer = tested.keys.simd_gt(held * nearer_by::<F>());
    let farther = held.simd_gt(tested.keys * nearer_by::<F>());
    let decided = tested.inside & (nearer | farther);
    (tested.inside & nearer, tested.perhaps & !decided)
}

#[cold]
fn leave_open<S: Simd>(
    brush: &Brush<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
    across: usize,
    mut doubt: u64,
) {
    let inside = tested.inside.to_bitmask();
    while doubt != 0 {
        let lane = doubt.trailing_zeros() as usize;
        doubt &= doubt - 1;
        let at = index + lane / across * buffer.stride() + lane % across;
        buffer.leave_open(at, brush.id, tested.keys.to_array()[lane], inside >> lane & 1 == 1);
    }
}

/// Tells of sixteen tests, and of the depth tests that follow.
#[expect(clippy::too_many_arguments, reason = "all that an observer may want to know")]
fn tell<S: Simd, O: Observer, F: Fault>(
    setup: &Setup,
    of: usize,
    buffer: &TileBuffer,
    observer: &mut O,
    index: usize,
    across: usize,
    in_box: mask32x16<S>,
    tested: &Tested<S>,
) {
    let (values, error) = (tested.values.map(SimdBase::to_array), setup.error[of]);
    let (inside, keys) = (tested.inside.to_bitmask(), tested.keys.to_array());
    for lane in (0..16).filter(|lane| in_box.to_bitmask() >> lane & 1 == 1) {
        let at = index + lane / across * buffer.stride() + lane % across;
        let edges = values.map(|values| values[lane]);
        setup.tell_test(of, buffer.sample(at), edges, error, observer);
        if inside >> lane & 1 == 1 {
            buffer.tell_certain::<O, F>(at, setup.ids[of], keys[lane], observer);
        }
    }
}
