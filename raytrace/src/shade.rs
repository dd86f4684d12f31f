//! The look of what is seen. Image order goes along each ray to the point that it hit.

mod local;
mod stretch;
mod triangle;

use bothways_common::engine::simd::{
    Level, Select, Simd, SimdBase, SimdFloat, SimdNarrow, apart, best_level, f32x16, f64x8,
};
use bothways_common::look::bands::{
    self, EightTriangles, LocalVector, MOST_LIGHTS, Points, Rays, Samples, Seen, SetUp, Sixteen,
    Stretch, Surfaces, Wanted, are_alike,
};
use bothways_common::look::lanes::{DVec3x8, Lanes, Real, Vec3x16, each};
use bothways_common::look::texture::{self, TexturePoints};
use bothways_common::{Frame, Primitive, Projection, Raster, View};
use glam::{DVec2, DVec3, Vec3};
use local::{Beside, LookAtHits};
use stretch::{FirstHit, HitsAlong};
use triangle::{Triangle, side_seen, steps_from_first};

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

/// [`shade`] with the vector instructions of this level, for tests that compare the levels. It is hidden because the type of
/// levels is: users call [`shade`], which takes the best one.
#[doc(hidden)]
pub fn shade_with(view: &View, frame: &mut Frame, level: Level) {
    let raster = view.camera.raster(frame.samples());
    bands::shade(view, frame, &AtHits { view, raster, steps: steps(view, &raster) }, level);
}

/// The surfaces of a view as image order finds them.
struct AtHits<'a> {
    view: &'a View<'a>,
    raster: Raster,
    /// The way on the viewport from a sample to the next one across, and to the next one down.
    steps: [DVec3; 2],
}

fn steps(view: &View, raster: &Raster) -> [DVec3; 2] {
    let [of_row, of_column] = raster.spacing();
    [view.camera.u() * of_column, view.camera.v() * -of_row]
}

/// One visible primitive.
struct Surface {
    form: Form,
    normals: Normals,
    /// Whether more than normals is needed: the ways to points of light, or their texture.
    has_points: bool,
    texture: Texture,
    details: Option<Box<Details>>,
    /// Whether it is worth finding along a stretch where it is hit: it is a plane, or a flat triangle with a pattern, and nothing is needed
    /// but the ways to points of light or the pattern.
    goes_along: bool,
}

/// Where a surface is hit along a stretch of samples, where `f32` is enough for that.
#[derive(Default)]
struct Along {
    is_found: bool,
    hits: HitsAlong,
}

enum Normals {
    /// The same everywhere, towards the viewer.
    Flat(Vec3),
    /// Those of a sphere; the reciprocal of its radius.
    Sphere(f64),
    /// The normal of the first corner, and what those of the others add to it, towards the viewer. They never cancel
    /// each other: no two are farther apart than 84°, so what they add up to is longer than 0.6.
    Smooth(Smooth),
    /// The same where they may cancel, and the flat one.
    Wild(Box<Wild>),
}

struct Smooth([Vec3; 3]);

struct Wild {
    corners: [DVec3; 3],
    flat: DVec3,
}

enum Form {
    Sphere { center: DVec3, radius: f64 },
    Plane { point: DVec3, normal: DVec3 },
    Triangle(Triangle),
}

enum Texture {
    /// There is none, or it is not needed.
    None,
    Sphere,
    /// In a box, so that many small triangles stay in the caches.
    Flat(Box<Chart>),
}

/// What few surfaces need.
struct Details {
    /// The colours of the vertices, as smooth normals are kept.
    colors: Option<Smooth>,
    /// Whether it is needed how the texture coordinate moves from sample to sample.
    has_steps: bool,
}

/// The texture of a flat form.
struct Chart {
    /// The coordinates at the point of a plane, or the first corner of a triangle.
    first: DVec2,
    /// The directions in which the two coordinates grow, and how fast.
    gradients: [DVec3; 2],
    /// How far they grow along the steps from a sample to the next ones: those across and down of each.
    growth: [[f32; 2]; 2],
    /// The part of the steps along the normal.
    rise: [f64; 2],
}

impl Surfaces for AtHits<'_> {
    type Surface = Surface;
    type Local = LookAtHits;
    type Along = Along;

    #[inline(always)]
    fn set_up(
        &self,
        seen: &Seen,
        wanted: Wanted,
        ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> SetUp<Surface, LookAtHits> {
        let corners = seen.corner_normals();
        if let Some(local) = self.local(seen, corners, wanted, ways) {
            return SetUp::Local(local);
        }
        let form = Form::new(&seen.primitive);
        let texture = if seen.needs_texture(wanted) {
            Texture::new(&form, seen.corner_coordinates(), self.steps)
        } else {
            Texture::None
        };
        let details = Details::new(seen, wanted).map(Box::new);
        let normals = Normals::new(self.view, &form, corners);
        let has_points =
            !wanted.lights.is_empty() || !matches!(texture, Texture::None) || details.is_some();
        let has_pattern = seen.needs_pattern_alone(wanted) && matches!(texture, Texture::Flat(_));
        let is_plane = matches!(form, Form::Plane { .. });
        let goes_along = matches!(normals, Normals::Flat(_))
            && has_points
            && details.is_none()
            && (has_pattern || is_plane && matches!(texture, Texture::None));
        SetUp::Surface(Surface { form, normals, has_points, texture, details, goes_along })
    }

    #[inline(always)]
    fn set_up_eight<S: Simd>(
        &self,
        triangles: &EightTriangles<S>,
        wanted: Wanted,
        mut keep: impl FnMut(Option<LookAtHits>, &[LocalVector; MOST_LIGHTS]),
    ) {
        let certain = triangles.are_alike();
        let beside = self.beside(triangles.corners, triangles.normals);
        beside.each_of(triangles.used, wanted.lights, |lane, look, ways| {
            keep(look.filter(|_| certain >> lane & 1 == 1), ways);
        });
    }

    #[inline(always)]
    fn go_along(&self, surface: &Surface, stretch: &Stretch, wanted: Wanted, along: &mut Along) {
        along.is_found =
            surface.goes_along && self.find_along(surface, stretch, wanted.lights, &mut along.hits);
    }

    #[inline(always)]
    fn at<S: Simd>(
        &self,
        simd: S,
        surface: &Surface,
        along: &Along,
        samples: &Sixteen<S>,
        points: &mut Points<'_>,
    ) {
        if along.is_found {
            if let Normals::Flat(flat) = surface.normals {
                points.set_normals(Vec3x16::splat(simd, flat));
            }
            return along.hits.store(simd, samples, points);
        }
        if let (Normals::Flat(flat), false) = (&surface.normals, surface.has_points) {
            return points.set_normals(Vec3x16::splat(simd, *flat));
        }
        let low = self.hits(simd, surface, &samples.low);
        let high = if samples.is_short { low } else { self.hits(simd, surface, &samples.high) };
        points.set_normals(surface.normals.at(simd, [&low, &high]));
        // Triangles of a mesh that are not small mostly need nothing but this.
        if !surface.has_points {
            return;
        }
        points.set_points([low.position, high.position]);
        let details = surface.details.as_deref();
        if let Some(Details { colors: Some(colors), .. }) = details {
            points.set_colors(colors.at(simd, [low.weights, high.weights]));
        }
        let has_steps = details.is_some_and(|details| details.has_steps);
        self.texture(simd, &surface.texture, [&low, &high], has_steps, points);
    }
}

/// Where eight rays hit a primitive.
#[derive(Clone, Copy)]
struct Hits<S: Simd> {
    t: f64x8<S>,
    /// Relative to the eye.
    position: DVec3x8<S>,
    /// Relative to the centre of a sphere, the point of a plane or the first corner of a triangle.
    beside: DVec3x8<S>,
    /// The directions of the rays.
    direction: DVec3x8<S>,
    /// 1 by the product of the directions and the normal of a flat form.
    reciprocal: f64x8<S>,
    /// The weights of the second and the third corner of a triangle.
    weights: [f64x8<S>; 2],
}

impl Form {
    #[inline(always)]
    fn new(primitive: &Primitive) -> Form {
        match *primitive {
            Primitive::Sphere { center, radius } => Form::Sphere { center, radius },
            Primitive::Plane { point, normal } => Form::Plane { point, normal },
            Primitive::Triangle(corners) => Form::Triangle(Triangle::new(corners.map(Lanes::from))),
        }
    }

    /// Intersects rays again, in `f64`, with the primitive that they are known to hit: far from the eye, the stored `t`
    /// has too few digits to tell points of the surface apart.
    ///
    /// Where a ray runs along the surface, or numbers are extreme, the new `t` may be worse than the stored one, which
    /// is then used.
    #[inline(always)]
    fn hits<S: Simd>(&self, simd: S, samples: &Samples<S>, rays: &Rays<S>) -> Hits<S> {
        let ([point, normal], growth) = match self {
            Form::Sphere { center, radius } => {
                return on_sphere(simd, *center, *radius, samples, rays);
            }
            Form::Plane { point, normal } => ([*point, *normal], [DVec3::ZERO; 2]),
            Form::Triangle(Triangle { a, normal, growth }) => {
                ([(*a).into(), (*normal).into()], growth.map(DVec3::from))
            }
        };
        on_plane(simd, [point, normal], growth, samples, rays)
    }
}

impl AtHits<'_> {
    /// The look of a small triangle of which nothing is wanted but normals and the ways to lights, and whose corners' normals never
    /// cancel each other.
    #[inline(always)]
    fn local(
        &self,
        seen: &Seen,
        normals: Option<[DVec3; 3]>,
        wanted: Wanted,
        ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> Option<LookAtHits> {
        let (Primitive::Triangle(corners), Some(normals)) = (seen.primitive, normals) else {
            return None;
        };
        if !seen.is_plain(wanted) || !are_alike(normals) {
            return None;
        }
        let [corners, normals] = each!(three in [corners, normals] => three.map(Lanes::from));
        self.beside(corners, normals).look(wanted.lights, ways)
    }

    #[inline(always)]
    fn beside<T: Real>(&self, corners: [Lanes<T>; 3], normals: [Lanes<T>; 3]) -> Beside<T> {
        Beside::new(self.view, &self.raster, self.steps, corners, normals)
    }

    /// Finds what is needed of a flat form along a stretch. Returns whether `f32` is enough.
    #[inline(always)]
    fn find_along(
        &self,
        surface: &Surface,
        stretch: &Stretch,
        lights: &[DVec3],
        hits: &mut HitsAlong,
    ) -> bool {
        let [point, normal] = match surface.form {
            Form::Plane { point, normal } => [point, normal],
            Form::Triangle(Triangle { a, normal, .. }) => [a.into(), normal.into()],
            Form::Sphere { .. } => return false,
        };
        let Some(first) = FirstHit::new(self.view, [point, normal], self.steps, stretch) else {
            return false;
        };
        if !hits.go_along(&first, lights) {
            return false;
        }
        if let Texture::Flat(chart) = &surface.texture {
            let Chart { first: at_point, gradients, .. } = **chart;
            hits.add_texture(&first, (at_point, gradients), point, self.steps[1]);
        }
        true
    }

    /// The texture coordinates at some hit points, and how they move from sample to sample if that is needed.
    #[inline(always)]
    fn texture<S: Simd>(
        &self,
        simd: S,
        texture: &Texture,
        [low, high]: [&Hits<S>; 2],
        has_steps: bool,
        points: &mut Points<'_>,
    ) {
        let (found, steps) = match texture {
            Texture::None => return,
            Texture::Flat(chart) => self.on_chart(simd, chart, [low, high]),
            Texture::Sphere => self.on_globes(simd, [low, high]),
        };
        points.set_texture(&found);
        if has_steps {
            points.set_steps(steps);
        }
    }

    #[inline(always)]
    fn hits<S: Simd>(&self, simd: S, surface: &Surface, samples: &Samples<S>) -> Hits<S> {
        let rays = Rays::of_row(simd, self.view.camera, samples.x, samples.y);
        surface.form.hits(simd, samples, &rays)
    }
}

/// Where rays meet a plane. `growth` is how the weights of a triangle's second and third corner grow along its plane; a plane that is
/// no triangle's has no weights.
#[inline(always)]
fn on_plane<S: Simd>(
    simd: S,
    [point, normal]: [DVec3; 2],
    growth: [DVec3; 2],
    samples: &Samples<S>,
    rays: &Rays<S>,
) -> Hits<S> {
    let [point, normal] = each!(vector in [point, normal] => DVec3x8::splat(simd, vector));
    let reciprocal = f64x8::splat(simd, 1.0) / normal.dot(rays.direction);
    let t = normal.dot(point - rays.origin) * reciprocal;
    let t = samples.is_close(simd, t).select(t, samples.t);
    let position = rays.at(t);
    let beside = position - point;
    let weights = each!(k in [0, 1] => DVec3x8::splat(simd, growth[k]).dot(beside));
    Hits { t, position, beside, direction: rays.direction, reciprocal, weights }
}

/// A ray comes nearest to the centre at `t = −k`, where it passes beside it by `f`. It meets the sphere half of
/// the way through the sphere before and after that. An eye outside sees the nearer point; where rounding hides
/// whether the eye is outside, the stored `t` decides.
#[inline(always)]
fn on_sphere<S: Simd>(
    simd: S,
    center: DVec3,
    radius: f64,
    samples: &Samples<S>,
    rays: &Rays<S>,
) -> Hits<S> {
    let splat = |number: f64| f64x8::splat(simd, number);
    let center = DVec3x8::splat(simd, center);
    let (m, d) = (rays.origin - center, rays.direction);
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
    let position = rays.at(t);
    let beside = (f + d * half).or(is_close, position - center);
    Hits { t, position, beside, direction: d, reciprocal: zero, weights: [zero; 2] }
}

impl Normals {
    #[inline(always)]
    fn new(view: &View, form: &Form, corners: Option<[DVec3; 3]>) -> Normals {
        let (point, normal) = match *form {
            Form::Sphere { radius, .. } => return Normals::Sphere(1.0 / radius),
            Form::Plane { point, normal } => (point, normal),
            Form::Triangle(Triangle { a, normal, .. }) => (a.into(), normal.into()),
        };
        let side = side_seen(view, Lanes::from(point), Lanes::from(normal));
        let flat = || normal.normalize_or_zero() * side;
        let Some(normals) = corners else { return Normals::Flat(flat().as_vec3()) };
        let corners = steps_from_first(normals.map(Lanes::from), side);
        let corners = corners.map(DVec3::from);
        if !are_alike(normals) {
            return Normals::Wild(Box::new(Wild { corners, flat: flat() }));
        }
        Normals::Smooth(Smooth(corners.map(|normal| normal.as_vec3())))
    }

    /// The normals at some hit points, towards the viewer.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, [low, high]: [&Hits<S>; 2]) -> Vec3x16<S> {
        /// Corners' normals that cancel each other leave the flat one.
        const CANCELLED: f64 = 1e-15;
        match self {
            Normals::Flat(flat) => Vec3x16::splat(simd, *flat),
            Normals::Sphere(scale) => {
                let [zero, scale] = each!(value in [0.0, *scale] => f64x8::splat(simd, value));
                let [low, high] = each!(hit in [low, high] => {
                    let is_back = hit.beside.dot(hit.direction).simd_gt(zero);
                    (hit.beside * scale).negated_where(is_back)
                });
                low.narrow(high)
            }
            Normals::Smooth(smooth) => smooth.at(simd, [low.weights, high.weights]),
            Normals::Wild(wild) => {
                let Wild { corners, flat } = &**wild;
                let [at_a, to_b, to_c] = each!(k in [0, 1, 2] => DVec3x8::splat(simd, corners[k]));
                let flat = DVec3x8::splat(simd, *flat);
                let [low, high] = each!(hit in [low, high] => {
                    let smooth = at_a + to_b * hit.weights[0] + to_c * hit.weights[1];
                    let is_direction = smooth.max_magnitude().simd_gt(f64x8::splat(simd, CANCELLED));
                    smooth.or(is_direction, flat)
                });
                low.narrow(high)
            }
        }
    }
}

impl Smooth {
    /// The normals where the second and the third corner have these weights, which were found in `f64`: on a sliver they
    /// are differences of large numbers. Here they are at most 1, so three roundings of numbers up to 2 remain.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, [low, high]: [[f64x8<S>; 2]; 2]) -> Vec3x16<S> {
        let [b, c] = each!(k in [0, 1] => low[k].narrow(high[k]));
        let [at_a, to_b, to_c] = each!(k in [0, 1, 2] => Vec3x16::splat(simd, self.0[k]));
        at_a + to_b * b + to_c * c
    }
}

impl Details {
    /// `None` if nothing of it is needed.
    #[inline(always)]
    fn new(seen: &Seen, wanted: Wanted) -> Option<Details> {
        let (colors, has_steps) = (seen.corner_colors(), seen.needs_steps(wanted));
        if colors.is_none() && !has_steps {
            return None;
        }
        let colors = colors.map(|[a, b, c]| Smooth([a, b - a, c - a]));
        Some(Details { colors, has_steps })
    }
}

impl Texture {
    #[inline(always)]
    fn new(form: &Form, corners: Option<[DVec2; 3]>, steps: [DVec3; 2]) -> Texture {
        let (first, gradients, normal) = match (form, corners) {
            (Form::Sphere { .. }, _) => return Texture::Sphere,
            (Form::Plane { normal, .. }, _) => (DVec2::ZERO, texture::plane_axes(*normal), *normal),
            (Form::Triangle(Triangle { normal, growth, .. }), Some([a, b, c])) => {
                let [of_b, of_c] = growth.map(DVec3::from);
                let gradient = |k: usize| of_b * (b - a)[k] + of_c * (c - a)[k];
                (a, [gradient(0), gradient(1)], (*normal).into())
            }
            (Form::Triangle(_), None) => return Texture::None,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a footprint needs no more digits")]
        let growth = gradients.map(|gradient| steps.map(|step| gradient.dot(step) as f32));
        let rise = steps.map(|step| normal.dot(step));
        Texture::Flat(Box::new(Chart { first, gradients, growth, rise }))
    }
}

impl AtHits<'_> {
    /// The texture of a flat form at some hit points.
    ///
    /// The rays through the neighbouring samples meet its plane a little beside this point: a step leads there, and then
    /// along the ray as far as the step rose from the plane. Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
    ///
    /// Coordinates are found in `f64`: a footprint may be far smaller than they are. Footprints are differences in `f32`,
    /// with an error of at most `5ε` of their terms' sizes, `ε = 2⁻²⁴`. A coordinate's gradient `g` seen along a ray `D`,
    /// `w = g − n (g·D)/(n·D)`, is no shorter than either part, since `g` lies in the plane, and at a right angle to `D`:
    /// so, pixels being square, a footprint is at least `cos θ` of the largest term; `θ` lies between the ray and the axis,
    /// and its relative error stays below `20ε / cos θ`.
    #[inline(always)]
    fn on_chart<S: Simd>(&self, simd: S, chart: &Chart, [low, high]: [&Hits<S>; 2]) -> Found<S> {
        let is_perspective = self.view.camera.projection() == Projection::Perspective;
        let wide = |number: f64| f64x8::splat(simd, number);
        let gradients = each!(k in [0, 1] => DVec3x8::splat(simd, chart.gradients[k]));
        let halves = each!(hit in [low, high] => each!(k in [0, 1] => {
            wide(chart.first[k]) + gradients[k].dot(hit.beside)
        }));
        // A parallel ray moves with its sample, a perspective one turns: it moves by t steps.
        let one = wide(1.0);
        let [low_moved, high_moved] =
            each!(hit in [low, high] => if is_perspective { hit.t } else { one });
        let moved = low_moved.narrow(high_moved);
        let rise = each!(axis in [0, 1] => {
            let rise = wide(chart.rise[axis]);
            (rise * low.reciprocal).narrow(rise * high.reciprocal)
        });
        let moves = each!(k in [0, 1] => {
            let along_ray = (gradients[k].dot(low.direction) * low_moved)
                .narrow(gradients[k].dot(high.direction) * high_moved);
            each!(axis in [0, 1] => {
                moved * f32x16::splat(simd, chart.growth[k][axis]) - along_ray * rise[axis]
            })
        });
        let footprint = each!(k in [0, 1] => moves[k][0].abs() + moves[k][1].abs());
        (TexturePoints { halves, footprint }, steps_of(moves))
    }

    /// The texture of a sphere at sixteen hit points.
    #[inline(always)]
    fn on_globes<S: Simd>(&self, simd: S, [low, high]: [&Hits<S>; 2]) -> Found<S> {
        let [low, high] = each!(hit in [low, high] => self.on_globe(simd, hit));
        let moves = each!(k in [0, 1] => {
            each!(axis in [0, 1] => low.1[k][axis].narrow(high.1[k][axis]))
        });
        let footprint = each!(k in [0, 1] => {
            let [low, high] = each!(moves in [low.1, high.1] => moves[k][0].abs() + moves[k][1].abs());
            low.narrow(high)
        });
        (TexturePoints { halves: [low.0, high.0], footprint }, steps_of(moves))
    }

    /// The texture of a sphere at eight hit points, and how each coordinate moves across and down: on the planes that touch it.
    #[inline(always)]
    fn on_globe<S: Simd>(&self, simd: S, hit: &Hits<S>) -> ([f64x8<S>; 2], [[f64x8<S>; 2]; 2]) {
        apart!(simd, {
            let (coordinate, gradients) = texture::on_sphere_lanes(simd, hit.beside);
            let [across, down] = each!(axis in [0, 1] => {
                let step = DVec3x8::splat(simd, self.steps[axis]);
                let moved = match self.view.camera.projection() {
                    Projection::Perspective => step * hit.t,
                    Projection::Parallel => step,
                };
                let farther = -(hit.beside.dot(moved) / hit.beside.dot(hit.direction));
                let beside = moved + hit.direction * farther;
                each!(k in [0, 1] => gradients[k].dot(beside))
            });
            (coordinate, each!(k in [0, 1] => [across[k], down[k]]))
        })
    }
}

/// The texture of sixteen hit points, and how the coordinate moves to the next sample across, and to the next one down.
type Found<S> = (TexturePoints<S>, [[f32x16<S>; 2]; 2]);

/// The steps across and down, from how each coordinate moves.
#[inline(always)]
fn steps_of<S: Simd>(moves: [[f32x16<S>; 2]; 2]) -> [[f32x16<S>; 2]; 2] {
    each!(axis in [0, 1] => each!(k in [0, 1] => moves[k][axis]))
}
