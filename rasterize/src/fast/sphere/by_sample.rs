//! A sphere tested at one sample after the other, by its equation.

use super::{equation, from_afar};
use crate::fast::answer::Answer;
use crate::fast::camera_map::CameraMap;
use crate::fast::one_primitive::fragment_writer::FragmentWriter;
use bothways_common::engine::context::ScalarContext;
use bothways_common::engine::fault::Planted;
use bothways_common::engine::roundoff::Interval;
use bothways_common::observe::Events;
use bothways_common::raster::{Region, Sample};
use bothways_common::{Projection, Ray};
use glam::DVec3;

/// A sphere, ready to be tested against rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sphere {
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
    pub(super) fn new(map: &CameraMap, center: DVec3, radius: f64, exact: bool) -> Sphere {
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
    pub(super) fn answer(&self, ray: &Ray) -> Answer {
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

/// Draws samples one by one.
pub(super) fn draw_samples<C: ScalarContext>(
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
pub(super) fn draw_sample<C: ScalarContext>(
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
