//! The judge: Cramer's rule for where a nudged ray meets a primitive, in exact numbers.
//!
//! A triangle's weights α, β and the distance t solve
//!
//! ```text
//! O(ε) + t·D(ε) = a + α·(b − a) + β·(c − a)
//! ```
//!
//! where ε is infinitely small and moves the sample to the right, and its square down: a perspective
//! camera has `O = 0` and `D(ε) = D + ε·u − ε²·v`, a parallel one `O(ε) = O + ε·u − ε²·v`.

use crate::algebra::{
    Fraction, Polynomial, Root, Scale, Vector, combine, determinant, difference, dot, rational,
};
use bothways_common::glam::DVec3;
use bothways_common::{Camera, Primitive, Projection, Ray};
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use std::cmp::Ordering;

/// Decides for the samples of one camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct IndependentJudge {
    projection: Projection,
    u: DVec3,
    v: DVec3,
}

/// What is true of one primitive and one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coverage {
    /// Whether the primitive covers the sample.
    pub(crate) covers: bool,
    /// Whether the sample lies exactly on the outline: a triangle's edge or corner, or where the
    /// ray touches a sphere.
    pub(crate) on_edge: bool,
}

/// What is true of two primitives that cover one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Precedence {
    /// Whether the first is seen rather than the second.
    pub(crate) first_is_seen: bool,
    /// Whether the ray of the sample itself meets both at the same distance.
    pub(crate) tie: bool,
}

/// Where the nudged ray meets the plane of a triangle.
struct Crossing {
    /// Of `a`, `b` and `c`; together 1.
    weights: [Fraction; 3],
    t: Fraction,
}

/// The exact distance of a primitive.
enum Distance {
    /// On the nudged ray.
    Flat(Fraction),
    /// On the ray of the sample itself.
    Round(Root),
}

impl IndependentJudge {
    /// The judge of one camera's samples.
    pub(crate) fn new(camera: &Camera) -> IndependentJudge {
        IndependentJudge { projection: camera.projection(), u: camera.u(), v: camera.v() }
    }

    /// Whether a primitive covers the sample of this ray.
    pub(crate) fn coverage(&self, primitive: &Primitive, ray: &Ray) -> Coverage {
        match primitive {
            Primitive::Triangle(corners) => self.triangle_coverage(corners, ray),
            Primitive::Sphere { center, radius } => sphere_coverage(*center, *radius, ray),
            Primitive::Plane { point, normal } => {
                let t = self.plane_distance(*point, *normal, ray);
                Coverage { covers: t.is_some_and(|t| in_front(&t)), on_edge: false }
            }
        }
    }

    /// Which of two primitives, given with their ids, is seen; both cover the sample.
    pub(crate) fn precedence(
        &self,
        (first_id, first): (u32, &Primitive),
        (second_id, second): (u32, &Primitive),
        ray: &Ray,
    ) -> Precedence {
        let (first, second) = (self.distance(first, ray), self.distance(second, ray));
        let at_sample = order_at_sample(&first, &second);
        let order = at_sample.then_with(|| match (&first, &second) {
            (Distance::Flat(first), Distance::Flat(second)) => first.order(second),
            (Distance::Flat(_), Distance::Round(_)) => Ordering::Less,
            (Distance::Round(_), Distance::Flat(_)) => Ordering::Greater,
            (Distance::Round(_), Distance::Round(_)) => Ordering::Equal,
        });
        Precedence {
            first_is_seen: order.then(first_id.cmp(&second_id)).is_lt(),
            tie: at_sample.is_eq(),
        }
    }

    /// The order of the exact distance of a primitive that covers the sample, and a number.
    pub(crate) fn order_with(&self, primitive: &Primitive, ray: &Ray, number: f64) -> Ordering {
        let number = rational(number);
        match self.distance(primitive, ray) {
            Distance::Flat(t) => value_at_sample(&t).cmp(&number),
            Distance::Round(root) => root.order_with(&number),
        }
    }

    fn triangle_coverage(&self, corners: &[DVec3; 3], ray: &Ray) -> Coverage {
        let missed = Coverage { covers: false, on_edge: false };
        if self.is_edge_on(corners, ray) {
            return missed;
        }
        let Some(Crossing { weights, t }) = self.crossing(corners, ray) else { return missed };
        if !in_front(&t) {
            return missed;
        }
        // In front of the eye at the sample itself, so that the weights exist there, too.
        let at_sample = weights
            .each_ref()
            .map(|weight| weight.numerator.at_zero().sign() * weight.denominator.at_zero().sign());
        Coverage {
            covers: weights.iter().all(|weight| weight.sign() == Sign::Plus),
            on_edge: at_sample.iter().min() == Some(&Sign::NoSign),
        }
    }

    /// Whether the triangle's plane holds the eye (perspective) or the viewing direction (parallel),
    /// or there is no such plane.
    fn is_edge_on(&self, corners: &[DVec3; 3], ray: &Ray) -> bool {
        let scale = Scale::of(corners.iter().copied().chain([ray.direction]));
        let [a, b, c] = corners.map(|corner| scale.vector(corner));
        let facing = match self.projection {
            Projection::Perspective => determinant(&a, &b, &c),
            Projection::Parallel => {
                let direction = scale.vector(ray.direction);
                determinant(&difference(&b, &a), &difference(&c, &a), &direction)
            }
        };
        facing.sign() == Sign::NoSign
    }

    fn crossing(&self, corners: &[DVec3; 3], ray: &Ray) -> Option<Crossing> {
        let scale = self.scale(corners, ray);
        let (origin, direction) = self.nudged(scale, ray);
        let [a, b, c] = corners.map(|corner| scale.vector(corner));
        // α·(b − a) + β·(c − a) + t·(−D) = O − a.
        let (ab, ac) = (difference(&b, &a), difference(&c, &a));
        let (back, right_side) = (direction.map(|x| -&x), difference(&origin, &a));
        let denominator = determinant(&ab, &ac, &back);
        if denominator.sign() == Sign::NoSign {
            return None;
        }
        let of = |numerator| Fraction { numerator, denominator: denominator.clone() };
        let alpha = determinant(&right_side, &ac, &back);
        let beta = determinant(&ab, &right_side, &back);
        let rest = &(&denominator - &alpha) - &beta;
        let t = determinant(&ab, &ac, &right_side);
        Some(Crossing { weights: [of(rest), of(alpha), of(beta)], t: of(t) })
    }

    fn plane_distance(&self, point: DVec3, normal: DVec3, ray: &Ray) -> Option<Fraction> {
        let scale = self.scale(&[point, normal], ray);
        let (origin, direction) = self.nudged(scale, ray);
        let (point, normal) = (scale.vector(point), scale.vector(normal));
        let numerator = dot(&normal, &difference(&point, &origin));
        let denominator = dot(&normal, &direction);
        (denominator.sign() != Sign::NoSign).then_some(Fraction { numerator, denominator })
    }

    fn distance(&self, primitive: &Primitive, ray: &Ray) -> Distance {
        let distance = match primitive {
            Primitive::Triangle(corners) => {
                self.crossing(corners, ray).map(|crossing| Distance::Flat(crossing.t))
            }
            Primitive::Plane { point, normal } => {
                self.plane_distance(*point, *normal, ray).map(Distance::Flat)
            }
            Primitive::Sphere { center, radius } => {
                Root::smallest_positive(quadratic(*center, *radius, ray)).map(Distance::Round)
            }
        };
        distance.expect("the primitive covers the sample")
    }

    /// One scale for everything that the nudged ray and a primitive are made of.
    fn scale(&self, vectors: &[DVec3], ray: &Ray) -> Scale {
        let camera = [ray.origin, ray.direction, self.u, self.v];
        Scale::of(vectors.iter().copied().chain(camera))
    }

    /// `O(ε)` and `D(ε)`.
    fn nudged(&self, scale: Scale, ray: &Ray) -> (Vector, Vector) {
        let (origin, direction) = (scale.vector(ray.origin), scale.vector(ray.direction));
        let nudge = combine(&scale.vector(self.u), &scale.vector(self.v), |u, v| {
            &u.times_epsilon(1) - &v.times_epsilon(2)
        });
        match self.projection {
            Projection::Perspective => (origin, combine(&direction, &nudge, |d, n| d + n)),
            Projection::Parallel => (combine(&origin, &nudge, |o, n| o + n), direction),
        }
    }
}

fn sphere_coverage(center: DVec3, radius: f64, ray: &Ray) -> Coverage {
    let quadratic = quadratic(center, radius, ray);
    // Touched where the parabola's lowest point lies on the axis: there b² = 4ac.
    let [c, b, a] = &quadratic;
    let touched = b * b == BigInt::from(4) * a * c;
    Coverage { covers: Root::smallest_positive(quadratic).is_some(), on_edge: touched }
}

/// `|O + t·D − center|² − radius²`, lowest power of t first.
fn quadratic(center: DVec3, radius: f64, ray: &Ray) -> [BigInt; 3] {
    let lengths = [center, DVec3::splat(radius), ray.origin, ray.direction];
    let scale = Scale::of(lengths);
    let [center, radius, origin, direction] = lengths.map(|vector| scale.vector(vector));
    let offset = difference(&origin, &center);
    let across = dot(&offset, &direction);
    let outside = &dot(&offset, &offset) - &(&radius[0] * &radius[0]);
    [outside, &across + &across, dot(&direction, &direction)].map(|power| power.at_zero())
}

/// Whether the crossing exists and is in front of the eye, judged at the sample itself.
fn in_front(t: &Fraction) -> bool {
    t.numerator.at_zero().sign() * t.denominator.at_zero().sign() == Sign::Plus
}

fn value_at_sample(t: &Fraction) -> BigRational {
    t.at_zero().expect("what covers the sample is crossed there")
}

fn order_at_sample(first: &Distance, second: &Distance) -> Ordering {
    match (first, second) {
        (Distance::Flat(first), Distance::Flat(second)) => {
            value_at_sample(first).cmp(&value_at_sample(second))
        }
        (Distance::Flat(first), Distance::Round(second)) => {
            second.order_with(&value_at_sample(first)).reverse()
        }
        (Distance::Round(first), Distance::Flat(second)) => {
            first.order_with(&value_at_sample(second))
        }
        (Distance::Round(first), Distance::Round(second)) => first.clone().order(second.clone()),
    }
}

/// The exact edge function `det(p − O, q − O, D)`, for tests that compare a rounded one with it.
pub(crate) fn edge_function(p: DVec3, q: DVec3, ray: &Ray) -> Polynomial {
    let vectors = [p, q, ray.origin, ray.direction];
    let scale = Scale::of(vectors);
    let [p, q, origin, direction] = vectors.map(|vector| scale.vector(vector));
    determinant(&difference(&p, &origin), &difference(&q, &origin), &direction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bothways_common::CameraDescription;

    /// A camera whose samples are at −1.5, −0.5, 0.5 and 1.5, with d = 1.
    fn camera(projection: Projection) -> Camera {
        let description = CameraDescription {
            projection,
            viewport: [4.0, 4.0],
            image: [4, 4],
            ..CameraDescription::default()
        };
        Camera::new(description).unwrap()
    }

    fn triangle(corners: [[f64; 3]; 3]) -> Primitive {
        Primitive::Triangle(corners.map(DVec3::from_array))
    }

    /// The picture of what a primitive covers, `#`, and beside it of what lies on its outline, `+`.
    fn picture(projection: Projection, primitive: &Primitive) -> [String; 4] {
        let camera = camera(projection);
        let judge = IndependentJudge::new(&camera);
        std::array::from_fn(|i| {
            let row = i.try_into().unwrap();
            let coverage = |j| judge.coverage(primitive, &camera.viewing_ray(row, j));
            let covered = (0..4).map(|j| if coverage(j).covers { '#' } else { '.' });
            let outline = (0..4).map(|j| if coverage(j).on_edge { '+' } else { '.' });
            covered.chain([' ']).chain(outline).collect()
        })
    }

    #[test]
    fn left_and_top_edges_own_their_samples() {
        // The right angle at the top left: all edges run through samples. Twice as far and twice as
        // large is the same for a perspective camera.
        let top_left = [[-1.5, 1.5, -1.0], [1.5, 1.5, -1.0], [-1.5, -1.5, -1.0]];
        let owned = ["###. ++++", "##.. +.+.", "#... ++..", ".... +..."];
        let far = top_left.map(|corner| corner.map(|x| 2.0 * x));
        assert_eq!(picture(Projection::Perspective, &triangle(top_left)), owned);
        assert_eq!(picture(Projection::Perspective, &triangle(far)), owned);
        assert_eq!(picture(Projection::Parallel, &triangle(top_left)), owned);
        // Seen from behind, nothing changes.
        let [a, b, c] = top_left;
        assert_eq!(picture(Projection::Perspective, &triangle([a, c, b])), owned);
        // The other half of the square owns the diagonal, and neither its right nor its bottom edge.
        let bottom_right = [[1.5, -1.5, -1.0], [-1.5, -1.5, -1.0], [1.5, 1.5, -1.0]];
        let rest = [".... ...+", "..#. ..++", ".##. .+.+", ".... ++++"];
        assert_eq!(picture(Projection::Perspective, &triangle(bottom_right)), rest);
    }

    #[test]
    fn what_reaches_behind_the_eye_is_covered_before_it_only() {
        // A strip of the floor y = −1 from far behind the eye to z = −2, where it is seen at
        // y = −0.5: the bottom row, at y = −1.5, meets it at z = −2/3; the row at −0.5 at its end,
        // which is its top edge.
        let floor = triangle([[-40.0, -1.0, -2.0], [40.0, -1.0, -2.0], [0.0, -1.0, 90.0]]);
        let owned = [".... ....", ".... ....", "#### ++++", "#### ...."];
        assert_eq!(picture(Projection::Perspective, &floor), owned);
        let behind = triangle([[-9.0, 9.0, 1.0], [9.0, 9.0, 1.0], [0.0, -18.0, 1.0]]);
        for projection in [Projection::Perspective, Projection::Parallel] {
            assert_eq!(picture(projection, &behind), [".... ...."; 4]);
        }
    }

    #[test]
    fn a_silhouette_met_exactly_shows_its_front() {
        // A wedge whose edge x = 0.5, z = −1 lies on the samples of a column; its two faces go right
        // from there, one to z = −1 and one to z = −3, farther. All ids favour the farther one.
        let front = triangle([[0.5, 9.0, -1.0], [0.5, -9.0, -1.0], [9.5, 0.0, -1.0]]);
        let back = triangle([[0.5, 9.0, -1.0], [0.5, -9.0, -1.0], [9.5, 0.0, -3.0]]);
        for projection in [Projection::Perspective, Projection::Parallel] {
            let camera = camera(projection);
            let judge = IndependentJudge::new(&camera);
            let ray = camera.viewing_ray(1, 2);
            assert!(judge.coverage(&front, &ray).covers && judge.coverage(&back, &ray).covers);
            let precedence = judge.precedence((9, &front), (2, &back), &ray);
            assert_eq!(precedence, Precedence { first_is_seen: true, tie: true });
            // The same face twice: the first in the scene.
            let precedence = judge.precedence((9, &front), (2, &front), &ray);
            assert_eq!(precedence, Precedence { first_is_seen: false, tie: true });
        }
    }

    #[test]
    fn spheres_are_touched_missed_and_seen_from_inside() {
        let camera = camera(Projection::Parallel);
        let judge = IndependentJudge::new(&camera);
        let ray = camera.viewing_ray(1, 2);
        let sphere = |x, z, radius| Primitive::Sphere { center: DVec3::new(x, 0.5, z), radius };
        let coverage = |primitive| judge.coverage(&primitive, &ray);
        assert_eq!(coverage(sphere(2.5, -5.0, 2.0)), Coverage { covers: false, on_edge: true });
        assert!(coverage(sphere(2.5, -5.0, 2.125)).covers);
        // Five across three and four: met at −5 + 4 and at −5 − 4.
        let ball = sphere(3.5, -5.0, 5.0);
        assert_eq!(judge.order_with(&ball, &ray, 1.0), Ordering::Equal);
        // Around the origin of the ray: the far wall, at 4 − 2.
        let around = sphere(3.5, 2.0, 5.0);
        assert_eq!(judge.order_with(&around, &ray, 2.0), Ordering::Equal);
        // The origin on the sphere: the far wall, or nothing.
        assert_eq!(judge.order_with(&sphere(3.5, -4.0, 5.0), &ray, 8.0), Ordering::Equal);
        assert!(!coverage(sphere(3.5, 4.0, 5.0)).covers);
        // Flat before round, where they touch.
        let wall = Primitive::Plane { point: DVec3::new(7.0, 7.0, -1.0), normal: DVec3::Z };
        let precedence = judge.precedence((9, &wall), (2, &ball), &ray);
        assert_eq!(precedence, Precedence { first_is_seen: true, tie: true });
        // Irrational distances: 5 − √(r² − 9), equal for both, then not.
        let other = Primitive::Sphere { center: DVec3::new(0.5, -2.5, -5.0), radius: 4.0 };
        let near = judge.precedence((1, &sphere(3.5, -5.0, 4.0)), (2, &other), &ray);
        assert_eq!(near, Precedence { first_is_seen: true, tie: true });
        let near =
            judge.precedence((1, &sphere(3.5, -5.0, 4.0_f64.next_down())), (2, &other), &ray);
        assert_eq!(near, Precedence { first_is_seen: false, tie: false });
    }
}
