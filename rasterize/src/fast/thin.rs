//! Triangles that are thin: one triangle at a time, sixteen of its rows at once, each testing one of its samples.

use super::fragments::{Fragments, leave_open};
use super::many_samples::{difference, guessed_end, guessed_first, lane_places};
use super::picture::Picture;
use super::setup::FlatSetup;
use super::size_class::THIN;
use super::tile::TileBuffer;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x16, i32x16, u32x16,
};
use bothways_common::look::lanes::each;
use bothways_common::raster::{Region, Sample};

/// In no more columns, blocks take no longer.
const COLUMNS_OF_BLOCKS: usize = 8;

/// Whether a triangle, or a strip of one, is thin in a part of its region. The answer only chooses how it is drawn.
#[inline(always)]
pub(super) fn is_thin(triangle: &FlatSetup, here: &Region) -> bool {
    if here.columns.len() <= COLUMNS_OF_BLOCKS || triangle.facing == 0.0 {
        return false;
    }
    let middle = difference(usize::midpoint(here.rows.start, here.rows.end), triangle.origin.row);
    let (mut low, mut high) = (f32::NEG_INFINITY, f32::INFINITY);
    for [at_origin, across, down] in triangle.edges {
        let crossing = -(at_origin + down * middle) / across;
        if across > 0.0 {
            low = low.max(crossing);
        } else if across < 0.0 {
            high = high.min(crossing);
        }
    }
    // A triangle that reaches the first and the last row has at least half as many columns in the row in the middle as in any
    // other. If it ends before that row, the lines through its edges have crossed there, and are the farther apart the wider it is.
    2.0 * (high - low).abs() <= THIN
}

/// Draws a triangle that is thin in a part of its region. Each sample has the same values as in a block of sixteen.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    triangle: &FlatSetup,
    here: &Region,
    (picture, fragments): (&Picture, &mut Fragments),
    buffer: &mut TileBuffer,
) {
    let simd = context.simd();
    let ids = u32x16::splat(simd, triangle.id);
    let rows = Rows::new(simd, triangle, here);
    let Rows { edges: [a, b, c], error, key, .. } = &rows;
    for first in here.rows.clone().step_by(16) {
        let Span { first: mut column, end, down, key_down } = rows.span(simd, first);
        let at = buffer.index(Sample { row: first, column: here.columns.start });
        let mut index = rows.index(simd, column, [at, buffer.stride()]);
        loop {
            let active = column.simd_lt(end);
            if !active.any_true() {
                break;
            }
            buffer.executed.lane_steps += 1;
            let least = (a.at_top(column) + down[0])
                .min(b.at_top(column) + down[1])
                .min(c.at_top(column) + down[2]);
            let inside = active & least.simd_gt(*error);
            let perhaps = active & least.simd_ge(-*error);
            let keys = key.at_top(column) + key_down;
            if inside.any_true() {
                fragments.add(index, keys, ids, inside);
            }
            // As inside ⊆ perhaps, this is the difference of two sets.
            let open = perhaps ^ inside;
            if open.any_true() {
                let fragments = (&ids.to_array(), &index.to_array(), &keys.to_array());
                leave_open(&mut context.scalar(), picture, buffer, open.to_bitmask(), fragments);
            }
            if fragments.are_full() {
                fragments.test_depth(context, picture, buffer);
            }
            column += 1.0;
            index += 1;
        }
        fragments.test_depth(context, picture, buffer);
        if buffer.is_duplicate::<C>(triangle.id) {
            return;
        }
    }
}

/// An affine function of row and column, the same in every lane.
#[derive(Clone, Copy)]
struct Affine<S: Simd> {
    at_origin: f32x16<S>,
    across: f32x16<S>,
    down: f32x16<S>,
    /// Whether it rises from column to column, or stays the same.
    rises: bool,
    /// In how many columns it changes by one.
    columns_per_unit: f32,
}

impl<S: Simd> Affine<S> {
    #[inline(always)]
    fn new(simd: S, [at_origin, across, down]: [f32; 3]) -> Self {
        let splat = |value: f32| f32x16::splat(simd, value);
        Affine {
            at_origin: splat(at_origin),
            across: splat(across),
            down: splat(down),
            rises: across >= 0.0,
            columns_per_unit: 1.0 / across,
        }
    }

    /// In the row of the origin.
    #[inline(always)]
    fn at_top(&self, column: f32x16<S>) -> f32x16<S> {
        self.at_origin + self.across * column
    }
}

/// The rows of a triangle's part.
struct Rows<S: Simd> {
    edges: [Affine<S>; 3],
    error: f32x16<S>,
    key: Affine<S>,
    origin: Sample,
    /// The end of the part's rows, its first column, and the end of its columns, from the origin.
    end_row: f32,
    first_column: f32x16<S>,
    end_column: f32x16<S>,
}

/// Sixteen rows: the columns that are tested, from the triangle's origin, and what each row adds to the functions.
struct Span<S: Simd> {
    first: f32x16<S>,
    end: f32x16<S>,
    down: [f32x16<S>; 3],
    key_down: f32x16<S>,
}

impl<S: Simd> Rows<S> {
    #[inline(always)]
    fn new(simd: S, triangle: &FlatSetup, here: &Region) -> Self {
        let origin = triangle.origin;
        let column = |column| f32x16::splat(simd, difference(column, origin.column));
        Rows {
            edges: each!(k in [0, 1, 2] => Affine::new(simd, triangle.edges[k])),
            error: f32x16::splat(simd, triangle.error),
            key: Affine::new(simd, triangle.key),
            origin,
            end_row: difference(here.rows.end, origin.row),
            first_column: column(here.columns.start),
            end_column: column(here.columns.end),
        }
    }

    /// The columns of sixteen rows from a first one on at which no edge function is certainly negative.
    ///
    /// Rounding keeps order: in a row, the computed edge function never falls from column to column, or never rises. So a
    /// column at which it is certainly negative excludes all columns on one side. The quotient only guesses such
    /// a column, and the test asks the function itself.
    #[inline(always)]
    fn span(&self, simd: S, first: usize) -> Span<S> {
        let row = f32x16::load_array(simd, const { lane_places::<16>()[1] })
            + difference(first, self.origin.row);
        let [a, b, c] = &self.edges;
        let down = [a.down * row, b.down * row, c.down * row];
        let (start, all_end) = (self.first_column, self.end_column);
        let in_rows = row.simd_lt(f32x16::splat(simd, self.end_row));
        let (mut from, mut to) = (start, in_rows.select(all_end, start));
        for k in 0..3 {
            let (edge, down) = (&self.edges[k], down[k]);
            let crossing = (-self.error - (edge.at_origin + down)) * edge.columns_per_unit;
            if edge.rises {
                // From here on it may be inside.
                let guess = guessed_first(crossing, [start, all_end]);
                let is_out = (edge.at_top(guess - 1.0) + down).simd_lt(-self.error);
                from = is_out.select(guess.max(from), from);
            } else {
                // Up to here.
                let guess = guessed_end(crossing, [start, all_end]);
                let is_out = (edge.at_top(guess) + down).simd_lt(-self.error);
                to = is_out.select(guess.min(to), to);
            }
        }
        Span { first: from, end: to, down, key_down: self.key.down * row }
    }

    /// The tile's indices of samples in sixteen rows, given by their columns, from the index of the first row's first.
    #[inline(always)]
    fn index(&self, simd: S, column: f32x16<S>, [first, stride]: [usize; 2]) -> i32x16<S> {
        let splat =
            |value: usize| i32x16::splat(simd, i32::try_from(value).expect("a tile is small"));
        let lane = f32x16::load_array(simd, const { lane_places::<16>()[1] });
        let columns = (column - self.first_column).to_int::<i32x16<S>>();
        splat(first) + lane.to_int::<i32x16<S>>() * splat(stride) + columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{dispatch, levels};

    #[test]
    fn columns_that_are_left_out_are_certainly_outside() {
        let random = &mut fastrand::Rng::with_seed(5);
        let mut left_out = 0;
        for _ in 0..300 {
            let triangle = FlatSetup::random(random);
            let bound = |random: &mut fastrand::Rng| [random.usize(0..40), random.usize(40..256)];
            let ([top, bottom], [left, right]) = (bound(random), bound(random));
            let here = Region { rows: top..bottom, columns: left..right };
            for level in levels() {
                dispatch!(level, simd => {
                    let rows = Rows::new(simd, &triangle, &here);
                    let Span { first, end, .. } = rows.span(simd, top);
                    for lane in 0..16 {
                        let (row, first, end) = (top + lane, first[lane], end[lane]);
                        let columns = here.columns.clone().map(|column| difference(column, 0));
                        if row >= bottom {
                            assert!(first >= end, "row {row} of {here:?}");
                            continue;
                        }
                        for column in columns.filter(|column| !(first..end).contains(column)) {
                            let is_out = |[at_origin, across, down]: [f32; 3]| {
                                let value = (at_origin + across * column) + down * difference(row, 0);
                                value < -triangle.error
                            };
                            assert!(triangle.edges.into_iter().any(is_out), "{row}, {column}");
                            left_out += 1;
                        }
                    }
                });
            }
        }
        assert!(left_out > 100_000, "{left_out}");
    }
}
