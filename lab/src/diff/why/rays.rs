//! The viewing rays of a renderer with other conventions.

use super::convention::{Convention, Framing, Look, Rays, Sampling};
use crate::common::glam::DVec3;
use crate::common::{Camera, CameraDescription, Judge, Projection, Ray};
use std::ops::{Index, Range};

/// The viewing rays of a picture, one a pixel, relative to the eye.
#[derive(Clone, Debug)]
pub(super) struct ViewingRays {
    /// `x` of each column and `y` of each row on the viewport.
    pub(super) x: Coordinates,
    pub(super) y: Coordinates,
    pub(super) u: DVec3,
    pub(super) v: DVec3,
    pub(super) w: DVec3,
    pub(super) projection: Projection,
    /// Along `−w`; negative where the renderer looks backward. `d` for a perspective camera, 1 for a parallel one.
    pub(super) distance: f64,
    /// Whether the rays of a parallel camera begin at their own points of the viewport.
    pub(super) spread: bool,
    /// Where the first sample lies in its pixel, in halves of the pixel from its upper left corner.
    pub(super) twice_offsets: [f64; 2],
    axis: DVec3,
    extent: f64,
    /// How many rows and columns of rays a pixel has.
    samples: u32,
    /// The camera with these axes and this projection; its distance and its viewport may be others than the rays'.
    camera: Camera,
}

impl ViewingRays {
    /// The rays of a camera under a convention. Under ours they have the bits of
    /// [`Camera::viewing_ray`](crate::common::Camera::viewing_ray).
    pub(super) fn new(camera: &Camera, convention: &Convention) -> ViewingRays {
        let (stated, camera) = (camera, &convention.camera(camera));
        let rise = convention.pose.rise(stated);
        let [width, height] = camera.image();
        // The field is that of the scene file; axes that are not of unit length stretch what it gives.
        let stretched = |of_field: f64, of_pose: f64, of_stated: f64| {
            if of_pose == of_stated { of_field } else { of_field * (of_pose / of_stated) }
        };
        let field = convention.field.viewport(stated);
        let [vw, vh] = [0, 1]
            .map(|axis| stretched(field[axis], camera.viewport()[axis], stated.viewport()[axis]));
        let projection = convention.rays.projection(camera.projection());
        let length = match projection {
            Projection::Perspective => {
                let of_field = convention.field.distance(stated);
                stretched(of_field, camera.distance(), stated.distance())
            }
            Projection::Parallel => 1.0,
        };
        let description = CameraDescription { projection, ..*camera.description() };
        let framing = convention.framing;
        let coordinates = |sampling: Sampling, axis: usize| {
            let (side, n) = ([vw, vh][axis], [width, height][axis]);
            let spacing = side / f64::from(n);
            (0..n).map(move |index| {
                let at = sampling.coordinate(side, index, n);
                // Without a framing, nothing is rounded once more.
                if framing == Framing::default() {
                    at
                } else {
                    framing.source(axis, at / spacing) * spacing
                }
            })
        };
        let x = Coordinates::new(coordinates(convention.columns, 0).collect());
        let y = Coordinates::new(coordinates(convention.rows, 1).map(|y| rise - y).collect());
        let distance = if convention.look == Look::Backward { -length } else { length };
        ViewingRays {
            extent: x.longest() + y.longest(),
            axis: -(distance * camera.w()),
            x,
            y,
            u: camera.u(),
            v: camera.v(),
            w: camera.w(),
            projection,
            distance,
            spread: convention.rays != Rays::OneOrigin,
            twice_offsets: [convention.columns, convention.rows].map(Sampling::twice_offset),
            samples: 1,
            camera: Camera::new(description).expect("only the projection is another"),
        }
    }

    /// The same rays as samples of larger pixels, `samples` × `samples` each.
    pub(super) fn of_samples(self, samples: u32) -> ViewingRays {
        ViewingRays { samples, ..self }
    }

    /// The width and the height of a pixel on the viewport.
    pub(super) fn spacing(&self) -> [f64; 2] {
        let ([vw, vh], [width, height]) =
            (self.camera.viewport(), self.camera.image().map(f64::from));
        [vw / width, vh / height].map(|side| side * f64::from(self.samples))
    }

    /// The place of a point of the viewport on the raster, in pixels to the right of and below its upper left corner. It is not
    /// finite where a picture has one column, or one row.
    pub(super) fn on_raster(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [right, down] = self.twice_offsets;
        [self.x.index(x) + right / 2.0, self.y.index(y) + down / 2.0]
    }

    /// The ray of pixel `(i, j)`.
    pub(super) fn ray(&self, i: usize, j: usize) -> Ray {
        let across = self.x[j] * self.u + self.y[i] * self.v;
        match self.projection {
            Projection::Perspective => {
                Ray { origin: DVec3::ZERO, direction: across - self.distance * self.w }
            }
            Projection::Parallel => Ray {
                origin: if self.spread { across } else { DVec3::ZERO },
                direction: -(self.distance * self.w),
            },
        }
    }

    /// Whether all pixels have the same ray.
    pub(super) fn are_one(&self) -> bool {
        self.projection == Projection::Parallel && !self.spread
    }

    /// The judge of these rays.
    pub(super) fn judge(&self) -> Judge {
        Judge::new(&self.camera)
    }

    /// The middle of all directions: along the axis.
    pub(super) fn axis(&self) -> DVec3 {
        self.axis
    }

    /// The longest coordinates on the viewport, added.
    pub(super) fn extent(&self) -> f64 {
        self.extent
    }
}

/// Equally spaced coordinates.
#[derive(Clone, Debug)]
pub(super) struct Coordinates {
    values: Vec<f64>,
    /// The inverse of the distance between two of them.
    per_spacing: f64,
}

impl Coordinates {
    fn new(values: Vec<f64>) -> Coordinates {
        let (first, last) = (values.first().unwrap_or(&0.0), values.last().unwrap_or(&0.0));
        #[expect(clippy::cast_precision_loss, reason = "at most 2^16")]
        let per_spacing = values.len().saturating_sub(1) as f64 / (last - first);
        Coordinates { values, per_spacing }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// The place among them: 0 for the first, 1 for the second.
    fn index(&self, at: f64) -> f64 {
        (at - self.values[0]) * self.per_spacing
    }

    fn longest(&self) -> f64 {
        let ends = [self.values.first(), self.values.last()];
        ends.into_iter().flatten().map(|end| end.abs()).fold(0.0, f64::max)
    }

    /// The indices of those within `[low, high]`, and a few around them.
    pub(super) fn indices(&self, [low, high]: [f64; 2], margin: f64) -> Range<usize> {
        let count = self.values.len();
        if count <= 1 {
            return 0..count;
        }
        let [a, b] = [low, high].map(|at| self.index(at));
        if a.is_nan() || b.is_nan() {
            return 0..count;
        }
        // A hundredth of a pixel is far more than the roundoff.
        let [begin, end] = [a.min(b) - margin - 0.01, a.max(b) + margin + 0.01];
        if end < 0.0 {
            return 0..0;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number below 0 becomes 0, one above all integers the largest"
        )]
        let whole = |at: f64| at as usize;
        let end = whole(end).saturating_add(1).min(count);
        // The next whole number, without a call where the processor has no instruction for it.
        let below = whole(begin);
        #[expect(clippy::cast_precision_loss, reason = "beyond 2^53 there is no fraction")]
        let begin = if (below as f64) < begin { below.saturating_add(1) } else { below };
        begin.min(end)..end
    }
}

impl Index<usize> for Coordinates {
    type Output = f64;

    fn index(&self, index: usize) -> &f64 {
        &self.values[index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diff::why::convention::{Change, Field};

    #[test]
    fn indices_are_those_between_two_coordinates() {
        let four = Coordinates::new(vec![-3.0, -1.0, 1.0, 3.0]);
        assert_eq!(four.indices([-1.0, 1.0], 0.0), 1..3);
        assert_eq!(four.indices([-0.5, 0.5], 0.0), 2..2);
        assert_eq!(four.indices([-0.5, 0.5], 1.0), 1..3);
        assert_eq!(four.indices([-90.0, 90.0], 0.0), 0..4);
        assert_eq!(four.indices([5.0, 90.0], 0.0), 4..4);
        assert_eq!(four.indices([-90.0, -5.0], 0.0), 0..0);
        assert_eq!(four.indices([f64::NAN, 0.0], 0.0), 0..4);
        let descending = Coordinates::new(vec![3.0, 1.0, -1.0, -3.0]);
        assert_eq!(descending.indices([-1.0, 0.0], 0.0), 2..3);
    }

    #[test]
    fn our_rays_have_the_bits_of_the_camera() {
        for projection in [Projection::Perspective, Projection::Parallel] {
            let description = CameraDescription {
                projection,
                distance: 0.7,
                viewport: [1.3, 0.9],
                image: [7, 5],
                ..CameraDescription::default()
            };
            let camera = Camera::new(description).unwrap();
            let rays = ViewingRays::new(&camera, &Convention::default());
            for (i, j) in (0..5).flat_map(|i| (0..7).map(move |j| (i, j))) {
                assert_eq!(rays.ray(i as usize, j as usize), camera.viewing_ray(i, j));
            }
        }
    }

    #[test]
    fn a_renderer_that_looks_backward_sees_what_lies_behind() {
        let camera = Camera::canonical(2, 2);
        let behind = Convention::default().with(Change::Look(Look::Backward));
        let ray = ViewingRays::new(&camera, &behind).ray(0, 0);
        assert_eq!(ray.direction.to_array(), [-0.25, 0.25, 1.0]);
    }

    #[test]
    fn samples_at_corners_lie_half_a_pixel_farther_left() {
        let camera = Camera::canonical(2, 4);
        let corner = Convention::default().with(Change::Columns(Sampling::Corner));
        let rays = ViewingRays::new(&camera, &corner);
        assert_eq!(rays.x.values, [-0.5, -0.25, 0.0, 0.25]);
        assert_eq!(rays.y.values, camera.sample_grid(1).y());
    }

    #[test]
    fn rays_that_no_camera_could_state_are_rays() {
        // With d = 1, a viewport of this size would be too large.
        let stated = CameraDescription {
            distance: 1e9,
            viewport: [1e14, 1e14],
            ..*Camera::canonical(2, 4).description()
        };
        let camera = Camera::new(stated).unwrap();
        for change in Change::of_rendering(&camera) {
            let ray = ViewingRays::new(&camera, &Convention::default().with(change)).ray(1, 3);
            assert!(ray.direction.is_finite(), "{change:?}");
        }
    }

    #[test]
    fn where_1_is_taken_for_d_the_viewport_is_as_stated_and_lies_at_1() {
        let stated = CameraDescription { distance: 2.0, ..*Camera::canonical(2, 4).description() };
        let camera = Camera::new(stated).unwrap();
        let left_out = Convention::default().with(Change::Field(Field::DistanceLeftOut));
        let [ours, theirs] = [Convention::default(), left_out]
            .map(|convention| ViewingRays::new(&camera, &convention).ray(0, 3).direction);
        assert_eq!([ours.z, theirs.z], [-2.0, -1.0]);
        assert_eq!(ours.truncate(), theirs.truncate());
    }
}
