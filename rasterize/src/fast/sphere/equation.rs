//! The equation of a sphere along a ray, relative to the eye.

use crate::fast::answer::Answer;
use crate::fast::depth::depth_from_t;
use crate::fast::high_precision::DoubleDouble;
use bothways_common::engine::roundoff::EPS53;
use bothways_common::{Projection, Ray};
use glam::DVec3;
use std::cmp::Ordering;

/// A floor of all bounds: smaller products may have underflowed. It is far above the loss of that.
const FLOOR: f64 = 1e-200;

/// Tests a ray against a sphere: in `f64`; and with twice as many digits, where that leaves the hit open or has too few
/// digits of `t`. `exact` says whether bounds hold or are (by a fault) zero.
#[inline(always)]
pub(crate) fn answer(
    projection: Projection,
    center: DVec3,
    radius: f64,
    ray: &Ray,
    exact: bool,
) -> Answer {
    /// The relative error of `t` from which a depth key can still be made.
    const ENOUGH: f64 = 1e-7;
    let hit = Equation::new(center, radius, ray, exact).first_hit();
    let hit = match hit {
        FirstHit::At { relative, .. } if relative <= ENOUGH => hit,
        FirstHit::Miss => hit,
        _ if exact => first_hit_in_high_precision(center, radius, ray),
        _ => hit,
    };
    match hit {
        FirstHit::At { t, relative } => Answer::Hit(depth_from_t(projection, t, 1.25 * relative)),
        FirstHit::Miss => Answer::Miss,
        FirstHit::Unknown => Answer::Open,
    }
}

/// Not inlined, because it would slow the loop down.
#[cold]
#[inline(never)]
fn first_hit_in_high_precision(center: DVec3, radius: f64, ray: &Ray) -> FirstHit {
    Equation::in_high_precision(center, radius, ray).first_hit()
}

/// The first hit of a ray.
enum FirstHit {
    /// The ray meets the sphere at `t`, which is off by at most this fraction of it.
    At {
        t: f64,
        relative: f64,
    },
    Miss,
    Unknown,
}

/// A ray put into the equation of a sphere: `A·t² + 2B·t + C = 0`, `A = D·D`, `B = m·D`, `C = m·m − r²`, `m = O −
/// center`; and how far each part may be off, besides a rounding. The discriminant is `B² − A·C`.
struct Equation {
    a: f64,
    b: f64,
    b_error: f64,
    c: f64,
    /// Zero only if `c` is zero and exact: the ray begins on the sphere.
    c_error: f64,
    discriminant: f64,
    d_error: f64,
    /// `ε₅₃`, or zero if bounds are zero.
    unit: f64,
}

impl Equation {
    /// In `f64`.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `A` carries 3 roundings; `m` one; `B` 1 + 3 of `B̂ = Σ|m|·|D|`; `C` 2 + 1 + 2 and the last difference
    /// one, of `Ĉ = m·m + r²`; `B²` twice 4 and one; `A·C` 3 + 6 + 1; their difference one more: 11 of
    /// `B̂² + A·Ĉ`. Each constant below is larger by one or more, for the roundings of the bounds.
    #[inline(always)]
    fn new(center: DVec3, radius: f64, ray: &Ray, exact: bool) -> Equation {
        let unit = if exact { EPS53 } else { 0.0 };
        let floor = if exact { FLOOR } else { 0.0 };
        let m = ray.origin - center;
        let a = ray.direction.length_squared();
        let b = m.dot(ray.direction);
        let (distance_squared, radius_squared) = (m.length_squared(), radius * radius);
        let c = distance_squared - radius_squared;
        let b_size = m.abs().dot(ray.direction.abs());
        let c_size = distance_squared + radius_squared;
        Equation {
            a,
            b,
            b_error: 5.0 * unit * b_size + floor,
            c,
            c_error: 7.0 * unit * c_size + floor,
            discriminant: b * b - a * c,
            d_error: 13.0 * unit * (b_size * b_size + a * c_size) + floor,
            unit,
        }
    }

    /// With twice as many digits; the leading half is kept in the end.
    ///
    /// # The errors, rounding by rounding
    ///
    /// `m` has none, a sum less than 4ε₅₃², a product less than 8ε₅₃². So `A` carries 8 + 2·4 of them; `B` as many of
    /// `B̂`; `C` 8 + 3·4 of `Ĉ`; `B²` 2·16 + 8; `A·C` 16 + 20 + 8; their difference four more: 48 of `B̂² + A·Ĉ`.
    /// Each constant below is larger by a fifth or more: for the roundings of sizes, and for products of errors.
    fn in_high_precision(center: DVec3, radius: f64, ray: &Ray) -> Equation {
        const SQUARE: f64 = EPS53 * EPS53;
        let d = ray.direction.to_array().map(DoubleDouble::new);
        let m: [DoubleDouble; 3] =
            std::array::from_fn(|k| DoubleDouble::difference(ray.origin[k], center[k]));
        let dot =
            |p: &[DoubleDouble; 3], q: &[DoubleDouble; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let r = DoubleDouble::new(radius);
        let (a, b, m_squared, r_squared) = (dot(&d, &d), dot(&m, &d), dot(&m, &m), r * r);
        let is_on = begins_on(&m, radius);
        let c = if is_on { DoubleDouble::ZERO } else { m_squared - r_squared };
        let discriminant = b * b - a * c;
        let sizes = m.map(|coordinate| coordinate.high.abs());
        let b_size = DVec3::from_array(sizes).dot(ray.direction.abs());
        let c_size = m_squared.high + r_squared.high;
        Equation {
            a: a.high,
            b: b.high,
            b_error: 20.0 * SQUARE * b_size + FLOOR,
            c: c.high,
            c_error: if is_on { 0.0 } else { 24.0 * SQUARE * c_size + FLOOR },
            discriminant: discriminant.high,
            d_error: 64.0 * SQUARE * (b_size * b_size + a.high * c_size) + FLOOR,
            unit: EPS53,
        }
    }

    #[inline(always)]
    fn first_hit(&self) -> FirstHit {
        let Equation { a, b, b_error, c, c_error, discriminant, d_error, unit } = *self;
        let (outside, inside) = (c > c_error, c < -c_error);
        let on = c == 0.0 && c_error == 0.0;
        if (outside || on) && b > b_error || outside && discriminant < -d_error {
            return FirstHit::Miss;
        }
        let approaches = b < -b_error;
        let near = outside && approaches && discriminant > d_error;
        // A ray that begins on the sphere meets its far wall, or nothing.
        if !(near || inside || on && approaches) {
            return FirstHit::Unknown;
        }
        // The form of the root in which nothing cancels, and the relative errors of its parts. Each part is
        // rounded once more at its end.
        let root = discriminant.sqrt();
        let root_error = d_error / root + 2.0 * unit * root;
        let sum = b.abs() + root;
        let sum_relative = (b_error + root_error) / sum + 3.0 * unit;
        let (t, relative) = if near || b > 0.0 {
            (c.abs() / sum, c_error / c.abs() + 2.0 * sum_relative)
        } else {
            (sum / a, sum_relative + 4.0 * unit)
        };
        FirstHit::At { t, relative: relative + 3.0 * unit }
    }
}

/// Whether `|m| = r`, exactly.
///
/// Let `q` be the place of the last digit of `r = R·q`, so that `R` is an odd integer below 2²⁴, and suppose `|m|² =
/// r²`. If some coordinate of `m` had more places, then with the last place `q/2ˢ` of them all, `s > 0`, three squares of
/// integers would sum to `4ˢ·R²`; but a square leaves 0 or 1 when divided by 4, so all three integers would be even,
/// and that was not the last place. So coordinates are integers times `q`, at most `R` of them, and their squares and
/// sums have at most 50 digits: plain arithmetic has no error.
pub(super) fn begins_on(m: &[DoubleDouble; 3], radius: f64) -> bool {
    let digits = radius.to_bits();
    // The place of the leading digit, and how many places lower the last digit is.
    let leading = f64::from_bits(digits >> 52 << 52);
    let beneath = 52 - u64::from((digits | 1 << 52).trailing_zeros());
    let q = leading * f64::from_bits((1023 - beneath) << 52);
    let in_places = m.map(|coordinate| coordinate.high / q);
    let places = radius / q;
    let fits = |x: f64| x.abs() <= places && x.fract() == 0.0;
    let [x, y, z] = in_places;
    m.iter().all(|coordinate| coordinate.is_short())
        && in_places.into_iter().all(fits)
        && x * x + y * y + z * z == places * places
}

/// Which of two spheres, each with its centre and radius, is nearer along a ray that meets both, if `f64` is certain.
///
/// Spheres that nearly touch have nearly all numbers in common. So the value that is computed is
/// `A·(t₁ − t₂) = σ₁·√d₁ − σ₂·√d₂ − Δ`, with `Δ = B₁ − B₂ = s·D`, `s` from the first centre to the second, and for two
/// roots of one side
/// `√d₁ − √d₂ = (d₁ − d₂)/(√d₁ + √d₂)`, `d₁ − d₂ = Δ·(B₁ + B₂) − A·(s·(m₁ + m₂) − (r₁ − r₂)·(r₁ + r₂))`.
///
/// # The errors, rounding by rounding
///
/// `s` carries one, `Δ` 1 + 3 of `Δ̂ = Σ|s|·|D|`; `m₁ + m₂` 2 of `Σ|m|`; `B₁ + B₂` as their product with `D` 5; `Δ·(B₁ +
/// B₂)` 10; `s·(m₁ + m₂)` 1 + 2 + 3; the radii's product 3; their difference one more, 7; times `A` 3 + 7 + 1; the last
/// difference one: 12 of all sizes. A root is off by less than `d_error/d` of itself, and one rounding. What is computed
/// from these adds a few; constants are larger.
pub(crate) fn nearer([first, second]: [(DVec3, f64); 2], ray: &Ray) -> Option<Ordering> {
    let d = ray.direction;
    let [one, other] =
        [first, second].map(|(center, radius)| Equation::new(center, radius, ray, true));
    let (side, other_side) = (one.side()?, other.side()?);
    let (root, other_root) = (one.root()?, other.root()?);
    let roots = root + other_root;
    let roots_error =
        (one.d_error / one.discriminant).max(other.d_error / other.discriminant) + 3.0 * EPS53;

    let way = second.0 - first.0;
    let (delta, delta_size) = (way.dot(d), way.abs().dot(d.abs()));
    let (apart, apart_error) = if side == other_side {
        let (m, other_m) = (ray.origin - first.0, ray.origin - second.0);
        let (sum, sum_size) = (m + other_m, m.abs() + other_m.abs());
        let (less, more) = (first.1 - second.1, first.1 + second.1);
        let difference = delta * sum.dot(d) - one.a * (way.dot(sum) - less * more);
        let size = delta_size * sum_size.dot(d.abs())
            + one.a * (way.abs().dot(sum_size) + less.abs() * more);
        let apart = side * difference / roots;
        // With room for the quotient: roots are certain to less than an eighth.
        (apart, 1.2 * (15.0 * EPS53 * size + FLOOR) / roots + 1.2 * apart.abs() * roots_error)
    } else {
        (side * roots, roots * roots_error)
    };
    let value = apart - delta;
    let error =
        apart_error + 6.0 * EPS53 * delta_size + 4.0 * EPS53 * (apart.abs() + delta.abs()) + FLOOR;
    (value.abs() > error * (1.0 + 16.0 * EPS53)).then(|| value.total_cmp(&0.0))
}

impl Equation {
    /// `σ` of the root that is seen, if that is certain: the near one from outside.
    fn side(&self) -> Option<f64> {
        let outside = self.c > self.c_error;
        (outside || self.c < -self.c_error).then_some(if outside { -1.0 } else { 1.0 })
    }

    /// The root of the discriminant, if that is certain to an eighth.
    fn root(&self) -> Option<f64> {
        (self.discriminant > 8.0 * self.d_error).then(|| self.discriminant.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn begins_on(m: [f64; 3], radius: f32) -> bool {
        super::begins_on(&m.map(DoubleDouble::new), radius.into())
    }

    #[test]
    fn a_ray_that_begins_on_a_sphere_is_recognised() {
        for scale in [1.0, 2f64.powi(-149), 2f64.powi(100), 2f64.powi(-20)] {
            let radius = |r: f64| (r * scale).to_string().parse().unwrap();
            for (m, r) in [([0.0, 0.0, -1.0], 1.0), ([3.0, 0.0, 4.0], 5.0), ([2.0, -3.0, 6.0], 7.0)]
            {
                assert!(begins_on(m.map(|x| x * scale), radius(r)), "{m:?} {scale}");
                assert!(!begins_on(
                    [m[0] * scale, m[1] * scale, m[2] * scale * (1.0 + f64::EPSILON)],
                    radius(r)
                ));
            }
        }
        // Of 24 digits: 4095·4097 + 64² and so on, made of (a² − b², 2ab, a² + b²).
        let (a, b) = (4095.0, 2.0);
        let m = [a * a - b * b, 2.0 * a * b, 0.0];
        assert!(begins_on(m, 16_769_029.0_f32));
        assert!(!begins_on([m[0], m[1] + 1.0, 0.0], 16_769_029.0_f32));
        assert!(!begins_on([1e30, 0.0, 0.0], 1.0) && !begins_on([0.5, 0.5, 0.5], 1.0));
    }
}
