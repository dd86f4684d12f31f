//! The look of what is seen. Image order goes along each ray to the point that it hit.

use bothways_common::engine::simd::{Level, Select, Simd, SimdBase, SimdFloat, best_level, f64x8};
use bothways_common::look::bands::{self, Points, Samples, Seen, Surfaces, Wanted};
use bothways_common::look::lanes::{DVec3x8, each};
use bothways_common::look::texture::{self, TexturePoints};
use bothways_common::{Frame, Primitive, Projection, View};
use glam::{DVec2, DVec3};

/// Gives a frame its picture, from the hit point of each sample's ray. If the frame keeps
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
    bands::shade(view, frame, &AtHits { view, steps: steps(view, frame.samples()) }, level);
}

/// The surfaces of a view as image order finds them.
struct AtHits<'a> {
    view: &'a View<'a>,
    /// The way on the viewport from a sample to the next one across, and to the next one down.
    steps: [DVec3; 2],
}

fn steps(view: &View, samples: u32) -> [DVec3; 2] {
    let [of_row, of_column] = view.camera.raster(samples).spacing();
    [view.camera.u() * of_column, view.camera.v() * -of_row]
}

/// One visible primitive.
struct Surface {
    form: Form,
    /// The flat normal; zero for a sphere.
    flat: DVec3,
    /// The normals of a triangle's corners, if it looks smooth.
    smooth: Option<[DVec3; 3]>,
    texture: Texture,
}

enum Form {
    Sphere {
        center: DVec3,
        radius: f64,
    },
    Plane {
        point: DVec3,
        normal: DVec3,
    },
    /// `normal` is the cross product of two sides; `dual` is it divided by the square of its length.
    Triangle {
        corners: [DVec3; 3],
        normal: DVec3,
        dual: DVec3,
    },
}

enum Texture {
    /// There is none, or it is not needed.
    None,
    Sphere,
    /// The directions in which the two coordinates grow.
    Plane([DVec3; 2]),
    /// The coordinates at the corners, and the directions in which they grow.
    Triangle {
        corners: [DVec2; 3],
        gradients: [DVec3; 2],
    },
}

impl Surfaces for AtHits<'_> {
    type Surface = Surface;

    #[inline(always)]
    fn set_up(&self, seen: &Seen, wanted: Wanted) -> Surface {
        let form = Form::new(&seen.primitive);
        let texture = if wanted.texture_coordinates || seen.material.checker.is_some() {
            Texture::new(&form, seen.corner_coordinates())
        } else {
            Texture::None
        };
        Surface { flat: form.flat_normal(), form, smooth: seen.corner_normals(), texture }
    }

    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, surface: &Surface, samples: &Samples<S>) -> Points<S> {
        let hit = surface.form.hits(simd, samples);
        let weights = match &surface.form {
            Form::Triangle { corners, dual, .. } => Some(areas(simd, corners, *dual, hit.position)),
            Form::Sphere { .. } | Form::Plane { .. } => None,
        };
        let normal = surface.normals(simd, samples, &hit, weights);
        let texture = self.texture_points(simd, surface, samples, &hit, weights);
        Points { position: hit.position, normal, texture }
    }
}

/// Where eight rays hit a primitive.
#[derive(Clone, Copy)]
struct Hits<S: Simd> {
    t: f64x8<S>,
    /// Relative to the eye.
    position: DVec3x8<S>,
    /// Relative to the centre of a sphere; of other primitives, the same as `position`.
    from_center: DVec3x8<S>,
}

impl Form {
    #[inline(always)]
    fn new(primitive: &Primitive) -> Form {
        match *primitive {
            Primitive::Sphere { center, radius } => Form::Sphere { center, radius },
            Primitive::Plane { point, normal } => Form::Plane { point, normal },
            Primitive::Triangle(corners) => {
                let [a, b, c] = corners;
                let normal = (b - a).cross(c - a);
                Form::Triangle { corners, normal, dual: normal / normal.length_squared() }
            }
        }
    }

    /// The unit normal of a flat form.
    #[inline(always)]
    fn flat_normal(&self) -> DVec3 {
        match *self {
            Form::Sphere { .. } => DVec3::ZERO,
            Form::Plane { normal, .. } | Form::Triangle { normal, .. } => {
                normal.normalize_or_zero()
            }
        }
    }

    /// Intersects rays again, in `f64`, with the primitive that they are known to hit: far from the eye, the stored `t`
    /// has too few digits to tell points of the surface apart.
    ///
    /// Where a ray runs along the surface, or numbers are extreme, the new `t` may be worse than the stored one, which
    /// is then used.
    #[inline(always)]
    fn hits<S: Simd>(&self, simd: S, samples: &Samples<S>) -> Hits<S> {
        match *self {
            Form::Sphere { center, radius } => on_sphere(simd, center, radius, samples),
            Form::Plane { point, normal } => on_plane(simd, point, normal, samples),
            Form::Triangle { corners: [a, ..], normal, .. } => on_plane(simd, a, normal, samples),
        }
    }
}

#[inline(always)]
fn on_plane<S: Simd>(simd: S, point: DVec3, normal: DVec3, samples: &Samples<S>) -> Hits<S> {
    let [point, normal] = each!(vector in [point, normal] => DVec3x8::splat(simd, vector));
    let t = normal.dot(point - samples.rays.origin) / normal.dot(samples.rays.direction);
    let t = samples.is_close(simd, t).select(t, samples.t);
    let position = samples.points_at(t);
    Hits { t, position, from_center: position }
}

/// A ray comes nearest to the centre at `t = −k`, where it passes beside it by `f`. It meets the sphere half of
/// the way through the sphere before and after that. An eye outside sees the nearer point; where rounding hides
/// whether the eye is outside, the stored `t` decides.
#[inline(always)]
fn on_sphere<S: Simd>(simd: S, center: DVec3, radius: f64, samples: &Samples<S>) -> Hits<S> {
    let splat = |number: f64| f64x8::splat(simd, number);
    let center = DVec3x8::splat(simd, center);
    let (m, d) = (samples.rays.origin - center, samples.rays.direction);
    let a = d.dot(d);
    let k = m.dot(d) / a;
    let f = m - d * k;
    let (zero, square) = (splat(0.0), splat(radius * radius));
    let rest = square - f.dot(f);
    let half = (rest.simd_gt(zero).select(rest, zero) / a).sqrt();
    let begins = m.dot(m);
    let is_clear = (begins - square).abs().simd_gt(splat(1e-12) * (begins + square));
    let outside = is_clear.select(begins - square, zero - (samples.t + k));
    let half = outside.simd_gt(zero).select(-half, half);
    let t = half - k;
    let is_close = samples.is_close(simd, t);
    let t = is_close.select(t, samples.t);
    let position = samples.points_at(t);
    Hits { t, position, from_center: (f + d * half).or(is_close, position - center) }
}

impl Surface {
    /// The normals at some hit points, towards the viewer.
    #[inline(always)]
    fn normals<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        hit: &Hits<S>,
        weights: Option<[f64x8<S>; 3]>,
    ) -> DVec3x8<S> {
        /// Corners' normals that cancel each other leave the flat one.
        const CANCELLED: f64 = 1e-15;
        let flat = match self.form {
            Form::Sphere { radius, .. } => hit.from_center * f64x8::splat(simd, 1.0 / radius),
            Form::Plane { .. } | Form::Triangle { .. } => DVec3x8::splat(simd, self.flat),
        };
        let normal = match (&self.smooth, weights) {
            (Some(normals), Some([of_a, of_b, of_c])) => {
                let [at_a, at_b, at_c] = each!(k in [0, 1, 2] => DVec3x8::splat(simd, normals[k]));
                let smooth = at_a * of_a + at_b * of_b + at_c * of_c;
                let is_direction = smooth.max_magnitude().simd_gt(f64x8::splat(simd, CANCELLED));
                smooth.or(is_direction, flat)
            }
            _ => flat,
        };
        // The surface decides which side is seen, not its smooth normals.
        let is_back = flat.dot(samples.rays.direction).simd_gt(f64x8::splat(simd, 0.0));
        normal.negated_where(is_back)
    }
}

/// The weights of the corners: the areas into which the hit points divide the triangle, as fractions of its own.
#[inline(always)]
fn areas<S: Simd>(simd: S, corners: &[DVec3; 3], dual: DVec3, hit: DVec3x8<S>) -> [f64x8<S>; 3] {
    let dual = DVec3x8::splat(simd, dual);
    let [a, b, c] = each!(k in [0, 1, 2] => DVec3x8::splat(simd, corners[k]) - hit);
    [b.cross(c).dot(dual), c.cross(a).dot(dual), a.cross(b).dot(dual)]
}

impl Texture {
    #[inline(always)]
    fn new(form: &Form, corners: Option<[DVec2; 3]>) -> Texture {
        match (form, corners) {
            (Form::Sphere { .. }, _) => Texture::Sphere,
            (Form::Plane { normal, .. }, _) => Texture::Plane(texture::plane_axes(*normal)),
            (Form::Triangle { corners: [a, b, c], dual, .. }, Some(values)) => {
                // The area opposite to a corner grows away from its side, in proportion to the side's length.
                let growth = [*c - *b, *a - *c, *b - *a].map(|side| dual.cross(side));
                let gradient = |k: usize| {
                    growth.iter().zip(values).map(|(&growth, value)| growth * value[k]).sum()
                };
                Texture::Triangle { corners: values, gradients: [gradient(0), gradient(1)] }
            }
            (Form::Triangle { .. }, None) => Texture::None,
        }
    }
}

/// The texture of surfaces around some of their points.
struct Charts<S: Simd> {
    coordinate: [f64x8<S>; 2],
    /// The directions in which the two coordinates grow, and how fast.
    gradients: [DVec3x8<S>; 2],
    /// Those of the surface; their lengths do not matter.
    normal: DVec3x8<S>,
}

impl AtHits<'_> {
    /// The texture at some hit points.
    #[inline(always)]
    fn texture_points<S: Simd>(
        &self,
        simd: S,
        surface: &Surface,
        samples: &Samples<S>,
        hit: &Hits<S>,
        weights: Option<[f64x8<S>; 3]>,
    ) -> Option<TexturePoints<S>> {
        let splat = |vector: DVec3| DVec3x8::splat(simd, vector);
        let charts = match (&surface.texture, &surface.form, weights) {
            (Texture::Sphere, ..) => {
                let (coordinate, gradients) = texture::on_sphere_lanes(simd, hit.from_center);
                Charts { coordinate, gradients, normal: hit.from_center }
            }
            (Texture::Plane(axes), Form::Plane { point, normal }, _) => {
                let gradients = each!(k in [0, 1] => splat(axes[k]));
                let beside = hit.position - splat(*point);
                let coordinate = each!(k in [0, 1] => gradients[k].dot(beside));
                Charts { coordinate, gradients, normal: splat(*normal) }
            }
            (Texture::Triangle { corners, gradients }, _, Some([of_a, of_b, of_c])) => {
                let total = of_a + of_b + of_c;
                let coordinate = each!(k in [0, 1] => {
                    let [a, b, c] =
                        each!(corner in [0, 1, 2] => f64x8::splat(simd, corners[corner][k]));
                    (a * of_a + b * of_b + c * of_c) / total
                });
                let gradients = each!(k in [0, 1] => splat(gradients[k]));
                Charts { coordinate, gradients, normal: splat(surface.flat) }
            }
            _ => return None,
        };
        Some(self.seen_along(simd, &charts, samples, hit.t))
    }

    /// What rays that hit here, at `t`, see of the texture.
    ///
    /// The rays through the neighbouring samples meet the tangent plane of the surface a little
    /// beside this point. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
    #[inline(always)]
    fn seen_along<S: Simd>(
        &self,
        simd: S,
        charts: &Charts<S>,
        samples: &Samples<S>,
        t: f64x8<S>,
    ) -> TexturePoints<S> {
        let [across, down] = each!(axis in [0, 1] => {
            let step = DVec3x8::splat(simd, self.steps[axis]);
            // A parallel ray moves with its sample, a perspective one turns.
            let moved = match self.view.camera.projection() {
                Projection::Perspective => step * t,
                Projection::Parallel => step,
            };
            let farther = -(charts.normal.dot(moved) / charts.normal.dot(samples.rays.direction));
            let beside = moved + samples.rays.direction * farther;
            each!(k in [0, 1] => charts.gradients[k].dot(beside))
        });
        TexturePoints::new(charts.coordinate, across, down)
    }
}
