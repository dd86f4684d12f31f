//! What the vector paths leave, one primitive at a time, set up in `f64`: triangles that are large, reach to the eye's
//! plane or are almost edge-on, and planes, both strip by strip; spheres, sample by sample.

pub(super) mod edges;
pub(super) mod fragment_writer;
pub(super) mod narrow;
pub(super) mod strips;

use super::answer::Answer;
use super::bounds::region;
use super::picture::Picture;
use super::plane;
use super::sphere::Sphere;
use super::tile::TileBuffer;
use super::triangle;
use bothways_common::Primitive;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::Interval;
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use fragment_writer::FragmentWriter;
use glam::DVec3;

/// Draws primitives, as far as they lie in the tile.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    ids: &[u32],
    picture: &Picture,
    buffer: &mut TileBuffer,
) {
    // Eight primitives are looked up before the first is drawn, so that the machine waits for their memory only once.
    for ids in ids.chunks(8) {
        if C::WATCHED && context.sink().has_enough() {
            return;
        }
        let last = ids.len() - 1;
        let primitives: [Primitive; 8] =
            std::array::from_fn(|k| picture.view.primitive(ids[k.min(last)]));
        for (id, primitive) in ids.iter().zip(primitives) {
            draw_primitive(context, &mut FragmentWriter { id: *id, primitive, picture, buffer });
        }
    }
}

#[inline(always)]
fn draw_primitive<C: Context>(context: &mut C, writer: &mut FragmentWriter) {
    let region = region::<C::Fault>(&writer.primitive, writer.picture.map);
    match writer.primitive {
        Primitive::Triangle(corners) => triangle::draw(context, writer, &corners, &region),
        Primitive::Sphere { center, radius } => {
            draw_sphere(&mut context.scalar(), writer, (center, radius), &region);
        }
        Primitive::Plane { point, normal } => {
            plane::draw(context, writer, [point, normal], &region);
        }
    }
}

/// Draws a sphere, as far as it lies in the tile, sample by sample.
fn draw_sphere<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    (center, radius): (DVec3, f64),
    region: &Region,
) {
    let map = writer.picture.map;
    let sphere = Sphere::new(map, center, radius, !C::has(Planted::ZeroErrorBound));
    let here = region.intersection(writer.buffer.region());
    writer.buffer.executed.single_samples += here.area() as u64;
    for row in here.rows {
        for column in here.columns.clone() {
            let sample = Sample { row, column };
            let ray = map.grid.ray(row, column);
            context.sink().sample_tested(sample, writer.id);
            let answer = if C::has(Planted::InfiniteErrorBound) {
                Answer::Open
            } else {
                sphere.answer(&ray)
            };
            match answer {
                Answer::Hit(depth) => writer.write(context, sample, depth),
                Answer::Miss => {}
                Answer::Open => {
                    if writer.judge_covers(context, sample) {
                        writer.write(context, sample, Interval::ALL);
                    }
                }
            }
        }
    }
}
