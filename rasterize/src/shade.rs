//! The look of what is seen. Object order interpolates the attributes of a triangle's corners,
//! with weights that are functions on the viewport.

mod form;
mod local;
mod quotient;
mod stretch;
mod ways;
mod weights;

use bothways_common::engine::simd::{Level, Simd, SimdBase, SimdNarrow, apart, best_level, f64x8};
use bothways_common::look::bands::{
    self, EightTriangles, LocalVector, MOST_LIGHTS, Points, Rays, Samples, Seen, SetUp, Sixteen,
    Stretch, Surfaces, Wanted, are_alike,
};
use bothways_common::look::lanes::{DVec3x8, Lanes, Vec3x16, each};
use bothways_common::look::texture::{self, TexturePoints};
use bothways_common::{Frame, Primitive, View};
use form::{Form, HitPoints};
use glam::{DVec2, DVec3, Vec3};
use local::{AffineLook, Grid, Local};
use quotient::{Affine, Colors, Quotient};
use stretch::{QuotientAlong, VectorAlong};
use ways::WaysToLights;
use weights::{side_of, side_seen, weights, weights_of};

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

/// [`shade`] with the vector instructions of this level, for tests that compare the levels. It is hidden because the type of
/// levels is: users call [`shade`], which takes the best one.
#[doc(hidden)]
pub fn shade_with(view: &View, frame: &mut Frame, level: Level) {
    let grid = Grid::of(&view.camera.raster(frame.samples()));
    bands::shade(view, frame, &Interpolated { view, grid }, level);
}

/// The surfaces of a view as object order finds them.
struct Interpolated<'a> {
    view: &'a View<'a>,
    grid: Grid,
}

/// One visible primitive, set up for all samples at which it is seen. What only some have is in boxes, so that many small
/// triangles stay in the caches.
struct Surface {
    place: Place,
    normals: Normals,
    texture: Texture,
    details: Option<Box<Details>>,
    /// Whether it is worth finding along a stretch what it looks like: it is flat, and its texture is needed for a pattern alone.
    goes_along: bool,
}

/// What a surface looks like along a stretch of samples, where `f32` is enough for that.
#[derive(Default)]
struct Along {
    /// The ways to the points of light, if there are any.
    ways: [VectorAlong; MOST_LIGHTS],
    has_ways: bool,
    pattern: Option<QuotientAlong>,
}

impl Along {
    /// Forgets what was there.
    #[inline(always)]
    fn begin(&mut self) {
        self.has_ways = false;
        self.pattern = None;
    }
}

/// Where the points are that are seen.
enum Place {
    /// It is not needed.
    Unneeded,
    /// It is found at each sample.
    Points(Box<Form>),
    /// The ways from there to the points of light are functions on the viewport.
    Ways(WaysToLights),
}

enum Texture {
    /// There is none, or it is not needed.
    None,
    /// That of a sphere.
    Sphere,
    /// That of a flat form: a function on the viewport.
    Flat(Box<Quotient>),
}

/// What few surfaces need.
struct Details {
    /// The colours of the vertices.
    colors: Option<Colors>,
    /// Whether it is needed how the texture coordinate moves from sample to sample.
    has_steps: bool,
}

enum Normals {
    /// The same everywhere, towards the viewer.
    Flat(Vec3),
    /// Those of a sphere; the reciprocal of its radius.
    Sphere(f64),
    Smooth(Smooth),
}

/// Interpolated normals: each coordinate is a function on the viewport.
struct Smooth {
    coordinates: [Affine; 3],
    /// The flat one, unless the corners' are alike enough never to cancel each other.
    flat: Option<Box<DVec3>>,
}

impl Surfaces for Interpolated<'_> {
    type Surface = Surface;
    type Local = AffineLook;
    type Along = Along;

    #[inline(always)]
    fn set_up(
        &self,
        seen: &Seen,
        wanted: Wanted,
        ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> SetUp<Surface, AffineLook> {
        let (view, primitive) = (self.view, &seen.primitive);
        let corners = seen.corner_normals();
        if let Some(local) = self.local(seen, corners, wanted, ways) {
            return SetUp::Local(local);
        }
        let normals = Normals::new(view, primitive, corners);
        let texture = if seen.needs_texture(wanted) {
            Texture::new(view, primitive, seen.corner_coordinates())
        } else {
            Texture::None
        };
        // Without a pattern, ways that are found at each sample take no longer.
        let goes_along = seen.needs_pattern_alone(wanted) && matches!(texture, Texture::Flat(_));
        let details = Details::new(view, seen, wanted).map(Box::new);
        let place = self.place(primitive, wanted);
        SetUp::Surface(Surface { place, normals, texture, details, goes_along })
    }

    #[inline(always)]
    fn set_up_eight<S: Simd>(
        &self,
        triangles: &EightTriangles<S>,
        wanted: Wanted,
        mut keep: impl FnMut(Option<AffineLook>, &[LocalVector; MOST_LIGHTS]),
    ) {
        let certain = triangles.are_alike();
        let local = Local::new(self.view, &self.grid, triangles.corners, triangles.normals);
        local.each_of(triangles.used, wanted.lights, |lane, look, ways| {
            keep(look.filter(|_| certain >> lane & 1 == 1), ways);
        });
    }

    #[inline(always)]
    fn go_along(&self, surface: &Surface, stretch: &Stretch, _: Wanted, along: &mut Along) {
        along.begin();
        if !surface.goes_along {
            return;
        }
        let step = self.grid.step();
        if let Texture::Flat(quotient) = &surface.texture {
            along.pattern = QuotientAlong::new(quotient, stretch, step);
        }
        if let Place::Ways(ways) = &surface.place {
            along.has_ways = ways.go_along(stretch, step[1], &mut along.ways);
        }
    }

    #[inline(always)]
    fn looks_at_t(&self, surface: &Surface) -> bool {
        matches!(surface.place, Place::Points(_))
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
        match &surface.normals {
            Normals::Flat(flat) => points.set_normals(Vec3x16::splat(simd, *flat)),
            Normals::Smooth(smooth) => {
                let low = smooth.at(simd, &samples.low);
                let high = if samples.is_short { low } else { smooth.at(simd, &samples.high) };
                points.set_normals(low.narrow(high));
            }
            Normals::Sphere(_) => {}
        }
        let hits = match &surface.place {
            Place::Unneeded => [HitPoints::nowhere(simd); 2],
            Place::Ways(ways) => {
                ways.store(simd, along.has_ways.then_some(&along.ways), samples, points);
                [HitPoints::nowhere(simd); 2]
            }
            Place::Points(form) => {
                let halves = [&samples.low, &samples.high];
                let rays = each!(k in [0, 1] => self.rays(simd, halves[k]));
                let hits = each!(k in [0, 1] => form.hit_points(simd, halves[k], &rays[k]));
                points.set_points(each!(k in [0, 1] => hits[k].position));
                if let Normals::Sphere(scale) = surface.normals {
                    let [low, high] =
                        each!(k in [0, 1] => on_ball(simd, scale, &hits[k], &rays[k]));
                    points.set_normals(low.narrow(high));
                }
                hits
            }
        };
        self.texture(simd, (&surface.texture, along), samples, &hits, points);
        if let Some(details) = &surface.details {
            self.details(simd, details, &surface.texture, samples, &hits, points);
        }
    }
}

impl Interpolated<'_> {
    /// The look of a small triangle of which nothing is wanted but normals and the ways to lights, and whose corners' normals never
    /// cancel each other.
    #[inline(always)]
    fn local(
        &self,
        seen: &Seen,
        normals: Option<[DVec3; 3]>,
        wanted: Wanted,
        ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> Option<AffineLook> {
        let (Primitive::Triangle(corners), Some(normals)) = (seen.primitive, normals) else {
            return None;
        };
        if !seen.is_plain(wanted) || !are_alike(normals) {
            return None;
        }
        let [corners, normals] = each!(three in [corners, normals] => three.map(Lanes::from));
        Local::new(self.view, &self.grid, corners, normals).look(wanted.lights, ways)
    }

    /// Where the points of a primitive are, if that is needed.
    fn place(&self, primitive: &Primitive, wanted: Wanted) -> Place {
        let is_sphere = matches!(primitive, Primitive::Sphere { .. });
        if !is_sphere && wanted.lights.is_empty() {
            return Place::Unneeded;
        }
        match WaysToLights::new(self.view, primitive, wanted.lights) {
            Some(ways) => Place::Ways(ways),
            None => Place::Points(Box::new(Form::new(self.view, primitive))),
        }
    }

    /// The texture coordinates of some samples, and their footprints.
    #[inline(always)]
    fn texture<S: Simd>(
        &self,
        simd: S,
        (texture, along): (&Texture, &Along),
        samples: &Sixteen<S>,
        hits: &[HitPoints<S>; 2],
        points: &mut Points<'_>,
    ) {
        if let Some(along) = &along.pattern {
            return points.set_pattern(simd, &along.at(simd, samples.numbers(simd)));
        }
        let [low, high] = match texture {
            Texture::None => return,
            Texture::Flat(quotient) => each!(half in [&samples.low, &samples.high] => {
                quotient.with_footprint(simd, half.x, half.y, self.grid.step())
            }),
            Texture::Sphere => {
                each!(half in [(&samples.low, &hits[0]), (&samples.high, &hits[1])] => {
                    self.on_sphere(simd, half.0, half.1)
                })
            }
        };
        let footprint = each!(k in [0, 1] => low.1[k].narrow(high.1[k]));
        points.set_texture(&TexturePoints { halves: [low.0, high.0], footprint });
    }

    /// What few surfaces need at some samples.
    #[inline(always)]
    fn details<S: Simd>(
        &self,
        simd: S,
        details: &Details,
        texture: &Texture,
        samples: &Sixteen<S>,
        hits: &[HitPoints<S>; 2],
        points: &mut Points<'_>,
    ) {
        if let Some(colors) = &details.colors {
            points.set_colors(colors.at(simd, &samples.low).narrow(colors.at(simd, &samples.high)));
        }
        if !details.has_steps {
            return;
        }
        let halves = [(&samples.low, &hits[0]), (&samples.high, &hits[1])];
        let [low, high] = match texture {
            Texture::None => return,
            Texture::Flat(quotient) => {
                each!(k in [0, 1] => quotient.differences(simd, halves[k].0, self.grid.step()))
            }
            Texture::Sphere => {
                each!(k in [0, 1] => self.differences_on_sphere(simd, halves[k].0, halves[k].1))
            }
        };
        points.set_steps(each!(way in [0, 1] => {
            each!(k in [0, 1] => low[way][k].narrow(high[way][k]))
        }));
    }

    /// The differences on the planes that touch a sphere where it is seen.
    #[inline(always)]
    fn differences_on_sphere<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        hit: &HitPoints<S>,
    ) -> [[f64x8<S>; 2]; 2] {
        apart!(simd, {
            let (_, gradients) = texture::on_sphere_lanes(simd, hit.from_center);
            // Each lane has a plane of its own, whose differences are taken for all lanes, and kept for one.
            let mut all = [[[f64x8::splat(simd, 0.0); 2]; 2]; 8];
            for (lane, differences) in all.iter_mut().enumerate() {
                let gradients = [gradients[0].lane(lane), gradients[1].lane(lane)];
                let (position, normal) = (hit.position.lane(lane), hit.from_center.lane(lane));
                let touching = Quotient::on_plane(self.view, position, normal, gradients);
                *differences = touching.differences(simd, samples, self.grid.step());
            }
            each!(way in [0, 1] => each!(k in [0, 1] => f64x8::from_fn(simd, |lane| all[lane][way][k][lane])))
        })
    }

    #[inline(always)]
    fn rays<S: Simd>(&self, simd: S, samples: &Samples<S>) -> Rays<S> {
        Rays::of_row(simd, self.view.camera, samples.x, samples.y)
    }

    /// Near a sample the sphere is the plane that touches it there.
    #[inline(always)]
    fn on_sphere<S: Simd>(
        &self,
        simd: S,
        samples: &Samples<S>,
        hit: &HitPoints<S>,
    ) -> ([f64x8<S>; 2], [f64x8<S>; 2]) {
        apart!(simd, {
            let (coordinate, gradients) = texture::on_sphere_lanes(simd, hit.from_center);
            let [down, across] = self.grid.step();
            let changes: [DVec2; 8] = std::array::from_fn(|lane| {
                let (position, normal) = (hit.position.lane(lane), hit.from_center.lane(lane));
                let gradients = gradients.map(|gradient| gradient.lane(lane));
                let touching = Quotient::on_plane(self.view, position, normal, gradients);
                let [along_x, along_y] = touching.changes(samples.x[lane], samples.y);
                (along_x * across).abs() + (along_y * down).abs()
            });
            let footprint = each!(k in [0, 1] => f64x8::from_fn(simd, |lane| changes[lane][k]));
            (coordinate, footprint)
        })
    }
}

impl Normals {
    #[inline(always)]
    fn new(view: &View, primitive: &Primitive, corners: Option<[DVec3; 3]>) -> Normals {
        match *primitive {
            Primitive::Sphere { radius, .. } => Normals::Sphere(1.0 / radius),
            Primitive::Plane { point, normal } => {
                let flat = normal.normalize_or_zero();
                Normals::Flat((flat * side_seen(view, point, flat)).as_vec3())
            }
            Primitive::Triangle(triangle) => {
                let [a, b, c] = triangle;
                let flat = || {
                    let normal = (b - a).cross(c - a);
                    normal.normalize_or_zero() * side_seen(view, a, normal)
                };
                let Some(normals) = corners else { return Normals::Flat(flat().as_vec3()) };
                let flat = (!are_alike(normals)).then(|| Box::new(flat()));
                let [triangle, normals] = [triangle, normals].map(|three| three.map(Lanes::from));
                Normals::Smooth(Smooth {
                    coordinates: smooth_normals(view, triangle, normals),
                    flat,
                })
            }
        }
    }
}

/// The coordinates of a triangle's interpolated normals, towards the viewer.
fn smooth_normals(view: &View, [a, b, c]: [Lanes<f64>; 3], at: [Lanes<f64>; 3]) -> [Affine; 3] {
    // The surface, not its smooth look, says which side is seen.
    let side = side_of(view, a, (b - a).cross(c - a));
    let [of_a, of_b, of_c] = weights(view, [a, b, c], side);
    // All weights times one number change no direction; with this one they keep clear of overflow.
    let scale = 1.0 / (of_a + of_b + of_c).largest(view);
    let scale = side * if scale.is_finite() { scale } else { 1.0 };
    let [x, y, z] = [at.map(|at| at.x), at.map(|at| at.y), at.map(|at| at.z)];
    [x, y, z].map(|at| (of_a * at[0] + of_b * at[1] + of_c * at[2]) * scale)
}

impl Smooth {
    /// The normals at some samples, towards the viewer.
    #[inline(always)]
    fn at<S: Simd>(&self, simd: S, samples: &Samples<S>) -> DVec3x8<S> {
        /// Corners' normals that cancel each other leave the flat one.
        const CANCELLED: f64 = 1e-15;
        let [x, y, z] = each!(k in [0, 1, 2] => self.coordinates[k].lanes(simd, samples));
        let smooth = Lanes { x, y, z };
        let Some(flat) = &self.flat else { return smooth };
        let is_direction = smooth.max_magnitude().simd_gt(f64x8::splat(simd, CANCELLED));
        smooth.or(is_direction, DVec3x8::splat(simd, **flat))
    }
}

/// The normals of a sphere at some of its points, towards the viewer, from the reciprocal of its radius.
#[inline(always)]
fn on_ball<S: Simd>(simd: S, scale: f64, hit: &HitPoints<S>, rays: &Rays<S>) -> DVec3x8<S> {
    let normal = hit.from_center * f64x8::splat(simd, scale);
    normal.negated_where(normal.dot(rays.direction).simd_gt(f64x8::splat(simd, 0.0)))
}

impl Details {
    /// `None` if nothing of it is needed.
    #[inline(always)]
    fn new(view: &View, seen: &Seen, wanted: Wanted) -> Option<Details> {
        let (colors, has_steps) = (seen.corner_colors(), seen.needs_steps(wanted));
        if colors.is_none() && !has_steps {
            return None;
        }
        let colors = match (seen.primitive, colors) {
            (Primitive::Triangle([a, b, c]), Some(colors)) => {
                let weights = weights_of(view, [a, b, c]);
                Some(Colors::interpolating(weights, colors))
            }
            _ => None,
        };
        Some(Details { colors, has_steps })
    }
}

impl Texture {
    fn new(view: &View, primitive: &Primitive, corners: Option<[DVec2; 3]>) -> Texture {
        match (*primitive, corners) {
            (Primitive::Sphere { .. }, _) => Texture::Sphere,
            (Primitive::Plane { point, normal }, _) => {
                let axes = texture::plane_axes(normal);
                Texture::Flat(Box::new(Quotient::on_plane(view, point, normal, axes)))
            }
            (Primitive::Triangle([a, b, c]), Some(coordinates)) => {
                let weights = weights_of(view, [a, b, c]);
                Texture::Flat(Box::new(Quotient::interpolating(weights, coordinates)))
            }
            (Primitive::Triangle(_), None) => Texture::None,
        }
    }
}
