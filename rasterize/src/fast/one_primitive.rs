//! What the vector paths leave, one primitive at a time, set up in `f64`: triangles that are large, reach to the eye's
//! plane or are almost edge-on, and planes, both strip by strip; spheres, row by row.

pub(super) mod edges;
pub(super) mod fragment_writer;
pub(super) mod narrow;
pub(super) mod strips;

use super::bounds::region;
use super::fragments::Fragments;
use super::picture::Picture;
use super::tile::TileBuffer;
use super::{plane, sphere, triangle};
use bothways_common::Primitive;
use bothways_common::engine::context::Context;
use bothways_common::engine::simd::apart;
use bothways_common::observe::Events;
use fragment_writer::FragmentWriter;

/// Draws primitives, as far as they lie in the tile.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    ids: &[u32],
    (picture, fragments): (&Picture, &mut Fragments),
    buffer: &mut TileBuffer,
) {
    // Eight primitives are looked up before the first is drawn, so that the machine waits for their memory only once.
    for ids in ids.chunks(8) {
        if C::WATCHED && context.sink().has_enough() {
            return;
        }
        let last = ids.len() - 1;
        let primitives: [Primitive; 8] =
            std::array::from_fn(|k| buffer.names.primitive(picture.view, ids[k.min(last)]));
        for (id, primitive) in ids.iter().zip(primitives) {
            let writer = FragmentWriter { id: *id, primitive, picture, fragments, buffer };
            draw_primitive(context, writer);
        }
    }
}

#[inline(always)]
fn draw_primitive<C: Context>(context: &mut C, writer: FragmentWriter) {
    let region = &region::<C::Fault>(&writer.primitive, writer.picture.map);
    let simd = context.simd();
    // The writer is moved into the function that draws, which can then keep its fields in registers.
    match writer.primitive {
        Primitive::Triangle(corners) => {
            apart!(simd, triangle::draw(context, &mut { writer }, &corners, region));
        }
        Primitive::Sphere { center, radius } => {
            apart!(simd, sphere::draw(context, &mut { writer }, (center, radius), region));
        }
        Primitive::Plane { point, normal } => {
            apart!(simd, plane::draw(context, &mut { writer }, [point, normal], region));
        }
    }
}
