//! A plane, set up in `f64` and drawn as a large triangle is: strip by strip.

use super::depth::{depth_plane, sign_in_front};
use super::one_primitive::fragment_writer::FragmentWriter;
use super::one_primitive::narrow::Narrowing;
use super::one_primitive::strips::{STRIP, strips};
use super::viewport_affine::ViewportAffine;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::error_bound;
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use glam::DVec3;

/// Draws a plane, as far as it lies in the tile, strip by strip.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    [point, normal]: [DVec3; 2],
    region: &Region,
) {
    if writer.buffer.is_edge_on(writer.id, &writer.primitive) {
        return;
    }
    let (map, keys) = (writer.picture.map, writer.picture.keys);
    let mut depth = depth_plane(map, point, normal, normal.abs());
    depth.error = error_bound::<C::Fault>(depth.error);
    let narrowing = Narrowing::of_plane(map, keys, &depth, writer.id);
    let here = region.intersection(writer.buffer.region());
    for rows in strips(&here.rows, &region.rows, STRIP[0]) {
        for columns in strips(&here.columns, &region.columns, STRIP[1]) {
            let strip = Region { rows: rows.clone(), columns };
            if let Some(plane) = narrowing.strip::<C::Fault>(&strip) {
                writer.write_strip(context, &plane);
            } else {
                draw_samples(&mut context.scalar(), writer, &depth, strip.intersection(&here));
            }
        }
    }
}

/// Draws samples one by one.
fn draw_samples<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    depth: &ViewportAffine,
    here: Region,
) {
    writer.buffer.executed.single_samples += here.area() as u64;
    let map = writer.picture.map;
    let (side, eye) = (sign_in_front(map.projection()), map.depth_of_eye());
    let (xs, ys) = (map.grid.x(), map.grid.y());
    for row in here.rows {
        let on_row = depth.on_row(ys[row]);
        for column in here.columns.clone() {
            let sample = Sample { row, column };
            let depth = depth.at(on_row, xs[column]);
            context.sink().sample_tested(sample, writer.real_id());
            // In front of the eye the depth has this side's sign, behind it the other.
            let [near, far] =
                if side > 0.0 { [depth.low, depth.high] } else { [-depth.high, -depth.low] };
            if near > eye || (far >= eye && writer.judge_covers(context, sample)) {
                writer.write(context, sample, depth);
            }
        }
    }
}
