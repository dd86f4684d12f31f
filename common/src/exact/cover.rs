//! Which samples a primitive covers.

use super::dyadic::Dyadic;
use super::evaluate::exactly;
use super::real::{Real, cross, difference, dot, vector};
use super::sign::Sign;
use crate::camera::{Projection, Ray};
use crate::engine::roundoff::EPS53;
use glam::DVec3;
use robust::{Coord3D, orient3d};

/// What decides whether a triangle covers a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeSigns {
    /// The facing `F`: negative when the corners are seen counter-clockwise, zero for edge-on.
    pub facing: Sign,
    /// The signs of `E_ab`, `E_bc`, `E_ca` at the sample itself; zero is a tie.
    pub at_sample: [Sign; 3],
    /// The same with ties broken by the nudge, so never zero unless the triangle is edge-on.
    pub decided: [Sign; 3],
    /// Whether the ray of a parallel camera meets the triangle's plane at `t > 0`. Always true for a perspective camera,
    /// for which the other signs imply `t > 0`.
    pub in_front: bool,
}

impl EdgeSigns {
    /// Whether the triangle covers the sample.
    pub fn covers(&self) -> bool {
        self.facing != Sign::Zero
            && self.decided.iter().all(|&edge| edge == self.facing)
            && self.in_front
    }
}

/// A triangle's edge functions at a sample as numbers to show. Each is computed without error and then rounded, to within
/// 2⁻⁵² of itself. Their signs are those of [`EdgeSigns`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeValues {
    /// The facing `F`.
    pub facing: f64,
    /// `E_ab`, `E_bc`, `E_ca`.
    pub at_sample: [f64; 3],
    /// The kind of each edge on which the sample lies; `None` for an edge on which it does not lie, and where the
    /// triangle is edge-on.
    pub sides: [Option<Side>; 3],
}

/// Where an edge of a triangle is, seen from its inside in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The inside is right of it: it owns its samples.
    Left,
    /// The inside is left of it: it does not own its samples.
    Right,
    /// Level, and the inside below it: it owns its samples.
    Top,
    /// Level, and the inside above it: it does not own its samples.
    Bottom,
}

impl Side {
    /// Its name in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Side::Left => "left",
            Side::Right => "right",
            Side::Top => "top",
            Side::Bottom => "bottom",
        }
    }
}

/// How a zero edge function is decided: the sample moves infinitely little along `u`, and far less
/// still against `v`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nudge {
    pub(super) u: DVec3,
    pub(super) v: DVec3,
}

/// All signs of a triangle at a sample.
pub(super) fn edge_signs(
    projection: Projection,
    nudge: &Nudge,
    triangle: &[DVec3; 3],
    ray: &Ray,
) -> EdgeSigns {
    let [a, b, c] = *triangle;
    let facing = facing(projection, triangle, ray);
    let at_sample = sample_signs(projection, triangle, ray);
    let mut decided = at_sample;
    for (sign, (p, q)) in decided.iter_mut().zip([(a, b), (b, c), (c, a)]) {
        *sign = sign.or_else(|| nudged_edge(projection, nudge, p, q, ray));
    }
    let in_front = in_front(projection, facing, triangle, ray);
    EdgeSigns { facing, at_sample, decided, in_front }
}

/// The numbers whose signs are [`edge_signs`].
pub(super) fn edge_values(
    projection: Projection,
    nudge: &Nudge,
    triangle: &[DVec3; 3],
    ray: &Ray,
) -> EdgeValues {
    let [a, b, c] = *triangle;
    let Ray { origin, direction } = *ray;
    let direction = [direction, DVec3::ZERO];
    // The eye is the origin of a perspective camera's rays.
    let edge = |(p, q)| difference_value::<Dyadic>([p, origin], [q, origin], direction).to_f64();
    let facing = match projection {
        Projection::Perspective => [a, b, c].map(|corner| [corner, DVec3::ZERO]),
        Projection::Parallel => [[b, a], [c, a], direction],
    };
    let [p, q, r] = facing;
    let signs = edge_signs(projection, nudge, triangle, ray);
    EdgeValues {
        facing: difference_value::<Dyadic>(p, q, r).to_f64(),
        at_sample: [(a, b), (b, c), (c, a)].map(edge),
        sides: edge_sides(projection, nudge, triangle, ray, &signs),
    }
}

/// On what kind of edge a sample lies that lies on one.
pub(super) fn edge_sides(
    projection: Projection,
    nudge: &Nudge,
    triangle: &[DVec3; 3],
    ray: &Ray,
    signs: &EdgeSigns,
) -> [Option<Side>; 3] {
    let [a, b, c] = *triangle;
    let edges = [(a, b), (b, c), (c, a)];
    std::array::from_fn(|index| {
        let (p, q) = edges[index];
        if signs.at_sample[index] != Sign::Zero || signs.facing == Sign::Zero {
            return None;
        }
        let is_level = edge_derivative(projection, nudge.u, p, q, ray) == Sign::Zero;
        Some(match (is_level, signs.decided[index] == signs.facing) {
            (false, true) => Side::Left,
            (false, false) => Side::Right,
            (true, true) => Side::Top,
            (true, false) => Side::Bottom,
        })
    })
}

/// The signs of `E_ab`, `E_bc`, `E_ca` at the sample itself.
pub(super) fn sample_signs(projection: Projection, [a, b, c]: &[DVec3; 3], ray: &Ray) -> [Sign; 3] {
    [(a, b), (b, c), (c, a)].map(|(p, q)| edge(projection, *p, *q, ray))
}

/// [`EdgeSigns::covers`] with these [`sample_signs`]. Two that are opposed exclude the sample, whatever the facing is:
/// most samples outside of a triangle are told by that.
pub(super) fn signs_cover(
    projection: Projection,
    nudge: &Nudge,
    triangle: &[DVec3; 3],
    ray: &Ray,
    signs: &[Sign; 3],
) -> bool {
    if signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative) {
        return false;
    }
    let [a, b, c] = *triangle;
    let facing = facing(projection, triangle, ray);
    let owns = |(sign, (p, q)): (&Sign, _)| {
        sign.or_else(|| nudged_edge(projection, nudge, p, q, ray)) == facing
    };
    facing != Sign::Zero
        && signs.iter().zip([(a, b), (b, c), (c, a)]).all(owns)
        && in_front(projection, facing, triangle, ray)
}

/// [`EdgeSigns::covers`], with no sign computed that is not needed.
pub(super) fn triangle_covers(
    projection: Projection,
    nudge: &Nudge,
    triangle: &[DVec3; 3],
    ray: &Ray,
) -> bool {
    let [a, b, c] = *triangle;
    let facing = facing(projection, triangle, ray);
    let owns = |(p, q)| {
        let edge = edge(projection, p, q, ray);
        edge.or_else(|| nudged_edge(projection, nudge, p, q, ray)) == facing
    };
    facing != Sign::Zero
        && [(a, b), (b, c), (c, a)].into_iter().all(owns)
        && in_front(projection, facing, triangle, ray)
}

/// `F = det(a, b, c)`, or for parallel rays `det(b − a, c − a, D)`.
pub(super) fn facing(projection: Projection, [a, b, c]: &[DVec3; 3], ray: &Ray) -> Sign {
    match projection {
        Projection::Perspective => determinant(*a, *b, *c),
        Projection::Parallel => {
            difference_determinant([*b, *a], [*c, *a], [ray.direction, DVec3::ZERO])
        }
    }
}

/// `E_pq = det(p − O, q − O, D)`: on which side of the edge the ray passes.
///
/// Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous Coordinates", 1997.
fn edge(projection: Projection, p: DVec3, q: DVec3, ray: &Ray) -> Sign {
    let Ray { origin, direction } = *ray;
    match projection {
        Projection::Perspective => determinant(p, q, direction),
        Projection::Parallel => {
            difference_determinant([p, origin], [q, origin], [direction, DVec3::ZERO])
        }
    }
}

/// The edge function's sign when it is zero at the sample: its derivative along the nudge.
///
/// With `D(ε₅₃) = D + ε₅₃·u − ε₅₃²·v` the edge function of a perspective camera is
/// `det(p, q, D) + ε₅₃·det(p, q, u) − ε₅₃²·det(p, q, v)`. With `O(ε₅₃) = O + ε₅₃·u − ε₅₃²·v` that of a parallel
/// camera is `det(p − O, q − O, D) + ε₅₃·det(u, p − q, D) − ε₅₃²·det(v, p − q, D)`: what is quadratic in
/// `O` cancels, since `det(O, O, D) = 0`.
fn nudged_edge(projection: Projection, nudge: &Nudge, p: DVec3, q: DVec3, ray: &Ray) -> Sign {
    let derivative = |along| edge_derivative(projection, along, p, q, ray);
    derivative(nudge.u).or_else(|| -derivative(nudge.v))
}

/// The sign of the edge function's derivative as the sample moves along an axis.
fn edge_derivative(projection: Projection, along: DVec3, p: DVec3, q: DVec3, ray: &Ray) -> Sign {
    match projection {
        Projection::Perspective => determinant(p, q, along),
        Projection::Parallel => {
            difference_determinant([along, DVec3::ZERO], [p, q], [ray.direction, DVec3::ZERO])
        }
    }
}

/// Whether `t > 0`. A covered sample of a perspective camera has it for free: `E_ab + E_bc + E_ca =
/// n·D` has the sign of `F`, and `t = F/(n·D)`.
fn in_front(projection: Projection, facing: Sign, [a, b, c]: &[DVec3; 3], ray: &Ray) -> bool {
    match projection {
        Projection::Perspective => true,
        Projection::Parallel => {
            difference_determinant([*b, *a], [*c, *a], [*a, ray.origin]) == facing
        }
    }
}

/// The sign of `det(p, q, r)` of stored vectors.
///
/// `robust` takes differences to a fourth point, here the origin: they are exact. Its error-free
/// transformations need products that neither over- nor underflow. Offsets from the eye are zero or
/// in 2⁻¹⁴⁹ … 2¹²⁹, and multiples of 2⁻¹⁴⁹. Directions are sums of products of a coordinate on the
/// viewport (zero or at least 2⁻⁸¹) or `d` and a frame component (zero or at least 2⁻¹⁰⁰): each
/// product is zero or at least 2⁻¹⁸¹, hence with its 53 bits a multiple of 2⁻²³³, and directions are
/// below 2⁶⁷. So products of three stay below 2³²⁶ and are multiples of 2⁻⁵³¹ (of three offsets: 2³⁸⁸
/// and 2⁻⁴⁴⁷), far within f64's 2¹⁰²³ and 2⁻¹⁰⁷⁴.
#[inline]
fn determinant(p: DVec3, q: DVec3, r: DVec3) -> Sign {
    let to_origin = [p, q, r].map(|v| [v, DVec3::ZERO]);
    let [from, via, to] = to_origin;
    rounded_difference_determinant(from, via, to).unwrap_or_else(|| {
        let point = |v: DVec3| Coord3D { x: v.x, y: v.y, z: v.z };
        Sign::of(orient3d(point(p), point(q), point(r), point(DVec3::ZERO)))
    })
}

/// The sign of `det(p₀ − p₁, q₀ − q₁, r₀ − r₁)`, of the real differences.
fn difference_determinant(p: [DVec3; 2], q: [DVec3; 2], r: [DVec3; 2]) -> Sign {
    rounded_difference_determinant(p, q, r).unwrap_or_else(|| exactly!(difference_sign(p, q, r)))
}

fn difference_sign<R: Real>(p: [DVec3; 2], q: [DVec3; 2], r: [DVec3; 2]) -> Option<Sign> {
    difference_value::<R>(p, q, r).sign()
}

/// The sign of the determinant of rounded differences, where it is certain: its bound takes a fraction of the time that
/// a bound of every number takes.
///
/// Each of the six products of the determinant is rounded at most eight times on its way to the sum: three times as
/// differences are taken, twice as they are multiplied, three times as products are added. So the sum is off by at most
/// `γ₈ = 8ε₅₃/(1 − 8ε₅₃)` times the real sum of the products' sizes, where `ε₅₃` is 2⁻⁵³. That sum is rounded in the same way:
/// the real one is at most `1/(1 − γ₈)` times the computed one. Both factors and the rounding of the product are below
/// `9ε₅₃`.
///
/// A product that underflows loses at most 2⁻¹⁰⁷⁵, and a third factor makes it larger. By the ranges that
/// [`determinant`] names, factors are below 2¹³¹ (parallel rays begin on the viewport, below 2⁶⁷): twelve products of
/// two and six of three, in both sums, lose less than 2⁻⁹³⁸, and nothing overflows.
fn rounded_difference_determinant(
    [p0, p1]: [DVec3; 2],
    [q0, q1]: [DVec3; 2],
    [r0, r1]: [DVec3; 2],
) -> Option<Sign> {
    const UNDERFLOWS: f64 = 1e-280;
    let (p, q, r) = (p0 - p1, q0 - q1, r0 - r1);
    let (yz, zy) = (p.y * q.z, p.z * q.y);
    let (zx, xz) = (p.z * q.x, p.x * q.z);
    let (xy, yx) = (p.x * q.y, p.y * q.x);
    let value = (yz - zy) * r.x + (zx - xz) * r.y + (xy - yx) * r.z;
    let size = (yz.abs() + zy.abs()) * r.x.abs()
        + (zx.abs() + xz.abs()) * r.y.abs()
        + (xy.abs() + yx.abs()) * r.z.abs();
    (value.abs() > 9.0 * EPS53 * size + UNDERFLOWS).then(|| Sign::of(value))
}

fn difference_value<R: Real>(
    [p0, p1]: [DVec3; 2],
    [q0, q1]: [DVec3; 2],
    [r0, r1]: [DVec3; 2],
) -> R {
    let normal = cross::<R>(&difference(p0, p1), &difference(q0, q1));
    dot(&normal, &difference(r0, r1))
}

/// Whether a plane is met: `n·D ≠ 0` and `t = n·(point − O)/(n·D) > 0`.
pub(super) fn plane_covers(point: DVec3, normal: DVec3, ray: &Ray) -> bool {
    let height = exactly!(dot_sign(normal, [point, ray.origin]));
    let descent = exactly!(dot_sign(normal, [ray.direction, DVec3::ZERO]));
    height * descent == Sign::Positive
}

/// Whether `n·v` is zero.
pub(super) fn is_perpendicular(normal: DVec3, v: DVec3) -> bool {
    exactly!(dot_sign(normal, [v, DVec3::ZERO])) == Sign::Zero
}

fn dot_sign<R: Real>(normal: DVec3, [p, q]: [DVec3; 2]) -> Option<Sign> {
    dot::<R>(&vector(normal), &difference(p, q)).sign()
}

/// Whether a sphere is met: a positive discriminant and a positive root.
pub(super) fn sphere_covers(center: DVec3, radius: f64, ray: &Ray) -> bool {
    exactly!(sphere_sign(center, radius, ray)) == Sign::Positive
}

fn sphere_sign<R: Real>(center: DVec3, radius: f64, ray: &Ray) -> Option<Sign> {
    let quadratic = Quadratic::<R>::new(center, radius, ray);
    // Inside of the sphere (C < 0) every ray leaves it. Outside and on it the ray must approach
    // (B < 0) and not miss; with C = 0 and B < 0 the discriminant is B² and the root −2B/A.
    if quadratic.c.sign()? == Sign::Negative {
        return Some(Sign::Positive);
    }
    if quadratic.b.sign()? == Sign::Negative {
        quadratic.discriminant().sign()
    } else {
        Some(Sign::Negative)
    }
}

/// A ray and a sphere: `A·t² + 2B·t + C = 0` with `A = D·D`, `B = m·D`, `C = m·m − r²`, `m = O −
/// center`.
pub(super) struct Quadratic<R> {
    pub(super) a: R,
    pub(super) b: R,
    pub(super) c: R,
    pub(super) m: [R; 3],
    pub(super) d: [R; 3],
    pub(super) radius: R,
}

impl<R: Real> Quadratic<R> {
    pub(super) fn new(center: DVec3, radius: f64, ray: &Ray) -> Self {
        let m = difference::<R>(ray.origin, center);
        let d = vector::<R>(ray.direction);
        let radius = R::new(radius);
        let (a, b) = (dot(&d, &d), dot(&m, &d));
        let c = dot(&m, &m).minus(&radius.square());
        Quadratic { a, b, c, m, d, radius }
    }

    /// `B² − A·C`, as `A·r² − |m × D|²` (Lagrange's identity): nothing of the size of `m·m` cancels, so that
    /// small spheres far away lose less to rounding.
    pub(super) fn discriminant(&self) -> R {
        let across = cross(&self.m, &self.d);
        self.a.times(&self.radius.square()).minus(&dot(&across, &across))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three differences that lie nearly in one plane, of such a size, and so far beside it.
    fn nearly_coplanar(
        size: f64,
        beside: f64,
        random: &mut impl FnMut() -> f64,
    ) -> [[DVec3; 2]; 3] {
        let mut point = |size: f64| DVec3::new(random(), random(), random()) * size;
        let [p, q] = [[point(size), point(1.0)], [point(1.0), point(size)]];
        let (along, start) = (point(1.0), point(1.0));
        let in_plane = (p[0] - p[1]) * along.x + (q[0] - q[1]) * along.y;
        let end = start + in_plane + point(beside) * in_plane.length();
        [p, q, [end, start]]
    }

    #[test]
    fn a_rounded_determinant_is_certain_of_nothing_false() {
        let mut state = 7_u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            #[expect(clippy::cast_precision_loss, reason = "53 bits")]
            let fraction = (state >> 11) as f64 / 2f64.powi(53);
            2.0 * fraction - 1.0
        };
        let (mut certain, mut open) = (0, 0);
        let sizes = [1.0, 1e-30, 1e30, 1e-140];
        let beside = [0.0, 1e-16, 1e-14];
        let kinds = sizes.into_iter().flat_map(|size| beside.map(|beside| (size, beside)));
        for (size, beside) in kinds.cycle().take(100_000) {
            let [p, q, r] = nearly_coplanar(size, beside, &mut random);
            let exact = difference_sign::<Dyadic>(p, q, r);
            match rounded_difference_determinant(p, q, r) {
                None => open += 1,
                sign => {
                    assert_eq!(sign, exact, "{p:?} {q:?} {r:?}");
                    certain += 1;
                }
            }
        }
        assert!(certain > 20_000 && open > 20_000, "{certain} certain, {open} open");
    }

    #[test]
    fn a_rounded_determinant_leaves_zeros_and_underflows_open() {
        let axis = [DVec3::X, DVec3::ZERO];
        assert_eq!(rounded_difference_determinant(axis, axis, axis), None);
        let tiny = [DVec3::Y * 1e-150, DVec3::ZERO];
        let least = [DVec3::Z * 1e-150, DVec3::ZERO];
        assert_eq!(rounded_difference_determinant(axis, tiny, least), None);
        assert_eq!(difference_determinant(axis, tiny, least), Sign::Positive);
    }
}
