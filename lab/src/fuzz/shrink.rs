//! Makes a disagreement small: the fewest primitives, the smallest picture, the simplest numbers.
//!
//! Each step tries a simpler case and keeps it if two renderers still disagree in it. So a step may be anything that might
//! work; nothing has to be proved of it. The idea of removing ever smaller parts is that of Zeller and Hildebrandt,
//! "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions on Software Engineering, 2002.

mod numbers;
mod picture;
mod primitives;

use super::case::Case;
use super::check::{Disagreement, check};
use super::dice::Dice;
use super::renderers::Renderers;

/// The cost of all tries of one finding: each costs 1, and 1 more for this many samples and primitives that are drawn.
const MOST_COST: u64 = 30_000;
const COST_OF_ONE: u64 = 1 << 12;

/// A case made small.
#[derive(Debug)]
pub(super) struct Shrunk {
    pub(super) case: Case,
    pub(super) disagreement: Disagreement,
    /// The cases that were tried.
    pub(super) steps: u64,
}

/// Shrinks a case in which two renderers disagree, until no step helps any more, or it took very many tries, or it is
/// asked to stop. It takes the same steps every time.
pub(super) fn shrink(
    case: Case,
    disagreement: Disagreement,
    renderers: &Renderers,
    is_stopped: &dyn Fn() -> bool,
) -> Shrunk {
    let mut shrinker = Shrinker { case, disagreement, renderers, is_stopped, steps: 0, cost: 0 };
    picture::crop(&mut shrinker);
    loop {
        let before = shrinker.case.clone();
        primitives::shrink(&mut shrinker);
        picture::shrink(&mut shrinker);
        numbers::shrink(&mut shrinker);
        if shrinker.case == before {
            break;
        }
    }
    let Shrinker { case, disagreement, steps, .. } = shrinker;
    Shrunk { case, disagreement, steps }
}

/// The smallest case so far.
struct Shrinker<'a> {
    case: Case,
    disagreement: Disagreement,
    renderers: &'a Renderers,
    is_stopped: &'a dyn Fn() -> bool,
    steps: u64,
    cost: u64,
}

impl Shrinker<'_> {
    /// Takes a simpler case in place of the present one if renderers disagree in it in the same way. Tells whether it
    /// did.
    fn try_case(&mut self, candidate: Case) -> bool {
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
    fn try_change(&mut self, change: impl FnOnce(&Case) -> Option<Case>) -> bool {
        let candidate = change(&self.case);
        candidate.is_some_and(|candidate| self.try_case(candidate))
    }
}
