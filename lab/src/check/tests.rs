//! Renderers with planted mistakes draw the whole set.

use super::*;
use crate::common::{CameraDescription, Frame, Projection};
use crate::orders::Rules;
use crate::picture::mask;
use crate::vectors::{self, Vector};
use image::GrayImage;
use std::fs;
use tempfile::TempDir;

/// Scenes of extreme numbers, in which an ordinary renderer also errs by rounding.
const EXTREMES: usize = 2;

/// A folder with the masks of the whole set.
fn masks(draw: impl Fn(&Vector) -> GrayImage) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for vector in vectors::all() {
        let path = folder.path().join(format!("{}.png", vector.name));
        draw(&vector).save(path).unwrap();
    }
    folder
}

fn frame(vector: &Vector, camera: CameraDescription, rule: Option<&str>) -> Frame {
    let (scene, camera) = (vector.scene(), Camera::new(camera).unwrap());
    let object_order = rule.map(|rule| rule.parse().unwrap());
    let rules = Rules { object_order, image_order: None };
    let options =
        RenderOptions { rules, no_counts: true, no_times: true, ..RenderOptions::default() };
    let view = View::new(&scene, &camera);
    orders::render(Order::Object, Method::Fast, &view, &options).unwrap().frame
}

fn exact(vector: &Vector) -> GrayImage {
    mask(&frame(vector, vector.camera, None))
}

fn checked(folder: &TempDir) -> Check {
    check(folder.path(), &ConformanceSet::BuiltIn, None).unwrap()
}

/// The sentences of the first cause, and the number of its files.
fn first_cause(check: &Check) -> (Vec<Vec<String>>, Certainty, usize) {
    let cause = &check.causes[0];
    (cause.alternatives.clone(), cause.certainty, cause.files.len())
}

#[test]
fn the_truth_passes() {
    let checked = checked(&masks(exact));
    assert!(checked.passes());
    assert_eq!(checked.verdict(), "all 68 files are right");
    assert!(checked.causes.is_empty());
}

#[test]
fn samples_at_corners_are_one_cause_of_all() {
    let corner = |vector: &Vector| mask(&frame(vector, vector.camera, Some("corner")));
    let checked = checked(&masks(corner));
    let (alternatives, certainty, files) = first_cause(&checked);
    let sentence = "it samples pixel corners (top left): in its loop, add 1/2 to i and j";
    assert_eq!((alternatives, certainty), (vec![vec![sentence.to_owned()]], Certainty::Convention));
    assert!(files >= 50 && files + EXTREMES >= 68 - checked.right(), "{}", checked.verdict());
}

#[test]
fn two_mistakes_are_both_named() {
    let wrong = |vector: &Vector| {
        let mut mask = mask(&frame(vector, vector.camera, Some("inclusive")));
        image::imageops::flip_vertical_in_place(&mut mask);
        mask
    };
    let checked = checked(&masks(wrong));
    let (alternatives, certainty, files) = first_cause(&checked);
    assert_eq!((alternatives.len(), certainty), (1, Certainty::Convention), "{alternatives:?}");
    let [flipped, edges] = &alternatives[0][..] else { panic!("{alternatives:?}") };
    assert!(
        flipped.starts_with("it is upside down") && edges.starts_with("it covers samples exactly")
    );
    assert!(files >= 45 && files + EXTREMES >= 68 - checked.right(), "{}", checked.verdict());
}

#[test]
fn parallel_cameras_drawn_in_perspective_are_a_cause() {
    let wrong = |vector: &Vector| {
        let camera = CameraDescription { projection: Projection::Perspective, ..vector.camera };
        mask(&frame(vector, camera, None))
    };
    let checked = checked(&masks(wrong));
    let (alternatives, certainty, files) = first_cause(&checked);
    assert_eq!((alternatives.len(), certainty), (1, Certainty::Convention), "{alternatives:?}");
    assert_eq!(files, 68 - checked.right());
    assert!(
        alternatives[0][0].starts_with("it draws a perspective picture for a parallel camera"),
        "{alternatives:?}"
    );
}

#[test]
fn a_renderer_with_its_own_faults_has_reasons_and_no_convention() {
    let clipped = |vector: &Vector| mask(&frame(vector, vector.camera, Some("near-clip:3")));
    let checked = checked(&masks(clipped));
    assert!(!checked.passes());
    let known = |cause: &Cause| cause.certainty != Certainty::Convention;
    assert!(checked.causes.iter().all(known), "{:?}", checked.causes);
    let named =
        checked.causes.iter().any(|cause| cause.alternatives[0][0].contains("clipped near"));
    assert!(named, "{:?}", checked.causes);
}

#[test]
fn what_cannot_be_read_and_what_is_missing_are_rows() {
    let folder = masks(exact);
    let names: Vec<&str> = vectors::all().iter().map(|vector| vector.name).collect();
    let path = |at: usize| folder.path().join(format!("{}.png", names[at]));
    fs::remove_file(path(0)).unwrap();
    fs::write(path(1), &fs::read(path(1)).unwrap()[..40]).unwrap();
    GrayImage::new(3, 5).save(path(2)).unwrap();
    fs::write(folder.path().join("mine.png"), "").unwrap();
    let checked = checked(&folder);
    assert_eq!(checked.missing, [names[0]]);
    assert_eq!(checked.ignored, ["mine.png"]);
    assert_eq!((checked.right(), checked.unreadable()), (65, 2));
    let error = |at: usize| checked.files[at].compared.as_ref().unwrap_err();
    assert!(error(0).contains(names[1]), "{}", error(0));
    assert!(error(1).contains("3 x 5"), "{}", error(1));
    assert_eq!(checked.verdict(), "3 of 68 fail: 2 cannot be compared; 1 missing");
}

#[test]
fn a_picture_of_something_else_is_not_explained() {
    let mut dice = 7_u32;
    let folder = masks(exact);
    let name = vectors::all()[20].name;
    let path = folder.path().join(format!("{name}.png"));
    let mut mask = image::open(&path).unwrap().into_luma8();
    for pixel in mask.pixels_mut() {
        dice = dice.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        pixel.0 = [if dice >> 31 == 1 { 255 } else { 0 }];
    }
    mask.save(&path).unwrap();
    let checked = checked(&folder);
    let (alternatives, certainty, files) = first_cause(&checked);
    assert_eq!((certainty, files), (Certainty::Unknown, 1), "{alternatives:?}");
}

#[test]
fn the_page_shows_what_is_wrong_and_loads_nothing() {
    let corner = |vector: &Vector| mask(&frame(vector, vector.camera, Some("corner")));
    let mut html = Vec::new();
    checked(&masks(corner)).write_page(["<mine>", "the built-in set"], &mut html).unwrap();
    let html = String::from_utf8(html).unwrap();
    assert!(html.contains("samples pixel corners") && html.contains("&lt;mine&gt;"));
    assert!(!html.contains("<mine>") && !html.contains("<script"));
    let addresses = html.matches("src=\"").count();
    assert_eq!(html.matches("src=\"data:image/png;base64,").count(), addresses);
    assert!(addresses > 60 && addresses.is_multiple_of(3), "{addresses}");
}

#[test]
fn a_folder_without_an_index_is_no_set() {
    let folder = masks(exact);
    let set = ConformanceSet::Folder(folder.path().to_owned());
    let error = check(folder.path(), &set, None).unwrap_err().to_string();
    assert!(error.contains("has no index.json of one"), "{error}");
    let empty = tempfile::tempdir().unwrap();
    let error = check(empty.path(), &ConformanceSet::BuiltIn, None).unwrap_err().to_string();
    assert!(error.contains("has the name of a scene"), "{error}");
}
