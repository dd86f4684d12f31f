//! What is true of one sample and one primitive, and of two primitives along one ray: exactly.
//!
//! Every answer is a statement about exact real numbers made from stored floating-point inputs, so
//! there is one right answer. Rounded arithmetic settles nearly every question; where its error
//! bound leaves a sign open, exact arithmetic is asked.

mod bounded;
mod cached_judge;
mod cover;
mod double;
mod dyadic;
mod evaluate;
mod judge;
mod nearest;
mod real;
mod sign;

pub use cached_judge::CachedJudge;
pub use cover::{EdgeSigns, EdgeValues, Side};
pub use double::two_sum;
pub use judge::{Coverage, Judge, SampleTest};
pub use nearest::Comparison;
pub use sign::Sign;

#[cfg(test)]
mod tests;
