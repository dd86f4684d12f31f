//! The look of what is seen. Object order interpolates the attributes of a triangle's corners,
//! with weights that are functions on the viewport.

mod form;
mod quotient;

use bothways_common::engine::simd::{Level, Simd, SimdBase, best_level, f64x8};
use bothways_common::look::bands::{self, Points, Samples, Seen, Surfaces, Wanted};
use bothways_common::look::lanes::{DVec3x8, Lanes, each};
use bothways_common::look::texture::{self, TexturePoints};
use bothways_common::{Frame, Primitive, Projection, View};
use form::{Form, HitPoints};
use glam::{DVec2, DVec3};
use quotient::{Affine, Quotient};

/// Gives a frame its picture, by interpolation over the triangle that is seen at each sample. If the frame keeps
/// [linear colours](Frame::with_colors), [normals](Frame::with_normals) or
/// [texture coordinates](Frame::with_texture_coordinates), every sample gets these, too.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame) {
    shade_with(view, frame, best_level());
}

/// [`shade`] with the vector instructions of this level, for tests that compare the levels.
#[doc(hidden)]
pub fn shade_with(view: &View, frame: &mut Frame, level: Level) {
    let samples = frame.samples();
    bands::shade(view, frame, &Interpolated { view, step: sample_step(view, samples) }, level);
}

/// The surfaces of a view as object order finds them.
struct Interpolated<'a> {
    view: &'a View<'a>,
    /// The way from a sample to the next one down, along `y`, and to the next one across, along `x`.
    step: [f64; 2],
}

fn sample_step(view: &View, samples: u32) -> [f64; 2] {
    let [down, across] = view.camera.raster(samples).spacing();
    [-down, across]
}

/// One visible primitive, set up for all samples at which it is seen.
struct Surface {
    /// `None` where only the normals of a flat form are wanted.
    form: Option<Form>,
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
    /// The same everywhere, towards the viewer.
    Flat(DVec3),
    /// Those of a sphere; the reciprocal of its radius.
    Sphere(f64),
    /// Interpolated: each coordinate is a function on the viewport. And the flat one, unless the corners' are alike
    /// enough never to cancel each other.
    Smooth { coordinates: [Affine; 3], flat: Option<DVec3> },
}

impl Surfaces for Interpolated<'_> {
    type Surface = Surface;

    #[inline(always)]
    fn set_up(&self, seen: &Seen, wanted: Wanted) -> Surface {
        let (view, primitive) = (self.view, &seen.primitive);
        let normals = Normals::new(view, primitive, seen.corner_normals());
        let texture = if wanted.texture_coordinates || seen.material.checker.is_some() {
            Texture::new(view, primitive, seen.corner_coordinates())
        } else {
            Texture::None
        };
        let is_sphere = matches!(primitive, Primitive::Sphere { .. });
        let form = (is_sphere || wanted.positions).then(|| Form::new(view, primitive));
        Surface { form, normals, texture }
    }

    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, surface: &Surface, samples: &Samples<S>) -> Points<S> {
        let hit = match &surface.form {
            Some(form) => form.hit_points(simd, samples),
            None => HitPoints::nowhere(simd),
        };
        let normal = surface.normals.at(simd, samples, &hit);
        let texture = self.texture_points(simd, &surface.texture, samples, &hit);
        Points { position: hit.position, normal, texture }
    }
}

impl Interpolated<'_> {
    /// The texture coordinates at some samples, and how they change towards their neighbours.
    #[inline(always)]
    fn texture_points<S: Simd>(
        &self,
        simd: S,
        texture: &Texture,
        samples: &Samples<S>,
        hit: &HitPoints<S>,
    ) -> Option<TexturePoints<S>> {
        let (coordinate, [along_x, along_y]) = match texture {
            Texture::None => return None,
            Texture::Flat(quotient) => quotient.at(simd, samples.x, samples.y),
            Texture::Sphere => self.on_sphere(simd, samples, hit),
        };
        let [down, across] = each!(k in [0, 1] => f64x8::splat(simd, self.step[k]));
        Some(TexturePoints::new(
            coordinate,
            each!(k in [0, 1] => along_x[k] * across),
            each!(k in [0, 1] => along_y[k] * down),
        ))
    }

    /// Near a sample the sphere is the plane that touches it there.
    #[inline(always)]
    fn on_sphere<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        hit: &HitPoints<S>,
    ) -> ([f64x8<S>; 2], [[f64x8<S>; 2]; 2]) {
        let (coordinate, gradients) = texture::on_sphere_lanes(simd, hit.from_center);
        let changes: [[DVec2; 2]; 8] = std::array::from_fn(|lane| {
            let (position, normal) = (hit.position.lane(lane), hit.from_center.lane(lane));
            let gradients = gradients.map(|gradient| gradient.lane(lane));
            let touching = Quotient::on_plane(self.view, position, normal, gradients);
            touching.changes(samples.x[lane], samples.y[lane])
        });
        let of = |axis: usize, k: usize| f64x8::from_fn(simd, |lane| changes[lane][axis][k]);
        (coordinate, each!(axis in [0, 1] => each!(k in [0, 1] => of(axis, k))))
    }
}

impl Normals {
    #[inline(always)]
    fn new(view: &View, primitive: &Primitive, corners: Option<[DVec3; 3]>) -> Normals {
        match *primitive {
            Primitive::Sphere { radius, .. } => Normals::Sphere(1.0 / radius),
            Primitive::Plane { point, normal } => {
                let flat = normal.normalize_or_zero();
                Normals::Flat(flat * side_seen(view, point, flat))
            }
            Primitive::Triangle([a, b, c]) => {
                let normal = (b - a).cross(c - a);
                // The surface, not its smooth look, says which side is seen.
                let side = side_seen(view, a, normal);
                let flat = normal.normalize_or_zero() * side;
                let Some([at_a, at_b, at_c]) = corners else { return Normals::Flat(flat) };
                let [of_a, of_b, of_c] = weights(view, [a, b, c], normal);
                // All weights times one number change no direction; with this one they keep clear of overflow.
                let scale = 1.0 / (of_a + of_b + of_c).largest(view);
                let scale = if scale.is_finite() { side * scale } else { side };
                let coordinate = |k: usize| of_a * at_a[k] + of_b * at_b[k] + of_c * at_c[k];
                let coordinates = each!(k in [0, 1, 2] => coordinate(k) * scale);
                let apart = at_a.dot(at_b).min(at_b.dot(at_c)).min(at_c.dot(at_a));
                Normals::Smooth { coordinates, flat: (apart < 0.1).then_some(flat) }
            }
        }
    }

    /// The normals at some samples, towards the viewer.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, samples: &Samples<S>, hit: &HitPoints<S>) -> DVec3x8<S> {
        /// Corners' normals that cancel each other leave the flat one.
        const CANCELLED: f64 = 1e-15;
        let zero = f64x8::splat(simd, 0.0);
        match self {
            Normals::Flat(flat) => DVec3x8::splat(simd, *flat),
            Normals::Sphere(scale) => {
                let normal = hit.from_center * f64x8::splat(simd, *scale);
                normal.negated_where(normal.dot(samples.rays.direction).simd_gt(zero))
            }
            Normals::Smooth { coordinates, flat } => {
                let [x, y, z] = each!(k in [0, 1, 2] => coordinates[k].lanes(simd, samples));
                let smooth = Lanes { x, y, z };
                let Some(flat) = flat else { return smooth };
                let is_direction = smooth.max_magnitude().simd_gt(f64x8::splat(simd, CANCELLED));
                smooth.or(is_direction, DVec3x8::splat(simd, *flat))
            }
        }
    }
}

/// 1 if a normal of a flat form through a point is towards the viewer, −1 if it is away.
#[inline(always)]
fn side_seen(view: &View, point: DVec3, normal: DVec3) -> f64 {
    let away = match view.camera.projection() {
        // Every ray that meets the form goes to the same side of it.
        Projection::Perspective => normal.dot(point) > 0.0,
        Projection::Parallel => normal.dot(-view.camera.w()) > 0.0,
    };
    if away { -1.0 } else { 1.0 }
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
/// function of the side opposite to its corner, positive inside of the triangle.
///
/// The function from `p` to `q` is computed from the difference `q − p`: seen from afar, `p × q` would be all rounding.
#[inline(always)]
fn weights(view: &View, [a, b, c]: [DVec3; 3], flat: DVec3) -> [Affine; 3] {
    let inside = side_seen(view, a, flat);
    each!(side in [[b, c], [c, a], [a, b]] => {
        let [p, q] = side;
        edge_function(view, p, q) * -inside
    })
}

/// The edge function from `p` to `q`, positive inside of a triangle that is seen from its back.
#[inline(always)]
fn edge_function(view: &View, p: DVec3, q: DVec3) -> Affine {
    match view.camera.projection() {
        Projection::Perspective => Affine::along_ray(view, p.cross(q - p)),
        Projection::Parallel => {
            let (u, v, w) = (view.camera.u(), view.camera.v(), view.camera.w());
            let slope = (p - q).cross(w);
            let [at_center, across, up] = [p.cross(q - p).dot(w), slope.dot(u), slope.dot(v)];
            Affine { at_center, across, up } * -1.0
        }
    }
}
