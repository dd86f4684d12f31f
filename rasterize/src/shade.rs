//! The look of what is seen: object order interpolates over each triangle what its corners carry,
//! with weights that are functions on the viewport.

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::shade::{SurfacePoint, colour};
use bothways_common::{Frame, Material, Primitive, Projection, SampleGrid, Scene, Shape, View};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Gives every sample its normal and colour, by interpolation over the triangle that is seen there.
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
    // Neighbouring samples mostly show the same primitive: set it up once for the run.
    let mut run: Option<(u32, Surface)> = None;
    for (column, &id) in row.ids.iter().enumerate() {
        if id == NO_PRIMITIVE {
            row.normals[column] = Vec3::ZERO;
            row.colours[column] = view.scene.background;
            continue;
        }
        let surface = match &run {
            Some((of, surface)) if *of == id => surface,
            _ => &run.insert((id, Surface::new(view, id))).1,
        };
        let (x, y) = (grid.x()[column], grid.y()[row.row]);
        let ray = view.camera.ray_through(x, y);
        let position = ray.origin + f64::from(row.t[column]) * ray.direction;
        let normal = surface.normal(x, y, position, ray.direction).as_vec3();
        let to_viewer = -ray.direction.normalize().as_vec3();
        let point = SurfacePoint { position: position.as_vec3(), normal, to_viewer };
        row.normals[column] = normal;
        row.colours[column] =
            colour(&point, &surface.material, &view.scene.lights, view.camera.eye());
    }
}

/// One visible primitive, set up for all samples at which it is seen.
struct Surface {
    material: Material,
    normals: Normals,
}

enum Normals {
    /// The same everywhere.
    Flat(DVec3),
    /// Of a sphere around this centre.
    Round(DVec3),
    /// Interpolated: the corners' normals, each with its weight, and the flat one.
    Smooth { corners: [(DVec3, Weight); 3], flat: DVec3 },
}

/// A function `at_centre + x·across + y·up` on the viewport: the edge function opposite to a corner,
/// which is that corner's perspective-correct weight up to a common factor.
struct Weight {
    at_centre: f64,
    across: f64,
    up: f64,
}

impl Surface {
    fn new(view: &View, id: u32) -> Surface {
        let (object, local) = view.scene.locate(id);
        let normals = match view.primitive(id) {
            Primitive::Sphere { center, .. } => Normals::Round(center),
            Primitive::Plane { normal, .. } => Normals::Flat(normal),
            Primitive::Triangle([a, b, c]) => {
                let flat = (b - a).cross(c - a);
                match corner_normals(view.scene, object, local) {
                    None => Normals::Flat(flat),
                    Some([at_a, at_b, at_c]) => {
                        let weight = |p, q| Weight::new(view, p, q, flat);
                        let corners =
                            [(at_a, weight(b, c)), (at_b, weight(c, a)), (at_c, weight(a, b))];
                        Normals::Smooth { corners, flat }
                    }
                }
            }
        };
        Surface { material: view.scene.objects()[object].material, normals }
    }

    /// The unit normal at a sample, towards the viewer.
    fn normal(&self, x: f64, y: f64, position: DVec3, direction: DVec3) -> DVec3 {
        let (flat, smooth) = match &self.normals {
            Normals::Flat(flat) => (*flat, *flat),
            Normals::Round(center) => (position - center, position - center),
            Normals::Smooth { corners, flat } => {
                let weighted = |(normal, weight): &(DVec3, Weight)| weight.at(x, y) * *normal;
                (*flat, corners.iter().map(weighted).sum::<DVec3>())
            }
        };
        let normal = smooth.normalize_or(flat.normalize_or_zero());
        // The surface, not its smooth look, says which side is seen.
        if flat.dot(direction) > 0.0 { -normal } else { normal }
    }
}

impl Weight {
    /// The edge function from `p` to `q`, positive inside of the triangle.
    fn new(view: &View, p: DVec3, q: DVec3, flat: DVec3) -> Weight {
        let camera = view.camera;
        let (u, v, w) = (camera.u(), camera.v(), camera.w());
        match camera.projection() {
            Projection::Perspective => {
                let edge = p.cross(q);
                let side = flat.dot(p).signum();
                Weight {
                    at_centre: -side * camera.distance() * edge.dot(w),
                    across: side * edge.dot(u),
                    up: side * edge.dot(v),
                }
            }
            Projection::Parallel => {
                let side = -flat.dot(w).signum();
                let slope = (p - q).cross(w);
                Weight {
                    at_centre: -side * p.cross(q).dot(w),
                    across: -side * slope.dot(u),
                    up: -side * slope.dot(v),
                }
            }
        }
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        self.at_centre + x * self.across + y * self.up
    }
}

fn corner_normals(scene: &Scene, object: usize, local: usize) -> Option<[DVec3; 3]> {
    match &scene.objects()[object].shape {
        Shape::Mesh(mesh) => {
            Some(mesh.normals().of(local)?.map(|normal| normal.as_dvec3().normalize_or_zero()))
        }
        Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => None,
    }
}
