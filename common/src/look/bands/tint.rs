//! What textures and colours of vertices leave of the material's colour, the tint; and what a frame keeps of textures.

use super::chunk::Chunk;
use crate::frame::{LEVELS_OF, NO_LEVEL};
use crate::look::level_of;
use crate::scene::material::Material;
use crate::scene::texture::Texture;
use glam::{DVec2, Vec2, Vec3};
use std::ops::Range;

/// What a frame keeps of the textures of some samples.
pub(super) struct KeptTexture<'a> {
    pub(super) coordinates: Option<&'a mut [Vec2]>,
    pub(super) levels: Option<&'a mut [f32]>,
}

impl KeptTexture<'_> {
    /// At these samples there is no texture.
    pub(super) fn fill_nothing(&mut self, samples: Range<usize>) {
        if let Some(kept) = &mut self.coordinates {
            kept[samples.clone()].fill(Vec2::ZERO);
        }
        if let Some(kept) = &mut self.levels {
            kept[samples].fill(NO_LEVEL);
        }
    }
}

/// Fills the tint of some samples of one primitive, at most sixteen. The chunk has their texture coordinates, their colours
/// (in the tint), and how the coordinates move from sample to sample, as far as `has` says so.
///
/// One sample after the other, compiled once for all levels of SIMD: texels are fetched one by one in any case.
#[inline(never)]
pub(super) fn fill(
    chunk: &mut Chunk,
    samples: Range<usize>,
    material: &Material,
    [has_texture, has_colors, has_steps]: [bool; 3],
) {
    let texture = material.texture.as_ref().filter(|_| has_texture);
    for (lane, at) in samples.enumerate() {
        let mut tint = if has_colors {
            Vec3::from([0, 1, 2].map(|k: usize| chunk.tint[k][at]))
        } else {
            Vec3::ONE
        };
        if let Some(texture) = texture {
            let [across, up] = &chunk.coordinate;
            let level = if has_steps { texture.level(steps_of(&chunk.steps, lane)) } else { 0.0 };
            tint *= texture.color(DVec2::new(across[at], up[at]), level);
        }
        for (k, to) in chunk.tint.iter_mut().enumerate() {
            to[at] = tint[k];
        }
    }
}

/// Stores the levels of some samples, at most sixteen; those of a [usual texture](LEVELS_OF) where there is no texture.
#[inline(never)]
pub(super) fn store_levels(
    steps: &[[f32; 16]; 4],
    texture: Option<&Texture>,
    has_steps: bool,
    levels: &mut [f32],
) {
    for (lane, level) in levels.iter_mut().enumerate() {
        let steps = steps_of(steps, lane);
        *level = match texture {
            _ if !has_steps => NO_LEVEL,
            Some(texture) => texture.level(steps),
            None => level_of(LEVELS_OF, [1.0; 2], steps),
        };
    }
}

/// Stores the texture coordinates of some samples, at most sixteen.
#[inline(never)]
pub(super) fn store_coordinates(
    chunk: &Chunk,
    at: usize,
    has_texture: bool,
    coordinates: &mut [Vec2],
) {
    let [across, up] = &chunk.coordinate;
    for (lane, coordinate) in coordinates.iter_mut().enumerate() {
        let at = at + lane;
        *coordinate =
            if has_texture { DVec2::new(across[at], up[at]).as_vec2() } else { Vec2::ZERO };
    }
}

/// How the texture coordinate moves from a sample to the next one across, and to the next one down.
fn steps_of(steps: &[[f32; 16]; 4], lane: usize) -> [Vec2; 2] {
    let [across, across_up, down, down_up] = steps;
    [Vec2::new(across[lane], across_up[lane]), Vec2::new(down[lane], down_up[lane])]
}
