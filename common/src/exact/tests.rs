use super::*;
use crate::{Camera, Primitive, Projection};
use glam::DVec3;
use std::cmp::Ordering;

fn point(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A camera whose pixel centres are the integer points −2 … 2 at distance 1.
fn five_by_five(projection: Projection) -> Camera {
    Camera::new(crate::CameraDescription {
        projection,
        viewport: [5.0, 5.0],
        image: [5, 5],
        ..Default::default()
    })
    .unwrap()
}

/// The samples that a triangle owns, a string a row.
fn owned(projection: Projection, corners: [[f64; 2]; 3]) -> Vec<String> {
    let camera = five_by_five(projection);
    let judge = Judge::new(&camera);
    let triangle = Primitive::Triangle(corners.map(|[x, y]| point(x, y, -1.0)));
    let covers = |i, j| judge.covers(&triangle, &camera.viewing_ray(i, j));
    (0..5).map(|i| (0..5).map(|j| if covers(i, j) { '1' } else { '.' }).collect()).collect()
}

#[test]
fn left_and_top_edges_own_their_samples() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        // A square from −1 to 1, cut along its diagonal: together the left and the top sides.
        let lower = owned(projection, [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]);
        assert_eq!(lower, [".....", ".....", ".1...", ".....", "....."].map(String::from));
        let upper = owned(projection, [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]]);
        assert_eq!(upper, [".....", ".11..", "..1..", ".....", "....."].map(String::from));
    }
}

#[test]
fn either_winding_covers_the_same() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        let one = owned(projection, [[-2.0, -1.0], [2.0, -2.0], [1.0, 2.0]]);
        let other = owned(projection, [[2.0, -2.0], [-2.0, -1.0], [1.0, 2.0]]);
        assert_eq!(one, other);
        assert!(one.concat().contains('1'));
    }
}

#[test]
fn what_is_behind_the_eye_is_not_seen() {
    let camera = five_by_five(Projection::Parallel);
    let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
    let at =
        |z| Primitive::Triangle([point(-3.0, -3.0, z), point(3.0, -3.0, z), point(0.0, 5.0, z)]);
    assert!(judge.covers(&at(-1.0), &ray));
    assert!(!judge.covers(&at(0.0), &ray));
    assert!(!judge.covers(&at(1.0), &ray));
    let plane = |z| Primitive::Plane { point: point(7.0, 7.0, z), normal: point(0.0, 0.0, 1.0) };
    assert!(judge.covers(&plane(-1.0), &ray) && !judge.covers(&plane(0.0), &ray));
    let ball = |z| Primitive::Sphere { center: point(0.0, 0.0, z), radius: 1.0 };
    assert!(judge.covers(&ball(-1.0), &ray) && !judge.covers(&ball(1.0), &ray));
    // An eye on the sphere sees its far wall; an eye inside does, too.
    assert_eq!(judge.distance(&ball(-1.0), &ray), 2.0);
    assert_eq!(judge.distance(&ball(-0.5), &ray), 1.5);
    assert_eq!(judge.distance(&ball(-2.0), &ray), 1.0);
}

#[test]
fn a_ray_that_touches_a_sphere_misses_it() {
    let camera = five_by_five(Projection::Parallel);
    let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
    let ball = |x: f64| Primitive::Sphere { center: point(x, 0.0, -3.0), radius: 1.0 };
    assert!(!judge.covers(&ball(1.0), &ray));
    assert!(judge.covers(&ball(1.0_f64.next_down()), &ray));
    assert!(!judge.covers(&ball(1.0_f64.next_up()), &ray));
}

#[test]
fn equal_distances_put_flat_before_round() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        let camera = five_by_five(projection);
        let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
        let ball = Primitive::Sphere { center: point(0.0, 0.0, -3.0), radius: 1.0 };
        let plane =
            |z| Primitive::Plane { point: point(0.0, 0.0, z), normal: point(1.0, 0.0, 1.0) };
        let order = |z| {
            let there = judge.compare(&ball, &plane(z), &ray);
            let back = judge.compare(&plane(z), &ball, &ray);
            assert_eq!(there.at_sample, back.at_sample.reverse());
            assert_eq!(there.decided, back.decided.reverse());
            (there.at_sample, there.decided)
        };
        assert_eq!(order(-2.0), (Ordering::Equal, Ordering::Greater));
        assert_eq!(order(-2.5), (Ordering::Less, Ordering::Less));
        assert_eq!(order(-5.0), (Ordering::Less, Ordering::Less));
        assert_eq!(order(-1.5), (Ordering::Greater, Ordering::Greater));
        assert!(judge.nearer((9, &plane(-2.0)), (1, &ball), &ray));
    }
}

#[test]
fn an_eye_inside_of_a_sphere_compares_its_far_wall() {
    let camera = five_by_five(Projection::Perspective);
    let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
    let room = Primitive::Sphere { center: point(0.0, 0.0, -1.0), radius: 3.0 };
    let plane = |z| Primitive::Plane { point: point(0.0, 0.0, z), normal: point(0.0, 0.0, -2.0) };
    let order = |z| judge.compare(&room, &plane(z), &ray).at_sample;
    assert_eq!(order(-1.0), Ordering::Greater);
    assert_eq!(order(-4.0), Ordering::Equal);
    assert_eq!(order(-5.0), Ordering::Less);
}

#[test]
fn two_spheres_are_compared_through_their_roots() {
    let camera = five_by_five(Projection::Perspective);
    let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
    let ball = |z: f64, radius: f64| Primitive::Sphere { center: point(0.0, 0.0, z), radius };
    let order = |first: Primitive, second: Primitive| {
        let there = judge.compare(&first, &second, &ray).at_sample;
        assert_eq!(there, judge.compare(&second, &first, &ray).at_sample.reverse());
        there
    };
    assert_eq!(order(ball(-3.0, 1.0), ball(-4.0, 2.0)), Ordering::Equal);
    assert_eq!(order(ball(-3.0, 1.0), ball(-4.0, 1.0)), Ordering::Less);
    assert_eq!(order(ball(-3.0, 1.0), ball(-4.0, 2.5)), Ordering::Greater);
    // From inside of the first, the far wall at 2; the second from outside at 2, or from inside at 4.
    assert_eq!(order(ball(-1.0, 1.5), ball(-3.5, 1.0)), Ordering::Equal);
    assert_eq!(order(ball(-1.0, 1.5), ball(-1.0, 3.0)), Ordering::Less);
    assert_eq!(order(ball(-1.0, 1.5), ball(-3.0, 1.0)), Ordering::Greater);
}

#[test]
fn a_silhouette_met_exactly_shows_its_front() {
    // Two faces meet in the vertical edge x = 0 at depth 2; the nudge goes right, where the first is
    // the nearer one.
    let camera = five_by_five(Projection::Perspective);
    let (judge, ray) = (Judge::new(&camera), camera.viewing_ray(2, 2));
    let plane = |slope: f64| Primitive::Plane {
        point: point(0.0, 0.0, -2.0),
        normal: point(-slope, 0.0, 1.0),
    };
    let comparison = judge.compare(&plane(0.5), &plane(-0.5), &ray);
    assert_eq!(comparison, Comparison { at_sample: Ordering::Equal, decided: Ordering::Less });
    // One plane, stated twice, is told apart by nothing but its ids.
    let twice = Primitive::Plane { point: point(2.0, 9.0, -1.0), normal: point(-1.0, 0.0, 2.0) };
    assert_eq!(judge.compare(&plane(0.5), &twice, &ray).decided, Ordering::Equal);
    assert!(judge.nearer((3, &twice), (4, &plane(0.5)), &ray));
}
