//! Pictures of another size or in another place.

use super::*;

/// What is found in the file of ids whose pixel `(i, j)` shows what `number` says of it.
pub(super) fn finding(view: &View, number: impl Fn([isize; 2]) -> Option<u64>) -> Finding {
    let [width, height] = view.camera.image().map(|side| isize::try_from(side).unwrap());
    let pixels = (0..height).flat_map(|i| (0..width).map(move |j| [i, j]));
    let content = Content::Ids(pixels.map(number).collect());
    find_conventions(view, &Buffer::new(view.camera.image(), 1, content)).unwrap().finding
}

/// The true id at any row and column; nothing beside the picture.
pub(super) fn true_ids(view: &View) -> impl Fn([isize; 2]) -> Option<u64> + use<> {
    let drawn = draw(view, &Convention::default(), Rows::ALL);
    let [width, height] = view.camera.image().map(|side| isize::try_from(side).unwrap());
    move |[i, j]| {
        let is_inside = (0..height).contains(&i) && (0..width).contains(&j);
        let id = drawn.ids
            [usize::try_from(i.clamp(0, height - 1) * width + j.clamp(0, width - 1)).unwrap()];
        (is_inside && id != NO_PRIMITIVE).then_some(id.into())
    }
}

pub(super) fn only(finding: &Finding) -> &Explanation {
    let Finding::Explained(found) = finding else { panic!("{finding:?}") };
    assert_eq!(found.len(), 1, "{found:?}");
    &found[0]
}

#[test]
fn a_picture_that_is_moved_is_named_with_its_placement_and_its_numbers() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let truth = true_ids(view);
        let moved = Framing { shift: [5.0, 2.0], is_alone: true, ..Framing::default() };
        let found = finding(view, |[i, j]| truth([i - 2, j - 5]));
        assert_eq!((only(&found).convention.framing, only(&found).remaining), (moved, 0));
        let counted = finding(view, |[i, j]| truth([i - 2, j - 5]).map(|id| id + 1));
        assert_eq!(only(&counted).convention, only(&found).convention);
        assert_eq!(only(&counted).encoding.ids, IdEncoding::CountedFrom(1));
        let flipped = finding(view, |[i, j]| truth([87 - i - 2, j - 5]));
        let expected = only(&found).convention.with(Change::Placement(Placement::UpsideDown));
        assert_eq!((only(&flipped).convention, only(&flipped).remaining), (expected, 0));
    });
}

#[test]
fn a_picture_of_half_its_size_in_a_corner_is_named() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let truth = true_ids(view);
        let found = finding(view, |[i, j]| truth([2 * i, 2 * j]));
        let Framing { scale, shift, is_alone, .. } = only(&found).convention.framing;
        assert!(is_alone && scale.iter().all(|scale| (scale - 0.5).abs() < 0.005), "{scale:?}");
        // The sample of each fourth pixel is a quarter of a pixel from the middle of the four.
        let expected = [-32.75, -21.75];
        assert!(shift.iter().zip(expected).all(|(by, to)| (by - to).abs() < 0.2), "{shift:?}");
    });
}

/// What is found in the ids that a renderer of this camera writes for the scene of the view.
pub(super) fn finding_of_camera(view: &View, description: CameraDescription) -> Finding {
    let camera = Camera::new(description).unwrap();
    finding(view, true_ids(&View::new(view.scene, &camera)))
}

#[test]
fn another_size_of_everything_is_named() {
    heap(Projection::Perspective, [96, 66], |view| {
        let description = *view.camera.description();
        for factor in [0.6, 0.9, 1.07_f32] {
            let distance = description.distance * factor;
            let found = finding_of_camera(view, CameraDescription { distance, ..description });
            let Framing { scale, shift, is_alone, .. } = only(&found).convention.framing;
            assert!(
                scale[0] == scale[1] && (scale[0] - f64::from(factor)).abs() < 2e-3,
                "{scale:?}"
            );
            assert_eq!((shift, is_alone), ([0.0; 2], false));
        }
    });
}

#[test]
fn a_small_change_of_size_is_not_taken_for_other_numbers() {
    with_scene(&coarse_lecture(), [264, 176], Projection::Perspective, |view| {
        let description = *view.camera.description();
        let distance = description.distance * 1.01;
        let found = finding_of_camera(view, CameraDescription { distance, ..description });
        let scale = only(&found).convention.framing.scale;
        assert!(scale[0] == scale[1] && (scale[0] - 1.01).abs() < 1e-3, "{scale:?}");
    });
}

#[test]
fn another_eye_is_no_framing() {
    with_scene(&coarse_lecture(), [132, 88], Projection::Perspective, |view| {
        let description = *view.camera.description();
        for by in [[0.3, 0.0, 0.0], [0.0, 0.4, 0.0], [0.5, -0.2, -1.0], [0.0, 0.0, 0.7]] {
            let eye = description.eye + crate::common::glam::Vec3::from_array(by);
            let found = finding_of_camera(view, CameraDescription { eye, ..description });
            if let Finding::Explained(found) = &found {
                assert!(found.iter().all(|one| !one.convention.is_framed()), "{by:?} {found:?}");
            }
        }
    });
}

#[test]
fn parallel_rays_from_another_eye_are_told_as_a_shift_alone() {
    with_scene(&coarse_lecture(), [264, 176], Projection::Parallel, |view| {
        let description = *view.camera.description();
        let by = crate::common::glam::Vec3::new(0.3, 0.2, 0.0);
        let Orientation::LookAt { target, up } = description.orientation else { panic!() };
        let orientation = Orientation::LookAt { target: target + by, up };
        let moved = CameraDescription { eye: description.eye + by, orientation, ..description };
        let found = finding_of_camera(view, moved);
        let Framing { scale, shift, is_alone, .. } = only(&found).convention.framing;
        assert_eq!((scale, is_alone), ([1.0; 2], false));
        assert!(shift[0] < -1.0 && shift[1] > 0.5, "{shift:?}");
    });
}
