//! Distances from another eye, or in another direction.

use super::stance::elsewhere;
use super::*;
use crate::common::glam::DVec3;

/// What is found in the numbers that another camera writes for its distances, by `t` and the direction of the ray.
fn finding_of_distances(
    view: &View,
    other: CameraDescription,
    number: impl Fn(f64, DVec3) -> f64,
) -> Finding {
    let camera = Camera::new(other).unwrap();
    let drawn = draw(&View::new(view.scene, &camera), &Convention::default(), Rows::ALL);
    let width = view.camera.image()[0] as usize;
    let numbers = drawn.t.iter().enumerate().map(|(index, &t)| {
        let [i, j] = [index / width, index % width].map(|side| u32::try_from(side).unwrap());
        if t.is_finite() { number(t, camera.viewing_ray(i, j).direction) } else { 0.0 }
    });
    let file = Buffer::new(view.camera.image(), 1, Content::Distances(numbers.collect()));
    find_conventions(view, &file).unwrap().finding
}

/// The stance that is named, how many pixels it leaves, and the sentence.
fn stance(view: &View, finding: &Finding) -> (Stance, u64, String) {
    let Finding::Explained(found) = finding else { panic!("{finding:?}") };
    let one = &found[0];
    let Pose::Measured(stance) = one.convention.pose else { panic!("{one:?}") };
    (stance, one.remaining, one.sentences("A", view.camera).join(" / "))
}

#[test]
fn another_eye_is_named_from_distances_with_its_place() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let description = *view.camera.description();
        for by in [[0.5, -0.2, -1.0], [0.0, 0.05, 0.0]] {
            let eye = description.eye + Vec3::from_array(by);
            let around = CameraDescription { eye, ..description };
            let found = finding_of_distances(view, around, |t, _| t);
            let (found, left, said) = stance(view, &found);
            assert_eq!(found.moved, Moved::EyeAroundTarget, "{by:?} {said}");
            assert!(found.eye.abs_diff_eq(eye.as_dvec3(), 1e-4), "{by:?} {left} {said}");
            let [u, v, w] = [view.camera.u(), view.camera.v(), view.camera.w()].map(DVec3::as_vec3);
            let orientation = Orientation::Frame { u, v, w };
            let beside = CameraDescription { eye, orientation, ..description };
            let along_ray =
                finding_of_distances(view, beside, |t, direction| t * direction.length());
            let (found, left, said) = stance(view, &along_ray);
            assert_eq!(found.moved, Moved::Eye, "{by:?} {said}");
            assert!(found.eye.abs_diff_eq(eye.as_dvec3(), 1e-4), "{by:?} {left} {said}");
        }
    });
}

#[test]
fn another_direction_and_another_up_are_named_from_distances() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        with_scene(&coarse_lecture(), [132, 88], projection, |view| {
            let description = *view.camera.description();
            let Orientation::LookAt { target, up } = description.orientation else { panic!() };
            let with = |target, up| {
                let other = looking_at(description, target, up);
                stance(view, &finding_of_distances(view, other, |t, _| -t))
            };
            let elsewhere = target + Vec3::new(0.4, 0.2, 0.1);
            let (found, _, said) = with(elsewhere, up);
            let back = (description.eye - elsewhere).as_dvec3().normalize();
            assert_eq!(found.moved, Moved::Direction, "{said}");
            assert!(found.axes[2].abs_diff_eq(back, 1e-5), "{projection:?} {said}");
            let (found, _, said) = with(target, up + Vec3::new(0.2, 0.0, 0.0));
            assert_eq!(found.moved, Moved::Up, "{projection:?} {said}");
        });
    }
}

#[test]
fn another_eye_that_looks_elsewhere_is_named_from_distances() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let other = elsewhere(*view.camera.description());
        let (found, left, said) = stance(view, &finding_of_distances(view, other, |t, _| t));
        assert!(found.eye.abs_diff_eq(other.eye.as_dvec3(), 1e-4), "{left} {said}");
    });
}

/// Where all is seen from the same place, distances are those of what is seen.
#[test]
fn another_size_and_place_of_everything_are_named_from_distances() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        with_scene(&coarse_lecture(), [132, 88], projection, |view| {
            let description = *view.camera.description();
            let [vw, vh] = description.viewport;
            for (x, y) in [(1.1, 1.1), (0.8, 0.8), (1.05, 1.0)] {
                let viewport = [vw * x, vh * y];
                let other = CameraDescription { viewport, ..description };
                let found = finding_of_distances(view, other, |t, _| t);
                let Finding::Explained(found) = &found else { panic!("{x} {y} {found:?}") };
                let Framing { scale, shift, evidence, .. } = found[0].convention.framing;
                assert_eq!((shift, evidence), ([0.0; 2], Evidence::Distances), "{x} {y}");
                assert_eq!(x == y, scale[0] == scale[1], "{x} {y} {scale:?}");
                for (scale, factor) in scale.into_iter().zip([x, y]) {
                    assert!((scale * f64::from(factor) - 1.0).abs() < 1e-4, "{scale} {factor}");
                }
                let said = found[0].sentences("A", view.camera).join(" / ");
                assert!(!said.contains("its eye") && said.contains("its viewport"), "{said}");
            }
        });
    }
}

/// A wall looks the same from wherever an eye stands before it.
#[test]
fn a_wall_tells_no_eye() {
    let wall = crate::common::Plane { point: Vec3::new(0.0, 0.0, -4.0), normal: Vec3::Z };
    let scene = crate::common::Scene::new(vec![crate::common::Shape::Plane(wall).into()]).unwrap();
    let description = CameraDescription { image: [96, 72], ..CameraDescription::default() };
    let camera = Camera::new(description).unwrap();
    let view = View::new(&scene, &camera);
    let eye = description.eye + Vec3::new(0.5, 0.2, -0.4);
    let other = CameraDescription { eye, ..description };
    let found = finding_of_distances(&view, other, |t, _| t);
    if let Finding::Explained(found) = &found {
        assert!(found.iter().all(|one| !one.convention.is_posed()), "{found:?}");
    }
}

#[test]
fn distances_of_another_scene_tell_no_eye() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let wave = |t: f64, direction: DVec3| t * (1.0 + 0.2 * (9.0 * direction.x).sin());
        let found = finding_of_distances(view, *view.camera.description(), wave);
        if let Finding::Explained(found) = &found {
            assert!(found.iter().all(|one| !one.convention.is_posed()), "{found:?}");
        }
    });
}
