//! The way of both orders from what is seen to a picture, a row of pixels at a time: what the surfaces look like at
//! each sample, light, and bytes.
//!
//! Where on a surface a sample lies, and what its normal and its texture are there, is each order's own: see
//! [`Surfaces`]. Every number belongs to its sample alone: neither neighbours nor threads nor the width of SIMD change
//! a bit of it.

use crate::camera::{Camera, Projection, SampleGrid};
use crate::engine::simd::{
    Level, Simd, SimdBase, SimdNarrow, dispatch, f64x8, mask64x8,
};
use crate::frame::{Frame, NO_PRIMITIVE, ShadingBand};
use crate::look::color::{srgb_from_linear, srgb_of_sixteen};
use crate::look::lanes::{DVec3x8, Lanes, Vec3x16, each};
use crate::look::shade::{Lighting, SurfacePoints};
use crate::look::texture::TexturePoints;
use crate::raster::Sample;
use crate::scene::material::Material;
use crate::view::View;
use glam::{DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// How a renderer finds out what its surfaces look like.
pub trait Surfaces: Sync {
    /// A visible primitive, set up for all samples at which it is seen.
    type Surface: Send;

    /// The viewing rays through eight samples that follow one another in a row: those of the camera, unless a renderer
    /// has others. There may be fewer samples; the lanes that are left over have any values.
    #[inline(always)]
    fn rays<S: Simd>(&self, simd: S, camera: &Camera, _first: Sample, [x, y]: [f64x8<S>; 2]) -> Rays<S> {
        Rays::of_camera(simd, camera, [x, y])
    }

    /// Sets up a primitive.
    fn set_up(&self, id: u32, wanted: Wanted) -> Self::Surface;

    /// What a primitive looks like at eight samples, at which it is seen. Lanes at which it is not have any values.
    fn at<S: Simd>(&self, simd: S, surface: &Self::Surface, samples: &Samples<S>) -> Points<S>;
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

/// Gives a frame its picture, and all else that it keeps of the look of what is seen.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame, surfaces: &impl Surfaces, level: Level) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    let (grid, lighting) = (view.camera.sample_grid(frame.samples()), Lighting::new(view));
    let wanted = Wanted {
        positions: lighting.needs_positions(),
        texture_coordinates: !frame.texture_coordinates().is_empty(),
    };
    let samples = frame.samples() as usize;
    let look = Look { view, grid, lighting, surfaces, wanted, samples };
    frame.shading_bands().into_par_iter().for_each_init(
        || Desk::new(&look),
        |desk, mut band| dispatch!(level, simd => look.shade_band(simd, desk, &mut band)),
    );
}

/// What all samples of a picture share.
struct Look<'a, A> {
    view: &'a View<'a>,
    grid: SampleGrid<'a>,
    lighting: Lighting,
    surfaces: &'a A,
    wanted: Wanted,
    /// Along one side of a pixel.
    samples: usize,
}

/// The most samples of a row that are shaded together: what is kept of them stays in the innermost cache.
const CHUNK: usize = 256;
/// What vectors may write beyond the last sample.
const BEYOND: usize = 16;
/// Visible primitives that are kept, by the last bits of their ids: neighbours of a row are mostly seen in the next one,
/// too.
const KEPT: usize = 1024;

/// What a thread works with. It decides no bit of the result.
struct Desk<'a, T> {
    /// The ids of the primitives in `kept`.
    ids: Vec<u32>,
    kept: Vec<Option<Kept<'a, T>>>,
    chunk: Box<Chunk>,
    /// Where the chunk's runs of samples end, and the material of each; `None` where nothing is seen.
    runs: Vec<(usize, Option<&'a Material>)>,
    /// Of each pixel of the row, the sum over its samples.
    sums: Vec<Vec3>,
}

struct Kept<'a, T> {
    surface: T,
    material: &'a Material,
}

/// Numbers of the samples of a chunk.
struct Chunk {
    x: [f64; CHUNK + BEYOND],
    t: [f64; CHUNK + BEYOND],
    direction: [[f64; CHUNK + BEYOND]; 3],
    position: [[f64; CHUNK + BEYOND]; 3],
    normal: [[f64; CHUNK + BEYOND]; 3],
    fraction: [f64; CHUNK + BEYOND],
    color: [[f32; CHUNK + BEYOND]; 3],
    bytes: [u32; CHUNK + BEYOND],
}

impl<'a, T> Desk<'a, T> {
    fn new<A: Surfaces<Surface = T>>(look: &Look<'a, A>) -> Self {
        const WIDE: usize = CHUNK + BEYOND;
        let pixels = look.grid.width() / look.samples;
        Desk {
            ids: vec![NO_PRIMITIVE; KEPT],
            kept: std::iter::repeat_with(|| None).take(KEPT).collect(),
            chunk: Box::new(Chunk {
                x: [0.0; WIDE],
                t: [0.0; WIDE],
                direction: [[0.0; WIDE]; 3],
                position: [[0.0; WIDE]; 3],
                normal: [[0.0; WIDE]; 3],
                fraction: [0.0; WIDE],
                color: [[0.0; WIDE]; 3],
                bytes: [0; WIDE],
            }),
            runs: Vec::new(),
            sums: if look.samples > 1 { vec![Vec3::ZERO; pixels] } else { Vec::new() },
        }
    }

    /// A visible primitive, set up.
    #[inline]
    fn surface<A: Surfaces<Surface = T>>(&mut self, look: &Look<'a, A>, id: u32) -> &Kept<'a, T> {
        let place = id as usize % KEPT;
        if self.ids[place] != id {
            let (object, local) = look.view.scene.locate(id);
            let material = look.view.scene.objects()[object].material_of(local);
            let surface = look.surfaces.set_up(id, look.wanted);
            self.ids[place] = id;
            self.kept[place] = Some(Kept { surface, material });
        }
        self.kept[place].as_ref().expect("it is kept with its id")
    }
}

/// The next eight numbers.
#[inline(always)]
fn eight<S: Simd>(simd: S, numbers: &[f64], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &numbers[at..at + 8])
}

/// The next eight vectors.
#[inline(always)]
fn eight_vectors<S: Simd>(simd: S, [x, y, z]: &[[f64; CHUNK + BEYOND]; 3], at: usize) -> DVec3x8<S> {
    Lanes { x: eight(simd, x, at), y: eight(simd, y, at), z: eight(simd, z, at) }
}

#[inline(always)]
fn store_eight<S: Simd>(vectors: DVec3x8<S>, to: &mut [[f64; CHUNK + BEYOND]; 3], at: usize) {
    let [to_x, to_y, to_z] = to;
    vectors.x.store_slice(&mut to_x[at..at + 8]);
    vectors.y.store_slice(&mut to_y[at..at + 8]);
    vectors.z.store_slice(&mut to_z[at..at + 8]);
}

impl<'a, A: Surfaces> Look<'a, A> {
    /// Shades a row of pixels.
    #[inline(always)]
    fn shade_band<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        band: &mut ShadingBand,
    ) {
        let width = band.region.columns.len();
        desk.sums.fill(Vec3::ZERO);
        for (line, row) in band.region.rows.clone().enumerate() {
            for start in (0..width).step_by(CHUNK) {
                let end = width.min(start + CHUNK);
                self.shade_chunk(simd, desk, band, (line, row), start..end);
            }
        }
        if self.samples > 1 {
            #[expect(clippy::cast_precision_loss, reason = "a count of samples needs no more")]
            let count = (self.samples * self.samples) as f32;
            for (pixel, sum) in band.picture.iter_mut().zip(&desk.sums) {
                *pixel = (*sum / count).to_array().map(srgb_from_linear);
            }
        }
    }

    /// Shades some samples of a row.
    #[inline(always)]
    fn shade_chunk<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        band: &mut ShadingBand,
        (line, row): (usize, usize),
        within: Range<usize>,
    ) {
        let width = band.region.columns.len();
        let stored = line * width + within.start..line * width + within.end;
        let (ids, first) = (&band.ids[stored.clone()], band.region.columns.start + within.start);
        if ids.iter().all(|&id| id == NO_PRIMITIVE) {
            desk.runs.clear();
            desk.runs.push((ids.len(), None));
        } else {
            let columns = first..first + ids.len();
            desk.chunk.x[..ids.len()].copy_from_slice(&self.grid.x()[columns]);
            for (wide, t) in desk.chunk.t.iter_mut().zip(&band.t[stored.clone()]) {
                *wide = f64::from(*t);
            }
            let kept = band.texture_coordinates.as_mut().map(|kept| &mut kept[stored.clone()]);
            self.find_points(simd, desk, Sample { row, column: first }, ids, kept);
        }
        let normals = band.normals.as_mut().map(|kept| &mut kept[stored.clone()]);
        self.light(simd, desk, normals);
        self.write(desk, band, within, stored);
    }

    /// What is seen at the samples of a chunk: fills its positions, normals and fractions, and its runs.
    #[inline(always)]
    fn find_points<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        first: Sample,
        ids: &[u32],
        mut texture_coordinates: Option<&mut [Vec2]>,
    ) {
        desk.runs.clear();
        let mut begin = 0;
        while let Some(&id) = ids.get(begin) {
            let rest = &ids[begin..];
            let end = begin + rest.iter().position(|&other| other != id).unwrap_or(rest.len());
            let material = if id == NO_PRIMITIVE {
                if let Some(kept) = &mut texture_coordinates {
                    kept[begin..end].fill(Vec2::ZERO);
                }
                None
            } else {
                Some(self.find_run(simd, desk, id, first, begin..end, &mut texture_coordinates))
            };
            match desk.runs.last_mut() {
                Some((last, same)) if same_material(*same, material) => *last = end,
                _ => desk.runs.push((end, material)),
            }
            begin = end;
        }
    }

    /// The same for one primitive; returns its material.
    #[inline(always)]
    fn find_run<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        id: u32,
        Sample { row, column: first }: Sample,
        run: Range<usize>,
        texture_coordinates: &mut Option<&mut [Vec2]>,
    ) -> &'a Material {
        let (material, y) = (desk.surface(self, id).material, self.grid.y()[row]);
        let kept = desk.kept[id as usize % KEPT].as_ref().expect("it was set up");
        let chunk = &mut *desk.chunk;
        for at in run.clone().step_by(8) {
            let (x, y) = (eight(simd, &chunk.x, at), f64x8::splat(simd, y));
            let first = Sample { row, column: first + at };
            let rays = self.surfaces.rays(simd, self.view.camera, first, [x, y]);
            let samples = Samples { x, y, rays, t: eight(simd, &chunk.t, at) };
            let points = self.surfaces.at(simd, &kept.surface, &samples);
            // What is written beyond the run is overwritten by the next one.
            store_eight(points.normal, &mut chunk.normal, at);
            store_eight(rays.direction, &mut chunk.direction, at);
            if self.wanted.positions {
                store_eight(points.position, &mut chunk.position, at);
            }
            if let Some(checker) = &material.checker {
                let none = f64x8::splat(simd, 0.0);
                let fraction = points.texture.map_or(none, |texture| checker.fraction(simd, &texture));
                fraction.store_slice(&mut chunk.fraction[at..at + 8]);
            }
            if let Some(kept) = texture_coordinates {
                let here = &mut kept[at..run.end.min(at + 8)];
                match &points.texture {
                    None => here.fill(Vec2::ZERO),
                    Some(TexturePoints { coordinate: [across, up], .. }) => {
                        let [across, up] = [across.narrow(*across), up.narrow(*up)];
                        for (lane, kept) in here.iter_mut().enumerate() {
                            *kept = Vec2::new(across[lane], up[lane]);
                        }
                    }
                }
            }
        }
        material
    }

    /// Lights the samples of a chunk: fills its colours and, where a pixel has one sample, its bytes.
    #[inline(always)]
    fn light<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        mut normals: Option<&mut [Vec3]>,
    ) {
        let background = self.view.scene.background;
        let background_bytes = {
            let [red, green, blue] = background.to_array().map(srgb_from_linear);
            u32::from_le_bytes([red, green, blue, 0])
        };
        let (chunk, mut begin) = (&mut *desk.chunk, 0);
        for &(end, material) in &desk.runs {
            let Some(material) = material else {
                for (to, channel) in chunk.color.iter_mut().zip(background.to_array()) {
                    to[begin..end].fill(channel);
                }
                chunk.bytes[begin..end].fill(background_bytes);
                if let Some(kept) = &mut normals {
                    kept[begin..end].fill(Vec3::ZERO);
                }
                begin = end;
                continue;
            };
            for at in (begin..end).step_by(16) {
                let [low, high] = each!(at in [at, at + 8] => eight_vectors(simd, &chunk.direction, at));
                let to_viewer = low.narrow(high).normalized(simd).negated();
                let [low, high] = each!(at in [at, at + 8] => eight_vectors(simd, &chunk.normal, at));
                let normal = low.narrow(high).normalized(simd);
                let fraction = eight(simd, &chunk.fraction, at);
                let points = SurfacePoints {
                    positions: each!(at in [at, at + 8] => eight_vectors(simd, &chunk.position, at)),
                    normals: normal,
                    to_viewer,
                    fraction: fraction.narrow(eight(simd, &chunk.fraction, at + 8)),
                };
                let colors = self.lighting.colors(simd, &points, material);
                let [red, green, blue] = &mut chunk.color;
                colors[0].store_slice(&mut red[at..at + 16]);
                colors[1].store_slice(&mut green[at..at + 16]);
                colors[2].store_slice(&mut blue[at..at + 16]);
                if self.samples == 1 {
                    chunk.bytes[at..at + 16].copy_from_slice(&srgb_of_sixteen(simd, colors));
                }
                if let Some(kept) = &mut normals {
                    let Vec3x16 { x, y, z } = normal;
                    for (lane, kept) in kept[at..end.min(at + 16)].iter_mut().enumerate() {
                        *kept = Vec3::new(x[lane], y[lane], z[lane]);
                    }
                }
            }
            begin = end;
        }
    }

    /// Writes what was found into the band.
    #[inline(always)]
    fn write(
        &self,
        desk: &mut Desk<'a, A::Surface>,
        band: &mut ShadingBand,
        within: Range<usize>,
        stored: Range<usize>,
    ) {
        let chunk = &*desk.chunk;
        let [red, green, blue] = &chunk.color;
        let color = |k: usize| Vec3::new(red[k], green[k], blue[k]);
        if let Some(colors) = &mut band.colors {
            for (k, kept) in colors[stored].iter_mut().enumerate() {
                *kept = color(k);
            }
        }
        if self.samples == 1 {
            for (pixel, bytes) in band.picture[within].iter_mut().zip(&chunk.bytes) {
                let [red, green, blue, _] = bytes.to_le_bytes();
                *pixel = [red, green, blue];
            }
        } else {
            for (k, column) in within.enumerate() {
                desk.sums[column / self.samples] += color(k);
            }
        }
    }
}

/// Whether two runs can be lit together.
fn same_material(one: Option<&Material>, other: Option<&Material>) -> bool {
    match (one, other) {
        (None, None) => true,
        (Some(one), Some(other)) => std::ptr::eq(one, other),
        _ => false,
    }
}
