//! A triangle that is set up in `f64`.

use super::camera_map::CameraMap;
use super::one_primitive::edges::F64Setup;
use super::one_primitive::fragment_writer::FragmentWriter;
use super::one_primitive::narrow::Narrowing;
use super::one_primitive::strips::{STRIP, TALL, strips};
use super::setup::FlatSetup;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use bothways_common::{Projection, Sign};
use glam::DVec3;
use std::ops::Range;

/// Draws a triangle, as far as it lies in the tile, by tall strips where `f32` is certain enough of depths in all of one, by
/// strips elsewhere, and sample by sample where it is not certain enough in these.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    corners: &[DVec3; 3],
    region: &Region,
) {
    let (map, keys) = (writer.picture.map, writer.picture.keys);
    let judge = writer.picture.view.judge();
    let Some(setup) = F64Setup::new::<C::Fault>(map, &judge, corners) else { return };
    let is_wide = region.columns.len() > STRIP[1];
    let triangle = &LargeTriangle { map, setup: &setup, region, is_wide };
    let here = region.intersection(writer.buffer.region());
    if is_wide && triangle.is_beside(&here) {
        return;
    }
    let narrowing = &Narrowing::of_triangle(map, keys, &setup, (writer.id, corners));
    for rows in strips(&here.rows, &region.rows, TALL) {
        for columns in strips(&here.columns, &triangle.columns(&rows), STRIP[1]) {
            let tall = Region { rows: rows.clone(), columns };
            match narrowing.strip::<C::Fault>(&tall) {
                Some(narrowed) if !C::WATCHED => writer.write_strip(context, &narrowed),
                narrowed => triangle.draw_strips(context, writer, &tall, (narrowing, narrowed)),
            }
        }
    }
}

/// A triangle that is drawn strip by strip.
struct LargeTriangle<'a> {
    map: &'a CameraMap<'a>,
    setup: &'a F64Setup,
    region: &'a Region,
    /// Whether its region is cut to what the edge functions leave of each strip.
    is_wide: bool,
}

impl LargeTriangle<'_> {
    /// The columns in which it may cover samples of some rows.
    #[inline(always)]
    fn columns(&self, rows: &Range<usize>) -> Range<usize> {
        if self.is_wide {
            let ys = [self.map.grid.y()[rows.start], self.map.grid.y()[rows.end - 1]];
            self.setup.span(self.map, ys, &self.region.columns)
        } else {
            self.region.columns.clone()
        }
    }

    /// Whether all strips of a part of the region are empty: in most parts of that of a sliver. On the rows of all
    /// strips together no edge function is less than on those of one, so the columns of each are among those of all.
    #[inline(always)]
    fn is_beside(&self, here: &Region) -> bool {
        if here.rows.is_empty() || here.columns.is_empty() {
            return true;
        }
        // Strips reach beyond the part.
        let first = (here.rows.start / TALL * TALL).max(self.region.rows.start);
        let end = here.rows.end.next_multiple_of(TALL).min(self.region.rows.end);
        let columns = self.columns(&(first..end));
        columns.end <= here.columns.start || here.columns.end <= columns.start
    }

    /// Draws the strips of a tall one, each by what the tall one is narrowed to, if it is. So are watched frames, whose
    /// events are those of strips.
    #[inline(always)]
    fn draw_strips<C: Context>(
        &self,
        context: &mut C,
        writer: &mut FragmentWriter,
        tall: &Region,
        (narrowing, narrowed): (&Narrowing, Option<FlatSetup>),
    ) {
        let here = tall.intersection(writer.buffer.region());
        for rows in strips(&here.rows, &self.region.rows, STRIP[0]) {
            let strip = Region { columns: self.columns(&rows), rows }.intersection(tall);
            if strip.columns.is_empty() {
                continue;
            }
            let narrowed = match &narrowed {
                Some(tall) => Some(FlatSetup { region: strip.clone(), ..tall.clone() }),
                None => narrowing.strip::<C::Fault>(&strip),
            };
            if let Some(narrowed) = narrowed {
                writer.write_strip(context, &narrowed);
            } else {
                let here = strip.intersection(&here);
                draw_samples(&mut context.scalar(), writer, self.setup, here);
            }
        }
    }
}

/// Draws samples one by one.
fn draw_samples<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    setup: &F64Setup,
    here: Region,
) {
    writer.buffer.executed.single_samples += here.area() as u64;
    let map = writer.picture.map;
    let (xs, ys) = (map.grid.x(), map.grid.y());
    let eye = map.depth_of_eye();
    let [ab, bc, ca] = &setup.edges;
    for row in here.rows {
        let y = ys[row];
        let on_row = [ab.on_row(y), bc.on_row(y), ca.on_row(y)];
        let depth_on_row = setup.depth.on_row(y);
        for column in here.columns.clone() {
            let (x, sample) = (xs[column], Sample { row, column });
            let e =
                [on_row[0] + x * ab.across, on_row[1] + x * bc.across, on_row[2] + x * ca.across];
            context.sink().sample_tested(sample, writer.real_id());
            let out = e[0] < -ab.error || e[1] < -bc.error || e[2] < -ca.error;
            let inside = e[0] > ab.error && e[1] > bc.error && e[2] > ca.error;
            if out || inside {
                context.sink().edge_signs(sample, writer.real_id(), certain_signs(setup, &e));
            }
            if out || (!inside && !writer.judge_covers(context, sample)) {
                continue;
            }
            let depth = setup.depth.at(depth_on_row, x);
            // A perspective ray meets what it covers in front of the eye; a parallel one may not.
            let behind = map.projection() == Projection::Parallel
                && (depth.high < eye
                    || (inside && depth.low <= eye && !writer.judge_covers(context, sample)));
            if !behind {
                writer.write(context, sample, depth);
            }
        }
    }
}

/// The edges' signs as far as they are certain, in the orientation of the contract.
fn certain_signs(setup: &F64Setup, e: &[f64; 3]) -> [Option<Sign>; 3] {
    std::array::from_fn(|k| {
        (e[k].abs() > setup.edges[k].error).then(|| Sign::of(setup.facing * e[k]))
    })
}
