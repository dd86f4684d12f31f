//! One ray against one sphere with twice as many digits: for spheres far away, nearly touched, or nearly at the eye.

use crate::fast::answer::{Answer, FLOOR, distance_around};
use crate::fast::high_precision::{self, DoubleDouble};
use bothways_common::Ray;
use bothways_common::engine::roundoff::{EPS53, Interval};
use glam::DVec3;

/// The answer from sums of products to twice as many digits: `A = D·D`, `B = m·D`, `C = m·m − r²` and, by Lagrange's
/// identity, the discriminant `B² − A·C = A·r² − |m × D|²`.
///
/// `m` is the sum of two numbers without error, so its products are sums of twice as many; `m × D` and `A` are taken
/// as they come out, and what they are off by goes into the bound. `r²` has 48 digits: no error.
#[cold]
#[inline(never)]
pub(super) fn answer(ray: &Ray, center: DVec3, radius: f64) -> Answer {
    let [dx, dy, dz] = ray.direction.to_array();
    let [(mx, nx), (my, ny), (mz, nz)] =
        std::array::from_fn(|k| high_precision::sum(ray.origin[k], -center[k]));
    let a = DoubleDouble::of_products([dx, dy, dz], [dx, dy, dz]);
    let b = DoubleDouble::of_products([mx, my, mz, nx, ny, nz], [dx, dy, dz, dx, dy, dz]);
    let c = DoubleDouble::of_products(
        [mx, my, mz, -radius, 2.0 * mx, 2.0 * my, 2.0 * mz, nx, ny, nz],
        [mx, my, mz, radius, nx, ny, nz, nx, ny, nz],
    );
    let cross = [
        DoubleDouble::of_products([my, -mz, ny, -nz], [dz, dy, dz, dy]),
        DoubleDouble::of_products([mz, -mx, nz, -nx], [dx, dz, dx, dz]),
        DoubleDouble::of_products([mx, -my, nx, -ny], [dy, dx, dy, dx]),
    ];
    let [x, y, z] = cross;
    let r_squared = radius * radius;
    let mut discriminant = DoubleDouble::of_products(
        [a.high, a.low, -x.high, -y.high, -z.high, -2.0 * x.high, -2.0 * y.high, -2.0 * z.high],
        [r_squared, r_squared, x.high, y.high, z.high, x.low, y.low, z.low],
    );
    // (h + l + e)² is h² + 2·h·l, and at most l² + 2·|h + l|·|e| + e² more.
    let of_square = |sum: &DoubleDouble| {
        let size = sum.high.abs() + sum.low.abs();
        sum.low * sum.low + (2.0 * size + sum.error) * sum.error
    };
    let carried = a.error * r_squared + cross.iter().map(of_square).sum::<f64>();
    discriminant.error += 1.1 * carried + FLOOR;
    from_parts(&a, &b, &c, &discriminant)
}

/// The root that is seen, in the form in which nothing cancels, from parts that are certain to more than their
/// leading halves: each is rounded to one, once.
fn from_parts(
    a: &DoubleDouble,
    b: &DoubleDouble,
    c: &DoubleDouble,
    discriminant: &DoubleDouble,
) -> Answer {
    let (outside, inside, on) = (c.is_positive(), c.is_negative(), c.is_zero());
    let leaves = b.is_positive() || b.is_zero();
    if (outside || on) && leaves || outside && discriminant.is_negative() {
        return Answer::Miss;
    }
    let near = outside && b.is_negative() && discriminant.is_positive();
    if !(near || inside || on && b.is_negative()) {
        return Answer::Open(Interval::NOT_NEGATIVE);
    }
    let root = discriminant.high.sqrt();
    let root_error = discriminant.error / root + 2.0 * EPS53 * root;
    let sum = b.high.abs() + root;
    let sum_relative = (b.error + EPS53 * b.high.abs() + root_error) / sum + 2.0 * EPS53;
    let (t, relative) = if near || b.high > 0.0 {
        let c_relative = c.error / c.high.abs() + EPS53;
        (c.high.abs() / sum, c_relative + sum_relative)
    } else {
        (sum / a.high, sum_relative + a.error / a.high + EPS53)
    };
    // The quotient is one rounding more; a divisor that is off by ρ < ⅛ changes it by less than 1.2·ρ.
    let relative = 1.25 * relative + 2.0 * EPS53;
    let known = relative < 0.125 && t > 0.0;
    Answer::Hit(if known { distance_around(t, t * relative) } else { Interval::NOT_NEGATIVE })
}
