//! What a renderer says of its surfaces, eight samples at a time.

use crate::camera::{Camera, Projection};
use crate::engine::simd::{Simd, SimdBase, f64x8, mask64x8};
use crate::look::lanes::{DVec3x8, each};
use crate::look::texture::{self, TexturePoints};
use crate::raster::Sample;
use crate::scene::material::Material;
use crate::scene::{Object, Primitive, Shape};
use glam::{DVec2, DVec3};

/// How a renderer finds out what its surfaces look like.
pub trait Surfaces: Sync {
    /// A visible primitive, set up for all samples at which it is seen.
    type Surface: Send;

    /// The viewing rays through eight samples that follow one another in a row: those of the camera, unless a renderer
    /// has others. There may be fewer samples; the lanes that are left over have any values.
    #[inline(always)]
    fn rays<S: Simd>(
        &self,
        simd: S,
        camera: &Camera,
        _first: Sample,
        [x, y]: [f64x8<S>; 2],
    ) -> Rays<S> {
        Rays::of_camera(simd, camera, [x, y])
    }

    /// Sets up a primitive. Where triangles are as small as samples, most of the time goes here: `#[inline(always)]`.
    fn set_up(&self, seen: &Seen, wanted: Wanted) -> Self::Surface;

    /// What a primitive looks like at eight samples, at which it is seen. Lanes at which it is not have any values.
    fn at<S: Simd>(&self, simd: S, surface: &Self::Surface, samples: &Samples<S>) -> Points<S>;
}

/// A primitive that is seen somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// Its id.
    pub id: u32,
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
                Some(each!(normal in [a, b, c] => normal.as_dvec3().normalize_or_zero()))
            }
            Shape::Triangle(_) | Shape::Sphere(_) | Shape::Plane(_) => None,
        }
    }

    /// The texture coordinates at the corners of a triangle that has some.
    #[inline]
    pub fn corner_coordinates(&self) -> Option<[DVec2; 3]> {
        texture::corners(&self.object.shape, self.local)
    }
}

/// What is needed to know of surfaces besides their normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Where their points are.
    pub positions: bool,
    /// Their texture coordinates, even where no pattern is drawn.
    pub texture_coordinates: bool,
}

/// Eight samples of a row.
#[derive(Clone, Copy, Debug)]
pub struct Samples<S: Simd> {
    /// Where they are on the viewport.
    pub x: f64x8<S>,
    /// Where their row is on the viewport.
    pub y: f64x8<S>,
    /// Their viewing rays.
    pub rays: Rays<S>,
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
        let across = u * x + v * y;
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
}

/// What is seen at eight samples.
#[derive(Clone, Copy, Debug)]
pub struct Points<S: Simd> {
    /// Where it is, relative to the eye; anything unless positions are wanted.
    pub position: DVec3x8<S>,
    /// Normals towards the viewer, of any length between 2⁻⁶⁰ and 2⁶⁰.
    pub normal: DVec3x8<S>,
    /// Texture coordinates, where there are any and they are wanted or a pattern is drawn.
    pub texture: Option<TexturePoints<S>>,
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

    /// The points of the viewing rays at these `t`.
    #[inline(always)]
    pub fn points_at(&self, t: f64x8<S>) -> DVec3x8<S> {
        self.rays.origin + self.rays.direction * t
    }
}
