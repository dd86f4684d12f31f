//! The judge: what is true of the samples of one camera.

use super::cover::{self, EdgeSigns, EdgeValues, Nudge, Side};
use super::nearest::{self, Comparison};
use super::sign::Sign;
use crate::camera::{Camera, Projection, Ray};
use crate::scene::primitive::Primitive;
use glam::DVec3;

/// Decides what is true of the samples of one camera.
///
/// Primitives are given relative to the eye, as [`View::primitive`](crate::View::primitive) gives them, and rays are
/// viewing rays of this camera. Their numbers are finite, as those of a [`View`](crate::View) and a [`Camera`] are: of others
/// nothing is promised, and a function may panic.
///
/// ```
/// use bothways_common::{Camera, Judge, Primitive, glam::DVec3};
///
/// let camera = Camera::canonical(2, 2);
/// let ball = Primitive::Sphere { center: DVec3::new(0.0, 0.0, -3.0), radius: 1.5 };
/// assert!(Judge::new(&camera).covers(&ball, &camera.viewing_ray(0, 0)));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Judge {
    pub(super) projection: Projection,
    nudge: Nudge,
    /// Where the camera looks, `−w`.
    pub(super) forward: DVec3,
}

impl Judge {
    /// The judge of one camera's samples.
    pub fn new(camera: &Camera) -> Judge {
        let nudge = Nudge { u: camera.u(), v: camera.v() };
        Judge { projection: camera.projection(), nudge, forward: -camera.w() }
    }

    /// Whether a primitive covers the sample that a viewing ray of this camera passes through.
    ///
    /// - A triangle covers a sample that is inside all of its edges and has `t > 0`, seen from either side. A sample on
    ///   an edge is on the side to which it comes when it is moved infinitely little to the right, and far less still
    ///   down. A triangle that is seen edge-on covers nothing.
    /// - A sphere covers a sample whose ray meets it at two points, at least one of them at `t > 0`. A ray that only
    ///   touches the sphere misses it.
    /// - A plane covers a sample whose ray meets it at one point, at `t > 0`.
    ///
    /// # Panics
    ///
    /// Perhaps, if a number of the primitive or the ray is NaN or infinite.
    pub fn covers(&self, primitive: &Primitive, ray: &Ray) -> bool {
        match primitive {
            Primitive::Triangle(triangle) => {
                cover::triangle_covers(self.projection, &self.nudge, triangle, ray)
            }
            Primitive::Sphere { center, radius } => cover::sphere_covers(*center, *radius, ray),
            Primitive::Plane { point, normal } => cover::plane_covers(*point, *normal, ray),
        }
    }

    /// [`Judge::covers`] with the signs that decide it, where they are a triangle's.
    pub fn coverage(&self, primitive: &Primitive, ray: &Ray) -> Coverage {
        match primitive {
            Primitive::Triangle(triangle) => {
                let edges = self.edge_signs(triangle, ray);
                Coverage { covers: edges.covers(), edges: Some(edges) }
            }
            Primitive::Sphere { .. } | Primitive::Plane { .. } => {
                Coverage { covers: self.covers(primitive, ray), edges: None }
            }
        }
    }

    /// [`Judge::covers`] as a loop over samples asks it: with the signs of a triangle's edge functions, and no sign
    /// computed that neither is shown nor decides.
    pub fn test(&self, primitive: &Primitive, ray: &Ray) -> SampleTest {
        match primitive {
            Primitive::Triangle(triangle) => {
                let signs = cover::sample_signs(self.projection, triangle, ray);
                let covers =
                    cover::signs_cover(self.projection, &self.nudge, triangle, ray, &signs);
                SampleTest { covers, edge_signs: Some(signs) }
            }
            Primitive::Sphere { .. } | Primitive::Plane { .. } => {
                SampleTest { covers: self.covers(primitive, ray), edge_signs: None }
            }
        }
    }

    /// The facing `F` of a triangle: negative when its corners are seen counter-clockwise, zero for
    /// edge-on. It is the same for every ray of the camera.
    pub fn facing(&self, triangle: &[DVec3; 3], ray: &Ray) -> Sign {
        cover::facing(self.projection, triangle, ray)
    }

    /// Whether a flat primitive covers no sample at all, because the camera sees it edge-on: `F = 0` of
    /// a triangle, a plane that holds the eye, or one along the rays of a parallel camera. A sphere is
    /// never seen edge-on.
    pub fn is_edge_on(&self, primitive: &Primitive) -> bool {
        let axis = Ray { origin: DVec3::ZERO, direction: self.forward };
        match primitive {
            Primitive::Triangle(corners) => self.facing(corners, &axis) == Sign::Zero,
            Primitive::Plane { point, normal } => {
                let along = match self.projection {
                    Projection::Perspective => *point,
                    Projection::Parallel => self.forward,
                };
                cover::is_perpendicular(*normal, along)
            }
            Primitive::Sphere { .. } => false,
        }
    }

    /// The signs that decide whether a triangle covers a sample, ties shown.
    pub fn edge_signs(&self, triangle: &[DVec3; 3], ray: &Ray) -> EdgeSigns {
        cover::edge_signs(self.projection, &self.nudge, triangle, ray)
    }

    /// The numbers behind [`Judge::edge_signs`], and what kind of edge a sample lies on.
    pub fn edge_values(&self, triangle: &[DVec3; 3], ray: &Ray) -> EdgeValues {
        cover::edge_values(self.projection, &self.nudge, triangle, ray)
    }

    /// What kind of edge a sample lies on, of each of the three: [`EdgeValues::sides`] for these signs, without the
    /// numbers.
    pub fn edge_sides(
        &self,
        triangle: &[DVec3; 3],
        ray: &Ray,
        signs: &EdgeSigns,
    ) -> [Option<Side>; 3] {
        cover::edge_sides(self.projection, &self.nudge, triangle, ray, signs)
    }

    /// Compares the distances of two primitives that both cover the sample; `Less` says that the first is nearer.
    pub fn compare(&self, first: &Primitive, second: &Primitive, ray: &Ray) -> Comparison {
        nearest::compare(self.projection, &self.nudge, first, second, ray)
    }

    /// Whether an incoming primitive is seen rather than the stored one, both with their ids; both cover the
    /// sample. What no distance tells apart, the smaller id does.
    pub fn nearer(
        &self,
        (incoming_id, incoming): (u64, &Primitive),
        (stored_id, stored): (u64, &Primitive),
        ray: &Ray,
    ) -> bool {
        let order = self.compare(incoming, stored, ray).decided;
        order.then(incoming_id.cmp(&stored_id)).is_lt()
    }

    /// The distance `t` of a primitive that covers the sample, in lengths of the ray's direction, to within a few parts
    /// in 10¹⁰ of itself.
    ///
    /// # Panics
    ///
    /// Perhaps, if the primitive does not cover the sample; where this does not panic, the answer means nothing.
    /// [`Judge::covers`] tells.
    pub fn distance(&self, primitive: &Primitive, ray: &Ray) -> f64 {
        nearest::distance(primitive, ray)
    }
}

/// Whether a primitive covers a sample, and on which side of its edges the sample lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleTest {
    /// Whether the primitive covers the sample.
    pub covers: bool,
    /// The signs of a triangle's `E_ab`, `E_bc`, `E_ca` at the sample itself; `None` for a sphere or a plane.
    pub edge_signs: Option<[Sign; 3]>,
}

/// Whether a primitive covers a sample, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Coverage {
    /// Whether the primitive covers the sample.
    pub covers: bool,
    /// The signs that decide it for a triangle; `None` for a sphere or a plane.
    pub edges: Option<EdgeSigns>,
}
