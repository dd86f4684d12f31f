//! A sphere far in front of a parallel camera, tested from the local origin: where it lies is known to as many digits
//! as if the eye were near.

use crate::fast::answer::Answer;
use bothways_common::Ray;
use bothways_common::engine::roundoff::{EPS53, Interval};
use glam::DVec3;

/// Puts a ray into the equation of a sphere, all of which lies in front of the eye: the near root is seen, whatever its
/// sign. `center` and the resulting depth count from the local origin.
///
/// # The errors, rounding by rounding
///
/// `A = D·D`, `B = m·D`, `C = m·m − r²` and `m = O − center`. The centre carries two roundings of itself, which are not
/// ones of `m`: beside the middle ray `O` and the centre cancel. With that one's own, a coordinate of `m` is off by at most
/// `3ε₅₃·s`, `s = |m| + |center|`. So `B` is off by 3 and 3 of `S = Σs·|D|`; `m·m` by 6 of `Σ|m|·s`, 9 of `ε₅₃·Σs·s` and 3
/// of itself; `C` by one of itself and of `r²` besides. With these `δB` and `δC`, `B²` is off by `2|B|·δB + δB²`, of
/// which the computed `B` may take one more `2δB²`, and one of itself; `A·C` by `A·δC`, 3 for `A` and one; their
/// difference by one of both. The root `(−B − √…)/A` carries what its parts do, and 3 of `A`, the sum's and the
/// quotient's. Constants are larger by one or more, or by a tenth.
pub(crate) fn answer(center: DVec3, radius: f64, ray: &Ray, exact: bool) -> Answer {
    /// A floor of all bounds: smaller products may have underflowed.
    const FLOOR: f64 = 1e-200;
    let (unit, floor) = if exact { (EPS53, FLOOR) } else { (0.0, 0.0) };
    let m = ray.origin - center;
    let a = ray.direction.length_squared();
    let b = m.dot(ray.direction);
    let (distance_squared, radius_squared) = (m.length_squared(), radius * radius);
    let size = m.abs() + center.abs();
    let b_error = 7.0 * unit * size.dot(ray.direction.abs()) + floor;
    let c_error = 12.0 * unit * (m.abs().dot(size) + radius_squared)
        + 16.0 * unit * unit * size.length_squared();
    let discriminant = b * b - a * (distance_squared - radius_squared);
    let d_error = 1.1 * (2.0 * b.abs() * b_error + 3.0 * b_error * b_error + a * c_error)
        + 8.0 * unit * (b * b + a * (distance_squared + radius_squared))
        + floor;
    if discriminant < -d_error {
        return Answer::Miss;
    }
    // Written so that NaN is unknown.
    if discriminant.partial_cmp(&d_error) != Some(std::cmp::Ordering::Greater) {
        return Answer::Open;
    }
    let root = discriminant.sqrt();
    let root_error = d_error / root + unit * root;
    let t = (-b - root) / a;
    let error = 1.01 * (b_error + root_error + 6.0 * unit * (b.abs() + root)) / a + floor;
    Answer::Hit(Interval::around(t, error).unwrap_or(Interval::ALL))
}
