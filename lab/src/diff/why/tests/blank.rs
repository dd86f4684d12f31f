//! Parts of a picture that a file leaves blank, and what must not be taken for one.

use super::*;
use crate::common::glam::Vec3;
use crate::common::{Object, Scene, Shape, Sphere};

/// A convention with a blank part.
fn with_part(view: &View, rows: [u32; 2], columns: [u32; 2]) -> Convention {
    let part = Part { rows, columns, image: view.camera.image(), alone: None };
    Convention::default().with(Change::Omission(Omission::Part(part)))
}

/// The explanations of a file.
fn found(view: &View, file: &Buffer) -> Vec<Explanation> {
    let finding = find_conventions(view, file).unwrap().finding;
    let Finding::Explained(found) = finding else { panic!("{finding:?}") };
    found
}

/// Whether one of the explanations says all of these.
fn is_said(view: &View, found: &[Explanation], said: &[&str]) -> bool {
    let sentences = |one: &Explanation| one.sentences("A", view.camera).join("; ");
    found.iter().any(|one| said.iter().all(|words| sentences(one).contains(words)))
}

#[test]
fn a_blank_part_of_a_picture_is_named() {
    let check = |view: &View, of_ids: bool| {
        let [width, height] = view.camera.image();
        let (all_rows, all_columns) = ([0, height - 1], [0, width - 1]);
        let one_too_early = "in its row 43, the last one: does its loop end one too early";
        for (rows, columns, said) in [
            ([30, height - 1], all_columns, "in its rows 30 to 43, the last ones"),
            ([height - 1; 2], all_columns, one_too_early),
            ([0, 19], all_columns, "in its rows 0 to 19, the first ones"),
            ([20, 27], all_columns, "in its rows 20 to 27: is this part"),
            (all_rows, [40, width - 1], "the last ones: do its loop"),
            (all_rows, [0, 0], "in its column 0, the first one: does its loop begin at 1"),
            ([16, 23], [24, 31], "in its rows 16 to 23 of columns 24 to 31: is a tile"),
            // Above, there is nothing to see.
            ([0, 15], [32, 47], "of columns 32 to 47: is a tile"),
        ] {
            let found = found(view, &file(view, &with_part(view, rows, columns), of_ids));
            assert!(found.iter().all(|one| one.remaining == 0), "{said}: {found:?}");
            assert!(is_said(view, &found, &[said]), "{said}: {found:?}");
        }
    };
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        check(view, true);
        check(view, false);
    });
}

#[test]
fn rows_and_columns_of_a_blank_part_are_those_of_the_file() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        let last_rows = with_part(view, [34, 43], [0, 65]);
        for (placement, said) in [
            (Placement::UpsideDown, "in its rows 0 to 9, the first ones"),
            (Placement::LeftToRight, "in its rows 34 to 43, the last ones"),
            (Placement::Transposed, "in its columns 34 to 43, the last ones"),
            (Placement::TurnedRight, "in its columns 0 to 9, the first ones"),
            (Placement::ByColumns, "where the upright picture has rows 34 to 43"),
        ] {
            let planted = last_rows.with(Change::Placement(placement));
            let found = found(view, &file(view, &planted, true));
            assert!(is_said(view, &found, &[said]), "{placement:?}: {found:?}");
        }
    });
}

#[test]
fn a_plane_that_clips_is_named_beside_a_blank_part() {
    with_scene(&coarse_lecture(), [66, 44], Projection::Perspective, |view| {
        // The floor fills the last rows, whose distances grow upwards.
        let truth = draw(view, &Convention::default(), Rows::ALL);
        let t = truth.t[36 * 66].next_up();
        let clip = Clip { at: Between { nearer: t, farther: t }, alone: None };
        let near = Change::Near(NearPlane { clip, hides_spheres: false });
        for of_ids in [true, false] {
            let found = found(view, &file(view, &Convention::default().with(near), of_ids));
            for said in ["nothing in its rows 36 to 43", "nothing nearer than t = "] {
                assert!(is_said(view, &found, &[said]), "{said}: {found:?}");
            }
        }
    });
}

#[test]
fn a_mask_of_a_part_alone_is_not_inverted() {
    let loaded = scenes::load("overlap").unwrap();
    with_scene(&loaded, [80, 60], Projection::Perspective, |view| {
        // Everything is covered: what is left in an inverted mask is one blank part.
        let truth = draw(view, &Convention::default(), Rows::ALL).ids;
        assert!(!truth.contains(&NO_PRIMITIVE));
        let found = found(view, &file(view, &with_part(view, [10, 59], [0, 79]), false));
        assert!(is_said(view, &found, &["in its rows 10 to 59, the last ones"]), "{found:?}");
        let is_inverted = |one: &Explanation| one.encoding.nothing == NothingEncoding::Inverted;
        assert!(!found.iter().any(is_inverted), "{found:?}");
        // Only a tile is covered: that is no mask in which a tile is blank.
        let is_tile =
            |pixel: usize| (20..40).contains(&(pixel / 80)) && (30..50).contains(&(pixel % 80));
        let mask: Vec<bool> = (0..80 * 60).map(is_tile).collect();
        let file = Buffer::new([80, 60], 1, Content::Mask(mask.into()));
        if let Finding::Explained(found) = find_conventions(view, &file).unwrap().finding {
            assert!(!is_said(view, &found, &["shows nothing"]), "{found:?}");
        }
    });
}

/// Three balls one above the other, each in rows that nothing else fills.
fn balls() -> Scene {
    let ball = |y: f32| Shape::Sphere(Sphere { center: Vec3::new(0.0, y, -3.0), radius: 0.4 });
    let objects: Vec<Object> = [1.0, 0.0, -1.0].map(ball).map(Into::into).into();
    Scene::new(objects).unwrap()
}

#[test]
fn an_object_that_is_cut_off_is_named_beside_a_blank_part() {
    let (scene, camera) = (balls(), Camera::canonical(64, 64));
    let view = View::new(&scene, &camera);
    let truth = draw(&view, &Convention::default(), Rows::ALL).ids;
    let is_lost = |pixel: usize| truth[pixel] == 0 && pixel / 64 < 10;
    let ids = (0..64 * 64).map(|pixel| {
        (truth[pixel] != NO_PRIMITIVE && !is_lost(pixel)).then_some(truth[pixel].into())
    });
    let file = Buffer::new([64, 64], 1, Content::Ids(ids.collect()));
    let found = found(&view, &file);
    let said = ["in its rows 0 to 9, the first ones", "or is id 0 alone cut off there?"];
    assert!(is_said(&view, &found, &said), "{found:?}");
}

#[test]
fn an_object_that_is_missing_is_no_blank_part() {
    let (scene, camera) = (balls(), Camera::canonical(64, 64));
    let view = View::new(&scene, &camera);
    for id in 0..3 {
        let omission = Omission::of_primitive(&scene, id);
        let planted = Convention::default().with(Change::Omission(omission));
        for of_ids in [true, false] {
            let found = found(&view, &file(&view, &planted, of_ids));
            let is_part = |one: &Explanation| matches!(one.convention.omission, Omission::Part(_));
            assert!(!found.iter().any(is_part), "{found:?}");
        }
    }
}
