//! What is no explanation, however much of a file it explains.

use super::*;
use crate::common::{Object, Plane, Scene, Shape, Sphere, Triangle};

/// A view of these objects, 48 × 32 pixels.
fn with_objects(shapes: Vec<Shape>, description: CameraDescription, run: impl Fn(&View)) {
    let scene = Scene::new(shapes.into_iter().map(Object::from).collect()).unwrap();
    let camera = CameraDescription { image: [48, 32], viewport: [1.5, 1.0], ..description };
    run(&View::new(&scene, &Camera::new(camera).unwrap()));
}

fn of_ids(view: &View, ids: Vec<u32>) -> Finding {
    let ids = ids.into_iter().map(|id| (id != NO_PRIMITIVE).then_some(u64::from(id)));
    let file = Buffer::new(view.camera.image(), 1, Content::Ids(ids.collect()));
    find_conventions(view, &file).unwrap().finding
}

fn floor(height: f32) -> Vec<Shape> {
    let corner = |x: f32, z: f32| Vec3::new(x, height, z);
    let [a, b, c, d] = [corner(-3.0, 2.0), corner(3.0, 2.0), corner(3.0, -9.0), corner(-3.0, -9.0)];
    vec![Shape::Triangle(Triangle { a, b, c }), Shape::Triangle(Triangle { a, b: c, c: d })]
}

#[test]
fn two_triangles_tell_an_eye_that_was_left_out_by_their_outlines() {
    let eye = Vec3::new(0.5, 0.25, 1.0);
    let description = CameraDescription { eye, ..CameraDescription::default() };
    with_objects(floor(-0.5), description, |view| {
        let planted = Convention::default().with(Change::Pose(Pose::EyeLeftOut));
        let drawn = draw(view, &planted, Rows::ALL);
        let Finding::Explained(found) = of_ids(view, drawn.ids) else { panic!("not explained") };
        assert_eq!((found.len(), found[0].convention, found[0].remaining), (1, planted, 0));
    });
}

#[test]
fn what_turns_an_object_over_that_is_right_explains_nothing() {
    let plane = Shape::Plane(Plane { point: Vec3::NEG_Y, normal: Vec3::Y });
    let center = Vec3::new(0.0, 0.75, -4.0);
    let shapes = vec![plane, Shape::Sphere(Sphere { center, radius: 0.75 })];
    with_objects(shapes, CameraDescription::default(), |view| {
        // The plane alone stands on its head, as by a sign that is wrong in its test.
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        let turned = |index: usize| truth[(31 - index / 48) * 48 + index % 48];
        let ids = (0..truth.len()).map(|index| match (truth[index], turned(index)) {
            (1, _) => 1,
            (_, 0) => 0,
            _ => NO_PRIMITIVE,
        });
        assert!(matches!(of_ids(view, ids.collect()), Finding::Unexplained(_)));
    });
}

#[test]
fn an_object_that_lies_elsewhere_is_no_mistake_of_the_depth_test() {
    let mut shapes = floor(-0.5);
    let corner = |x: f32, y: f32| Vec3::new(x, y, -3.0);
    let tall = |x: f32| Triangle {
        a: corner(x - 0.75, -0.5),
        b: corner(x + 0.75, -0.5),
        c: corner(x, 0.5),
    };
    shapes.push(Shape::Triangle(tall(-0.75)));
    let mut moved = shapes.clone();
    moved[2] = Shape::Triangle(tall(1.0));
    with_objects(moved, CameraDescription::default(), |theirs| {
        let ids = draw(theirs, &Convention::default(), Rows::ALL).ids;
        with_objects(shapes.clone(), CameraDescription::default(), |view| {
            if let Finding::Explained(found) = of_ids(view, ids.clone()) {
                let is_of_depth = |one: &Explanation| one.convention.depth != Depth::Nearest;
                assert!(!found.iter().any(is_of_depth), "{:?}", found[0].convention.changes());
            }
        });
    });
}

#[test]
fn a_few_wrong_distances_tell_no_eye() {
    with_scene(&scenes::load("lecture").unwrap(), [64, 48], Projection::Perspective, |view| {
        let mut t = draw(view, &Convention::default(), Rows::ALL).t;
        for (pixel, t) in t.iter_mut().enumerate().skip(20 * 64 + 20).step_by(400).take(4) {
            *t *= 1.0 + 1e-4 * (1.0 + pixel as f64 / 3000.0);
        }
        let file = Buffer::new([64, 48], 1, Content::Distances(t));
        let findings = find_conventions(view, &file).unwrap();
        assert_eq!(findings.differing, 4);
        assert!(!matches!(findings.finding, Finding::Explained(_)));
    });
}

#[test]
fn distances_that_are_interpolated_wrongly_are_named() {
    for name in ["lecture", "overlap"] {
        with_scene(&scenes::load(name).unwrap(), [80, 60], Projection::Perspective, |view| {
            for interpolation in Interpolation::OTHERS {
                let planted = Convention::default().with(Change::Interpolation(interpolation));
                let drawn = draw(view, &planted, Rows::ALL);
                let file = Buffer::new([80, 60], 1, Content::Distances(drawn.t));
                let findings = find_conventions(view, &file).unwrap();
                let Finding::Explained(found) = findings.finding else {
                    panic!("{name}: {interpolation:?} is not explained")
                };
                assert_eq!(found[0].convention, planted, "{name}");
                assert_eq!(found[0].remaining, 0, "{name}: {interpolation:?}");
            }
        });
    }
}

#[test]
fn a_linear_distance_is_that_of_the_corners_at_the_corners_and_between_them_no_reciprocal() {
    let corners = [(-1.0, 0.0, -2.0), (1.0, 0.0, -2.0), (0.0, 3.0, -6.0)]
        .map(|(x, y, z)| crate::common::glam::DVec3::new(x, y, z));
    let camera = Camera::new(CameraDescription {
        image: [16, 16],
        viewport: [2.0, 2.0],
        ..CameraDescription::default()
    })
    .unwrap();
    let rays = super::super::rays::ViewingRays::new(&camera, &Convention::default());
    let t = |interpolation, x, y| {
        let plane =
            super::super::outline::PlaneDistance::interpolated(&corners, &rays, interpolation);
        plane.expect("it lies before the eye").t(x, y).0
    };
    let is = |one: f64, other: f64| assert!((one - other).abs() < 1e-12, "{one} is not {other}");
    // Projected, the corners are (−½, 0), (½, 0) and (0, ½).
    for interpolation in [Interpolation::Perspective, Interpolation::Linear] {
        is(t(interpolation, 0.5, 0.0), 2.0);
        is(t(interpolation, 0.0, 0.5), 6.0);
    }
    is(t(Interpolation::Linear, 0.0, 0.25), 4.0);
    is(t(Interpolation::Perspective, 0.0, 0.25), 3.0);
    is(t(Interpolation::Mean, 0.0, 0.25), 10.0 / 3.0);
    is(t(Interpolation::FirstCorner, 0.0, 0.25), 2.0);
}

#[test]
fn a_half_that_is_forgotten_in_rows_from_the_bottom_is_to_be_added() {
    // y = vh (i/H − ½), with i from the top, and x = vw (j/W − ½).
    with_scene(&scenes::load("lecture").unwrap(), [64, 48], Projection::Perspective, |view| {
        let planted = Convention::default()
            .with(Change::Placement(Placement::UpsideDown))
            .with(Change::Columns(Sampling::Corner))
            .with(Change::Rows(Sampling::FarCorner));
        let findings = find_conventions(view, &file(view, &planted, true)).unwrap();
        let Finding::Explained(found) = findings.finding else { panic!("it is not explained") };
        assert_eq!((found[0].convention, found[0].remaining), (planted, 0));
        let said = found[0].sentences("B", view.camera).join("; ");
        assert!(said.contains("add 1/2 to i and j") && !said.contains("subtract"), "{said}");
    });
}
