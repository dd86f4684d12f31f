//! The look of what is seen: image order goes back along each ray to the point that it hit.

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::shade::{SurfacePoint, colour};
use bothways_common::texture::{self, TexturePoint};
use bothways_common::{Frame, Primitive, Projection, Ray, SampleGrid, Scene, Shape, View};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Gives every sample its normal and colour, from the hit point of its ray; its texture coordinate,
/// too, if the frame [keeps them](Frame::with_texture_coordinates).
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
            row.normals[index] = Vec3::ZERO;
            row.colours[index] = view.scene.background;
            if let Some(kept) = &mut row.texture_coordinates {
                kept[index] = Vec2::ZERO;
            }
            continue;
        }
        let ray = grid.ray(row.row, column);
        let t = f64::from(row.t[index]);
        let hit = ray.origin + t * ray.direction;
        let to_viewer = -ray.direction.normalize();
        let normal = normal_at(view, id, &ray, hit).as_vec3();
        let (object, local) = view.scene.locate(id);
        let material = view.scene.objects()[object].material_of(local);
        let texture = if keeps_texture || material.checker.is_some() {
            texture_at(view, id, hit).map(|chart| chart.seen_along(&ray, t, view, grid))
        } else {
            None
        };
        let (position, to_viewer) = (hit.as_vec3(), to_viewer.as_vec3());
        let point = SurfacePoint { position, normal, to_viewer, texture };
        row.normals[index] = normal;
        if let Some(kept) = &mut row.texture_coordinates {
            kept[index] = texture.map_or(Vec2::ZERO, |texture| texture.stored());
        }
        row.colours[index] = colour(&point, material, &view.scene.lights, view.camera.eye());
    }
}

/// The unit normal of a primitive at a hit point, towards the viewer.
fn normal_at(view: &View, id: u32, ray: &Ray, hit: DVec3) -> DVec3 {
    let (flat, smooth) = match view.primitive(id) {
        Primitive::Sphere { center, .. } => (hit - center, None),
        Primitive::Plane { normal, .. } => (normal, None),
        Primitive::Triangle(corners) => {
            let flat = flat_normal(corners);
            let normals = corner_normals(view.scene, id);
            (flat, normals.map(|normals| interpolate(corners, flat, hit, normals)))
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
fn texture_at(view: &View, id: u32, hit: DVec3) -> Option<Chart> {
    match view.primitive(id) {
        Primitive::Sphere { center, .. } => {
            let (coordinate, gradients) = texture::on_sphere(hit - center);
            Some(Chart { coordinate, gradients, normal: hit - center })
        }
        Primitive::Plane { point, normal } => {
            let gradients = texture::plane_axes(normal);
            let coordinate = DVec2::from(gradients.map(|axis| axis.dot(hit - point)));
            Some(Chart { coordinate, gradients, normal })
        }
        Primitive::Triangle(corners) => {
            let (object, local) = view.scene.locate(id);
            let values = texture::corners(&view.scene.objects()[object].shape, local)?;
            Some(triangle_chart(corners, values, hit))
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
