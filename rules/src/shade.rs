//! The look of what a rule sees: in `f64`, at the point where the rule's own ray is after its `t`.
//!
//! A rule may see a primitive beside its edge or out of its depth. So the point is taken from the stored `t`, and nothing
//! here asks whether the ray really meets the primitive there.

use crate::samples::Samples;
use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::look::shade::{SurfacePoint, color};
use bothways_common::look::texture::{self, TexturePoint};
use bothways_common::{Frame, Primitive, Projection, Ray, Shape, View};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Gives every sample its colour; also its normal and its texture coordinate, if the frame keeps them.
pub(crate) fn shade(view: &View, samples: &Samples, frame: &mut Frame) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    frame.shading_rows().into_par_iter().for_each(|row| shade_row(view, samples, row));
}

fn shade_row(view: &View, samples: &Samples, mut row: ShadingRow) {
    for (index, (column, &id)) in row.columns.zip(row.ids).enumerate() {
        let (color, normal, coordinate) = if id == NO_PRIMITIVE {
            (view.scene.background, Vec3::ZERO, Vec2::ZERO)
        } else {
            let ray = samples.ray(row.row, column);
            look(view, samples, &ray, id, f64::from(row.t[index]))
        };
        row.colors[index] = color;
        if let Some(kept) = &mut row.normals {
            kept[index] = normal;
        }
        if let Some(kept) = &mut row.texture_coordinates {
            kept[index] = coordinate;
        }
    }
}

/// Colour, normal and texture coordinate of a primitive, seen along a ray at `t`.
fn look(view: &View, samples: &Samples, ray: &Ray, id: u32, t: f64) -> (Vec3, Vec3, Vec2) {
    let point =
        Point { view, id, primitive: view.primitive(id), position: ray.origin + t * ray.direction };
    let normal = point.normal(ray.direction);
    let texture = point.texture().map(|(coordinate, gradients)| {
        let [across, down] = steps(samples, ray, t, normal)
            .map(|step| DVec2::from(gradients.map(|gradient| gradient.dot(step))));
        TexturePoint::new(coordinate, across, down)
    });
    let surface = SurfacePoint {
        position: point.position,
        normal: normal.as_vec3(),
        to_viewer: -ray.direction.normalize().as_vec3(),
        texture,
    };
    let (object, local) = view.scene.locate(id);
    let material = view.scene.objects()[object].material_of(local);
    let coordinate = texture.map_or(Vec2::ZERO, |texture| texture.stored());
    (color(&surface, material, &view.scene.lights, view.camera.eye()), surface.normal, coordinate)
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
    id: u32,
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
        let Shape::Mesh(mesh) = &self.view.scene.objects()[object].shape else { return None };
        let normals = mesh.normals().of(local)?.map(|n| n.as_dvec3().normalize_or_zero());
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
