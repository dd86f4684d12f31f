//! Masks from another eye, or in another direction: their contours alone tell it.

use super::framing::true_ids;
use super::*;
use crate::common::glam::DVec3;

/// What is found in the mask that another camera sees, perhaps of another scene.
fn finding_of_mask(view: &View, scene: &crate::common::Scene, other: CameraDescription) -> Finding {
    let camera = Camera::new(other).unwrap();
    let mask = file(&View::new(scene, &camera), &Convention::default(), false);
    find_conventions(view, &mask).unwrap().finding
}

/// The stance that is named, and the sentence, if one is.
fn named(view: &View, finding: &Finding) -> Option<(Stance, String)> {
    let Finding::Explained(found) = finding else { return None };
    let stance = found.iter().find_map(|one| match one.convention.pose {
        Pose::Measured(stance) => Some((stance, one)),
        _ => None,
    });
    stance.map(|(stance, one)| (stance, one.sentences("A", view.camera).join(" / ")))
}

/// The teapot of the lecture alone, and larger.
fn teapot(scale: f32) -> LoadedScene {
    let text = format!(
        r#"
        [camera]
        eye = [1.0, 2.1, 6.8]
        look_at = [0.1, 0.75, 0]
        distance = 2
        [[object]]
        generate = {{ kind = "teapot", divisions = [4, 4] }}
        scale = {scale}
        rotate = {{ axis = [0, 1, 0], degrees = 25 }}
        translate = [-0.35, 0, -0.3]
        "#
    );
    let file = GivenFile::new("teapot.toml", text.as_bytes());
    scenes::load_file(&InputFile::given(&[file], 0), None).unwrap()
}

#[test]
fn another_eye_is_named_from_a_mask() {
    with_scene(&teapot(0.6), [160, 120], Projection::Perspective, |view| {
        let description = *view.camera.description();
        for by in [[0.4, 0.0, 0.0], [0.5, -0.2, -1.0]] {
            let eye = description.eye + Vec3::from_array(by);
            let around = CameraDescription { eye, ..description };
            let found = named(view, &finding_of_mask(view, view.scene, around));
            let (stance, said) = found.unwrap_or_else(|| panic!("{by:?}"));
            assert_eq!(stance.moved, Moved::EyeAroundTarget, "{by:?} {said}");
            assert!(stance.eye.abs_diff_eq(eye.as_dvec3(), 0.03), "{by:?} {said}");
            assert!(said.contains("is its eye another, its field of view, or"), "{said}");
        }
    });
}

#[test]
fn another_direction_and_another_up_are_named_from_a_mask() {
    for projection in [Projection::Perspective, Projection::Parallel] {
        with_scene(&teapot(0.6), [160, 120], projection, |view| {
            let description = *view.camera.description();
            let Orientation::LookAt { target, up } = description.orientation else { panic!() };
            let with = |target, up| {
                let other = looking_at(description, target, up);
                let found = named(view, &finding_of_mask(view, view.scene, other));
                found.unwrap_or_else(|| panic!("{projection:?} {target} {up}"))
            };
            let (stance, said) = with(target, up + Vec3::new(0.2, 0.0, 0.0));
            assert_eq!(stance.moved, Moved::Up, "{projection:?} {said}");
            let elsewhere = target + Vec3::new(0.4, 0.3, 0.1);
            let (stance, said) = with(elsewhere, up);
            let back: DVec3 = (description.eye - elsewhere).as_dvec3().normalize();
            assert_eq!(stance.moved, Moved::Direction, "{projection:?} {said}");
            assert!(stance.axes[2].abs_diff_eq(back, 2e-3), "{projection:?} {said}");
            let end = "is its look_at another, or the picture or all of the scene moved?";
            assert!(said.ends_with(end), "{said}");
        });
    }
}

/// A larger teapot is what a nearer eye sees: the sentence names both.
#[test]
fn an_object_of_another_size_may_be_the_cause_of_a_mask() {
    with_scene(&teapot(0.6), [160, 120], Projection::Perspective, |view| {
        let description = *view.camera.description();
        let larger = finding_of_mask(view, &teapot(0.63).scene, description);
        let (_, said) = named(view, &larger).unwrap();
        let end =
            "is its eye another, its field of view, or all of the scene moved or of another size?";
        assert!(said.ends_with(end), "{said}");
    });
}

/// The framing that is named first, with its sentence, and how many pixels it leaves.
fn framed(view: &View, finding: &Finding) -> (Framing, String, u64) {
    let Finding::Explained(found) = finding else { panic!("{finding:?}") };
    let Explanation { convention, remaining, .. } = found[0];
    (convention.framing, found[0].sentences("A", view.camera).join(" / "), remaining)
}

/// With a teapot that lies wholly in the picture, and with one that is cut.
#[test]
fn another_size_and_another_place_are_named_from_a_mask() {
    for (size, projection) in [
        (0.6, Projection::Perspective),
        (0.6, Projection::Parallel),
        (0.9, Projection::Perspective),
    ] {
        with_scene(&teapot(size), [160, 120], projection, |view| {
            let description = *view.camera.description();
            let with = |viewport: [f32; 2]| {
                let other = CameraDescription { viewport, ..description };
                framed(view, &finding_of_mask(view, view.scene, other))
            };
            let [vw, vh] = description.viewport;
            for factor in [0.8, 1.07] {
                let (Framing { scale: [x, y], shift, .. }, said, left) =
                    with([vw * factor, vh * factor]);
                assert!(x == y && (x * f64::from(factor) - 1.0).abs() < 0.01, "{factor} {said}");
                assert!(shift == [0.0; 2] && left < 30, "{factor} {left} {said}");
                assert!(said.ends_with(", or all of the scene of another size?"), "{said}");
            }
            let (Framing { scale: [x, y], .. }, said, _) = with([vw * 1.1, vh]);
            assert!((1.1 * x - 1.0).abs() < 0.01 && y == 1.0, "{said}");
            let truth = true_ids(view);
            let mask = (0..120).flat_map(|i| (0..160).map(move |j| [i, j]));
            let mask: Vec<bool> = mask.map(|[i, j]| truth([i + 5, j - 9]).is_some()).collect();
            let file = Buffer::new([160, 120], 1, Content::Mask(mask.into()));
            let found = find_conventions(view, &file).unwrap().finding;
            let (Framing { scale, shift, .. }, said, left) = framed(view, &found);
            assert_eq!((scale, shift, left), ([1.0; 2], [9.0, -5.0], 0), "{said}");
        });
    }
}

/// Where everything is much larger, most pixels may be wrong.
#[test]
fn a_near_eye_is_not_taken_for_an_inverted_mask() {
    with_scene(&teapot(0.6), [160, 120], Projection::Perspective, |view| {
        let description = *view.camera.description();
        let Orientation::LookAt { target, .. } = description.orientation else { panic!() };
        let eye = target + 0.45 * (description.eye - target);
        let other = CameraDescription { eye, ..description };
        let camera = Camera::new(other).unwrap();
        let mask = |view: &View| file(view, &Convention::default(), false);
        let (ours, theirs) = (mask(view), mask(&View::new(view.scene, &camera)));
        let differing = (0..160 * 120).filter(|&at| ours.covered(at) != theirs.covered(at)).count();
        assert!(2 * differing > 160 * 120, "{differing}");
        let found = find_conventions(view, &theirs).unwrap().finding;
        let (stance, said) = named(view, &found).unwrap_or_else(|| panic!("{found:?}"));
        assert!(stance.eye.abs_diff_eq(eye.as_dvec3(), 0.1), "{said}");
        assert!(!said.contains("inverted"), "{said}");
    });
}

/// The contour of an inverted mask is that of the mask.
#[test]
fn another_size_is_named_from_an_inverted_mask() {
    with_scene(&teapot(0.6), [160, 120], Projection::Perspective, |view| {
        let description = *view.camera.description();
        let viewport = description.viewport.map(|side| 0.93 * side);
        let camera = Camera::new(CameraDescription { viewport, ..description }).unwrap();
        let mask = file(&View::new(view.scene, &camera), &Convention::default(), false);
        let inverted: Vec<bool> =
            (0..160 * 120).map(|at| mask.covered(at) == Some(false)).collect();
        let inverted = Buffer::new([160, 120], 1, Content::Mask(inverted.into()));
        let found = find_conventions(view, &inverted).unwrap().finding;
        let (Framing { scale: [x, y], .. }, said, _) = framed(view, &found);
        assert!(x == y && (0.93 * x - 1.0).abs() < 0.01 && said.contains("inverted"), "{said}");
    });
}

/// A ball is a disc from everywhere.
#[test]
fn a_mask_of_a_ball_tells_no_eye_beside_it() {
    let ball = crate::common::Sphere { center: Vec3::new(0.2, 0.1, -3.0), radius: 0.8 };
    let scene = crate::common::Scene::new(vec![crate::common::Shape::Sphere(ball).into()]).unwrap();
    let description = CameraDescription {
        image: [160, 120],
        orientation: Orientation::LookAt { target: Vec3::new(0.2, 0.1, -3.0), up: Vec3::Y },
        ..CameraDescription::default()
    };
    let camera = Camera::new(description).unwrap();
    let view = View::new(&scene, &camera);
    let eye = description.eye + Vec3::new(0.5, 0.2, -0.4);
    let found = finding_of_mask(&view, &scene, CameraDescription { eye, ..description });
    let found = named(&view, &found);
    assert!(
        found.as_ref().is_none_or(|(stance, _)| stance.moved != Moved::EyeAroundTarget),
        "{found:?}"
    );
}

/// A horizon looks the same from wherever an eye of some height looks along it.
#[test]
fn a_horizon_tells_no_eye() {
    with_scene(&coarse_lecture(), [160, 120], Projection::Perspective, |view| {
        let description = *view.camera.description();
        for by in [[0.0, 0.0, -0.7], [0.3, -0.4, 0.0]] {
            let other =
                CameraDescription { eye: description.eye + Vec3::from_array(by), ..description };
            let found = named(view, &finding_of_mask(view, view.scene, other));
            assert!(
                found.as_ref().is_none_or(|(stance, _)| !stance.moved.is_of_eye()),
                "{found:?}"
            );
        }
    });
}

#[test]
fn a_mask_of_another_shape_tells_no_eye() {
    with_scene(&teapot(0.6), [160, 120], Projection::Perspective, |view| {
        let other = BUILT_IN.iter().find(|scene| scene.name == "many").unwrap();
        let file = GivenFile::new("many.toml", other.toml.as_bytes());
        let other = scenes::load_file(&InputFile::given(&[file], 0), None).unwrap();
        let camera = CameraDescription { image: view.camera.image(), ..other.camera };
        assert_eq!(named(view, &finding_of_mask(view, &other.scene, camera)), None);
    });
}
