//! What is seen where triangles are small, run by run.

use super::chunk::{Vectors, store_eight};
use super::desk::{Kept, KeptLook};
use super::local::{LocalLook, LocalVector, vector_at};
use super::runs::{Groups, Run, is_same, samples_of};
use super::tint::KeptTexture;
use crate::engine::simd::{Simd, apart};
use crate::raster::Sample;
use crate::scene::material::Material;

/// What is seen in runs of a chunk, from the one with this number on, up to the first whose primitive has no local look: fills normals
/// and ways to lights, and finds which samples are lit together. Returns the number of that run.
///
/// Small triangles have a run for every two or three samples. So this is a function of its own, though only one place calls it: what its
/// loop needs is at hand then.
#[inline(never)]
pub(super) fn find_local<'a, S: Simd, L: LocalLook>(
    simd: S,
    here: (Sample, &[Run], usize),
    seen: (&[Kept<'a, L>], &[LocalVector]),
    to: (&mut Vectors, &mut [Vectors]),
    groups: &mut Groups<'a>,
    texture: &mut KeptTexture,
) -> usize {
    apart!(simd, find_in_runs(simd, here, seen, to, groups, texture))
}

#[inline(always)]
fn find_in_runs<'a, S: Simd, L: LocalLook>(
    simd: S,
    (start, runs, mut number): (Sample, &[Run], usize),
    (kept, ways): (&[Kept<'a, L>], &[LocalVector]),
    (normals, to_lights): (&mut Vectors, &mut [Vectors]),
    groups: &mut Groups<'a>,
    texture: &mut KeptTexture,
) -> usize {
    let first = samples_of(runs, number).start;
    // What is seen just before `begin`: these samples are added together, as soon as another material begins.
    let (mut begin, mut material) = (first, None);
    let mut add = |end: usize, material: Option<&'a Material>| {
        if first < end {
            groups.add(end, material.map(|material| (material, false)));
        }
    };
    for run in &runs[number..] {
        let end = run.end();
        let here = match run.place().map(|place| &kept[place]) {
            None => {
                texture.fill_nothing(begin..end);
                None
            }
            // There are such ones only where a frame keeps nothing of textures.
            Some(Kept { material, look: KeptLook::Local { look, ways: first_way } }) => {
                // What is written beyond the run is overwritten by the next one.
                let mut at = begin;
                while at < end {
                    let factors = look.factors(simd, Sample { column: start.column + at, ..start });
                    store_eight(vector_at(simd, look.normals(), factors), normals, at);
                    for (light, to_light) in to_lights.iter_mut().enumerate() {
                        let way = &ways[*first_way as usize + light];
                        store_eight(vector_at(simd, way, factors), to_light, at);
                    }
                    at += 8;
                }
                Some(*material)
            }
            Some(Kept { look: KeptLook::Surface(_), .. }) => break,
        };
        if !is_same(material, here) {
            add(begin, material);
            material = here;
        }
        (number, begin) = (number + 1, end);
    }
    add(begin, material);
    number
}
