//! Makes a disagreement small: the fewest primitives, the smallest picture, the simplest numbers.
//!
//! Each step tries a simpler case and keeps it if two renderers still disagree in it. So a step may be anything that might
//! work; nothing has to be proved of it. The idea of removing ever smaller parts is that of Zeller and Hildebrandt,
//! "Simplifying and Isolating Failure-Inducing Input", IEEE Transactions on Software Engineering, 2002.

mod numbers;
mod picture;
mod primitives;
mod shrinker;

use super::case::Case;
use super::check::Disagreement;
use super::renderers::Renderers;
use shrinker::Shrinker;

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
