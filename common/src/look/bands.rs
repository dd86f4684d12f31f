//! The way of both orders from what is seen to a picture, some samples of a row at a time: what the surfaces look like at
//! each sample, light, and bytes.
//!
//! Where on a surface a sample lies, and what its normal and its texture are there, is each order's own: see
//! [`Surfaces`]. Every number belongs to its sample alone: neither neighbours nor threads nor the width of SIMD change
//! a bit of it.

mod chunk;
mod desk;
mod found;
mod local;
mod local_runs;
mod runs;
mod surfaces;
mod tint;

use crate::camera::SampleGrid;
use crate::engine::simd::{Level, Simd, SimdBase, apart, dispatch, f32x16, prefetch_all};
use crate::frame::{Frame, ShadingBand};
use crate::look::color::srgb_from_linear;
use crate::look::lanes::{Vec3x16, each};
use crate::look::shade::{Finish, Lighting, SurfacePoints};
use crate::raster::Sample;
use crate::scene::material::Material;
use crate::view::View;
use chunk::{
    CHUNK, Chunk, SET_UP_TOGETHER, TOGETHER, Vectors, eight, sixteen, sixteen_vectors,
    store_sixteen_bytes, store_sixteen_places,
};
use desk::{Desk, Kept, KeptLook, KeptSurface, Setting};
use glam::Vec3;
use local_runs::find_local;
use rayon::prelude::*;
use runs::{Group, samples_of};
use std::ops::Range;
use tint::KeptTexture;

pub use local::{
    Anchor, EightVectors, LocalLook, LocalVector, MOST_LIGHTS, eight_columns, local_vector,
    vector_at,
};
pub use surfaces::{
    EightTriangles, Points, Rays, STORED_ERROR, Samples, Seen, SetUp, Sixteen, Stretch, Surfaces,
    TowardsViewer, Wanted, are_alike,
};

/// Gives a frame its picture, and all else that it keeps of the look of what is seen.
///
/// # Panics
///
/// If the frame does not show this view: another size, or ids that the scene does not have.
pub fn shade(view: &View, frame: &mut Frame, surfaces: &impl Surfaces, level: Level) {
    assert_eq!(frame.camera_image(), view.camera.image(), "the frame shows another view");
    let (grid, lighting) = (view.camera.sample_grid(frame.samples()), Lighting::new(view));
    let wanted = Wanted {
        lights: lighting.points(),
        texture_coordinates: !frame.texture_coordinates().is_empty(),
        steps: !frame.levels().is_empty(),
    };
    let samples = frame.samples() as usize;
    let setting = Setting { view, surfaces, wanted };
    let [across, down] = [grid.x(), grid.y()].map(|places| {
        #[expect(clippy::cast_possible_truncation, reason = "light needs no more digits")]
        let places = places.iter().map(|place| (place / view.camera.distance()) as f32);
        places.chain([0.0; 16]).collect()
    });
    let background_bytes = [view.scene.background.to_array().map(srgb_from_linear); CHUNK];
    let lighting = &lighting;
    let look = Look { setting, grid, lighting, background_bytes, across, down, samples };
    // A pixel of one sample has no sum; sums are those of one row.
    let (sums, rows) =
        if samples > 1 { (look.grid.width() / samples, 1) } else { (0, TOGETHER[0]) };
    frame.shading_bands(rows).into_par_iter().for_each_init(
        || Desk::new(sums, lighting.points().len()),
        |desk, mut band| dispatch!(level, simd => look.shade_band(simd, desk, &mut band)),
    );
}

/// Rows and columns of samples of a band whose primitives are set up together.
struct Block {
    lines: Range<usize>,
    columns: Range<usize>,
}

/// What all samples of a picture share.
struct Look<'a, A> {
    setting: Setting<'a, A>,
    grid: SampleGrid<'a>,
    lighting: &'a Lighting,
    /// The background's sRGB bytes, once for each sample of a chunk: to copy them is faster than to repeat three.
    background_bytes: [[u8; 3]; CHUNK],
    /// The places of columns and rows on the viewport, in lengths of the camera's distance; and sixteen more.
    across: Vec<f32>,
    down: Vec<f32>,
    /// Along one side of a pixel.
    samples: usize,
}

impl<'a, A: Surfaces> Look<'a, A> {
    /// Shades some rows of pixels, one where a pixel has several samples.
    #[inline(always)]
    fn shade_band<S: Simd>(&self, simd: S, desk: &mut Desk<'a, A>, band: &mut ShadingBand) {
        let width = band.region.columns.len();
        desk.sums.fill(Vec3::ZERO);
        let height = band.region.rows.len();
        let mut blocks = (0..width).step_by(TOGETHER[1]).flat_map(|column| {
            (0..height).step_by(SET_UP_TOGETHER).map(move |line| Block {
                lines: line..height.min(line + SET_UP_TOGETHER),
                columns: column..width.min(column + TOGETHER[1]),
            })
        });
        let mut block = blocks.next();
        while let Some(this) = block {
            block = blocks.next();
            self.shade_block(simd, desk, band, &this, block.as_ref());
        }
        if self.samples > 1 {
            #[expect(clippy::cast_precision_loss, reason = "a count of samples needs no more")]
            let count = (self.samples * self.samples) as f32;
            for (pixel, sum) in band.picture.iter_mut().zip(&desk.sums) {
                *pixel = (*sum / count).to_array().map(srgb_from_linear);
            }
        }
    }

    /// Shades some rows, or parts of them: finds and sets up what is seen there, then goes through it once more.
    #[inline(always)]
    fn shade_block<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A>,
        band: &mut ShadingBand,
        Block { lines, columns }: &Block,
        next: Option<&Block>,
    ) {
        let width = band.region.columns.len();
        let starts = || columns.clone().step_by(CHUNK);
        let chunks = lines.clone().flat_map(|line| starts().map(move |start| (line, start)));
        let within = |start: usize| start..columns.end.min(start + CHUNK);
        desk.begin_block();
        for (line, start) in chunks.clone() {
            let Range { start, end } = within(start);
            desk.find_runs(simd, band.ids.of(line * width + start..line * width + end));
        }
        if let Some(Block { lines, columns }) = next {
            for line in lines.clone() {
                let samples = line * width + columns.start..line * width + columns.end;
                self.prefetch(band, samples, desk.looks_at_t);
            }
        }
        apart!(simd, desk.set_up_new(simd, &self.setting));
        for (number, (line, start)) in chunks.enumerate() {
            desk.runs.go_to(number);
            self.shade_chunk(simd, desk, band, line, within(start));
        }
    }

    /// Asks the machine for what some samples of a row are shaded from and for where they are written, before use: it does not
    /// guess where the next row is.
    #[inline(always)]
    fn prefetch(&self, band: &ShadingBand, samples: Range<usize>, looks_at_t: bool) {
        band.ids.prefetch(samples.clone());
        if looks_at_t {
            prefetch_all(&band.t[samples.clone()]);
        }
        if self.samples == 1 {
            prefetch_all(&band.picture[samples]);
        }
    }

    /// Shades some samples of a row, of which the runs are known.
    #[inline(always)]
    fn shade_chunk<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A>,
        band: &mut ShadingBand,
        line: usize,
        within: Range<usize>,
    ) {
        let width = band.region.columns.len();
        let stored = line * width + within.start..line * width + within.end;
        let row = band.region.rows.start + line;
        let (count, first) = (within.len(), band.region.columns.start + within.start);
        let start = Sample { row, column: first };
        let mut kept = KeptTexture {
            coordinates: band.texture_coordinates.as_mut().map(|kept| &mut kept[stored.clone()]),
            levels: band.levels.as_mut().map(|kept| &mut kept[stored.clone()]),
        };
        if let [run] = desk.runs.of_chunk()
            && run.place().is_none()
        {
            kept.fill_nothing(0..count);
            return self.write_background(desk, band, within, stored);
        }
        if !desk.surfaces.is_empty() {
            desk.chunk.x[..count].copy_from_slice(&self.grid.x()[first..first + count]);
        }
        if desk.looks_at_t {
            for (wide, t) in desk.chunk.t.iter_mut().zip(&band.t[stored.clone()]) {
                *wide = f64::from(*t);
            }
        }
        apart!(simd, self.find_points(simd, desk, start, &mut kept));
        let normals = band.normals.as_mut().map(|kept| &mut kept[stored.clone()]);
        let needs_colors = self.samples > 1 || band.colors.is_some();
        apart!(simd, self.light(simd, desk, start, needs_colors, normals));
        self.write(desk, band, within, stored);
    }

    /// What is seen at the samples of a chunk: fills its normals, fractions, and ways to lights, and finds which of them are lit together.
    #[inline(always)]
    fn find_points<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A>,
        start: Sample,
        texture: &mut KeptTexture,
    ) {
        let (runs, mut number) = (desk.runs.of_chunk(), 0);
        let (chunk, to_lights) = (&mut *desk.chunk, &mut desk.to_lights[..]);
        let mut along = A::Along::default();
        desk.groups.clear();
        while let Some(run) = runs.get(number) {
            let kept = run.place().map(|place| &desk.kept[place]);
            let Some(Kept { material, look: KeptLook::Surface(place) }) = kept else {
                let seen = (&desk.kept[..], &desk.ways[..]);
                let to = (&mut chunk.normal, &mut *to_lights);
                let (here, groups) = ((start, runs, number), &mut desk.groups);
                number = find_local(simd, here, seen, to, groups, texture);
                continue;
            };
            let (surface, run) = (&desk.surfaces[*place as usize], samples_of(runs, number));
            number += 1;
            desk.groups.add(run.end, Some((material, surface.is_tinted)));
            // A run is in one stretch or more.
            let mut begin = run.start;
            while begin < run.end {
                let next = Stretch::begin_of(start.column + begin) + Stretch::LENGTH;
                let end = run.end.min(next - start.column);
                let (seen, part) = ((surface, *material, &mut along), (start, begin..end));
                apart!(simd, self.find_in_stretch(simd, chunk, to_lights, seen, part, texture));
                begin = end;
            }
        }
    }

    /// The same for the part of a run that is in one stretch.
    ///
    /// The chunk and the ways to lights are parameters of their own: so the compiler knows that to write them changes no surface.
    #[inline(always)]
    fn find_in_stretch<S: Simd>(
        &self,
        simd: S,
        chunk: &mut Chunk,
        to_lights: &mut [Vectors],
        (KeptSurface { surface, is_tinted }, material, along): (
            &KeptSurface<A::Surface>,
            &Material,
            &mut A::Along,
        ),
        (start, run): (Sample, Range<usize>),
        texture: &mut KeptTexture,
    ) {
        let y = self.grid.y()[start.row];
        let begin = Stretch::begin_of(start.column + run.start);
        let stretch = Stretch { x: self.grid.x()[begin], y };
        self.setting.surfaces.go_along(surface, &stretch, self.setting.wanted, along);
        for at in run.clone().step_by(16) {
            let first = Sample { column: start.column + at, ..start };
            let [low, high] = each!(beyond in [0, 8] => Samples {
                first: Sample { column: first.column + beyond, ..first },
                x: eight(simd, &chunk.x, at + beyond),
                y,
                t: eight(simd, &chunk.t, at + beyond),
            });
            let samples = Sixteen {
                low,
                high,
                is_short: run.end - at <= 8,
                #[expect(clippy::cast_precision_loss, reason = "fewer than 64")]
                number: (first.column - begin) as f32,
            };
            // What is written beyond the run is overwritten by the next one.
            let mut points = Points {
                chunk: &mut *chunk,
                to_lights: &mut *to_lights,
                lights: self.setting.wanted.lights,
                checker: material.checker.as_ref(),
                at,
                has_texture: false,
                has_fraction: false,
                has_colors: false,
                has_steps: false,
            };
            self.setting.surfaces.at(simd, surface, along, &samples, &mut points);
            let (has_texture, has_fraction) = (points.has_texture, points.has_fraction);
            let (has_colors, has_steps) = (points.has_colors, points.has_steps);
            if has_fraction {
                // The pattern has been found already.
            } else if let Some(checker) = &material.checker {
                let fraction = if has_texture {
                    checker.fraction(simd, &points.texture(simd))
                } else {
                    f32x16::splat(simd, 0.0)
                };
                fraction.store_slice(&mut chunk.fraction[at..at + 16]);
            } else if *is_tinted {
                let samples = at..run.end.min(at + 16);
                tint::fill(chunk, samples, material, [has_texture, has_colors, has_steps]);
            }
            if let Some(kept) = &mut texture.levels {
                let here = &mut kept[at..run.end.min(at + 16)];
                let texture = material.texture.as_ref().filter(|_| has_steps);
                tint::store_levels(&chunk.steps, texture, has_steps, here);
            }
            if let Some(kept) = &mut texture.coordinates {
                let here = &mut kept[at..run.end.min(at + 16)];
                tint::store_coordinates(chunk, at, has_texture, here);
            }
        }
    }

    /// Lights the samples of a chunk: fills its colours, if they are needed, and its bytes where a pixel has one sample.
    #[inline(always)]
    fn light<S: Simd>(
        &self,
        simd: S,
        desk: &mut Desk<'a, A>,
        start: Sample,
        needs_colors: bool,
        mut normals: Option<&mut [Vec3]>,
    ) {
        let Setting { view, surfaces, .. } = self.setting;
        let towards_viewer = TowardsViewer::along_row(view.camera, self.down[start.row]);
        let (chunk, to_lights, mut begin) = (&mut *desk.chunk, &desk.to_lights[..], 0);
        for &Group { end, shown } in desk.groups.all() {
            let Some((material, is_tinted)) = shown else {
                self.light_nothing(chunk, begin..end, needs_colors, normals.as_deref_mut());
                begin = end;
                continue;
            };
            let finish = *match &desk.finish {
                Some(finish) if finish.is_of(material, is_tinted) => finish,
                _ => desk.finish.insert(Finish::new(material, is_tinted)),
            };
            let looks_at_viewer = self.lighting.looks_at_viewer(&finish);
            for at in (begin..end).step_by(16) {
                let first = Sample { column: start.column + at, ..start };
                let x = sixteen(simd, &self.across, first.column);
                let normal = sixteen_vectors(simd, &chunk.normal, at).normalized(simd);
                let to_viewer = if looks_at_viewer {
                    surfaces.to_viewer(simd, &towards_viewer, first, x).normalized(simd)
                } else {
                    Vec3x16::splat(simd, Vec3::ZERO)
                };
                let points = SurfacePoints {
                    normals: normal,
                    to_viewer,
                    fraction: sixteen(simd, &chunk.fraction, at),
                    tint: each!(k in [0, 1, 2] => sixteen(simd, &chunk.tint[k], at)),
                };
                let to_light = |light: usize| sixteen_vectors(simd, &to_lights[light], at);
                let colors = self.lighting.colors(simd, &points, &finish, to_light);
                if needs_colors {
                    let [red, green, blue] = &mut chunk.color;
                    colors[0].store_slice(&mut red[at..at + 16]);
                    colors[1].store_slice(&mut green[at..at + 16]);
                    colors[2].store_slice(&mut blue[at..at + 16]);
                }
                if self.samples == 1 {
                    store_sixteen_places(simd, colors, &mut chunk.places, at);
                }
                if let Some(kept) = &mut normals {
                    let Vec3x16 { x, y, z } = normal;
                    for (lane, kept) in kept[at..end.min(at + 16)].iter_mut().enumerate() {
                        *kept = Vec3::new(x[lane], y[lane], z[lane]);
                    }
                }
            }
            if self.samples == 1 {
                for at in (begin..end).step_by(16) {
                    store_sixteen_bytes(simd, &chunk.places, &mut chunk.bytes, at);
                }
            }
            begin = end;
        }
    }

    /// The same for samples of a chunk that show nothing.
    #[inline(always)]
    fn light_nothing(
        &self,
        chunk: &mut Chunk,
        samples: Range<usize>,
        needs_colors: bool,
        normals: Option<&mut [Vec3]>,
    ) {
        let background = self.setting.view.scene.background;
        if needs_colors {
            for (to, channel) in chunk.color.iter_mut().zip(background.to_array()) {
                to[samples.clone()].fill(channel);
            }
        }
        if self.samples == 1 {
            let bytes = &self.background_bytes[samples.clone()];
            chunk.bytes[samples.clone()].copy_from_slice(bytes);
        }
        if let Some(normals) = normals {
            normals[samples].fill(Vec3::ZERO);
        }
    }

    /// Writes what a chunk shows where nothing is seen, into the band.
    #[inline(always)]
    fn write_background(
        &self,
        desk: &mut Desk<'a, A>,
        band: &mut ShadingBand,
        within: Range<usize>,
        stored: Range<usize>,
    ) {
        let background = self.setting.view.scene.background;
        if let Some(colors) = &mut band.colors {
            colors[stored.clone()].fill(background);
        }
        if let Some(normals) = &mut band.normals {
            normals[stored.clone()].fill(Vec3::ZERO);
        }
        if self.samples == 1 {
            band.picture[stored].copy_from_slice(&self.background_bytes[..within.len()]);
        } else {
            for column in within {
                desk.sums[column / self.samples] += background;
            }
        }
    }

    /// Writes what was found into the band.
    #[inline(always)]
    fn write(
        &self,
        desk: &mut Desk<'a, A>,
        band: &mut ShadingBand,
        within: Range<usize>,
        stored: Range<usize>,
    ) {
        let chunk = &*desk.chunk;
        let [red, green, blue] = &chunk.color;
        let color = |k: usize| Vec3::new(red[k], green[k], blue[k]);
        if let Some(colors) = &mut band.colors {
            for (k, kept) in colors[stored.clone()].iter_mut().enumerate() {
                *kept = color(k);
            }
        }
        if self.samples == 1 {
            band.picture[stored].copy_from_slice(&chunk.bytes[..within.len()]);
        } else {
            for (k, column) in within.enumerate() {
                desk.sums[column / self.samples] += color(k);
            }
        }
    }
}
