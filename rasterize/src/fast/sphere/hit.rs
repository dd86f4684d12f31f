//! What rounded arithmetic says of a sphere and a ray.

use bothways_common::engine::roundoff::Interval;

/// What rounded arithmetic says of a sphere at a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) enum SphereHit {
    /// The sphere certainly covers the sample, at a depth in this interval.
    At(Interval),
    /// The sphere certainly does not cover the sample.
    Miss,
    /// The judge must say.
    Unknown,
}
