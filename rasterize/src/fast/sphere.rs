//! A sphere: sixteen samples at a time where rounding lets its equation be a sum of functions on the raster, and
//! otherwise by its equation against the rays of samples.
//!
//! [`forms`] are those functions, [`rows`] and [`blocks`] their use. [`equation`] takes what it is given relative to the
//! eye; [`from_afar`] takes it relative to the local origin.

mod blocks;
mod equation;
mod forms;
mod from_afar;
mod rows;

pub(super) use equation::nearer;

use super::answer::Answer;
use super::camera_map::CameraMap;
use super::one_primitive::fragment_writer::FragmentWriter;
use bothways_common::engine::context::{Context, ScalarContext};
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::Interval;
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use bothways_common::{Projection, Ray};
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

/// Draws samples one by one.
fn draw_samples<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    sphere: &Sphere,
    here: Region,
) {
    writer.buffer.executed.single_samples += here.area() as u64;
    for row in here.rows {
        for column in here.columns.clone() {
            let sample = Sample { row, column };
            context.sink().sample_tested(sample, writer.real_id());
            draw_sample(context, writer, sphere, sample);
        }
    }
}

/// Draws one sample, by the sphere's equation.
#[inline(always)]
fn draw_sample<C: ScalarContext>(
    context: &mut C,
    writer: &mut FragmentWriter,
    sphere: &Sphere,
    sample: Sample,
) {
    let ray = writer.picture.map.grid.ray(sample.row, sample.column);
    let answer =
        if C::has(Planted::InfiniteErrorBound) { Answer::Open } else { sphere.answer(&ray) };
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

/// A sphere, ready to be tested against rays.
#[derive(Clone, Copy, Debug)]
struct Sphere {
    projection: Projection,
    /// Relative to the eye.
    center: DVec3,
    /// Relative to the local origin.
    local_center: DVec3,
    radius: f64,
    /// Whether the local origin is another point than the eye.
    has_local_origin: bool,
    /// Whether all of the sphere is certainly in front of the eye.
    is_in_front: bool,
    /// Whether bounds of rounding errors hold; with a planted fault they are zero.
    exact: bool,
}

impl Sphere {
    fn new(map: &CameraMap, center: DVec3, radius: f64, exact: bool) -> Sphere {
        let (extent, depth) = (center.abs().element_sum() + radius, -center.dot(map.w));
        Sphere {
            projection: map.projection(),
            center,
            local_center: map.local.relative(center),
            radius,
            has_local_origin: map.local.t > 0.0,
            is_in_front: depth - radius >= extent * (-10f64).exp2(),
            exact,
        }
    }

    /// The answer for a ray.
    #[inline(always)]
    fn answer(&self, ray: &Ray) -> Answer {
        let Sphere { projection, center, local_center, radius, exact, .. } = *self;
        if self.has_local_origin && self.is_in_front {
            return from_afar::answer(local_center, radius, ray, exact);
        }
        match equation::answer(projection, center, radius, ray, exact) {
            // The depth from the eye is not that from the local origin.
            Answer::Hit(_) if self.has_local_origin => Answer::Hit(Interval::ALL),
            answer => answer,
        }
    }
}
