//! `jittered:SEED`: each sample is moved randomly within its pixel, or its part of a pixel with several samples. The
//! place depends on seed, row and column alone, so every run and any number of threads give the same picture. All else
//! is right, in `f64`.
//!
//! Cook, "Stochastic Sampling in Computer Graphics", ACM Transactions on Graphics, 1986.

use crate::samples::{SamplePoint, Samples};

pub(super) fn samples<'a>(at: impl Fn(SamplePoint) -> Samples<'a>, seed: u64) -> Samples<'a> {
    at(SamplePoint::Jittered(seed))
}
