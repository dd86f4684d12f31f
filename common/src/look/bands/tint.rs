//! The tint of samples: what textures leave of the material's colour.

use super::desk::Chunk;
use crate::scene::material::Material;
use glam::{DVec2, Vec3};
use std::ops::Range;

/// Fills the tint of some samples of one primitive, whose texture coordinates are in the chunk if it has some.
///
/// One sample after the other, compiled once for all levels of SIMD: texels are fetched one by one in any case.
#[inline(never)]
pub(super) fn fill(
    chunk: &mut Chunk,
    samples: Range<usize>,
    material: &Material,
    has_texture: bool,
) {
    for at in samples {
        let mut tint = Vec3::ONE;
        if let Some(texture) = material.texture.as_ref().filter(|_| has_texture) {
            let [across, up] = &chunk.coordinate;
            tint = texture.color(DVec2::new(across[at], up[at]), 0.0);
        }
        for (k, to) in chunk.tint.iter_mut().enumerate() {
            to[at] = tint[k];
        }
    }
}
