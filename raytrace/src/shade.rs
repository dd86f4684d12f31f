//! The look of what is seen: image order goes back along each ray to the point that it hit.

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::look::shade::{SurfacePoint, color};
use bothways_common::look::texture::{self, TexturePoint};
use bothways_common::{Frame, Primitive, Projection, Ray, SampleGrid, Scene, Shape, View};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Gives every sample its colour, from the hit point of its ray; its normal and its texture coordinate, too, if the
/// frame keeps [them](Frame::with_normals) [both](Frame::with_texture_coordinates).
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    let grid = view.camera.sample_grid(frame.samples());
    frame.shading_rows().into_par_iter().for_each(|row| shade_row(view, &grid, row));
}

fn shade_row(view: &View, grid: &SampleGrid, mut row: ShadingRow) {
    let keeps_texture = row.texture_coordinates.is_some();
    for (index, (column, &id)) in row.columns.zip(row.ids).enumerate() {
        if id == NO_PRIMITIVE {
            row.colors[index] = view.scene.background;
            if let Some(kept) = &mut row.normals {
                kept[index] = Vec3::ZERO;
            }
            if let Some(kept) = &mut row.texture_coordinates {
                kept[index] = Vec2::ZERO;
            }
            continue;
        }
        let ray = grid.ray(row.row, column);
        let primitive = view.primitive(id);
        let hit = Hit::new(&primitive, &ray, row.t[index]);
        let to_viewer = -ray.direction.normalize();
        let normal = normal_at(view, (id, &primitive), &ray, &hit).as_vec3();
        let (object, local) = view.scene.locate(id);
        let material = view.scene.objects()[object].material_of(local);
        let texture = if keeps_texture || material.checker.is_some() {
            let chart = texture_at(view, (id, &primitive), &hit);
            chart.map(|chart| chart.seen_along(&ray, hit.t, view, grid))
        } else {
            None
        };
        let to_viewer = to_viewer.as_vec3();
        let point = SurfacePoint { position: hit.position, normal, to_viewer, texture };
        if let Some(kept) = &mut row.normals {
            kept[index] = normal;
        }
        if let Some(kept) = &mut row.texture_coordinates {
            kept[index] = texture.map_or(Vec2::ZERO, |texture| texture.stored());
        }
        row.colors[index] = color(&point, material, &view.scene.lights, view.camera.eye());
    }
}

/// Where a ray hits a primitive.
struct Hit {
    t: f64,
    /// Relative to the eye.
    position: DVec3,
    /// Relative to the middle of a sphere; elsewhere the same.
    from_center: DVec3,
}

/// How far a stored `t` may be from the true one, as a part of it.
const STORED: f64 = 2e-5;

impl Hit {
    /// What is known to be hit, found again in `f64`: from afar, the digits of the stored `t` end before those of
    /// the surface begin.
    ///
    /// Where the ray runs along the surface or numbers are extreme, rounding may leave less than is stored; then
    /// that is taken.
    fn new(primitive: &Primitive, ray: &Ray, stored: f32) -> Hit {
        let stored = f64::from(stored);
        let hit = match *primitive {
            Primitive::Sphere { center, radius } => Hit::on_sphere(center, radius, ray, stored),
            Primitive::Plane { point, normal } => Hit::on_plane(point, normal, ray),
            Primitive::Triangle(corners) => Hit::on_plane(corners[0], flat_normal(corners), ray),
        };
        if (hit.t - stored).abs() <= STORED * stored {
            return hit;
        }
        let position = ray.origin + stored * ray.direction;
        let center = match *primitive {
            Primitive::Sphere { center, .. } => center,
            _ => DVec3::ZERO,
        };
        Hit { t: stored, position, from_center: position - center }
    }

    fn on_plane(point: DVec3, normal: DVec3, ray: &Ray) -> Hit {
        let t = normal.dot(point - ray.origin) / normal.dot(ray.direction);
        let position = ray.origin + t * ray.direction;
        Hit { t, position, from_center: position }
    }

    /// The ray comes nearest to the centre at `−k`, beside it by `f`; half of the way through the sphere nearer or
    /// farther, it meets the sphere. From outside it is seen where it is nearer; from where rounding cannot tell, where
    /// the stored `t` says.
    fn on_sphere(center: DVec3, radius: f64, ray: &Ray, stored: f64) -> Hit {
        let (m, d) = (ray.origin - center, ray.direction);
        let a = d.length_squared();
        let k = m.dot(d) / a;
        let f = m - k * d;
        let half = ((radius * radius - f.length_squared()).max(0.0) / a).sqrt();
        let (begins, square) = (m.length_squared(), radius * radius);
        let is_clear = (begins - square).abs() > 1e-12 * (begins + square);
        let is_near = if is_clear { begins > square } else { stored + k < 0.0 };
        let half = if is_near { -half } else { half };
        let t = half - k;
        Hit { t, position: ray.origin + t * d, from_center: f + half * d }
    }
}

/// The unit normal of a primitive at a hit point, towards the viewer.
fn normal_at(view: &View, (id, primitive): (u32, &Primitive), ray: &Ray, hit: &Hit) -> DVec3 {
    let (flat, smooth) = match *primitive {
        Primitive::Sphere { .. } => (hit.from_center, None),
        Primitive::Plane { normal, .. } => (normal, None),
        Primitive::Triangle(corners) => {
            let flat = flat_normal(corners);
            let normals = corner_normals(view.scene, id);
            (flat, normals.map(|normals| interpolate(corners, flat, hit.position, normals)))
        }
    };
    let normal = smooth.unwrap_or(flat).normalize_or(flat.normalize_or_zero());
    // The surface, not its smooth look, says which side is seen.
    if flat.dot(ray.direction) > 0.0 { -normal } else { normal }
}

fn flat_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

fn corner_normals(scene: &Scene, id: u32) -> Option<[DVec3; 3]> {
    let (object, local) = scene.locate(id);
    match &scene.objects()[object].shape {
        Shape::Mesh(mesh) => Some(mesh.normals().of(local)?.map(Vec3::as_dvec3)),
        Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => None,
    }
}

/// The normals at the corners, weighted.
fn interpolate(corners: [DVec3; 3], flat: DVec3, hit: DVec3, normals: [DVec3; 3]) -> DVec3 {
    let [of_a, of_b, of_c] = areas(corners, flat, hit);
    let [at_a, at_b, at_c] = normals.map(DVec3::normalize_or_zero);
    of_a * at_a + of_b * at_b + of_c * at_c
}

/// The corners' weights up to a common factor: the areas that the hit point cuts the triangle into.
fn areas([a, b, c]: [DVec3; 3], flat: DVec3, hit: DVec3) -> [f64; 3] {
    [(b, c), (c, a), (a, b)].map(|(p, q)| (p - hit).cross(q - hit).dot(flat))
}

/// A surface's texture around one of its points.
struct Chart {
    coordinate: DVec2,
    /// Where the two coordinates grow, and how fast.
    gradients: [DVec3; 2],
    /// Of the surface; its length does not matter.
    normal: DVec3,
}

/// The texture of a primitive around a hit point.
fn texture_at(view: &View, (id, primitive): (u32, &Primitive), hit: &Hit) -> Option<Chart> {
    match *primitive {
        Primitive::Sphere { .. } => {
            let (coordinate, gradients) = texture::on_sphere(hit.from_center);
            Some(Chart { coordinate, gradients, normal: hit.from_center })
        }
        Primitive::Plane { point, normal } => {
            let gradients = texture::plane_axes(normal);
            let coordinate = DVec2::from(gradients.map(|axis| axis.dot(hit.position - point)));
            Some(Chart { coordinate, gradients, normal })
        }
        Primitive::Triangle(corners) => {
            let (object, local) = view.scene.locate(id);
            let values = texture::corners(&view.scene.objects()[object].shape, local)?;
            Some(triangle_chart(corners, values, hit.position))
        }
    }
}

fn triangle_chart(corners: [DVec3; 3], values: [DVec2; 3], hit: DVec3) -> Chart {
    let normal = flat_normal(corners);
    let weights = areas(corners, normal, hit);
    let total: f64 = weights.iter().sum();
    let weighted = weights.iter().zip(values).map(|(&weight, value)| weight * value);
    // The area opposite to a corner grows away from its side, as long as that side is.
    let [a, b, c] = corners;
    let growth = [c - b, a - c, b - a].map(|side| normal.cross(side));
    let gradient = |k: usize| {
        growth.iter().zip(values).map(|(&growth, value)| growth * value[k]).sum::<DVec3>() / total
    };
    Chart {
        coordinate: weighted.sum::<DVec2>() / total,
        gradients: [gradient(0), gradient(1)],
        normal,
    }
}

impl Chart {
    /// What a ray that hits here, at `t`, sees of the texture.
    ///
    /// The rays through the neighbouring samples meet the plane that touches the surface here a little
    /// beside. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
    fn seen_along(&self, ray: &Ray, t: f64, view: &View, grid: &SampleGrid) -> TexturePoint {
        let camera = view.camera;
        let [width, height] = camera.viewport();
        let steps = [
            camera.u() * (width / count(grid.width())),
            camera.v() * (-height / count(grid.height())),
        ];
        let [across, down] = steps.map(|step| {
            // A parallel ray moves with its sample, a perspective one turns.
            let moved = match camera.projection() {
                Projection::Perspective => t * step,
                Projection::Parallel => step,
            };
            let farther = -self.normal.dot(moved) / self.normal.dot(ray.direction);
            let beside = moved + farther * ray.direction;
            DVec2::from(self.gradients.map(|gradient| gradient.dot(beside)))
        });
        TexturePoint::new(self.coordinate, across, down)
    }
}

/// Of samples along a side.
#[expect(clippy::cast_precision_loss, reason = "at most 65,536")]
fn count(samples: usize) -> f64 {
    samples as f64
}
