//! Renderers with planted mistakes draw the whole set.

use super::*;
use crate::common::{CameraDescription, Frame, Options, Projection};
use crate::diff::why::Pose;
use crate::orders::{self, Method, Order, RenderOptions, Rules};
use crate::picture::mask;
use crate::vectors::{self, Group, Vector};
use image::GrayImage;
use npyz::WriterBuilder;
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
    frame_of_samples(vector, camera, rule, 1)
}

fn frame_of_samples(
    vector: &Vector,
    camera: CameraDescription,
    rule: Option<&str>,
    samples: u32,
) -> Frame {
    let (scene, camera) = (vector.scene(), Camera::new(camera).unwrap());
    let object_order = rule.map(|rule| rule.parse().unwrap());
    let rules = Rules { object_order, image_order: None };
    let frame = Options { samples, crop: None };
    let options =
        RenderOptions { frame, rules, no_counts: true, no_times: true, ..Default::default() };
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

/// The sentences of the first cause, which is certain and the only explanation, and the number of its files.
fn only_convention(check: &Check) -> (Vec<String>, usize) {
    let (alternatives, certainty, files) = first_cause(check);
    assert_eq!((alternatives.len(), certainty), (1, Certainty::Convention), "{alternatives:?}");
    (alternatives.concat(), files)
}

#[test]
fn the_truth_passes() {
    let checked = checked(&masks(exact));
    assert!(checked.passes());
    assert_eq!(checked.verdict(), "all 74 files are right");
    assert!(checked.causes.is_empty());
}

#[test]
fn samples_at_corners_are_one_cause_of_all() {
    let corner = |vector: &Vector| mask(&frame(vector, vector.camera, Some("corner")));
    let checked = checked(&masks(corner));
    let (sentences, files) = only_convention(&checked);
    assert!(sentences[0].starts_with("it samples pixel corners (top left)"), "{sentences:?}");
    assert_eq!(sentences.len(), 1);
    assert!(files >= 50 && files + EXTREMES >= 74 - checked.right(), "{}", checked.verdict());
}

#[test]
fn two_mistakes_are_both_named() {
    let wrong = |vector: &Vector| {
        let mut mask = mask(&frame(vector, vector.camera, Some("inclusive")));
        image::imageops::flip_vertical_in_place(&mut mask);
        mask
    };
    let checked = checked(&masks(wrong));
    let (sentences, files) = only_convention(&checked);
    let [flipped, edges] = &sentences[..] else { panic!("{sentences:?}") };
    assert!(
        flipped.starts_with("it is upside down") && edges.starts_with("it covers samples exactly")
    );
    assert!(files >= 45 && files + EXTREMES >= 74 - checked.right(), "{}", checked.verdict());
}

#[test]
fn parallel_cameras_drawn_in_perspective_are_a_cause() {
    let wrong = |vector: &Vector| {
        let camera = CameraDescription { projection: Projection::Perspective, ..vector.camera };
        mask(&frame(vector, camera, None))
    };
    let checked = checked(&masks(wrong));
    let (sentences, files) = only_convention(&checked);
    assert_eq!(files, 74 - checked.right());
    assert!(
        sentences[0].starts_with("it draws a perspective picture for a parallel camera"),
        "{sentences:?}"
    );
}

#[test]
fn scenes_of_the_camera_are_about_nothing_else() {
    // A renderer that rounds vertices as a GPU does, and owns edges otherwise, sees the same.
    for vector in vectors::all().iter().filter(|vector| vector.group == Group::Camera) {
        let exact = frame(vector, vector.camera, None);
        for rule in ["snapped:8", "inclusive", "exclusive"] {
            let other = frame(vector, vector.camera, Some(rule));
            assert_eq!(other.ids(), exact.ids(), "{} {rule}", vector.name);
        }
    }
}

#[test]
fn a_wrong_camera_is_a_cause_though_most_of_the_set_has_a_straight_one() {
    for (pose, says) in [
        (Pose::EyeLeftOut, "it looks from the origin of the world"),
        (Pose::EyeAfterTurn, "it turns first, and subtracts the eye then"),
        (Pose::AxesLeftOut, "it does not turn"),
        (Pose::AxesExchanged, "it turns the other way"),
        (Pose::SidesNotNormalized, "it does not normalize u"),
        (Pose::BackNotNormalized, "it does not normalize w"),
    ] {
        let wrong = |vector: &Vector| {
            let camera = pose.camera(&vector.camera());
            let other = camera.map_or(vector.camera, |camera| *camera.description());
            mask(&frame(vector, other, None))
        };
        let checked = checked(&masks(wrong));
        let (sentences, files) = only_convention(&checked);
        assert_eq!(files, 74 - checked.right(), "{pose:?}");
        assert!(files >= 3 && sentences[0].starts_with(says), "{pose:?} {sentences:?}");
    }
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
    assert_eq!((checked.right(), checked.unreadable()), (71, 2));
    let error = |at: usize| &checked.files[at].compared.as_ref().unwrap_err().reason;
    assert!(error(0).contains(names[1]), "{}", error(0));
    assert!(error(1).contains("3 x 5"), "{}", error(1));
    assert_eq!(checked.verdict(), "2 of 73 cannot be compared; 1 scene is missing");
}

#[test]
fn each_number_of_the_verdict_belongs_to_what_stands_beside_it() {
    let file = |at: usize| CheckedFile {
        scene: format!("scene-{at}"),
        file: format!("scene-{at}.png"),
        point: String::new(),
        compared: Err("it is of no use".to_owned().into()),
    };
    let cause = |sentence: &str, files: std::ops::Range<usize>| Cause {
        alternatives: vec![vec![sentence.into()]],
        certainty: Certainty::Reason,
        files: files.collect(),
    };
    let mut check = Check {
        files: (0..8).map(file).collect(),
        missing: vec!["other".into(); 15],
        ignored: Vec::new(),
        causes: vec![cause("it rounds", 0..3), cause("it hides", 3..5), cause("it ends", 5..6)],
    };
    let verdict = "8 of 8 fail, 3 of them: it rounds; 2 other causes (3); 2 cannot be compared; 15 scenes are missing";
    assert_eq!(check.verdict(), verdict);
    check.causes = vec![cause("it rounds", 0..8)];
    check.missing.clear();
    assert_eq!(check.verdict(), "8 of 8 fail: it rounds");
    check.files.clear();
    check.causes.clear();
    check.missing.push("other".into());
    assert_eq!(check.verdict(), "all 0 files are right; 1 scene is missing");
}

/// A folder with the ids of every third scene, 2 x 2 samples a pixel, by a rule.
fn ids_of_samples(rule: Option<&str>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for vector in vectors::all().iter().step_by(3) {
        let frame = frame_of_samples(vector, vector.camera, rule, 2);
        let [width, height] = frame.image().map(u64::from);
        let file = fs::File::create(folder.path().join(format!("{}.npy", vector.name))).unwrap();
        let shape = [height, width, 2, 2];
        let options = npyz::WriteOptions::new().default_dtype().shape(&shape);
        let mut ids = options.writer(file).begin_nd().unwrap();
        for [i, j] in frame.pixels() {
            let samples = frame.samples_of(i as usize, j as usize);
            ids.extend(samples.map(|sample| frame.ids().narrow().unwrap()[sample])).unwrap();
        }
        ids.finish().unwrap();
    }
    folder
}

/// A folder with an array of one number a pixel for each scene of the set.
fn arrays<T: npyz::AutoSerialize + Copy>(draw: impl Fn(&Vector) -> Vec<T>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for vector in vectors::all() {
        let [width, height] = vector.camera.image.map(u64::from);
        let file = fs::File::create(folder.path().join(format!("{}.npy", vector.name))).unwrap();
        let options = npyz::WriteOptions::new().default_dtype().shape(&[height, width]);
        let mut numbers = options.writer(file).begin_nd().unwrap();
        numbers.extend(draw(&vector)).unwrap();
        numbers.finish().unwrap();
    }
    folder
}

#[test]
fn ids_that_are_saved_as_floats_are_named_as_such() {
    for nothing in [-1.0, f64::INFINITY] {
        let checked = checked(&arrays(|vector| {
            let frame = frame(vector, vector.camera, None);
            let number =
                |id: Option<u64>| id.map_or(nothing, |id| f64::from(u32::try_from(id).unwrap()));
            frame.ids().iter().map(number).collect()
        }));
        let (alternatives, certainty, files) = first_cause(&checked);
        let said = &alternatives[0][0];
        assert!(said.starts_with("it saves ids as floating-point numbers"), "{said}");
        // Where nothing is seen, there are no ids.
        assert!(certainty == Certainty::Reason && files > 60, "{files}");
    }
}

#[test]
fn distances_in_another_unit_are_named_as_such() {
    let far = |vector: &Vector, map: fn(f64) -> f64| {
        let frame = frame(vector, vector.camera, None);
        frame.distances().iter().map(|&t| map(f64::from(t))).collect::<Vec<f64>>()
    };
    type Map = fn(f64) -> f64;
    let units: [(Map, &str); 3] = [
        (|t| 2.0 * t, "it holds 2 t"),
        (|t| 3.0 * t, "it holds 3 t"),
        (|t| t + 1.0, "it holds t + 1"),
    ];
    for (map, expected) in units {
        let checked = checked(&arrays(|vector| far(vector, map)));
        assert!(!checked.passes());
        let (sentences, _) = only_convention(&checked);
        assert!(
            sentences.len() == 1 && sentences[0].starts_with(&format!("{expected}:")),
            "{sentences:?}"
        );
    }
}

#[test]
fn distances_in_no_unit_are_no_number_of_nothing() {
    let squared = |vector: &Vector| {
        let frame = frame(vector, vector.camera, None);
        frame.distances().iter().map(|&t| f64::from(t).powi(2)).collect::<Vec<f64>>()
    };
    let checked = checked(&arrays(squared));
    assert!(!checked.passes());
    for cause in &checked.causes {
        let of_nothing = |one: &String| one.contains("for nothing");
        assert!(!cause.alternatives.iter().flatten().any(of_nothing), "{cause:?}");
        assert_ne!(cause.certainty, Certainty::Convention, "{cause:?}");
    }
}

#[test]
fn nothing_that_is_0_in_all_files_is_a_cause() {
    let from_one = |vector: &Vector| {
        let frame = frame(vector, vector.camera, None);
        let number = |&id: &u32| if id == u32::MAX { 0 } else { id + 1 };
        frame.ids().narrow().unwrap().iter().map(number).collect::<Vec<u32>>()
    };
    let checked = checked(&arrays(from_one));
    let (sentences, _) = only_convention(&checked);
    assert!(
        sentences.iter().any(|one| one.starts_with("it writes 0 for nothing")),
        "{sentences:?}"
    );
}

#[test]
fn a_stray_nan_is_not_what_a_renderer_writes_for_nothing() {
    let with_0 = |vector: &Vector| {
        let frame = frame(vector, vector.camera, None);
        let number = |&t: &f32| if t == f32::INFINITY { 0.0 } else { t };
        let mut t: Vec<f32> = frame.distances().iter().map(number).collect();
        if vector.name == "huge-world" {
            *t.iter_mut().find(|t| **t == 0.0).unwrap() = f32::NAN;
        }
        t
    };
    let checked = checked(&arrays(with_0));
    let (sentences, _) = only_convention(&checked);
    assert!(sentences[0].starts_with("it writes 0 for nothing"), "{sentences:?}");
}

#[test]
fn several_samples_a_pixel_are_held_to_the_truth_and_explained_by_sample() {
    let right = checked(&ids_of_samples(None));
    assert_eq!((right.right(), right.files.len()), (25, 25), "{}", right.verdict());
    let corner = checked(&ids_of_samples(Some("corner")));
    let (sentences, files) = only_convention(&corner);
    let corners = |one: &String| one.starts_with("it samples pixel corners (top left)");
    assert!(sentences.iter().any(corners), "{sentences:?}");
    let counted = "in files of several samples a pixel, i and j count the samples";
    assert_eq!(sentences.last().unwrap(), counted);
    assert!(files + 6 >= 25 - corner.right(), "{files}: {}", corner.verdict());
    let clipped = checked(&ids_of_samples(Some("near-clip:3")));
    let said: Vec<&str> =
        clipped.causes.iter().map(|cause| cause.alternatives[0][0].as_str()).collect();
    assert!(
        said.iter().any(|said| said.starts_with("most of the samples: clipped near")),
        "{said:?}"
    );
}

#[test]
fn exchanged_rows_and_columns_are_one_cause_whatever_the_form_of_the_picture() {
    let transposed = |vector: &Vector| {
        let mask = exact(vector);
        GrayImage::from_fn(mask.height(), mask.width(), |x, y| *mask.get_pixel(y, x))
    };
    let checked = checked(&masks(transposed));
    let (sentences, files) = only_convention(&checked);
    assert!(sentences[0].starts_with("it has rows and columns exchanged"), "{sentences:?}");
    let of_other_size = checked.files.iter().filter(|file| file.compared.is_err()).count();
    assert!(of_other_size > 3, "{of_other_size}");
    assert_eq!((files, checked.unreadable()), (74 - checked.right(), 0), "{}", checked.verdict());
    let mut html = Vec::new();
    checked.write_page(["mine", "the built-in set"], &mut html).unwrap();
    let html = String::from_utf8(html).unwrap();
    assert_eq!(html.matches("; cause 1</p>").count(), files);
}

#[test]
fn a_cause_of_few_of_the_wrong_files_is_a_guess() {
    // Most files are noise; some are upside down.
    let mut dice = fastrand::Rng::with_seed(3);
    let mixed = |vector: &Vector| {
        let mut mask = exact(vector);
        image::imageops::flip_vertical_in_place(&mut mask);
        mask
    };
    let folder = masks(mixed);
    for vector in vectors::all().iter().skip(16) {
        let path = folder.path().join(format!("{}.png", vector.name));
        let mut mask = image::open(&path).unwrap().into_luma8();
        mask.pixels_mut().for_each(|pixel| pixel.0 = [if dice.bool() { 255 } else { 0 }]);
        mask.save(&path).unwrap();
    }
    let checked = checked(&folder);
    let guess = checked.causes.iter().find(|cause| cause.certainty == Certainty::Guess).unwrap();
    assert!(guess.short().starts_with("a guess: it is upside down"), "{}", guess.short());
    assert!(2 * guess.files.len() < 74 - checked.right());
}

#[test]
fn a_background_tells_what_is_covered_in_pictures_without_alpha() {
    let folder = tempfile::tempdir().unwrap();
    let background = [16, 20, 24];
    for vector in vectors::all().iter().step_by(6) {
        let mask = exact(vector);
        let color =
            |x, y| image::Rgb(if mask[(x, y)].0 == [0] { background } else { [200, 90, 9] });
        let picture = image::RgbImage::from_fn(mask.width(), mask.height(), color);
        picture.save(folder.path().join(format!("{}.png", vector.name))).unwrap();
    }
    let checked = |background| check(folder.path(), &ConformanceSet::BuiltIn, background).unwrap();
    let told = checked(Some(background));
    assert_eq!((told.right(), told.files.len()), (13, 13), "{}", told.verdict());
    let untold = checked(None);
    assert_eq!(untold.unreadable(), 13);
    let reason = &untold.files[0].compared.as_ref().unwrap_err().reason;
    assert!(reason.contains("--background"), "{reason}");
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
