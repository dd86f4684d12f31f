//! Normals of triangles and ways to lights, for the tests of both shaders.

use crate::Dice;
use bothways_common::Sample;
use bothways_common::engine::simd::{SimdBase, dispatch, levels};
use bothways_common::glam::{DVec3, Vec3};
use bothways_common::look::bands::{LocalLook, vector_at};
use bothways_common::look::lanes::Lanes;

/// Checks that the vectors of a row have the bits of each sample's own, at every level of SIMD.
pub fn assert_vectors_of_a_row(look: &impl LocalLook, at: impl Fn(Sample) -> Vec3) {
    for level in levels() {
        for column in [990, 998, 1006] {
            let first = Sample { row: 5, column };
            let normals: [[f32; 8]; 3] = dispatch!(level, simd => {
                let Lanes { x, y, z } = vector_at(simd, look.normals(), look.factors(simd, first));
                [x, y, z].map(SimdBase::to_array)
            });
            for lane in 0..8 {
                let expected = at(Sample { column: column + lane, ..first });
                assert_eq!(Vec3::from(normals.map(|lanes| lanes[lane])), expected);
            }
        }
    }
}

/// Unit normals for the corners of a triangle, farther apart the larger `change` is.
pub fn normals_at_corners(dice: &mut Dice, change: f64) -> [DVec3; 3] {
    let normal = dice.vector();
    [0; 3].map(|_: u8| (normal + change * dice.vector()).normalize_or_zero())
}

/// Points of light for a triangle with these corners: one near it, and one anywhere.
pub fn lights_of_a_triangle(dice: &mut Dice, [a, b, c]: [DVec3; 3]) -> [DVec3; 2] {
    let size = (b - a).length() + (c - a).length();
    [size * dice.power([-0.5, 2.0]), dice.power([-3.0, 9.0])].map(|far| a + far * dice.vector())
}
