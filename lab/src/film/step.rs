//! One step of the loops, and how many of them are kept in little room.
//!
//! Small loops take many steps: every object of a teapot at every pixel of a small picture is millions. Nearly all of them go as
//! the one before went: the inner loop moves on by one, and the object does not affect the pixel. So what is kept is where a
//! [`Run`] of the inner loop begins, and what came of the steps that found something ([`Told`]).

use super::recorder::Line;

/// What came of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// The object does not affect the pixel.
    #[default]
    NotCovered = 0,
    /// It does, and is the first to do so.
    First = 1,
    /// It does, and is nearer than what was stored, which it replaces.
    Nearer = 2,
    /// It does, and lies behind what is stored.
    Behind = 3,
    /// The ray misses the box.
    Missed = 4,
    /// The ray enters the box.
    Entered = 5,
}

/// A step: a pair of a primitive and a pixel that is tested, or a pixel's ray and a box of the hierarchy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The primitive, or the box.
    pub tested: Tested,
    /// The row of the pixel.
    pub row: u32,
    /// The column of the pixel.
    pub column: u32,
    /// What came of it.
    pub outcome: Outcome,
    /// Where the ray meets the primitive, if the primitive covers the pixel.
    pub t: Option<f32>,
}

/// What a step tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tested {
    /// A primitive, by its id.
    Primitive(u32),
    /// A box of the hierarchy, by the number of its node.
    Node(u32),
}

/// Steps one after another in which the inner loop moves on by one: in object order, one primitive and pixel after pixel, row by
/// row; in image order, one pixel and primitive after primitive. The test of a box is a run of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// The number of its first step.
    pub first: u32,
    /// What that step tests.
    pub tested: Tested,
    /// The pixel of that step, counted row by row.
    pub pixel: u32,
}

/// What came of a step that found something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// The number of the step.
    pub step: u32,
    /// What came of it.
    pub outcome: Outcome,
    /// Where the ray meets the primitive, if the primitive covers the pixel.
    pub t: Option<f32>,
}

impl Step {
    /// The line of the code that is lit.
    pub fn line(&self) -> Line {
        match (self.tested, self.outcome) {
            (Tested::Node(_), _) => Line::Inner,
            (_, Outcome::First | Outcome::Nearer | Outcome::Behind) => Line::Keep,
            _ => Line::Test,
        }
    }
}
