//! What a number must be able to do for a predicate to compute with it, and vectors of such numbers.

use super::sign::Sign;
use glam::DVec3;

/// More than all underflows of one operation and of its bound can lose.
pub(super) const UNDERFLOW: f64 = 8.0 * f64::MIN_POSITIVE;

/// A number that a predicate computes with.
pub(super) trait Real: Sized {
    /// A stored number, exactly.
    fn new(number: f64) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    /// The sign of the real number that is meant, if it is certain.
    fn sign(&self) -> Option<Sign>;
    fn square(&self) -> Self {
        self.times(self)
    }
}

/// A vector of stored numbers.
pub(super) fn vector<R: Real>(v: DVec3) -> [R; 3] {
    [R::new(v.x), R::new(v.y), R::new(v.z)]
}

/// `p − q` of stored points: the real difference, not the rounded one.
pub(super) fn difference<R: Real>(p: DVec3, q: DVec3) -> [R; 3] {
    let coordinate = |p: f64, q: f64| R::new(p).minus(&R::new(q));
    [coordinate(p.x, q.x), coordinate(p.y, q.y), coordinate(p.z, q.z)]
}

pub(super) fn dot<R: Real>(p: &[R; 3], q: &[R; 3]) -> R {
    p[0].times(&q[0]).plus(&p[1].times(&q[1])).plus(&p[2].times(&q[2]))
}

pub(super) fn cross<R: Real>(p: &[R; 3], q: &[R; 3]) -> [R; 3] {
    let minor = |k: usize, l: usize| p[k].times(&q[l]).minus(&p[l].times(&q[k]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}
