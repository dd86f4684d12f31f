//! The look of what is seen. Object order interpolates the attributes of a triangle's corners,
//! with weights that are functions on the viewport.

mod form;
mod quotient;

use bothways_common::frame::{NO_PRIMITIVE, ShadingRow};
use bothways_common::look::shade::{SurfacePoint, color};
use bothways_common::look::texture::{self, TexturePoint};
use bothways_common::{
    Frame, Material, Primitive, Projection, Ray, SampleGrid, Scene, Shape, View,
};
use form::{Form, HitPoint};
use glam::{DVec2, DVec3, Vec2, Vec3};
use quotient::{Affine, Quotient};
use rayon::prelude::*;

/// Gives every sample its colour, by interpolation over the triangle that is seen there. If the frame keeps
/// [normals](Frame::with_normals) or [texture coordinates](Frame::with_texture_coordinates), every sample gets these,
/// too.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    let grid = view.camera.sample_grid(frame.samples());
    let step = sample_step(view, frame.samples());
    frame.shading_rows().into_par_iter().for_each(|row| shade_row(view, &grid, step, row));
}

fn shade_row(view: &View, grid: &SampleGrid, step: [f64; 2], mut row: ShadingRow) {
    // Neighbouring samples mostly show the same primitive: set it up once for the run.
    let mut run: Option<(u32, Surface)> = None;
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
        let surface = match &run {
            Some((of, surface)) if *of == id => surface,
            _ => &run.insert((id, Surface::new(view, id, row.texture_coordinates.is_some()))).1,
        };
        let (x, y) = (grid.x()[column], grid.y()[row.row]);
        let ray = view.camera.ray_through(x, y);
        let hit = surface.hit_point([x, y], &ray, row.t[index]);
        let normal = surface.normal(x, y, &hit, ray.direction).as_vec3();
        let to_viewer = -ray.direction.normalize().as_vec3();
        let texture = surface.texture_point(view, x, y, &hit, step);
        let point = SurfacePoint { position: hit.position, normal, to_viewer, texture };
        if let Some(kept) = &mut row.normals {
            kept[index] = normal;
        }
        if let Some(kept) = &mut row.texture_coordinates {
            kept[index] = texture.map_or(Vec2::ZERO, |texture| texture.stored());
        }
        row.colors[index] = color(&point, &surface.material, &view.scene.lights, view.camera.eye());
    }
}

/// The way from a sample to the next one down, along `y`, and to the next one across, along `x`.
fn sample_step(view: &View, samples: u32) -> [f64; 2] {
    let [down, across] = view.camera.raster(samples).spacing();
    [-down, across]
}

/// One visible primitive, set up for all samples at which it is seen.
struct Surface {
    material: Material,
    form: Form,
    normals: Normals,
    texture: Texture,
}

enum Texture {
    /// There is none, or it is not needed.
    None,
    /// That of a sphere.
    Sphere,
    /// That of a flat form: a function on the viewport.
    Flat(Quotient),
}

enum Normals {
    /// The same everywhere.
    Flat(DVec3),
    /// Those of a sphere.
    Sphere,
    /// Interpolated: the corners' normals, each with its weight, and the flat one.
    Smooth { corners: [(DVec3, Affine); 3], flat: DVec3 },
}

impl Surface {
    fn new(view: &View, id: u32, keeps_texture: bool) -> Surface {
        let (object, local) = view.scene.locate(id);
        let primitive = view.primitive(id);
        let normals = match primitive {
            Primitive::Sphere { .. } => Normals::Sphere,
            Primitive::Plane { normal, .. } => Normals::Flat(normal),
            Primitive::Triangle([a, b, c]) => {
                let flat = (b - a).cross(c - a);
                match corner_normals(view.scene, object, local) {
                    None => Normals::Flat(flat),
                    Some([at_a, at_b, at_c]) => {
                        let [of_a, of_b, of_c] = weights(view, [a, b, c], flat);
                        Normals::Smooth {
                            corners: [(at_a, of_a), (at_b, of_b), (at_c, of_c)],
                            flat,
                        }
                    }
                }
            }
        };
        let object = &view.scene.objects()[object];
        let material = *object.material_of(local);
        let texture = if keeps_texture || material.checker.is_some() {
            Texture::new(view, &primitive, texture::corners(&object.shape, local))
        } else {
            Texture::None
        };
        Surface { material, form: Form::new(view, &primitive), normals, texture }
    }

    /// The point that is seen at a sample, for which this `t` is stored.
    fn hit_point(&self, [x, y]: [f64; 2], ray: &Ray, stored: f32) -> HitPoint {
        self.form.hit_point([x, y], ray, stored.into())
    }

    /// The texture coordinate at a sample, and how it changes towards its neighbours.
    fn texture_point(
        &self,
        view: &View,
        x: f64,
        y: f64,
        hit: &HitPoint,
        [down, across]: [f64; 2],
    ) -> Option<TexturePoint> {
        let (coordinate, [along_x, along_y]) = match &self.texture {
            Texture::None => return None,
            Texture::Flat(quotient) => quotient.at(x, y),
            Texture::Sphere => {
                // Near the sample the sphere is the plane that touches it there.
                let normal = hit.from_center;
                let (coordinate, gradients) = texture::on_sphere(normal);
                let touching = Quotient::on_plane(view, hit.position, normal, gradients);
                (coordinate, touching.at(x, y).1)
            }
        };
        Some(TexturePoint::new(coordinate, across * along_x, down * along_y))
    }

    /// The unit normal at a sample, towards the viewer.
    fn normal(&self, x: f64, y: f64, hit: &HitPoint, direction: DVec3) -> DVec3 {
        let (flat, smooth) = match &self.normals {
            Normals::Flat(flat) => (*flat, *flat),
            Normals::Sphere => (hit.from_center, hit.from_center),
            Normals::Smooth { corners, flat } => {
                let weighted = |(normal, weight): &(DVec3, Affine)| weight.at(x, y) * *normal;
                (*flat, corners.iter().map(weighted).sum::<DVec3>())
            }
        };
        let normal = smooth.normalize_or(flat.normalize_or_zero());
        // The surface, not its smooth look, says which side is seen.
        if flat.dot(direction) > 0.0 { -normal } else { normal }
    }
}

impl Texture {
    fn new(view: &View, primitive: &Primitive, corners: Option<[DVec2; 3]>) -> Texture {
        match (*primitive, corners) {
            (Primitive::Sphere { .. }, _) => Texture::Sphere,
            (Primitive::Plane { point, normal }, _) => {
                let axes = texture::plane_axes(normal);
                Texture::Flat(Quotient::on_plane(view, point, normal, axes))
            }
            (Primitive::Triangle([a, b, c]), Some(coordinates)) => {
                let flat = (b - a).cross(c - a);
                Texture::Flat(Quotient::interpolating(weights(view, [a, b, c], flat), coordinates))
            }
            (Primitive::Triangle(_), None) => Texture::None,
        }
    }
}

/// The perspective-correct weights of a triangle's corners, up to a common factor: each is the edge
/// function of the side opposite to its corner.
fn weights(view: &View, [a, b, c]: [DVec3; 3], flat: DVec3) -> [Affine; 3] {
    [(b, c), (c, a), (a, b)].map(|(p, q)| edge_function(view, p, q, flat))
}

/// The edge function from `p` to `q`, positive inside of the triangle.
///
/// It is computed from the difference `q − p`: seen from afar, `p × q` would be all rounding.
fn edge_function(view: &View, p: DVec3, q: DVec3, flat: DVec3) -> Affine {
    let w = view.camera.w();
    match view.camera.projection() {
        Projection::Perspective => {
            let side = flat.dot(p).signum();
            Affine::along_ray(view, p.cross(q - p)) * side
        }
        Projection::Parallel => {
            let side = -flat.dot(w).signum();
            let (u, v) = (view.camera.u(), view.camera.v());
            let slope = (p - q).cross(w);
            let [at_center, across, up] = [p.cross(q - p).dot(w), slope.dot(u), slope.dot(v)];
            Affine { at_center, across, up } * -side
        }
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
