//! The look of what is seen: image order goes back along each ray to the point that it hit.

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::shade::{SurfacePoint, colour};
use bothways_common::{Frame, Primitive, Ray, SampleGrid, Scene, Shape, View};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Gives every sample its normal and colour, from the hit point of its ray.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame) {
    assert_eq!(frame.image(), view.camera.image(), "the frame shows another view");
    let grid = view.camera.sample_grid(frame.samples());
    frame.shading_rows().into_par_iter().for_each(|row| shade_row(view, &grid, row));
}

fn shade_row(view: &View, grid: &SampleGrid, row: ShadingRow) {
    for (column, &id) in row.ids.iter().enumerate() {
        if id == NO_PRIMITIVE {
            row.normals[column] = Vec3::ZERO;
            row.colours[column] = view.scene.background;
            continue;
        }
        let ray = grid.ray(row.row, column);
        let hit = ray.origin + f64::from(row.t[column]) * ray.direction;
        let to_viewer = -ray.direction.normalize();
        let normal = normal_at(view, id, &ray, hit).as_vec3();
        let point =
            SurfacePoint { position: hit.as_vec3(), normal, to_viewer: to_viewer.as_vec3() };
        let (object, _) = view.scene.locate(id);
        let material = &view.scene.objects()[object].material;
        row.normals[column] = normal;
        row.colours[column] = colour(&point, material, &view.scene.lights, view.camera.eye());
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

/// The normals at the corners, weighted by the areas that the hit point cuts the triangle into.
fn interpolate(
    [a, b, c]: [DVec3; 3],
    flat: DVec3,
    hit: DVec3,
    [at_a, at_b, at_c]: [DVec3; 3],
) -> DVec3 {
    let area = |p: DVec3, q: DVec3| (p - hit).cross(q - hit).dot(flat);
    let normal = |n: DVec3| n.normalize_or_zero();
    area(b, c) * normal(at_a) + area(c, a) * normal(at_b) + area(a, b) * normal(at_c)
}
