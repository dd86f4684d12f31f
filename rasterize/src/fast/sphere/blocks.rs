//! A sphere tested at sixteen samples of a row at once, in `f64`.

use super::by_sample::{Sphere, draw_sample};
use super::forms::{Forms, SeenRoot};
use super::rows::{EightRows, Row};
use crate::fast::depth::{KEY_ERROR, LARGEST_KEY, NOTHING, nearer_by};
use crate::fast::lanes::{keys_to_store, lanes_of};
use crate::fast::one_primitive::fragment_writer::FragmentWriter;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Fault;
use bothways_common::engine::simd::{
    Select, Simd, SimdBase, SimdFloat, SimdMask, f32x16, f64x8, mask32x16, u32x16,
};
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};

/// Stands for "not covered" among keys.
const MISS: f64 = -1.0;

/// What a computed key's error may be of it, so that with the rounding to `f32`, a sixty-fourth of [`KEY_ERROR`], and
/// those of the comparison it is still within that.
const KEY_ERROR_PART: f64 = 0.98 * KEY_ERROR as f64;

/// The depth test of a block.
struct SphereTested<S: Simd> {
    keys: f32x16<S>,
    /// The lanes that are certainly fragments.
    covered: mask32x16<S>,
    /// What is nearest so far, for certain.
    nearer: mask32x16<S>,
    /// What is not decided.
    doubt: mask32x16<S>,
}

/// Draws a sphere, as far as it lies in the tile.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    (sphere, forms): (&Sphere, &Forms),
    here: &Region,
) {
    let simd = context.simd();
    for first in here.rows.clone().step_by(8) {
        let rows = EightRows::new(simd, forms, first);
        for row in first..here.rows.end.min(first + 8) {
            let of_row = rows.row(row, here);
            draw_row(context, writer, (sphere, forms), row, &of_row);
        }
    }
}

/// Draws one row.
#[inline(always)]
fn draw_row<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    (sphere, forms): (&Sphere, &Forms),
    row: usize,
    of_row: &Row,
) {
    let simd = context.simd();
    let end = of_row.columns.end;
    // Blocks that lie behind what is seen are left out, but not if they are events.
    let hidden_by = f32x16::splat(simd, forms.nearest * nearer_by::<C::Fault>());
    let (mut blocks, mut singles) = (0, 0);
    for column in of_row.columns.clone().step_by(16) {
        let first = Sample { row, column };
        let index = writer.buffer.index(first);
        let count = (end - column).min(16);
        let (_, stored) = writer.buffer.from(index);
        let stored = f32x16::from_slice(simd, &stored[..16]);
        let hidden = stored.simd_gt(hidden_by).to_bitmask() | (u64::MAX << count);
        if !C::WATCHED && hidden == u64::MAX {
            continue;
        }
        blocks += 1;
        let keys = keys(simd, forms, of_row, column);
        let tested = depth_test::<_, C::Fault>(simd, keys, count, stored);
        if C::WATCHED {
            emit_tests(context, writer, first, count, &tested);
        }
        store(simd, writer, index, &tested);
        if tested.doubt.any_true() {
            let masks = [tested.doubt.to_bitmask(), tested.covered.to_bitmask()];
            singles += (masks[0] & !masks[1]).count_ones();
            let keys = tested.keys.to_array();
            decide(&mut context.scalar(), writer, sphere, first, (masks, &keys));
        }
    }
    writer.buffer.executed.blocks += blocks;
    writer.buffer.executed.single_samples += u64::from(singles);
}

/// The keys of sixteen samples of a row: [`MISS`] where the sphere is certainly missed, NaN where rounding leaves it
/// open.
#[inline(always)]
fn keys<S: Simd>(simd: S, forms: &Forms, row: &Row, column: usize) -> f32x16<S> {
    #[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
    let from_origin = column as f64 - forms.origin.column as f64;
    let columns = f64x8::load_array(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    let low = eight_keys(simd, forms, row, columns + f64x8::splat(simd, from_origin));
    let high = eight_keys(simd, forms, row, columns + f64x8::splat(simd, from_origin + 8.0));
    simd.narrow_f64x8(low, high)
}

/// The same for eight samples. Comparisons are written so that NaN is open.
#[inline(always)]
fn eight_keys<S: Simd>(simd: S, forms: &Forms, row: &Row, columns: f64x8<S>) -> f64x8<S> {
    let splat = |value: f64| f64x8::splat(simd, value);
    let across = columns * splat(forms.spacing[1]);
    // Arrays of vectors are written out here and below: `map` would not be inlined.
    let slope = splat(row.square[1]) + across * splat(forms.square.curvature);
    let square = splat(row.square[0]) + across * slope;
    let linear = splat(row.linear) + across * splat(forms.linear.across);
    let (missed, certain, key) = match forms.seen {
        SeenRoot::Near { square_error, key_error, behind } => {
            let error = splat(square_error);
            let root = square.sqrt();
            let key = linear + root;
            // The error is `key_error` and `square_error/root`.
            let room = (key * splat(KEY_ERROR_PART) - splat(key_error)) * root;
            let certain = square.simd_gt(error) & room.simd_ge(error);
            (square.simd_lt(-error) | linear.simd_lt(splat(behind)), certain, key)
        }
        SeenRoot::Inside { depth, least_root } => {
            let root = (linear * linear + square * splat(depth)).sqrt();
            let sum = linear.abs() + root;
            let approaches = linear.simd_ge(splat(0.0));
            let key = approaches.select(square, sum) / approaches.select(sum, splat(depth));
            let certain = root.simd_gt(splat(least_root));
            // From an eye on the sphere, half of the rays leave it.
            let is_on = splat(depth).simd_eq(splat(0.0));
            let in_range = key.simd_ge(splat(1.0 / LARGEST_KEY)) & key.simd_le(splat(LARGEST_KEY));
            (is_on & certain & !approaches, certain & in_range, key)
        }
    };
    missed.select(splat(MISS), certain.select(key, splat(f64::NAN)))
}

/// The depth test of the first `count` samples.
#[inline(always)]
fn depth_test<S: Simd, F: Fault>(
    simd: S,
    keys: f32x16<S>,
    count: usize,
    stored: f32x16<S>,
) -> SphereTested<S> {
    let splat = |value: f32| f32x16::splat(simd, value);
    let in_row = lanes_before(simd, count);
    let keys = in_row.select(keys, splat(-1.0));
    let covered = keys.simd_gt(splat(0.0));
    let open = !keys.simd_eq(keys);
    let nearer = covered & keys.simd_gt(stored * nearer_by::<F>());
    let farther = covered & stored.simd_gt(keys * nearer_by::<F>());
    SphereTested { keys, covered, nearer, doubt: (covered | open) & !(nearer | farther) }
}

/// The lanes of the first `count` samples of a block.
#[inline(always)]
fn lanes_before<S: Simd>(simd: S, count: usize) -> mask32x16<S> {
    const LANES: [f32; 16] =
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
    #[expect(clippy::cast_precision_loss, reason = "at most 16")]
    let count = f32x16::splat(simd, count as f32);
    f32x16::load_array(simd, LANES).simd_lt(count)
}

/// Stores what is certainly nearest.
#[inline(always)]
fn store<S: Simd>(simd: S, writer: &mut FragmentWriter, index: usize, tested: &SphereTested<S>) {
    let (ids, keys) = writer.buffer.from(index);
    let (ids, keys) = (&mut ids[..16], &mut keys[..16]);
    let stored = f32x16::from_slice(simd, keys);
    keys_to_store::<u32x16<S>, _>(tested.nearer, tested.keys, stored).store_slice(keys);
    let stored = u32x16::from_slice(simd, ids);
    tested.nearer.select(u32x16::splat(simd, writer.id), stored).store_slice(ids);
}

/// Decides what is in doubt, one sample at a time: the depth where the sphere is covered, otherwise everything.
#[cold]
#[inline(never)]
fn decide<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    sphere: &Sphere,
    Sample { row, column }: Sample,
    ([doubt, covered], keys): ([u64; 2], &[f32; 16]),
) {
    for lane in lanes_of(doubt) {
        let sample = Sample { row, column: column + lane };
        if covered >> lane & 1 == 1 {
            writer.write_key(context, sample, keys[lane & 15]);
        } else {
            draw_sample(context, writer, sphere, sample);
        }
    }
}

/// Emits the tests of the first `count` samples, and the depth tests that are decided.
#[inline(always)]
fn emit_tests<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    first: Sample,
    count: usize,
    tested: &SphereTested<C::Simd>,
) {
    let index = writer.buffer.index(first);
    let certain = (tested.covered & !tested.doubt).to_bitmask();
    if let Some(counts) = context.sink().counts() {
        let (_, stored) = writer.buffer.from(index);
        let lanes = lanes_of(certain);
        counts.tests += count as u64;
        counts.fragments += u64::from(certain.count_ones());
        counts.depth_tests += lanes.filter(|lane| stored[*lane] != NOTHING).count() as u64;
        return;
    }
    let keys = tested.keys.to_array();
    for lane in 0..count {
        let sample = Sample { row: first.row, column: first.column + lane };
        context.sink().sample_tested(sample, writer.real_id());
        if certain >> lane & 1 == 1 {
            writer.buffer.emit_certain(context, index + lane, writer.id, keys[lane & 15]);
        }
    }
}
