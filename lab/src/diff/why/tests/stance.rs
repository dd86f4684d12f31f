//! Pictures from another eye, or in another direction, that no mistake of the list gives.

use super::framing::{finding, finding_of_camera, only, true_ids};
use super::*;
use crate::common::glam::DVec3;

/// The stance that is named, how many pixels it leaves, and the sentence.
fn stance(view: &View, finding: &Finding) -> (Stance, u64, String) {
    let one = only(finding);
    let Pose::Measured(stance) = one.convention.pose else { panic!("{one:?}") };
    (stance, one.remaining, one.sentences("A", view.camera).join(" / "))
}

fn is_near(one: DVec3, other: DVec3, by: f64) -> bool {
    (one - other).length() <= by
}

#[test]
fn another_eye_is_named_with_its_place() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let description = *view.camera.description();
        for by in [[0.3, 0.0, 0.0], [0.0, 0.4, 0.0], [0.5, -0.2, -1.0], [0.0, 0.0, 0.7]] {
            let eye = description.eye + Vec3::from_array(by);
            // It looks at the same point, as the words of the scene file say.
            let around = finding_of_camera(view, CameraDescription { eye, ..description });
            let (found, left, said) = stance(view, &around);
            assert!(is_near(found.eye, eye.as_dvec3(), 0.01), "{by:?} {found:?} {left}");
            assert_eq!(found.moved, Moved::EyeAroundTarget, "{by:?}");
            assert!(said.contains("that looks at the same point"), "{said}");
            // And with the axes as they were.
            let [u, v, w] = [view.camera.u(), view.camera.v(), view.camera.w()].map(DVec3::as_vec3);
            let orientation = Orientation::Frame { u, v, w };
            let beside = CameraDescription { eye, orientation, ..description };
            let (found, left, said) = stance(view, &finding_of_camera(view, beside));
            assert!(is_near(found.eye, eye.as_dvec3(), 0.01), "{by:?} {found:?} {left}");
            assert_eq!(found.moved, Moved::Eye, "{by:?}");
            assert!(said.contains("in the same direction"), "{said}");
        }
    });
}

#[test]
fn another_direction_and_another_up_are_named() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        with_scene(&coarse_lecture(), [132, 88], projection, |view| {
            let description = *view.camera.description();
            let Orientation::LookAt { target, up } = description.orientation else { panic!() };
            let with = |target, up| finding_of_camera(view, looking_at(description, target, up));
            let elsewhere = target + Vec3::new(0.4, 0.2, 0.1);
            let (found, _, said) = stance(view, &with(elsewhere, up));
            let back = (description.eye - elsewhere).as_dvec3().normalize();
            assert!(is_near(found.axes[2], back, 1e-3), "{projection:?} {found:?} {back}");
            assert_eq!(found.moved, Moved::Direction);
            assert!(said.ends_with("is its look_at another?"), "{said}");
            let both = with(elsewhere, up + Vec3::new(0.3, 0.0, 0.0));
            let (found, _, said) = stance(view, &both);
            assert_eq!(found.moved, Moved::Axes, "{projection:?}");
            assert!(is_near(found.axes[2], back, 1e-3), "{projection:?} {found:?} {back}");
            assert!(said.contains("(with another up)"), "{said}");
            let (found, _, said) = stance(view, &with(target, up + Vec3::new(0.2, 0.0, 0.0)));
            assert_eq!(found.moved, Moved::Up, "{projection:?}");
            // With its head to the right, a camera sees everything lean to the left.
            assert!(said.contains(" counter-clockwise by "), "{said}");
        });
    }
}

/// A camera whose eye stands elsewhere and that looks elsewhere, with another `up`.
pub(super) fn elsewhere(description: CameraDescription) -> CameraDescription {
    let Orientation::LookAt { target, .. } = description.orientation else { panic!() };
    let eye = description.eye + Vec3::new(0.15, 0.1, 0.3);
    let target = target + Vec3::new(0.1, -0.2, 0.0);
    let up = Vec3::new(0.1, 1.0, 0.0);
    looking_at(CameraDescription { eye, ..description }, target, up)
}

#[test]
fn another_eye_that_looks_elsewhere_is_named() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let other = elsewhere(*view.camera.description());
        let (found, left, said) = stance(view, &finding_of_camera(view, other));
        let camera = Camera::new(other).unwrap();
        assert!(is_near(found.eye, camera.eye().as_dvec3(), 0.01), "{found:?} {left}");
        assert!(is_near(found.axes[0], camera.u(), 0.01), "{found:?} {}", camera.u());
        assert!(said.contains(" along about "), "{said}");
    });
}

#[test]
fn another_eye_is_named_from_ids_that_count_from_1_and_upside_down() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let description = *view.camera.description();
        let eye = description.eye + Vec3::new(0.2, 0.1, 0.1);
        let camera = Camera::new(CameraDescription { eye, ..description }).unwrap();
        let truth = true_ids(&View::new(view.scene, &camera));
        // 0 is nothing, as where a picture is cleared to 0.
        let found = finding(view, |[i, j]| Some(truth([87 - i, j]).map_or(0, |id| id + 1)));
        let (found, _, said) = stance(view, &found);
        assert!(is_near(found.eye, eye.as_dvec3(), 0.01), "{found:?}");
        assert!(said.contains("upside down") && said.contains("counts ids from 1"), "{said}");
    });
}

/// How far the eye of a parallel camera is from what it looks at, no picture tells.
#[test]
fn another_eye_of_parallel_rays_is_told_as_a_direction() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Parallel, |view| {
        let description = *view.camera.description();
        let Orientation::LookAt { target, .. } = description.orientation else { panic!() };
        let from_target = description.eye - target;
        let eye = target + 1.5 * (from_target + Vec3::new(1.0, 0.5, 0.0));
        let (found, _, said) =
            stance(view, &finding_of_camera(view, CameraDescription { eye, ..description }));
        let back = (eye - target).as_dvec3().normalize();
        assert!(is_near(found.axes[2], back, 2e-3), "{found:?} {back}");
        assert_eq!(found.moved, Moved::EyeAroundTarget);
        let distance = (found.eye - target.as_dvec3()).length();
        assert!((distance - f64::from(from_target.length())).abs() < 1e-6, "{distance}");
        assert!(said.contains("with the same point in the middle"), "{said}");
    });
}

/// Over a floor without an end, a mesh that is moved is what an eye sees that is moved the other way.
#[test]
fn one_object_among_others_may_be_moved_itself() {
    let moved = |by: f32| {
        let mut dice = bothways_test_support::Dice(5);
        let mut triangle = || {
            let middle = 0.6 * dice.point();
            let [a, b, c] =
                [(); 3].map(|()| middle + 0.3 * dice.point() + Vec3::new(by, 0.0, -3.0));
            [a, b, c]
        };
        let triangles: Vec<[Vec3; 3]> = (0..40).map(|_| triangle()).collect();
        let positions: Vec<Vec3> = triangles.concat();
        let corners = (0..).map(|triangle: u32| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
        let mesh = crate::common::Mesh::new(positions, corners.take(40).collect()).unwrap();
        let floor = crate::common::Plane { point: Vec3::new(0.0, -1.5, 0.0), normal: Vec3::Y };
        let shapes = [crate::common::Shape::Mesh(mesh), crate::common::Shape::Plane(floor)];
        crate::common::Scene::new(shapes.map(crate::common::Object::from).to_vec()).unwrap()
    };
    let camera = Camera::new(CameraDescription { image: [132, 99], ..Default::default() }).unwrap();
    let [scene, other] = [0.0, 0.25].map(moved);
    let truth = true_ids(&View::new(&other, &camera));
    let view = View::new(&scene, &camera);
    let (found, _, said) = stance(&view, &finding(&view, truth));
    assert_eq!((found.moved, found.told_by), (Moved::Eye, Some(0)));
    assert!(is_near(found.eye, DVec3::new(-0.25, 0.0, 0.0), 0.01), "{found:?}");
    assert!(said.ends_with("is its eye another, or object 0 moved or of another size?"), "{said}");
}

#[test]
fn a_picture_of_another_scene_has_no_stance() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let truth = true_ids(view);
        // Every place shows the id of another primitive, which no eye sees there.
        let count = view.scene.primitive_count();
        let found = finding(view, |pixel| truth(pixel).map(|id| (id * 7 + 3) % count));
        if let Finding::Explained(found) = &found {
            assert!(found.iter().all(|one| !one.convention.is_posed()), "{found:?}");
        }
    });
}
