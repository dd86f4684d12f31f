//! The way of both orders from what is seen to a picture, a row of pixels at a time: what the surfaces look like at
//! each sample, light, and bytes.
//!
//! Where on a surface a sample lies, and what its normal and its texture are there, is each order's own: see
//! [`Surfaces`]. Every number belongs to its sample alone: neither neighbours nor threads nor the width of SIMD change
//! a bit of it.

use crate::camera::{Camera, Projection, SampleGrid};
use crate::engine::simd::{
    Level, Simd, SimdBase, SimdMask, SimdNarrow, dispatch, f64x8, mask64x8, u32x16,
};
use crate::frame::{Frame, NO_PRIMITIVE, ShadingBand};
use crate::look::color::{srgb_from_linear, srgb_of_sixteen};
use crate::look::lanes::{DVec3x8, Lanes, Vec3x16, each};
use crate::look::shade::{Lighting, SurfacePoints};
use crate::look::texture::{self, TexturePoints};
use crate::raster::Sample;
use crate::scene::material::Material;
use crate::scene::{Object, Primitive, Shape};
use crate::view::View;
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;

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
/// The hashes of ids under which visible primitives are kept: those of a row are mostly seen in the next one, too.
const HASHES: usize = 1 << HASH_BITS;
const HASH_BITS: u32 = 12;
/// From so many kept primitives on, a new chunk begins with none.
const MANY_KEPT: usize = HASHES;

/// What a thread works with. It decides no bit of the result.
struct Desk<'a, T> {
    /// For each hash, the id that came last, and its place in `kept`.
    places: Vec<(u32, u32)>,
    kept: Vec<Kept<'a, T>>,
    chunk: Box<Chunk>,
    /// The samples of the chunk in runs of one primitive each.
    runs: Vec<Run>,
    /// Of each pixel of the row, the sum over its samples.
    sums: Vec<Vec3>,
}

struct Kept<'a, T> {
    surface: T,
    material: &'a Material,
}

/// Samples of a row, one after another, that show the same primitive.
#[derive(Clone, Copy)]
struct Run {
    /// The first sample after them.
    end: usize,
    /// The primitive's place in `kept`; `None` where nothing is seen.
    place: Option<u32>,
}

/// Numbers of the samples of a chunk.
struct Chunk {
    x: [f64; CHUNK + BEYOND],
    t: [f64; CHUNK + BEYOND],
    origin: [[f64; CHUNK + BEYOND]; 3],
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
            places: vec![(NO_PRIMITIVE, 0); HASHES],
            kept: Vec::new(),
            chunk: Box::new(Chunk {
                x: [0.0; WIDE],
                t: [0.0; WIDE],
                origin: [[0.0; WIDE]; 3],
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

    /// Finds the runs of a chunk, and sets up their primitives, unless they are kept.
    ///
    /// All are set up before the first is used: so the memory that they lie in is fetched for several at once.
    #[inline(always)]
    fn find_runs<S: Simd, A: Surfaces<Surface = T>>(
        &mut self,
        simd: S,
        look: &Look<'a, A>,
        ids: &[u32],
    ) {
        if self.kept.len() >= MANY_KEPT {
            self.kept.clear();
            self.places.fill((NO_PRIMITIVE, 0));
        }
        self.runs.clear();
        // The ends of the runs: where an id differs from the next one. Vectors find sixteen at a time.
        let mut at = 0;
        while at + 16 < ids.len() {
            let [these, next] =
                each!(at in [at, at + 1] => u32x16::from_slice(simd, &ids[at..at + 16]));
            let mut ends = these.simd_ne(next).to_bitmask();
            while ends != 0 {
                let last = at + ends.trailing_zeros() as usize;
                ends &= ends - 1;
                self.end_run(look, ids, last);
            }
            at += 16;
        }
        for last in at..ids.len() {
            if ids.get(last + 1) != Some(&ids[last]) {
                self.end_run(look, ids, last);
            }
        }
    }

    /// Adds the run of samples that ends with this one.
    #[inline(always)]
    fn end_run<A: Surfaces<Surface = T>>(&mut self, look: &Look<'a, A>, ids: &[u32], last: usize) {
        let id = ids[last];
        let place = (id != NO_PRIMITIVE).then(|| self.place_of(look, id));
        self.runs.push(Run { end: last + 1, place });
    }

    /// The place in `kept` of a visible primitive.
    #[inline(always)]
    fn place_of<A: Surfaces<Surface = T>>(&mut self, look: &Look<'a, A>, id: u32) -> u32 {
        // The golden ratio of 2³² spreads neighbours best (Knuth, "The Art of Computer Programming", 6.4).
        let hash = (id.wrapping_mul(0x9e37_79b9) >> (u32::BITS - HASH_BITS)) as usize;
        let (kept, place) = self.places[hash];
        if kept == id { place } else { self.set_up(look, id, hash) }
    }

    #[inline(never)]
    fn set_up<A: Surfaces<Surface = T>>(
        &mut self,
        look: &Look<'a, A>,
        id: u32,
        hash: usize,
    ) -> u32 {
        let scene = look.view.scene;
        let (object, local) = scene.locate(id);
        let object = &scene.objects()[object];
        let primitive = look.view.primitive_of(&object.shape, local);
        let material = object.material_of(local);
        let seen = Seen { id, primitive, object, local, material };
        let place = u32::try_from(self.kept.len()).expect("few are kept");
        self.kept.push(Kept { surface: look.surfaces.set_up(&seen, look.wanted), material });
        self.places[hash] = (id, place);
        place
    }
}

/// The next eight numbers.
#[inline(always)]
fn eight<S: Simd>(simd: S, numbers: &[f64], at: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &numbers[at..at + 8])
}

/// The next eight vectors.
#[inline(always)]
fn eight_vectors<S: Simd>(
    simd: S,
    [x, y, z]: &[[f64; CHUNK + BEYOND]; 3],
    at: usize,
) -> DVec3x8<S> {
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
        let mut kept = band.texture_coordinates.as_mut().map(|kept| &mut kept[stored.clone()]);
        if is_nothing(ids) {
            desk.runs.clear();
            desk.runs.push(Run { end: ids.len(), place: None });
            if let Some(kept) = &mut kept {
                kept.fill(Vec2::ZERO);
            }
        } else {
            desk.find_runs(simd, self, ids);
            self.find_rays(simd, desk, Sample { row, column: first }, &band.t[stored.clone()]);
            self.find_points(simd, desk, row, kept);
        }
        let normals = band.normals.as_mut().map(|kept| &mut kept[stored.clone()]);
        self.light(simd, desk, normals);
        self.write(desk, band, within, stored);
    }

    /// Where the samples of a chunk are, their viewing rays and their `t`, from the first to the last sample at which
    /// something is seen.
    #[inline(always)]
    fn find_rays<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        start: Sample,
        stored: &[f32],
    ) {
        let (camera, runs, chunk) = (self.view.camera, &desk.runs, &mut *desk.chunk);
        let nothing_until = match runs[..] {
            [Run { end, place: None }, ..] => end,
            _ => 0,
        };
        let nothing_from = match runs[..] {
            [.., Run { end, .. }, Run { place: None, .. }] => end,
            _ => stored.len(),
        };
        let seen = nothing_until..nothing_from;
        let columns = start.column + seen.start..start.column + seen.end;
        chunk.x[seen.clone()].copy_from_slice(&self.grid.x()[columns]);
        for (wide, t) in chunk.t[seen.clone()].iter_mut().zip(&stored[seen.clone()]) {
            *wide = f64::from(*t);
        }
        let y = f64x8::splat(simd, self.grid.y()[start.row]);
        for at in seen.step_by(8) {
            let sample = Sample { column: start.column + at, ..start };
            let rays = self.surfaces.rays(simd, camera, sample, [eight(simd, &chunk.x, at), y]);
            store_eight(rays.direction, &mut chunk.direction, at);
            if camera.projection() == Projection::Parallel {
                store_eight(rays.origin, &mut chunk.origin, at);
            }
        }
    }

    /// What is seen at the samples of a chunk: fills its positions, normals and fractions.
    #[inline(always)]
    fn find_points<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A::Surface>,
        row: usize,
        mut texture_coordinates: Option<&mut [Vec2]>,
    ) {
        let (kept, chunk, mut begin) = (&desk.kept, &mut *desk.chunk, 0);
        for &Run { end, place } in &desk.runs {
            let run = begin..end;
            begin = end;
            if let Some(place) = place {
                let kept = &kept[place as usize];
                self.find_run(simd, chunk, kept, row, run, &mut texture_coordinates);
            } else if let Some(kept) = &mut texture_coordinates {
                kept[run].fill(Vec2::ZERO);
            }
        }
    }

    /// The same for one run.
    #[inline(always)]
    fn find_run<S: Simd>(
        &self,
        simd: S,
        chunk: &mut Chunk,
        Kept { surface, material }: &Kept<'a, A::Surface>,
        row: usize,
        run: Range<usize>,
        texture_coordinates: &mut Option<&mut [Vec2]>,
    ) {
        let y = f64x8::splat(simd, self.grid.y()[row]);
        for at in run.clone().step_by(8) {
            let rays = Rays {
                // All perspective rays begin at the eye.
                origin: match self.view.camera.projection() {
                    Projection::Perspective => DVec3x8::splat(simd, DVec3::ZERO),
                    Projection::Parallel => eight_vectors(simd, &chunk.origin, at),
                },
                direction: eight_vectors(simd, &chunk.direction, at),
            };
            let samples =
                Samples { x: eight(simd, &chunk.x, at), y, rays, t: eight(simd, &chunk.t, at) };
            let points = self.surfaces.at(simd, surface, &samples);
            // What is written beyond the run is overwritten by the next one.
            store_eight(points.normal, &mut chunk.normal, at);
            if self.wanted.positions {
                store_eight(points.position, &mut chunk.position, at);
            }
            if let Some(checker) = &material.checker {
                let none = f64x8::splat(simd, 0.0);
                let fraction =
                    points.texture.map_or(none, |texture| checker.fraction(simd, &texture));
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
        let material_of = |run: &Run| run.place.map(|place| desk.kept[place as usize].material);
        for runs in desk.runs.chunk_by(|a, b| same_material(material_of(a), material_of(b))) {
            let (end, material) = (runs[runs.len() - 1].end, material_of(&runs[0]));
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
                let [low, high] =
                    each!(half in [at, at + 8] => eight_vectors(simd, &chunk.direction, half));
                let to_viewer = low.narrow(high).normalized(simd).negated();
                let [low, high] =
                    each!(half in [at, at + 8] => eight_vectors(simd, &chunk.normal, half));
                let normal = low.narrow(high).normalized(simd);
                let fraction = eight(simd, &chunk.fraction, at);
                let points = SurfacePoints {
                    positions: each!(half in [at, at + 8] => eight_vectors(simd, &chunk.position, half)),
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

/// Whether nothing is seen at any of some samples.
#[inline(always)]
fn is_nothing(ids: &[u32]) -> bool {
    // Without a branch for each sample, vectors compare them.
    ids.chunks(64).all(|ids| ids.iter().fold(true, |all, &id| all & (id == NO_PRIMITIVE)))
}

/// Whether two runs can be lit together.
fn same_material(one: Option<&Material>, other: Option<&Material>) -> bool {
    match (one, other) {
        (None, None) => true,
        (Some(one), Some(other)) => std::ptr::eq(one, other),
        _ => false,
    }
}
