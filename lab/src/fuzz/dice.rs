//! Random choices, the same for the same seed and scene.
//!
//! The numbers come from the crate `fastrand`: it is small, well kept, already needed by `tempfile`, and changes its
//! sequences only with a major version, so that a seed means the same scenes on every machine.

use fastrand::Rng;
use std::ops::RangeInclusive;

/// The random choices for one scene.
#[derive(Clone, Debug)]
pub(super) struct Dice(Rng);

impl Dice {
    /// The choices for scene number `scene` of a seed. They do not depend on other scenes.
    pub(super) fn new(seed: u64, scene: u64) -> Dice {
        // The generator mixes neighbouring states thoroughly; the key keeps the seeds apart.
        let key = Rng::with_seed(seed).u64(..);
        Dice(Rng::with_seed(key ^ scene))
    }

    /// A whole number from 0, smaller than `count`, which must not be 0.
    pub(super) fn below(&mut self, count: usize) -> usize {
        self.0.usize(0..count)
    }

    /// A whole number of a range.
    pub(super) fn within(&mut self, range: RangeInclusive<i32>) -> i32 {
        self.0.i32(range)
    }

    /// A number of pixels of a range, the small ones as likely as the large ones: its logarithm is uniform.
    pub(super) fn size(&mut self, range: RangeInclusive<u32>) -> u32 {
        let [least, most] = [*range.start(), *range.end()].map(f64::from);
        let size = least * (most / least).powf(self.0.f64());
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in the range")]
        let size = size.round() as u32;
        size.clamp(*range.start(), *range.end())
    }

    /// True once in `times`, on average.
    pub(super) fn once_in(&mut self, times: u32) -> bool {
        self.0.u32(0..times) == 0
    }

    /// A number from `low`, smaller than `high`.
    pub(super) fn real(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// The same in single precision.
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked")]
    pub(super) fn single(&mut self, low: f64, high: f64) -> f32 {
        self.real(low, high) as f32
    }

    /// Any 32 bits.
    pub(super) fn bits(&mut self) -> u32 {
        self.0.u32(..)
    }

    /// One of several things, equally likely.
    pub(super) fn one_of<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.below(things.len())]
    }

    /// One of several things, each with its weight.
    pub(super) fn weighted<T: Copy>(&mut self, things: &[(u32, T)]) -> T {
        let total = things.iter().map(|(weight, _)| weight).sum();
        let mut left = self.0.u32(0..total);
        for (weight, thing) in things {
            if left < *weight {
                return *thing;
            }
            left -= weight;
        }
        unreachable!("a number below the total meets one of the weights")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_means_the_same_numbers_for_ever() {
        let numbers = |seed, scene| {
            let mut dice = Dice::new(seed, scene);
            [dice.bits(), dice.bits()]
        };
        assert_eq!(numbers(7, 0), PINNED);
        assert_ne!(numbers(7, 1), numbers(7, 0));
        assert_ne!(numbers(8, 0), numbers(7, 0));
    }

    const PINNED: [u32; 2] = [68_384_918, 1_027_810_507];

    #[test]
    fn weights_are_shares() {
        let mut dice = Dice::new(1, 1);
        let often = (0..1000).filter(|_| dice.weighted(&[(9, true), (1, false)])).count();
        assert!((850..950).contains(&often), "{often}");
    }

    #[test]
    fn sizes_keep_to_their_range() {
        let mut dice = Dice::new(1, 2);
        let sizes: Vec<u32> = (0..1000).map(|_| dice.size(1..=1000)).collect();
        assert!(sizes.contains(&1) && sizes.iter().all(|size| (1..=1000).contains(size)));
        let small = sizes.iter().filter(|size| **size < 32).count();
        assert!((400..600).contains(&small), "{small} of 1000 are small");
    }
}
