//! Functions on the viewport along a [`Stretch`] of samples: counted from its first sample, `f32` is enough for them.

use super::quotient::{Affine, Quotient};
use bothways_common::engine::simd::{Simd, SimdBase, f32x16};
use bothways_common::look::bands::Stretch;
use bothways_common::look::lanes::{Vec3x16, each};
use bothways_common::look::texture::TextureDifferences;
use glam::{DVec3, Vec3};

/// A vector whose coordinates are affine functions, of which only the direction counts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct VectorAlong {
    at_first: Vec3,
    /// From a sample to the next one.
    change: Vec3,
}

impl VectorAlong {
    /// `None` where it may change by more than half of its length, and where it is extremely long or short.
    ///
    /// So it is nowhere shorter than half of what it is at the first sample, `A`. With `ε = 2⁻²⁴`, rounding `A` and the sum adds
    /// `2ε|A|`, the change and its product `2ε` of at most `½|A|`, and a sum may be `1½|A|` long: all in all less than
    /// `4ε|A|`, which is `8ε` of the vector.
    #[inline(always)]
    pub(super) fn new(coordinates: &[Affine; 3], stretch: &Stretch, across: f64) -> Option<Self> {
        let [x, y, z] = each!(k in [0, 1, 2] => coordinates[k].at(stretch.x, stretch.y));
        let at_first = DVec3 { x, y, z };
        let [x, y, z] = each!(k in [0, 1, 2] => coordinates[k].across * across);
        let change = DVec3 { x, y, z };
        let (length, steps) = (at_first.abs().max_element(), change.abs());
        let is_steady = (steps.x + steps.y + steps.z) * (2.0 * Stretch::LAST) <= length;
        (is_steady && Stretch::LENGTHS.contains(&length))
            .then(|| VectorAlong { at_first: at_first.as_vec3(), change: change.as_vec3() })
    }

    /// The vector at some samples.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, numbers: f32x16<S>) -> Vec3x16<S> {
        Vec3x16::splat(simd, self.at_first) + Vec3x16::splat(simd, self.change) * numbers
    }
}

/// Two [quotients](Quotient) with one denominator.
///
/// With `k` steps across, `n/d` becomes `(n + k·n')/(d + k·d')`, which is farther by `k·s/(1 + k·r)`, where `s = (n' − d'·n/d)/d` is how
/// fast it changes at the first sample, and `r = d'/d`. There it changes by `s/(1 + k·r)²`. Down, it changes by
/// `(v + k·b)/(1 + k·r)²`: by `v = (n° − d°·n/d)/d` at the first sample, with `n°` and `d°` from a row to the next, and
/// `b = (n°·d' − d°·n')/d²`.
#[derive(Clone, Copy, Debug)]
pub(super) struct QuotientAlong {
    /// `r`.
    turn: f32,
    /// `n/d`.
    at_first: [f64; 2],
    /// `s`.
    across: [f32; 2],
    /// `v`.
    down: [f32; 2],
    /// `b`.
    bend: [f32; 2],
}

impl QuotientAlong {
    /// `None` where the denominator may change by more than half of itself along the stretch, or by more than an eighth of itself from a row
    /// to the next.
    ///
    /// # The error, rounding by rounding
    ///
    /// So `1 + k·r` is between ½ and 1½. With `ε = 2⁻²⁴` it is off by `2ε` of at most ½ and by its own rounding, in all by less than `5ε` of
    /// itself, and its reciprocal by `6ε`. Three more roundings make a difference, `δ = k·s/(1 + k·r)`, off by `9ε` of itself. As the
    /// footprint across is at least `f = s/(1 + k·r)²`, and `k` at most 63, `δ` is at most `95f`: what a pattern makes of it
    /// ([`fraction_by_differences`]) is off by less than `14ε · 95f`, and by twice that of the footprint, `1.6·10⁻⁴`, where the sample
    /// meets a border.
    ///
    /// As `b = r·v − s·d°/d`, the footprint down is `|v·(1 + k·r) − k·s·d°/d|` over `(1 + k·r)²`. Its terms are off by `3ε` of
    /// `1½|v| + 8|s|`, by the second condition; where `|v|` is above `32|s|`, it is more than a quarter of `|v|`, and elsewhere both
    /// footprints together are at least `|s|`. So their sum is off by less than `170ε` of itself, and `14ε` for the square and the
    /// product: 1.1·10⁻⁵.
    ///
    /// [`fraction_by_differences`]: bothways_common::scene::material::Checker::fraction_by_differences
    #[inline(always)]
    pub(super) fn new(
        quotient: &Quotient,
        stretch: &Stretch,
        [down, across]: [f64; 2],
    ) -> Option<Self> {
        let Quotient { numerators, denominator } = quotient;
        let below = 1.0 / denominator.at(stretch.x, stretch.y);
        let [turn, fall] = [denominator.across * across * below, denominator.up * down * below];
        if !(turn.abs() <= 0.5 / Stretch::LAST && fall.abs() <= 0.125) {
            return None;
        }
        let of_both = each!(k in [0, 1] => {
            let Affine { across: along_x, up: along_y, .. } = numerators[k];
            let value = numerators[k].at(stretch.x, stretch.y) * below;
            let of_row = along_x * (across * below) - value * turn;
            let of_column = along_y * (down * below) - value * fall;
            (value, of_row, of_column)
        });
        #[expect(clippy::cast_possible_truncation, reason = "see above")]
        let number = |number: f64| number as f32;
        Some(QuotientAlong {
            turn: number(turn),
            at_first: each!(k in [0, 1] => of_both[k].0),
            across: each!(k in [0, 1] => number(of_both[k].1)),
            down: each!(k in [0, 1] => number(of_both[k].2)),
            bend: each!(k in [0, 1] => number(turn * of_both[k].2 - fall * of_both[k].1)),
        })
    }

    /// The values at some samples, and how far each changes by a step down or across, added up.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, numbers: f32x16<S>) -> TextureDifferences<S> {
        let splat = |number: f32| f32x16::splat(simd, number);
        let nearer = splat(1.0) / (numbers * splat(self.turn) + splat(1.0));
        let (along, square) = (numbers * nearer, nearer * nearer);
        TextureDifferences {
            from: self.at_first,
            differences: each!(k in [0, 1] => along * splat(self.across[k])),
            footprint: each!(k in [0, 1] => {
                let down = (splat(self.down[k]) + numbers * splat(self.bend[k])).abs();
                (splat(self.across[k].abs()) + down) * square
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::engine::simd::{Level, dispatch, levels};
    use bothways_test_support::Dice;
    use glam::DVec2;

    /// An affine function of this size, which changes by about as much, a tenth or a thousandth of it on the viewport.
    fn affine(dice: &mut Dice, size: f64) -> Affine {
        let change = size * dice.power([-3.0, 0.0]);
        let [at_center, across, up] = dice.vector().to_array();
        Affine { at_center: size * at_center, across: change * across, up: change * up }
    }

    /// What sixteen samples get, the same at every level of SIMD.
    fn at_all_levels<const N: usize>(of: impl Fn(Level) -> [[f32; 16]; N]) -> [[f32; 16]; N] {
        let all: Vec<_> = levels().into_iter().map(of).collect();
        assert!(all.iter().all(|one| *one == all[0]));
        all[0]
    }

    fn numbers<S: Simd>(simd: S, first: u8) -> f32x16<S> {
        f32x16::from_fn(simd, |lane| f32::from(first) + lane as f32)
    }

    #[test]
    fn quotients_along_a_stretch_are_within_their_bounds() {
        const EPSILON: f64 = 1.0 / (1 << 24) as f64;
        let mut dice = Dice(5);
        let (mut found, mut missing, mut worst) = (0, 0, [0.0_f64; 2]);
        for case in 0..40_000 {
            let size = dice.power([-3.0, 3.0]);
            let quotient = Quotient {
                numerators: [size, 2.0 * size].map(|size| affine(&mut dice, size)),
                denominator: affine(&mut dice, 1.0),
            };
            let place = dice.vector();
            let (stretch, pixel) = (Stretch { x: place.x, y: place.y }, dice.power([-5.0, -1.0]));
            let step = [-pixel, pixel];
            let Some(along) = QuotientAlong::new(&quotient, &stretch, step) else {
                missing += 1;
                continue;
            };
            found += 1;
            let first = [0, 17, 48][case % 3];
            let [across, up, width, height] = at_all_levels(|level| {
                dispatch!(level, simd => {
                    let TextureDifferences { differences, footprint, .. } =
                        along.at(simd, numbers(simd, first));
                    let [[across, up], [width, height]] = [differences, footprint];
                    [across, up, width, height].map(SimdBase::to_array)
                })
            });
            for lane in 0..16 {
                let x = stretch.x + pixel * (f64::from(first) + lane as f64);
                let below = quotient.denominator.at(x, stretch.y);
                let value = quotient.numerators.map(|above| above.at(x, stretch.y) / below);
                let [along_x, along_y] =
                    quotient.changes(x, stretch.y).map(|way| way.abs() * pixel);
                let footprint: DVec2 = along_x + along_y;
                for k in 0..2 {
                    let difference = f64::from([across, up][k][lane]);
                    let off = (along.at_first[k] + difference - value[k]).abs() / footprint[k];
                    // What `f64` rounds in places that are large beside their footprint is no part of the bound.
                    let of_places = 1e-15 * value[k].abs() / footprint[k];
                    let of_footprint = f64::from([width, height][k][lane]) / footprint[k] - 1.0;
                    worst = [worst[0].max(off - of_places), worst[1].max(of_footprint.abs())];
                }
            }
        }
        println!("{found} found, {missing} missing, off by {worst:?} at most");
        assert!(found > 10_000 && missing > 1_000, "{found}, {missing}");
        assert!(worst[0] < 9.0 * 95.0 * EPSILON && worst[1] < 184.0 * EPSILON, "{worst:?}");
    }

    #[test]
    fn vectors_along_a_stretch_are_within_their_bound() {
        let mut dice = Dice(6);
        let (mut found, mut missing, mut worst) = (0, 0, 0.0_f64);
        for case in 0..40_000 {
            let size = dice.power([-20.0, 20.0]);
            let coordinates = [(); 3].map(|()| affine(&mut dice, size));
            let (stretch, pixel) = (Stretch { x: 0.4, y: -0.3 }, dice.power([-4.0, 0.0]));
            let Some(along) = VectorAlong::new(&coordinates, &stretch, pixel) else {
                missing += 1;
                continue;
            };
            found += 1;
            let first = [0, 17, 48][case % 3];
            let [x, y, z] = at_all_levels(|level| {
                dispatch!(level, simd => {
                    let vectors = along.at(simd, numbers(simd, first));
                    [vectors.x, vectors.y, vectors.z].map(SimdBase::to_array)
                })
            });
            for lane in 0..16 {
                let place = stretch.x + pixel * (f64::from(first) + lane as f64);
                let expected = DVec3::from(coordinates.map(|at| at.at(place, stretch.y)));
                let vector = Vec3::new(x[lane], y[lane], z[lane]).as_dvec3();
                worst = worst.max(vector.distance(expected) / expected.length());
            }
        }
        println!("{found} found, {missing} missing, off by {worst:e} at most");
        assert!(found > 10_000 && missing > 5_000, "{found}, {missing}");
        assert!(worst < 8.0 / f64::from(1 << 24), "{worst:e}");
    }
}
