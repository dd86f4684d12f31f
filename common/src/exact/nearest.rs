//! Which of two primitives is nearer along a ray, and how far one is.
//!
//! Both are known to cover the sample. Triangles and planes are *flat*: with a normal `n` and a point
//! `a` of it, the ray crosses it at `t = p/q`, `p = n·(a − O)`, `q = n·D`.

use super::bounded::Bounded;
use super::cover::{Nudge, Quadratic};
use super::double::Double;
use super::dyadic::Dyadic;
use super::evaluate::exactly;
use super::real::{Real, cross, difference, dot, vector};
use super::sign::Sign;
use crate::camera::{Projection, Ray};
use crate::scene::primitive::{Primitive, are_same_corners};
use glam::DVec3;
use std::cmp::Ordering;

/// Which of two primitives is nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Comparison {
    /// By `t` at the sample itself; equal is a tie.
    pub at_sample: Ordering,
    /// With ties broken: flat before round, then the nudged ray. What is still equal is the same
    /// plane, or two spheres met at the same point.
    pub decided: Ordering,
}

impl Comparison {
    /// Nothing but the order in the scene tells them apart.
    pub(super) const EQUAL: Comparison =
        Comparison { at_sample: Ordering::Equal, decided: Ordering::Equal };
}

/// Compares the distances of two primitives that both cover the sample; `Less` is nearer.
pub(super) fn compare(
    projection: Projection,
    nudge: &Nudge,
    first: &Primitive,
    second: &Primitive,
    ray: &Ray,
) -> Comparison {
    if are_identical(first, second) {
        return Comparison::EQUAL;
    }
    match (first.is_round(), second.is_round()) {
        (true, true) => {
            let order = ordering(exactly!(sphere_against_sphere(first, second, ray)));
            Comparison { at_sample: order, decided: order }
        }
        (true, false) => {
            let order = ordering(exactly!(sphere_against_flat(first, second, ray)));
            Comparison { at_sample: order, decided: order.then(Ordering::Greater) }
        }
        (false, true) => {
            let order = ordering(exactly!(sphere_against_flat(second, first, ray))).reverse();
            Comparison { at_sample: order, decided: order.then(Ordering::Less) }
        }
        (false, false) => {
            let at_sample = ordering(exactly!(flat_against_flat(first, second, ray)));
            let along = |direction| {
                ordering(exactly!(flat_against_flat_along(
                    projection, first, second, ray, direction
                )))
            };
            let decided = at_sample.then_with(|| along(nudge.u)).then_with(|| along(-nudge.v));
            Comparison { at_sample, decided }
        }
    }
}

/// The comparison of two flat primitives, if rounded arithmetic is certain that one is nearer.
pub(super) fn by_rounded_arithmetic(
    first: &Primitive,
    second: &Primitive,
    ray: &Ray,
) -> Option<Comparison> {
    if first.is_round() || second.is_round() {
        return None;
    }
    let sign = flat_against_flat::<Bounded>(first, second, ray)?;
    let order = ordering(sign);
    (sign != Sign::Zero).then_some(Comparison { at_sample: order, decided: order })
}

/// The distance of a primitive that covers the sample, to within a few parts in 10¹⁰.
pub(super) fn distance(primitive: &Primitive, ray: &Ray) -> f64 {
    const CLOSE: f64 = 1e-10;
    let rounded = match *primitive {
        Primitive::Sphere { center, radius } => rounded_sphere_distance(center, radius, ray),
        Primitive::Triangle(_) | Primitive::Plane { .. } => {
            let Crossing { p, q, .. } = Crossing::<Bounded>::new(primitive, ray);
            p.over(q)
        }
    };
    if rounded.error < CLOSE * rounded.value {
        return rounded.value;
    }
    match *primitive {
        Primitive::Sphere { center, radius } => doubled_sphere_distance(center, radius, ray)
            .unwrap_or_else(|| exact_sphere_distance(center, radius, ray)),
        Primitive::Triangle(_) | Primitive::Plane { .. } => {
            let Crossing { p, q, .. } = Crossing::<Dyadic>::new(primitive, ray);
            p.to_f64() / q.to_f64()
        }
    }
}

/// The sign of `t₁ − t₂` as an order.
pub(super) fn ordering(sign: Sign) -> Ordering {
    sign.cmp(&Sign::Zero)
}

/// Whether two primitives are duplicates, with their corners in any order. Duplicates are the most
/// frequent ties, and need no arithmetic.
pub(super) fn are_identical(first: &Primitive, second: &Primitive) -> bool {
    match (first, second) {
        (Primitive::Triangle(first), Primitive::Triangle(second)) => {
            are_same_corners(first, second)
        }
        _ => first == second,
    }
}

/// Where a ray crosses a flat primitive: at `t = p/q`.
pub(super) struct Crossing<R> {
    pub(super) normal: [R; 3],
    pub(super) p: R,
    pub(super) q: R,
}

impl<R: Real> Crossing<R> {
    pub(super) fn new(flat: &Primitive, ray: &Ray) -> Self {
        let (normal, point) = match *flat {
            Primitive::Triangle([a, b, c]) => (cross(&difference(b, a), &difference(c, a)), a),
            Primitive::Plane { point, normal } => (vector(normal), point),
            Primitive::Sphere { .. } => unreachable!("a sphere is not flat"),
        };
        let p = dot(&normal, &difference(point, ray.origin));
        let q = dot(&normal, &vector(ray.direction));
        Crossing { normal, p, q }
    }
}

/// The sign of `p₁/q₁ − p₂/q₂`: that of `(p₁·q₂ − p₂·q₁)·q₁·q₂`.
fn flat_against_flat<R: Real>(first: &Primitive, second: &Primitive, ray: &Ray) -> Option<Sign> {
    let (first, second) = (Crossing::<R>::new(first, ray), Crossing::<R>::new(second, ray));
    let difference = first.p.times(&second.q).minus(&second.p.times(&first.q));
    Some(difference.sign()? * first.q.sign()? * second.q.sign()?)
}

/// The same when it is zero at the sample: the derivative along a direction of the nudge.
///
/// A perspective camera nudges `D`, which moves `q` by `n·along`; `p₁·q₂ − p₂·q₁` moves by
/// `p₁·(n₂·along) − p₂·(n₁·along)`. A parallel camera nudges `O`, which moves `p` by `−n·along`, and
/// the difference by `(n₂·along)·q₁ − (n₁·along)·q₂`.
fn flat_against_flat_along<R: Real>(
    projection: Projection,
    first: &Primitive,
    second: &Primitive,
    ray: &Ray,
    along: DVec3,
) -> Option<Sign> {
    let (first, second) = (Crossing::<R>::new(first, ray), Crossing::<R>::new(second, ray));
    let along = vector::<R>(along);
    let (slope1, slope2) = (dot(&first.normal, &along), dot(&second.normal, &along));
    let derivative = match projection {
        Projection::Perspective => first.p.times(&slope2).minus(&second.p.times(&slope1)),
        Projection::Parallel => first.q.times(&slope2).minus(&second.q.times(&slope1)),
    };
    Some(derivative.sign()? * first.q.sign()? * second.q.sign()?)
}

fn center_and_radius(sphere: &Primitive) -> (DVec3, f64) {
    match *sphere {
        Primitive::Sphere { center, radius } => (center, radius),
        Primitive::Triangle(_) | Primitive::Plane { .. } => unreachable!("it is a sphere"),
    }
}

/// A sphere's visible root: `t = (−B + side·√(B² − A·C))/A`, near side first.
fn root_side<R: Real>(quadratic: &Quadratic<R>) -> Option<Sign> {
    // The eye outside of the sphere sees the near root; inside, and on it, only the far one is
    // positive.
    Some(if quadratic.c.sign()? == Sign::Positive { Sign::Negative } else { Sign::Positive })
}

/// The sign of `t_sphere − t_flat`.
///
/// Put `t = p/q` with `q > 0` into the sphere's quadratic: `Q = A·p² + 2B·p·q + C·q²` is positive
/// where the flat's point lies outside of the roots, and then the slope `X = A·p + B·q` says on which
/// side of both.
fn sphere_against_flat<R: Real>(sphere: &Primitive, flat: &Primitive, ray: &Ray) -> Option<Sign> {
    let (center, radius) = center_and_radius(sphere);
    let quadratic = Quadratic::<R>::new(center, radius, ray);
    let Quadratic { a, b, c, .. } = &quadratic;
    let Crossing { p, q, .. } = Crossing::<R>::new(flat, ray);
    let twice = p.times(&q).plus(&p.times(&q));
    let value = a.times(&p.square()).plus(&b.times(&twice)).plus(&c.times(&q.square())).sign()?;
    // Multiplied by q's sign, X is the slope for q > 0.
    let slope = || Some(a.times(&p).plus(&b.times(&q)).sign()? * q.sign()?);
    match (root_side(&quadratic)?, value) {
        // Between the roots: the near one comes before, the far one after.
        (side, Sign::Negative) => Some(side),
        // On a root: which one, says the slope (it is not zero: the roots are two).
        (side, Sign::Zero) => {
            let at = slope()?;
            Some(if at == side { Sign::Zero } else { side })
        }
        // Outside of both roots: behind both, or before both.
        (_, Sign::Positive) => Some(-slope()?),
    }
}

/// The sign of `t₁ − t₂` of two spheres: of `L − Δ` with `L = σ₁·√d₁ − σ₂·√d₂`, `Δ = B₁ − B₂`.
///
/// Spheres that nearly touch have nearly everything in common, which must not be subtracted once it is
/// rounded. So `Δ = s·D` with the way `s` from the first centre to the second, and by Lagrange's identity
/// `d₁ − d₂ = A·(r₁ − r₂)·(r₁ + r₂) − (s × D)·((m₁ + m₂) × D)`.
fn sphere_against_sphere<R: Real>(
    first: &Primitive,
    second: &Primitive,
    ray: &Ray,
) -> Option<Sign> {
    let [(center1, radius1), (center2, radius2)] = [first, second].map(center_and_radius);
    let first = Quadratic::<R>::new(center1, radius1, ray);
    let second = Quadratic::<R>::new(center2, radius2, ray);
    let (side1, side2) = (root_side(&first)?, root_side(&second)?);
    let way = difference(center2, center1);
    let delta = dot(&way, &first.d);
    let same_side = side1 == side2;
    let greater = || difference_of_discriminants(&first, &second, &way);

    let left = if same_side { side1 * greater().sign()? } else { side1 };
    let right = delta.sign()?;
    if left != right {
        return Some(if left > right { Sign::Positive } else { Sign::Negative });
    }
    if left == Sign::Zero {
        return Some(Sign::Zero);
    }
    // L and Δ have one sign, so their squares tell: L² − Δ² = M − 2σ₁σ₂·√(d₁·d₂) with
    // M = d₁ + d₂ − Δ². And M² − 4·d₁·d₂ = (d₁ − d₂)² − Δ²·(M + d₁ + d₂).
    let square = delta.square();
    let sum = first.discriminant().plus(&second.discriminant());
    let m = sum.minus(&square);
    let squares = || greater().square().minus(&square.times(&m.plus(&sum))).sign();
    let greater = match (m.sign()?, same_side) {
        (Sign::Positive, true) => squares()?,
        (_, true) => Sign::Negative,
        (Sign::Negative, false) => -squares()?,
        (_, false) => Sign::Positive,
    };
    Some(greater * left)
}

/// `d₁ − d₂` of two spheres, with the `way` from the first centre to the second.
fn difference_of_discriminants<R: Real>(
    first: &Quadratic<R>,
    second: &Quadratic<R>,
    way: &[R; 3],
) -> R {
    let sum: [R; 3] = std::array::from_fn(|k| first.m[k].plus(&second.m[k]));
    let radii = first.radius.minus(&second.radius).times(&first.radius.plus(&second.radius));
    let across = dot(&cross(way, &first.d), &cross(&sum, &first.d));
    first.a.times(&radii).minus(&across)
}

fn rounded_sphere_distance(center: DVec3, radius: f64, ray: &Ray) -> Bounded {
    let quadratic = Quadratic::<Bounded>::new(center, radius, ray);
    let root = quadratic.discriminant().square_root();
    let Quadratic { a, b, c, .. } = quadratic;
    let minus_b = Bounded::new(0.0).minus(&b);
    // Of the two forms of a root, the one without cancellation. Which root is seen must be certain.
    match (c.sign(), b.value < 0.0) {
        (Some(Sign::Positive), _) => c.over(minus_b.plus(&root)),
        (Some(Sign::Negative), true) => minus_b.plus(&root).over(a),
        (Some(Sign::Negative), false) => Bounded::new(0.0).minus(&c).over(b.plus(&root)),
        _ => Bounded { value: 0.0, error: f64::INFINITY },
    }
}

/// From numbers of twice as many digits, if they leave no doubt of more than a part in 10¹².
fn doubled_sphere_distance(center: DVec3, radius: f64, ray: &Ray) -> Option<f64> {
    const PART: f64 = 1e-12;
    let quadratic = Quadratic::<Double>::new(center, radius, ray);
    let outside = quadratic.c.sign()? == Sign::Positive;
    let relative = |number: &Double| number.within(PART * number.rounded().abs());
    let root = relative(&quadratic.discriminant())?.sqrt();
    // b only needs to be precise relative to the root.
    let b = quadratic.b.within(PART * root)?;
    let (a, c) = (relative(&quadratic.a)?, relative(&quadratic.c)?);
    Some(seen_root(outside, [a, b, c], root))
}

fn exact_sphere_distance(center: DVec3, radius: f64, ray: &Ray) -> f64 {
    let quadratic = Quadratic::<Dyadic>::new(center, radius, ray);
    let root = quadratic.discriminant().square_root();
    let outside = quadratic.c.sign() == Some(Sign::Positive);
    let parts = [quadratic.a, quadratic.b, quadratic.c].map(|number| number.to_f64());
    seen_root(outside, parts, root)
}

/// The root that is seen, in the form in which nothing cancels. `root` is that of the discriminant.
fn seen_root(outside: bool, [a, b, c]: [f64; 3], root: f64) -> f64 {
    match (outside, b < 0.0) {
        (true, _) => c / (root - b),
        (false, true) => (root - b) / a,
        (false, false) => -c / (b + root),
    }
}
