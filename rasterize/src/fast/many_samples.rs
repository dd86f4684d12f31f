//! Triangles over many samples: one triangle at a time, sixteen samples at once.

use super::depth::{NOTHING, nearer_by};
use super::lanes::{keys_to_store, lanes_of};
use super::picture::Picture;
use super::setup::{FlatSetup, Setup};
use super::tile::TileBuffer;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x8, f32x16, mask32x16, u32x8, u32x16,
};
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use std::ops::Range;

/// Boxes of no more columns are drawn in all their rows: to find out where a triangle is not would take longer.
const MOST_UNCUT: usize = 32;

/// One triangle, its numbers broadcast to all lanes.
struct Broadcast<S: Simd> {
    id: u32,
    edges: [[f32x16<S>; 3]; 3],
    error: f32x16<S>,
    keys: [f32x16<S>; 3],
    /// −∞, as far from the inside as an edge function can be.
    outside: f32x16<S>,
}

/// Sixteen samples, tested: `inside ⊆ perhaps`.
struct Tested<S: Simd> {
    values: [f32x16<S>; 3],
    inside: mask32x16<S>,
    perhaps: mask32x16<S>,
    keys: f32x16<S>,
}

/// Draws the triangles of some lanes, as far as they lie in the tile: first those that take one column of blocks of eight samples
/// across, then one of sixteen, then several. If they were mixed, the machine could not predict which comes next.
#[inline(always)]
pub(super) fn draw_lanes<C: Context>(
    context: &mut C,
    setup: &Setup,
    lanes: u16,
    picture: &Picture,
    buffer: &mut TileBuffer,
) {
    let (simd, tile) = (context.simd(), buffer.region().columns.clone());
    let lanes = lanes & !setup.in_columns(simd, &tile, 0);
    let narrow = lanes & setup.in_columns(simd, &tile, 8);
    let one_column = lanes & setup.in_columns(simd, &tile, 16);
    draw_each::<8, true, C>(context, setup, narrow, picture, buffer);
    draw_each::<16, true, C>(context, setup, one_column & !narrow, picture, buffer);
    draw_each::<16, false, C>(context, setup, lanes & !one_column, picture, buffer);
}

/// [`draw_blocks`] for the triangles of some lanes.
#[inline(always)]
fn draw_each<const ACROSS: usize, const ONE_COLUMN: bool, C: Context>(
    context: &mut C,
    setup: &Setup,
    lanes: u16,
    picture: &Picture,
    buffer: &mut TileBuffer,
) {
    for lane in lanes_of(lanes.into()) {
        let triangle = setup.triangle(lane);
        let here = triangle.region.intersection(buffer.region());
        draw_blocks::<ACROSS, ONE_COLUMN, C>(context, &triangle, here, picture, buffer);
    }
}

/// Draws a strip of a primitive, as far as it lies in the tile. Most strips are wide.
#[inline(always)]
pub(super) fn draw_strip<C: Context>(
    context: &mut C,
    strip: &FlatSetup,
    picture: &Picture,
    buffer: &mut TileBuffer,
) {
    let here = strip.region.intersection(buffer.region());
    if here.is_empty() {
        return;
    }
    if here.columns.len() <= 8 {
        draw_blocks::<8, true, C>(context, strip, here, picture, buffer);
    } else {
        draw_blocks::<16, false, C>(context, strip, here, picture, buffer);
    }
}

/// Draws in blocks of sixteen samples, in `ACROSS` columns: 16 or 8. With `ONE_COLUMN`, the region has 1 to `ACROSS` columns.
#[inline(always)]
fn draw_blocks<const ACROSS: usize, const ONE_COLUMN: bool, C: Context>(
    context: &mut C,
    triangle: &FlatSetup,
    Region { rows, columns }: Region,
    picture: &Picture,
    buffer: &mut TileBuffer,
) {
    let simd = context.simd();
    let broadcast = Broadcast::new(simd, triangle);
    let lane_row = f32x16::load_array(simd, const { lane_places::<ACROSS>()[0] });
    let lane_column = f32x16::load_array(simd, const { lane_places::<ACROSS>()[1] });
    // Rows and columns from the triangle's origin.
    let Sample { row: first_row, column: first_column } = triangle.origin;
    let end_row = f32x16::splat(simd, difference(rows.end, first_row));
    let end_column = f32x16::splat(simd, difference(columns.end, first_column));
    let down = 16 / ACROSS;
    let step = f32x16::splat(simd, const { difference(16 / ACROSS, 0) });
    let to_next = down * buffer.stride();

    // If the loops are watched, every test is an event.
    let is_cut = !C::WATCHED && !ONE_COLUMN && columns.len() > MOST_UNCUT && triangle.facing != 0.0;
    let mut ends = [[0; 16]; 2];
    if is_cut {
        let own = [difference(rows.start, first_row), difference(rows.end, first_row)];
        ends = broadcast.rows_of_columns(simd, difference(columns.start, first_column), own);
    }
    let columns_of_blocks = if ONE_COLUMN { 1 } else { columns.len().div_ceil(ACROSS) };
    for number in 0..columns_of_blocks {
        let column = columns.start + number * ACROSS;
        let rows = if is_cut { counted_from(first_row, &ends, number) } else { rows.clone() };
        let lane_columns = lane_column + difference(column, first_column);
        let at_top = broadcast.at_top(lane_columns, lane_columns.simd_lt(end_column));
        let mut lane_rows = lane_row + difference(rows.start, first_row);
        let mut index = buffer.index(Sample { row: rows.start, column });
        let count = rows.len().div_ceil(down);
        for block in 0..count {
            let row = rows.start + block * down;
            let in_rows = (ACROSS < 16).then(|| lane_rows.simd_lt(end_row));
            let tested = broadcast.test(lane_rows, &at_top, in_rows);
            let first = Sample { row, column };
            if C::WATCHED {
                let ends = [rows.end, columns.end];
                emit_tests::<ACROSS, C>(context, triangle, buffer, first, ends, &tested);
            }
            let doubt = keep::<ACROSS, _, C::Fault>(simd, &broadcast, &tested, buffer, index);
            if doubt.any_true() {
                let masks = [doubt.to_bitmask(), tested.inside.to_bitmask()];
                let fragments = (broadcast.id, tested.keys.to_array());
                let context = &mut context.scalar();
                leave_open::<ACROSS, _>(context, fragments, picture, buffer, first, masks);
                if buffer.is_duplicate::<C>(broadcast.id) {
                    buffer.executed.blocks += (block + 1) as u64;
                    return;
                }
            }
            lane_rows += step;
            index += to_next;
        }
        buffer.executed.blocks += count as u64;
    }
}

/// The rows of one of sixteen columns of blocks, given by their ends, which count from a first row.
#[inline(always)]
fn counted_from(first_row: usize, ends: &[[u32; 16]; 2], column: usize) -> Range<usize> {
    let [first, end] = [ends[0][column & 15], ends[1][column & 15]];
    first_row + first as usize..first_row + end as usize
}

/// The last row or column before a crossing, between a first one and an end; what is not a number is the first.
#[inline(always)]
pub(super) fn guessed_first<S: Simd>(
    crossing: f32x16<S>,
    [first, end]: [f32x16<S>; 2],
) -> f32x16<S> {
    let guess = crossing.floor();
    let guess = guess.simd_gt(first).select(guess, first);
    guess.simd_lt(end).select(guess, end)
}

/// The first row or column that is at least one behind a crossing, between a first one and an end; what is not a number is
/// the end.
#[inline(always)]
pub(super) fn guessed_end<S: Simd>(crossing: f32x16<S>, [first, end]: [f32x16<S>; 2]) -> f32x16<S> {
    let guess = (crossing + 1.0).ceil();
    let guess = guess.simd_lt(end).select(guess, end);
    guess.simd_gt(first).select(guess, first)
}

/// A row or column of the picture, counted from a first one.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most 65,536")]
#[expect(clippy::cast_precision_loss, reason = "at most 256")]
pub(super) const fn difference(place: usize, first: usize) -> f32 {
    (place as i32 - first as i32) as f32
}

/// Rows and columns of the sixteen samples of a block.
pub(super) const fn lane_places<const ACROSS: usize>() -> [[f32; 16]; 2] {
    let mut places = [[0.0; 16]; 2];
    let mut lane = 0;
    while lane < 16 {
        #[expect(clippy::cast_precision_loss, reason = "at most 16")]
        let place = [(lane / ACROSS) as f32, (lane % ACROSS) as f32];
        (places[0][lane], places[1][lane]) = (place[0], place[1]);
        lane += 1;
    }
    places
}

impl<S: Simd> Broadcast<S> {
    #[inline(always)]
    fn new(simd: S, FlatSetup { id, edges: [a, b, c], error, key, .. }: &FlatSetup) -> Self {
        debug_assert!(error.is_finite(), "or lanes beyond the region would count");
        let in_lanes = |numbers: &[f32; 3]| {
            let [at_origin, across, down] = *numbers;
            [f32x16::splat(simd, at_origin), f32x16::splat(simd, across), f32x16::splat(simd, down)]
        };
        Broadcast {
            id: *id,
            edges: [in_lanes(a), in_lanes(b), in_lanes(c)],
            error: f32x16::splat(simd, *error),
            keys: in_lanes(key),
            outside: f32x16::splat(simd, f32::NEG_INFINITY),
        }
    }

    /// The edge functions and the key in the first row of the triangle's box. One edge function excludes the samples
    /// beside its columns.
    #[inline(always)]
    fn at_top(&self, column: f32x16<S>, in_columns: mask32x16<S>) -> [f32x16<S>; 4] {
        let ([a, b, c], key) = (&self.edges, &self.keys);
        [
            in_columns.select(a[0] + a[1] * column, self.outside),
            b[0] + b[1] * column,
            c[0] + c[1] * column,
            key[0] + key[1] * column,
        ]
    }

    /// For each of sixteen columns of blocks of sixteen samples, the first of which begins at a column, the rows at which no
    /// edge function is certainly negative at all samples of a block: of some rows, the first, and the end. Rows and
    /// columns count from the triangle's origin.
    ///
    /// Rounding keeps order: in a row, the computed edge function is largest at one end of the block, and there it never falls
    /// from row to row, or never rises. So a row at which it is certainly negative excludes all rows on one side. The
    /// quotient only guesses such a row, and the test asks the function itself.
    #[inline(always)]
    fn rows_of_columns(&self, simd: S, column: f32, [first, end]: [f32; 2]) -> [[u32; 16]; 2] {
        let zero = f32x16::splat(simd, 0.0);
        let (all_first, all_end) = (f32x16::splat(simd, first), f32x16::splat(simd, end));
        let left = f32x16::load_array(simd, const { lane_places::<16>()[1] }) * 16.0 + column;
        let right = left + 15.0;
        let (mut from, mut to) = (all_first, all_end);
        for [at_origin, across, down] in &self.edges {
            let best = across.simd_gt(zero).select(right, left);
            let largest = *at_origin + *across * best;
            let crossing = (-self.error - largest) / *down;
            // From here on it may be inside.
            let guess = guessed_first(crossing, [all_first, all_end]);
            let is_out = (largest + *down * (guess - 1.0)).simd_lt(-self.error);
            let rises = down.simd_ge(zero);
            from = (rises & is_out).select(guess.max(from), from);
            // Up to here.
            let guess = guessed_end(crossing, [all_first, all_end]);
            let is_out = (largest + *down * guess).simd_lt(-self.error);
            to = (!rises & is_out).select(guess.min(to), to);
        }
        let to = to.max(from);
        [from.to_int::<u32x16<S>>().to_array(), to.to_int::<u32x16<S>>().to_array()]
    }

    /// Tests sixteen samples, of which some may lie outside of the triangle's rows.
    #[inline(always)]
    fn test(
        &self,
        row: f32x16<S>,
        at_top: &[f32x16<S>; 4],
        in_rows: Option<mask32x16<S>>,
    ) -> Tested<S> {
        let [a, b, c] = &self.edges;
        let values = [at_top[0] + a[2] * row, at_top[1] + b[2] * row, at_top[2] + c[2] * row];
        let mut least = values[0].min(values[1]).min(values[2]);
        if let Some(in_rows) = in_rows {
            least = in_rows.select(least, self.outside);
        }
        Tested {
            values,
            inside: least.simd_gt(self.error),
            perhaps: least.simd_ge(-self.error),
            keys: at_top[3] + self.keys[2] * row,
        }
    }
}

/// The depth test of a block. Returns the lanes that are left open.
#[inline(always)]
fn keep<const ACROSS: usize, S: Simd, F: Fault>(
    simd: S,
    broadcast: &Broadcast<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
) -> mask32x16<S> {
    if ACROSS == 8 {
        keep_two_rows::<S, F>(simd, broadcast, tested, buffer, index)
    } else {
        keep_row::<S, F>(simd, broadcast, tested, buffer, index)
    }
}

/// The depth test of one row of sixteen samples. Returns the lanes that are left open.
#[inline(always)]
fn keep_row<S: Simd, F: Fault>(
    simd: S,
    broadcast: &Broadcast<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
) -> mask32x16<S> {
    let (ids, keys) = buffer.from(index);
    let (ids, keys) = (&mut ids[..16], &mut keys[..16]);
    let stored = f32x16::from_slice(simd, keys);
    let (replaces, doubt) = depth_test::<S, F>(tested, stored);
    keys_to_store::<u32x16<S>, _>(replaces, tested.keys, stored).store_slice(keys);
    let stored_ids = u32x16::from_slice(simd, ids);
    replaces.select(u32x16::splat(simd, broadcast.id), stored_ids).store_slice(ids);
    doubt
}

/// The depth test of two rows of eight samples. Returns the lanes that are left open.
#[inline(always)]
fn keep_two_rows<S: Simd, F: Fault>(
    simd: S,
    broadcast: &Broadcast<S>,
    tested: &Tested<S>,
    buffer: &mut TileBuffer,
    index: usize,
) -> mask32x16<S> {
    let stride = buffer.stride();
    let (ids, keys) = buffer.from(index);
    let (ids, keys) = (&mut ids[..stride + 8], &mut keys[..stride + 8]);
    let stored = two_rows(simd, keys, stride);
    let (replaces, doubt) = depth_test::<S, F>(tested, stored);
    let (upper, lower) = simd.split_mask32x16(replaces);
    let (upper_keys, lower_keys) = simd.split_f32x16(tested.keys);
    let id = u32x8::splat(simd, broadcast.id);
    for (start, mask, new) in [(0, upper, upper_keys), (stride, lower, lower_keys)] {
        let (ids, keys) = (&mut ids[start..start + 8], &mut keys[start..start + 8]);
        let stored = f32x8::from_slice(simd, keys);
        keys_to_store::<u32x8<S>, _>(mask, new, stored).store_slice(keys);
        mask.select(id, u32x8::from_slice(simd, ids)).store_slice(ids);
    }
    doubt
}

/// Eight keys of one row and eight of the next.
#[inline(always)]
fn two_rows<S: Simd>(simd: S, keys: &[f32], stride: usize) -> f32x16<S> {
    simd.combine_f32x8(
        f32x8::from_slice(simd, &keys[..8]),
        f32x8::from_slice(simd, &keys[stride..stride + 8]),
    )
}

/// The fragments that are certainly nearest so far, and the samples that are not decided.
#[inline(always)]
fn depth_test<S: Simd, F: Fault>(
    tested: &Tested<S>,
    stored: f32x16<S>,
) -> (mask32x16<S>, mask32x16<S>) {
    let nearer = tested.inside & tested.keys.simd_gt(stored * nearer_by::<F>());
    let farther = tested.inside & stored.simd_gt(tested.keys * nearer_by::<F>());
    // As inside ⊆ perhaps, this is the difference of two sets.
    (nearer, tested.perhaps ^ (nearer | farther))
}

/// The sample of one lane of a block that begins at `first`.
fn sample<const ACROSS: usize>(first: Sample, lane: usize) -> Sample {
    Sample { row: first.row + lane / ACROSS, column: first.column + lane % ACROSS }
}

/// Leaves some lanes to the judge: those of the mask `doubt`, of which those of `inside` are certainly covered. It
/// takes copies, so that the caller can keep everything in registers.
#[cold]
fn leave_open<const ACROSS: usize, C: ScalarContext>(
    context: &mut C,
    (id, keys): (u32, [f32; 16]),
    picture: &Picture,
    buffer: &mut TileBuffer,
    first: Sample,
    [doubt, inside]: [u64; 2],
) {
    for lane in lanes_of(doubt) {
        let at = buffer.index(sample::<ACROSS>(first, lane));
        let covered = inside >> lane & 1 == 1;
        buffer.leave_open(context, picture, (at, id, keys[lane & 15]), covered);
    }
}

/// Emits sixteen tests, and the depth tests that follow.
#[inline(always)]
fn emit_tests<const ACROSS: usize, C: Context>(
    context: &mut C,
    triangle: &FlatSetup,
    buffer: &mut TileBuffer,
    first: Sample,
    [end_row, end_column]: [usize; 2],
    tested: &Tested<C::Simd>,
) {
    let simd = context.simd();
    if let Some(counts) = context.sink().counts() {
        let (index, stride) = (buffer.index(first), buffer.stride());
        let (_, keys) = buffer.from(index);
        let stored = match ACROSS {
            8 => two_rows(simd, keys, stride),
            _ => f32x16::from_slice(simd, &keys[..16]),
        };
        let (nearer, doubt) = depth_test::<_, C::Fault>(tested, stored);
        let certain = nearer | (tested.inside & !doubt);
        let meets_earlier = certain & !stored.simd_eq(f32x16::splat(simd, NOTHING));
        let (rows, columns) = (end_row - first.row, end_column - first.column);
        counts.tests += (rows.min(16 / ACROSS) * columns.min(ACROSS)) as u64;
        counts.fragments += u64::from(certain.to_bitmask().count_ones());
        counts.depth_tests += u64::from(meets_earlier.to_bitmask().count_ones());
        return;
    }
    let values = tested.values.map(SimdBase::to_array);
    let (inside, keys) = (tested.inside.to_bitmask(), tested.keys.to_array());
    for lane in 0..16 {
        let sample = sample::<ACROSS>(first, lane);
        if sample.row >= end_row || sample.column >= end_column {
            continue;
        }
        triangle.emit_test(
            context.sink(),
            &buffer.names,
            sample,
            values.map(|values| values[lane]),
        );
        if inside >> lane & 1 == 1 {
            let at = buffer.index(sample);
            buffer.emit_certain(context, at, triangle.id, keys[lane]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};

    #[test]
    fn rows_that_are_left_out_are_certainly_outside() {
        let random = &mut fastrand::Rng::with_seed(7);
        let mut left_out = 0;
        for _ in 0..300 {
            let triangle = FlatSetup::random(random);
            let (first, end) = (random.u8(0..40), random.u8(40..));
            for level in levels() {
                dispatch!(level, simd => {
                    let broadcast = Broadcast::new(simd, &triangle);
                    let ends = [first, end].map(f32::from);
                    let [from, to] = broadcast.rows_of_columns(simd, 3.0, ends);
                    let lane_column = f32x16::load_array(simd, const { lane_places::<16>()[1] });
                    for column in 0..16_u8 {
                        let (from, to) = (from[usize::from(column)], to[usize::from(column)]);
                        assert!(u32::from(first) <= from && from <= to && to <= u32::from(end));
                        let columns = lane_column + f32::from(3 + 16 * column);
                        let at_top = broadcast.at_top(columns, columns.simd_lt(1e9));
                        for row in (first..end).filter(|row| !(from..to).contains(&u32::from(*row))) {
                            let row = f32x16::splat(simd, row.into());
                            assert!(broadcast.test(row, &at_top, None).perhaps.all_false());
                            left_out += 1;
                        }
                    }
                });
            }
        }
        assert!(left_out > 100_000, "{left_out}");
    }
}
