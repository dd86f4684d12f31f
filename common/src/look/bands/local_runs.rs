//! What is seen where triangles are small, run by run.

use super::chunk::{Vectors, store_vectors};
use super::desk::{Kept, KeptLook};
use super::local::{LocalLook, LocalVector, vector_at};
use super::runs::{Groups, Run, is_same, samples_of};
use super::tint::KeptTexture;
use crate::engine::simd::{Simd, apart};
use crate::raster::Sample;
use crate::scene::material::Material;

/// What is seen in runs of a chunk, from the one with this number on, up to the first whose primitive has no local look: fills normals
/// and ways to lights, and finds which samples are lit together. Returns the number of that run. `here` is the first sample of the chunk, its
/// runs, and the number of the first of them to look at.
///
/// Small triangles have a run for every two or three samples. So this is a function of its own, though only one place calls it: as a
/// part of a larger one, its loop has no registers left, and loads again for each run what it had before.
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
        // Before the first run, there is nothing to add.
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
                    store_vectors(&vector_at(simd, look.normals(), factors), normals, at);
                    for (light, to_light) in to_lights.iter_mut().enumerate() {
                        let way = &ways[*first_way as usize + light];
                        store_vectors(&vector_at(simd, way, factors), to_light, at);
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

#[cfg(test)]
mod tests {
    use super::super::chunk::{CHUNK, WIDE};
    use super::super::runs::NOTHING;
    use super::*;
    use crate::engine::simd::{SimdBase, dispatch, f32x8, levels};
    use crate::frame::NO_LEVEL;
    use glam::Vec2;

    /// A triangle whose vectors are sums by row and by column.
    #[derive(Clone, Copy)]
    struct ByPlace(LocalVector);

    impl LocalLook for ByPlace {
        fn normals(&self) -> &LocalVector {
            &self.0
        }

        fn factors<S: Simd>(&self, simd: S, first: Sample) -> [f32x8<S>; 2] {
            let columns = f32x8::from_fn(simd, |lane| (first.column + lane) as f32);
            [f32x8::splat(simd, first.row as f32), columns]
        }
    }

    fn vector(number: f32) -> LocalVector {
        [[number, 0.0, 1.0], [10.0, -1.0, 0.0], [0.0, number, 0.5]]
    }

    fn at(number: f32, row: usize, column: usize) -> [f32; 3] {
        let (row, column) = (row as f32, column as f32);
        [number + 10.0 * row, number * column - row, 1.0 + 0.5 * column]
    }

    #[test]
    fn runs_are_found_up_to_the_next_surface() {
        let [one, other] = [Material::default(), Material::default()];
        let look = |number: f32, ways| KeptLook::Local { look: ByPlace(vector(number)), ways };
        let kept = [
            Kept { material: &one, look: look(2.0, 0) },
            Kept { material: &one, look: look(3.0, 1) },
            Kept { material: &other, look: look(4.0, 2) },
            Kept { material: &other, look: KeptLook::Surface(0) },
        ];
        let ways = [5.0, 6.0, 7.0].map(vector);
        // Nothing; two triangles of one material, the second over three times eight samples; one of another; a surface; both ends.
        let seen = [(3, None), (5, Some(0)), (25, Some(1)), (26, Some(2)), (30, Some(3))];
        let seen = seen.into_iter().chain([(31, Some(0)), (32, None), (CHUNK, Some(2))]);
        let runs: Vec<Run> = seen
            .map(|(end, place)| Run::new(u32::try_from(end).unwrap(), place.unwrap_or(NOTHING)))
            .collect();
        let start = Sample { row: 7, column: 1000 };
        for level in levels() {
            let (mut normals, mut to_lights) = ([[0.0; WIDE]; 3], [[[0.0; WIDE]; 3]]);
            let (mut groups, mut levels) = (Groups::default(), [9.0; CHUNK]);
            let mut coordinates = [Vec2::ONE; CHUNK];
            let mut texture =
                KeptTexture { coordinates: Some(&mut coordinates), levels: Some(&mut levels) };
            // The second time, on from behind the surface.
            for (first, next) in [(0, 4), (5, runs.len())] {
                let (here, seen) = ((start, &runs[..], first), (&kept[..], &ways[..]));
                let to = (&mut normals, &mut to_lights[..]);
                let found = dispatch!(level, simd => find_local(simd, here, seen, to, &mut groups, &mut texture));
                assert_eq!(found, next, "{level:?}");
            }

            let expected = [
                (3..5, [2.0, 5.0]),
                (5..25, [3.0, 6.0]),
                (25..26, [4.0, 7.0]),
                (30..31, [2.0, 5.0]),
                (32..CHUNK, [4.0, 7.0]),
            ];
            for (samples, numbers) in expected {
                for k in samples {
                    let found = [&normals, &to_lights[0]].map(|of| of.map(|axis| axis[k]));
                    let expected = numbers.map(|number| at(number, 7, 1000 + k));
                    assert_eq!(found, expected, "{level:?}: {k}");
                }
            }
            let ends: Vec<_> = groups.all().iter().map(|group| group.end).collect();
            assert_eq!(ends, [3, 25, 26, 31, 32, CHUNK], "{level:?}");
            let shown = [None, Some(&one), Some(&other), Some(&one), None, Some(&other)];
            for (group, shown) in groups.all().iter().zip(shown) {
                assert!(group.shows(shown.map(|material| (material, false))), "{}", group.end);
            }
            for k in 0..CHUNK {
                let is_nothing = k < 3 || k == 31;
                assert_eq!(levels[k] == NO_LEVEL, is_nothing, "{k}");
                assert_eq!(coordinates[k] == Vec2::ZERO, is_nothing, "{k}");
            }
        }
    }
}
