//! One try after the other to make a case simpler.

use crate::fuzz::case::Case;
use crate::fuzz::check::{Disagreement, check};
use crate::fuzz::dice::Dice;
use crate::fuzz::renderers::Renderers;

/// The cost of all tries of one finding: each costs 1, and 1 more for this many samples and primitives that are drawn.
const MOST_COST: u64 = 30_000;

const COST_OF_ONE: u64 = 1 << 12;

/// The smallest case so far.
pub(super) struct Shrinker<'a> {
    pub(super) case: Case,
    pub(super) disagreement: Disagreement,
    pub(super) renderers: &'a Renderers,
    pub(super) is_stopped: &'a dyn Fn() -> bool,
    pub(super) steps: u64,
    pub(super) cost: u64,
}

impl Shrinker<'_> {
    /// Takes a simpler case in place of the present one if renderers disagree in it in the same way. Tells whether it
    /// did.
    pub(super) fn try_case(&mut self, candidate: Case) -> bool {
        if candidate == self.case || self.cost >= MOST_COST || (self.is_stopped)() {
            return false;
        }
        let pixels = candidate.pixels();
        let samples = u64::from(pixels.height) * u64::from(pixels.width);
        let samples = samples * u64::from(candidate.samples).pow(2);
        self.steps += 1;
        self.cost += 1 + (samples + candidate.primitives()) / COST_OF_ONE;
        let pixel = self.disagreement.pixel();
        let inside = |[i, j]: &[u32; 2]| {
            let rows = pixels.row..pixels.row + pixels.height;
            rows.contains(i) && (pixels.column..pixels.column + pixels.width).contains(j)
        };
        let mut dice = Dice::new(0, 0);
        let focus = pixel.filter(inside);
        let checked = check(&candidate, self.renderers, focus, &mut dice);
        match checked.and_then(|checked| checked.disagreement) {
            Some(found) if found.is_like(&self.disagreement) => {
                (self.case, self.disagreement) = (candidate, found);
                true
            }
            _ => false,
        }
    }

    /// Tries a change of the present case; `None` stands for one that does not apply.
    pub(super) fn try_change(&mut self, change: impl FnOnce(&Case) -> Option<Case>) -> bool {
        let candidate = change(&self.case);
        candidate.is_some_and(|candidate| self.try_case(candidate))
    }
}
