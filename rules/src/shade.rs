//! The look of what a rule sees: in `f64`, at the point where the rule's own ray is after its `t`.
//!
//! A rule may see a primitive beside its edge or out of its depth. So the point is taken from the stored `t`, and nothing
//! here asks whether the ray really meets the primitive there.

use crate::samples::Samples;
use bothways_common::engine::simd::{Simd, SimdBase, SimdNarrow, best_level, f32x16, f64x8};
use bothways_common::look::bands::{
    self, LocalVector, MOST_LIGHTS, Points, SetUp, Sixteen, Surfaces, TowardsViewer, Wanted,
};
use bothways_common::look::lanes::{DVec3x8, Vec3x16};
use bothways_common::look::texture::{self, TexturePoints};
use bothways_common::{Frame, Primitive, Projection, Ray, Sample, Shape, View};
use glam::{DVec2, DVec3, Vec3};
use std::convert::Infallible;

/// Gives a frame its picture; also all else that it keeps of the look of what is seen.
pub(crate) fn shade(view: &View, samples: &Samples, frame: &mut Frame) {
    bands::shade(view, frame, &AsSeen { view, samples }, best_level());
}

/// The surfaces of a view as a rule sees them.
struct AsSeen<'a> {
    view: &'a View<'a>,
    samples: &'a Samples<'a>,
}

impl Surfaces for AsSeen<'_> {
    /// Its id.
    type Surface = u64;
    type Local = Infallible;
    type Along = ();

    fn to_viewer<S: Simd>(
        &self,
        simd: S,
        _row: &TowardsViewer,
        first: Sample,
        _x: f32x16<S>,
    ) -> Vec3x16<S> {
        let [low, high] = [first, Sample { column: first.column + 8, ..first }].map(|first| {
            let rays = self.rays(first);
            DVec3x8::from_fn(simd, |lane| -rays[lane].direction)
        });
        low.narrow(high)
    }

    fn set_up(
        &self,
        seen: &bands::Seen,
        _wanted: Wanted,
        _ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> SetUp<u64, Infallible> {
        SetUp::Surface(seen.id)
    }

    fn at<S: Simd>(
        &self,
        simd: S,
        id: &u64,
        (): &(),
        samples: &Sixteen<S>,
        points: &mut Points<'_>,
    ) {
        let halves = [&samples.low, &samples.high].map(|samples| -> [Seen; 8] {
            let rays = self.rays(samples.first);
            std::array::from_fn(|lane| self.seen(&rays[lane], *id, samples.t[lane]))
        });
        let vectors = |of: fn(&Seen) -> DVec3| {
            halves.each_ref().map(|seen| DVec3x8::from_fn(simd, |lane| of(&seen[lane])))
        };
        let numbers = |of: fn(&Texture) -> DVec2| {
            halves.each_ref().map(|seen| {
                [0, 1].map(|k| {
                    f64x8::from_fn(simd, |lane| {
                        seen[lane].texture.as_ref().map_or(0.0, |t| of(t)[k])
                    })
                })
            })
        };
        let [low, high] = vectors(|seen| seen.normal);
        points.set_normals(low.narrow(high));
        points.set_points(vectors(|seen| seen.position));
        if halves[0][0].texture.is_some() {
            let [low, high] = numbers(|texture| texture.footprint);
            points.set_texture(&TexturePoints {
                halves: numbers(|texture| texture.coordinate),
                footprint: [low[0].narrow(high[0]), low[1].narrow(high[1])],
            });
        }
    }
}

/// What is seen at one sample.
struct Seen {
    position: DVec3,
    normal: DVec3,
    texture: Option<Texture>,
}

/// A texture coordinate, and how far it changes to the neighbouring samples.
struct Texture {
    coordinate: DVec2,
    footprint: DVec2,
}

impl AsSeen<'_> {
    /// The rays of eight samples; those beyond the row's end are the last one's.
    fn rays(&self, first: Sample) -> [Ray; 8] {
        let [_, columns] = self.samples.size();
        std::array::from_fn(|lane| {
            self.samples.ray(first.row, (first.column + lane).min(columns as usize - 1))
        })
    }

    /// What a primitive looks like along a ray at `t`.
    fn seen(&self, ray: &Ray, id: u64, t: f64) -> Seen {
        let (view, position) = (self.view, ray.origin + t * ray.direction);
        let point = Point { view, id, primitive: view.primitive(id), position };
        let normal = point.normal(ray.direction);
        let texture = point.texture().map(|(coordinate, gradients)| {
            let [across, down] = steps(self.samples, ray, t, normal)
                .map(|step| DVec2::from(gradients.map(|gradient| gradient.dot(step))));
            Texture { coordinate, footprint: across.abs() + down.abs() }
        });
        Seen { position, normal, texture }
    }
}

/// How the point moves from a sample to the next one across, and to the next one down, on the tangent plane.
fn steps(samples: &Samples, ray: &Ray, t: f64, normal: DVec3) -> [DVec3; 2] {
    let camera = samples.camera();
    let [rows, columns] = samples.size().map(f64::from);
    let [vw, vh] = camera.viewport();
    [camera.u() * (vw / columns), camera.v() * (-vh / rows)].map(|step| {
        let moved = match camera.projection() {
            Projection::Perspective => t * step,
            Projection::Parallel => step,
        };
        moved - normal.dot(moved) / normal.dot(ray.direction) * ray.direction
    })
}

/// A point of a primitive.
struct Point<'a> {
    view: &'a View<'a>,
    id: u64,
    primitive: Primitive,
    /// Relative to the eye.
    position: DVec3,
}

impl Point<'_> {
    /// The unit normal, against the direction of view.
    fn normal(&self, direction: DVec3) -> DVec3 {
        let (flat, smooth) = match self.primitive {
            Primitive::Sphere { center, .. } => (self.position - center, None),
            Primitive::Plane { normal, .. } => (normal, None),
            Primitive::Triangle(corners) => (face_normal(corners), self.smooth_normal(corners)),
        };
        let normal = smooth.unwrap_or(flat).normalize_or(flat.normalize_or_zero());
        if flat.dot(direction) > 0.0 { -normal } else { normal }
    }

    fn smooth_normal(&self, corners: [DVec3; 3]) -> Option<DVec3> {
        let (object, local) = self.view.scene.locate(self.id);
        let normals = match &self.view.scene.objects()[object].shape {
            Shape::Mesh(mesh) => mesh.normals().of(local)?.map(Vec3::as_dvec3),
            Shape::Instances(instances) => instances.corner_normals(local)?,
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => return None,
        };
        let normals = normals.map(DVec3::normalize_or_zero);
        let weights = weights(corners, self.position);
        Some(weights.into_iter().zip(normals).map(|(weight, normal)| weight * normal).sum())
    }

    /// The texture coordinate, and the directions in which its two numbers grow.
    fn texture(&self) -> Option<(DVec2, [DVec3; 2])> {
        match self.primitive {
            Primitive::Sphere { center, .. } => Some(texture::on_sphere(self.position - center)),
            Primitive::Plane { point, normal } => {
                let axes = texture::plane_axes(normal);
                Some((DVec2::from(axes.map(|axis| axis.dot(self.position - point))), axes))
            }
            Primitive::Triangle(corners) => {
                let (object, local) = self.view.scene.locate(self.id);
                let values = texture::corners(&self.view.scene.objects()[object].shape, local)?;
                let weights = weights(corners, self.position);
                let coordinate =
                    weights.into_iter().zip(values).map(|(weight, value)| weight * value).sum();
                Some((coordinate, gradients(corners, values)))
            }
        }
    }
}

fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// The barycentric coordinates of a point of a triangle's plane.
fn weights([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let normal = face_normal([a, b, c]);
    [(b, c), (c, a), (a, b)]
        .map(|(from, to)| (from - point).cross(to - point).dot(normal) / normal.length_squared())
}

/// The gradients of the two texture coordinates of a triangle.
fn gradients(corners: [DVec3; 3], values: [DVec2; 3]) -> [DVec3; 2] {
    let normal = face_normal(corners);
    let [a, b, c] = corners;
    // The weight of a corner grows away from the opposite side.
    let growth = [c - b, a - c, b - a].map(|side| normal.cross(side) / normal.length_squared());
    [0, 1].map(|k| growth.into_iter().zip(values).map(|(growth, value)| growth * value[k]).sum())
}
