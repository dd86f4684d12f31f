//! Shading: image order goes along each ray to the point that it hit.

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::look::shade::{SurfacePoint, color};
use bothways_common::look::texture::{self, TexturePoint};
use bothways_common::{Frame, Primitive, Projection, Raster, Ray, SampleGrid, Scene, Shape, View};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Gives every sample its colour, from the hit point of its ray. If the frame keeps [normals](Frame::with_normals) or
/// [texture coordinates](Frame::with_texture_coordinates), every sample gets these, too.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    let (grid, raster) =
        (view.camera.sample_grid(frame.samples()), view.camera.raster(frame.samples()));
    frame.shading_rows().into_par_iter().for_each(|row| shade_row(view, &grid, &raster, row));
}

fn shade_row(view: &View, grid: &SampleGrid, raster: &Raster, mut row: ShadingRow) {
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
            chart.map(|chart| chart.seen_along(&ray, hit.t, view, raster))
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
    /// Relative to the centre of a sphere; of other primitives, the same as `position`.
    from_center: DVec3,
}

/// How far a stored `t` may be from the true one, as a fraction of it.
const STORED_ERROR: f64 = 2e-5;

impl Hit {
    /// Intersects the ray again, in `f64`, with the primitive that it is known to hit: far from the eye, the stored `t`
    /// has too few digits to tell points of the surface apart.
    ///
    /// Where the ray runs along the surface, or numbers are extreme, the new `t` may be worse than the stored one, which
    /// is then used.
    fn new(primitive: &Primitive, ray: &Ray, stored: f32) -> Hit {
        let stored = f64::from(stored);
        let hit = match *primitive {
            Primitive::Sphere { center, radius } => Hit::on_sphere(center, radius, ray, stored),
            Primitive::Plane { point, normal } => Hit::on_plane(point, normal, ray),
            Primitive::Triangle(corners) => Hit::on_plane(corners[0], flat_normal(corners), ray),
        };
        if (hit.t - stored).abs() <= STORED_ERROR * stored {
            return hit;
        }
        let position = ray.origin + stored * ray.direction;
        let center = match *primitive {
            Primitive::Sphere { center, .. } => center,
            Primitive::Triangle(_) | Primitive::Plane { .. } => DVec3::ZERO,
        };
        Hit { t: stored, position, from_center: position - center }
    }

    fn on_plane(point: DVec3, normal: DVec3, ray: &Ray) -> Hit {
        let t = normal.dot(point - ray.origin) / normal.dot(ray.direction);
        let position = ray.origin + t * ray.direction;
        Hit { t, position, from_center: position }
    }

    /// The ray comes nearest to the centre at `t = −k`, where it passes beside it by `f`. It meets the sphere half of
    /// the way through the sphere before and after that. An eye outside sees the nearer point; where rounding hides
    /// whether the eye is outside, the stored `t` decides.
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
    // The surface decides which side is seen, not its smooth normals.
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

/// The sum of the normals at the corners, weighted.
fn interpolate(corners: [DVec3; 3], flat: DVec3, hit: DVec3, normals: [DVec3; 3]) -> DVec3 {
    let [of_a, of_b, of_c] = areas(corners, flat, hit);
    let [at_a, at_b, at_c] = normals.map(DVec3::normalize_or_zero);
    of_a * at_a + of_b * at_b + of_c * at_c
}

/// The weights of the corners, up to a common factor: the areas into which the hit point divides the triangle.
fn areas([a, b, c]: [DVec3; 3], flat: DVec3, hit: DVec3) -> [f64; 3] {
    [(b, c), (c, a), (a, b)].map(|(p, q)| (p - hit).cross(q - hit).dot(flat))
}

/// The texture of a surface around one of its points.
struct Chart {
    coordinate: DVec2,
    /// The directions in which the two coordinates grow, and how fast.
    gradients: [DVec3; 2],
    /// That of the surface; its length does not matter.
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
    // The area opposite to a corner grows away from its side, in proportion to the side's length.
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
    /// The rays through the neighbouring samples meet the tangent plane of the surface a little
    /// beside this point. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
    fn seen_along(&self, ray: &Ray, t: f64, view: &View, raster: &Raster) -> TexturePoint {
        let camera = view.camera;
        let [of_row, of_column] = raster.spacing();
        let [across, down] = [camera.u() * of_column, camera.v() * -of_row].map(|step| {
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
