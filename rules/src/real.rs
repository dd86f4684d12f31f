//! The arithmetic of a rule: 32 or 64 bits, and vectors of them.

use glam::{DVec3, Vec3};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `f32` or `f64`: a rule rounds after each operation, as its system does.
pub(crate) trait Real:
    Copy
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    const ZERO: Self;

    /// The nearest number of this kind.
    fn of(value: f64) -> Self;
    /// The same number, exactly.
    fn double(self) -> f64;
    fn sqrt(self) -> Self;
}

impl Real for f32 {
    const ZERO: f32 = 0.0;

    #[expect(clippy::cast_possible_truncation, reason = "the rule is to round to f32")]
    fn of(value: f64) -> f32 {
        value as f32
    }

    fn double(self) -> f64 {
        f64::from(self)
    }

    fn sqrt(self) -> f32 {
        self.sqrt()
    }
}

impl Real for f64 {
    const ZERO: f64 = 0.0;

    fn of(value: f64) -> f64 {
        value
    }

    fn double(self) -> f64 {
        self
    }

    fn sqrt(self) -> f64 {
        self.sqrt()
    }
}

/// A vector in the arithmetic of a rule.
pub(crate) type Vector<R> = [R; 3];

/// The vector, each component rounded.
pub(crate) fn vector<R: Real>(value: DVec3) -> Vector<R> {
    value.to_array().map(R::of)
}

/// A position of the world, exactly.
pub(crate) fn position<R: Real>(value: Vec3) -> Vector<R> {
    vector(value.as_dvec3())
}

pub(crate) fn minus<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn plus<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn scaled<R: Real>(factor: R, a: Vector<R>) -> Vector<R> {
    a.map(|component| factor * component)
}

pub(crate) fn dot<R: Real>(a: Vector<R>, b: Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
