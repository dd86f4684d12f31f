//! Questions that rounded arithmetic answers wrongly: found by search, counted, and put to the
//! library, whose filter must refuse to answer them.
//!
//! Stored numbers have 24 bits and leave little room below the rounding of `f64`. Three ways lead
//! there: an offset from the eye of 53 bits, where a vertex lies next to the world's origin and the
//! eye does not; edges and planes that point nearly at the eye; and far small spheres.

use crate::cases::{Case, few_bits, projection, triangle, turned_camera};
use crate::judge::{Coverage, IndependentJudge, edge_function};
use crate::{Judges, confirm_case, runner};
use bothways_common::exact::CachedJudge;
use bothways_common::glam::{DVec3, Vec3};
use bothways_common::{
    Camera, CameraDescription, Orientation, Primitive, Projection, Ray, Shape, Sphere, Triangle,
    View,
};
use num_bigint::Sign;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use std::cmp::Ordering;

/// How often plain `f64` arithmetic was wrong.
#[derive(Clone, Copy, Debug, Default)]
struct Wrong {
    /// An edge function with the opposite sign.
    edge_signs: u32,
    /// An edge function of zero that rounds to something else.
    edges_not_zero: u32,
    /// An edge function that rounds to zero and is not.
    edges_zero: u32,
    /// A triangle that covers a sample not exactly on its outline, and is said not to, or the
    /// reverse.
    triangles: u32,
    /// The farther of two primitives taken for the nearer.
    orders: u32,
    /// Equal distances that round to different ones.
    equal_distances: u32,
    /// Different distances that round to equal ones.
    different_distances: u32,
    /// A sphere hit that is missed, or missed that is hit.
    spheres: u32,
}

/// Asks plain arithmetic and the exact judge the same questions about one sample.
fn count_wrong(judges: &Judges, primitives: &[(u32, Primitive)], ray: &Ray, wrong: &mut Wrong) {
    let mut covering = Vec::new();
    for (id, primitive) in primitives {
        let Coverage { covers, on_edge } = judges.truth.coverage(primitive, ray);
        match primitive {
            Primitive::Triangle([a, b, c]) => {
                let edges = [(a, b), (b, c), (c, a)];
                for (p, q) in edges {
                    count_wrong_edge(*p, *q, ray, wrong);
                }
                let signs = edges.map(|(p, q)| rounded_edge(*p, *q, ray));
                let inside = signs.iter().all(|&e| e > 0.0) || signs.iter().all(|&e| e < 0.0);
                let rounded = inside && rounded_distance(primitive, ray) > 0.0;
                wrong.triangles += u32::from(!on_edge && rounded != covers);
            }
            Primitive::Sphere { center, radius } => {
                wrong.spheres += u32::from(rounded_sphere(*center, *radius, ray) != covers);
            }
            Primitive::Plane { .. } => {}
        }
        if covers {
            covering.push((*id, primitive));
        }
    }
    for (index, &first) in covering.iter().enumerate() {
        for &second in &covering[index + 1..] {
            count_wrong_order(&judges.truth, first, second, ray, wrong);
        }
    }
}

fn count_wrong_edge(p: DVec3, q: DVec3, ray: &Ray, wrong: &mut Wrong) {
    let rounded = rounded_edge(p, q, ray);
    let exact = edge_function(p, q, ray).sign();
    match (rounded.total_cmp(&0.0), exact) {
        _ if rounded == 0.0 => wrong.edges_zero += u32::from(exact != Sign::NoSign),
        (_, Sign::NoSign) => wrong.edges_not_zero += 1,
        (Ordering::Greater, Sign::Minus) | (Ordering::Less, Sign::Plus) => wrong.edge_signs += 1,
        _ => {}
    }
}

fn count_wrong_order(
    truth: &IndependentJudge,
    first: (u32, &Primitive),
    second: (u32, &Primitive),
    ray: &Ray,
    wrong: &mut Wrong,
) {
    let exact = truth.precedence(first, second, ray);
    let (t, s) = (rounded_distance(first.1, ray), rounded_distance(second.1, ray));
    if exact.tie {
        wrong.equal_distances += u32::from(t != s);
    } else if t == s {
        wrong.different_distances += 1;
    } else {
        wrong.orders += u32::from((t < s) != exact.first_is_seen);
    }
}

fn rounded_edge(p: DVec3, q: DVec3, ray: &Ray) -> f64 {
    (p - ray.origin).cross(q - ray.origin).dot(ray.direction)
}

/// Distances as a textbook has them.
fn rounded_distance(primitive: &Primitive, ray: &Ray) -> f64 {
    match *primitive {
        Primitive::Triangle([a, b, c]) => {
            let normal = (b - a).cross(c - a);
            normal.dot(a - ray.origin) / normal.dot(ray.direction)
        }
        Primitive::Plane { point, normal } => {
            normal.dot(point - ray.origin) / normal.dot(ray.direction)
        }
        Primitive::Sphere { center, radius } => {
            let [a, b, c] = rounded_quadratic(center, radius, ray);
            let root = (b * b - a * c).sqrt();
            if c > 0.0 { (-b - root) / a } else { (-b + root) / a }
        }
    }
}

fn rounded_sphere(center: DVec3, radius: f64, ray: &Ray) -> bool {
    let [a, b, c] = rounded_quadratic(center, radius, ray);
    b * b - a * c > 0.0 && (c < 0.0 || b < 0.0)
}

/// `a·t² + 2b·t + c`.
fn rounded_quadratic(center: DVec3, radius: f64, ray: &Ray) -> [f64; 3] {
    let offset = ray.origin - center;
    let b = offset.dot(ray.direction);
    [ray.direction.length_squared(), b, offset.length_squared() - radius * radius]
}

/// Puts many cases to both judges, and counts what plain arithmetic would have got wrong.
fn search(cases: u32, pictures: impl Strategy<Value = Case>) -> Wrong {
    let mut runner = runner(cases);
    let mut wrong = Wrong::default();
    for _ in 0..runner.config().cases {
        let case = pictures.new_tree(&mut runner).expect("cases are found").current();
        let (camera, scene) = (case.camera(), case.scene());
        let judges = Judges::new(&camera);
        let view = View::new(&scene, &camera);
        let primitives: Vec<_> =
            (0..).zip(view.primitives().map(|(_, primitive)| primitive)).collect();
        let [x, y] = case.points[0];
        let ray = camera.ray_through(x, y);
        count_wrong(&judges, &primitives, &ray, &mut wrong);
        let mut cached = CachedJudge::new(judges.library);
        judges
            .confirm(&mut cached, &primitives, &ray)
            .unwrap_or_else(|error| panic!("{error}\n{case:?}"));
    }
    println!("plain arithmetic on {} near misses: {wrong:?}", runner.config().cases);
    wrong
}

/// A canonical camera with its eye moved so that the first corner or centre comes to lie next to
/// the world's origin: its offset, but for this step, is as given, and has 53 bits.
///
/// All shapes are given by their offsets from the eye.
fn beside_the_origin(
    projection: Projection,
    mut shapes: Vec<Shape>,
    point: [f64; 2],
    step: Vec3,
) -> Case {
    let anchor = match shapes[0] {
        Shape::Triangle(Triangle { a, .. }) => a,
        Shape::Sphere(Sphere { center, .. }) => center,
        Shape::Plane(_) | Shape::Mesh(_) | Shape::Instances(_) => {
            unreachable!("no such shape comes first")
        }
    };
    for shape in &mut shapes {
        match shape {
            Shape::Triangle(Triangle { a, b, c }) => {
                [*a, *b, *c] = [*a, *b, *c].map(|p| p - anchor);
            }
            Shape::Sphere(Sphere { center, .. }) => *center -= anchor,
            Shape::Plane(plane) => plane.point -= anchor,
            Shape::Mesh(_) | Shape::Instances(_) => unreachable!("no mesh is used"),
        }
    }
    match &mut shapes[0] {
        Shape::Triangle(Triangle { a: first, .. })
        | Shape::Sphere(Sphere { center: first, .. }) => *first = step,
        Shape::Plane(_) | Shape::Mesh(_) | Shape::Instances(_) => {
            unreachable!("no such shape comes first")
        }
    }
    let camera = CameraDescription {
        projection,
        eye: -anchor,
        viewport: [4.0, 4.0],
        image: [1, 1],
        ..CameraDescription::default()
    };
    Case { camera, shapes, points: vec![point] }
}

/// A step of a few units of the 53rd bit, or none.
fn tiny_step() -> impl Strategy<Value = Vec3> {
    let one =
        (-3..=3_i8, 50..=54_u8).prop_map(|(k, bits)| f32::from(k) * (-f32::from(bits)).exp2());
    [one.clone(), one.clone(), one].prop_map(Vec3::from_array)
}

/// A number between −2 and 2 with this many bits behind the point.
///
/// Few enough that corners made of such numbers are exact in `f32`, and enough that the products of
/// three of them need more than the 53 bits of an `f64`.
fn short(bits: u8) -> impl Strategy<Value = f32> {
    let one = 1_i32 << bits;
    (1 - 2 * one..2 * one).prop_map(move |k| k as f32 / one as f32)
}

/// A ray through a point with fourteen bits, by its origin and direction.
fn short_ray() -> impl Strategy<Value = (Projection, [f32; 2], [Vec3; 2])> {
    (projection(), [short(14), short(14)]).prop_map(|(projection, point)| {
        let across = Vec3::new(point[0], point[1], 0.0);
        let ray = match projection {
            Projection::Perspective => [Vec3::ZERO, across - Vec3::Z],
            Projection::Parallel => [across, Vec3::NEG_Z],
        };
        (projection, point, ray)
    })
}

/// Triangles with an edge through the ray, but for a tiny step of one end.
fn edges_beside_the_ray() -> impl Strategy<Value = Case> {
    let distances = [1..=255_u8, 1..=255_u8];
    let across = [short(14), short(14), short(14)].prop_map(Vec3::from_array);
    let ends = ([short(6), short(6)], across, distances, few_bits());
    (short_ray(), ends, tiny_step()).prop_map(
        |((projection, point, [origin, direction]), ends, step)| {
            let ([left, right], across, distances, third) = ends;
            let [near, far] = distances.map(|k| origin + f32::from(k) / 64.0 * direction);
            let (a, b) = (near + left * across, far + right * across);
            let c = origin + 2.0 * direction + third;
            let shapes = vec![triangle([a, b, c]), triangle([b, a, 2.0 * far - c])];
            beside_the_origin(projection, shapes, point.map(f64::from), step)
        },
    )
}

/// Two triangles in one plane, but for a tiny step of one corner.
fn planes_beside_each_other() -> impl Strategy<Value = Case> {
    let plane = ([few_bits(), few_bits()], [1..=4_u8, 1..=4_u8, 1..=4_u8, 1..=4_u8]);
    (short_ray(), plane, tiny_step()).prop_map(
        |((projection, point, [origin, direction]), ([e, f], factors), step)| {
            let middle = origin + 2.0 * direction;
            let [i, j, k, l] = factors.map(f32::from);
            let first = triangle([middle + i * e, middle + j * f, middle - e - f]);
            let second = triangle([middle - k * e, middle - l * f, middle + e + f]);
            beside_the_origin(projection, vec![first, second], point.map(f64::from), step)
        },
    )
}

/// Two large triangles in one plane, in numbers of few bits, under a turned camera: its rays have 53.
fn one_plane_under_a_turned_camera() -> impl Strategy<Value = Case> {
    (turned_ray(), [few_bits(), few_bits(), few_bits()]).prop_map(
        |((camera, _, point), [middle, e, f])| {
            let at = |i: f32, j: f32| middle + i * e + j * f;
            let first = triangle([at(-16.0, -16.0), at(32.0, 0.0), at(0.0, 32.0)]);
            let second = triangle([at(20.0, 19.0), at(-40.0, 3.0), at(5.0, -40.0)]);
            Case { camera, shapes: vec![first, second], points: vec![point] }
        },
    )
}

/// A sphere and a triangle that meet the ray at one point, but for a tiny step of the sphere; and a
/// second sphere, the mirror image of the first.
fn spheres_beside_a_point() -> impl Strategy<Value = Case> {
    let radius = proptest::sample::select(
        &[([0.0, 0.0, -1.0], 1.0), ([1.0, 2.0, -2.0], 3.0), ([3.0, 0.0, -4.0], 5.0)][..],
    );
    (short_ray(), radius, [few_bits(), few_bits()], tiny_step()).prop_map(
        |((projection, point, [origin, direction]), (to_center, radius), [e, f], step)| {
            let middle = origin + 2.0 * direction;
            let spheres = [to_center, [-to_center[1], to_center[0], to_center[2]]].map(|offset| {
                Shape::Sphere(Sphere { center: middle + Vec3::from_array(offset), radius })
            });
            let face = triangle([middle + e, middle + f, middle - e - f]);
            let shapes = spheres.into_iter().chain([face]).collect();
            beside_the_origin(projection, shapes, point.map(f64::from), step)
        },
    )
}

/// What a turned camera sees along one ray, at two depths.
fn turned_ray() -> impl Strategy<Value = (CameraDescription, Ray, [f64; 2])> {
    let along = (-0.5..0.5_f64, -0.5..0.5_f64);
    (turned_camera(), along).prop_filter_map("an accepted camera", |(description, (x, y))| {
        let description = CameraDescription { image: [1, 1], ..description };
        let ray = Camera::new(description).ok()?.ray_through(x, y);
        Some((description, ray, [x, y]))
    })
}

/// Triangles with an edge along the ray, as well as `f32` can say it.
fn edges_along_the_ray() -> impl Strategy<Value = Case> {
    (turned_ray(), 0.5..2.0_f64, 3.0..20.0_f64, [few_bits(), few_bits()]).prop_map(
        |((camera, ray, point), near, far, thirds)| {
            let at = |t: f64| camera.eye + (ray.origin + t * ray.direction).as_vec3();
            let shapes = thirds.map(|third| triangle([at(near), at(far), at(near) + third]));
            Case { camera, shapes: shapes.to_vec(), points: vec![point] }
        },
    )
}

/// Small spheres that a ray passes as closely as the last bit of their radius can say it.
fn far_spheres() -> impl Strategy<Value = Case> {
    (turned_ray(), 4.0..40.0_f64, -16..=-8_i8, few_bits()).prop_filter_map(
        "a radius",
        |((camera, ray, point), t, exponent, aside)| {
            let aside = ray.direction.cross(aside.as_dvec3()).normalize_or_zero();
            let middle = ray.origin + t * ray.direction + f64::from(exponent).exp2() * t * aside;
            let center = (camera.eye.as_dvec3() + middle).as_vec3();
            let offset = center.as_dvec3() - camera.eye.as_dvec3() - ray.origin;
            let distance = offset.cross(ray.direction).length() / ray.direction.length();
            let radius = DVec3::splat(distance).as_vec3().x;
            let sphere = |radius| Shape::Sphere(Sphere { center, radius });
            let shapes = [radius.next_down(), radius, radius.next_up()].map(sphere);
            (radius > 0.0).then(|| Case { camera, shapes: shapes.to_vec(), points: vec![point] })
        },
    )
}

#[test]
fn edges_whose_rounded_sign_is_wrong() {
    let beside = search(4000, edges_beside_the_ray());
    assert!(beside.edge_signs >= 50 && beside.edges_zero >= 50, "{beside:?}");
    assert!(beside.edges_not_zero >= 50 && beside.triangles >= 50, "{beside:?}");
    let along = search(6000, edges_along_the_ray());
    assert!(along.edge_signs >= 50 && along.triangles >= 25, "{along:?}");
}

#[test]
fn distances_whose_rounded_order_is_wrong() {
    let planes = search(3000, planes_beside_each_other());
    assert!(planes.orders >= 50 && planes.different_distances >= 50, "{planes:?}");
    let one_plane = search(2000, one_plane_under_a_turned_camera());
    assert!(one_plane.equal_distances >= 50, "{one_plane:?}");
    let spheres = search(3000, spheres_beside_a_point());
    assert!(spheres.orders >= 50 && spheres.different_distances >= 50, "{spheres:?}");
}

#[test]
fn spheres_whose_rounded_discriminant_is_wrong() {
    let far = search(3000, far_spheres());
    assert!(far.spheres >= 50, "{far:?}");
}

#[test]
fn a_distance_over_a_rounded_zero_is_finite() {
    // The corners' z differ by 2⁵³ ± ½, which rounds to 2⁵³ both times, and n·D to zero.
    let far = 53f32.exp2();
    let corners = [[-0.5, 0.0, 0.5], [0.0, 1.0, far], [0.5, -1.0, -far]].map(Vec3::from_array);
    let orientation = Orientation::Direction { direction: Vec3::X, up: Vec3::Y };
    let camera = CameraDescription { orientation, image: [1, 1], ..CameraDescription::default() };
    let case = Case { camera, shapes: vec![triangle(corners)], points: vec![] };
    let tally = confirm_case(&case).unwrap();
    assert_eq!((tally.covered, tally.edge_ties), (1, 1));
}
