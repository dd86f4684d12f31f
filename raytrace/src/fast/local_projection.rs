//! Projects the vertices of a leaf in `f32`: one of them in `f64`, and the others, which lie near it, by their offsets
//! from it. So digits that the eye's distance takes are not missed.

use super::search::tile_frustum::TileFrustum;
use super::search::tree::LEAF;
use super::world_affine::WorldAffine;
use bothways_common::engine::simd::{Simd, SimdBase, SimdNarrow, f32x16, f64x4};

/// The map of [`super::camera_map`] about a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct LocalProjection {
    pub(super) vertex: [f32; 3],
    /// `t`, columns and rows times `t`, at points relative to the vertex.
    pub(super) map: [WorldAffine; 3],
    /// How far a row or column may be off.
    pub(super) error: f32,
    /// How far a key may be off, as a part of it, and by the roundings of two sums. Without meaning where no keys are found.
    pub(super) key_error: f32,
    /// An upper estimate of how many rows or columns apart vertices are, or 0 where nothing asks for it.
    pub(super) extent: f32,
}

impl LocalProjection {
    /// For a leaf of which no vertex is farther from this one along any axis than `size`, nor has a `t` less than
    /// `near`, as computed with [`super::search::box_culling`].
    #[inline(always)]
    pub(super) fn new<S: Simd>(
        simd: S,
        frustum: &TileFrustum,
        vertex: [f32; 3],
        size: f32,
        near: f32,
    ) -> LocalProjection {
        let template = frustum.template;
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(vertex[axis]) - template.eye[axis]);
        let [of_x, of_y, of_z, shift] =
            frustum.by_axis.each_ref().map(|column| f64x4::load_array_ref(simd, column));
        let at_vertex = of_x * x + of_y * y + of_z * z + shift;
        let [t, column, row, ..] = at_vertex.narrow(at_vertex).to_array();
        let near = if template.parallel { 1.0 } else { template.boxes.nearest(near) };
        let by_near = reciprocal(near);
        let [of_t, across, down] = frustum.normals;
        LocalProjection {
            vertex,
            map: [
                WorldAffine { normal: of_t, offset: t },
                WorldAffine { normal: across, offset: column },
                WorldAffine { normal: down, offset: row },
            ],
            error: template.local.of(size, [row, column], by_near),
            key_error: template.local.of_key(size, by_near),
            extent: template.local.extent(size, by_near),
        }
    }

    /// Whether rows and columns are known to far less than one; not so near the eye.
    #[inline(always)]
    pub(super) fn is_useful(&self) -> bool {
        (0.0..1.0 / 16.0).contains(&self.error)
    }

    /// The rows and the columns where vertices are seen, counted from the tile's first; and their keys, `1/t`. For a parallel camera,
    /// these are not found.
    #[inline(always)]
    pub(super) fn project<S: Simd>(
        &self,
        simd: S,
        frustum: &TileFrustum,
        [x, y, z]: [&[f32; LEAF]; 3],
    ) -> [f32x16<S>; 3] {
        let from_vertex = [
            f32x16::load_array_ref(simd, x) - self.vertex[0],
            f32x16::load_array_ref(simd, y) - self.vertex[1],
            f32x16::load_array_ref(simd, z) - self.vertex[2],
        ];
        let [t, across, down] = &self.map;
        let (across, down) = (across.at(from_vertex), down.at(from_vertex));
        let half = -frustum.centered(0);
        if frustum.template.parallel {
            [down + half, across + half, f32x16::splat(simd, f32::NAN)]
        } else {
            let by_t = f32x16::splat(simd, 1.0) / t.at(from_vertex);
            [down * by_t + half, across * by_t + half, by_t]
        }
    }
}

/// The reciprocal of a `t`; infinite if that is not positive.
#[inline(always)]
pub(super) fn reciprocal(t: f32) -> f32 {
    // NaN is not positive.
    1.0 / if t > 0.0 { t } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_known_of_what_may_lie_behind_the_eye() {
        assert_eq!(reciprocal(4.0), 0.25);
        for behind in [0.0, -0.0, -1e-30, -4.0, f32::NEG_INFINITY, f32::NAN] {
            assert_eq!(reciprocal(behind), f32::INFINITY, "{behind}");
        }
    }
}
