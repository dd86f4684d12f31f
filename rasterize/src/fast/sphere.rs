//! A sphere: sixteen samples at a time where rounding lets its equation be a sum of functions on the raster, and
//! otherwise by its equation against the rays of samples.
//!
//! [`forms`] are those functions, [`rows`] and [`blocks`] their use. [`by_sample`] asks the equation: [`equation`] takes what it is given relative to the
//! eye; [`from_afar`] takes it relative to the local origin.

mod blocks;
mod by_sample;
mod equation;
mod forms;
mod from_afar;
mod rows;

pub(super) use equation::nearer;

use super::one_primitive::fragment_writer::FragmentWriter;
use bothways_common::engine::context::Context;
use bothways_common::engine::fault::Planted;
use bothways_common::raster::Region;
use by_sample::{Sphere, draw_samples};
use forms::Forms;
use glam::DVec3;

/// Draws a sphere, as far as it lies in the tile. `region` is that of the whole picture.
#[inline(always)]
pub(super) fn draw<C: Context>(
    context: &mut C,
    writer: &mut FragmentWriter,
    (center, radius): (DVec3, f64),
    region: &Region,
) {
    let (map, keys) = (writer.picture.map, writer.picture.keys);
    let here = region.intersection(writer.buffer.region());
    if here.is_empty() {
        return;
    }
    let sphere = Sphere::new(map, center, radius, !C::has(Planted::ZeroErrorBound));
    match Forms::new::<C::Fault>(map, keys, (center, radius), region) {
        Some(forms) => blocks::draw(context, writer, (&sphere, &forms), &here),
        None => draw_samples(&mut context.scalar(), writer, &sphere, here),
    }
}
