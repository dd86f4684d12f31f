//! From `f64` to `f32`: a flat primitive on one tile, ready to be drawn sixteen samples at a time.

use super::flat::FlatFunctions;
use crate::fast::answer::Trust;
use crate::fast::many_samples::FlatSetup;
use crate::fast::search::tile_frustum::TileFrustum;
use crate::fast::viewport_affine::{TileAffine, TileViewport};
use crate::fast::world_affine::{narrowed, upward};
use bothways_common::engine::roundoff::EPS24;

/// What evaluating an affine function in `f32` is off by, as a fraction of [`TileAffine::most`].
///
/// The function at the middle is rounded by its conversion and in three sums (with what rows bring, with what
/// columns bring up to the middle of a block, with what both bring from there), what a row brings by its conversion, a
/// product and these three. Where blocks are dropped, and at the ends of keys, there is one sum more: at
/// most six of `ε₂₄`. The rest is for the factor of an edge function, roundings in `f64`, and numbers too small to be
/// normal.
const EVALUATION: f64 = 6.5 * EPS24 as f64;

/// A flat primitive on a tile; `None` if it certainly cannot be seen there, as it covers no sample, or only where its
/// key is less than `far`.
///
/// Each edge function is divided by the largest value that it may have in the tile: so one error suits all, and nothing
/// overflows.
pub(crate) fn narrow(
    functions: &FlatFunctions,
    frustum: &TileFrustum,
    trust: Trust,
    far: f32,
) -> Option<FlatSetup> {
    let tile = TileViewport::new(frustum);
    let (edges, key) = (functions.edges.map(|edge| edge.on(&tile)), functions.key.on(&tile));
    // False for NaN.
    let outside = edges.iter().any(|edge| edge.greatest(trust) < 0.0);
    let hidden = key.greatest(trust) < f64::from(far);
    let behind = frustum.template.parallel && key.least(trust) > 0.0;
    if outside || hidden || behind {
        return None;
    }
    let mut affine = [[0.0; 3]; 4];
    let mut error = 0.0_f64;
    for (edge, to) in edges.iter().zip(&mut affine) {
        let factor = 1.0 / edge.most();
        if factor.is_normal() {
            *to = rounded(edge, factor);
            error = error.max(edge.error * factor);
        } else {
            error = f64::INFINITY;
        }
    }
    let key_error = key.error + EVALUATION * key.most() + f64::from(f32::MIN_POSITIVE);
    let is_known = trust.of(key_error).max(key.most()) < f64::from(f32::MAX) / 4.0;
    if is_known {
        affine[3] = rounded(&key, 1.0);
    }
    let end = -2.0 * frustum.centered(0);
    Some(FlatSetup {
        affine,
        error: bound(trust, error + EVALUATION),
        key_error: if is_known { bound(trust, key_error) } else { f32::INFINITY },
        rows: [0.0, end],
        columns: [0.0, end],
    })
}

/// The function times a factor.
fn rounded(function: &TileAffine, factor: f64) -> [f32; 3] {
    let TileAffine { at_middle, across, down, .. } = *function;
    [at_middle, across, down].map(|number| narrowed(number * factor))
}

/// A bound in `f32`, not less for its rounding.
fn bound(trust: Trust, error: f64) -> f32 {
    let error = trust.of(error);
    if error > 0.0 { upward(error) } else { 0.0 }
}
