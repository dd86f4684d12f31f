//! One ray against one sphere, and two spheres against each other along a ray.

pub(super) mod blocks;
mod high_precision;

use super::answer::{Answer, FLOOR, Trust, distance_around};
use bothways_common::Ray;
use bothways_common::engine::roundoff::{EPS53, Interval};
use glam::DVec3;
use std::cmp::Ordering;

/// A sufficient relative precision of `t`: more precision has no use.
const ENOUGH: f64 = 1e-7;

/// The answer for a sphere: computed in `f64`, and with twice as many digits if `f64` leaves the answer or its
/// precision uncertain.
#[inline(always)]
pub(super) fn answer(ray: &Ray, center: DVec3, radius: f64, trust: Trust) -> Answer {
    match ClosestApproach::new(ray, center, radius, trust).answer(trust) {
        Answer::Hit(Interval { low, high }) if high - low <= ENOUGH * high => {
            Answer::Hit(Interval { low, high })
        }
        open @ (Answer::Hit(_) | Answer::Open(_)) if !trust.is_sound() => open,
        Answer::Hit(_) | Answer::Open(_) => high_precision::answer(ray, center, radius),
        Answer::Miss => Answer::Miss,
    }
}

/// How the line of a ray passes a sphere.
///
/// With `k = m·D/A`, `m = O − center`, it comes nearest to the centre at `t = −k`, where `f = m − k·D` remains; it
/// meets the sphere at `t = −k ∓ √((r² − f·f)/A)`. Unlike the discriminant `B² − A·C`, `f·f` does not cancel for small
/// spheres far away (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019).
struct ClosestApproach {
    a: f64,
    k: f64,
    k_error: f64,
    f: DVec3,
    f_error: DVec3,
    /// `r² − f·f`.
    room: f64,
    room_error: f64,
    /// `m·m − r²`: its sign tells whether the ray begins outside.
    c: f64,
    c_error: f64,
}

impl ClosestApproach {
    /// `m` carries one rounding; `A` 3; `k` 1 + 3 + 3 + 1 of `k̂ = Σ|m|·|D|/A`; a coordinate of `f` at most 10 of
    /// `|m| + k̂·|D|`; `f·f` what its coordinates bring, and 3; `C = m·m − r²` 2 + 1 + 2 + 1. Constants are larger by
    /// one or more, for the roundings of the bounds.
    #[inline(always)]
    fn new(ray: &Ray, center: DVec3, radius: f64, trust: Trust) -> ClosestApproach {
        let (m, d) = (ray.origin - center, ray.direction);
        let a = d.length_squared();
        let (k, k_size) = (m.dot(d) / a, m.abs().dot(d.abs()) / a);
        let f = m - k * d;
        let f_error = 11.0 * EPS53 * (m.abs() + k_size * d.abs());
        let f_squared = f.length_squared();
        let radius_squared = radius * radius;
        let room_error = 2.0 * f.abs().dot(f_error)
            + f_error.length_squared()
            + 5.0 * EPS53 * (f_squared + radius_squared)
            + FLOOR;
        let m_squared = m.length_squared();
        ClosestApproach {
            a,
            k,
            k_error: trust.of(9.0 * EPS53 * k_size + FLOOR),
            f,
            f_error,
            room: radius_squared - f_squared,
            room_error: trust.of(room_error),
            c: m_squared - radius_squared,
            c_error: trust.of(7.0 * EPS53 * (m_squared + radius_squared) + FLOOR),
        }
    }

    /// Half of the way through the sphere, in lengths of the ray's direction, and how far that may be off.
    ///
    /// `|√(X + e) − √X| ≤ |e|/√X`, and `A` brings 3 roundings, the quotient and the root one each.
    #[inline(always)]
    fn half(&self, trust: Trust) -> (f64, f64) {
        let half = (self.room.max(0.0) / self.a).sqrt();
        (half, trust.of(self.room_error / (self.a * half) + 5.0 * EPS53 * half))
    }

    #[inline(always)]
    fn answer(&self, trust: Trust) -> Answer {
        let (inside, outside) = (self.c < -self.c_error, self.c > self.c_error);
        if outside && (self.k > self.k_error || self.room < -self.room_error) {
            return Answer::Miss;
        }
        let (half, half_error) = self.half(trust);
        let k = self.k;
        let t = if inside { half - k } else { -half - k };
        let error = self.k_error + half_error + trust.of(2.0 * EPS53 * (k.abs() + half));
        if inside || (outside && k < -self.k_error && self.room > self.room_error) {
            let cancelled = outside && 2.5 * error > ENOUGH * t;
            let distance = distance_around(t, error);
            Answer::Hit(if cancelled { self.near_wall(half - k, error) } else { distance })
        } else {
            Answer::Open(Interval::NOT_NEGATIVE)
        }
    }

    /// Where a ray from outside meets the sphere first, from where it leaves it: the product of both is `C/A`, so
    /// nothing cancels.
    ///
    /// `A` brings 3 roundings, two quotients one each; a divisor that is off by ρ < ⅛ changes them by less than 1.2·ρ.
    fn near_wall(&self, far: f64, far_error: f64) -> Interval {
        let t = self.c / self.a / far;
        let relative = self.c_error / self.c + far_error / far;
        if relative < 0.125 {
            distance_around(t, t * (1.2 * relative + 7.0 * EPS53))
        } else {
            Interval::NOT_NEGATIVE
        }
    }

    /// Whether the ray begins inside, if that is certain.
    fn sees_far_wall(&self) -> Option<bool> {
        (self.c.abs() > self.c_error).then_some(self.c < 0.0)
    }
}

/// Which of two spheres, each with its centre and radius, is nearer along a ray that meets both, if `f64` is certain.
///
/// Spheres that nearly touch have nearly all in common, so differences are computed rather than subtracted. With the
/// way `s` from the first centre to the second, `κ = k₁ − k₂ = s·D/A` and `g = f₁ − f₂ = s − κ·D`, the halves `h` of the
/// ways through the spheres have `A·(h₁² − h₂²) = (r₁ − r₂)·(r₁ + r₂) − g·(f₁ + f₂)`, and the ray meets the spheres
/// `±h₁ ∓ h₂ − κ` apart.
///
/// `κ` carries 1 + 1 + 2 + 3 + 1 roundings of `κ̂ = Σ|s|·|D|/A`, a coordinate of `g` 11 of `|s| + κ̂·|D|`, `f₁ + f₂` what
/// its terms bring and one, the radii's product 3, the product of `g` and `f₁ + f₂` 3, the difference one.
pub(super) fn nearer([first, second]: [(DVec3, f64); 2], ray: &Ray) -> Option<Ordering> {
    let trust = Trust::Sound;
    let [one, other] =
        [first, second].map(|(center, radius)| ClosestApproach::new(ray, center, radius, trust));
    let (far, other_far) = (one.sees_far_wall()?, other.sees_far_wall()?);
    let ((half, half_error), (other_half, other_error)) = (one.half(trust), other.half(trust));
    let d = ray.direction;
    let way = second.0 - first.0;
    let (kappa, kappa_size) = (way.dot(d) / one.a, way.abs().dot(d.abs()) / one.a);
    let kappa_error = 9.0 * EPS53 * kappa_size + FLOOR;
    let (halves, halves_error) = (half + other_half, half_error + other_error);
    // If the error is more than an eighth of the halves, the comparison decides nothing.
    let certain = halves > 8.0 * halves_error;
    if !certain {
        return None;
    }
    let (apart, apart_error) = if far == other_far {
        let (less, more) = (first.1 - second.1, first.1 + second.1);
        let g = way - kappa * d;
        let g_error = 12.0 * EPS53 * (way.abs() + kappa_size * d.abs());
        let sum = one.f + other.f;
        let sum_error = one.f_error + other.f_error + 2.0 * EPS53 * sum.abs();
        let difference = less * more - g.dot(sum);
        let difference_error = g_error.dot(sum.abs() + sum_error)
            + g.abs().dot(sum_error)
            + 6.0 * EPS53 * (less.abs() * more + g.abs().dot(sum.abs()))
            + FLOOR;
        let below = one.a * halves;
        let apart = difference / below;
        let relative = 1.2 * (halves_error / halves) + 6.0 * EPS53;
        let error = 1.2 * difference_error / below + apart.abs() * relative;
        (if far { apart } else { -apart }, error)
    } else {
        (if far { halves } else { -halves }, halves_error + 2.0 * EPS53 * halves)
    };
    let value = apart - kappa;
    let error = apart_error + kappa_error + 2.0 * EPS53 * (apart.abs() + kappa.abs());
    (value.abs() > error * (1.0 + 32.0 * EPS53)).then(|| value.total_cmp(&0.0))
}
