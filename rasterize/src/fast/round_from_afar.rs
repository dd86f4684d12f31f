//! A sphere far before a parallel camera, tested as [`super::round`] tests others, but from the waypoint: where it lies is
//! known to as many digits as if the eye were near.

use super::depth::{DepthInterval, UNIT_ROUNDOFF};
use super::round::Covered;
use bothways_common::Ray;
use glam::DVec3;

/// Puts a ray into the equation of a sphere that lies before the eye as a whole: the near root is seen, whatever its
/// sign. `center`, and the depth that comes of it, count from the waypoint.
///
/// # The errors, rounding by rounding
///
/// With `A = D·D`, `B = m·D`, `C = m·m − r²` and `m = O − center`, of which the centre brings two for each coordinate:
/// `A` carries 3, `m` 3, `B` 3 and 3 of `B̂ = Σ|m|·|D|`, `C` 6, 3 and 1 of `Ĉ = m·m + r²`, `B²` twice 6 and one, `A·C` 3,
/// 10 and 1, their difference one more: 15 of `B̂² + A·Ĉ`. The root `(−B − √…)/A` carries what its parts do, and 3 of
/// `A`, the sum's and the quotient's. Constants are larger by one or more.
pub(super) fn covered(center: DVec3, radius: f64, ray: &Ray, exact: bool) -> Covered {
    const FLOOR: f64 = 1e-200;
    let (unit, floor) = if exact { (UNIT_ROUNDOFF, FLOOR) } else { (0.0, 0.0) };
    let m = ray.origin - center;
    let a = ray.direction.length_squared();
    let b = m.dot(ray.direction);
    let (distance_squared, radius_squared) = (m.length_squared(), radius * radius);
    let b_size = m.abs().dot(ray.direction.abs());
    let c_size = distance_squared + radius_squared;
    let discriminant = b * b - a * (distance_squared - radius_squared);
    let d_error = 18.0 * unit * (b_size * b_size + a * c_size) + floor;
    if discriminant < -d_error {
        return Covered::No;
    }
    // Written so that NaN is not known.
    if discriminant.partial_cmp(&d_error) != Some(std::cmp::Ordering::Greater) {
        return Covered::Unknown;
    }
    let root = discriminant.sqrt();
    let root_error = d_error / root + unit * root;
    let t = (-b - root) / a;
    let error =
        1.01 * (8.0 * unit * b_size + root_error + 6.0 * unit * (b.abs() + root)) / a + floor;
    let (low, high) = (t - error, t + error);
    Covered::At(if low <= high { DepthInterval { low, high } } else { DepthInterval::UNKNOWN })
}
