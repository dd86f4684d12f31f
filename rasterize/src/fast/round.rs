//! A sphere, tested by its equation at the samples of its bounding region.

use super::depth::{DepthInterval, UNIT_ROUNDOFF};
use bothways_common::{Projection, Ray};
use glam::DVec3;

/// What rounded arithmetic says of a sphere at a sample.
#[derive(Clone, Copy, Debug)]
pub(super) enum Covered {
    /// Certainly, at this depth.
    At(DepthInterval),
    /// Certainly not.
    No,
    /// The judge must say.
    Unknown,
}

/// Puts a ray into the equation of a sphere: `A·t² + 2B·t + C = 0`, `A = D·D`, `B = m·D`, `C = m·m −
/// r²`, `m = O − center`.
///
/// # The errors, rounding by rounding
///
/// `A` carries 3 roundings; `m` one; `B` 1 + 3 of `B̂ = Σ|m|·|D|`; `C` 2 + 1 + 2 and the last difference
/// one, of `Ĉ = m·m + r²`; `B²` twice 4 and one; `A·C` 3 + 6 + 1; their difference one more: 11 of
/// `B̂² + A·Ĉ`. Each constant below is larger by one or more, for the roundings of the bounds.
/// `exact` says whether bounds hold or are (by a fault) zero.
pub(super) fn covered(
    projection: Projection,
    center: DVec3,
    radius: f64,
    ray: &Ray,
    exact: bool,
) -> Covered {
    // Beneath this, products may have underflowed; it is far above what that can lose.
    const FLOOR: f64 = 1e-200;
    let unit = if exact { UNIT_ROUNDOFF } else { 0.0 };
    let floor = if exact { FLOOR } else { 0.0 };
    let m = ray.origin - center;
    let a = ray.direction.length_squared();
    let b = m.dot(ray.direction);
    let (distance_squared, radius_squared) = (m.length_squared(), radius * radius);
    let c = distance_squared - radius_squared;
    let b_size = m.abs().dot(ray.direction.abs());
    let c_size = distance_squared + radius_squared;
    let b_error = 5.0 * unit * b_size + floor;
    let c_error = 7.0 * unit * c_size + floor;
    let discriminant = b * b - a * c;
    let d_error = 13.0 * unit * (b_size * b_size + a * c_size) + floor;

    let outside = c > c_error;
    if outside && (b > b_error || discriminant < -d_error) {
        return Covered::No;
    }
    let near = outside && b < -b_error && discriminant > d_error;
    let inside = c < -c_error;
    if !(near || inside) {
        return Covered::Unknown;
    }
    // The form of the root in which nothing cancels, and the relative errors of its parts.
    let root = discriminant.sqrt();
    let root_error = d_error / root + unit * root;
    let sum = b.abs() + root;
    let sum_relative = (b_error + root_error) / sum + unit;
    let (t, relative) = if near || b > 0.0 {
        (c.abs() / sum, c_error / c.abs() + 2.0 * sum_relative)
    } else {
        (sum / a, sum_relative + 4.0 * unit)
    };
    Covered::At(DepthInterval::from_t(projection, t, 1.25 * (relative + 2.0 * unit)))
}
