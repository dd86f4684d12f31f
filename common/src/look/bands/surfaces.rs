//! What a renderer says of its surfaces, sixteen samples at a time.

use super::chunk::{Chunk, Vectors, eight, sixteen, store_vectors};
use super::local::{LocalLook, LocalVector, MOST_LIGHTS};
use crate::camera::{Camera, Projection};
use crate::engine::simd::{Simd, SimdBase, SimdMask, f32x16, f64x8, mask64x8};
use crate::look::lanes::{DVec3x8, Vec3x16, each};
use crate::look::texture::{self, TextureDifferences, TexturePoints};
use crate::raster::Sample;
use crate::scene::material::{Checker, Material};
use crate::scene::{Object, Primitive, Shape};
use glam::{DVec2, DVec3, Vec3};
use std::ops::Range;

/// The directions against the camera's rays along a row of samples, of any length.
#[derive(Clone, Copy, Debug)]
pub struct TowardsViewer {
    /// Where `x` is 0.
    at_middle: Vec3,
    /// What is subtracted for each unit of `x`.
    across: Vec3,
}

impl TowardsViewer {
    /// Those of the row at `y`, in lengths of the camera's distance.
    pub fn along_row(camera: &Camera, y: f32) -> TowardsViewer {
        let [u, v, w] = [camera.u(), camera.v(), camera.w()].map(|axis| axis.as_vec3());
        match camera.projection() {
            Projection::Perspective => TowardsViewer { at_middle: w - v * y, across: u },
            Projection::Parallel => TowardsViewer { at_middle: w, across: Vec3::ZERO },
        }
    }

    /// Those of sixteen samples, by their places `x` in lengths of the camera's distance.
    #[inline(always)]
    pub fn at<S: Simd>(&self, simd: S, x: f32x16<S>) -> Vec3x16<S> {
        Vec3x16::splat(simd, self.at_middle) - Vec3x16::splat(simd, self.across) * x
    }
}

/// How a renderer finds out what its surfaces look like.
pub trait Surfaces: Sync {
    /// A visible primitive, set up for all samples at which it is seen.
    type Surface: Send;
    /// A triangle of which nothing but its normals and ways to lights is wanted, where few numbers are enough for them.
    type Local: LocalLook;
    /// What is computed of a primitive once for a [`Stretch`] of samples.
    type Along: Default;

    /// The directions towards the viewer, of any length, at sixteen samples that follow one another in a row: against
    /// the rays of the camera, which `row` has, unless a renderer has others. The samples are given by the first of them and by
    /// their places `x`, in lengths of the camera's distance. There may be fewer; the lanes that are left over have any values.
    #[inline(always)]
    fn to_viewer<S: Simd>(
        &self,
        simd: S,
        row: &TowardsViewer,
        _first: Sample,
        x: f32x16<S>,
    ) -> Vec3x16<S> {
        row.at(simd, x)
    }

    /// Sets up a primitive. Of a local one it fills the ways to the points of light that are wanted, of which there are no more
    /// than there is room for. Where triangles are as small as samples, most of the time goes here: `#[inline(always)]`.
    fn set_up(
        &self,
        seen: &Seen,
        wanted: Wanted,
        ways: &mut [LocalVector; MOST_LIGHTS],
    ) -> SetUp<Self::Surface, Self::Local>;

    /// Sets up eight triangles at once, each with the bits of [`Surfaces::set_up`], and gives those that are used to `keep`,
    /// one after another, with the ways to the points of light that are wanted; `None` for one that is to be set up alone, as all
    /// are unless a renderer does better.
    #[inline(always)]
    fn set_up_eight<S: Simd>(
        &self,
        triangles: &EightTriangles<S>,
        _wanted: Wanted,
        mut keep: impl FnMut(Option<Self::Local>, &[LocalVector; MOST_LIGHTS]),
    ) {
        (0..triangles.used).for_each(|_| keep(None, &[LocalVector::default(); MOST_LIGHTS]));
    }

    /// Whether the `t` of the samples matter to a primitive.
    #[inline(always)]
    fn looks_at_t(&self, _surface: &Self::Surface) -> bool {
        true
    }

    /// Computes what is computed once for a stretch of samples. It must not depend on which of them show the primitive.
    #[inline(always)]
    fn go_along(
        &self,
        _surface: &Self::Surface,
        _stretch: &Stretch,
        _wanted: Wanted,
        _along: &mut Self::Along,
    ) {
    }

    /// Writes down what a primitive looks like at up to sixteen samples, at which it is seen. Lanes at which it is not
    /// get any values.
    fn at<S: Simd>(
        &self,
        simd: S,
        surface: &Self::Surface,
        along: &Self::Along,
        samples: &Sixteen<S>,
        points: &mut Points<'_>,
    );
}

/// What a primitive is set up as.
#[derive(Clone, Copy, Debug)]
pub enum SetUp<S, L> {
    /// A triangle of which nothing but its normals and ways to lights is wanted, where few numbers are enough for them.
    Local(L),
    /// Anything else.
    Surface(S),
}

/// A primitive that is seen somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// Its id.
    pub id: u64,
    /// The primitive, relative to the eye.
    pub primitive: Primitive,
    /// The object that it belongs to.
    pub object: &'a Object,
    /// Its number among the object's primitives, from 0.
    pub local: usize,
    /// The material that it has there.
    pub material: &'a Material,
}

impl Seen<'_> {
    /// The unit normals at the corners of a triangle that has some.
    #[inline(always)]
    pub fn corner_normals(&self) -> Option<[DVec3; 3]> {
        match &self.object.shape {
            Shape::Mesh(mesh) => {
                let [a, b, c] = mesh.normals().of(self.local)?;
                Some(each!(normal in [a, b, c] => unit(normal.as_dvec3())))
            }
            Shape::Instances(instances) => {
                let [a, b, c] = instances.corner_normals(self.local)?;
                Some(each!(normal in [a, b, c] => unit(normal)))
            }
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => None,
        }
    }

    /// The colours at the corners of a triangle that has some.
    #[inline(always)]
    pub fn corner_colors(&self) -> Option<[Vec3; 3]> {
        let (mesh, triangle) = match &self.object.shape {
            Shape::Mesh(mesh) => (mesh, self.local),
            Shape::Instances(instances) => (instances.mesh(), instances.locate(self.local).1),
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => return None,
        };
        let colors = mesh.colors();
        if colors.is_empty() {
            return None;
        }
        let [a, b, c] = mesh.triangles()[triangle];
        Some(each!(vertex in [a, b, c] => colors[vertex as usize]))
    }

    /// Whether each of its samples has a tint: by a texture, or by colours.
    #[inline(always)]
    pub(super) fn is_tinted(&self) -> bool {
        self.material.texture.is_some() || has_colors(self.object)
    }

    /// Whether nothing is wanted but normals and ways to few points of light.
    #[inline(always)]
    pub fn is_plain(&self, wanted: Wanted) -> bool {
        is_plain(wanted, self.object, self.material)
    }

    /// Whether texture coordinates are needed.
    #[inline(always)]
    pub fn needs_texture(&self, wanted: Wanted) -> bool {
        wanted.texture_coordinates || wanted.steps || self.material.has_pattern()
    }

    /// Whether it is needed how texture coordinates move from sample to sample.
    #[inline(always)]
    pub fn needs_steps(&self, wanted: Wanted) -> bool {
        let texture = &self.material.texture;
        wanted.steps || texture.as_ref().is_some_and(|texture| texture.sampler.has_footprint())
    }

    /// Whether texture coordinates are needed for the pattern alone, and for no picture.
    #[inline(always)]
    pub fn needs_pattern_alone(&self, wanted: Wanted) -> bool {
        let Wanted { texture_coordinates, steps, .. } = wanted;
        self.material.checker.is_some() && !(texture_coordinates || steps)
    }

    /// The texture coordinates at the corners of a triangle that has some.
    #[inline]
    pub fn corner_coordinates(&self) -> Option<[DVec2; 3]> {
        texture::corners(&self.object.shape, self.local)
    }
}

/// [`Seen::is_plain`], before the primitive is looked at.
#[inline(always)]
pub(super) fn is_plain(wanted: Wanted, object: &Object, material: &Material) -> bool {
    let Wanted { lights, texture_coordinates, steps } = wanted;
    let is_textured = texture_coordinates || steps || material.has_pattern();
    lights.len() <= MOST_LIGHTS && !is_textured && !has_colors(object)
}

/// Whether its vertices have colours.
#[inline(always)]
fn has_colors(object: &Object) -> bool {
    object.shape.mesh().is_some_and(|mesh| !mesh.colors().is_empty())
}

/// The square of a unit vector's length differs from 1 by no more, whose coordinates were rounded to `f32`.
const NEAR_ONE: f64 = 1e-6;

/// The unit vector; a vector whose length is 1 but for its rounding to `f32` already stands for it, and takes no root.
#[inline(always)]
fn unit(vector: DVec3) -> DVec3 {
    let is_unit = (vector.length_squared() - 1.0).abs() < NEAR_ONE;
    if is_unit { vector } else { vector.normalize_or_zero() }
}

/// Eight triangles of which nothing but interpolated normals and ways to lights is wanted.
#[derive(Clone, Copy, Debug)]
pub struct EightTriangles<S: Simd> {
    /// The corners of each, relative to the eye.
    pub corners: [DVec3x8<S>; 3],
    /// The normals at the corners.
    pub normals: [DVec3x8<S>; 3],
    /// How many there are, if there are fewer than eight: the first ones.
    pub used: usize,
}

/// Corners' normals with smaller cosines between them may cancel each other.
const LEAST_COSINE: f64 = 0.1;

/// Whether three unit normals at the corners of a triangle are alike: then what is interpolated from them is longer than 0.6.
#[inline(always)]
pub fn are_alike([a, b, c]: [DVec3; 3]) -> bool {
    a.dot(b).min(b.dot(c)).min(c.dot(a)) >= LEAST_COSINE
}

impl<S: Simd> EightTriangles<S> {
    /// One bit for each triangle whose normals are unit vectors as they are, and [alike](are_alike).
    #[inline(always)]
    pub fn are_alike(&self) -> u64 {
        let [a, b, c] = self.normals;
        let splat = |number: f64| f64x8::splat(a.x.simd, number);
        let [near_one, one, least] =
            each!(number in [NEAR_ONE, 1.0, LEAST_COSINE] => splat(number));
        let [of_a, of_b, of_c] =
            each!(normal in [a, b, c] => (normal.dot(normal) - one).abs().simd_lt(near_one));
        let [ab, bc, ca] =
            each!(pair in [[a, b], [b, c], [c, a]] => pair[0].dot(pair[1]).simd_ge(least));
        (of_a & of_b & of_c & ab & bc & ca).to_bitmask()
    }
}

/// What shading needs of surfaces besides their normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wanted<'a> {
    /// The ways from their points to these points of light, which are relative to the eye.
    pub lights: &'a [DVec3],
    /// Their texture coordinates, even where no pattern is drawn.
    pub texture_coordinates: bool,
    /// How these move from sample to sample, even where no texture needs it.
    pub steps: bool,
}

/// Up to sixteen samples of a row.
#[derive(Clone, Copy, Debug)]
pub struct Sixteen<S: Simd> {
    /// The first eight.
    pub low: Samples<S>,
    /// The next ones.
    pub high: Samples<S>,
    /// Whether the first eight are all that matter.
    pub is_short: bool,
    /// The number of the first of them in its [`Stretch`].
    pub number: f32,
}

impl<S: Simd> Sixteen<S> {
    /// The numbers of the samples in their stretch. Lanes beyond the stretch get numbers, too, which nobody uses.
    #[inline(always)]
    pub fn numbers(&self, simd: S) -> f32x16<S> {
        let lanes = [0., 1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13., 14., 15.];
        f32x16::splat(simd, self.number) + f32x16::load_array(simd, lanes)
    }
}

/// Samples of a row that are counted from the first of them. What is computed at one of them from its number is the same wherever in
/// the stretch a primitive begins to be seen. A stretch begins in each column whose number is a multiple of 64.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Where its first sample is on the viewport.
    pub x: f64,
    /// Where its row is on the viewport.
    pub y: f64,
}

impl Stretch {
    /// The column in which the stretch of a column begins.
    #[inline(always)]
    pub(super) fn begin_of(column: usize) -> usize {
        column - column % Self::LENGTH
    }

    /// How many samples a stretch has.
    pub const LENGTH: usize = 64;
    /// The number of its last sample.
    pub const LAST: f64 = 63.0;
    /// The lengths that vectors in `f32` may have at the first sample, so that nothing is lost on the way to a direction: from 2⁻⁶⁰ to 2⁶⁰.
    pub const LENGTHS: Range<f64> = 1.0 / (1_u64 << 60) as f64..(1_u64 << 60) as f64;
}

/// Eight samples of a row; there may be fewer.
#[derive(Clone, Copy, Debug)]
pub struct Samples<S: Simd> {
    /// The first of them.
    pub first: Sample,
    /// Where they are on the viewport.
    pub x: f64x8<S>,
    /// Where their row is on the viewport.
    pub y: f64,
    /// The `t` that is stored of what is seen.
    pub t: f64x8<S>,
}

/// Eight viewing rays.
#[derive(Clone, Copy, Debug)]
pub struct Rays<S: Simd> {
    /// Where they begin, relative to the eye.
    pub origin: DVec3x8<S>,
    /// Where they go.
    pub direction: DVec3x8<S>,
}

impl<S: Simd> Rays<S> {
    /// [`Camera::ray_through`] for eight points of the viewport, with the same bits.
    #[inline(always)]
    pub fn of_camera(simd: S, camera: &Camera, [x, y]: [f64x8<S>; 2]) -> Rays<S> {
        let [u, v] = each!(axis in [camera.u(), camera.v()] => DVec3x8::splat(simd, axis));
        Rays::through(simd, camera, u * x + v * y)
    }

    /// Those through some places of a row of the viewport, with the bits of [`Rays::of_camera`].
    #[inline(always)]
    pub fn of_row(simd: S, camera: &Camera, x: f64x8<S>, y: f64) -> Rays<S> {
        let up = DVec3x8::splat(simd, camera.v() * y);
        Rays::through(simd, camera, DVec3x8::splat(simd, camera.u()) * x + up)
    }

    /// Those through points of the viewport, given by the ways from its middle.
    #[inline(always)]
    fn through(simd: S, camera: &Camera, across: DVec3x8<S>) -> Rays<S> {
        match camera.projection() {
            Projection::Perspective => Rays {
                origin: DVec3x8::splat(simd, DVec3::ZERO),
                direction: across - DVec3x8::splat(simd, camera.distance() * camera.w()),
            },
            Projection::Parallel => {
                Rays { origin: across, direction: DVec3x8::splat(simd, -camera.w()) }
            }
        }
    }

    /// The points of the rays at these `t`.
    #[inline(always)]
    pub fn at(&self, t: f64x8<S>) -> DVec3x8<S> {
        self.origin + self.direction * t
    }
}

/// Where to write what is seen at sixteen samples. It goes to memory at once: what is passed on in many vectors, some of
/// which may be missing, is copied several times on its way.
#[derive(Debug)]
pub struct Points<'a> {
    pub(super) chunk: &'a mut Chunk,
    pub(super) to_lights: &'a mut [Vectors],
    /// Those of [`Wanted`].
    pub(super) lights: &'a [DVec3],
    /// That of the material.
    pub(super) checker: Option<&'a Checker>,
    /// The first of the samples in the chunk.
    pub(super) at: usize,
    pub(super) has_texture: bool,
    pub(super) has_fraction: bool,
    pub(super) has_colors: bool,
    pub(super) has_steps: bool,
}

impl Points<'_> {
    /// Normals towards the viewer, of any length between 2⁻⁶⁰ and 2⁶⁰. They are always wanted.
    #[inline(always)]
    pub fn set_normals<S: Simd>(&mut self, normals: Vec3x16<S>) {
        store_vectors(&normals, &mut self.chunk.normal, self.at);
    }

    /// The ways to the point of light with this number, of any length. The ways to all of them are to be set, or
    /// [the points](Points::set_points).
    #[inline(always)]
    pub fn set_to_light<S: Simd>(&mut self, light: usize, ways: Vec3x16<S>) {
        store_vectors(&ways, &mut self.to_lights[light], self.at);
    }

    /// Where the points are, relative to the eye, two times eight: in `f64`, as the eye may be far away. Sets the ways to all points
    /// of light.
    #[inline(always)]
    pub fn set_points<S: Simd>(&mut self, points: [DVec3x8<S>; 2]) {
        for (number, light) in self.lights.iter().enumerate() {
            let light = DVec3x8::splat(points[0].x.simd, *light);
            let [low, high] = each!(k in [0, 1] => light - points[k]);
            self.set_to_light(number, low.narrow(high));
        }
    }

    /// Texture coordinates, if there are any and they are wanted or a pattern is drawn.
    #[inline(always)]
    pub fn set_texture<S: Simd>(&mut self, texture: &TexturePoints<S>) {
        self.has_texture = true;
        let [low, high] = &texture.halves;
        let at = self.at;
        let [across, up] = &mut self.chunk.coordinate;
        low[0].store_slice(&mut across[at..at + 8]);
        high[0].store_slice(&mut across[at + 8..at + 16]);
        low[1].store_slice(&mut up[at..at + 8]);
        high[1].store_slice(&mut up[at + 8..at + 16]);
        let [width, height] = &mut self.chunk.footprint;
        texture.footprint[0].store_slice(&mut width[at..at + 16]);
        texture.footprint[1].store_slice(&mut height[at..at + 16]);
    }

    /// The texture coordinates by differences, where [the pattern is all that they are needed for](Seen::needs_pattern_alone).
    #[inline(always)]
    pub fn set_pattern<S: Simd>(&mut self, simd: S, texture: &TextureDifferences<S>) {
        let Some(checker) = self.checker else { return };
        self.has_fraction = true;
        let fraction = checker.fraction_by_differences(simd, texture);
        fraction.store_slice(&mut self.chunk.fraction[self.at..self.at + 16]);
    }

    /// How the texture coordinate moves from each sample to the next one across and to the next one down, as this order
    /// finds it: if steps are needed.
    #[inline(always)]
    pub fn set_steps<S: Simd>(&mut self, [across, down]: [[f32x16<S>; 2]; 2]) {
        self.has_steps = true;
        let steps = &mut self.chunk.steps;
        across[0].store_slice(&mut steps[0]);
        across[1].store_slice(&mut steps[1]);
        down[0].store_slice(&mut steps[2]);
        down[1].store_slice(&mut steps[3]);
    }

    /// Interpolated colours, if the corners have some.
    #[inline(always)]
    pub fn set_colors<S: Simd>(&mut self, colors: Vec3x16<S>) {
        self.has_colors = true;
        store_vectors(&colors, &mut self.chunk.tint, self.at);
    }

    /// The texture that was set.
    #[inline(always)]
    pub(super) fn texture<S: Simd>(&self, simd: S) -> TexturePoints<S> {
        let Chunk { coordinate, footprint, .. } = &*self.chunk;
        TexturePoints {
            halves: each!(at in [self.at, self.at + 8] => {
                each!(k in [0, 1] => eight(simd, &coordinate[k], at))
            }),
            footprint: each!(k in [0, 1] => sixteen(simd, &footprint[k], self.at)),
        }
    }
}

/// The largest part of a stored `t` by which it may differ from the true one, with room: a `t` that is computed anew
/// and differs by more is worse than the stored one, because the ray runs along the surface or numbers are extreme.
pub const STORED_ERROR: f64 = 2e-5;

impl<S: Simd> Samples<S> {
    /// Whether a `t` that was computed anew is better than the stored one: close to it, but of more digits.
    #[inline(always)]
    pub fn is_close(&self, simd: S, t: f64x8<S>) -> mask64x8<S> {
        (t - self.t).abs().simd_le(f64x8::splat(simd, STORED_ERROR) * self.t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::CameraDescription;
    use crate::engine::simd::{dispatch, levels};

    /// One of each projection.
    fn cameras() -> [Camera; 2] {
        [Projection::Perspective, Projection::Parallel].map(|projection| {
            let eye = Vec3::new(0.7, -1.1, 3.0);
            Camera::new(CameraDescription { projection, eye, ..Default::default() }).unwrap()
        })
    }

    #[test]
    fn rays_of_a_row_are_those_of_the_camera() {
        for camera in cameras() {
            for (level, y) in levels().into_iter().zip([0.3, -0.7, 1e-9, 1e9].into_iter().cycle()) {
                dispatch!(level, simd => {
                    let x = f64x8::from_fn(simd, |lane| 0.37 * lane as f64 - 1.0);
                    let row = Rays::of_row(simd, &camera, x, y);
                    let places = Rays::of_camera(simd, &camera, [x, f64x8::splat(simd, y)]);
                    for lane in 0..8 {
                        let ray = camera.ray_through(x[lane], y);
                        for rays in [&row, &places] {
                            assert_eq!(rays.origin.lane(lane), ray.origin);
                            assert_eq!(rays.direction.lane(lane), ray.direction);
                        }
                    }
                });
            }
        }
    }

    #[test]
    fn directions_to_the_viewer_are_against_the_rays() {
        for camera in cameras() {
            for (level, y) in levels().into_iter().zip([0.3, -0.7, 2.5].into_iter().cycle()) {
                let place = |lane: usize| 0.37 * lane as f64 - 1.0;
                #[expect(clippy::cast_possible_truncation, reason = "as light has them")]
                let in_distances = |place: f64| (place / camera.distance()) as f32;
                dispatch!(level, simd => {
                    let x = f32x16::from_fn(simd, |lane| in_distances(place(lane)));
                    let row = TowardsViewer::along_row(&camera, in_distances(y));
                    let Vec3x16 { x, y: up, z } = row.at(simd, x).normalized(simd);
                    for lane in 0..16 {
                        let found = Vec3::new(x[lane], up[lane], z[lane]).as_dvec3();
                        let ray = camera.ray_through(place(lane), y).direction.normalize();
                        assert!((found + ray).length() < 1e-6, "{:?}: {lane}, {y}", camera.projection());
                    }
                });
            }
        }
    }
}
