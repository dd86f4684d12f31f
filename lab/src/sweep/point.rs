//! One point of a curve.

use super::table::Source;

/// One point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The place on the axis.
    pub x: f64,
    /// The steps; or the least time of all rounds, in milliseconds.
    pub value: f64,
    /// The least and the greatest of the rounds.
    pub least: f64,
    /// The greatest of the rounds.
    pub most: f64,
    /// How the value is known.
    pub source: Source,
}
